"""Coulomb friction along a path of straight legs, each exact in time.

Between two instants at which nodes touch or open, normal forces are linear in time on a leg, and tangential ones
between two events of friction (:mod:`partialslip.friction.path_following`). There are no load steps. Constant pressure
is the case in which the bounds are constant (:meth:`Bounds.constant`): a leg may then be taken in one step, too
(:mod:`partialslip.friction.coulomb_constant_pressure`).

Scaled as in :mod:`partialslip.friction.history`.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from partialslip.friction.active_set import Solution
from partialslip.friction.history import History, Steps, follow, resting
from partialslip.friction.load_path import Missed, Path
from partialslip.friction.path_following import Bounds, Follower, Leg, joined
from partialslip.scene.model import require_carried
from partialslip.tools.arrays import Array, Mask, submatrix

_AT = 1e-12  # accuracy: of the sum of the bounds: rounding of the force that a leg begins with
_SLIGHT = 1e-6  # accuracy: of the longest path of slip: none
_NOTHING = 1e-11  # accuracy: slip, relative to the largest possible: rounding


@dataclass(frozen=True)
class Done:
    """A leg from the forces ``start`` to those ``found``, with the ``change`` of the loads up to ``load``, under normal
    forces ``pressed`` and the friction ``bounds``, at the nodes that are ever in contact; ``leg``: what is known of it,
    or None if it was taken in one step."""

    start: Array
    load: Array
    change: Array
    pressed: Bounds
    bounds: Bounds
    found: Solution
    leg: Leg | None = None

    @property
    def held(self) -> Mask:
        """Nodes that are in contact throughout."""
        return self.pressed.values.min(axis=0) > 0

    @property
    def turned(self) -> int:
        """Number of nodes that slip both ways, or cease to slip. Nodes that open do so with the contact."""
        if not self.leg:
            return 0
        both = self.leg.path - np.abs(self.leg.rest) > _SLIGHT * float(self.leg.path.max())
        return int(np.count_nonzero(self._slips(self.leg) & (both | ~self.leg.slips)))

    @property
    def changed(self) -> Array:
        """As of :meth:`Leg.changed`; no leg taken in one step has it."""
        assert self.leg
        return self.leg.changed(self._slips(self.leg))

    def _slips(self, leg: Leg) -> Mask:
        least = max(_SLIGHT * float(leg.path.max()), _NOTHING * float(self.bounds.values.max(axis=0).sum()))
        return self.held & (leg.path > least)

    @property
    def slipped(self) -> Array:
        """Slip along +x and along -x, (2, n)."""
        return self.leg.slipped if self.leg else np.array([-self.found.rest, self.found.rest]).clip(0)


class Legs:
    """Legs of a ``path`` in turn, on which nodes touch and open.

    Parameters
    ----------
    tangential : (n, n) array
        Relative compliance of all nodes.
    stretch : (2, n) array
        Displacements of the lower surface along x under the tension that strains it by 1, and under the tension that
        strains it by x (:func:`partialslip.friction.load_path.stretched`).
    f : (n,) array
        Coefficient of friction.
    pressed : sequence of Bounds
        Normal forces on each way of the path.
    path : Path
    few : int
        Nodes that may slip both ways where slip does not reverse.
    """

    def __init__(
        self, tangential: Array, stretch: Array, f: Array, pressed: Sequence[Bounds], path: Path, few: int
    ) -> None:
        self._f, self._few, self._count, self._cycle = f, few, len(tangential), len(path.cycle)
        self._path = replace(path, ways=((1.0,),) * (1 + self._cycle), missed=Missed(0.0, 0.0))
        self._on = np.flatnonzero(np.maximum.reduce([each.values.max(axis=0) for each in pressed]) > 0)
        self._pressed = [each.of(self._on) for each in pressed]
        self._bounds = [each.times(np.broadcast_to(f, self._count)[self._on]) for each in self._pressed]
        for load, each in zip((path.cycle[-1], *path.cycle), self._bounds, strict=True):
            require_carried([load[0]], float(each.values[-1].sum()))
        self._tangential, self._stretch = tangential, stretch
        self.legs: list[Done] = []

    def followed(self, skip: Callable[[float], None] | None = None) -> History:
        """Follow the path; ``skip`` as of :func:`partialslip.friction.history.follow`."""
        before = self._path.before
        begin = resting(np.zeros(self._count) if before is None else before)
        return self._completed(follow(self._path, self._advance, begin, self._f, skip=skip))

    def _advance(self, before: Solution, load: Array, change: Array) -> tuple[Solution, Array]:
        """Go along one leg, as :func:`partialslip.friction.history.follow` asks for it."""
        number = len(self.legs)
        way = number if not number else 1 + (number - 1) % self._cycle
        pressed, bounds = self._pressed[way], self._bounds[way]
        self.legs.append(done := self._leg(self._here(before.x), load, change, pressed, bounds))
        found = done.found if len(self._on) == self._count else done.found.spread(self._on, self._count)
        return found, self._at_all_nodes(pressed.values[-1])

    def _leg(self, start: Array, load: Array, change: Array, pressed: Bounds, bounds: Bounds) -> Done:
        """Go along one leg, event by event."""
        # a state of another mesh has the load, and keeps the bounds, to an error of that mesh only
        start = np.clip(start, -bounds.values[0], bounds.values[0])
        off = float(load[0] - change[0]) - float(start.sum())
        Q = float(change[0]) + (off if abs(off) > _AT * float(bounds.values[0].sum()) else 0.0)
        g = self._here(change[1:3] @ self._stretch)
        leg = self._follower.leg(bounds, start, g, Q, self._path.stages)
        return Done(start, load, change, pressed, bounds, leg.solution, leg)

    @cached_property
    def _follower(self) -> Follower:
        return Follower(submatrix(self._tangential, self._on, self._on))

    def _here(self, values: Array) -> Array:
        """``values`` at the nodes that are ever in contact. If all are, the same array: its product with C is known."""
        return values if len(self._on) == self._count else values[self._on]

    def _at_all_nodes(self, values: Array, outside: float = 0.0) -> Array:
        """``values`` (..., k) at all nodes, (..., n)."""
        result = np.full((*values.shape[:-1], self._count), outside)
        result[..., self._on] = values
        return result

    def _completed(self, history: History) -> History:
        """``history`` with what is known of its legs."""
        path, last = history.path, self.legs[-self._cycle :]
        ways, forces, shifts = zip(*(self._stages(each) for each in last), strict=True)
        pressures = np.concatenate([each.pressed.stages(shares) for each, shares in zip(last, ways, strict=True)])
        second = last[path.ends[1]] if path.in_phase and last[path.ends[1]].leg else None
        return replace(
            history,
            held=self._at_all_nodes(np.logical_and.reduce([each.held for each in last])).astype(bool),
            slipped=self._at_all_nodes(np.sum([each.slipped for each in last], axis=0)),
            dissipated=sum(each.leg.dissipated for each in last if each.leg),
            around=Steps(
                ways, self._at_all_nodes(np.concatenate(forces)), self._at_all_nodes(pressures), self._f, joined(shifts)
            ),
            turns=path.in_phase and any(each.turned > self._few for each in last),
            changed=self._at_all_nodes(second.changed, np.nan) if second else None,
            stuck=self._at_all_nodes(second.leg.stuck, np.nan) if second and second.leg else None,
            events=sum(each.leg.events for each in self.legs if each.leg),
        )

    def _stages(self, done: Done) -> tuple[tuple[float, ...], Array, Array]:
        """Fractions of a leg, ascending to 1, the forces (s, k) there, and the rigid shifts (s,) up to there."""
        assert done.leg
        return self._path.stages, done.leg.stages, done.leg.shifts
