"""partialslip score: compare results of another code with the reference."""

import argparse
import sys
from pathlib import Path

import partialslip
from partialslip.cli.common import (
    Commands,
    add_columns,
    add_out,
    add_pdf,
    add_scene,
    add_tolerance,
    add_verbose,
    check_output,
    columns_of,
    factors_of,
    folder_if_wanted,
    numbers_of,
    origin,
    print_outcome,
    where_of,
)
from partialslip.tools.bars import LARGEST, Asked, asked
from partialslip.tools.errors import InputError
from partialslip.tools.methods import REFERENCES


def add(commands: Commands) -> None:
    """Add the command to the parser of ``commands``."""
    scores = commands.add_parser(
        "score",
        help="compare tractions of another code with the reference",
        description="Compare tractions of another code with the reference: the exact solution where it is known, else "
        "march or fem. The file is a table, CalculiX results or a mesh with point data. Output: the table, page and "
        "files of partialslip run.",
        examples=[
            "partialslip score fretting-aluminium --template > mine.csv",
            "partialslip score fretting-aluminium mine.csv --bar 1e-2",
            "partialslip score hertz-shear first.rpt second.rpt --where part=FLAT-1",
        ],
        failure="a bar missed",
        unjudged="headline quantities not judged, with --bar",
    )
    add_scene(scores)
    add_tolerance(scores)
    scores.add_argument("files", metavar="FILE", nargs="*", default=[],
                        help="tractions: a table (.csv, .txt, .tsv, .rpt), .frd or .dat, or .vtu, .vtk, .xdmf, .xmf, "
                        ".msh, .med, .e, .exo or .ex2; or one file for each load point")  # fmt: skip
    scores.add_argument("--template", action="store_true", help="print a table to fill in, and nothing else")
    add_columns(scores)
    scores.add_argument("--centre", choices=("given", "auto"), default="given",
                        help="auto puts x = 0 in the middle of the contact (default: given)")  # fmt: skip
    scores.add_argument("--order", metavar="1|2", default="1",
                        help="order of the elements, for nodal forces (columns Fn, Ft) (default: 1)")  # fmt: skip
    scores.add_argument("--kind", choices=("sampled", "mean", "nodal"),
                        help="what the values are: sampled (at points), mean (over cells) or nodal (forces of linear "
                        "elements over the nodes' weights) (default: guessed, with a note)")  # fmt: skip
    scores.add_argument("--at", metavar="I,J",
                        help="CalculiX: numbers, from 1, of the contact results at load points 1 and 2 (default: ends "
                        "of the last steps)")  # fmt: skip
    scores.add_argument("--with", dest="reference", metavar="METHOD", choices=REFERENCES,
                        help="compare with exact, march or fem (default: the first that solves the scene)")  # fmt: skip
    scores.add_argument("--bar", metavar="FRACTION",
                        help="largest allowed error of a, m and n, as a fraction of a (p: 10 times, q: 15 times, at "
                        "most 0.1); or three numbers for contact, stick zone and tractions: 1e-3,1e-2,5e-2; none above "
                        "0.1")  # fmt: skip
    add_out(scores, "results/NAME-FILE[-HASH]")
    add_pdf(scores)
    add_verbose(scores, "what was read from the file, and costs and effects of the reference")
    scores.add_argument("--json", action="store_true", help="print results.json, nothing else; files only with --out")
    scores.set_defaults(command=_score)


def _score(options: argparse.Namespace) -> int:
    check_output(options)
    factors = factors_of(options.factors)
    at = () if options.at is None else numbers_of(options.at, int, "--at", "two whole numbers, for example 3,4", 2)
    bar = None if options.bar is None else _bar(options.bar)
    if options.order not in ("1", "2"):
        raise InputError(f"--order {options.order}: must be 1 or 2")
    scene = partialslip.load_scene(options.scene, options.overrides)
    if options.template:
        if options.files:
            raise InputError(f"--template {options.files[0]}: must go without a file: remove {options.files[0]}")
        from partialslip.codes.score.csvfile import csv_template
        from partialslip.halfplane import contact

        sys.stdout.write(csv_template(scene, contact(scene).a))
        return 0
    if not options.files:
        raise InputError("FILE: missing: must be a file with tractions; --template prints a table to fill in")

    from partialslip.cli.consoles import working
    from partialslip.codes.score.read import check
    from partialslip.report import write_run
    from partialslip.run.judge.reference import reference

    files = [Path(file) for file in options.files]
    for file in files:
        check(file)  # before a folder is created
    beside = files[0].with_suffix(".frd")  # has the mesh of a .dat
    mesh = beside if files[0].suffix.lower() == ".dat" and beside.is_file() else None
    known = {f"file{k or ''}": file for k, file in enumerate(files)} | {
        "files": None,
        "mesh": mesh,
        "factors": factors,
        "reference": options.reference or reference(scene).method,
    }

    def usual() -> dict[str, object]:
        method = known["reference"] if options.reference is None else reference(scene).method
        return known | {"factors": (1, 1, 1), "reference": method}

    name = f"{scene.name}-{'-'.join(file.stem for file in files)}"
    with (
        folder_if_wanted(options, "score", name, scene, known, usual) as (folder, elsewhere),
        working(scene.name) as tell,
    ):
        outcome = partialslip.score(
            scene,
            files,
            bar=bar,
            reference=options.reference,
            factors=factors,
            order=int(options.order),
            at=(at[0], at[1]) if at else None,
            columns=columns_of(options.columns),
            where=where_of(options.where),
            centre=options.centre,
            kind=options.kind,
            progress=tell,
        )
        if scene.tolerance:
            from partialslip.study.tolerance import with_tolerance

            outcome = with_tolerance(outcome, tell)
        written = write_run(outcome, folder, origin(options), pdf=options.pdf) if folder else []
    return print_outcome(outcome, options, written, elsewhere=elsewhere)


def _bar(text: str) -> Asked:
    """Parse the value of ``--bar``."""
    wanted = f"one number, or three for contact, stick zone and tractions, > 0 and <= {LARGEST:g}"
    numbers = numbers_of(text, float, "--bar", wanted, 1, 3)
    try:
        found = asked(numbers)
    except InputError:
        raise InputError(f"--bar {text}: must be {wanted}") from None
    assert found
    return found
