"""partialslip identify: the coefficient of friction from a measured loop or the width of a scar."""

import argparse
import math
from dataclasses import replace
from pathlib import Path

import partialslip
from partialslip.cli.common import (
    Commands,
    add_out,
    add_pdf,
    add_scene,
    check_output,
    columns_of,
    naming,
    numbers_of,
)
from partialslip.cli.findings import Findings, present
from partialslip.tools.errors import InputError


def add(commands: Commands) -> None:
    """Add the command to the parser of ``commands``."""
    identify = commands.add_parser(
        "identify",
        help="find f from a measured loop or the width of a scar",
        description="Find the coefficient of friction with its interval of 95 % from a measured loop of Q over "
        "displacement, or from the width of a stick zone or a slip zone. P, profile, material and dsigma/dQ are those "
        "of the scene, for widths Q, too; its f plays no part.",
        examples=[
            "partialslip identify my-scene.toml --from loop.csv",
            "partialslip identify my-scene.toml --from loop.csv --columns displacement=2,Q=3",
            "partialslip identify fretting-aluminium --stick-width 9.1e-5 --error 1e-5",
        ],
    )
    add_scene(identify)
    source = identify.add_mutually_exclusive_group(required=True)
    source.add_argument(
        "--from",
        dest="loop",
        metavar="FILE",
        help="table with columns displacement, Q per unit depth and, if rows are missing, time",
    )
    source.add_argument("--stick-width", metavar="W", help="width of the stick zone, in the scene's unit of length")
    source.add_argument("--slip-scar", metavar="W", help="width of the slip zone; of the wider one under tension")
    identify.add_argument("--error", metavar="E", help="error of the width: half of its interval of 95 %%")
    identify.add_argument("--columns", metavar="NAMES",
                          help="columns by name or number (from 1): displacement=2,Q=3,time=1")  # fmt: skip
    identify.add_argument("--factors", metavar="D,Q", default="1,1",
                          help="multiply displacement and Q by these factors, after the units: -1,1 changes a sign, "
                          "1,100 makes N of N/m if the contact is 10 mm long")  # fmt: skip
    identify.add_argument("--stiffness", action="store_true", help="also print the stiffness, dQ/d(displacement)")
    add_out(identify, "results/NAME-identify[-HASH]")
    add_pdf(identify)
    identify.set_defaults(command=_identify)


def _identify(options: argparse.Namespace) -> int:
    check_output(options)
    factors = numbers_of(options.factors, float, "--factors", "two numbers, for example 1e-3,100", 2)
    if not all(0 < abs(factor) < math.inf for factor in factors):
        raise InputError(f"--factors {options.factors}: must be finite and not zero")
    columns = columns_of(options.columns)
    for name, given in (("--columns", columns), ("--stiffness", options.stiffness)):
        if given and options.loop is None:
            raise InputError(f"{name}: must be given only with --from")
    if options.error is not None and options.loop is not None:
        raise InputError(f"--error {options.error}: must be left out with --from, whose rows tell their noise")
    scene = partialslip.load_scene(options.scene, options.overrides)

    from partialslip.cli.consoles import working
    from partialslip.report.page import Section
    from partialslip.study.identify import from_loop, from_width, read_loop, shown
    from partialslip.tools.output.files import json_text, write_texts

    units, option = scene.units, "--slip-scar" if options.stick_width is None else "--stick-width"
    texts: dict[str, str] = {}
    if options.loop is not None:
        loop = read_loop(options.loop, units, columns, (factors[0], factors[1]))
        with working(scene.name), naming(options.scene):
            found = from_loop(scene, loop)
        f, remarks, rows = found.f, found.remarks, shown.loop_rows(found, units, options.stiffness)
        texts = {"identify.csv": shown.loop_csv(found, units), "identify.svg": shown.loop_svg(found, units)}
        record = shown.record(f, "loop", remarks, found)
    else:
        width = _length(option, options.slip_scar or options.stick_width)
        error = None if options.error is None else units.to_si(_length("--error", options.error), "m")
        with working(scene.name), naming(options.scene):
            f, remarks = from_width(scene, units.to_si(width, "m"), error, option == "--slip-scar")
        rows = [shown.interval_row("f", f, f"{option[2:]} of {width:g} {units.label('m')}")]
        record = shown.record(f, option[2:], remarks)
    remarks += ("P, profile and material of the scene count as exact.",)
    if options.loop is not None:
        remarks += ("Not told apart: what acts like friction elsewhere, as a fixture that slips, or columns that lag.",)
    figure = texts.get("identify.svg", "")
    caption = "Dots: measured. Line: fitted. Both without drift." if figure else ""

    def find(folder: Path) -> Findings:
        files = write_texts(folder, {"identify.json": json_text(record), **texts})
        table = Section("Coefficient of friction", (), figure, caption, shown.HEADINGS, rows, shown.WORDS)
        sections = [table, Section("Notes", remarks)]
        printed: list[str | Section] = [replace(table, title=""), *remarks]
        return Findings(files, f"{scene.name}: coefficient of friction", printed, f"{scene.name}: f", sections)

    given = {} if options.loop is None else {"loop": Path(options.loop)}
    return present(options, "identify", f"{scene.name}-identify", scene, find, given)


def _length(option: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0 < value < math.inf:
        raise InputError(f"{option} {text}: must be a length > 0, in the scene's unit")
    return value
