"""Ends of zones between the points of a table.

At the end e of a zone a traction vanishes like a square root: p at the ends of the contact, 2 f p - |dq| at the ends of
the stick zone; like (e - x)^(3/2) where the end drifted (docs/theory.md, section 7). The end lies between the last
value above zero and the first that is zero. How far, depends on what the values are: :class:`kinds.Average`.

Within this bracket one model is fitted to the nearest values: the average of (e - x)^(1/2) (c0 + c1 (e - x) + ...).
All ends, and all averages, that fit as well as noise of the size of the best fit's misfit allows are possible. A second
reading leaves the nearest values out: what blurs an end over some length, as friction by a penalty does, misleads the
first more than the second. The interval of both is the uncertainty. Where the values fade out, as they do where the
blur takes many points, the end may be anywhere from where they begin to.
"""

from collections.abc import Sequence
from itertools import permutations, product
from typing import NamedTuple

import numpy as np
from scipy.special import fdtri, stdtrit

from partialslip.codes.score.kinds import Average
from partialslip.tools.arrays import Array, Indices

_NEAR = (8, 16)  # accuracy: fewest points of fits beside the end; the one that leaves it less uncertain counts
_TERMS = (3, 4)  # accuracy: of its polynomial; of both the one that leaves the end less uncertain
_RISEN = 10.0  # accuracy: times the noise: least value where a fit begins
_MOST = 48  # cost: most points of a fit; longer ones are thinned out
_DOUBT = 1e-3  # accuracy: probability that noise alone makes the right end fit so much worse than the best
_SCAN, _AGAIN = 31, 7  # cost: ends tried at once, and how often between the neighbours of the best
FEWEST = 3  # accuracy: points beyond the end of a square root that show a drift
NOISE_FACTOR = 4.0  # accuracy: standard deviations of the noise: smaller values count as noise
ZERO_LEVEL = 1e-9  # accuracy: of the largest value: smaller values count as zero
# accuracy: of the largest pressure: what codes leave outside of a contact; a root is as small within 1e-10 of an end
_NOTHING = 1e-5


class ZoneEnd(NamedTuple):
    """End of a zone at ``x``, m, with its ``uncertainty``, m, read from values that may be any of ``averages``."""

    x: float
    uncertainty: float
    averages: tuple[Average, ...] = ()


class _Fit(NamedTuple):
    """The ``best`` end, m, of one fit, the interval from ``low`` to ``high`` that is possible, and the sum of squares
    that is left (``misfit``), with its degrees of ``freedom``."""

    best: float
    low: float
    high: float
    misfit: float
    freedom: int

    @property
    def width(self) -> float:
        """Length of the interval, m."""
        return self.high - self.low

    def better(self, other: "_Fit") -> bool:
        """Whether this fit leaves less than the ``other`` by more than chance does."""
        ratio = other.misfit / other.freedom * self.freedom / self.misfit
        return other.misfit < np.inf and bool(ratio > fdtri(other.freedom, self.freedom, 1 - _DOUBT))


def noise_level(values: Array, x: Array) -> float:
    """Standard deviation of the noise in ``values`` at ``x``, (n,) each: of their deviations from the cubics through
    two neighbours on either side, so that little of a smooth curve counts as noise."""
    if len(x) < 5:
        return 0.0
    nodes = np.stack([x[:-4], x[1:-3], x[3:-1], x[4:]]) - x[2:-2]
    shares = np.ones_like(nodes)
    for i, j in permutations(range(4), 2):
        shares[i] *= nodes[j] / (nodes[j] - nodes[i])
    off = values[2:-2] - (shares * [values[:-4], values[1:-3], values[3:-1], values[4:]]).sum(axis=0)
    return float(1.4826 * np.median(np.abs(off) / np.sqrt(1 + (shares**2).sum(axis=0))))


def zone_around_peak(values: Array, least: Array | float) -> tuple[int, int] | None:
    """First and last index of the points around the largest of ``values`` that exceed ``least``; None if none do."""
    peak = int(values.argmax())
    inside = values > np.maximum(least, ZERO_LEVEL * values[peak])
    if not inside[peak]:
        return None
    outside = np.flatnonzero(~inside)
    place = np.searchsorted(outside, peak)
    first = outside[place - 1] + 1 if place > 0 else 0
    last = outside[place] - 1 if place < len(outside) else len(values) - 1
    return int(first), int(last)


def least_pressure(x: Array, p: Array) -> float:
    """Largest of the pressures ``p`` at ``x`` (n,) that are none: noise, or what codes leave outside of a contact."""
    return max(NOISE_FACTOR * noise_level(p, x), _NOTHING * float(p.max()))


def possible_averages(x: Array, p: Array, averages: Sequence[Average]) -> tuple[Average, ...]:
    """Which of ``averages`` the values of the pressure ``p`` at ``x`` (n,) may be, from both ends of the contact."""
    least = least_pressure(x, p)
    touching = zone_around_peak(p, least)
    if touching is None or touching[1] - touching[0] < max(_TERMS) + 3:
        return tuple(averages)
    first, last = touching
    left = _Reading(-x[::-1], p[::-1], len(x) - 1 - first, len(x) - 1 - last, least).possible(averages)
    right = _Reading(x, p, last, first, least).possible(averages)
    both = [each for each in averages if each in left and each in right]
    found = both or [each for each in averages if each in left or each in right]
    plain = [each for each in found if each.points == 1]  # an average over points must show
    return tuple(plain or found)


def read_right_end(
    x: Array,
    values: Array,
    last: int,
    first: int,
    averages: Sequence[Average],
    *,
    least: float = 0.0,
    slack: Array | None = None,
    drifts: bool = False,
) -> ZoneEnd:
    """Right end of a zone, where ``values`` vanish.

    Parameters
    ----------
    x, values : (n,) arrays
        Points, ascending, m, and the values that vanish.
    last, first : int
        Last and first point inside the zone.
    averages : sequence of Average
        What the values may be.
    least : float
        Largest value that counts as noise.
    slack : (n,) array, optional
        Common error of all values.
    drifts : bool
        Whether the end may have drifted.
    """
    shifts = [values]
    if slack is not None and slack.max() > ZERO_LEVEL * values.max():
        shifts, least = [values, values + slack, values - slack], least + float(slack[last])
    found = [_Reading(x, each, last, first, least).end(averages, drifts) for each in shifts]
    fit, possible = found[0]
    low, high = min(each.low for each, _ in found), max(each.high for each, _ in found)
    return ZoneEnd(fit.best, max(high - fit.best, fit.best - low), possible)


def read_left_end(
    x: Array,
    values: Array,
    first: int,
    last: int,
    averages: Sequence[Average],
    *,
    least: float = 0.0,
    slack: Array | None = None,
    drifts: bool = False,
) -> ZoneEnd:
    """Left end of a zone: :func:`read_right_end` of the mirror image, with the same parameters."""
    count, slack = len(x) - 1, None if slack is None else slack[::-1]
    end = read_right_end(
        -x[::-1], values[::-1], count - first, count - last, averages, least=least, slack=slack, drifts=drifts
    )
    return end._replace(x=-end.x)


class _Reading:
    """Readings of the right end of the zone from point ``first`` to ``last``."""

    def __init__(self, x: Array, values: Array, last: int, first: int, least: float) -> None:
        self.whole = first  # point where the zone begins
        inner = values[first : last + 1][::-1]  # a fit reaches no farther than the values rise
        (fallen,) = np.nonzero(inner < np.maximum.accumulate(inner) - 2 * least)
        first = last - int(inner[: fallen[0] if len(fallen) else len(inner)].argmax())
        self.x, self.values, self.last, self.first = x, values, last, first
        self.spacing = float(x[last] - x[max(last - 1, 0)])
        (risen,) = np.nonzero(values[first : last + 1] >= _RISEN * least)
        self.risen = first + int(risen[-1] if len(risen) else 0)
        # what counts as zero, in c: the values near the end are about the averages of c (end - x)^(1/2)
        begin = self._begin(_NEAR[0])
        self.least = max(least, ZERO_LEVEL * float(values.max()))
        self.zero = self.least / float(values[begin]) * float(x[last] - x[begin]) ** 0.5
        self.more = self.spacing if last + 1 == len(x) else 0.0

    def possible(self, averages: Sequence[Average]) -> tuple[Average, ...]:
        """The ``averages`` that are possible."""
        return self._near(averages)[1]

    def end(self, averages: Sequence[Average], drifts: bool) -> tuple[_Fit, tuple[Average, ...]]:
        """The end, and the averages that are possible."""
        near, possible = self._near(averages)
        low, high = self._bracket(possible)
        found = near._replace(low=min(near.low, low), high=max(near.high, high))  # no more than the bracket is known
        average = possible[0]
        far = self._far(average, high, 1)
        fade = self._fade(possible)
        if far is not None and (fade is not None or far.better(near)):
            found = self._blurred(average, found, far, high)
        elif far is not None:
            # what misleads halves with twice the distance, so that the end is off by twice what it moves, if it does
            inner = min(far.low, 2 * far.best - near.best)
            if far.high >= low:
                found = near._replace(
                    low=min(near.low, max(inner, float(self.x[self.last]) - self.spacing)),
                    high=max(near.high, far.high),
                )
            else:
                found = found._replace(low=min(found.low, inner))
        if fade is not None:
            best = min(max(found.best, fade), high)
            found = found._replace(best=best, low=min(found.low, fade), high=max(found.high, high))
        # where an end drifted, the cube root of the values ends like a square root
        drifted = self._drifted(possible) if drifts and self._fade(possible, 1 / 3) is None else None
        if drifted and drifted.width < found.width:
            return drifted, possible
        return found, possible

    def _bracket(self, averages: Sequence[Average]) -> tuple[float, float]:
        """Where the end may lie: the last value is above zero, and the next is not."""
        low = min(each.begins(self.x, self.last) for each in averages)
        high = max(each.begins(self.x, self.last + 1) + each.hidden(self.zero, self.spacing) for each in averages)
        return low, high + self.more

    def _fade(self, averages: Sequence[Average], power: float = 1.0) -> float | None:
        """Where the values to a ``power`` begin to fade out, m; None if they end like a square root averaged.

        Secants from the first zero grow less steep inward where values end like a square root, and steeper at first
        where they fade, as (1 - tanh(slip/delta)) does. A faded end lies between the steepest secant's two ends.
        """
        points = np.arange(self.last, self.whole - 1, -1)
        distances = float(self.x[min(self.last + 1, len(self.x) - 1)]) + self.more - self.x[points]
        least = self.least**power
        slopes = (np.maximum(self.values[points], 0.0) ** power - least) / distances
        (fallen,) = np.nonzero(slopes < np.maximum.accumulate(slopes) - 2 * least / distances)
        rising = int(slopes[: fallen[0] if len(fallen) else len(points)].argmax())
        return float(self.x[points[slopes.argmax()]]) if rising > max(each.rises for each in averages) else None

    def _begin(self, count: int) -> int:
        """First point of a window of ``count`` points, or more: the values there are well above the noise."""
        return max(min(self.last + 1 - count, self.risen), self.first)

    def _near(self, averages: Sequence[Average]) -> tuple[_Fit, tuple[Average, ...]]:
        """From the values beside the end, and those beyond; with the averages that are possible."""
        if self.last - self.first < 2:  # too few to fit
            low, high = self._bracket(averages)
            return _Fit((low + high) / 2, low, high, np.inf, 1), tuple(averages)
        beyond = min(max(self.last + 2, int(np.searchsorted(self.x, self._bracket(averages)[1]))), len(self.x) - 1)
        found = []
        for begin, terms in product({self._begin(count) for count in _NEAR}, _TERMS):
            window = _thinned(begin, beyond)
            inside = int(np.count_nonzero(window <= self.last))
            terms = max(min(terms, inside - 2), 1)
            freedom = max(inside - terms - 1, 1)
            tried = [self._misfits(each, window, *self._bracket([each]), 0.5, terms) for each in averages]
            within = min(misfits.min() for _, misfits in tried) * _worse(freedom)
            fits = {each: _fit(*of, within, freedom) for each, of in zip(averages, tried, strict=True)
                    if of[1].min() <= within}  # fmt: skip
            best = min(fits.values(), key=lambda fit: fit.misfit)
            low, high = min(fit.low for fit in fits.values()), max(fit.high for fit in fits.values())
            found.append((best._replace(low=low, high=high), tuple(sorted(fits, key=lambda each: fits[each].misfit))))
        (fit, possible), closest = (
            min(found, key=lambda each: each[0].width),
            min((each for each, _ in found), key=lambda each: each.misfit / each.freedom),
        )
        return fit._replace(misfit=closest.misfit, freedom=closest.freedom), possible

    def _far(self, average: Average, high: float, times: int) -> _Fit | None:
        """Without the nearest points, and ``times`` as far away; None if there are too few points."""
        count, fewest = self.last + 1 - self._begin(_NEAR[0]), max(_TERMS) + 3
        stop = self.last - times * (3 * count // 4)
        if times == 1:
            stop = max(stop, min(self.first + fewest - 1, self.last - 1))
        window = _thinned(max(stop + 1 - times * (3 * count // 2), self.first), stop)
        if len(window) < fewest:
            return None
        fits = []
        for terms in _TERMS:
            freedom = len(window) - terms - 1
            tried = self._misfits(average, window, float(self.x[stop]), high, 0.5, terms)
            fits.append(_fit(*tried, tried[1].min() * _worse(freedom), freedom))
        return min(fits, key=lambda fit: fit.width)

    def _blurred(self, average: Average, near: _Fit, far: _Fit, high: float) -> _Fit:
        """Where the nearest points mislead: from farther and farther away, until the end moves by half a spacing at
        most. What misleads halves with twice the distance, so that the end is off by as much as it moved."""
        moved, times, low = abs(far.best - near.best), 2, far.low
        while moved > self.spacing / 2 and (farther := self._far(average, high, times)) is not None:
            moved, times, low = abs(farther.best - far.best), 2 * times, min(far.low, farther.low)
            far = farther
        return far._replace(low=min(low, far.best - moved), high=high)

    def _drifted(self, averages: Sequence[Average]) -> _Fit | None:
        """Where the values fall with the power 3/2, as two points and three show, whose ends agree better than with a
        square root and with a line."""
        if self.last - self.first < FEWEST:
            return None
        known, apart = {}, {}
        for power in (0.5, 1.0, 1.5):
            ends = []
            for each, terms in product(averages, (1, 2)):
                window = np.arange(self.last - terms, self.last + 1)
                tried, misfits = self._misfits(each, window, *self._bracket([each]), power, terms)
                end = float(tried[misfits.argmin()])
                inside = min(end - tried[0], tried[-1] - end) > ZERO_LEVEL * (tried[-1] - tried[0])
                ends.append(end if inside else np.inf)
            known[power], apart[power] = ends[1], max(ends) - min(ends) if max(ends) < np.inf else np.inf
        if apart[1.5] >= min(apart[0.5], apart[1.0]):
            return None
        return _Fit(known[1.5], known[1.5] - apart[1.5], known[1.5] + apart[1.5], 0.0, 1)

    def _misfits(
        self, average: Average, window: Indices, low: float, high: float, power: float, terms: int
    ) -> tuple[Array, Array]:
        """Ends from ``low`` to ``high``, (e,), closer together beside the best, and the sum of squares that each leaves
        of the values at the ``window``."""
        scale = float(self.x[window[-1]] - self.x[window[0]])
        x, y, powers = self.x / scale, self.values[window], power + np.arange(float(terms))
        ends = np.linspace(low, high, _SCAN) / scale
        every: list[tuple[Array, Array]] = []
        for _ in range(_AGAIN):
            Q, _ = np.linalg.qr(average.powers(x, window, ends, powers))
            left = y - np.einsum("enk,ek->en", Q, np.einsum("enk,n->ek", Q, y))
            misfits = (left**2).sum(axis=1) + len(y) * (ZERO_LEVEL * np.abs(y).max()) ** 2
            every.append((ends, misfits))
            best = int(misfits.argmin())
            ends = np.linspace(ends[max(best - 1, 0)], ends[min(best + 1, _SCAN - 1)], _SCAN)
        ends, misfits = (np.concatenate(parts) for parts in zip(*every, strict=True))
        order = np.argsort(ends, kind="stable")
        return ends[order] * scale, misfits[order]


def _worse(freedom: int) -> float:
    """How much larger than the least the sum of squares may be by noise alone, with that many degrees of freedom."""
    return float(1 + stdtrit(freedom, 1 - _DOUBT / 2) ** 2 / freedom)


def _fit(ends: Array, misfits: Array, within: float, freedom: int) -> _Fit:
    """The best of the ``ends``, and the first and last whose misfit is ``within`` bounds, each up to the next that is
    not."""
    (good,) = np.nonzero(misfits <= within)
    low, high = ends[max(good[0] - 1, 0)], ends[min(good[-1] + 1, len(ends) - 1)]
    return _Fit(float(ends[misfits.argmin()]), float(low), float(high), float(misfits.min()), freedom)


def _thinned(first: int, last: int) -> Indices:
    """Points from ``first`` to ``last``; every second, third, ... if there are too many."""
    return np.arange(last, first - 1, min(-(last + 1 - first) // _MOST, -1))[::-1]
