"""The book of the benchmark: a page with all problems and the scoreboard, and a zip of plain data."""

from collections.abc import Mapping, Sequence
from importlib.metadata import version
from importlib.resources import files as resources
from typing import Any

import msgspec

from partialslip.report import rows
from partialslip.report.sketch import sketch_svg
from partialslip.scene.reading import scene_toml, set_tables
from partialslip.tools.origin import Made, origin_lines
from partialslip.tools.output.files import csv_text, json_text, zipped
from partialslip.tools.output.page import render_page
from partialslip.verify.benchmark.figure import problem_svg
from partialslip.verify.benchmark.grade import LIMITS
from partialslip.verify.benchmark.ladder import CLIMB_HEADS, climb_rows
from partialslip.verify.benchmark.neutral import files as model_files
from partialslip.verify.benchmark.problem import EDITION, SETTINGS, Problem, read_frozen
from partialslip.verify.benchmark.scoreboard import Board, scoreboard
from partialslip.verify.benchmark.submission import Submission

_IDLE = ("steps", "sigma_slope")  # display: keys of loads: a setting of partialslip, and zero in all problems
_COLUMNS = 8  # display: codes side by side in a scoreboard


def book_page(problems: Mapping[str, Problem], submissions: Sequence[Submission], made: Made) -> str:
    """The book as HTML: all ``problems`` by number, a scoreboard of the ``submissions`` if there are any, and how it
    was ``made``."""
    return render_page(
        "partialslip.verify.benchmark",
        "book.html",
        title=f"Benchmark of frictional contact, edition {EDITION}",
        origin=origin_lines([made]),
        limits=LIMITS,
        boards=_boards(problems, submissions),
        codes=[_code(submission) for submission in submissions],
        overview=[_overview(problem) for problem in problems.values()],
        problems=list(problems.values()),
        sketches={number: sketch_svg(problem.scene) for number, problem in problems.items()},
        figures={number: problem_svg(problem, submissions) for number, problem in problems.items()},
        data={number: _data(problem) for number, problem in problems.items()},
        targets={number: _targets(problem) for number, problem in problems.items()},
        ladders={number: _ladders(problem, submissions) for number, problem in problems.items()},
        climb_heads=("code", *CLIMB_HEADS),
        edition=EDITION,
        checksums=read_frozen().checksums,
    )


def book_zip(problems: Mapping[str, Problem]) -> bytes:
    """The ``problems`` by number as plain data, a zip that stands alone: how to take part, a workflow that grades
    answers, and for each problem a JSON file with everything, scene as TOML, targets as CSV, meshes and decks."""
    package = resources("partialslip.verify.benchmark")
    readme = (package / "zip_readme.txt").read_text("utf-8")
    limits = ", ".join(f"{grade} {limit:g}" for grade, limit in LIMITS.items())
    listed = "\n".join(f"{number}  {problem.title}" for number, problem in problems.items())
    content = {
        "README.txt": readme.format(
            edition=EDITION, version=version("partialslip"), limits=limits, problems=listed
        ).encode()
    }
    content["grade.yml"] = (package / "grade.yml").read_bytes()
    checksums = read_frozen().checksums
    for number, problem in problems.items():
        own = {name: text.encode() for name, text in _files(problem, checksums[number]).items()} | model_files(problem)
        content |= {f"{number}/{name}": data for name, data in own.items()}
    return zipped(content)


def _files(problem: Problem, checksum: str) -> dict[str, str]:
    a = problem.targets["a"].value
    listed = [
        (key, {"x": float(place) * a} if (place := key.partition("@")[2]) else {}, target)
        for key, target in problem.targets.items()
    ]
    everything = {
        "number": problem.number,
        "edition": EDITION,
        "checksum": checksum,
        "title": problem.title,
        "statement": problem.statement,
        "sources": msgspec.to_builtins(problem.sources),
        "remark": problem.why,
        "data": _given(set_tables(problem.scene, SETTINGS)),
        "targets": {key: placed | msgspec.to_builtins(target) for key, placed, target in listed},
    }
    columns = ("value", "unit", "scale", "uncertainty", "group", "known")
    lines = [[key, placed.get("x"), *(getattr(target, name) for name in columns)] for key, placed, target in listed]
    return {
        "problem.json": json_text(everything),
        "scene.toml": scene_toml(problem.scene, SETTINGS),
        "targets.csv": csv_text(("key", "x", *columns), lines),
    }


def _given(tables: dict[str, Any]) -> dict[str, Any]:
    """``tables`` of a scene without the keys that are no part of the problem."""
    load = {key: value for key, value in tables["load"].items() if key not in _IDLE}
    return tables | {"load": load}


def _boards(problems: Mapping[str, Problem], submissions: Sequence[Submission]) -> list[Board]:
    """Scoreboards of a few codes each, which fit on a page."""
    count = -(-len(submissions) // _COLUMNS)
    each = -(-len(submissions) // count) if count else 1
    return [scoreboard(problems, submissions[first : first + each]) for first in range(0, len(submissions), each)]


def _code(submission: Submission) -> tuple[str, ...]:
    meta = submission.meta
    return (f"{meta.code} {meta.version}".strip(), meta.settings, meta.machine, meta.author)


def _ladders(problem: Problem, submissions: Sequence[Submission]) -> list[tuple[str, ...]]:
    """Rows of what ladders of meshes say of ``problem``, with the code in front."""
    return [
        (submission.meta.code, *row)
        for submission in submissions
        if problem.number in submission.answers
        for row in climb_rows(problem, submission.answers[problem.number])
    ]


def _overview(problem: Problem) -> Sequence[str]:
    a = problem.targets["a"].value
    ends = [f"{problem.targets[key].value / a:.6f}" if key in problem.targets else "–" for key in ("m", "n")]
    return (problem.number, problem.title, problem.regime, f"{a * 1e3:.6g}", *ends)


def _data(problem: Problem) -> list[tuple[str, str, str]]:
    """Data of a problem: rows of table, key and value, without settings of partialslip."""
    found, table = [], ""
    for line in rows.settings(problem.scene):
        table = line[0] or table
        if table not in SETTINGS and line[1] not in _IDLE:
            found.append(line)
    return found


def _targets(problem: Problem) -> list[tuple[str, ...]]:
    return [
        (key, each.group, f"{each.value:.12g} {each.unit}", f"{each.scale:.6g}", f"{each.uncertainty:.0e}", each.known)
        for key, each in problem.targets.items()
    ]
