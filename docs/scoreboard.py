"""Write scoreboard.md from benchmarks/submissions and, in benchmarks/peers, timing.jsonl and increments.jsonl."""

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
from partialslip.verify.benchmark.grade import best_grade, graded
from partialslip.verify.benchmark.measured import GROUPS
from partialslip.verify.benchmark.problem import EDITION

DOCS = Path(__file__).parent
SUBMISSIONS = DOCS.parent / "benchmarks" / "submissions"
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
PEERS = DOCS.parent / "benchmarks" / "peers"
TIMING = PEERS / "timing.jsonl"
EQUAL = "partialslip fem-P1", "partialslip fem-P2"  # methods with elements of the sizes of other codes
PLACE = -0.8  # x/a, as in benchmarks/peers/increments.py

_HEAD = """\
# Scoreboard

Grades on the [problems of the benchmark](howto/benchmark.md), edition {edition}, from A to E, by errors of a, m and n
and of the curves p and q in the norms of `partialslip score`: B is what `partialslip score --bar 1e-3` passes, C is
1e-2. Values at points are detail. Dash: not run, or not offered. *none*: not converged. *At best*: the highest grade
that the uncertainty of the targets allows. This project ran all codes with adapters of its own, by one script
(`benchmarks/peers/board.py`); their authors did not tune them, and are asked to [correct us](#what-was-found).

## Methods of partialslip

The second table has the number of problems with all headline values, and the worst grade of each group over all
problems. "1 not offered": one problem with other values lacks values of the group.

"""

_OTHERS = """
## Codes on the same meshes

The problems that are timed below, on the same meshes with elements of h along the contact, the same blocks and the
same growth; a dash where a code was not run or gave no answer. Element, contact condition and stiffness are in the
list of settings: first what a code does by default or its manual recommends, then another that we tried. A cell has
the grade, the error that decides it, and how well this could be read from nodal values or how large the method says
it is (+-), which is in no grade. Where +- is as large as the error, reading decides.

{settings}

{tables}

{kept}
"""

_TIME = """
## Time

CPU seconds on {processor} ({dates}), codes in turn, one at a time, one thread each, load of the machine by others up
to {load:.1f}; raw output: `benchmarks/peers/timing.jsonl`. partialslip: the whole process, with the start of Python,
with meshing, and with its error estimate; other codes: the code alone, without meshing. CalculiX solves slices with two
layers of nodes.

{table}
"""

_FOUND = """
## What was found

We are users of these codes. `benchmarks/submissions/CODE/inputs` has what was run: `run.sh`, the script or deck of
PS-02, and checksums of all decks. If a setting is not what you recommend, open an issue or a pull request with yours
(addresses: `[project.urls]` of pyproject.toml): we run it, renew the row and name you.

**Choices of ours**, not errors of a code:

- *Element.* On one mesh of PS-02 C3D8I has less than half the errors of C3D8 in CalculiX (a from 7e-3 to 8e-4; in
  PS-23 q is worse), bbarQuad half of those of `quad` in OpenSees (q from 2.0e-2 to 0.9e-2). The first board had C3D8
  and `quad`, which also lock at nu = 0.4999 (PS-14).
- *Stiffness in stick.* 30 E/a instead of 100 E/a halves the error of q with CalculiX's penalties in PS-02 (0.05 a), and
  does not matter in PS-23; [other scenes](symptoms.md#which-stiffness).
- *Multipliers.* GetFEM's p overshoots at the corners of the flat (PS-10, PS-11) with the linear multipliers that we
  chose. Meshes graded to the ends of a first run are better by up to two grades.
- *Points.* The first board graded the worst point: dq at 0.5 a in PS-02, 0.013 a inside the end of the stick zone.
- *Reading.* a, m and n are read from nodal values. Where +- is as large as the error, the reader decides and not the
  code (CalculiX's penalties in PS-23: p near the ends is not smooth).
- *Adapters* for Kratos and OpenSees do not rotate bodies (PS-21); that for OpenSees needs matching meshes (PS-26) and
  repeats increments until the multipliers rest.

**Findings**, all without a message of the code:

| code | version, settings | found | again by | report |
|---|---|---|---|---|
| CalculiX | 2.20, TYPE=MORTAR, hard | a depends on the unit of length, by 25 % | `peers/units.py` | [draft][1] |
| Kratos | 10.4.4, ALMContactFrictional | dq depends on tangent_factor after reversal | `run.sh` | [draft][2] |
| OpenSees | 3.7.1, Transformation | a second equalDOF of a node is dropped | script in the draft | [draft][3] |
| all | any | one increment where slip reverses: another solution | [below](#how-many-increments-ps-27) | none |

[1]: upstream/calculix-mortar-units.md
[2]: upstream/kratos-tangent-factor.md
[3]: upstream/opensees-transformation.md

From the first board, 0.05 a (Kratos 0.1 a), not repeated since: no convergence of CalculiX's penalties in PS-06, PS-07,
PS-17 and PS-27, of Kratos in PS-03, PS-08, PS-14 and PS-16, of OpenSees in PS-22 and PS-25.

**partialslip.** P1 and P2 (elements of one size) lose a grade or two at nu = 0.4999 (PS-14) and near stick (PS-09).

## Codes that were looked at

Newest versions from a package (Debian 12, PyPI): CalculiX 2.20 (PyPI and npm have readers and converters only), GetFEM
5.4.2, Kratos 10.4.4; OpenSeesPy 3.7.1.2 for Python 3.11 (3.8.0.0 needs 3.12). Not run, and why:

| code | reason |
|---|---|
| Akantu 5.0.7 | friction by penalties alone (CouplerSolidContact, penalty_linear): an adapter was given up before |
| NGSolve 6.2.2608 | ContactBoundary has energies of the gap; Coulomb friction would be our code |
| SfePy 2026.3 | contact terms (ContactTerm, ContactIPCTerm) without friction |
| FreeFEM 4.11 | no contact conditions of its own |
| Tamaas 2.9.0 | half-spaces, periodic; its solvers for friction (Kato, Condat) have no history of loads |
| ASPHER 0.1.3 | half-spaces in three dimensions, with friction: it could answer ST-05 and ST-06; not built here |
| SlipPY | half-spaces, no finite elements |
| OpenSees' zeroLengthContact2D, -ASDimplex | the first forgets a slipping node's traction; second not tried |
| Elmer, Code_Aster, Feel++, FEBio, MOOSE | no package with the solver in Debian 12 or on PyPI |
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
    lines = [json.loads(line) for line in TIMING.read_text("utf-8").splitlines()]
    runs = [json.loads(line) for line in INCREMENTS.read_text("utf-8").splitlines()]
    parts = [_filled(_HEAD.format(edition=EDITION)), _own_table(problems, own), "", _standings(own)]
    parts += [_same(problems, own, others, lines), _times(lines), _FOUND.strip(), _increments(problems["PS-27"], runs)]
    return "\n".join(parts)


def _filled(text: str) -> str:
    paragraphs = text.strip().split("\n\n")
    return (
        "\n\n".join(each if each[0] in "#|-" else fill(each, 120, break_on_hyphens=False) for each in paragraphs) + "\n"
    )


def _own_table(problems: Mapping[str, Problem], own: Sequence[Submission]) -> str:
    """Grades of the methods of partialslip."""
    heads = [each.meta.code.removeprefix("partialslip ") for each in own]
    rows = [
        (
            f"{number} {NAMES.get(number, '')}".strip(),
            best_grade(problems[number]),
            *(cell.split(" (")[0] for cell in cells),
        )
        for number, *cells in scoreboard(problems, own).rows
    ]
    return _table(("problem", "at best", *heads), rows)


def _table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    return "\n".join(
        [f"| {' | '.join(heads)} |", "|---" * len(heads) + "|", *(f"| {' | '.join(row)} |" for row in rows)]
    )


def _standings(found: Sequence[Submission]) -> str:
    """Table of how many problems count, and the worst grade of each group."""
    rows = []
    for each in found:
        whole = standing(each)
        cells = [group.text.removeprefix(f"{group.name} ") for group in whole.groups]
        rows.append((each.meta.code.removeprefix("partialslip "), f"{whole.counted} of {whole.of}", *cells))
    return _table(("", "counts", *GROUPS), rows)


def _same(
    problems: Mapping[str, Problem], own: Sequence[Submission], others: Sequence[Submission], lines: Sequence[Any]
) -> str:
    """Tables of all codes on the same meshes, for the problems that have been timed."""
    timed = sorted({line["problem"] for line in lines})
    shown = [*(each for each in own if each.meta.code in EQUAL), *others]
    sizes = sorted(
        {rung.h for each in others for answer in each.answers.values() for rung in answer.ladder}, reverse=True
    )
    rows = [
        (each.meta.code, f"{size:g}", *(_cell(problems[number], _rung(each, number, size)) for number in timed))
        for each in shown
        for size in sizes
    ]
    told = (f"- **{each.meta.code}** {each.meta.version}: {each.meta.settings}" for each in shown)
    listed = "\n".join(fill(line, 120, subsequent_indent="  ", break_on_hyphens=False) for line in told)
    heads = ("code", "h/a", *(f"{number} {NAMES[number]}" for number in timed))
    kept = sum(len(each.answers.keys() - set(timed)) for each in others)
    words = (
        f"Earlier answers to other problems ({kept}, of the same codes on meshes of 0.05 a) have values at points but "
        "no curves, and so no grade of tractions; `partialslip benchmark score` grades their contact and stick zone."
    )
    return _OTHERS.format(settings=listed, tables=_table(heads, rows), kept=fill(words, 120) if kept else "")


def _rung(submission: Submission, number: str, size: float) -> Answer | None:
    """Answer to a problem with elements of one ``size``, in a, of the ladder."""
    answer = submission.answers.get(number)
    for rung in answer.ladder if answer else ():
        if rung.h == size:
            last = answer is not None and rung is answer.ladder[-1]
            return Answer(rung.values, estimate=answer.estimate if answer and last else rung.estimate)
    return None


def _cell(problem: Problem, answer: Answer | None) -> str:
    """Grade of an answer, and the error that decides it."""
    if answer is None:
        return "–"
    mark = graded(problem, answer).overall
    if mark.error is None:
        return "*none*" if not answer.values else f"– ({mark.worst})"
    known = "" if mark.estimate is None else f" +- {mark.estimate:.0e}"
    return f"{mark.grade} {mark.worst} {mark.error:.1e}{known}".replace("e-0", "e-")


def _times(lines: Sequence[Any]) -> str:
    """Table of CPU seconds by code, size and problem."""
    numbers = sorted({line["problem"] for line in lines})
    seconds = {(line["code"], line["h"], line["problem"]): line["cpu_s"] for line in lines}
    rows = [
        (code, "" if h is None else f"{h:g}", *(_seconds(seconds.get((code, h, number))) for number in numbers))
        for code, h in dict.fromkeys((code, h) for code, h, _ in seconds)
    ]
    told = {
        "processor": ", ".join(sorted({line["processor"] for line in lines})),
        "dates": ", ".join(sorted({line["date"] for line in lines})),
        "load": max(line["load"] for line in lines),
    }
    return _filled(_TIME.format(table=_table(("code", "h/a", *numbers), rows), **told))


def _seconds(spent: float | None) -> str:
    return "–" if spent is None else f"{spent:{'.2g' if spent < 100 else '.0f'}}"


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


if __name__ == "__main__":
    (DOCS / "scoreboard.md").write_text(page(), "utf-8")
