"""partialslip study tolerance: what the tolerances of a scene's numbers allow its results."""

import argparse
from pathlib import Path

import partialslip
from partialslip.cli.common import Commands, add_out, add_pdf, add_scene, add_tolerance, check_output, naming
from partialslip.cli.findings import Findings, present


def add(topics: Commands) -> None:
    """Add the topic to the parser of ``topics``."""
    tolerance = topics.add_parser(
        "tolerance",
        help="what the tolerances of the inputs allow the results",
        description="Propagate the tolerances of a scene's numbers to a, m, n, pressure, stress, dissipated energy and "
        "fatigue criteria: 95 % intervals, the share of each input, and where the contact slides or its regime "
        "changes. Draws are solved exactly where an exact solution is known; by march or equivalent half-planes "
        "differences are taken.",
        examples=[
            "partialslip study tolerance fretting-aluminium --tolerance friction.f=5% --tolerance load.P=1%",
            "partialslip study tolerance my-scene.toml --pdf",
        ],
    )
    add_scene(tolerance)
    add_tolerance(tolerance)
    add_out(tolerance, "results/NAME-tolerance[-HASH]")
    add_pdf(tolerance)
    tolerance.set_defaults(command=_tolerance)


def _tolerance(options: argparse.Namespace) -> int:
    check_output(options)
    scene = partialslip.load_scene(options.scene, options.overrides)
    name = f"{scene.name}-tolerance"

    from partialslip.cli.consoles import working
    from partialslip.report import tolerance as shown
    from partialslip.report.page import Section
    from partialslip.study.tolerance import propagate
    from partialslip.study.tolerance.figure import CAPTION, draws_csv, tolerance_csv, tolerance_svg
    from partialslip.tools.output.files import write_texts

    def find(folder: Path) -> Findings:
        with working(name) as tell, naming(options.scene):
            found, known = propagate(scene, tell, drawn=True)
            figure = tolerance_svg(found, known)
            texts = {
                "tolerance.csv": tolerance_csv(found, scene.units),
                "draws.csv": draws_csv(found, known),
                "tolerance.svg": figure,
            }
            files = write_texts(folder, texts)
        lines = shown.tolerance_lines(found, scene.units)
        table = shown.HEADINGS, shown.tolerance_rows(found, scene.units), (1, 5)
        heading = f"{scene.name}, {shown.tolerance_heading(found)}"
        return Findings(
            files,
            heading,
            [Section("", (), "", "", *table), *lines],
            f"{scene.name}: tolerances",
            [Section("Answer", [f"{line}." for line in (heading, *lines)], figure, CAPTION, *table)],
        )

    return present(options, "study tolerance", name, scene, find)
