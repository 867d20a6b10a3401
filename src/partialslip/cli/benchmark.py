"""partialslip benchmark: numbered problems with frozen targets, for contact codes."""

import argparse
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from partialslip.cli.common import (
    Commands,
    add_columns,
    add_out,
    add_pdf,
    check_output,
    columns_of,
    factors_of,
    print_written,
    results_folder,
    where_of,
)
from partialslip.tools.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from partialslip.verify.benchmark import Submission
    from partialslip.verify.benchmark.problem import Posed

_LACKING = "an answer without a headline target"
_PROBLEMS = "numbers of problems, or patterns such as PS-0*, separated by commas (default: all)"

_TITLED = 144  # display: columns of a terminal from which on a table has the titles of the problems


def add(commands: Commands) -> None:
    """Add the command to the parser of ``commands``."""
    benchmark = commands.add_parser(
        "benchmark",
        help="numbered problems with frozen targets, for contact codes",
        description="List the problems of the benchmark, answer them with a method of partialslip, score the answers "
        "of a code, check them before they are handed in, write the book, the targets as a data set, or gold "
        "files.",
        examples=[
            "partialslip benchmark list",
            "partialslip benchmark score my-answers",
            "partialslip benchmark build",
        ],
    )
    parts = benchmark.add_subparsers(required=True, metavar="PART", parser_class=type(benchmark))
    lists = parts.add_parser("list", help="list the problems",
                             description="List the problems: number, title, regime, and how many targets.",
                             examples=["partialslip benchmark list", "partialslip benchmark list --help"])  # fmt: skip
    lists.set_defaults(command=_list)

    runs = parts.add_parser("run", help="answer problems with a method of partialslip or an installed code",
                            description="Answer problems with a method of partialslip, or with another code that is "
                            "installed, and write the answers.",
                            unjudged=_LACKING,
                            examples=["partialslip benchmark run --code exact",
                                      "partialslip benchmark run --code fem-1e-4 --problems PS-0*"])  # fmt: skip
    runs.add_argument("--code", required=True, metavar="CODE", help="exact, march, fem-1e-3, fem-1e-4, fem-1e-5, "
                      "fem-P1, fem-P2, equivalent, or another code's adapter (docs/howto/benchmark.md)")  # fmt: skip
    runs.add_argument("--problems", metavar="NUMBERS", help=_PROBLEMS)
    add_out(runs, "results/benchmark-CODE[-HASH]")
    runs.set_defaults(command=_run, overrides=[])

    reads = parts.add_parser("read", help="turn a table of tractions into an answer",
                             description="Turn a table of tractions, or results of CalculiX, into the answer to a "
                             "problem, as partialslip score reads it.",
                             examples=["partialslip benchmark read PS-02 tractions.csv -o my-answers",
                                       "partialslip benchmark read PS-05 job.frd -o my-answers"])  # fmt: skip
    reads.add_argument("problem", metavar="PROBLEM", help="number of the problem")
    reads.add_argument("files", metavar="FILE", nargs="+",
                       help="table of x, p and q, or CalculiX's .frd; or one file for each load point")  # fmt: skip
    reads.add_argument("-o", "--out", metavar="DIR", required=True, help="folder of the answers of one code")
    reads.add_argument("--code", metavar="NAME",
                       help="name of the code, for meta.toml in a new folder (default: name of the table)")  # fmt: skip
    add_columns(reads)
    reads.add_argument("--force", action="store_true", help="replace another answer to the problem")
    reads.set_defaults(command=_read)

    scores = parts.add_parser("score", help="grade the answers of a code",
                              description="Grade the answers of a code: a folder with meta.toml, PS-01.json and so "
                              "on. Values that are left out are read from PS-01.csv, a table of tractions.",
                              unjudged=_LACKING,
                              examples=["partialslip benchmark score my-answers",
                                        "partialslip benchmark score my-answers --problems PS-0*"])  # fmt: skip
    scores.add_argument("folder", metavar="FOLDER", help="folder with the answers")
    scores.add_argument("--problems", metavar="NUMBERS", help=_PROBLEMS)
    scores.set_defaults(command=_score)

    checks = parts.add_parser("check", help="check answers before they are handed in",
                              description="Check a folder of answers before it is handed in: author, version, "
                              "settings, machine, input files with their checksums, values and tables of tractions. "
                              "Print a line for each thing that is wrong, or the grades.",
                              unjudged=_LACKING,
                              examples=["partialslip benchmark check my-answers",
                                        "partialslip benchmark check benchmarks/submissions/my-code"])  # fmt: skip
    checks.add_argument("folder", metavar="FOLDER", help="folder with the answers")
    checks.set_defaults(command=_check_submission)

    data = parts.add_parser("data", help="write the targets as a data set",
                            description="Write the targets of all problems as a data set that stands alone: JSON and "
                            "CSV with units, uncertainty and provenance, JSON Schema, licence (CC-BY-4.0), citation, "
                            "RO-Crate.",
                            examples=["partialslip benchmark data --out targets",
                                      "partialslip benchmark data --out targets.zip"])  # fmt: skip
    data.add_argument("-o", "--out", metavar="PATH", required=True, help="folder, or a file that ends in .zip")
    data.set_defaults(command=_data)

    gold = parts.add_parser("gold", help="write gold files for a regression harness",
                            description="Write a problem's targets of contact, stick zone and tractions with "
                            "tolerances: a test for pytest, a row of values with the comparison file of MOOSE's "
                            "CSVDiff, or JSON.",
                            examples=["partialslip benchmark gold PS-02 --for pytest",
                                      "partialslip benchmark gold PS-02 --for csvdiff --grade B"])  # fmt: skip
    gold.add_argument("problem", metavar="PROBLEM", help="number of the problem")
    gold.add_argument("--for", dest="form", metavar="HARNESS", required=True, help="pytest, csvdiff or json")
    gold.add_argument("--grade", default="C", metavar="GRADE", help="whose limit is the tolerance: A to D (default: C)")
    gold.add_argument("-o", "--out", metavar="DIR", default="gold", help="folder for the files (default: gold)")
    gold.set_defaults(command=_gold)

    builds = parts.add_parser("build", help="write the book",
                              description="Write the book of problems, book.html and book.pdf, a zip of plain data, "
                              "meshes and decks, and a scoreboard and badges of the given answers.",
                              examples=["partialslip benchmark build",
                                        "partialslip benchmark build my-answers results/benchmark-march"])  # fmt: skip
    builds.add_argument("folders", nargs="*", default=[], metavar="FOLDER", help="folders with answers")
    builds.add_argument("--problems", metavar="NUMBERS", help=_PROBLEMS)
    add_pdf(builds, "refuse if WeasyPrint is missing; without --pdf, book.pdf is then left out")
    add_out(builds, "results/benchmark[-HASH]")
    builds.set_defaults(command=_build, overrides=[])


def _list(_: argparse.Namespace) -> int:
    from partialslip.cli.consoles import output
    from partialslip.tools.output.tables import print_table
    from partialslip.verify.benchmark import read_problems, read_statements

    table = [(each.number, each.title, each.regime, str(len(each.targets))) for each in read_problems().values()]
    table += [(each.number, each.title, "statement", str(len(each.targets))) for each in read_statements().values()]
    print_table(output(), ("", "problem", "regime", "targets"), table, words=(0, 1, 2))
    return 0


def _run(options: argparse.Namespace) -> int:
    from partialslip.cli.consoles import counting, output
    from partialslip.verify.benchmark.codes import code_answers, installed
    from partialslip.verify.benchmark.problem import chosen_problems
    from partialslip.verify.benchmark.submission import META

    check_output(options)
    installed(options.code)
    some, name = chosen_problems(options.problems), f"benchmark-{options.code}"
    with (
        results_folder(options, "benchmark", name, None, {}, lambda: {"code": options.code}) as (folder, elsewhere),
        counting(options.code) as progress,
    ):
        found = code_answers(options.code, some, progress, folder)
    console = output()
    code = _print_grades(found, some)
    print_written([folder / META, *(folder / f"{number}.json" for number in found.answers)], console, elsewhere)
    return code


def _read(options: argparse.Namespace) -> int:
    from partialslip.cli.consoles import output
    from partialslip.verify.benchmark.problem import numbered
    from partialslip.verify.benchmark.submission import Answer, add_answer
    from partialslip.verify.benchmark.tables import completed, read_table

    problem, named = numbered(options.problem), options.code is not None
    code = options.code if named else Path(options.files[0]).stem
    table = read_table(
        problem, options.files, columns_of(options.columns), where_of(options.where), factors_of(options.factors)
    )
    for note in table.notes:
        output().print(note, soft_wrap=True, markup=False)
    print_written(
        add_answer(problem.number, completed(Answer({}), table), options.out, code, named, options.force), output()
    )
    return 0


def _score(options: argparse.Namespace) -> int:
    from partialslip.verify.benchmark import read_problems, read_statements, read_submission
    from partialslip.verify.benchmark.problem import chosen_problems

    some: dict[str, Posed] = {**chosen_problems(options.problems)}
    if options.problems is None:
        some |= read_statements()
    return _graded(read_submission(options.folder, {**read_problems(), **read_statements()}), some)


def _check_submission(options: argparse.Namespace) -> int:
    from partialslip.cli.consoles import output
    from partialslip.tools.errors import one_line
    from partialslip.verify.benchmark import handed_in, read_problems, read_statements

    known: dict[str, Posed] = {**read_problems(), **read_statements()}
    submission, wrong = handed_in(options.folder, known)
    for line in wrong:
        output().print(one_line(line), markup=False, soft_wrap=True)
    if submission is None:
        raise InputError(f"{options.folder}: not accepted: {len(wrong)} thing{'s' * (len(wrong) > 1)} to correct")
    code = _graded(submission, known)
    more = ", but problems that are not judged do not count (exit code 4)" if code else ""
    output().print(f"accepted: {options.folder} can be handed in{more}", markup=False, soft_wrap=True)
    return code


def _graded(submission: "Submission", some: "Mapping[str, Posed]") -> int:
    """Print grades, ladders and remarks on tables of a submission. Returns the exit code of :func:`_print_grades`."""
    from partialslip.cli.consoles import output
    from partialslip.tools.output.tables import print_table
    from partialslip.verify.benchmark import CLIMB_HEADS, climb_rows

    code = _print_grades(submission, some)
    every = len(some) == 1
    rows = [
        (number, *row)
        for number, answer in submission.answers.items()
        if number in some
        for row in climb_rows(some[number], answer, every)
    ]
    if rows:
        output().print(
            "ladders: error of the finest mesh, order, and what follows, in the scales of the targets", soft_wrap=True
        )
        print_table(output(), ("", *CLIMB_HEADS), rows, words=(0, 1))
    for line in submission.remarks:
        output().print(line, markup=False, soft_wrap=True)
    return code


def _print_grades(submission: "Submission", some: "Mapping[str, Posed]") -> int:
    """Print the grades of a submission, with the target that decides. Returns the exit code: 4 if an answer lacks a
    headline target."""
    from partialslip.cli.consoles import output
    from partialslip.run.judge.verdicts import UNJUDGED
    from partialslip.tools.output.tables import print_table
    from partialslip.verify.benchmark.grade import NOT_GRADED, NOT_OFFERED
    from partialslip.verify.benchmark.measured import GROUPS
    from partialslip.verify.benchmark.scoreboard import grades, standing

    console, table, lacking = output(), [], list[str]()
    titled, short = console.width >= _TITLED, {NOT_OFFERED: "-", NOT_GRADED: "?"}
    for number, found in grades(some, submission).items():
        worst, answer = found.overall, submission.answers[number]
        error = "" if worst.error is None else f"{worst.error:.2e}"
        own = "" if worst.estimate is None else f"{worst.estimate:.0e}"
        groups = [found.groups[group].grade if group in found.groups else "" for group in GROUPS]
        spent = "" if answer.cpu_s is None else f"{answer.cpu_s:.2g}"
        if not found.counts:
            lacking.append(f"{number} ({', '.join(found.lacks) if found.answered else 'no values'})")
        graded = [short.get(grade, grade) for grade in (worst.grade, *groups)]
        table.append((number, *([some[number].title] if titled else []), *graded, worst.worst, error, own, spent))
    console.print(f"{submission.meta.code} {submission.meta.version}", markup=False)
    heads = ("", *(["problem"] if titled else []), "grade", *GROUPS, "worst", "error", "+-", "CPU s")
    print_table(console, heads, table, words=range(len(heads) - 3))
    used = [f"{mark}: {grade}" for grade, mark in short.items() if any(mark in row for row in table)]
    if used:
        console.print("; ".join(used), markup=False)
    whole = standing(submission)
    told = "; ".join(group.text for group in whole.groups)
    console.print(f"{whole.counted} of {whole.of} problems count: {told}", markup=False, soft_wrap=True)
    if lacking:
        console.print(f"not judged: {', '.join(lacking)}", markup=False, soft_wrap=True)
    return UNJUDGED if lacking else 0


def _data(options: argparse.Namespace) -> int:
    from datetime import date

    from partialslip.cli.consoles import output
    from partialslip.tools.output.files import write_files, zipped
    from partialslip.verify.benchmark import read_problems
    from partialslip.verify.benchmark.data import data_files

    files, path = data_files(read_problems(), date.today()), Path(options.out)
    if path.suffix == ".zip":
        write_files(path.parent, {path.name: lambda made: made.write_bytes(zipped(files))})
    else:
        write_files(path, {name: partial(_write_bytes, content) for name, content in files.items()})
    output().print(f"written: {len(files)} files in {path}", markup=False, soft_wrap=True)
    return 0


def _write_bytes(content: bytes, path: Path) -> None:
    path.write_bytes(content)


def _gold(options: argparse.Namespace) -> int:
    from partialslip.cli.consoles import output
    from partialslip.tools.output.files import write_texts
    from partialslip.verify.benchmark.gold import gold_files
    from partialslip.verify.benchmark.problem import numbered

    texts = gold_files(numbered(options.problem), options.form, options.grade)
    print_written(write_texts(Path(options.out), texts), output())
    return 0


def _build(options: argparse.Namespace) -> int:
    from partialslip.cli.common import origin
    from partialslip.cli.consoles import output
    from partialslip.tools.errors import MissingLibraryError
    from partialslip.tools.output.files import write_files, write_texts
    from partialslip.tools.output.page import check_pdf, write_pdf
    from partialslip.verify.benchmark import badge, badge_names, book_page, book_zip, read_problems, read_submission
    from partialslip.verify.benchmark.problem import chosen_problems

    check_output(options)
    some = chosen_problems(options.problems)
    submissions = [read_submission(folder, read_problems()) for folder in options.folders]
    names = badge_names(submissions)
    with results_folder(options, "benchmark", "benchmark", None) as (folder, elsewhere):
        html, data = book_page(some, submissions, origin(options)), book_zip(some)
        badges = dict(zip(names, map(badge, submissions), strict=True))
        files = write_texts(Path(folder), {"book.html": html} | badges)
        files += write_files(Path(folder), {"problems.zip": lambda path: path.write_bytes(data)})
        try:
            check_pdf("book.pdf")
        except MissingLibraryError:
            if options.pdf:
                raise
        else:
            files += write_pdf(html, Path(folder), "book.pdf")
    print_written(files, output(), elsewhere)
    return 0
