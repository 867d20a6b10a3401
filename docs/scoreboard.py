"""Regenerate the page of the scoreboard: python docs/scoreboard.py writes scoreboard.md from benchmarks/submissions,
benchmarks/start.json and benchmarks/peers/increments.jsonl."""

import functools
import json
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from textwrap import fill
from typing import Any

import numpy as np

from partialslip.halfplane import contact
from partialslip.halfplane.turning import half_cycle
from partialslip.verify.benchmark import (
    Answer,
    Problem,
    Submission,
    read_problems,
    read_submission,
    scoreboard,
    standing,
)
from partialslip.verify.benchmark.codes import CODES, Own
from partialslip.verify.benchmark.grade import Mark, best_grade, graded
from partialslip.verify.benchmark.measured import GROUPS
from partialslip.verify.benchmark.problem import EDITION

DOCS = Path(__file__).parent
SUBMISSIONS = DOCS.parent / "benchmarks" / "submissions"
START = DOCS.parent / "benchmarks" / "start.json"
INCREMENTS = DOCS.parent / "benchmarks" / "peers" / "increments.jsonl"
NAMES = {  # short titles of the problems, as rows have at most 120 characters
    "PS-01": "Hertz",
    "PS-02": "Cattaneo, Mindlin",
    "PS-03": "small tension",
    "PS-04": "near the transition",
    "PS-05": "large tension",
    "PS-06": "zone off the middle",
    "PS-07": "zone of 1e-4 a",
    "PS-08": "near sliding",
    "PS-09": "near stuck",
    "PS-10": "flat, small tension",
    "PS-11": "flat, large tension",
    "PS-12": "table of a profile",
    "PS-13": "plane stress",
    "PS-14": "nu = 0.4999",
    "PS-15": "mean loads",
    "PS-16": "settling",
    "PS-17": "ratcheting",
    "PS-18": "out of phase",
    "PS-19": "varying P, ends slip",
    "PS-20": "varying P, ends stick",
    "PS-21": "varying M",
    "PS-22": "unlike, sheared",
    "PS-23": "two blocks",
    "PS-24": "pad on a specimen",
    "PS-25": "unlike, pressed",
    "PS-26": "meshes do not match",
    "PS-27": "slip turns round",
}
COLUMNS = 4  # codes of partialslip side by side
EQUAL = (  # ours, size of its elements in a, and codes that have elements of this size and order along the contact
    ("partialslip fem-P1", 0.1, ("kratos",)),
    ("partialslip fem-P1", 0.05, ("calculix-mortar", "calculix-penalty")),
    ("partialslip fem-P1", 0.05, ("opensees",)),
    ("partialslip fem-P2", 0.05, ("getfem",)),
)
BARS = (1e-3, 4e-3, 1e-2)  # errors of a that are counted
PLACE = -0.8  # x/a, as in benchmarks/peers/increments.py

_HEAD = """\
# Scoreboard

Grades of codes on the [problems of the benchmark](howto/benchmark.md), edition {edition}, from A (every target within
1e-4) to E (beyond 5e-2), with CPU seconds in brackets. A dash: the code does not offer the problem, or one of the
targets, or there was no time to run it. *none*: the code did not converge; the note in its answer tells where. *At
best* is the highest grade that the uncertainty of the targets allows: no code can have a better one. This project ran
all codes, with adapters of its own; their authors did not tune them.

**Seconds.** All codes ran on one machine of two cores ({machine}), but not under equal conditions: partialslip alone,
one process of one thread at a time; the others up to two at a time and beside tests of partialslip, which costs 5 to
10 % ([measured](cost.md) with GetFEM). CPU seconds of
CalculiX, GetFEM, Kratos and OpenSees are of their whole process, without the meshes, which partialslip makes; those of
`getfem-graded` count the first run, which finds the ends. Methods of partialslip answered in a process that was warm.
The first number is the solution, meshes included (P1 and P2: of the finest mesh). The second number adds the start,
Python and libraries, measured first (`benchmarks/start.py`): {starts} CPU s. Only it should be compared with other
codes. Repeated runs differ by a tenth and more. CalculiX solves slices of three dimensions, two layers of nodes held in
plane strain: twice the unknowns that a plane code has on the same mesh. The answers are in `benchmarks/submissions`.

The table below them has, for each code, the number of problems that count (every target of contact, stick and tractions
has a value), and the worst grade of each group of targets. "1 not offered": one problem with other values lacks values
of the group.

"""

_WRONG = """

## What each code gets wrong

Versions and settings are those of the tables above. All codes but partialslip have elements of 0.05 a along the contact
(Kratos: 0.1 a). No target at one point can be better than such elements allow: next to the ends of contact and stick
zone, where tractions fall like a square root, an error of 1 to 2 % is that of the elements. The elements are choices of
our adapters: C3D8 in CalculiX, `quad` in OpenSees, SmallDisplacementElement2D4N in Kratos, Q2 in GetFEM. The codes have
others, which were not run. What is wrong here is wrong in these versions with these elements, settings and meshes.

{right}

- **CalculiX 2.20, penalty contact** (1000 E/a on overlap, 100 E/a on stick, which the export chose). q depends on the
  stiffness of sticking, which the user chooses ([how much](symptoms.md#which-stiffness)), and on the state before:
  after the load has turned round, q is off by 0.2 f p0 next to the stick zone in PS-03. With the table of PS-12, a is
  2.4 % too wide, without a message, while GetFEM finds a to 1e-3 on the same mesh. At nu = 0.4999 (PS-14) nodal
  pressures scatter so much that no contact can be told. In PS-06, PS-07, PS-17 and PS-27 increments are cut until it
  gives up. Varying P (PS-19, PS-20), a contact that rocks (PS-21), bodies of a size (PS-23, PS-24) and unlike materials
  (PS-22, PS-25) converge.
- **CalculiX 2.20, mortar contact** (hard pressure, 1e5 E/a on stick). It converges where penalties give up. q is right
  to 1 % where it does not fall steeply. Next to a stick zone of 1e-4 a (PS-07) no element is small enough. It depends
  on the unit of length: a was off by 30 % at a = 1e-3 units, 5 % at 0.1 and 0.2 % at 1, without a message. The decks
  use units in which a is 100 or more, to be safe ([calculix](howto/calculix.md)).
- **GetFEM 5.4.2** (linear multipliers, constant of the augmented conditions E/a). One script serves all problems. On
  uniform meshes the grade is that of the last element in the contact: p at 0.9 a is off by 1.5 %. At the corners of the
  flat (PS-10, PS-11), where elements are fine, the linear multipliers overshoot and p_max is 7 % too large. At nu =
  0.4999 (PS-14) m is off by 0.16 a. Meshes graded to the ends that a first run found give one to three grades more, at
  three to five times the cost, but not in PS-04, whose left slip zone is 0.0017 a wide, and in PS-26.
- **Kratos 10.4.4, mortar contact** (augmented Lagrangian, tangent_factor 1, 8 increments). When the load turns round,
  the state of nodes beside the stick zone goes wrong without a message: in PS-05 dq is off by 0.8 of 2 f p0. Kratos'
  own factor of the tangential penalty (tangent_factor = 0.025) makes this worse; the adapter takes 1. In PS-06, PS-17
  and PS-23 Newton's method converges with 16 increments only, in two of them to a stick zone that is far off. With
  tension in PS-03, near sliding (PS-08), at nu = 0.4999 (PS-14) and in the third cycle of PS-16 it converges with
  neither. The adapter does not turn bodies (PS-21).
- **OpenSees 3.7.1** (OpenSeesPy 3.7.1.2; SimpleContact2D with multipliers, ContactMaterial2D with 1000 E/a on stick, 8
  increments). Where it converges, it is as right as CalculiX's mortar contact on the same mesh. It does so with tension
  (PS-03, PS-05, PS-06), near sliding (PS-08), over many cycles (PS-16, PS-17), out of phase (PS-18), under varying P
  (PS-19, PS-20), for the pad on the pulled specimen (PS-24), and with 64 increments where slip turns round (PS-27: dq
  to 5e-3). Convergence hangs on details: PS-02, PS-07, PS-15 and PS-17 need 16 increments, PS-02 those or elements of
  0.049 or 0.051 a. No stick zone can be told from its tractions in PS-09, whose slip zones are narrower than an
  element, in PS-20 and in PS-27, so that these do not count. It does not converge while unlike bodies are pressed
  (PS-22, PS-25). At nu = 0.4999 (PS-14) `quad` locks: pressure stands on single nodes, 4.6 p0 too high, without a
  message. The element finds contact one increment late; the adapter therefore repeats an increment under the same loads
  until the multipliers rest. The handler "Transformation" keeps one tie of a node without a message: a body whose nodes
  were tied along x and y by two commands tilted. The adapter does not turn bodies (PS-21) and needs meshes that match
  (PS-26).
- **partialslip.** Linear and quadratic elements of one size (P1, P2) lose a grade or two where the contact has corners
  (PS-10, PS-11) and where nu = 0.4999 (PS-14). The marching method has the exact pressure, so its errors are those of q
  alone.

## Codes that were looked at

OpenSees was chosen among these. A code needs finite elements and Coulomb friction, and a package that installs. Not
run, or given up: OpenSees' zeroLengthContact2D, which forgets at the end of an increment what a node that slips
carries, and zeroLengthContactASDimplex; Akantu 5.0.7 (CouplerSolidContact, penalty_linear); Tamaas and SlipPY
(half-spaces, no finite elements); Elmer, Code_Aster, Feel++ and FEBio (no package of the solver in Debian 12 or on
PyPI).
"""

_EQUAL = """
## At equal resolution

Methods of partialslip that are asked for an accuracy choose their meshes; the other codes have elements of one size
along the contact. Here partialslip has elements of one size, too: linear ones beside Kratos, CalculiX and OpenSees,
quadratic ones beside GetFEM. A cell has the largest error among the targets of contact, stick and tractions, in the
scales of the targets, the target that it is of, and the CPU seconds of a whole process. Rows that no other code answers
are left out. One thing is not equal: at the corners of the flat (PS-10, PS-11) the meshes of the other codes are
finer than along the rest of the contact, and ours are not.

{tables}

{told}
"""

_LEARNT = """
**What to learn from it.** Of {common} problems that both answer ({names}), ours has the smaller error in {smaller}. Our
error over theirs goes from {least} to {most}; the largest ratios are at the corners of the flat, where their meshes are
finer. Most of these errors are those of the last elements beside the ends of contact and stick zone. What the first
tables show for partialslip comes from where its meshes have small elements, and from loads that it follows without
increments.
"""

_ROW = "| " + " | ".join(["{}"] * 10) + " |"

_TURNS = """
## How many increments: PS-27

In PS-27 slip turns round on the way from load point to load point: the stick zone moves to the left and takes points
back that have slipped ([theory](theory.md), section 7). The state at a load point is that of loads that change
gradually; one increment from load point to load point has another one. Codes count slip from the start of an increment,
so the number of increments decides. The elements are those of the table above.

{table}

- **m/a** is read as `partialslip score` reads it, from points at which |dq| begins to leave the friction bound like a
  square root. At an end that has drifted it does not: 2 f p - |dq| grows like (x + m)^(3/2), and what is there is
  easily taken for the scatter of a slip zone. The grades above are of this reading.
- **m/a, drifted** is a straight line through (1 - |dq|/(2 f p))^(2/3) at the points where the bracket is between 0.01
  and 0.17, extended to zero. A dash: fewer than two points tell. From exact tractions it is 0.01 too large.
- **room** is 1 - |dq|/(2 f p) at x = -0.8 a, a point that one step lets slip; above 1, dq has the wrong sign. It needs
  no reading of ends.

**What to learn from it.** With one increment per half cycle, converged and without a message, CalculiX's mortar contact
and GetFEM find the state of one step: m is 0.71 a, and 0.72 a in the exact solution of one step, where gradual loads
have 0.89 a. With 8 increments the point at -0.8 a sticks again, with three quarters of its room; with 64 the room is
right to 5 %, and m, read for a drifted end, to 0.01 a, which is what this reading allows. n looks right with each
number of increments that was tried, and so gives no warning. Where slip may turn round (under Hertz, large tension with
Q_f above 0.5601 always does), compare 8 increments with 64, not with 1, and look at the traction just inside the zone
rather than at its end. CalculiX with penalties gives up at the third load point whatever the increments. Kratos and
OpenSees do not converge with 1 and 8. With 64 OpenSees finds the right state, as CalculiX's mortar contact and GetFEM
do. Kratos then converges, on elements twice as wide, to a wrong state, without a message: dq has the wrong sign at
-0.8 a.

`python benchmarks/peers/increments.py` measures the rows, for the codes that are installed.
"""


def page() -> str:
    """Content of the page."""
    problems = read_problems()
    found = [read_submission(folder, problems) for folder in sorted(SUBMISSIONS.iterdir())]
    own = [each for each in found if each.meta.code.startswith("partialslip ")]
    others = [each for each in found if each not in own]
    parts = [*(own[first : first + COLUMNS] for first in range(0, len(own), COLUMNS)), others]
    firsts = [chr(ord("a") + sum(map(len, parts[:number]))) for number in range(len(parts))]
    tables = [_table(problems, part, first) for part, first in zip(parts, firsts, strict=True)]
    runs = [json.loads(line) for line in INCREMENTS.read_text("utf-8").splitlines()]
    table = _increments(problems["PS-27"], runs)
    wrong = _WRONG.format(right=_right(problems, others))
    return _head(found) + "\n".join([*tables, _standings([*own, *others])]) + _equal(problems, found) + wrong + table


def _head(found: Sequence[Submission]) -> str:
    """Head of the page: what the grades and the seconds of the codes ``found`` are."""
    told = _start()
    starts = ", ".join(f"{seconds:.2g} ({method})" for method, seconds in told["start"].items())
    machines = {told["machine"], *(each.meta.machine for each in found)}
    assert len(machines) == 1, f"one machine is told, not {machines}"
    text = _HEAD.format(edition=EDITION, starts=starts, machine=told["machine"])
    return "\n\n".join(fill(part, 120, break_on_hyphens=False) for part in text.strip().split("\n\n")) + "\n\n"


def _increments(problem: Problem, runs: Sequence[Mapping[str, Any]]) -> str:
    """Table of ``runs`` with a few or many increments, between what is right and what one step gives, and what it
    says."""
    scene, targets = problem.scene, problem.targets
    pressed, f = contact(scene), scene.friction.f
    found = half_cycle(pressed, f, scene.load.dQ, scene.load.dsigma)
    m, n = (targets[key].value / targets["a"].value for key in "mn")
    bound = 2 * np.sqrt(1 - PLACE**2)
    right, wrong = (1 - abs(float(way.traction(np.array([PLACE]))[0])) / bound for way in (found, found.once))
    exact = {"m": m, "n": n, "m_drift": m, "room": right}
    step = {"m": -found.once.zone.left, "n": found.once.zone.right, "m_drift": None, "room": wrong}
    rows = [("gradual loads, exactly", "", exact), ("one step, exactly", 1, step)]
    runs = sorted(runs, key=lambda run: (run["code"], run["increments"] or 0))
    rows += [(run["code"], run["increments"] or "own choice", run) for run in runs]
    heads = "code", "increments", "m/a", "error", "m/a, drifted", "error", "n/a", "error", "room", "CPU s"
    lines = [_ROW.format(*heads)]
    lines.append("|---" * 10 + "|")
    for name, count, run in rows:
        if "why" in run:
            cells = ["*none*", *["–"] * 6]
        else:
            ends = (("m", m), ("m_drift", m), ("n", n))
            cells = [cell for key, value in ends for cell in _end(run.get(key), value)]
            cells.append(f"{run['room']:.3f}".replace("-0.000", "0.000"))
        lines.append(_ROW.format(name, count, *cells, f"{run['cpu_s']:.3g}" if "cpu_s" in run else ""))
    return _TURNS.format(table="\n".join(lines))


def _end(found: float | None, value: float) -> tuple[str, str]:
    """An end that was ``found``, in a, and its error."""
    if found is None:
        return "–", "–"
    return f"{found:.4f}", f"{abs(found - value):.1e}" if found != value else "0"


def _equal(problems: Mapping[str, Problem], found: Sequence[Submission]) -> str:
    """Tables of the codes that have elements of one size along the contact, beside ours of that size."""
    by_name = {each.meta.code: each for each in found}
    parts, ratios = [], []
    both: dict[str, str] = {}
    for ours, size, others in EQUAL:
        codes = [_rung(by_name[ours], size), *(by_name[name] for name in others)]
        lines = [f"| problem | {ours}, {size:g} a | " + " | ".join(others) + " |", "|---|" + "---|" * len(codes)]
        smaller = dict.fromkeys(others, "")
        for number, problem in problems.items():
            marks = [_mark(each, problem, number) for each in codes]
            told = [_error(each, mark, number) for each, mark in zip(codes, marks, strict=True)]
            if any(cell != "–" for cell in told[1:]):
                lines.append(f"| {number} {NAMES[number]} | " + " | ".join(told) + " |")
            for name, mark in zip(others, marks[1:], strict=True):
                if mark and marks[0]:
                    smaller[name] += "+" if marks[0].error < mark.error else "-"
                    ratios.append(marks[0].error / mark.error)
        both |= smaller
        counts = (f"{each.count('+')} of {len(each)} problems ({name})" for name, each in smaller.items())
        parts.append("\n".join([*lines, "", fill(f"partialslip has the smaller error in {', '.join(counts)}.", 120)]))
    told = _LEARNT.format(
        common=_listed(len(each) for each in both.values()),
        names=", ".join(both),
        smaller=_listed(each.count("+") for each in both.values()),
        least=f"1/{1 / min(ratios):.0f}",
        most=f"{float(f'{max(ratios):.2g}'):g}",
    )
    return _EQUAL.format(tables="\n\n".join(parts), told=fill(told.strip(), 120, break_on_hyphens=False))


def _listed(numbers: Iterable[int]) -> str:
    """``numbers`` as words of a sentence."""
    *first, last = map(str, numbers)
    return f"{', '.join(first)} and {last}"


def _rung(submission: Submission, size: float) -> Submission:
    """Answers of the ``submission`` with elements of one ``size``, in a, of its ladder."""
    answers = {
        number: Answer(rung.values, rung.cpu_s, rung.unknowns)
        for number, answer in submission.answers.items()
        for rung in answer.ladder
        if rung.h == size
    }
    return Submission(submission.meta, answers)


def _mark(submission: Submission, problem: Problem, number: str) -> Mark | None:
    """What decides the grade of an answer; None without one that counts."""
    answer = submission.answers.get(number)
    found = graded(problem, answer) if answer else None
    return found.overall if found and found.counts else None


def _error(submission: Submission, mark: Mark | None, number: str) -> str:
    """Error that the ``mark`` of an answer is of, and seconds of a whole process."""
    answer = submission.answers.get(number)
    if answer and not answer.values:
        return "*none*"
    if mark is None:
        return "–"
    return f"{mark.error:.1e} ({mark.worst}; {_seconds(submission, number)})"


def _standings(found: Sequence[Submission]) -> str:
    """Table of how many problems count, and the worst grade of each group."""
    lines = ["| | counts | " + " | ".join(GROUPS) + " |", "|---|---|" + "---|" * len(GROUPS)]
    for number, each in enumerate(found):
        whole = standing(each)
        cells = [group.text.removeprefix(f"{group.name} ") for group in whole.groups]
        lines.append(f"| {chr(ord('a') + number)} | {whole.counted} of {whole.of} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def _right(problems: Mapping[str, Problem], found: Sequence[Submission]) -> str:
    """Table of how many problems the codes ``found`` answer, and how well they know a."""
    bars = (f"a to {bar:.0e}".replace("e-0", "e-") for bar in BARS)
    rows = [("code", "answers", *bars, "largest error of a", "no answer to")]
    for each in found:
        marks = {number: graded(problems[number], answer).errors for number, answer in each.answers.items()}
        errors = {number: mark["a"] for number, mark in marks.items() if "a" in mark}
        worst = max(errors, key=lambda number: errors[number])
        none = ", ".join(number for number, mark in marks.items() if not mark) or "–"
        counts = (str(sum(error <= bar for error in errors.values())) for bar in BARS)
        answers = f"{len(errors)} of {len(marks)}"
        rows.append((each.meta.code, answers, *counts, f"{errors[worst]:.1e} ({worst})", none))
    head, *lines = (f"| {' | '.join(row)} |" for row in rows)
    return "\n".join([head, "|---" * len(rows[0]) + "|", *lines])


def _table(problems: Mapping[str, Problem], found: Sequence[Submission], first: str) -> str:
    """List of codes, with letters from ``first``, and table of their grades."""
    letters = [chr(ord(first) + number) for number in range(len(found))]
    told = (
        f"- **{letter}**: {each.meta.code} {each.meta.version}"
        + (f"; {each.meta.settings}" if each.meta.settings else "")
        for letter, each in zip(letters, found, strict=True)
    )
    codes = [fill(line, 120, subsequent_indent="  ", break_on_hyphens=False) for line in told]
    lines = ["| problem | at best | " + " | ".join(letters) + " |", "|---|---|" + "---|" * len(letters)]
    for number, *cells in scoreboard(problems, found).rows:
        shown = [_whole(each, number, cell) for each, cell in zip(found, cells, strict=True)]
        lines.append(f"| {number} {NAMES[number]} | {best_grade(problems[number])} | " + " | ".join(shown) + " |")
    return "\n".join([*codes, "", *lines]) + "\n"


def _whole(submission: Submission, number: str, cell: str) -> str:
    """``cell`` of the table; for a method of partialslip with the seconds of a whole process beside the solution's."""
    if not (_own(submission) and cell.endswith(" s)")):
        return cell
    return f"{cell.removesuffix(' s)')}; {_seconds(submission, number)})"


def _seconds(submission: Submission, number: str) -> str:
    """CPU seconds of a whole process: an answer of a method of partialslip has those of the solution."""
    own = _own(submission)
    whole = submission.answers[number].cpu_s + (_start()["start"][own.method] if own else 0.0)
    return f"{float(f'{whole:.2g}'):g} s"


def _own(submission: Submission) -> Own | None:
    """The method of partialslip that answers, if one does."""
    code = CODES.get(submission.meta.code.removeprefix("partialslip "))
    return code if isinstance(code, Own) else None


@functools.cache
def _start() -> dict[str, Any]:
    """CPU seconds of the start of a process by method, and where they were measured."""
    return json.loads(START.read_text("utf-8"))


if __name__ == "__main__":
    (DOCS / "scoreboard.md").write_text(page(), "utf-8")
