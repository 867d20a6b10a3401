"""Coulomb friction along a path on which the pressure varies, event by event.

Between two instants at which nodes touch or open, normal forces are linear in time on a straight leg of the path, and
tangential ones between two events of friction (:mod:`partialslip.friction.path_following`). There are no load steps.

Scaled as in :mod:`partialslip.friction.history`.
"""

import itertools
from dataclasses import dataclass, replace

import numpy as np

from partialslip.friction.active_set import Solution, spread
from partialslip.friction.history import History, Steps, follow, resting
from partialslip.friction.load_path import Missed, Path
from partialslip.friction.normal import Presses
from partialslip.friction.path_following import Bounds, Follower, Leg, joined
from partialslip.scene.model import require_carried
from partialslip.tools.arrays import Array, Mask, submatrix

_REPEATS = 1e-12  # accuracy: change of q over a cycle, in f p, that is rounding of the events
_SLIGHT = 1e-6  # accuracy: of the longest path of slip: none
_NOTHING = 1e-11  # accuracy: slip, relative to the largest possible: rounding


def march(tangential: Array, stretch: Array, f: Array, press: Presses, path: Path, few: int = 0) -> History:
    """Follow the path leg by leg; every leg has a certificate.

    Parameters
    ----------
    tangential, stretch, f, press, path
        As for :func:`partialslip.friction.coulomb_varying_pressure.march`.
    few : int
        Nodes that may slip both ways where slip does not turn round, as for
        :func:`partialslip.friction.coulomb_constant_pressure.march`.

    Raises SlidesError if no node sticks.
    """
    return _Contact(tangential, stretch, f, press, path, few).followed()


@dataclass(frozen=True)
class _Done:
    """A ``leg`` under normal forces ``pressed`` and the friction ``bounds``, at the nodes that are ever in contact."""

    pressed: Bounds
    bounds: Bounds
    leg: Leg

    @property
    def held(self) -> Mask:
        """Nodes that are in contact throughout."""
        return self.pressed.values.min(axis=0) > 0

    @property
    def _slips(self) -> Mask:
        least = max(_SLIGHT * float(self.leg.path.max()), _NOTHING * float(self.bounds.values.max(axis=0).sum()))
        return self.held & (self.leg.path > least)

    @property
    def turns(self) -> int:
        """Number of nodes that slip both ways, or cease to slip. Nodes that open do so with the contact."""
        leg = self.leg
        both = leg.path - np.abs(leg.rest) > _SLIGHT * float(leg.path.max())
        return int(np.count_nonzero(self._slips & (both | ~leg.slips)))

    @property
    def changed(self) -> Array:
        """As of :meth:`Leg.changed`."""
        return self.leg.changed(self._slips)


class _Contact:
    """Legs of a path in turn; arguments as for :func:`march`."""

    def __init__(self, tangential: Array, stretch: Array, f: Array, press: Presses, path: Path, few: int) -> None:
        self._f = f
        self._asked, self._stretch, self._few = path, stretch, few
        self._path = replace(path, ways=((1.0,),) * (1 + len(path.cycle)), settled=max(path.settled, _REPEATS))
        loads = [load[3:5] for load in (path.begin, path.cycle[-1], *path.cycle)]
        ways = [press.way((P, M), (P2, M2)) for (P, M), (P2, M2) in itertools.pairwise(loads)]
        most = np.maximum.reduce([each.values.max(axis=0) for each in ways])
        self._on, self._count = np.flatnonzero(most > 0), len(most)
        self._pressed = [each.of(self._on) for each in ways]
        self._bounds = [each.times(f[self._on]) for each in self._pressed]
        for load, each in zip((path.cycle[-1], *path.cycle), self._bounds, strict=True):
            require_carried([load[0]], float(each.values[-1].sum()))
        self._follower = Follower(submatrix(tangential, self._on, self._on))
        self._legs: list[_Done] = []

    def followed(self) -> History:
        """Follow the path."""
        before = self._path.before
        begin = resting(np.zeros(self._count) if before is None else before)
        return self._completed(follow(self._path, self._advance, begin, self._f))

    def _advance(self, before: Solution, load: Array, change: Array) -> tuple[Solution, Array]:
        """Go along one leg, as :func:`partialslip.friction.history.follow` asks for it."""
        on, number = self._on, len(self._legs)
        way = number if not number else 1 + (number - 1) % len(self._path.cycle)
        pressed, bounds = self._pressed[way], self._bounds[way]
        # a state of another mesh has the load, and keeps the bounds, to an error of that mesh only
        start = np.clip(before.x[on], -bounds.values[0], bounds.values[0])
        g, Q = (change[1:3] @ self._stretch)[on], float(load[0]) - float(start.sum())
        leg = self._follower.leg(bounds, start, g, Q, self._path.stages)
        self._legs.append(_Done(pressed, bounds, leg))
        return leg.solution.spread(on, self._count), self._spread(pressed.values[-1])

    def _spread(self, values: Array) -> Array:
        return spread(values, self._on, self._count)

    def _completed(self, history: History) -> History:
        """``history`` with what is known of its legs."""
        path, last = history.path, self._legs[-len(self._path.cycle) :]
        stages = np.zeros((2, len(last) * len(path.stages), self._count))
        stages[:, :, self._on] = [
            np.concatenate([each.leg.stages for each in last]),
            np.concatenate([each.pressed.stages(path.stages) for each in last]),
        ]
        forces, pressures = stages
        shifts = joined([each.leg.shifts for each in last])
        bounds = self._f * pressures
        room = np.maximum((bounds - forces).min(axis=0) + (bounds + forces).min(axis=0), 0.0)
        changed, stuck = np.full((2, self._count), np.nan)
        changed[self._on], stuck[self._on] = last[path.ends[1]].changed, last[path.ends[1]].leg.stuck
        turns = path.in_phase and any(each.turns > self._few for each in last)
        return replace(
            history,
            path=replace(self._asked, turns=turns, missed=Missed(0.0, 0.0)),
            room=None if path.in_phase else room,
            held=self._spread(np.logical_and.reduce([each.held for each in last])).astype(bool),
            slipped=np.array([self._spread(each) for each in np.sum([each.leg.slipped for each in last], axis=0)]),
            dissipated=sum(each.leg.dissipated for each in last),
            around=Steps((path.stages,) * len(last), forces, pressures, self._f, shifts),
            turns=turns,
            changed=changed if path.in_phase else None,
            stuck=stuck if path.in_phase else None,
            events=sum(each.leg.events for each in self._legs),
        )
