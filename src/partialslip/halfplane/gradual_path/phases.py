"""Phases of half a cycle in which one zone sticks; scaled as in :mod:`partialslip.halfplane.shape`."""

import itertools
from typing import Protocol

from partialslip.halfplane.gradual_path.drift import Drift
from partialslip.halfplane.gradual_path.retreat import Retreat, Zone
from partialslip.halfplane.gradual_path.stage import Loads, LostError, Stage
from partialslip.halfplane.gradual_path.tractions import Piece, Tractions
from partialslip.tools.arrays import Array


class Phase(Protocol):
    """A part of the half cycle in which the stick zone moves in one way, between two stages."""

    @property
    def first(self) -> Stage:
        """Stage at which the phase begins."""
        ...

    @property
    def last(self) -> Stage:
        """Stage at which the phase ends."""
        ...

    def at(self, progress: float) -> Stage:
        """Stage at a ``progress`` within the phase."""
        ...


class Leading(Phase, Protocol):
    """A phase after which the stick zone may drift."""

    def lacking(self, from_left: Array, from_right: Array) -> Array:
        """p - q in the stick zone at the end of the phase, at distances from its ends, which keep their digits."""
        ...


class Resting:
    """Nothing yet: the ``first`` stage is the ``last``."""

    def __init__(self, first: Stage) -> None:
        self.first = self.last = first

    def at(self, progress: float) -> Stage:
        """The stage."""
        del progress
        return self.first

    def lacking(self, from_left: Array, from_right: Array) -> Array:
        """p - q at distances from the ends of the zone."""
        del from_left
        return self.first.q.less(1.0, self.first.zone.right - from_right)


class Retreating:
    """Phase in which both ends of the stick zone move inwards: from the stage ``first`` to the ``zone`` at
    ``progress``."""

    def __init__(self, loads: Loads, first: Stage, sign: int, progress: float, zone: Zone) -> None:
        self._loads, self.first, self.retreat = loads, first, Retreat(first.q, first.zone, sign)
        self.last = self._stage(progress, zone)

    def at(self, progress: float) -> Stage:
        """Stage at a ``progress`` within the phase."""
        more = progress - self.first.progress
        share = more / (self.last.progress - self.first.progress)
        (left0, right0), (left1, right1) = self.first.zone, self.last.zone
        guess = Zone(left0 + share * (left1 - left0), right0 + share * (right1 - right0))
        return self._stage(progress, self.zone(progress, guess))

    def zone(self, progress: float, guess: Zone) -> Zone:
        """Stick zone at a ``progress`` within the phase, near a ``guess``."""
        more = progress - self.first.progress
        changes = more * self._loads.tension, more * self._loads.shear
        zone = self.retreat.zone(*changes, guess) or self.retreat.follow(*changes)
        if not zone:
            raise LostError
        return zone

    def lacking(self, from_left: Array, from_right: Array) -> Array:
        """p - q at distances from the ends of the last zone."""
        zone, start = self.last.zone, self.first.q
        return start.less(1.0, zone.right - from_right) - self.retreat.inside(zone, from_left, from_right)

    def _stage(self, progress: float, zone: Zone) -> Stage:
        def added(part: Piece) -> Piece:
            after, before = part.low - zone.left, zone.right - part.high
            return part.plus(
                lambda from_low, from_high: self.retreat.inside(zone, after + from_low, before + from_high)
            )

        parts = [
            Piece(-1.0, zone.left, self.retreat.sign),
            *map(added, self.first.q.between(*zone)),
            Piece(zone.right, 1.0, 1.0),
        ]
        return Stage(progress, zone, Tractions.of(self.first.q.shape, parts))


class Drifting:
    """The stick zone moves to the left, from the end of the phase ``before`` on, up to the end of the half cycle or of
    the contact."""

    def __init__(self, loads: Loads, before: Leading) -> None:
        self.first = first = before.last
        zone, shape = first.zone, first.q.shape
        c = zone.half_width

        def missing(tau: Array, rest: Array) -> Array:
            if tau[-1] <= 1:
                return before.lacking(2 * c * rest, 2 * c * tau)
            return 2 * shape.pressure(zone.right - 2 * c * tau)

        breaks = [(zone.right - kink) / (2 * c) for kink in shape.strong_kinks]
        breaks += [(zone.right - each) / (2 * c) for each in first.q.breaks if zone.left < each < zone.right]
        self._drift = Drift(loads.tension, missing, [each for each in breaks if each > 0], (zone.right + 1) / (2 * c))
        self._most = (zone.left + 1) / (2 * c)
        self.travel = self._drift.travel(1 - first.progress, self._most)
        self.last = self._stage(min(first.progress + self._drift.progress(self.travel), 1.0), self.travel)

    @property
    def reaches_end(self) -> bool:
        """Whether the zone reaches the left end of the contact."""
        return self.travel >= self._most

    def at(self, progress: float) -> Stage:
        """Stage at a ``progress`` within the phase."""
        return self._stage(progress, self._drift.travel(progress - self.first.progress, self._most))

    def _stage(self, progress: float, travel: float) -> Stage:
        (left0, right0), q = self.first.zone, self.first.q
        width = right0 - left0
        left, right = left0 - travel * width, right0 - travel * width
        if self.travel >= self._most and travel == self.travel:
            left = -1.0

        def added(part: Piece) -> Piece:
            def change(from_low: Array, from_high: Array) -> Array:
                from_left = part.low - left0 + from_low
                if part.high <= left0:
                    from_left = part.high - left0 - from_high
                return self._drift.accumulated(-from_left / width, travel)

            return part.plus(change)

        cuts = [left0 - width * each for each in self._drift.ends if left < left0 - width * each]
        cuts = sorted(each for each in {left, *cuts, min(left0, right)} if left <= each <= min(left0, right))
        back = [Piece(low, high, -1.0) for low, high in itertools.pairwise(cuts)]
        parts = [
            Piece(-1.0, left, -1.0),
            *map(added, [*back, *q.between(left0, right)]),
            Piece(right, 1.0, 1.0),
        ]
        return Stage(progress, Zone(left, right), Tractions.of(q.shape, parts))
