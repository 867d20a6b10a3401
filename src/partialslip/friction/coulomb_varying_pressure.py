"""Coulomb friction along a path on which the pressure varies: nodes come into contact and leave it.

Scaled as in :mod:`partialslip.friction.history`. Nodes that leave the contact lose their traction. Nodes that come
back start with none, and stick with the relative displacement that they have when they touch, at some moment of a step.

Where the surfaces stick beside a growing contact, the increments of q and of p are in a ratio L at the contact's end,
and so are the displacements beyond the end: while the gap closes by dv, the surfaces move along x by L dv, relative to
the bodies. The contact grows over x, and leaves q = L(x) p. A node at the distance d from the end at the beginning of
the step moves, up to touching, by the closing of its gap times L at x - 2/5 d: for Hertz contacts under changes of Q
and of tension this is exact up to relative errors of d^2. L is linear over the nodes that touch in a step, and
consistent with the q to which it leads.
"""

from contextlib import suppress
from dataclasses import replace

import numpy as np
import scipy.linalg as la

from partialslip.friction import coulomb_varying_events
from partialslip.friction.active_set import Sides, Solution, solve_bounded, spread
from partialslip.friction.history import History, follow, resting
from partialslip.friction.load_path import Path
from partialslip.friction.normal import Presses
from partialslip.friction.path_following import NothingSticksError
from partialslip.friction.warm_start import Trail
from partialslip.scene.model import require_carried
from partialslip.tools.arrays import Array, Mask, submatrix

_INSIDE = 0.4  # accuracy: of the distance from the end at the beginning of a step: where the ratio L is taken
_FEW = 3  # accuracy: nodes that touch on one side from which on L is linear, and not constant
_TIMES = 6  # limit: most solutions of one step with new ratios


def march(
    x: Array,
    tangential: Array,
    stretch: Array,
    f: Array,
    press: Presses,
    path: Path,
    few: int = 0,
    trail: Trail | None = None,
) -> History:
    """Follow the path with a new pressure at each step, or event by event (:attr:`Path.followed`); every step, and
    every leg, has a certificate.

    Parameters
    ----------
    x : (n,) array
        Nodes of the contact line.
    tangential, stretch
        As for :func:`partialslip.friction.history.march`, at all nodes.
    f : (n,) array
        Coefficient of friction.
    press : Presses
        Normal forces (n,) under any P and M. Where surfaces stick while the contact grows, their compliance must be
        discretised as ``tangential`` is, and the same for half-planes: a difference would be locked in.
    path : Path
    few : int
        As for :func:`partialslip.friction.coulomb_varying_events.march`.
    trail : Trail, optional
        Where steps begin that no cycle before has taken; theirs are kept in it.
    """
    if path.followed:
        with suppress(
            NothingSticksError
        ):  # so near to sliding that rounding lets no node stick: steps still have an answer
            return coulomb_varying_events.march(tangential, stretch, f, press, path, few)
    first, *ways = (len(way) for way in path.fractions)
    cycle = sum(ways)
    sides: list[Sides] = []
    pressed = [press(*path.begin[3:])]
    attached = _spanned(pressed[0].x)  # nodes that remember where they stuck: those between the ends of the contact
    trail = trail or Trail(x)
    drift = 0 * x  # displacement of attached nodes that are open, since they opened

    def advance(before: Solution, load: Array, change: Array) -> tuple[Solution, Array]:
        nonlocal attached, drift
        Q, P, M = (float(load[i]) for i in (0, 3, 4))
        normal = press(P, M)
        taken = len(sides) >= first + cycle
        near = sides[-cycle] if taken else trail.sides(len(sides), before.sides)
        free = tangential @ before.x + change[1] * stretch[0] + change[2] * stretch[1] - drift
        bound = f * normal.x
        require_carried([Q], float(bound.sum()))
        step = _Step(x, tangential, press.normal, free, bound, Q, attached)
        found = step.solve(pressed[-1].x, normal.x, near)
        moved = tangential @ found.x - free
        sticks = (normal.x > 0) & (found.sides == 0)
        attached = _spanned(normal.x)
        drift = np.where(attached & (normal.x <= 0), moved - moved[sticks].mean(), 0.0) if sticks.any() else 0 * x
        if not taken:
            trail.keep(len(sides), (normal, found))
        pressed.append(normal)
        sides.append(found.sides)
        return found, normal.x

    return follow(path, advance, resting(0 * x if path.before is None else path.before), f)


def _spanned(forces: Array) -> Mask:
    """Nodes between the first and the last node with a force; single ones among them may be open."""
    on, numbers = np.flatnonzero(forces > 0), np.arange(len(forces))
    return (numbers >= on[0]) & (numbers <= on[-1])


class _Step:
    """One load step: nodes ``x`` (n,), compliances along x and y (n, n), ``free`` relative displacement, ``bound``
    (n,), zero at nodes that are open at the end of the step, shear force ``Q``, and the nodes that are ``attached``
    before the step (n,)."""

    def __init__(
        self, x: Array, tangential: Array, normal: Array, free: Array, bound: Array, Q: float, attached: Mask
    ) -> None:
        self._x, self._C, self._normal, self._free, self._bound, self._Q = x, tangential, normal, free, bound, Q
        self._attached = attached
        self._on = np.flatnonzero(bound > 0)
        self._inner = submatrix(tangential, self._on, self._on)

    def solve(self, before: Array, after: Array, near: Sides) -> Solution:
        """Solve the step in which the normal forces change from ``before`` to ``after``, (n,) each, beginning with the
        sides ``near``."""
        kept, ratios = self._touching(before, after)
        if not kept.size:
            return self._bounded(self._free, near)
        sides = np.where(before > 0, near, 0).astype(np.int8)
        spent: list[Solution] = []
        while True:
            found = self._bounded(self._free + self._ratio(sides, kept, ratios) @ kept, sides)
            spent.append(found)
            if np.array_equal(found.sides, sides) or len(spent) == _TIMES:
                break
            sides = found.sides
        iterations, changes = (sum(getattr(each, key) for each in spent) for key in ("iterations", "changes"))
        return replace(found, iterations=iterations, changes=changes)

    def _ratio(self, sides: Sides, kept: Array, ratios: Array) -> Array:
        """Coefficients (k,) of the ratio L that are consistent with the q to which they lead, if nodes are on the
        ``sides``: q is then linear in the coefficients."""
        free = np.flatnonzero((sides == 0) & (self._bound > 0))
        q = sides * self._bound
        if not ratios[:, free].any():
            return ratios @ q
        factor = la.cho_factor(submatrix(self._C, free, free), check_finite=False)
        moved = la.cho_solve(
            factor,
            np.column_stack([np.ones(len(free)), (self._free - self._C @ q)[free], kept.T[free]]),
            check_finite=False,
        )
        uniform, by = moved[:, 0], moved[:, 1:]
        missing = np.append(self._Q - q.sum(), np.zeros(len(kept))) - by.sum(axis=0)
        by = by + np.outer(uniform, missing / uniform.sum())
        q[free] = by[:, 0]
        return np.linalg.solve(np.eye(len(kept)) - ratios[:, free] @ by[:, 1:], ratios @ q)

    def _bounded(self, free: Array, near: Sides) -> Solution:
        on, bound = self._on, self._bound[self._on]
        return solve_bounded(self._inner, free[on], -bound, bound, self._Q, near[on]).spread(on, len(self._x))

    def _touching(self, before: Array, after: Array) -> tuple[Array, Array]:
        """Displacements (k, n) at nodes that touch in the step for unit coefficients of the ratio L, and rows (k, n)
        that take q to these coefficients, (k,)."""
        x, on = self._x, self._bound > 0
        new, both = on & ~self._attached, np.flatnonzero(on & (before > 0))
        if not new.any() or len(both) < 2:
            return np.empty((0, len(x))), np.empty((0, len(x)))
        approach = self._normal @ (after - before)
        rigid = np.polynomial.polynomial.polyfit(x[both], approach[both], 1)  # approach, and rotation by a moment
        closing = approach - np.polynomial.polynomial.polyval(x, rigid)
        kept, ratios = [], []
        for side, last in ((-1, both[0]), (1, both[-1])):
            touch = np.flatnonzero(new & (side * np.arange(len(x)) > side * last))
            if not len(touch):
                continue
            end = (x[touch[0 if side > 0 else -1]] + x[touch[0 if side > 0 else -1] - side]) / 2
            apart = (x[touch] - end) / (x[touch[-1]] - x[touch[0]] or 1.0)
            powers = np.arange(2 if len(touch) >= _FEW else 1)[:, None]
            fit = np.linalg.pinv((apart**powers * after[touch]).T)
            for power, row in zip(powers, fit, strict=True):
                kept.append(spread(closing[touch] * ((1 - _INSIDE) * apart) ** power, touch, len(x)))
                ratios.append(spread(row, touch, len(x)))
        return np.array(kept).reshape(-1, len(x)), np.array(ratios).reshape(-1, len(x))
