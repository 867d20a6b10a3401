"""Bodies pressed together without friction, on a line of contact nodes."""

from dataclasses import replace

import numpy as np
import scipy.linalg as la

from partialslip.arrays import Array, submatrix
from partialslip.condensed.bounded import Sides, Solution, solve_bounded

_TURNS = 100  # largest number of angles tried
_LEVEL = 1e-14  # moment, relative to that of the forces without sign, that is rounding
_START, _WIDER = 1e-3, 2.0  # angle, and factor of an angle, where the moment does not depend on it


def press(
    normal: Array,
    gap: Array,
    P: float,
    arms: Array | None = None,
    moment: float = 0.0,
    near: tuple[Sides, float] | None = None,
) -> tuple[Solution, float]:
    """Nodal normal forces (n,), none tensile, that close ``gap`` (n,) and sum to ``P``; and the angle of rotation.

    ``normal`` is the compliance along y, (n, n). With ``arms`` (n,), the abscissae of the nodes, the bodies turn until
    the forces have the ``moment``. The moment grows with the angle, and is linear in it while no node changes sides;
    that of a single node does not depend on it, but for rounding.
    ``near`` are the sides and the angle of a similar problem, to begin with.
    """
    free = np.zeros(len(gap)), np.full(len(gap), np.inf), P
    sides, angle = near or (None, 0.0)
    found = solve_bounded(normal, (0.0 if arms is None else angle * arms) - gap, *free, sides)
    if arms is None:
        return found, 0.0
    low, high, iterations, changes = -np.inf, np.inf, found.iterations, found.changes
    for _ in range(_TURNS):
        off = float(arms @ found.x) - moment
        if abs(off) <= _LEVEL * float(np.abs(arms) @ found.x):
            break
        low, high = (angle, high) if off < 0 else (low, angle)
        on = np.flatnonzero(found.x > 0)
        factor = la.cho_factor(submatrix(normal, on, on), check_finite=False)
        uniform, tilted = la.cho_solve(factor, np.stack([np.ones(len(on)), arms[on]], axis=1), check_finite=False).T
        rate = float(arms[on] @ (tilted - uniform * tilted.sum() / uniform.sum()))
        step = -off / rate if rate > 0 and len(on) > 1 else np.copysign(_WIDER * (abs(angle) + _START), -off)
        angle = angle + step if low < angle + step < high else (low + high) / 2
        found = solve_bounded(normal, angle * arms - gap, *free, found.sides)
        iterations, changes = iterations + found.iterations, changes + found.changes
    off, lever = abs(float(arms @ found.x) - moment), float(np.abs(arms) @ found.x)
    turned = off / max(lever, abs(moment)) * P if off else 0.0  # a single node below the force has no lever
    return replace(found, imbalance=max(found.imbalance, turned), iterations=iterations, changes=changes), float(angle)


class Presses:
    """Forces under any P and M, in any order: each from the solution of the loads before; those known are kept.

    Parameters
    ----------
    normal, gap, arms
        As for :func:`press`.
    """

    def __init__(self, normal: Array, gap: Array, arms: Array | None) -> None:
        self._problem = normal, gap
        self._arms = arms
        self._near: tuple[Sides, float] | None = None
        self._known: dict[tuple[float, float], Solution] = {}

    def __call__(self, P: float, M: float) -> Solution:
        """Solution under ``P`` and ``M``, about the origin of the arms."""
        if (P, M) not in self._known:
            found, angle = press(*self._problem, P, self._arms, M, self._near)
            self._near = found.sides, angle
            self._known[P, M] = found
        return self._known[P, M]

    @property
    def solutions(self) -> list[Solution]:
        """All solutions so far."""
        return [*self._known.values()]
