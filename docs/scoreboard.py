"""Write scoreboard.md from benchmarks/submissions, benchmarks/start.json and benchmarks/peers/increments.jsonl."""

import functools
import json
from collections.abc import Mapping, Sequence
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
    "PS-22": "dissimilar, sheared",
    "PS-23": "two blocks",
    "PS-24": "pad on a specimen",
    "PS-25": "dissimilar, pressed",
    "PS-26": "meshes do not match",
    "PS-27": "slip reversal",
    "PS-28": "strips, shear",
    "PS-29": "strips, large tension",
}
COLUMNS = 4  # codes of partialslip side by side
EQUAL = (  # ours, size of its elements in a, and codes that have elements of this size and order along the contact
    ("partialslip fem-P1", 0.1, ("kratos",)),
    ("partialslip fem-P1", 0.05, ("calculix-mortar", "calculix-penalty", "opensees")),
    ("partialslip fem-P2", 0.05, ("getfem",)),
)
BARS = (1e-3, 4e-3, 1e-2)  # errors of a that are counted
PLACE = -0.8  # x/a, as in benchmarks/peers/increments.py

_HEAD = """\
# Scoreboard

Grades on the [problems of the benchmark](howto/benchmark.md), edition {edition}, from A (every target within 1e-4) to E
(beyond 5e-2), and CPU seconds. Dash: not run, or the problem or a target is not offered. *none*: not converged (notes
in `benchmarks/submissions`). *At best*: the highest grade that the uncertainty of the targets allows. This project ran
all codes with adapters of its own; their authors did not tune them.

**Seconds.** Two cores ({machine}). partialslip ran alone, in one thread, the others up to two at a time and beside
tests, which costs 5 to 10 % ([measured](cost.md) with GetFEM); repeated runs differ by a tenth and more. All seconds
are those of the whole process: of partialslip with meshing (P1 and P2: the finest mesh) and with the start of Python
({starts}), of other codes without meshing; `getfem-graded` includes the run that finds the ends. CalculiX solves slices
with two layers of nodes, twice the unknowns of a plane mesh.

The table of groups has the number of problems with a value for every target of contact, stick and tractions, and the
worst grade of each group. "1 not offered": one problem with other values lacks values of the group.

"""

_WRONG = """
## What each code gets wrong

Elements along the contact are 0.05 a (Kratos: 0.1 a): C3D8 in CalculiX, `quad` in OpenSees,
SmallDisplacementElement2D4N in Kratos, Q2 in GetFEM; others were not run. Next to the ends of contact and stick zone,
where tractions fall like a square root, such elements have errors of 1 to 2 %.

{right}

- **CalculiX 2.20, penalty contact** (1000 E/a on overlap, 100 E/a on stick). q depends on the stick stiffness
  ([how much](symptoms.md#which-stiffness)) and on the state before: after load reversal it is off by 0.2 f p0 next to
  the stick zone (PS-03). In PS-12, a is 2.4 % too wide, without a message (GetFEM, same mesh: 1e-3). At nu = 0.4999
  (PS-14) nodal pressures scatter too much to tell the contact. PS-06, PS-07, PS-17 and PS-27 do not converge.
- **CalculiX 2.20, mortar contact** (hard pressure, 1e5 E/a on stick). It converges where penalties give up. q is right
  to 1 % where it is not steep, but not beside the stick zone of 1e-4 a (PS-07). The result depends on the unit of
  length: a is off by 30 % at a = 1e-3 units, 5 % at 0.1 and 0.2 % at 1, without a message; decks have 100 or more
  ([calculix](howto/calculix.md)).
- **GetFEM 5.4.2** (linear multipliers, augmentation constant E/a). p at 0.9 a is off by 1.5 % (last element in the
  contact), p_max at the corners of the flat by 7 % (PS-10, PS-11: overshoot of the multipliers), m at nu = 0.4999 by
  0.16 a (PS-14). Meshes graded to the ends of a first run give one to three grades more at three to five times the
  cost, except in PS-04 (left slip zone 0.0017 a wide) and PS-26.
- **Kratos 10.4.4, mortar contact** (augmented Lagrangian, tangent_factor 1, 8 increments). After load reversal the
  state beside the stick zone is wrong without a message: in PS-05 dq is off by 0.8 of 2 f p0, and by more with Kratos'
  own tangent_factor of 0.025. PS-06, PS-17 and PS-23 need 16 increments, and two of them have a stick zone that is far
  off. PS-03, PS-08, PS-14 and the third cycle of PS-16 do not converge. The adapter does not rotate bodies (PS-21).
- **OpenSees 3.7.1** (OpenSeesPy 3.7.1.2; SimpleContact2D with multipliers, ContactMaterial2D with 1000 E/a on stick, 8
  increments). Where it converges, it is as right as CalculiX's mortar contact. PS-02, PS-07, PS-15 and PS-17 need 16
  increments (or PS-02 elements of 0.049 or 0.051 a), PS-27 64 (dq to 5e-3). PS-09, PS-20 and PS-27 do not count, as
  their tractions tell no stick zone. Pressing dissimilar bodies (PS-22, PS-25) does not converge. At nu = 0.4999
  (PS-14) `quad` locks: pressure on single nodes, 4.6 p0 too high, without a message. Contact is found one increment
  late: the adapter repeats increments until the multipliers rest. The handler "Transformation" keeps one constraint of
  a node, without a message. The adapter does not rotate bodies (PS-21) and needs matching meshes (PS-26).
- **partialslip.** P1 and P2 (elements of one size) lose a grade or two at corners (PS-10, PS-11) and at nu = 0.4999
  (PS-14). March has the exact pressure: its errors are those of q.

## Codes that were looked at

Not run, or given up: OpenSees' zeroLengthContact2D, which forgets the traction of a slipping node at the end of an
increment, and zeroLengthContactASDimplex; Akantu 5.0.7 (CouplerSolidContact, penalty_linear); Tamaas and SlipPY
(half-spaces, no finite elements); Elmer, Code_Aster, Feel++ and FEBio (no package in Debian 12 or on PyPI).
"""

_EQUAL = """
## At equal resolution

Codes with elements of one size along the contact: partialslip's linear ones beside Kratos, CalculiX and OpenSees,
quadratic ones beside GetFEM. A cell has the largest error among the targets of contact, stick and tractions, and its
target. Rows that no other code answers are left out. At the corners of the flat
(PS-10, PS-11) only the meshes of the other codes are finer.

{tables}

{told}
"""

_LEARNT = """
partialslip has the smaller error in {smaller} of the problems that both answer. Its error over theirs goes from {least}
to {most}, the latter at the corners of the flat. Most of these errors are those of the last elements beside the ends of
contact and stick zone.
"""

_ROW = "| " + " | ".join(["{}"] * 10) + " |"

_TURNS = """
## How many increments: PS-27

PS-27 has slip reversal between the load points: the stick zone moves to the left and takes points back that have
slipped ([theory](theory.md), section 7). Codes count slip from the start of an increment, so the number of increments
decides.

{table}

- **m/a** is read as by `partialslip score`, where |dq| leaves the friction bound like a square root. At a drifted end
  2 f p - |dq| grows like (x + m)^(3/2), which is easily taken for scatter.
- **m/a, drifted**: a straight line through (1 - |dq|/(2 f p))^(2/3) where the bracket is between 0.01 and 0.17,
  extended to zero. Dash: fewer than two points. From exact tractions it is 0.01 too large.
- **slack**: 1 - |dq|/(2 f p) at x = -0.8 a, which slips in one step; above 1, dq has the wrong sign.

With one increment CalculiX's mortar contact and GetFEM converge, without a message, to the solution of one step; with
64 the slack is right to 5 %, and the drifted m to 0.01 a. Their n is right with any number and gives no warning. Kratos
with 64, on elements twice as wide, converges to a dq of the wrong sign at -0.8 a, without a message. Where slip
reversal may occur (under Hertz and large tension: always above Q_f = 0.5601), compare 8 increments with 64, and look at
the traction just inside the zone rather than at its end.

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
    """Head of the page."""
    told = _start()
    starts = ", ".join(f"{method} {seconds:.2g}" for method, seconds in told["start"].items())
    machines = {told["machine"], *(each.meta.machine for each in found)}
    assert len(machines) == 1, f"one machine is told, not {machines}"
    text = _HEAD.format(edition=EDITION, starts=starts, machine=told["machine"])
    return "\n\n".join(fill(part, 120, break_on_hyphens=False) for part in text.strip().split("\n\n")) + "\n\n"


def _increments(problem: Problem, runs: Sequence[Mapping[str, Any]]) -> str:
    """Table of ``runs`` by number of increments, below the exact solutions of gradual loads and of one step."""
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
    heads = "code", "increments", "m/a", "error", "m/a, drifted", "error", "n/a", "error", "slack", "CPU s"
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
                lines.append(f"| {number} | " + " | ".join(told) + " |")
            for name, mark in zip(others, marks[1:], strict=True):
                if mark and marks[0]:
                    smaller[name] += "+" if marks[0].error < mark.error else "-"
                    ratios.append(marks[0].error / mark.error)
        both |= smaller
        parts.append("\n".join(lines))
    told = _LEARNT.format(
        smaller=", ".join(f"{each.count('+')} of {len(each)} ({name})" for name, each in both.items()),
        least=f"1/{1 / min(ratios):.0f}",
        most=f"{float(f'{max(ratios):.2g}'):g}",
    )
    return _EQUAL.format(tables="\n\n".join(parts), told=fill(told.strip(), 120, break_on_hyphens=False))


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
    """Error that the ``mark`` of an answer is of."""
    answer = submission.answers.get(number)
    if answer and not answer.values:
        return "*none*"
    if mark is None:
        return "–"
    return f"{mark.error:.1e} ({mark.worst})"


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
    """``cell`` of the table with CPU seconds of the whole process: the answers of partialslip have the solution's."""
    own = _own(submission)
    if not own or not cell.endswith(" s)"):
        return cell
    whole = submission.answers[number].cpu_s + _start()["start"][own.method]
    return f"{cell.split('(')[0]}({float(f'{whole:.2g}'):g} s)"


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
