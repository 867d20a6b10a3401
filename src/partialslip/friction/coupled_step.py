"""One load step of two coupled bodies: pressure moves the surfaces along x, and shear opens the gap.

Scaled as in :mod:`partialslip.friction.history`. The surfaces' relative displacements u (upper body less lower body,
along x) and v (opening, along y) under normal forces p and tangential forces q (of the lower body on the upper one):

    u = C_xx q + C_xy p,    v = C_xy^T q + C_yy p.

A body on a pin turns by an angle, which opens the gap at x by minus x times the angle, and moves the surfaces along x
by minus the height of the pin times the angle, until the moment of the forces about the pin is the given one.
"""

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import NamedTuple

import numpy as np
import scipy.linalg as la
from scipy.optimize import brentq

from partialslip.friction.active_set import Sides, Solution, solve_bounded
from partialslip.friction.history import resting
from partialslip.friction.normal import press
from partialslip.friction.partition import Factors, Forces, longest
from partialslip.friction.warm_start import Pair, Trail
from partialslip.tools.arrays import Array, Mask, submatrix
from partialslip.tools.errors import PartialslipError

_ROUNDING = 16 * float(np.finfo(float).eps)
_SAME = 1e-6  # accuracy: shear force of an actuator, in f P, that Newton's method begins with
_PATIENCE = 4  # cost: iterations without progress before the method changes
_UNSOLVED = 1e-8  # limit: residual of a step, in P, that does not converge: rounding leaves 1e-15, and others 1e-4
_CLOSE = 32  # cost: changes of sides in an iteration without progress below which rounding errors may matter

_Solver = Callable[[Array, Array], Forces]  # forces for the displacements (2, n) that have the totals (2,) or (3,)


@dataclass(frozen=True)
class Relative:
    """Relative compliances (n, n) of the contact nodes of two bodies.

    ``xx``, ``yy`` and ``xy`` are C_xx, C_yy and C_xy; ``xx`` is None without friction, ``xy`` None if it vanishes or is
    neglected. ``yx`` gives the opening of the gap by q; default: the transpose of ``xy``, by reciprocity. It is zero in
    Goodman's approximation.
    """

    xx: Array | None
    yy: Array
    xy: Array | None
    yx: Array | None = None

    @property
    def opening(self) -> Array:
        """``yx``, by default from reciprocity."""
        assert self.xy is not None
        return self.xy.T if self.yx is None else self.yx

    def moved(self, p: Array, q: Array) -> tuple[Array, Array]:
        """Relative displacements (n,) along x, and opening along y, under the forces ``p`` and ``q`` (n,)."""
        assert self.xx is not None
        assert self.xy is not None
        return self.xx @ q + self.xy @ p, self.yy @ p + self.opening @ q

    @cached_property
    def factors(self) -> Factors | None:
        """Factors of all of them, with friction and coupling; None if they are not symmetric."""
        return Factors(self) if self.yx is None else None


class Pivot(NamedTuple):
    """Pin on which one of the bodies turns: ``arms`` (n,) are the distances of the nodes from its axis along x,
    ``height`` is that of the pin over the contact line, negative below it, ``moment`` that of the loads: int x p dx
    plus the height times the sum of q."""

    arms: Array
    height: float
    moment: float

    def of(self, p: Array, q: Array) -> float:
        """Moment of the forces ``p`` and ``q`` (n,) about the pin."""
        return float(self.arms @ p) + self.height * float(q.sum())

    @property
    def turned(self) -> Array:
        """Displacements (2, n) along y and x that nodes make up for if the body turns by 1."""
        return np.stack([self.arms, np.full(len(self.arms), self.height)])


@dataclass(frozen=True)
class LoadStep:
    """Problem of one load step with friction ``f`` (n,): p sums to ``P`` over the ``gap`` (n,) before loading, q sums
    to ``Q``, and nodes that stick have the relative displacement ``kept`` (n,) along x, up to a rigid shift.
    ``factors`` are those of the compliances, which many steps share.

    If an ``actuator`` drives the bodies, its end moves by ``Q``: by the shift, and its compliance times the sum of q.
    A body on a ``pivot`` turns until the forces have its moment; ``kept`` counts from where no body has turned.
    """

    xx: Array
    yy: Array
    xy: Array
    yx: Array
    f: Array
    P: float
    gap: Array
    Q: float
    kept: Array
    factors: Factors | None = None
    actuator: float | None = None
    pivot: Pivot | None = None

    @property
    def _totals(self) -> Array:
        return np.array([self.P, self.Q, *([self.pivot.moment] if self.pivot else [])])

    @property
    def _units(self) -> Array:
        """Units of the totals, in that of force."""
        along = 1.0 if self.actuator is None else self.actuator + float(np.diag(self.xx).max())
        return np.array([1.0, along, *([1.0] if self.pivot else [])])

    def _borne(self, found: Forces) -> Array:
        """Resultants of the nodal forces to be compared with the prescribed totals: P; Q, or the displacement of the
        actuator's end; and M about the pin if a body pivots."""
        p, q, (_, shift, *_) = found
        Q = float(q.sum())
        along = Q if self.actuator is None else self.actuator * Q + shift
        return np.array([p.sum(), along, *([self.pivot.of(p, q)] if self.pivot else [])])

    @cached_property
    def _load(self) -> Array:
        """Displacements (2, n) of nodes that touch and stick, along y and x."""
        return np.stack([-self.gap, self.kept])

    def sweep(self, p: Solution, q: Solution) -> Pair:
        """One fixed-point iteration: solve for p with the old q, then for q with the new p; both problems are
        convex.

        The shear force of an actuator turns a body on a high pin by more than the shear force that follows from the
        turn can bear: the iteration then begins with the force that follows from itself.
        """
        if self.pivot is None or self.actuator is None:
            return self._swept(p, q, self.Q)
        most = float(self.f.max()) * self.P
        found = {Q: self._swept(p, q, Q) for Q in (float(q.x.sum()), -most, most)}

        def excess(Q: float) -> float:
            if Q not in found:
                found[Q] = self._swept(p, q, Q)
            return float(found[Q][1].x.sum()) - Q

        if excess(most) < 0 < excess(-most):
            brentq(excess, -most, most, xtol=_SAME * most)
        return found[min(found, key=lambda Q: abs(excess(Q)))]

    def _swept(self, p: Solution, q: Solution, Q: float) -> Pair:
        """A sweep under the shear force ``Q``, which turns a body on a pivot."""
        n, pushed = len(self.gap), self.gap + self.yx @ q.x
        arms, about = None, 0.0
        if self.pivot:
            arms = self.pivot.arms
            reach = self.P * np.array([arms.min(), arms.max()])  # no pressure has a larger moment
            about = float(np.clip(self.pivot.moment - self.pivot.height * Q, *reach))
        pressed = press(self.yy, pushed, self.P, arms, about, (p.sides, p.turn))
        on = np.flatnonzero(pressed.x > 0)
        bound = self.f[on] * pressed.x[on]
        free = (self.kept - self.xy @ pressed.x)[on]
        if self.pivot:
            free = free + pressed.turn * self.pivot.height
        sheared = self._tangential_forces(submatrix(self.xx, on, on), free, bound, q.sides[on]).spread(on, n)
        moved = self.yx @ (sheared.x - q.x)  # opening due to the change of q, which p does not include yet
        left = np.abs(moved - moved[on].mean()) / np.diag(self.yy)
        if self.pivot:
            off = abs(self.pivot.of(pressed.x, sheared.x) - self.pivot.moment) / float(np.abs(self.pivot.arms).max())
            pressed = replace(pressed, imbalance=max(pressed.imbalance, off))
        return replace(pressed, residual=left), replace(sheared, turn=pressed.turn)

    def _tangential_forces(self, C: Array, free: Array, bound: Array, sides: Sides) -> Solution:
        """Tangential forces of the nodes that touch, for given normal ones. The end of an actuator is one more node,
        which always sticks, and bears what the others do."""
        if self.actuator is None:
            return solve_bounded(C, free, -bound, bound, self.Q, sides)
        # a uniform displacement under all forces, whose sum is 0, is part of the rigid shift
        uniform, all_bound = float(np.trace(C)) / len(C), np.append(bound, np.inf)
        every = np.pad(C, (0, 1)) + uniform
        every[-1, -1] += self.actuator
        found = solve_bounded(every, np.append(free, -self.Q), -all_bound, all_bound, 0.0, np.append(sides, 0))
        return replace(found, **{key: getattr(found, key)[:-1] for key in ("x", "rest", "residual")})

    def newton(self, p: Solution, q: Solution) -> Pair | None:
        """Solve for p and q together, iterating on the partition from that of ``p`` and ``q``; None if that fails."""
        touch, slip = p.x > 0, q.sides * (p.x > 0)
        fewest, chances, iteration, refined = 2 * len(touch), _PATIENCE, 0, False
        solver, found = None, None
        while chances > 0:
            iteration += 1
            if not (touch & (slip == 0)).any():
                return None
            solver = solver or self._solver(touch, slip)
            found = self._linear_solve(solver, touch, slip, refined, found)
            opening, rest = self._gap_and_slip(found, (0, 0) if refined else longest(touch & (slip == 0)))
            scale, (p_new, q_new, _) = self._scale(found), found
            noise = _ROUNDING * scale
            pushed = p_new - opening / np.diag(self.yy)
            augmented, bound = q_new - rest / np.diag(self.xx), self.f * p_new
            touches = pushed > noise[0]
            slips = (augmented > bound + noise[1]).astype(np.int8) - (augmented < -bound - noise[1])
            # nodes on the bound to rounding, where the loads return to an earlier state, go on as they are
            slips = touches * np.where((slip != 0) & (slip * augmented > bound - noise[1]), slip, slips)
            if np.array_equal(touches, touch) and np.array_equal(slips, slip):
                if not refined:
                    refined, iteration = True, iteration - 1
                    continue
                zero = np.zeros(len(self.gap))
                p_off, q_off, *turned_off = (np.abs(self._borne(found) - self._totals) / self._units).tolist()
                p_off, turn = max(p_off, *turned_off, 0.0), float(found.rigid[2]) if self.pivot else 0.0
                p_in, q_in = np.maximum(p_new, 0.0), np.clip(q_new, -bound, bound)
                p_rest, q_rest = np.where(touch, 0.0, np.maximum(opening, 0.0)), np.where(slip == 0, 0.0, rest)
                p_left = np.abs(p_new - np.maximum(pushed, 0.0)) + np.abs(p_new - p_in)
                q_left = np.where(touch, np.abs(q_new - np.clip(augmented, -bound, bound)), zero)
                return (
                    Solution(p_in, p_rest, p_left, p_off, iteration, iteration - 1, float(found.rigid[0]), turn),
                    Solution(q_in, q_rest, q_left, q_off, 0, 0, float(found.rigid[1]), turn),
                )
            wrong = int((touches != touch).sum() + (slips != slip).sum())
            chances = _PATIENCE if wrong < fewest else chances - 1
            touch, slip, fewest = touches, slips, min(wrong, fewest)
            refined = wrong <= _CLOSE and chances < _PATIENCE
            solver = found = None
        return None

    def _linear_solve(
        self, solve: _Solver, touch: Mask, slip: Sides, refined: bool, found: Forces | None = None
    ) -> Forces:
        """Forces of one partition, whose linear system ``solve`` solves: nodes that ``touch`` have no gap, nodes that
        stick keep their displacement, and q = ``slip`` f p at nodes that slip; ``refined`` to rounding, from those that
        were ``found``."""
        totals = self._totals
        found = found or solve(self._load, totals)
        if not refined:
            return found
        opening, rest = self._gap_and_slip(found)
        sticks = touch & (slip == 0)
        left = -np.stack([np.where(touch, opening, 0.0), np.where(sticks, rest, 0.0)])
        change = solve(left, totals - self._borne(found))
        return Forces(*(each + more for each, more in zip(found, change, strict=True)))

    def _scale(self, found: Forces) -> Array:
        """Scale (2, n) of rounding errors of the forces."""
        p, q, (approach, shift, *_) = found
        gap, kept = self._turned(found)
        return (np.abs(p).sum() + np.abs(q).sum()) + np.stack(
            [
                (np.abs(gap) + abs(approach)) / np.diag(self.yy),
                (np.abs(kept) + abs(shift)) / np.diag(self.xx),
            ]
        )

    def _gap_and_slip(self, found: Forces, but: tuple[int, int] = (0, 0)) -> Array:
        """Opening of the gap and slip increment under the forces, (2, n); zero, not calculated, at nodes from but[0] up
        to but[1], which stick."""
        p, q, (approach, shift, *_) = found
        gap, kept = self._turned(found)
        result = np.zeros((2, len(p)))
        for rows in (slice(0, but[0]), slice(but[1], None)):
            result[0, rows] = self.yy[rows] @ p + self.yx[rows] @ q + gap[rows] - approach
            result[1, rows] = self.xx[rows] @ q + self.xy[rows] @ p - kept[rows] - shift
        return result

    def _turned(self, found: Forces) -> tuple[Array, Array]:
        """The gap before loading, and what nodes that stick keep, (n,) each, between bodies that have turned."""
        if not self.pivot:
            return self.gap, self.kept
        along_y, along_x = found.rigid[2] * self.pivot.turned
        return self.gap - along_y, self.kept + along_x

    def _solver(self, touch: Mask, slip: Sides) -> _Solver:
        """Solver of the linear system of a partition: nodes that ``touch``, sides that ``slip``."""
        solve = self._solver_without_pivot(touch, slip)
        if not (pivot := self.pivot):
            return solve
        by_turn = solve(pivot.turned, np.zeros(2))
        rate = pivot.of(by_turn.p, by_turn.q)

        def turned(load: Array, totals: Array) -> Forces:
            found = solve(load, totals[:2])
            # a single node has no lever
            turn = (float(totals[2]) - pivot.of(found.p, found.q)) / rate if touch.sum() > 1 else 0.0
            p, q, rigid = (each + turn * more for each, more in zip(found, by_turn, strict=True))
            return Forces(p, q, np.append(rigid, turn))

        return turned

    def _solver_without_pivot(self, touch: Mask, slip: Sides) -> _Solver:
        """Solver as :meth:`_solver` for bodies that do not rotate."""
        if self.factors and (partition := self.factors.partition(touch, slip, self.f)):
            return partial(partition.solve, actuator=self.actuator)
        on, sticks = np.flatnonzero(touch), np.flatnonzero(touch & (slip == 0))
        i, end = len(on), len(on) + len(sticks)
        dragged = self.f[on] * slip[on]
        matrix = np.zeros((end + 2, end + 2))
        matrix[:i, :i] = submatrix(self.yy, on, on) + submatrix(self.yx, on, on) * dragged
        matrix[:i, i:end] = submatrix(self.yx, on, sticks)
        matrix[i:end, :i] = submatrix(self.xx, sticks, on) * dragged + submatrix(self.xy, sticks, on)
        matrix[i:end, i:end] = submatrix(self.xx, sticks, sticks)
        matrix[:i, -2] = matrix[i:end, -1] = -1  # rigid shifts
        matrix[-2, :i] = 1
        matrix[-1, :i], matrix[-1, i:end] = dragged, 1
        if self.actuator is not None:
            matrix[-1] *= self.actuator
            matrix[-1, -1] = 1
        factors = la.lu_factor(matrix, overwrite_a=True, check_finite=False)

        def solve(load: Array, totals: Array) -> Forces:
            solution = la.lu_solve(factors, np.concatenate([load[0][on], load[1][sticks], totals]), check_finite=False)
            p, q = np.zeros(len(touch)), np.zeros(len(touch))
            p[on] = solution[:i]
            q[on] = dragged * p[on]
            q[sticks] = solution[i:end]
            return Forces(p, q, solution[-2:])

        return solve


def punched(C: Relative, f: float, sides: Sides) -> tuple[Array, Array]:
    """Normal and tangential forces (n,) under a flat punch with the force 1 that covers all nodes, with friction; from
    the guess that nodes slip under q = ``sides`` f p (n,)."""
    assert C.xx is not None
    assert C.xy is not None
    zero = np.zeros(len(C.yy))
    guess = replace(resting(zero), x=zero + 1 / len(zero)), replace(resting(zero), rest=-sides.astype(float))
    p, q = solve(LoadStep(C.xx, C.yy, C.xy, C.opening, zero + f, 1.0, zero, 0.0, zero), [guess])
    return p.x, q.x


def solve_near(step: LoadStep, starts: Sequence[Pair], trail: Trail | None, key: Hashable) -> Pair:
    """Solve one step, first from what the ``trail`` knows of it under its ``key``. The first of the ``starts`` is the
    step before.

    Raises
    ------
    PartialslipError
        If two steps in turn do not converge: under very large friction a step may have no solution, and all that follow
        would take long and converge as little. The residual of a single one stands in the certificate.
    """
    found = solve(step, [*starts, *(trail.starts(key) if trail else [])])
    residuals = [float(p.residual.max()) / step.P for p, _ in (starts[0], found)]
    if min(residuals) > _UNSOLVED:
        raise PartialslipError(
            f"friction.f = {step.f.max():.6g}: load steps do not converge (residual {residuals[1]:.0e} P): too large "
            "where shear changes the pressure; take a smaller f: the contact sticks nearly everywhere in any case; "
            "or effects.coupling = false"
        )
    if trail:
        trail.keep(key, found)
    return found


def solve(step: LoadStep, starts: Sequence[Pair]) -> Pair:
    """Solve one step by Newton's method on the partition, from the partitions of ``starts``.

    If no iteration converges, a fixed-point sweep, which contracts unless friction is very large, gives the next start.
    The iteration ends when sweeps stop reducing the residual, at rounding.
    """
    iterations, changes, least, chances = 0, 0, np.inf, _PATIENCE
    while chances > 0:
        for p, q in reversed(starts):
            if (p.x > 0).any() and (together := step.newton(p, q)):
                p, q = together
                return p, replace(q, iterations=iterations, changes=changes)
        p, q = step.sweep(*starts[0])
        starts = [(p, q)]
        iterations += p.iterations + q.iterations
        changes += p.changes + q.changes
        left = float(p.residual.max())
        chances = _PATIENCE if left < least else chances - 1
        least = min(left, least)
    return replace(p, iterations=0, changes=0), replace(q, iterations=iterations, changes=changes)
