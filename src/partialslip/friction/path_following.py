"""Coulomb friction along a straight leg of the load path, exactly in time, event by event.

The rates of all nodes are constant between two events. At an event a node reaches its bound and begins to slip; held
nodes whose slip would reverse re-stick; where the pressure varies, nodes touch and open. Each change of a node is
a principal pivot (:class:`partialslip.friction.tableau.Tableau`). There are no load steps, and no errors of load
steps. This is parametric quadratic programming; the rates after an event are found by principal pivoting (Keller,
1973).

Nodes on a bound s f p have the rates s f p', and what they have besides, tau = T' - s f p', is what obeys the law of
constant bounds: tau = 0 where they slip, and s tau <= 0 where they stick. Open nodes are nodes that slip without
forces.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import scipy.linalg as la

from partialslip.friction.active_set import Solution, inverse
from partialslip.friction.tableau import Tableau
from partialslip.tools.arrays import Array, Indices, Mask
from partialslip.tools.errors import PartialslipError

_EPS = float(np.finfo(float).eps)
_AT = 1e-12  # accuracy: distance from the bound, relative: a thousand roundings of the forces that many events add up
_CHECKED = 64  # cost: pivots after which the rates are checked by a product with C, at the cost of one more pivot
_DRIFT = 1e-11  # cost: error of the rates, relative to their sum, from which on the tableau is set up anew
_ADDED, _SEEN = 1e-13, 1e-9  # accuracy: errors that events add up, in the bounds: corrected on the way; left to be seen
_GIVE = 8  # limit: rounds in which nodes that corrections push beyond their bounds are let slip
_MOST = 50  # limit: pivots per node in a leg: a stick zone that crosses the contact moves each node in and out once


class NothingSticksError(PartialslipError):
    """No node sticks."""


class Bounds(NamedTuple):
    """Normal forces along a leg, or f times these, which bound tangential ones: ``values`` (k + 1, n) where lambda is
    ``at`` (k + 1,), from 0 to 1, linear between. Nodes touch and open at these lambda only: they are open between two
    zeros."""

    at: Array
    values: Array

    @classmethod
    def constant(cls, values: Array) -> "Bounds":
        """Constant bounds ``values`` (n,)."""
        return cls(np.array([0.0, 1.0]), np.array([values, values]))

    @property
    def reversed(self) -> "Bounds":
        """Bounds along the reversed load segment."""
        return Bounds(1.0 - self.at[::-1], self.values[::-1])

    def of(self, nodes: Indices) -> "Bounds":
        """Bounds of some ``nodes`` only (indices)."""
        return self._replace(values=self.values[:, nodes])

    def times(self, factor: Array) -> "Bounds":
        """Bounds times a ``factor`` (n,)."""
        return self._replace(values=factor * self.values)

    def stages(self, shares: Sequence[float]) -> Array:
        """Bounds (s, n) at the ``shares`` of the leg (s,)."""
        place = np.interp(shares, self.at, np.arange(len(self.at)))
        before = np.minimum(place.astype(np.int64), len(self.at) - 2)
        weight = (place - before)[:, None]
        return (1 - weight) * self.values[before] + weight * self.values[before + 1]


@dataclass(frozen=True)
class Leg:
    """Tangential forces and slip of n nodes along a leg, on which lambda goes from 0 to 1.

    Parameters
    ----------
    forces : (n,) array
        Tangential forces T at the end.
    rest : (n,) array
        Minus the slip of nodes in contact: C (T - T_start) - g - shift at nodes that never open.
    path : (n,) array
        Length of the path of slip, \\|slip\\| added up both ways.
    lowest, highest : (n,) arrays
        Smallest and largest forces along the leg, its ends included.
    began, stuck : (n,) arrays
        lambda at which a node last began to slip, and at which it last began to re-stick; nan: never.
    slips : (n,) bool array
        Nodes that slip at the end.
    dissipated : float
        Work against friction.
    stages, shifts : (s, n), (s,) array
        Forces, and rigid shift, at the requested stages.
    residual : (n,) array
        Errors in units of force: of the displacements, by a product with C, and of the bounds.
    imbalance : float
        Distance of the sum of forces from the prescribed one.
    shift : float
        Rigid shift.
    events, pivots : int
        Number of instants at which rates changed, and of nodes that changed between sticking and slipping.
    moves : (k, 2) array
        lambda, and the rigid shift, at the beginning of the leg, at each event and at the end: straight between.
    """

    forces: Array
    rest: Array
    path: Array
    lowest: Array
    highest: Array
    began: Array
    stuck: Array
    slips: Mask
    dissipated: float
    stages: Array
    shifts: Array
    residual: Array
    imbalance: float
    shift: float
    events: int
    pivots: int
    moves: Array

    @property
    def mirrored(self) -> "Leg":
        """The leg from minus the forces under minus the loads, without events of its own."""
        turned = {key: -getattr(self, key) for key in ("forces", "rest", "stages", "shifts", "shift")}
        turned["moves"] = self.moves * [1, -1]
        return replace(self, lowest=-self.highest, highest=-self.lowest, events=0, pivots=0, **turned)

    @property
    def solution(self) -> Solution:
        """The end of the leg, as one step."""
        return Solution(self.forces, self.rest, self.residual, self.imbalance, 1, self.pivots, self.shift)

    def changed(self, slips: Mask) -> Array:
        """Share of the leg at which each node last began to slip or to stick, (n,); nan at nodes other than ``slips``:
        they slip so little that they do not slip in the steady state."""
        return np.where(slips, np.where(self.slips, self.began, self.stuck), np.nan)

    @property
    def slipped(self) -> Array:
        """Slip along +x and along -x, (2, n)."""
        return np.array([self.path - self.rest, self.path + self.rest]) / 2


def joined(shifts: Sequence[Array]) -> Array:
    """Rigid shifts since the beginning of consecutive legs, from the shifts since each leg began."""
    begins = np.cumsum([0.0, *(leg[-1] for leg in shifts)])
    return np.concatenate([begin + leg for begin, leg in zip(begins.tolist(), shifts, strict=False)])


def noise(rate: Array, g: Array, shift: float, diagonal: Array) -> Array:
    """Rounding errors (n,) of the rates of forces (n,) under the rates ``g`` (n,) and ``shift`` of displacements;
    ``diagonal`` (n,) is that of the compliance."""
    return 16 * _EPS * (float(np.abs(rate).sum()) + (np.abs(g) + abs(shift)) / diagonal)


class Follower:
    """Follows straight legs of one contact in turn.

    Parameters
    ----------
    C : (n, n) array
        Relative compliance of the nodes, symmetric positive definite.
    inverted : (n, n) array, optional
        Inverse of ``C``, where it is known.
    """

    def __init__(self, C: Array, inverted: Array | None = None) -> None:
        self._C, self._diagonal = C, np.diag(C).copy()
        self._tableau = Tableau(inverse(C) if inverted is None else inverted)

    def leg(self, bounds: Bounds, start: Array, g: Array, Q: float, stages: Sequence[float] = ()) -> Leg:
        """Follow one leg.

        Parameters
        ----------
        bounds : Bounds
            f times the normal forces.
        start : (n,) array
            Tangential forces at the beginning, not beyond the bounds.
        g : (n,) array
            Change of the free relative displacements over the leg, up to a rigid shift.
        Q : float
            Change of the sum of the forces over the leg.
        stages : sequence of float
            Ascending lambda in [0, 1] at which forces are returned.

        Raises
        ------
        SlidesError
            If no node sticks.
        PartialslipError
            If nodes change between sticking and slipping again and again, which only rounding errors can cause.
        """
        return _Leg(self._C, self._diagonal, bounds, self._tableau, start, g, Q).followed(stages)


class _Leg:
    """A leg on its way: forces, rates, and which nodes stick.

    ``sides`` (n,) are 1 and -1 at nodes that lie on the upper and the lower bound, 0 between the bounds. Slipping nodes
    lie on a bound, or are open. Of the others, those on a bound have just been released: they may not be pushed beyond
    it. ``along`` (n,) are the rates with which nodes follow their bounds.
    """

    def __init__(
        self, C: Array, diagonal: Array, bounds: Bounds, tableau: Tableau, start: Array, g: Array, Q: float
    ) -> None:
        self._C, self._diagonal, self._bounds, self._tableau = C, diagonal, bounds, tableau
        self._start, self._g, self._Q = start, g, Q
        self._least = _AT * bounds.values.max(axis=0)  # distance from the bound that is none
        count = len(start)
        self._bound, self._slope = bounds.values[0].copy(), np.zeros(count)
        self._forces = start.copy()
        on = (np.abs(start) >= self._bound - self._least) & (self._bound > 0)
        self._sides = np.where(on, np.sign(start), 0).astype(np.int8)
        self._open = np.zeros(count, dtype=bool)
        self._at, self._rest, self._path, self._shift = 0.0, np.zeros(count), np.zeros(count), 0.0
        self._slip, self._dissipated = np.zeros(count), 0.0
        self._lowest, self._highest = start.copy(), start.copy()
        self._beyond = np.zeros(count)
        self._began, self._stuck = np.full(count, np.nan), np.full(count, np.nan)
        self._along = np.zeros(count)
        self._pivots = 0
        self._checked = 0
        self._moves = [(0.0, 0.0)]

    def followed(self, stages: Sequence[float]) -> Leg:
        wanted, states, events = [*stages], list[tuple[Array, float]](), 0
        for piece, end in enumerate(self._bounds.at[1:].tolist()):
            self._enter(piece)
            while True:
                self._settle()
                if self._tableau.pivots - self._checked >= _CHECKED:
                    self._refresh_tableau()
                node, way, step = self._next(end)
                rate = self._rate()
                while wanted and wanted[0] <= self._at + step:
                    share = wanted.pop(0) - self._at
                    states.append((self._forces + share * rate, self._shift + share * float(self._p[-1])))
                self._advance(rate, step)
                if node is None:
                    break
                self._put(node, way)
                self._forces[node] = way * self._bound[node]
                events += 1
            self._at = end
        return self._result(states, events)

    def _enter(self, piece: int) -> None:
        """Begin a piece of the leg, in which no node touches or opens."""
        (begin, end), (before, after) = (each[piece : piece + 2] for each in self._bounds)
        self._bound, self._slope = before.copy(), (after - before) / (end - begin)
        was, self._open = self._open, (before <= 0) & (after <= 0)
        self._forces = np.where(self._sides != 0, self._sides * before, self._forces)
        closing = self._open & ~was
        self._beyond = np.maximum(self._beyond, np.where(closing, np.abs(self._forces), 0.0))
        self._forces[closing], self._sides[closing] = 0.0, 0
        if piece == 0:
            self._along = self._sides * self._slope
            self._begin()
            self._checked = self._tableau.pivots
            return
        for node in np.flatnonzero(closing & self._tableau.sticks).tolist():
            self._change(node)
        for node in np.flatnonzero(was & ~self._open).tolist():
            self._sides[node] = self._beside(node, was)
            if self._sides[node] == 0:
                self._change(node)
        self._along = self._sides * self._slope
        self._set_rates()

    def _beside(self, node: int, was: Mask) -> int:
        """Bound on which nodes slip beside the ``node`` that touches; 0 if they stick. Open nodes ``was`` (n,)."""
        near = [each for each in (node - 1, node + 1) if 0 <= each < len(was) and not (was[each] or self._open[each])]
        return int(self._sides[near[0]]) if near and not self._tableau.sticks[near[0]] else 0

    def _change(self, node: int) -> None:
        """Let the ``node`` stick if it is open, and be open if it sticks."""
        self._tableau.pivot(node, self._tableau.column(node))
        self._pivots += 1

    def _result(self, states: Sequence[tuple[Array, float]], events: int) -> Leg:
        self._refine()
        off = np.abs(self._displacement_errors()) / self._diagonal
        change = self._forces - self._start
        return Leg(
            forces=self._forces,
            rest=self._slip,
            path=self._path,
            lowest=self._lowest,
            highest=self._highest,
            began=self._began,
            stuck=self._stuck,
            slips=~(self._tableau.sticks | self._open),
            dissipated=self._dissipated,
            stages=np.array([forces for forces, _ in states]).reshape(-1, len(change)),
            shifts=np.array([shift for _, shift in states]),
            residual=np.maximum(off, self._beyond),
            imbalance=abs(float(change.sum()) - self._Q),
            shift=self._shift,
            events=events,
            pivots=self._pivots,
            moves=np.array(self._moves),
        )

    def _refine(self, least: float = 0.0) -> None:
        """Correct the rounding errors that the events have added up, by a product with C, if they are ``least`` of the
        bounds or more; errors that are more than rounding are left to be seen. Nodes that stick at their bounds, and
        would get beyond them, slip a little instead: a force that is cut off at its bound is an error at all others."""
        tableau, sticks, off = self._tableau, self._tableau.sticks, self._displacement_errors()
        whole = float(self._bound.sum())
        if not least * whole <= float((np.abs(off) / self._diagonal).max()) <= _SEEN * whole:
            return
        p = alone = tableau.solve(-off, self._at * self._Q - float((self._forces - self._start).sum()))
        give, slip = np.empty(0, dtype=np.int64), off[:0]
        for _ in range(_GIVE):
            forces = self._forces - np.where(sticks, p[:-1], 0.0)
            bounded = np.clip(forces, -self._bound, self._bound)
            beyond = np.setdiff1d(np.flatnonzero(forces != bounded), give)
            if not len(beyond) or len(give) + len(beyond) >= np.count_nonzero(sticks):  # one is to stick
                break
            give = np.union1d(give, beyond)
            columns = tableau.columns(give)
            held = self._forces[give] - alone[give]
            excess = held - np.clip(held, -self._bound[give], self._bound[give])
            slip = la.solve(columns[give], excess)
            p = alone + columns @ slip
        self._forces = np.clip(self._forces - np.where(sticks, p[:-1], 0.0), -self._bound, self._bound)
        more = np.where(sticks, 0.0, p[:-1])
        more[give] += slip
        self._rest = self._rest + more
        self._slip = self._slip + np.where(self._open, 0.0, more)
        self._path = np.maximum(self._path, np.abs(self._slip))
        self._shift += float(p[-1])

    def _displacement_errors(self) -> Array:
        """Errors of the displacements summed up along the leg, (n,): C (F - F_start) less that sum."""
        return self._C @ (self._forces - self._start) - self._at * self._g - self._shift - self._rest

    def _begin(self) -> None:
        """Begin with the nodes that slipped last, or with none: whichever is nearer to the rates of this leg."""
        tableau = self._tableau
        slipping, free = ~tableau.sticks, self._open | (self._sides != 0)
        if slipping.any():
            if not (free[slipping].all() and slipping[self._open].all()):
                tableau.restart(np.flatnonzero(self._open | (slipping & free)))
            self._set_rates()
            wrong = np.count_nonzero(self._room() < -self._tolerance())
            if 2 * wrong <= np.count_nonzero(~(tableau.sticks | self._open)):
                return
        if slipping.any() or self._open.any():
            tableau.restart(np.flatnonzero(self._open))
        self._set_rates()

    def _set_rates(self) -> None:
        self._p = self._tableau.solve(self._g, self._Q, self._along)
        self._noise = noise(self._rate(), self._g, float(self._p[-1]), self._diagonal)

    def _put(self, node: int, side: int) -> None:
        """Let the ``node``, which sticks, be on the bound ``side``, or 0, between the bounds."""
        self._sides[node] = side
        self._p[node] += side * self._slope[node] - self._along[node]
        self._along[node] = side * self._slope[node]

    def _rate(self) -> Array:
        """T' (n,)."""
        return np.where(self._tableau.sticks, -self._p[:-1], 0.0) + self._along

    def _room(self) -> Array:
        """Rates that must be >= 0, (n,): of T away from the moving bound at nodes on it that stick, of slip along T at
        nodes that slip; 0 at all other nodes."""
        return np.where(self._tableau.sticks, self._sides, -self._sides) * self._p[:-1]

    def _tolerance(self) -> Array:
        """Rates of :meth:`_room` that count as zero, (n,): rounding errors, or changes below ``_AT`` of the bound over
        the leg."""
        return np.maximum(self._noise, self._least) * np.where(self._tableau.sticks, 1.0, self._diagonal)

    def _settle(self) -> None:
        """Find which of the nodes on their bounds slip: no node is pushed beyond its bound, and none slips against its
        traction."""
        while True:
            tolerance = self._tolerance()
            room = self._room()
            # a leg on which nothing moves has no tolerance, and no room
            beyond = np.divide(room, tolerance, out=np.where(room < 0, -np.inf, 0.0), where=tolerance > 0)
            worst = int(np.argmin(beyond))
            if room[worst] >= -tolerance[worst]:
                return
            self._drive(worst)

    def _drive(self, node: int) -> None:
        """Change the ``node``, whose rate has the wrong sign, between sticking and slipping.

        Its other rate grows from zero until the wrong one vanishes. Nodes whose rates would get a wrong sign on the way
        change first. As C is positive definite, this ends.
        """
        way, total = -int(self._sides[node]), 0.0
        while True:
            column = self._tableau.column(node)
            room = self._room()
            falls = -way * np.where(self._tableau.sticks, self._sides, -self._sides) * column[:-1]
            falls[node] = 0.0
            blocks = (falls > 0) & (room >= -self._tolerance())
            steps = np.divide(np.maximum(room, 0.0), falls, out=np.full(len(room), np.inf), where=blocks)
            first = int(np.argmin(steps))
            # the last sticking node bears the change of Q: it is relieved by the next one that sticks only
            last = self._tableau.sticks[node] and np.count_nonzero(self._tableau.sticks) == 1
            whole = np.inf if last else -self._p[node] / column[node] * way
            if last and not np.isfinite(steps[first]):
                raise NothingSticksError("friction: the contact slides; |Q| must be less than f P along the leg")
            if whole <= steps[first]:
                total += way * whole
                self._p += way * whole * column
                self._pivot(node, column, total)
                return
            total += way * float(steps[first])
            self._p += way * float(steps[first]) * column
            self._pivot(first, self._tableau.column(first), 0.0)

    def _pivot(self, node: int, column: Array, rate: float) -> None:
        """Let the ``node`` slip at r' = ``rate``, or stick at T' = ``rate``."""
        began = bool(self._tableau.sticks[node])
        self._tableau.pivot(node, column)
        self._p[node] = rate if began else -rate
        (self._began if began else self._stuck)[node] = self._at
        self._pivots += 1
        if self._pivots > _MOST * (len(self._bound) + 1):
            raise PartialslipError(
                f"friction: {self._pivots:,} changes between stick and slip of {len(self._bound):,} nodes in one leg, "
                "without an end; the compliance is ill-conditioned"
            )

    def _refresh_tableau(self) -> None:
        """Factor the tableau again if its rates do not solve C F' = g + shift' + slip' within rounding, and correct the
        displacements that the events have summed up: their rounding errors grow as elements shrink."""
        rate, tableau = self._rate(), self._tableau
        rest = np.where(tableau.sticks, 0.0, self._p[:-1])
        off = np.abs(self._C @ rate - self._g - self._p[-1] - rest) / self._diagonal
        if (off > np.maximum(_DRIFT * float(np.abs(rate).sum()), self._noise)).any():
            tableau.restart(np.flatnonzero(~tableau.sticks))
            self._set_rates()
            self._settle()
        self._refine(_ADDED)
        self._checked = tableau.pivots

    def _next(self, end: float) -> tuple[int | None, int, float]:
        """The node that reaches a bound next, which one, and the lambda up to there; None if none does before the
        ``end`` of the piece."""
        rate, left = self._rate(), end - self._at
        first, way, least = None, 0, left
        for side in (1, -1):
            closing = side * rate - self._slope
            moves = self._tableau.sticks & (closing > 0) & (side * self._sides <= 0)
            distance = np.maximum(self._bound - side * self._forces, 0.0)
            steps = np.divide(distance, closing, out=np.full(len(rate), np.inf), where=moves)
            node = int(np.argmin(steps))
            if steps[node] < least:
                first, way, least = node, side, float(steps[node])
        return first, way, least

    def _advance(self, rate: Array, step: float) -> None:
        if step > 0:
            slip = np.where(self._tableau.sticks, 0.0, step * self._p[:-1])
            self._rest += slip
            slip[self._open] = 0.0
            self._slip += slip
            self._path += np.abs(slip)
            self._forces += step * rate
            self._dissipated += float(np.abs(slip) @ (self._bound + step / 2 * self._slope))
            self._bound += step * self._slope
            self._shift += step * float(self._p[-1])
            np.minimum(self._lowest, self._forces, out=self._lowest)
            np.maximum(self._highest, self._forces, out=self._highest)
            np.maximum(self._beyond, np.abs(self._forces) - self._bound, out=self._beyond)
            self._at += step
            self._moves.append((self._at, self._shift))
            away = self._bound - self._sides * self._forces > self._least
            for node in np.flatnonzero(self._tableau.sticks & away & (self._sides != 0)).tolist():
                self._put(node, 0)
