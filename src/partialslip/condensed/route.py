"""Which nodes slip in the steps of a march: where the steps of another march on the same nodes begin."""

import bisect
import math

import numpy as np

from partialslip.condensed.bounded import Sides
from partialslip.condensed.path import Path

_SAME = 1e-12  # difference of times that is rounding
_WIDE = 3.0  # times a step: farther apart, two known states say less than the steps before


class Route:
    """Sides after the steps of the last march, by time: the number of ways that are done, and the fraction of the next.
    ``near`` are sides (n,) after the first loading, known from elsewhere.

    What a step leads to does not depend on where its active set begins.
    """

    def __init__(self, near: Sides | None = None) -> None:
        self._loads: tuple[object, ...] = ()
        self._times: list[float] = [1.0] if near is not None else []
        self._sides: list[Sides] = [near] if near is not None else []

    def keep(self, path: Path, sides: list[Sides]) -> None:
        """Remember the ``sides`` after the first steps along ``path``."""
        self._loads, self._times, self._sides = (path.begin, path.cycle), path.times[: len(sides)], sides

    def at(self, path: Path, time: float, step: float) -> Sides | None:
        """Sides with which a ``step`` along ``path`` up to the ``time`` may begin; None if those of the step before are
        likely to be nearer.

        Under other loads these are likely to be nearer in all steps but the first of a way, before which nothing slips.
        """
        after = bisect.bisect_left(self._times, time - _SAME)
        if after == len(self._times):
            return None
        known, same, way = self._times[after], self._loads == (path.begin, path.cycle), math.ceil(time - _SAME) - 1
        sides, begins = self._sides[after], time - step <= way + _SAME
        if known <= time + _SAME:
            return sides if same or begins else None
        before = max(self._times[after - 1] if after else 0.0, float(way))
        if not same or not (begins or known - before <= _WIDE * step):
            return None
        earlier = self._sides[after - 1] if before > way + _SAME else 0 * sides
        return ahead(sides, earlier, (time - known) / (known - before))


def ahead(sides: Sides, earlier: Sides, times: float) -> Sides:
    """Sides after a step if the ends of slip zones go on moving, ``times`` as far as in the step from the ``earlier``
    sides to these ``sides``, (n,) each; the same ``sides`` if slip zones have come or gone, but for the first, which
    come from the ends.
    """
    ends, before = (np.flatnonzero(np.diff(each)) + 1 for each in (sides, earlier))
    runs, runs_before = (each[np.append(0, at)] for each, at in ((sides, ends), (earlier, before)))
    if not earlier.any() and np.count_nonzero(runs == 0) == 1:
        before = np.where(runs[1:] == 0, 0, len(sides))
    elif not np.array_equal(runs, runs_before):
        return sides
    moved = np.maximum.accumulate(np.clip(np.rint(ends + times * (ends - before)), 0, len(sides)).astype(np.int64))
    result: Sides = np.repeat(runs, np.diff(moved, prepend=0, append=len(sides)))
    return result
