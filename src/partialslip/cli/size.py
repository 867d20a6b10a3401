"""partialslip study size: changes from the half-plane over sizes of bodies."""

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING

from partialslip.cli.common import (
    add_pdf,
    add_scene,
    check_folder,
    check_report,
    held,
    print_outdated,
    print_written,
    write_study,
)
from partialslip.errors import InputError
from partialslip.scene.reading import load_scene

if TYPE_CHECKING:
    from partialslip.cli.common import Commands
    from partialslip.scene import Scene
    from partialslip.study.size.axes import Axis
    from partialslip.study.size.sizes import Law, Sizes


def add(topics: "Commands") -> None:
    """Add the topic to the parser of ``topics``."""
    size = topics.add_parser(
        "size",
        help="changes from the half-plane, over sizes of bodies or other settings",
        description="Sweep over sizes of bodies, or other settings of a scene. Refined meshes separate the change by "
        "the body from the error of the mesh. Fit a law for the change over the size. A stopped study continues.",
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
    size.add_argument("--out", metavar="DIR", help="folder for the files (default: results/NAME-size)")
    add_pdf(size)
    size.set_defaults(command=_size)


def _size(options: argparse.Namespace) -> int:
    check_folder(options.out)
    check_report(options)
    if options.processes is not None and options.processes < 1:
        raise InputError(f"--processes {options.processes}: must be >= 1")
    if len(options.over) > 2:
        raise InputError(f"--over: given {len(options.over)} times: must be at most 2")
    from partialslip.study.size.axes import axis

    scene = load_scene(options.scene, options.overrides)
    folder = Path(options.out) if options.out else Path("results") / f"{scene.name}-size"
    axes = [axis(text) for text in options.over]
    with held(folder):
        return _swept(options, scene, axes, folder)


def _swept(options: argparse.Namespace, scene: "Scene", axes: "list[Axis]", folder: Path) -> int:
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    from partialslip.batch.ledger import Ledger
    from partialslip.batch.sweep import workers
    from partialslip.cli.consoles import messages, output, shown
    from partialslip.output.csv import csv_text
    from partialslip.output.files import write_texts
    from partialslip.output.tables import print_table
    from partialslip.report.page import Section
    from partialslip.study.size import sizes
    from partialslip.study.size.figure import grid_svg, size_svg

    ledger = Ledger(folder / "ledger.jsonl")
    columns = (TextColumn(f"{scene.name}-size"), BarColumn(), MofNCompleteColumn(), TextColumn("{task.fields[left]}"))
    print_outdated(ledger, messages())
    bar = Progress(*columns, console=messages(), transient=True)
    task = bar.add_task("", total=None, left="")

    def progress(done: int, total: int, left: float) -> None:
        bar.update(task, completed=done, total=total, left="" if math.isnan(left) else f"{left:.0f} s left")

    with shown(bar), workers(options.cluster, options.processes) as executor:
        entries = sizes.measure(scene, axes, ledger, executor, progress, control=not options.one_mesh)
    console = output()
    texts = {"cases.csv": csv_text(*sizes.table(axes, entries))}
    unit = "in contact half-widths" if axes[0].in_a else "as in the scene"
    tables: list[Section] = []
    if len(axes) == 1:
        found = sizes.along(axes[0], entries)
        laws = [law for quantity in sizes.QUANTITIES if (law := sizes.law(found, quantity))]
        texts["size.svg"] = size_svg(found, laws, scene.name, unit)
        console.print(f"{scene.name}: change from the half-plane, over {axes[0].name} {unit}", style="bold")
        rows = [
            [f"{value:.4g}", *(_number(found.off[quantity][k]) for quantity in sizes.QUANTITIES), _share(found, k)]
            for k, value in enumerate(found.size)
        ]
        changes = ["size", *sizes.QUANTITIES, "mesh"]
        tables.append(Section("Changes from the half-plane", (), "", "", changes, rows))
        print_table(console, changes, rows)
        if laws:
            needed = [f"{level:.1%}" for level in sizes.LEVELS]
            head = ["change = C size^-k", "C", "k", "95 %", "points", *needed]
            console.print("the law, and the size from which on the change is below", markup=False)
            fitted = [_law(law) for law in laws]
            tables.append(Section("The law, and the size from which on the change is below", (), "", "", head, fitted))
            print_table(console, head, fitted)
    else:
        for quantity in sizes.QUANTITIES:
            grid = sizes.grid(axes, entries, quantity)
            names = tuple(f"{each.name}{', in a' if each.in_a else ''}" for each in axes)
            texts[f"map-{quantity}.svg"] = grid_svg(*grid, (names[0], names[1]), f"{scene.name}: change of {quantity}")
    failed = [entry for entry in entries if entry.error]
    for entry in failed:
        labels = ", ".join(f"{key} {value}" for key, value in entry.labels.items())
        console.print(f"not solved: {labels}: {entry.error}", soft_wrap=True, markup=False)
    figures = [Section(name.removesuffix(".svg"), (), text) for name, text in texts.items() if name.endswith(".svg")]
    sections = [*figures, *tables]
    page = write_study(options, folder, f"{scene.name}: size of the bodies", scene, sections)
    print_written([ledger.path, *write_texts(folder, texts), *page], console)
    return 1 if failed else 0


def _number(value: float) -> str:
    return "" if math.isnan(value) else f"{value:.1e}"


def _share(sizes: "Sizes", k: int) -> str:
    """Return the largest share of a change that may be an error of the mesh, as text."""
    shares = [sizes.mesh[key][k] / off[k] for key, off in sizes.off.items() if off[k] > 0]
    return f"{max(shares):.1%}" if shares else ""


def _law(law: "Law") -> list[str]:
    bounds = f"{law.bounds[0]:.2f} to {law.bounds[1]:.2f}"
    return [law.quantity, f"{law.C:.3g}", f"{law.k:.2f}", bounds, str(law.points), *(f"{s:.3g}" for s in law.needed)]
