"""partialslip study: many cases of a scene, and what they say together."""

from typing import TYPE_CHECKING

from partialslip.cli import cost, effects, size

if TYPE_CHECKING:
    from partialslip.cli.common import Commands


def add(commands: "Commands") -> None:
    """Add the command to the parser."""
    study = commands.add_parser(
        "study",
        help="many cases of a scene: its effects, what accuracy costs, sizes of bodies",
        description="Solve many cases of a scene and say what they show together, as tables, files and pictures. "
        "What was stopped goes on where it was.",
        examples=[
            "partialslip study effects fretting-aluminium",
            "partialslip study cost hertz-large-tension --repeats 1",
        ],
    )
    topics = study.add_subparsers(required=True, metavar="TOPIC")
    for topic in (effects, cost, size):
        topic.add(topics)
