"""Cycles of a path of loads: goes on until nothing changes, and records forces and slip. The law of friction is in
:mod:`partialslip.friction.active_set`, and in the modules that begin with ``coulomb`` and ``coupled``.

Scaled: lengths by sqrt(A R P), forces by P and displacements by A P, so that nothing depends on units.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from numpy.lib.stride_tricks import sliding_window_view

from partialslip.friction.active_set import Solution
from partialslip.friction.limit import LIMIT, SLIPS, Cycles, ahead, limit, lost, room_of
from partialslip.friction.load_path import Path
from partialslip.friction.zone_ends import turning_points
from partialslip.tools.arrays import Array, Mask
from partialslip.tools.telling import tell

STEADY = 1e-6  # accuracy: change of q from cycle to cycle, relative to the range of q or to f p0, that counts as none
# accuracy: change over a cycle, in f p, that ends cycles near enough to the limit for ratios of changes to tell it
_NEAR = 1e-6
_BESIDE = 5  # accuracy: neighbouring nodes of which the one that moves most tells how far the steady state is
# accuracy: slip, in A times the sum of the bounds, that is rounding: forces are known to 1e-16 of their sum, and the
# compliance of the finest cells adds up 1e5 of them
_ROUNDED = 1e-10
# accuracy: slip of nodes that stay in contact, in that of nodes that open, below which they settle
_NO_SLIP = 1e-3
_CREEPS = 0.5  # accuracy: of the path of slip in a cycle: net slip from which on a node creeps


@dataclass(frozen=True)
class History:
    """Tangential forces, slip and dissipation along a path, at n nodes; scaled.

    Parameters
    ----------
    path : Path
    points : list of Solution
        Solutions at the load points in turn, each with the residuals of all steps since the previous load point.
    at_ends : two (n,) arrays
        Tangential forces at load points 1 and 2 of the last cycle.
    q1, q2 : (n,) arrays
        Equal to ``at_ends``; out of phase the smallest and the largest tangential forces of the last cycle, at
        constant pressure at its load points.
    pressures : two (n,) arrays
        Normal forces at load points 1 and 2.
    slip : (n,) array
        Slip from load point 1 to 2 of the last cycle.
    net_slip : (n,) array
        Slip over the whole last cycle; zero in a steady state.
    dissipated : float
        Work against friction over the last cycle.
    load_steps : int
        Number of load steps solved; at constant pressure, of legs.
    slipped : (2, n) array or None
        Slip of the last cycle along +x and along -x; None for coupled bodies.
    held : (n,) bool array or None
        Where the pressure varies: nodes that are in contact throughout the last cycle.
    around : Steps
        The load steps of the last cycle.
    turns : bool
        In phase: whether slip reverses on a leg of the last cycle.
    changed : (n,) array or None
        In phase: share of the leg to load point 2 at which a node last began to slip or to stick; nan where it did
        neither. None if the leg was not followed.
    stuck : (n,) array or None
        On the same leg: share at which a node last re-stuck, whether or not it slipped once more; nan where it
        never did.
    events : int
        Number of instants at which rates change, on legs that are followed.
    rooms : (k, n) array or None
        Room 2 f p - \\|dq\\| in each of the last cycles in turn, at most 3; None if no cycles were followed.
    steady : bool
        Whether the last cycle is steady: q changed by no more than ``path.steady`` of its bound, and of each node it is
        known whether it slips in the steady state.
    """

    path: Path
    points: list[Solution]
    at_ends: tuple[Array, Array]
    q1: Array
    q2: Array
    pressures: tuple[Array, Array]
    slip: Array
    net_slip: Array
    dissipated: float
    load_steps: int
    around: "Steps"
    slipped: Array | None = None
    held: Mask | None = None
    turns: bool = False
    changed: Array | None = None
    stuck: Array | None = None
    events: int = 0
    rooms: Array | None = None
    steady: bool = True

    def of(self, nodes: npt.NDArray[np.int64]) -> "History":
        """History of some ``nodes`` only (indices)."""
        points = [
            replace(step, x=step.x[nodes], rest=step.rest[nodes], residual=step.residual[nodes]) for step in self.points
        ]
        fields: dict[str, Any] = {key: getattr(self, key)[nodes] for key in ("q1", "q2", "slip", "net_slip")} | {
            key: tuple(each[nodes] for each in getattr(self, key)) for key in ("at_ends", "pressures")
        }
        fields["around"] = self.around.of(nodes)
        some = {key: getattr(self, key) for key in ("slipped", "held", "changed", "stuck", "rooms")}
        fields |= {key: each[..., nodes] for key, each in some.items() if each is not None}
        return replace(self, points=points, **fields)

    @property
    def visited(self) -> list[tuple[Array, Array]]:
        """q and the bound f p at the load points of the first two cycles and of the last cycle, for
        :func:`partialslip.friction.zone_ends.kinks`."""
        cycle = len(self.path.cycle)
        bounds = dict(zip(self.path.ends, self.bounds, strict=True))
        numbers = sorted({*range(2 * cycle + 1), *range(len(self.points) - cycle, len(self.points))})
        known = [number for number in numbers if 0 <= number < len(self.points)]
        return [(self.points[number].x, bounds.get((number - 1) % cycle, self.bound)) for number in known]

    @property
    def end(self) -> tuple[Array, Array]:
        """Tangential and normal forces at the end of the path, (n,) each."""
        return self.points[-1].x, self.around.pressures[-1]

    @property
    def f(self) -> Array:
        """Coefficient of friction, (n,)."""
        return self.around.f

    @cached_property
    def room(self) -> Array | None:
        r"""Room of q up to f p plus room down to -f p, the least of each in the last cycle, (n,), out of phase under
        varying pressure; zero where a node slips both ways or opens. None elsewhere: there it is f (p_1 + p_2) - \|q_2
        - q_1\|."""
        if self.path.in_phase or not self.path.presses_anew:
            return None
        forces, bounds = self.around.forces, self.around.bounds
        return np.maximum((bounds - forces).min(axis=0) + (bounds + forces).min(axis=0), 0.0)

    @property
    def bound(self) -> Array:
        """Half of the admissible range of q: the mean of the bounds at load points 1 and 2."""
        first, second = self.bounds
        known = (first + second) / 2
        return known if self.room is None else (self.room + np.abs(self.change)) / 2

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Friction bounds f p at load points 1 and 2."""
        return self.f * self.pressures[0], self.f * self.pressures[1]

    @property
    def change(self) -> Array:
        """q2 - q1."""
        return self.q2 - self.q1

    @property
    def shifts(self) -> tuple[float, float]:
        """Rigid shift from the beginning of the path to load points 1 and 2 of the last cycle; nan where cycles were
        skipped."""
        since = np.cumsum([step.shift for step in self.points])[-len(self.path.cycle) :]
        return float(since[self.path.ends[0]]), float(since[self.path.ends[1]])

    @property
    def angles(self) -> tuple[float, float]:
        """Angles by which a body on a pin has turned at load points 1 and 2 of the last cycle."""
        first, second = (self.points[end - len(self.path.cycle)].turn for end in self.path.ends)
        return first, second

    @property
    def repeats(self) -> bool:
        """Whether q changed over the last cycle by less than ``STEADY`` times the change over half a cycle."""
        return bool(self._cycle_change.max() <= STEADY * np.abs(self.change).max())

    @property
    def _cycle_change(self) -> Array:
        """Change of the forces over the last cycle, (n,), without sign."""
        return np.abs(self.points[-1].x - self.points[-1 - len(self.path.cycle)].x)

    @property
    def unsteady(self) -> Array | None:
        r"""Room 2 f p - \|dq\| that vanishes in the steady state, (n,); None if no cycles were followed.

        Room with the limit zero vanishes (:func:`partialslip.friction.limit.lost`). At re-stuck nodes, changes d of q
        per cycle in geometric progression add up to d r/(1 - r), with r the ratio of the last two, and 1 - r known
        within a factor of two; changes that fall like a power of the cycles count as d times the number of cycles
        taken. d is the largest of a node and its neighbours, as a single node may hardly move by chance. At constant
        pressure half cycles of a steady state mirror each other: nodes that slip towards load point 2 slip towards load
        point 1, too, and lose all of their room.
        """
        if self.rooms is None:
            return None
        room = 2 * self.bound - np.abs(self.change)
        gone = np.where(lost(self.rooms), room, 0.0)
        if self.changed is None or self.lasting is None:
            return gone
        changed = np.isfinite(self.changed)
        moved, lasts = self._moved_beside(0), np.full_like(room, max(LIMIT, self.cycles))
        if self.cycles > 1 and 0 < self.path.settled <= _NEAR:
            falls = np.maximum(self._moved_beside(1) - moved, 0.0)
            lasts = np.minimum(np.maximum(np.divide(2 * moved, falls, out=lasts.copy(), where=falls > 0), 1.0), lasts)
        gone = np.where(changed, np.maximum(gone, lasts * self.bound * moved), gone)
        if self.stuck is not None and not self.path.presses_anew:
            slips = np.isfinite(self.lasting) & ~(self.stuck >= self.lasting)
            gone = np.where(slips, np.maximum(room, gone), gone)
        return gone

    def _moved_beside(self, ago: int) -> Array:
        """Largest change of q over a cycle, relative to the bound, of each node and its neighbours, (n,): over the last
        cycle, or the one so many cycles ``ago``; of nodes that change between sticking and slipping alone."""
        cycle = len(self.path.cycle)
        last = len(self.points) - 1 - ago * cycle
        off = np.abs(self.points[last].x - self.points[last - cycle].x)
        counts = (self.bound > 0) & (np.isfinite(self.changed) if self.changed is not None else True)
        moved: Array = np.divide(off, self.bound, out=np.zeros_like(off), where=counts)
        return sliding_window_view(np.pad(moved, _BESIDE // 2), _BESIDE).max(axis=-1)

    @property
    def reverses(self) -> bool:
        """In phase: whether slip reverses on a leg of the last cycle: on the way, or from load step to load step."""
        return self.path.in_phase and (self.turns or self.path.turns or bool(self.around.reversing.any()))

    @property
    def ratchets(self) -> float:
        """Largest net slip of the last cycle, relative to the largest slip of half a cycle, of nodes that stay in
        contact; nearly 0 if they do not slip."""
        held = np.min([*self.pressures, *self.around.pressures], axis=0) > 0  # nodes that open may close elsewhere
        if self.held is not None:
            held = self.held
        if not held.any():
            return 0.0
        half = float(np.abs(self.slip[held]).max())
        half = max(half, _NO_SLIP * float(np.abs(self.slip).max()), _ROUNDED * float(self.bound.sum()))
        return float(np.abs(self.net_slip[held]).max()) / half if half > 0 else 0.0

    @property
    def cycles(self) -> int:
        """Number of cycles followed; 0 if the first loading determines the cycle."""
        return 0 if self.path.half else len(self.points) // len(self.path.cycle)

    @property
    def slips(self) -> Mask:
        """Nodes that slip from load point 1 to 2, (n,)."""
        return np.abs(self.change) >= (2 - SLIPS) * self.bound

    @property
    def never_slips(self) -> Mask | None:
        """Nodes that do not slip in the last cycle, (n,); None where this is not known."""
        if self.slipped is None:
            return None
        most = self.slipped.sum(axis=0)
        return most <= SLIPS * float(most.max())

    @property
    def creeps(self) -> Mask | None:
        """Nodes (n,) with net slip over the last cycle: they creep to their place under mean loads and do not slip in
        the steady state. None if not known."""
        if self.slipped is None:
            return None
        forth, back = self.slipped
        return np.abs(forth - back) > _CREEPS * (forth + back)

    @property
    def still(self) -> Mask | None:
        """Nodes that do not slip in the steady state, (n,): those that do not in the last cycle, and those that creep.
        None where this is not known."""
        never, creeps = self.never_slips, self.creeps
        return None if never is None or creeps is None else never | creeps

    def turning(self, x: Array) -> list[float]:
        """Points where an end of the stick zone reversed, between the nodes ``x`` (n,); none where this is not
        known."""
        still = self.still if self.turns else None
        return [] if still is None else turning_points(x, still, self.slips)

    @property
    def lasting(self) -> Array | None:
        """``changed``, and nan at nodes that creep: when nodes began to slip, or to stick, that do so in every cycle.
        None if this is not known."""
        if self.changed is None or self.creeps is None:
            return self.changed
        return np.where(self.creeps, np.nan, self.changed)

    @property
    def opposing(self) -> int:
        """Number of nodes that slip in the less frequent direction from load point 1 to 2."""
        ways = np.sign(self.change[self.slips & (self.bound > 0)])
        return int(min((ways > 0).sum(), (ways < 0).sum()))

    @property
    def iterations(self) -> int:
        """Linear solves of the active-set iteration."""
        return sum(step.iterations for step in self.points)

    @property
    def changes(self) -> int:
        """Changes of the sets of sticking and slipping nodes; 0 if one linear solve per step sufficed."""
        return sum(step.changes for step in self.points)


SHEARS: dict[str, Callable[[History], Array]] = {
    "q": lambda history: history.change,
    "q1": lambda history: history.q1,
    "q2": lambda history: history.q2,
}


class Steps(NamedTuple):
    """Load steps of a cycle: the ways to each load point, as ascending fractions up to 1, and the states at the ends of
    the steps, in turn: tangential ``forces`` (s, n), and normal forces, ``pressures`` (s, n), or (1, n) where they are
    constant; with the coefficient of friction ``f`` (n,), and the rigid ``shifts`` (s,) since the cycle began."""

    ways: tuple[tuple[float, ...], ...]
    forces: Array
    pressures: Array
    f: Array
    shifts: Array

    def of(self, nodes: npt.NDArray[np.int64]) -> "Steps":
        """Steps of some ``nodes`` only (indices)."""
        return self._replace(forces=self.forces[:, nodes], pressures=self.pressures[:, nodes], f=self.f[nodes])

    @property
    def bounds(self) -> Array:
        """Friction bounds f p (s, n)."""
        return np.broadcast_to(self.f * self.pressures, self.forces.shape)

    @property
    def reversing(self) -> Mask:
        """Nodes (n,) that slip at the end of a step, and stick or slip the other way at the end of the next step on the
        same leg, still in contact."""
        bounds = self.bounds
        ways = np.where((np.abs(self.forces) >= (1 - SLIPS) * bounds) & (bounds > 0), np.sign(self.forces), 0.0)
        legs = np.repeat(np.arange(len(self.ways)), [len(way) for way in self.ways])
        goes_on = (legs[1:] == legs[:-1])[:, None] & (bounds[1:] > 0)
        reversing: Mask = (goes_on & (ways[:-1] != 0) & (ways[1:] != ways[:-1])).any(axis=0)
        return reversing


Advance = Callable[[Solution, Array, Array], tuple[Solution, Array]]


def resting(forces: Array) -> Solution:
    """Solution with given ``forces`` (n,), without slip and residuals."""
    zero = 0 * forces
    return Solution(forces, zero, zero, 0.0, 0)


def still(before: Solution) -> Solution:
    """Solution of a step in which no load changes: the forces ``before`` the step, without slip and residuals."""
    zero = 0 * before.x
    return replace(before, rest=zero, residual=zero, imbalance=0.0, iterations=0, changes=0, shift=0.0)


def follow(
    path: Path, advance: Advance, before: Solution, f: Array, skip: Callable[[float], None] | None = None
) -> History:
    """Follow the path: to the last load point, then cycle after cycle, until a cycle repeats or all cycles are done. If
    the first loading determines the cycle (``path.half``), only the first loading is solved.

    ``advance(before, load, change) -> (solution, pressure)`` solves one step: from the solution before the step, the
    loads after the step and their change, to the solution after the step, whose ``rest`` is minus the slip, and the
    normal forces. The coefficient of friction is ``f`` (n,). With ``skip``, cycles that lead to the steady state skip
    those of which the limit is known (:mod:`partialslip.friction.limit`); ``skip(times)`` lets what else the method
    keeps of its state go on by so many times its change in the last cycle.
    """
    first, *ways = path.fractions
    load = np.array(path.begin)
    went = [_go(advance, before, load, np.array(path.cycle[-1]), first, "first loading")]
    points, taken = [certified([step for step, _ in went[0]])], len(first)
    if path.half:
        return _reversed(path, points[0], went[0], f)
    ended, cycles = [points[0].x], Cycles(path.settled, path.steady)
    for cycle in range(path.cycles):
        went = []
        for start, end, fractions in zip((path.cycle[-1], *path.cycle), path.cycle, ways, strict=False):
            tell(where := f"cycle {cycle + 1}, way {len(went) + 1} of {len(path.cycle)}")
            went.append(_go(advance, points[-1], np.array(start), np.array(end), fractions, where))
            points.append(certified([step for step, _ in went[-1]]))
            taken += len(fractions)
        largest = max(float(np.abs(step.x).sum()) for way in went for step, _ in way)
        bound = f * went[-1][-1][1]
        off = max(float(point.residual.max()) for point in points[-len(went) :])
        room = room_of([(way[-1][0].x, f * way[-1][1]) for way in went], path.ends if path.in_phase else None)
        cycles.add(points[-1].x, points[-1 - len(went)].x, bound, room, largest, off)
        if cycles.end:
            break
        ended.append(points[-1].x)
        if skip and cycle + 1 < path.cycles and (times := ahead(ended, bound)) is not None:
            skip(times)
            skipped = limit(ended, bound, times)
            points[-1], ended = replace(points[-1], x=skipped, shift=np.nan), [skipped]
            cycles.skipped()
    steps = [step for way in went for step, _ in way]
    ends = [way[-1] for way in went]
    slips = np.cumsum([sum(-step.rest for step, _ in way) for way in went], axis=0)
    (q1, p1), (q2, p2) = ((ends[end][0].x, ends[end][1]) for end in path.ends)
    forces = np.array([step.x for step in steps])
    dissipated = -sum(float(step.x @ step.rest) for step in steps)
    anew: dict[str, Any] = {}
    pressed = [pressure for way in went for _, pressure in way]
    constant = all(pressure is pressed[0] for pressure in pressed)
    pressures = np.array(pressed[:1] if constant else pressed)
    if path.presses_anew:
        bounds = f * pressures
        slip = -np.array([step.rest for step in steps])
        anew = {
            "held": (bounds > 0).all(axis=0),
            "slipped": np.array([slip.clip(0).sum(axis=0), -slip.clip(None, 0).sum(axis=0)]),
        }
        # while a node slips, q follows the bound
        dissipated = float((np.abs(slip) * (bounds + np.roll(bounds, 1, axis=0)) / 2).sum())
    return History(
        path=path,
        points=points,
        at_ends=(q1, q2),
        q1=q1 if path.in_phase else forces.min(axis=0),
        q2=q2 if path.in_phase else forces.max(axis=0),
        pressures=(p1, p2),
        slip=slips[path.ends[1]] - slips[path.ends[0]],
        net_slip=slips[-1],
        dissipated=dissipated,
        load_steps=taken,
        around=Steps(tuple(ways), forces, pressures, f, np.cumsum([step.shift for step in steps])),
        rooms=np.array(cycles.rooms[-3:]),
        steady=cycles.steady,
        **anew,
    )


def _reversed(path: Path, first: Solution, went: "_Way", f: Array) -> History:
    """Cycle from the first loading to load point 2: the change from load point 1 to 2 is twice that (Masing's rule)."""
    forces, slip, pressure = first.x, -2 * np.sum([step.rest for step, _ in went], axis=0), went[-1][1]
    way = replace(first, rest=-slip, iterations=0, changes=0, shift=2 * first.shift)
    return History(
        path=path,
        points=[first, replace(way, x=-forces, rest=-way.rest, shift=-way.shift), way],
        at_ends=(-forces, forces),
        q1=-forces,
        q2=forces,
        pressures=(pressure, pressure),
        slip=slip,
        net_slip=0 * slip,
        dissipated=2 * float(forces @ slip),
        load_steps=len(went),
        around=Steps(((1.0,), (1.0,)), np.array([-forces, forces]), pressure[None], f, np.array([-way.shift, 0.0])),
    )


_Way = list[tuple[Solution, Array]]


def _go(advance: Advance, before: Solution, start: Array, end: Array, fractions: tuple[float, ...], where: str) -> _Way:
    """Solve the steps from the loads at ``start`` to the loads at ``end``; ``where`` on the path they are."""
    before = resting(before.x)  # the loads reverse: the slip before gives no start for the active set
    load, way = start, list[tuple[Solution, Array]]()
    for number, fraction in enumerate(fractions, 1):
        if len(fractions) > 1:
            tell(f"{where}, step {number} of {len(fractions)}")
        next_load = start + fraction * (end - start) if fraction < 1 else end
        before, pressure = advance(before, next_load, next_load - load)
        way.append((before, pressure))
        load = next_load
    return way


def certified(steps: Sequence[Solution]) -> Solution:
    """Last of the ``steps``, with the largest residuals, the whole shift and the summed work of all steps."""
    return replace(
        steps[-1],
        residual=np.maximum.reduce([step.residual for step in steps]),
        imbalance=max(step.imbalance for step in steps),
        iterations=sum(step.iterations for step in steps),
        changes=sum(step.changes for step in steps),
        shift=sum(step.shift for step in steps),
    )


def certificate(history: History, weights: Array, f: float, p0: float) -> dict[str, float]:
    """Largest residuals of a history: ``kkt``, of the friction conditions, in f p0, and ``equilibrium``, of Q, relative
    to f P. ``weights`` (n,) turn tractions into forces."""
    return {
        "kkt": max(float((step.residual / (weights * f * p0)).max()) for step in history.points),
        "equilibrium": max(step.imbalance for step in history.points) / f,
    }


def last_cycle_change(history: History, weights: Array, f: float, p0: float) -> float | None:
    """Largest change of q between the last two visits of the last load point, in f p0; None if no whole cycle was
    followed. ``weights`` (n,) turn tractions into forces."""
    if history.path.half:
        return None
    last, before = history.points[-1].x, history.points[-1 - len(history.path.cycle)].x
    return float((np.abs(last - before) / (weights * f * p0)).max())
