"""partialslip study effects: what each effect of a scene is worth, and what it costs."""

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING

from partialslip.cli.common import add_scene, check_folder, held, print_written
from partialslip.reading import load_scene

if TYPE_CHECKING:
    from partialslip.cli.common import Commands


def add(topics: "Commands") -> None:
    """Add the topic to the parser."""
    effects = topics.add_parser(
        "effects",
        help="each effect on and off: what it changes and what it costs",
        description="Turn each effect of a scene over; print what that changes in a, m, n and q, and what it costs.",
        examples=[
            "partialslip study effects fretting-aluminium",
            "partialslip study effects my-scene.toml --set fem.size=0.05",
        ],
    )
    add_scene(effects)
    effects.add_argument("--out", metavar="DIR", help="folder for the files (default: results/NAME-effects)")
    effects.set_defaults(command=_effects)


def _effects(options: argparse.Namespace) -> int:
    check_folder(options.out)
    scene = load_scene(options.scene, options.overrides)

    from partialslip.cli.consoles import output, working
    from partialslip.report import print_table, write_texts
    from partialslip.study import effects
    from partialslip.study.effectsfigure import effects_svg

    name = f"{scene.name}-effects"
    folder = Path(options.out) if options.out else Path("results") / name
    with held(folder), working(name) as tell:
        study = effects.study_effects(scene, tell)
        texts = {
            "effects.json": json.dumps(effects.effects_record(study), indent=1, allow_nan=False) + "\n",
            "effects.csv": effects.effects_csv(study),
            "effects.svg": effects_svg(study),
        }
        files = write_texts(folder, texts)
    console = output()
    console.print(effects.heading(study), style="bold", markup=False)
    print_table(console, *effects.changes_table(study), words=(0, 1))
    print_table(console, *effects.costs_table(study))
    for line in effects.notes(study):
        console.print(line, soft_wrap=True, markup=False)
    print_written(files, console)
    return 0
