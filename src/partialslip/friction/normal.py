"""Bodies pressed together without friction, on a line of contact nodes."""

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property

import numpy as np
import scipy.linalg as la

from partialslip.friction.active_set import Sides, Solution, inverse, solve_bounded
from partialslip.friction.path_following import Bounds
from partialslip.friction.tableau import Tableau
from partialslip.tools.arrays import Array, Mask, submatrix
from partialslip.tools.errors import PartialslipError

_TURNS = 100  # limit: largest number of angles tried
_LEVEL = 1e-14  # accuracy: moment, relative to that of the forces without sign, that is rounding
_START, _WIDER = 1e-3, 2.0  # accuracy: angle, and factor of an angle, where the moment does not depend on it
_CHECKED = 64  # cost: changes after which rates are found anew, free of the rounding errors of earlier ones
_APART = 1e-12  # accuracy: share of a way between two instants at which nodes touch, below which they are one
_MOST = 8  # limit: changes per node on a way: under a moment the contact may move over a node and back

Near = tuple[Sides, float]


def press(
    normal: Array,
    gap: Array,
    P: float,
    arms: Array | None = None,
    moment: float = 0.0,
    near: Near | None = None,
) -> Solution:
    """Nodal normal forces (n,), none tensile, that close ``gap`` (n,) and sum to ``P``.

    ``normal`` is the compliance along y, (n, n). With ``arms`` (n,), the abscissae of the nodes, the bodies turn until
    the forces have the ``moment``. The moment grows with the angle, and is linear in it while no node changes sides;
    that of a single node does not depend on it, but for rounding.
    ``near`` are the sides and the angle of a similar problem, to begin with.
    """
    free = np.zeros(len(gap)), np.full(len(gap), np.inf), P
    sides, angle = near or (None, 0.0)
    found = solve_bounded(normal, (0.0 if arms is None else angle * arms) - gap, *free, sides)
    if arms is None:
        return found
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
    off = max(found.imbalance, turned)
    return replace(found, imbalance=off, iterations=iterations, changes=changes, turn=float(angle))


class Presses:
    """Forces under any P and M, in any order; those known are kept.

    Parameters
    ----------
    normal, gap, arms
        As for :func:`press`.
    start : callable, optional
        ``start(P, M)``: sides and angle to begin with; default: those of the loads before.
    """

    def __init__(
        self, normal: Array, gap: Array, arms: Array | None, start: Callable[[float, float], Near] | None = None
    ) -> None:
        self.normal = normal
        self._problem = normal, gap
        self._arms, self._start = arms, start
        self._near: Near | None = None
        self._known: dict[tuple[float, float], Solution] = {}
        self._ways: dict[tuple[tuple[float, float], tuple[float, float]], Bounds] = {}
        self._tableau: Tableau | None = None

    def __call__(self, P: float, M: float) -> Solution:
        """Solution under ``P`` and ``M``, about the origin of the arms."""
        if (P, M) not in self._known:
            near = self._start(P, M) if self._start else self._near
            found = press(*self._problem, P, self._arms, M, near)
            self._near = found.sides, found.turn
            self._known[P, M] = found
        return self._known[P, M]

    @cached_property
    def inverse(self) -> Array:
        """Inverse of the compliance along y."""
        return inverse(self._problem[0])

    def way(self, begin: tuple[float, float], end: tuple[float, float]) -> Bounds:
        """Forces on the straight way from P and M at its ``begin`` to those at its ``end``: linear between the instants
        at which nodes touch or open.

        Raises PartialslipError if nodes touch and open again and again, which only rounding errors can cause.
        """
        if (end, begin) in self._ways:
            return self._ways[end, begin].reversed
        if (begin, end) not in self._ways:
            self._ways[begin, end] = self._follow(begin, end)
        return self._ways[begin, end]

    def _follow(self, begin: tuple[float, float], end: tuple[float, float]) -> Bounds:
        """Event by event: rates are constant while no node touches or opens, and each change of a node is a pivot."""
        start, last = self(*begin), self(*end)
        if begin == end:
            return Bounds.constant(start.x)
        if self._tableau is None:
            self._tableau = Tableau(self.inverse)
        tableau, (P, M) = self._tableau, np.subtract(end, begin)
        tableau.restart(np.flatnonzero(start.x <= 0))
        force, opening, at = start.x.copy(), np.maximum(start.rest, 0.0), 0.0
        places, forces = [0.0], [force.copy()]
        for number in range(_MOST * len(force)):
            if number % _CHECKED == 0:
                rates = [tableau.solve(0 * force, float(P))]
                rates += [] if self._arms is None else [tableau.solve(self._arms, 0.0)]
            p = self._rates(tableau.sticks, float(M), *rates)
            left = np.where(tableau.sticks, force, opening)
            falls = np.where(tableau.sticks, p, -p)
            steps = np.divide(left, falls, out=np.full(len(left), np.inf), where=falls > 0)
            node = int(np.argmin(steps))
            step = min(float(steps[node]), 1.0 - at)
            force = np.where(tableau.sticks, np.maximum(force - step * p, 0.0), 0.0)
            opening = np.where(tableau.sticks, 0.0, np.maximum(opening + step * p, 0.0))
            at += step
            if steps[node] > step or at > 1.0 - _APART:
                return Bounds(np.array([*places, 1.0]), np.array([*forces, last.x]))
            force[node] = opening[node] = 0.0
            if at - places[-1] > _APART:
                places.append(at)
                forces.append(force)
            elif len(places) > 1:
                forces[-1] = force
            tableau.exchange(node, *rates)
        raise PartialslipError("contact: nodes touch and open without an end; the compliance is ill-conditioned")

    def _rates(self, closed: Mask, M: float, pressed: Array, tilted: Array | None = None) -> Array:
        """Minus the rates of the forces of ``closed`` nodes (n,), and the rates at which others open, (n,): those when
        ``pressed``, and ``tilted`` so that the moment changes by ``M``."""
        if self._arms is None or tilted is None:
            return pressed[:-1]
        moments = [-float(self._arms[closed] @ each[:-1][closed]) for each in (pressed, tilted)]
        # a single node has no lever
        angle = (M - moments[0]) / moments[1] if np.count_nonzero(closed) > 1 else 0.0
        return (pressed + angle * tilted)[:-1]

    @property
    def solutions(self) -> list[Solution]:
        """All solutions so far."""
        return [*self._known.values()]
