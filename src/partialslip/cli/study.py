"""partialslip study: solve many cases of a scene and evaluate them together."""

from partialslip.cli import cost, effects, size, tolerance
from partialslip.cli.common import Commands


def add(commands: Commands) -> None:
    """Add the command to the parser of ``commands``."""
    study = commands.add_parser(
        "study",
        help="studies of a scene: effects, cost of accuracy, sizes of bodies, tolerances",
        description="Solve many cases of a scene; print tables and write files and figures. A stopped study of cost or "
        "size continues.",
        examples=[
            "partialslip study effects fretting-aluminium",
            "partialslip study cost hertz-large-tension --repeats 1",
        ],
    )
    topics = study.add_subparsers(required=True, metavar="TOPIC")
    for topic in (effects, cost, size, tolerance):
        topic.add(topics)
