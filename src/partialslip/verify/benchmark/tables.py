"""Tables of tractions beside answers: what they give, how well it can be read from them, and what differs from it.

A table has values at points. How far they can be read shows from every second row: reading is repeated with the even
and with the odd rows, and the larger difference is the error. The ends of zones have the reader's own estimate, too.
"""

import math
import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from msgspec.structs import replace

from partialslip.codes.score.method import scored
from partialslip.codes.score.mistakes import mistakes
from partialslip.codes.score.read import read_tractions
from partialslip.codes.score.samples import Samples
from partialslip.result import Result
from partialslip.run import run
from partialslip.run.judge.reference import reference
from partialslip.tools.errors import InputError
from partialslip.verify.benchmark.grade import LIMITS, NOT_GRADED, NOT_OFFERED, graded
from partialslip.verify.benchmark.measured import Quantity, targeted
from partialslip.verify.benchmark.problem import Posed, Problem
from partialslip.verify.benchmark.submission import Answer

# limit: errors of reading: largest difference of a value from its table. Tables of exact tractions of 14 problems,
# 61 to 2001 rows over 2.5 a, are off by 2.5 errors at most, where rows are not too far apart to see the stick zone
_SURE = 3.0
_NAMED = 6  # display: keys of values that are read from a table
_LEAST = 1e-5  # limit: least such difference, in the scale of the target: a tenth of what grade A allows


class TableValues(NamedTuple):
    """What a table gives: ``values`` by key of the target, SI units, and the ``errors`` of reading them, in the scale
    of the target; infinite where every second row is not enough; and ``notes`` on what was read, on units and signs."""

    values: dict[str, float]
    errors: dict[str, float]
    notes: tuple[str, ...] = ()

    def allowed(self, key: str) -> float:
        """Largest difference of an answer's value from the table's, in the scale of the target."""
        return max(_SURE * self.errors[key], _LEAST)


def read_table(
    problem: Problem,
    files: str | os.PathLike[str] | Sequence[str | os.PathLike[str]],
    columns: Mapping[str, str] | None = None,
    where: Mapping[str, str] | None = None,
    factors: tuple[float, float, float] = (1.0, 1.0, 1.0),
) -> TableValues:
    """Read what the tractions in ``files``, one or one for each load point, give of the targets of ``problem``.

    a, m and n are found as :func:`partialslip.score` finds them; p, dq, q1 and q2 are linear between the rows, and the
    places are those of the target's a. ``columns``, ``where`` and
    ``factors`` as there.

    Raises
    ------
    InputError
        If a file cannot be read.
    """
    paths = [Path(each) for each in ([files] if isinstance(files, (str, os.PathLike)) else files)]
    samples = read_tractions(paths, problem.scene, factors, chosen=columns, kept=where)
    origin = " and ".join(map(str, paths))
    found = table_values(problem, samples, origin)
    return found._replace(notes=(*likely_mistakes(problem, samples, origin), *found.notes))


def table_values(problem: Problem, samples: Samples, origin: str) -> TableValues:
    """Read what ``samples``, whose ``origin`` is named in messages, give of the targets of ``problem``. Raises
    InputError if their pressure does not exceed its noise."""
    result = _result(problem, samples, origin)
    found = targeted(problem, result)
    halves = [_half(problem, samples.coarser(first), origin) for first in (0, 1)]
    errors = {}
    for key, each in found.items():
        apart = [abs(half[key].value - each.value) / each.scale if key in half else float("inf") for half in halves]
        errors[key] = max(each.error if each.error > 0 else 0.0, *apart)  # it may be NaN
    return TableValues({key: each.value for key, each in found.items()}, errors, result.notes)


def likely_mistakes(problem: Problem, samples: Samples, origin: str) -> tuple[str, ...]:
    """Notes on likely mistakes in ``samples``, such as other units and signs, where the exact solution is known."""
    scene = problem.scene
    if reference(scene).method != "exact":
        return ()
    return mistakes(scene, _result(problem, samples, origin), run(scene, ["exact"]).results["exact"])


def _result(problem: Problem, samples: Samples, origin: str) -> Result:
    return scored(problem.scene, samples, "table", origin)


def _half(problem: Problem, samples: Samples, origin: str) -> dict[str, Quantity]:
    """Quantities of every second row; none if these are too few."""
    try:
        return targeted(problem, _result(problem, samples, origin))
    except InputError:
        return {}


def completed(answer: Answer, table: TableValues) -> Answer:
    """The ``answer`` with the values of the ``table`` that it leaves out, and how well these can be read. A null is no
    value, and stays."""
    read = {key: value for key, value in table.values.items() if key not in answer.values}
    errors = {key: table.errors[key] for key in read if "@" not in key and math.isfinite(table.errors[key])}
    known = {key: float(f"{error:.2g}") for key, error in errors.items()}
    return replace(answer, values=read | answer.values, estimate=known | answer.estimate)


def differences(problem: Posed, answer: Answer, table: TableValues, name: str) -> Iterator[str]:
    """Lines for values of the ``answer`` that differ from the ``table`` of this ``name`` by more than reading it
    explains."""
    for key, value in answer.values.items():
        if value is None or key not in table.values:
            continue
        target, seen, most = problem.measured[key], table.values[key], table.allowed(key)
        if not abs(value - seen) <= most * target.scale:
            within = f"{seen:.9g} within {most * target.scale:.1e} {target.unit}"
            yield f"values.{key} = {value:.9g}: must be {within}, as {name} has it, or left out"


def remark(problem: Posed, answer: Answer, table: TableValues) -> str:
    """Line about the ``table`` beside an ``answer``: what is read from it, and the grade that it gives without the
    values of the answer. A table that is worse than the values shows."""
    alone = graded(problem, Answer(dict(table.values))).overall
    name = f"{problem.number}.csv"
    told = alone.grade if alone.grade in (NOT_OFFERED, NOT_GRADED) else f"grade {alone.grade}"
    off = "" if alone.error is None else f" {alone.error:.1e}"
    line = f"{name} alone: {told} ({alone.worst}{off})"
    both = [key for key, value in answer.values.items() if value is not None and key in table.values]
    compared = [key for key in both if table.allowed(key) <= max(LIMITS.values())]  # others tell no grade from another
    if compared:
        worst = max(compared, key=table.allowed)
        line += f"; {len(compared)} values are compared with it, to {table.allowed(worst):.1e} at worst ({worst})"
    if len(compared) < len(both):
        line += f"; {len(both) - len(compared)} are not: its rows are too far apart"
    taken = [key for key in table.values if key not in answer.values]
    named = ", ".join(taken) if len(taken) <= _NAMED else f"{len(taken)} values"
    return "; ".join((line + (f"; read from it: {named}" if taken else ""), *table.notes))
