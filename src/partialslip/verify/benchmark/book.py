"""The book of the benchmark: a page with all problems and the scoreboard, and a zip of plain data."""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from importlib.metadata import version
from importlib.resources import files as resources
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import isotonic_regression

from partialslip.report import rows
from partialslip.report.figure import draw_tractions
from partialslip.report.sketch import sketch_svg
from partialslip.result import Result
from partialslip.run import run
from partialslip.run.judge.reference import reference
from partialslip.scene.reading import scene_toml
from partialslip.tools.origin import Made, origin_lines
from partialslip.tools.output.files import json_text, zipped
from partialslip.tools.output.page import render_page
from partialslip.tools.output.svg import svg
from partialslip.verify.benchmark.data import IDLE, problem_data, targets_csv
from partialslip.verify.benchmark.grade import LIMITS, graded
from partialslip.verify.benchmark.ladder import CLIMB_HEADS, climb_rows
from partialslip.verify.benchmark.neutral import files as model_files
from partialslip.verify.benchmark.problem import EDITION, SETTINGS, Problem, read_frozen
from partialslip.verify.benchmark.scoreboard import Board, scoreboard
from partialslip.verify.benchmark.submission import Submission

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_ACCURACY = 1e-3  # display: of a drawn curve, far below the width of a line
_PLACED = ("p", "q1", "q2", "dq")
_CHANGE = "dq/(2 f p0)"  # display: name of the shear, of which dq is the target
_GREYS = ("1.0", "0.93", "0.82", "0.66", "0.4")  # display: cells of the grades A to E
_DARK = 4  # display: grade, counted from A, from which on the text of a cell is white
_WIDTH = 7.4  # display: inches
_ABOVE, _ROW, _AXIS = 3.1, 0.2, 0.7  # display: height of the tractions, of a code, and of the axis below, inches
_CELL = 19.0, 11.0  # display: width and height of a cell, points
_APART = 0.1  # display: least distance of two columns of cells, in a: more than the width of a cell

ErrorsByResolution = Mapping[str, Mapping[float, float]]
_COLUMNS = 8  # display: codes side by side in a scoreboard


def problem_svg(problem: Problem, submissions: Sequence[Submission]) -> str:
    """Return the figure of ``problem`` as SVG: above, p and q of the targets over x/a, the stick zone, and the targets
    as points; below, the errors of the ``submissions`` that have tractions."""
    errors = errors_along(problem, submissions)
    result = _asked(problem)

    def draw(figure: "Figure") -> None:
        heights = (_ABOVE, _ROW * len(errors)) if errors else (_ABOVE,)
        above, *below = np.ravel(figure.subplots(len(heights), 1, sharex=True, height_ratios=heights))
        _draw_targets(above, problem, result)
        for axes in below:
            above.set_xlabel("")
            _draw_errors(axes, errors)

    size = (_WIDTH, _ABOVE + _ROW * len(errors) + (_AXIS if errors else 0.0))
    return re.sub("font-family: [^;]*sans-serif;", "font-family: sans-serif;", svg(draw, size))  # a third of the bytes


def errors_along(problem: Problem, submissions: Sequence[Submission]) -> dict[str, dict[float, float]]:
    """Errors of codes along the contact.

    Parameters
    ----------
    problem : Problem
    submissions : sequence of Submission

    Returns
    -------
    dict of str to dict of float to float
        By code and version, then by x/a: the largest error of p, q1, q2 and dq there, in the scales of the targets.
        Codes without any traction are left out.
    """
    found: dict[str, dict[float, float]] = {}
    for submission in submissions:
        answer = submission.answers.get(problem.number)
        along: dict[float, float] = {}
        for key, error in (graded(problem, answer).errors if answer else {}).items():
            name, _, place = key.partition("@")
            if name in _PLACED and place:
                along[float(place)] = max(error, along.get(float(place), 0.0))
        if along:
            found[f"{submission.meta.code} {submission.meta.version}".strip()] = along
    return found


def _asked(problem: Problem) -> Result:
    """Solve ``problem`` for its curves. What no target asks for is left out: a stick zone, and shear."""
    scene = problem.scene.replace(fem={"accuracy": _ACCURACY}, effects={"subsurface": False}, fatigue={})
    method = "exact" if reference(scene).method == "exact" else "fem"
    result = run(scene, method)[method]
    # without cells a mesh is drawn as lines, too: markers here are targets
    traction = replace(result.traction, cells=None)
    if not any(key.startswith("dq@") for key in problem.targets):
        traction = replace(traction, values=traction.values._replace(dq=np.zeros_like(traction.x), p1=None))
    centre, half_width = None, None
    if {"m", "n"} <= problem.targets.keys():
        m, n = (problem.targets[key].value for key in ("m", "n"))
        centre, half_width = (n - m) / 2, (n + m) / 2
    return replace(result, traction=traction, stick_centre=centre, stick_half_width=half_width)


def _draw_targets(axes: "Axes", problem: Problem, result: Result) -> None:
    draw_tractions(axes, {"targets": result}, problem.scene.friction, _CHANGE)
    for name in ("p", "dq"):  # the scale of dq is 2 f p0: drawn is q = dq/2, in f p0
        some = {place: target for place in problem.places if (target := problem.targets.get(f"{name}@{place:g}"))}
        heights = [target.value / target.scale for target in some.values()]
        axes.plot(list(some), heights, "o", ms=4, color="black", zorder=3)


def _draw_errors(axes: "Axes", errors: ErrorsByResolution) -> None:
    """Draw a row for each code, with the error as a number at each place, on the grey of its grade."""
    from matplotlib.path import Path

    columns = _columns({place for along in errors.values() for place in along})
    cells = [
        (columns[place], row, error) for row, along in enumerate(errors.values()) for place, error in along.items()
    ]
    x, rows, sizes = np.array(cells).T
    grade = np.searchsorted(list(LIMITS.values()), sizes)
    corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)]) * _CELL
    greys = [_GREYS[each] for each in grade]
    axes.scatter(x, rows, s=_CELL[0] ** 2, c=greys, marker=Path(corners, closed=True), lw=0)
    for column, row, size, each in zip(x, rows, sizes, grade, strict=True):
        color = "white" if each >= _DARK else "black"
        text = axes.text(column, row, _error_text(size), color=color, fontsize=7, ha="center", va="center")
        text.set_in_layout(False)  # it lies inside the axes
    for place, column in columns.items():
        axes.plot([place, column], [-1.4, -0.5], color="0.7", lw=0.6, clip_on=False)
    axes.set(xlabel="x/a", ylim=(len(errors) - 0.5, -0.5))
    axes.set_yticks(range(len(errors)), [code.replace("$", r"\$") for code in errors], fontsize=8)
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)


def _columns(places: Iterable[float]) -> dict[float, float]:
    """Return the x/a of the column of each place: the place itself, unless columns would be too near to each other."""
    known = sorted(places)
    shifts = _APART * np.arange(len(known))
    return dict(zip(known, (isotonic_regression(known - shifts).x + shifts).tolist(), strict=True))


def _error_text(error: float) -> str:
    """Return an error in at most four characters: 2e-3, and "0" below 1e-9."""
    if error < 1e-9:
        return "0"
    return f"{error:.0e}".replace("e-0", "e-").replace("e+0", "e")


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
    package_statements = (package / "statements").iterdir()
    content |= {f"statements/{each.name}": each.read_bytes() for each in sorted(package_statements, key=str)}
    for number, problem in problems.items():
        texts = {
            "problem.json": json_text(problem_data(problem)),
            "scene.toml": scene_toml(problem.scene, SETTINGS),
            "targets.csv": targets_csv(problem),
        }
        own = {name: text.encode() for name, text in texts.items()} | model_files(problem)
        content |= {f"{number}/{name}": data for name, data in own.items()}
    return zipped(content)


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
        if table not in SETTINGS and line[1] not in IDLE:
            found.append(line)
    return found


def _targets(problem: Problem) -> list[tuple[str, ...]]:
    return [
        (key, each.group, f"{each.value:.12g} {each.unit}", f"{each.scale:.6g}", f"{each.uncertainty:.0e}", each.known)
        for key, each in problem.measured.items()
        if key in problem.targets
    ]
