"""partialslip study size: half-planes against finite elements over sizes of bodies."""

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import partialslip
from partialslip.cli.common import Commands, add_out, add_pdf, add_scene, add_verbose, check_output, study_ledger
from partialslip.cli.findings import Findings, present
from partialslip.tools.errors import InputError

if TYPE_CHECKING:
    from partialslip.scene import Scene
    from partialslip.study.size.axes import Axis
    from partialslip.study.size.case import Sized
    from partialslip.study.size.tables import SizeStudy

_WORDS = ("half-planes", "unit", "stresses")  # headings of columns of words


def add(topics: Commands) -> None:
    """Add the topic to the parser of ``topics``."""
    size = topics.add_parser(
        "size",
        help="half-planes against finite elements, over sizes of bodies or other settings",
        description="Tell from which size on bodies act like half-planes, or how other settings matter. Compare "
        "half-planes, and half-planes with the data that make them act like the bodies, with finite elements. Refined "
        "meshes separate the differences from the error of the mesh. One case with bodies 100 times the largest size "
        "tells what remains however large they are; laws over the size are fitted to the rest. A stopped study "
        "continues.",
        examples=[
            "partialslip study size block.toml --over bodies.*.width+bodies.*.height=4a..256a",
            "partialslip study size rig.toml --over bodies.lower.thickness=5,10,20 --level 2%",
            "partialslip study size pad.toml --over bodies.upper.height=8a,16a,32a --over friction.f=0.2,0.4",
        ],
        failure="a case that could not be solved",
    )
    add_scene(size)
    size.add_argument("--over", action="append", required=True, metavar="KEY[+KEY]=VALUES",
                      help="values: a list 4a,8a,16a or a range in equal ratios 4a..256a or 4a..256a:13; a is the "
                      "contact half-width of the half-plane, without a the unit is the scene's; 3*KEY is set to three "
                      "times the value; bodies.lower.thickness is twice the height of a body on rollers; give --over "
                      "twice for a map")  # fmt: skip
    size.add_argument("--level", action="append", default=[], metavar="[QUANTITY=]SHARE", dest="levels",
                      help="difference for which to tell the size, as 2%% or, of one quantity, m=2%%; may be repeated "
                      "(default: 1%%, 0.1%% and 0.01%%)")  # fmt: skip
    size.add_argument("--show", metavar="QUANTITIES", dest="quantities",
                      help="what to tell and draw the sizes of, separated by commas, of a, p_max, p, m, n, q, sigma_xx "
                      "and criteria (default: m,n,sigma_xx)")  # fmt: skip
    size.add_argument("--processes", type=int, metavar="N",
                      help="parallel processes on this machine (default: number of cores)")  # fmt: skip
    size.add_argument("--cluster", metavar="ADDRESS",
                      help="address of a Dask scheduler; the cluster's workers solve the cases")  # fmt: skip
    size.add_argument("--one-mesh", action="store_true",
                      help="one mesh per size, without further meshes to check the error of the mesh")  # fmt: skip
    size.add_argument("--criterion", metavar="CRITERIA", dest="shown",
                      help="fatigue criteria to show, separated by commas, as for partialslip fatigue (default: all "
                      "whose constants the table fatigue has; swt if it has none)")  # fmt: skip
    add_out(size, "results/NAME-size-HASH")
    add_verbose(size, "differences by size, stresses and laws")
    add_pdf(size)
    size.set_defaults(command=_size)


def _size(options: argparse.Namespace) -> int:
    check_output(options)
    if options.processes is not None and options.processes < 1:
        raise InputError(f"--processes {options.processes}: must be >= 1")
    if len(options.over) > 2:
        raise InputError(f"--over: given {len(options.over)} times: must be at most 2")
    from partialslip.study.size.axes import axis

    scene = partialslip.load_scene(options.scene, options.overrides)
    axes = [axis(text) for text in options.over]
    if len(axes) > 1 and (options.levels or options.quantities):
        raise InputError("--over: given twice: must be given once with --level or --show, as a map has all quantities")
    for each in axes if len(axes) > 1 else []:
        if len(set(each.values)) < 2 or min(each.values) <= 0:
            raise InputError(f"--over {each.name}: must have at least 2 values, all > 0, for a map")
    from partialslip.study.size.law import levels
    from partialslip.study.size.stresses import criteria_of, quantities_of

    names, quantities = _names(options.shown), _names(options.quantities)
    shown = criteria_of(scene, names)  # before anything is solved
    asked, below = quantities_of(scene, quantities, shown, names is not None), levels(options.levels)
    if foreign := [key for key in below if key and key not in asked]:
        raise InputError(f"--level {foreign[0]}=: must be of {', '.join(asked)}; --show names others")
    name = f"{scene.name}-size"

    def find(folder: Path) -> Findings:
        from partialslip.cli.consoles import counting
        from partialslip.study.batch.sweep import workers
        from partialslip.study.size import sizes
        from partialslip.study.size.tables import size_study
        from partialslip.tools.output.files import csv_text, write_texts

        ledger = study_ledger(folder)
        try:
            with counting(name) as progress, workers(options.cluster, options.processes) as executor:
                entries = sizes.measure(scene, axes, ledger, executor, progress, control=not options.one_mesh)
        except KeyboardInterrupt:
            kept = f"{len(ledger):,} case{'' if len(ledger) == 1 else 's'} kept"
            raise KeyboardInterrupt(f"{kept}; the same command goes on") from None
        entries = sizes.with_criteria(entries, shown)
        cases = write_texts(ledger.path.parent, {"cases.csv": csv_text(*sizes.case_table(axes, entries, scene.units))})
        failed = any(entry.error and not sizes.at_limit(axes, entry) for entry in entries)
        found = (
            _answered(size_study(scene, axes[0], entries, below), asked, ledger.path, options.verbose)
            if len(axes) == 1
            else _mapped(scene, axes, entries, ledger.path)
        )
        return replace(found, files=[ledger.path, *cases, *found.files], code=1 if failed else 0)

    return present(options, "study size", name, scene, find)


def _names(text: str | None) -> list[str] | None:
    return None if text is None else [name.strip() for name in text.split(",")]


def _answered(study: "SizeStudy", asked: Sequence[str], ledger: Path, verbose: bool) -> Findings:
    """Draw, write and tabulate a ``study`` along one axis: first the sizes needed for the quantities ``asked``."""
    from partialslip.report.page import Section
    from partialslip.scene.plan import asks_for_stresses
    from partialslip.study.size import sizes, stresses, tables
    from partialslip.study.size.figure import CAPTION, size_svg
    from partialslip.tools.output.files import write_texts

    shown = study.part(asked)
    shown = shown if shown.trends else study
    texts = {"points.csv": tables.points_csv(study), "laws.csv": tables.laws_csv(study)}
    texts |= {"stresses.csv": stresses.stresses_csv(study)} if study.spots else {}
    texts |= {"size.svg": size_svg(shown)} if study.trends else {}
    ends, stress = study.part(sizes.DIFFERENCES), stresses.stresses_of(study)
    found = [
        *((each.title, tables.differences_table(ends, each)) for each in ends.models),
        ("Stresses", stresses.largest_table(study)),
        *((f"{each.title} in stresses", stresses.stress_differences_table(study, each)) for each in stress.models),
        ("Laws", tables.laws_table(study)),
        ("All sizes needed", tables.needed_table(study)),
    ]
    details = [
        Section(title, (), "", "", headings, rows, (1,) if headings[1] in _WORDS else ())
        for title, (headings, rows) in found
        if rows
    ]
    answers, needed = tables.size_answers(shown), tables.needed_table(shown)
    notes = [*stresses.in_short(study), *tables.kinds_notes(shown), *study.remarks]
    notes += [] if asks_for_stresses(study.scene) else [stresses.NOT_ASKED]
    marks = tables.table_notes(study)
    more = [*details, *marks] if verbose else ["differences by size, stresses and laws: --verbose, or report.html"]
    name, over = study.scene.name, tables.size_heading(study)
    first = Section("Answer", [*answers, over], texts.get("size.svg", ""), CAPTION, *needed, (1,))
    return Findings(
        write_texts(ledger.parent, texts),
        f"{name}, {answers[0]}" if answers else over,
        [
            *answers[1:],
            *([over] if answers else []),
            Section("", headings=needed[0], rows=needed[1], words=(1,)),
            *notes,
            *more,
        ],
        f"{name}: size of the bodies",
        [first, *details, Section("Notes", [*notes, *marks])],
    )


def _mapped(scene: "Scene", axes: "list[Axis]", entries: "list[Sized]", ledger: Path) -> Findings:
    """Draw and write a map over two ``axes``."""
    from partialslip.report.page import Section
    from partialslip.scene.plan import asks_for_stresses
    from partialslip.study.size import sizes, stresses, tables
    from partialslip.study.size.figure import grid_svg
    from partialslip.tools.output.files import write_texts

    x, y = (each.label(scene.units) for each in axes)
    figures = {
        f"map-{key}": grid_svg(*sizes.grid(axes, entries, key), (x, y), f"{scene.name}: change of {key}")
        for key in (*sizes.DIFFERENCES, *sizes.stress_quantities(entries))
    }
    lines = tables.case_remarks(axes, entries)
    lines += [] if asks_for_stresses(scene) else [stresses.NOT_ASKED]
    return Findings(
        write_texts(ledger.parent, {f"{name}.svg": svg for name, svg in figures.items()}),
        "",
        lines,
        f"{scene.name}: size of the bodies",
        [*(Section(name, (), svg) for name, svg in figures.items()), *([Section("Notes", lines)] if lines else [])],
    )
