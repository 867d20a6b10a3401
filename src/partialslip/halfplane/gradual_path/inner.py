"""A phase in which a zone inside the stick zone slips; scaled as in :mod:`partialslip.halfplane.shape`."""

import itertools

import numpy as np

from partialslip.halfplane.gradual_path.inner_rates import A, B, L, R
from partialslip.halfplane.gradual_path.inner_way import SHUT, Way
from partialslip.halfplane.gradual_path.retreat import Zone
from partialslip.halfplane.gradual_path.stage import Loads, LostError, Stage
from partialslip.halfplane.gradual_path.tractions import Piece, Tractions
from partialslip.tools.arrays import Array

_PATIENT = 24  # cost: steps without progress, for ways that are lost with fewer


def opens(first: Stage, least: float) -> bool:
    """Whether an inner slip zone opens inside the stick zone at the beginning of a half cycle, the stage ``first``.

    It opens where points at the friction bound, of abscissa ``low`` on, lie to the left of e - c*: e - c* - low >
    ``SHUT``, with e the centre of the stick zone and c* = ``least``.
    """
    last = first.q.parts[-1]
    return last.smooth is None and first.zone.centre - least - last.low > SHUT


def inner_phase(loads: Loads, first: Stage, near: object = None) -> "Parted":
    """The phase in which a zone inside the stick zone slips, from ``first`` on, perhaps ``near`` a similar phase."""
    # Why this stays, though it is two fifths of its package: of 144 random scenes slip reverses in 46, and in 23 of
    # these a zone inside slips, which moves m or n by up to 3e-2 a (by less than 1e-7 a in most). Without it the exact
    # method would refuse them, and march, which knows three to four digits, would be their reference. Of the 23, 19 are
    # solved here, in 0.3 to 7 CPU s in place of 0.05 to 0.6 s; none is a shipped scene or a benchmark problem.
    return Parted(loads, first, first.q.parts[-1].low, near if isinstance(near, Parted) else None)


def _followed(loads: Loads, first: Stage, low: float, near: Way | None) -> Way:
    given = loads.tension, loads.least, first.q, first.zone.left, low
    try:
        return Way(*given, near)
    except LostError:  # rounding decides whether Newton's method comes through
        return Way(*given, patience=_PATIENT)


class Parted:
    """The stick zone is parted by an inner slip zone from ``first`` on. ``low`` is the left end of the points on the
    lower friction bound that the first rate pushes. ``way``: the ways of the ends, perhaps near those of a similar
    phase."""

    def __init__(self, loads: Loads, first: Stage, low: float, near: "Parted | None" = None) -> None:
        self.way: Way = _followed(loads, first, low, near.way if near else None)
        self.first = first._replace(inner=Zone(*(float(self.way.first[end]) for end in (A, B))))
        self.last = last = self.at(self.way.progress)
        if self.way.vanished and last.inner:
            zone = Zone(last.inner.right, right=last.zone.right)
            parts = Piece(-1.0, zone.left, -1.0), *last.q.between(zone.left, 1.0)
            self.last = Stage(last.progress, zone, Tractions.of(first.q.shape, parts))
        elif not self.way.closed:
            raise LostError("an inner zone slips up to the end of the half cycle")

    def lacking(self, from_left: Array, from_right: Array) -> Array:
        """p - q in the right interval at distances from the ends of the last zone."""
        del from_left
        way = self.way
        seen, _ = way.seen(way.ends, R, -from_right, way.progress)
        return self.first.q.less(1.0, float(way.ends[R]) - from_right) - seen

    def at(self, progress: float) -> Stage:
        """Stage at a ``progress`` within the phase."""
        way, q = self.way, self.first.q
        ends = way.at(progress)
        left, low, high, right = (float(each) for each in ends[:4])
        shut = way.closed and progress == way.progress  # what is left of the inner zone is no part of its own

        def added(part: Piece, first: int, last: int) -> Piece:
            def change(from_low: Array, from_high: Array) -> Array:
                result, to_first = np.empty_like(from_low), np.maximum(part.low - ends[first] + from_low, 0.0)
                to_last = ends[last] - part.high + from_high
                near = to_first < to_last
                for here, end, offsets in ((near, first, to_first[near]), (~near, last, -to_last[~near])):
                    result[here] = way.seen(ends, end, offsets, progress)[0]
                return result

            return part.plus(change)

        cuts = [low if shut else high, *sorted(cut for cut in way.kinks if high < cut < right), right]
        parts = [
            Piece(-1.0, left, -1.0),
            *(added(part, L, A) for part in q.between(left, low)),
            *([] if shut else [Piece(low, high, -1.0)]),
            *(added(Piece(*span, -1.0), B, R) for span in itertools.pairwise(cuts)),
            Piece(right, 1.0, 1.0),
        ]
        return Stage(progress, Zone(left, right), Tractions.of(q.shape, parts), Zone(low, low if shut else high))
