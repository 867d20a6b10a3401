"""partialslip study effects: changes and costs by each effect of a scene."""

import argparse
from typing import TYPE_CHECKING

import partialslip
from partialslip.cli.common import (
    add_out,
    add_pdf,
    add_scene,
    check_folder,
    check_report,
    print_written,
    results_folder,
    write_study,
)

if TYPE_CHECKING:
    from partialslip.cli.common import Commands


def add(topics: "Commands") -> None:
    """Add the topic to the parser of ``topics``."""
    effects = topics.add_parser(
        "effects",
        help="switch each effect on and off: changes and costs",
        description="Switch each effect of a scene on or off. Print the changes of a, m, n and q, and the costs.",
        examples=[
            "partialslip study effects fretting-aluminium",
            "partialslip study effects my-scene.toml --set fem.size=0.05",
        ],
    )
    add_scene(effects)
    add_out(effects, "results/NAME-effects[-HASH]")
    add_pdf(effects)
    effects.set_defaults(command=_effects)


def _effects(options: argparse.Namespace) -> int:
    check_folder(options.out)
    check_report(options)
    scene = partialslip.load_scene(options.scene, options.overrides)

    from partialslip.cli.consoles import output, working
    from partialslip.output.files import json_text, write_texts
    from partialslip.output.tables import print_table
    from partialslip.study.effects import worth
    from partialslip.study.effects.figure import effects_svg

    name = f"{scene.name}-effects"
    with results_folder(options, "study effects", name, scene) as (folder, elsewhere), working(name) as tell:
        study = worth.study_effects(scene, tell)
        texts = {
            "effects.json": json_text(worth.effects_record(study)),
            "effects.csv": worth.effects_csv(study),
            "effects.svg": effects_svg(study),
        }
        files = [
            *write_texts(folder, texts),
            *write_study(
                options, folder, f"{scene.name}: effects", scene, worth.effects_sections(study, texts["effects.svg"])
            ),
        ]
    console = output()
    console.print(worth.effects_heading(study), style="bold", markup=False)
    print_table(console, *worth.changes_table(study), words=(0, 1))
    print_table(console, *worth.costs_table(study))
    for line in worth.refusals(study):
        console.print(line, soft_wrap=True, markup=False)
    print_written(files, console, elsewhere)
    return 0
