"""partialslip study effects: changes and costs by each effect of a scene."""

import argparse
from pathlib import Path

import partialslip
from partialslip.cli.common import Commands, add_out, add_pdf, add_scene, check_output
from partialslip.cli.findings import Findings, present


def add(topics: Commands) -> None:
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
    check_output(options)
    scene = partialslip.load_scene(options.scene, options.overrides)
    name = f"{scene.name}-effects"

    from partialslip.cli.consoles import working
    from partialslip.report.page import Section
    from partialslip.study import effects
    from partialslip.tools.output.files import json_text, write_texts

    def find(folder: Path) -> Findings:
        with working(name) as tell:
            study = effects.study_effects(scene, tell)
            texts = {
                "effects.json": json_text(effects.effects_record(study)),
                "effects.csv": effects.effects_csv(study),
                "effects.svg": effects.effects_svg(study),
            }
            files = write_texts(folder, texts)
        printed: list[str | Section] = [
            Section("", (), "", "", *effects.changes_table(study), (1,)),
            Section("", (), "", "", *effects.costs_table(study)),
            *effects.refusals(study),
        ]
        sections = effects.effects_sections(study, texts["effects.svg"])
        return Findings(files, effects.effects_heading(study), printed, f"{scene.name}: effects", sections)

    return present(options, "study effects", name, scene, find)
