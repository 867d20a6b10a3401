"""Half a cycle under gradual loads, and the steady cycle; scaled as in :mod:`partialslip.halfplane.shape`."""

import itertools
import math
from collections.abc import Sequence

import numpy as np

from partialslip.halfplane.gradual_path.graded import Smooth
from partialslip.halfplane.gradual_path.inner import inner_phase, opens
from partialslip.halfplane.gradual_path.phases import Drifting, Leading, Phase, Resting, Retreating
from partialslip.halfplane.gradual_path.retreat import Retreat, Zone
from partialslip.halfplane.gradual_path.stage import Loads, LostError, Stage, common_zones, lasting
from partialslip.halfplane.gradual_path.tractions import Piece, Tractions
from partialslip.halfplane.shape import Shape
from partialslip.halfplane.steady import steady_stick_zone, stick_zones
from partialslip.halfplane.traction import half_range
from partialslip.tools.arrays import Array

# limit: most half cycles, and those in which the change does not become less: they do not settle
_CYCLES, _STALLED = 60, 8
_SETTLED, _NEAR = 1e-13, 1e-8  # accuracy: change of the middle of the stick zone that is none
# accuracy: half cycles without a smaller change, after which a change that is no longer near is rounding, too
_NO_LESS = 2
_CLOSE = 1e-12  # accuracy: change of the middle where a zone inside is followed
_PROBES = (1 - np.cos(np.pi * (np.arange(200) + 0.5) / 200)) / 2  # places between the outer ends
# accuracy: change of the outer ends that counts as much as one of q by 1: q rises there like a square root
_OF_Q = 2e-3
_NEARLY = 1e-8  # accuracy: change of the zone's middle from which on a zone inside is followed
_SAME = 1e-9  # accuracy: by how much a zone is wider than the one that drifts where it drifts at once
_CENTRED = 1e-11  # accuracy: mean of Q that is rounding
_LEAST, _MOST = 0.05, 0.8  # cost: shares of the half cycle before in a mixture
_FINE = 1e-11  # accuracy: change of the middle below which the interpolation of a mixture shows
_HALVINGS = 12  # limit: of the way between two stages
_NONE = Zone(1.0, -1.0)  # of no points
_NARROWEST = 0.02  # limit: half-width of a stick zone that drifts: slip along its way costs stages as 1 over it


class HalfCycle:
    """Half a cycle of gradual loads from a state.

    Parameters
    ----------
    loads : Loads
    start : Tractions
        The state at its beginning.
    guess : HalfCycle, optional
        A half cycle from a similar state.
    parts : bool
        Whether a zone inside the stick zone is followed.

    Attributes
    ----------
    opens, parted : bool
        Whether a zone inside the stick zone slips as the half cycle begins, and whether it is followed.
    """

    def __init__(self, loads: Loads, start: Tractions, guess: "HalfCycle | float", parts: bool = True) -> None:
        self.loads, self.start, c = loads, start, loads.least
        first = start.parts[0]
        # points on the bound on which the first rate pushes slip at once
        left = max(min(first.high, 1 - 2 * c), -1.0) if first.smooth is None and first.factor < 0 else -1.0
        self.phases: list[Phase] = []
        before: Leading = Resting(Stage(0.0, Zone(left, 1.0), start))
        self.opens = opens(before.last, c)
        self.parted = parts and self.opens
        if self.parted:
            before = inner_phase(loads, before.last, guess.phases[0] if isinstance(guess, HalfCycle) else None)
            self.phases.append(before)
        if c - before.last.zone.half_width > _SAME:  # the left end slips forwards from the beginning
            self.phases.append(self._last_retreat(before.last, 1, None))
            return
        if before.last.zone.half_width - c > _SAME:
            before = self._retreat(before.last, guess.middle if isinstance(guess, HalfCycle) else guess)
            self.phases.append(before)
        if before.last.progress == 1:
            return
        drift = Drifting(loads, before)
        self.phases.append(drift)
        if drift.reaches_end:
            near = guess.phases[-1] if isinstance(guess, HalfCycle) else None
            guessed = near.last.zone if isinstance(near, Retreating) else None
            self.phases.append(self._last_retreat(drift.last, 1, guessed))

    def _retreat(self, begin: Stage, guess: float) -> Retreating:
        """Retreat up to where the zone drifts, its middle near a ``guess``, or up to the end of the half cycle."""
        c, retreat = self.loads.least, Retreat(begin.q, begin.zone, -1)
        if not c:
            return self._last_retreat(begin, -1, None)
        inside = begin.zone.left + c < guess < begin.zone.right - c
        centre = retreat.balanced(c, guess) if inside else None
        if centre is None:
            centre = retreat.bracketed(c)
        if centre is None:  # the zone may stay wider up to the end
            return self._last_retreat(begin, -1, None)
        zone = Zone(centre - c, centre + c)
        progress = begin.progress + retreat.conditions(zone).tension / self.loads.tension
        if progress >= 1:
            return self._last_retreat(begin, -1, None)
        return Retreating(self.loads, begin, -1, progress, zone)

    def _last_retreat(self, begin: Stage, sign: int, guess: Zone | None) -> Retreating:
        """Retreat up to the end of the half cycle, perhaps to a zone near a ``guess``."""
        more, retreat = 1 - begin.progress, Retreat(begin.q, begin.zone, sign)
        changes = more * self.loads.tension, more * self.loads.shear
        found = (guess and retreat.zone(*changes, guess)) or retreat.follow(*changes)
        if not found:
            raise LostError
        return Retreating(self.loads, begin, sign, 1.0, found)

    @property
    def middle(self) -> float:
        """Middle of the stick zone where it begins to drift."""
        return next((phase.first.zone for phase in self.phases if isinstance(phase, Drifting)), self.last.zone).centre

    @property
    def last(self) -> Stage:
        """Stage at the end of the half cycle."""
        return self.phases[-1].last

    def at(self, progress: float) -> Stage:
        """Stage (stick zone and q) of the half cycle at lambda = ``progress``, from 0 to 1."""
        phase = next((each for each in self.phases if progress < each.last.progress), None)
        return phase.at(progress) if phase else self.last

    @property
    def sign(self) -> int:
        """Direction of the last slip at the left end; at the right end it is positive."""
        return 1 if isinstance(self.phases[-1], Retreating) and self.phases[-1].retreat.sign > 0 else -1

    @property
    def stuck(self) -> tuple[float, float]:
        """Ends of the interval of points that never slip; the left one is not left of the right one if there are
        none."""
        return stuck([stage for phase in self.phases for stage in (phase.first, phase.last)])

    def stuck_until(self, stage: Stage) -> tuple[float, float]:
        """Ends of the interval of points that have not slipped up to a ``stage``."""
        before = [each for phase in self.phases for each in (phase.first, phase.last)]
        return stuck([*(each for each in before if each.progress <= stage.progress), stage])

    @property
    def settled(self) -> Tractions:
        """Tractions at the end, without what is locked in where no point slips: half of the change there, and so much
        of a linear rest that they are continuous."""
        q, (low, high) = self.last.q, self.stuck
        if low >= high:
            return q.joined()

        def mean(from_low: Array, from_high: Array) -> Array:
            ends = (low, high, from_low, from_high)
            return (q.within(*ends) + self.start.within(*ends)) / 2

        width = np.array([0.0, high - low])
        at_low, at_high = mean(width, width[::-1]).tolist()

        def half(from_low: Array, from_high: Array) -> Array:
            locked = mean(from_low, from_high) - (at_low * from_high + at_high * from_low) / (high - low)
            return q.within(low, high, from_low, from_high) - locked

        middle = Piece(low, high, 0.0).plus(half)
        return Tractions.of(q.shape, [*q.between(-1.0, low), middle, *q.between(high, 1.0)]).joined()


def between(phase: Phase, first: Stage, last: Stage, share: float, halvings: int = _HALVINGS) -> list[Stage]:
    """Stages of a ``phase`` after the ``first`` up to the ``last``, so many that neighbours have a ``share`` of their
    stick zones in common; the way from ``first`` to ``last`` is halved no more than ``halvings`` times."""
    widths = [sum(zone.right - zone.left for zone in zones) for zones in (first.sticks, last.sticks)]
    kept = sum(zone.right - zone.left for zone in lasting(first, last))
    if halvings == 0 or kept >= share * min(widths):
        return [last]
    middle = phase.at((first.progress + last.progress) / 2)
    return [
        *between(phase, first, middle, share, halvings - 1),
        *between(phase, middle, last, share, halvings - 1),
    ]


def stuck(stages: Sequence[Stage]) -> tuple[float, float]:
    """Ends of the interval of points that stick at all ``stages``, ascending, with the ends of phases among these; of
    two, where a zone inside slips, the left one."""
    zones: Sequence[Zone] = stages[0].sticks
    for before, after in itertools.pairwise(stages):
        zones = common_zones(itertools.product(zones, lasting(before, after)))
    return zones[0] if zones else _NONE


def once(loads: Loads, shape: Shape) -> Tractions:
    """Half of the change of q by a single step of the ``loads``, on a pressure ``shape``."""
    zone = steady_stick_zone(loads.shear / math.pi, loads.tension, shape)

    def half(from_low: Array, from_high: Array) -> Array:
        del from_high
        return half_range(zone.left + from_low, zone, shape)

    middle = Smooth(zone.left, zone.right, half)
    pieces = Piece(-1.0, zone.left, zone.s), Piece(zone.left, zone.right, 0.0, middle), Piece(zone.right, 1.0, 1.0)
    return Tractions.of(shape, pieces)


def steady(loads: Loads, shape: Shape, parts: bool = True) -> HalfCycle:
    """Return the steady half cycle, to which half cycles tend.

    Parameters
    ----------
    loads : Loads
        Loads under which the stick zone drifts: slip reverses on the way.
    shape : Shape
        Pressure.
    parts : bool
        Whether a slip zone inside the stick zone is followed.

    Raises
    ------
    LostError
        If retreat and drift do not lead to the end of the half cycle.
    """
    if loads.least < _NARROWEST:
        raise LostError(f"a zone of the half-width {loads.least:.2g} a drifts")
    start = -once(loads, shape)
    shares = np.append(np.geomspace(1e-4, 0.1, 12), np.linspace(0.1, 1, 64)[1:])
    tried = stick_zones(shares * loads.shear / math.pi, shares * loads.tension, shape)
    narrow = np.flatnonzero(tried.half_width < loads.least)
    guess = float(tried.centre[narrow[0]]) if len(narrow) else Zone(start.parts[0].high, start.parts[-1].low).centre
    found = HalfCycle(loads, start, guess, parts=False)
    found = _repeated(found, parts=False)
    return _repeated(found, parts=True) if parts else found


def _state_distance(one: Tractions, other: Tractions) -> float:
    """Distance of two states: the largest difference of the outer ends of their stick zones (in a) or of q between
    these ends (in f p0, times ``_OF_Q``)."""
    ends = np.array([[each.parts[0].high, each.parts[-1].low] for each in (one, other)])
    low, high = ends[:, 0].max(), ends[:, 1].min()
    x = low + (high - low) * _PROBES
    return float(max(np.abs(ends[0] - ends[1]).max(), _OF_Q * np.abs(one(x) - other(x)).max()))


def _repeated(found: HalfCycle, parts: bool) -> HalfCycle:
    """The half cycle that begins with minus the tractions at its end; a zone inside is followed if it ``parts``.

    Half cycles tend to the steady one by a factor that may be as large as -0.5 where a zone inside slips. There the
    next one begins from a mixture of the two states before, in which the middle would not change (secant method). The
    last ones are true half cycles, each from the end of the one before.

    Raises
    ------
    LostError
        If the state still changes after the last of these half cycles.
    """
    loads, least = found.loads, np.inf  # smallest change
    begin, middle = -found.settled, found.last.zone.centre
    last: tuple[Tractions, float, float] | None = None  # state and middle after the half cycle before, and its change
    nearest = 0
    for number in range(_CYCLES):
        try:
            found = HalfCycle(_centred(loads, found, begin), begin, found, parts)
        except LostError:
            if not last or begin is last[0]:
                raise
            begin, middle, _ = last
            last = None
            continue
        state, after = -found.settled, found.last.zone.centre
        change = after - middle
        size = max(abs(change), _state_distance(begin, state)) if found.parted else abs(change)
        settled = _SETTLED if not found.opens else _CLOSE if found.parted else _NEARLY
        rounding = least < min(size, _NEAR) and (size < _NEAR or number - nearest >= _NO_LESS)
        if size < settled or rounding:
            return found
        if size < least:
            least, nearest = size, number
        elif number - nearest >= _STALLED:
            break
        begin, middle = state, after
        if last and found.parted and abs(change) > _FINE:
            share = change / (change - last[2]) if change != last[2] else 0.0
            if _LEAST < abs(share) < _MOST and (mixed := state.toward(last[0], share)):
                begin, middle = mixed, after + share * (last[1] - after)
        last = state, after, change
    raise LostError(f"half cycles still change by {least:.1e}")


def _centred(loads: Loads, before: HalfCycle, begin: Tractions) -> Loads:
    """Loads of a half cycle after which Q has no mean. Where some point never slips, the settled state is free of it;
    where each point slips, it would come back with the other sign in each half cycle, for ever."""
    low, high = before.stuck
    mean = begin.force + loads.shear / 2
    return loads if low < high or abs(mean) < _CENTRED else loads._replace(shear=loads.shear - mean)
