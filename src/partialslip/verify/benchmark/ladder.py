"""Ladders of meshes: observed order, extrapolated value and grid convergence index of each target.

The rule is that of :mod:`partialslip.tools.convergence`. The formal order of a code is not known.
"""

import itertools
import math
from typing import NamedTuple

from partialslip.tools.convergence import extrapolated, fitted_order, grid_convergence_index
from partialslip.verify.benchmark.problem import Posed
from partialslip.verify.benchmark.submission import Answer

_CONSTANT = 0.01  # limit: largest deviation of the ratios of sizes, relative
_HIGHEST = 8.0  # limit: order beyond which two values agree by chance
NOT_MONOTONE, NO_RATIO, MISSING, FEW = "not monotone", "no constant ratio", "not given", "two meshes"


class Climb(NamedTuple):
    """Convergence of a target over the last three meshes of a ladder.

    Parameters
    ----------
    key : str
        That of the target.
    value : float or None
        On the finest mesh, SI units.
    error : float or None
        Of this value, in the scale of the target.
    order : float or None
        Observed order; None where the values are not monotone.
    extrapolated : float or None
        Richardson's value, SI units.
    left : float or None
        Error of the extrapolated value, in the scale of the target.
    gci : float or None
        Grid convergence index of the finest mesh, in the scale of the target.
    why : str
        Why there is no order; empty if there is one.
    """

    key: str
    value: float | None
    error: float | None
    order: float | None = None
    extrapolated: float | None = None
    left: float | None = None
    gci: float | None = None
    why: str = ""


def climbs(problem: Posed, answer: Answer) -> list[Climb]:
    """Convergence of each target of ``problem`` on the ladder of the ``answer``; empty without a ladder."""
    return [_climb(problem, answer, key) for key in problem.measured] if answer.ladder else []


def _climb(problem: Posed, answer: Answer, key: str) -> Climb:
    target, last = problem.measured[key], answer.ladder[-3:]
    values = [rung.values.get(key) for rung in last]

    def off(value: float) -> float:
        return abs(value - target.value) / target.scale

    if len(values) < 3:
        return Climb(key, values[-1], None if values[-1] is None else off(values[-1]), why=FEW)
    coarse, middle, fine = values
    if coarse is None or middle is None or fine is None:
        return Climb(key, fine, None, why=MISSING)
    ratios = [before.h / after.h for before, after in itertools.pairwise(last)]
    if not (1 < ratios[1] < math.inf and abs(ratios[0] / ratios[1] - 1) <= _CONSTANT):
        return Climb(key, fine, off(fine), why=NO_RATIO)
    first, second = middle - coarse, fine - middle
    if not (first * second > 0 and abs(second) < abs(first) < math.inf):
        return Climb(key, fine, off(fine), why=NOT_MONOTONE)
    order = fitted_order((ratios[1], 1), (abs(first), abs(second)))
    if order is None or not order <= _HIGHEST:
        return Climb(key, fine, off(fine), why=NOT_MONOTONE)
    limit = extrapolated(coarse, middle, fine)
    index = grid_convergence_index(abs(second), ratios[1], order) / target.scale
    return Climb(key, fine, off(fine), order, limit, off(limit), index)


def climb_rows(problem: Posed, answer: Answer, every: bool = False) -> list[tuple[str, ...]]:
    """Rows of :data:`CLIMB_HEADS` for the ladder of the ``answer``: of ``every`` target, or of those that are not
    tractions at points."""
    return [_climb_row(climb) for climb in climbs(problem, answer) if every or "@" not in climb.key]


CLIMB_HEADS = ("target", "error", "order", "GCI", "error, extrapolated", "extrapolated")


def _climb_row(climb: Climb) -> tuple[str, ...]:
    error = "" if climb.error is None else f"{climb.error:.1e}"
    if climb.order is None or climb.gci is None or climb.left is None:
        return (climb.key, error, climb.why, "", "", "")
    return (
        climb.key,
        error,
        f"{climb.order:.2f}",
        f"{climb.gci:.1e}",
        f"{climb.left:.1e}",
        f"{climb.extrapolated:.9g}",
    )
