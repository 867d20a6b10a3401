"""partialslip study size: half-planes against finite elements over sizes of bodies."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

import partialslip
from partialslip.cli.common import Commands, add_out, add_pdf, add_scene, check_output, study_ledger
from partialslip.cli.findings import Findings, present
from partialslip.tools.errors import InputError

if TYPE_CHECKING:
    from partialslip.scene import Scene
    from partialslip.study.size.axes import Axis
    from partialslip.study.size.case import Sized

_WORDS = ("half-planes", "unit", "stresses")  # headings of columns of words


def add(topics: Commands) -> None:
    """Add the topic to the parser of ``topics``."""
    size = topics.add_parser(
        "size",
        help="half-planes against finite elements, over sizes of bodies or other settings",
        description="Sweep over sizes of bodies, or other settings of a scene. Compare half-planes, and half-planes "
        "with the data that make them act like the bodies, with finite elements. Refined meshes separate the "
        "differences from the error of the mesh. One case with bodies 100 times the largest size tells what remains "
        "however large they are; laws over the size are fitted to the rest. A stopped study continues.",
        examples=[
            "partialslip study size block.toml --over bodies.*.width+bodies.*.height=4a..256a",
            "partialslip study size pad.toml --over bodies.upper.height=8a,16a,32a --over friction.f=0.2,0.4",
        ],
        failure="a case that could not be solved",
    )
    add_scene(size)
    size.add_argument("--over", action="append", required=True, metavar="KEY[+KEY]=VALUES",
                      help="values: a list 4a,8a,16a or a range in equal ratios 4a..256a or 4a..256a:13; a is the "
                      "contact half-width of the half-plane, without a the unit is the scene's; 3*KEY is set to three "
                      "times the value; give --over twice for a map")  # fmt: skip
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
    for each in axes if len(axes) > 1 else []:
        if len(set(each.values)) < 2 or min(each.values) <= 0:
            raise InputError(f"--over {each.name}: must have at least 2 values, all > 0, for a map")
    from partialslip.study.size.stresses import criteria_of

    names = None if options.shown is None else [name.strip() for name in options.shown.split(",")]
    shown = criteria_of(scene, names)  # before anything is solved
    name = f"{scene.name}-size"

    def find(folder: Path) -> Findings:
        from partialslip.cli.consoles import counting
        from partialslip.study.batch.sweep import workers
        from partialslip.study.size import sizes

        ledger = study_ledger(folder)
        with counting(name) as progress, workers(options.cluster, options.processes) as executor:
            entries = sizes.measure(scene, axes, ledger, executor, progress, control=not options.one_mesh)
        return _evaluated(scene, axes, sizes.with_criteria(entries, shown), ledger.path)

    return present(options, "study size", name, scene, find)


def _evaluated(scene: "Scene", axes: "list[Axis]", entries: "list[Sized]", ledger: Path) -> Findings:
    """Draw, write and tabulate the ``entries`` of a ledger."""
    from partialslip.report.page import Section
    from partialslip.scene.plan import asks_for_stresses
    from partialslip.study.size import sizes, stresses, tables
    from partialslip.study.size.figure import grid_svg, size_svg
    from partialslip.tools.output.files import csv_text, write_texts

    answer = list[str]()
    texts, heading = {"cases.csv": csv_text(*sizes.case_table(axes, entries, scene.units))}, ""
    sections = list[Section]()
    if len(axes) == 1:
        study = tables.size_study(scene, axes[0], entries)
        ends, stress = study.part(sizes.DIFFERENCES), stresses.stresses_of(study)
        texts |= {"points.csv": tables.points_csv(study), "laws.csv": tables.laws_csv(study)}
        texts |= {"stresses.csv": stresses.stresses_csv(study)} if study.spots else {}
        texts |= {name: size_svg(part) for name, part in (("size.svg", ends), ("stress.svg", stress)) if part.trends}
        heading = tables.size_heading(study)
        answer = [tables.size_answer(study)] if study.trends else []
        found = [(each.title, tables.differences_table(ends, each)) for each in ends.models]
        found += [("Stresses", stresses.largest_table(study))]
        found += [
            (f"{each.title} in stresses", stresses.stress_differences_table(study, each)) for each in stress.models
        ]
        found += [("Laws", tables.laws_table(study)), ("Sizes needed", tables.needed_table(study))]
        sections = [
            Section(title, (), "", "", headings, rows, (1,) if headings[1] in _WORDS else ())
            for title, (headings, rows) in found
            if rows
        ]
        lines = [*stresses.in_short(study), *tables.size_notes(study)]
    else:
        for quantity in (*sizes.DIFFERENCES, *sizes.stress_quantities(entries)):
            grid = sizes.grid(axes, entries, quantity)
            names = tuple(each.label(scene.units) for each in axes)
            texts[f"map-{quantity}.svg"] = grid_svg(*grid, (names[0], names[1]), f"{scene.name}: change of {quantity}")
        lines = tables.case_remarks(axes, entries)
    lines += [] if asks_for_stresses(scene) else [stresses.NOT_ASKED]
    figures = [Section(name.removesuffix(".svg"), (), text) for name, text in texts.items() if name.endswith(".svg")]
    return Findings(
        [ledger, *write_texts(ledger.parent, texts)],
        heading,
        [*answer, *sections, *lines],
        f"{scene.name}: size of the bodies",
        [Section(title, found) for title, found in (("Answer", answer),) if found]
        + [*figures, *sections, *([Section("Notes", lines)] if lines else [])],
        code=1 if any(entry.error and not sizes.at_limit(axes, entry) for entry in entries) else 0,
    )
