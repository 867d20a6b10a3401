"""Half a cycle under gradual loads, and the steady cycle; scaled as in :mod:`partialslip.halfplane.shape`."""

import itertools
import math
from collections.abc import Callable
from typing import Protocol

import numpy as np

from partialslip.arrays import Array
from partialslip.halfplane.gradual_path.drift import Drift
from partialslip.halfplane.gradual_path.graded import Smooth
from partialslip.halfplane.gradual_path.retreat import Retreat, Zone
from partialslip.halfplane.gradual_path.stage import Loads, Stage
from partialslip.halfplane.gradual_path.tractions import Part, Tractions
from partialslip.halfplane.shape import Shape
from partialslip.halfplane.steady import stick_zone, stick_zones
from partialslip.halfplane.traction import half_range

_CYCLES = 200
_SETTLED, _NEAR = 1e-13, 1e-8
_TOLD = 1e-4  # change of the zone's middle below which a zone inside is told
_INSIDE = 4e-4  # width of an inner slip zone that moves the ends by less than 1e-6
_HALVINGS = 12  # of the way between two stages
_NARROWEST = 0.02  # half-width of a stick zone that drifts: narrower ones travel more than fifty times their width


class LostError(ValueError):
    """The stick zone cannot be followed by retreat and drift alone: a zone inside it slips, too."""


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


class Retreating:
    """Both ends of the stick zone give way, from ``first`` on, up to the ``zone`` at ``progress``."""

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

    def _stage(self, progress: float, zone: Zone) -> Stage:
        def added(part: Part) -> Part:
            after, before = part.low - zone.left, zone.right - part.high
            return part.plus(
                lambda from_low, from_high: self.retreat.inside(zone, after + from_low, before + from_high)
            )

        parts = [
            Part(-1.0, zone.left, self.retreat.sign),
            *map(added, self.first.q.between(*zone)),
            Part(zone.right, 1.0, 1.0),
        ]
        return Stage(progress, zone, Tractions.of(self.first.q.shape, parts))


class Drifting:
    """The stick zone moves to the left, from ``first`` on, up to the ``progress`` or the end of the contact."""

    def __init__(self, loads: Loads, first: Stage, lacking: Callable[[Array, Array], Array]) -> None:
        self.first, zone, shape = first, first.zone, first.q.shape
        c = zone.half_width

        def missing(tau: Array, rest: Array) -> Array:
            if tau[-1] <= 1:
                return lacking(2 * c * tau, 2 * c * rest)
            return 2 * shape.pressure(zone.right - 2 * c * tau)

        breaks = [(zone.right - kink) / (2 * c) for kink in shape.strong_kinks]
        breaks += [(zone.right - each) / (2 * c) for each in first.q.breaks if zone.left < each < zone.right]
        self._breaks = breaks
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

        def added(part: Part) -> Part:
            def change(from_low: Array, from_high: Array) -> Array:
                from_left = part.low - left0 + from_low
                if part.high <= left0:
                    from_left = part.high - left0 - from_high
                return self._drift.accumulated(-from_left / width, travel)

            return part.plus(change)

        cuts = [left0 - width * each for each in {0.0, *self._breaks, *range(1, 6)} if left < left0 - width * each]
        cuts = sorted(each for each in {left, *cuts, min(left0, right)} if left <= each <= min(left0, right))
        back = [Part(low, high, -1.0) for low, high in itertools.pairwise(cuts)]
        parts = [
            Part(-1.0, left, -1.0),
            *map(added, [*back, *q.between(left0, right)]),
            Part(right, 1.0, 1.0),
        ]
        return Stage(progress, Zone(left, right), Tractions.of(q.shape, parts))


class HalfCycle:
    """Half a cycle of gradual loads from a state.

    Parameters
    ----------
    loads : Loads
    start : Tractions
        The state at its beginning.
    guess : HalfCycle, optional
        A half cycle from a similar state.
    """

    def __init__(self, loads: Loads, start: Tractions, guess: "HalfCycle | float") -> None:
        self.loads, self.start, c = loads, start, loads.least
        first = start.parts[0]
        # points on the bound on which the first rate pushes slip at once
        left = min(first.high, 1 - 2 * c) if first.smooth is None and first.factor < 0 else -1.0
        begin = Stage(0.0, Zone(left, 1.0), start)
        self.phases: list[Phase] = []
        retreat = Retreat(start, begin.zone, -1)
        if left >= 1 - 2 * c:
            progress = 0.0

            def lacking(from_right: Array, from_left: Array) -> Array:
                del from_left
                return start.less(1.0, 1.0 - from_right)
        else:
            centre = retreat.balanced(c, guess.phases[0].last.zone.centre if isinstance(guess, HalfCycle) else guess)
            if centre is None:
                raise LostError
            zone = Zone(centre - c, centre + c)
            progress = retreat.conditions(zone).tension / loads.tension
            self.phases.append(Retreating(loads, begin, -1, progress, zone))

            def lacking(from_right: Array, from_left: Array) -> Array:
                return start.less(1.0, zone.right - from_right) - retreat.inside(zone, from_left, from_right)

            begin = self.phases[-1].last
        drift = Drifting(loads, begin, lacking)
        self.phases.append(drift)
        if drift.reaches_end:
            begin, more = drift.last, 1 - drift.last.progress
            retreat = Retreat(begin.q, begin.zone, 1)
            changes = more * loads.tension, more * loads.shear
            near = guess.phases[-1] if isinstance(guess, HalfCycle) else None
            found = retreat.zone(*changes, near.last.zone) if isinstance(near, Retreating) else None
            found = found or retreat.follow(*changes)
            if not found:
                raise LostError
            self.phases.append(Retreating(loads, begin, 1, 1.0, found))

    @property
    def last(self) -> Stage:
        """Stage at the end of the half cycle."""
        return self.phases[-1].last

    def at(self, progress: float) -> Stage:
        """Stage at a ``progress`` from 0 to 1."""
        phase = next((each for each in self.phases if progress < each.last.progress), None)
        return phase.at(progress) if phase else self.last

    @property
    def sign(self) -> int:
        """Direction of the last slip at the left end; at the right end it is positive."""
        return 1 if isinstance(self.phases[-1], Retreating) and self.phases[-1].retreat.sign > 0 else -1

    @property
    def left_out(self) -> float:
        """Width of the zone inside the stick zone that slips for a while, which is left out: from where the right end
        has been in the half cycle before to where the first rate changes its sign, and a third further."""
        return max(self.phases[0].first.zone.centre - self.loads.least - self.last.zone.right, 0.0) * 4 / 3

    @property
    def followed(self) -> bool:
        """Whether all slip is followed: no zone inside the stick zone slips."""
        return self.left_out <= _INSIDE

    @property
    def stuck(self) -> tuple[float, float]:
        """Ends of the interval of points that never slip; the left one is not left of the right one if there are
        none."""
        return stuck([stage for phase in self.phases for stage in (phase.first, phase.last)])

    def stuck_until(self, stage: Stage) -> tuple[float, float]:
        """Ends of the interval of points that have not slipped up to a ``stage``."""
        before = [each for phase in self.phases for each in (phase.first, phase.last)]
        return stuck([stage, *(each for each in before if each.progress <= stage.progress)])

    @property
    def settled(self) -> Tractions:
        """Tractions at the end, without what is locked in where no point slips: half of the change there."""
        q, (low, high) = self.last.q, self.stuck
        if low >= high:
            return q

        def half(from_low: Array, from_high: Array) -> Array:
            ends = (low, high, from_low, from_high)
            return (q.within(*ends) - self.start.within(*ends)) / 2

        middle = Part(low, high, 0.0).plus(half)
        return Tractions.of(q.shape, [*q.between(-1.0, low), middle, *q.between(high, 1.0)])


def between(phase: Phase, first: Stage, last: Stage, share: float, halvings: int = _HALVINGS) -> list[Stage]:
    """Stages of a ``phase`` after the ``first`` up to the ``last``, so many that neighbours have a ``share`` of their
    stick zones in common; the way from ``first`` to ``last`` is halved no more than ``halvings`` times."""
    least = min(_common(each.sticks, each.sticks) for each in (first, last))
    if halvings == 0 or _common(first.sticks, last.sticks) >= share * least:
        return [last]
    middle = phase.at((first.progress + last.progress) / 2)
    return [
        *between(phase, first, middle, share, halvings - 1),
        *between(phase, middle, last, share, halvings - 1),
    ]


def _common(one: tuple[Zone, ...], other: tuple[Zone, ...]) -> float:
    """Width that two sets of intervals have in common."""
    return sum(max(min(a.right, b.right) - max(a.left, b.left), 0.0) for a in one for b in other)


def stuck(stages: list[Stage]) -> tuple[float, float]:
    """Ends of the interval of points that stick at all ``stages``."""
    return max(stage.zone.left for stage in stages), min(stage.zone.right for stage in stages)


def steady(loads: Loads, shape: Shape) -> HalfCycle:
    """Return the steady half cycle, to which half cycles tend, where no zone inside the stick zone slips.

    Parameters
    ----------
    loads : Loads
        Loads under which the stick zone drifts: slip turns round on the way.
    shape : Shape
        Pressure.

    Raises
    ------
    LostError
        If retreat and drift do not lead to the end of the half cycle.
    """
    zone = stick_zone(loads.shear / math.pi, loads.tension, shape)

    def half(from_low: Array, from_high: Array) -> Array:
        del from_high
        return half_range(zone.left + from_low, zone, shape)

    once = Smooth(zone.left, zone.right, half)
    parts = Part(-1.0, zone.left, zone.s), Part(zone.left, zone.right, 0.0, once), Part(zone.right, 1.0, 1.0)
    start = -Tractions.of(shape, parts)
    shares = np.append(np.geomspace(1e-4, 0.1, 12), np.linspace(0.1, 1, 64)[1:])
    tried = stick_zones(shares * loads.shear / math.pi, shares * loads.tension, shape)
    narrow = np.flatnonzero(tried.half_width < loads.least)
    if not len(narrow) or loads.least < _NARROWEST:
        raise LostError
    found = HalfCycle(loads, start, float(tried.centre[narrow[0]]))
    changes: list[float] = []
    for _ in range(_CYCLES):
        before, found = found.last.zone.centre, HalfCycle(loads, -found.settled, found)
        changes.append(abs(found.last.zone.centre - before))
        if changes[-1] < _TOLD and _leaves_trace(found):
            raise LostError
        if changes[-1] < _SETTLED or min(changes[:-1], default=np.inf) < min(changes[-1], _NEAR):
            break
    return found


def _leaves_trace(half: HalfCycle) -> bool:
    """Whether a zone inside the stick zone slips, and not all of it slips again on the left before the zone drifts."""
    right = half.last.zone.right
    drifts = next((phase.first.zone.left for phase in half.phases if isinstance(phase, Drifting)), -1.0)
    return not half.followed and drifts < right + 5 / 4 * half.left_out
