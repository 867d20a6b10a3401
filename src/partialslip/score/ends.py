"""Locate the ends of zones between the points of a table whose tractions may be coarse, noisy or smoothed.

At an end a traction vanishes like a square root: p at the ends of the contact, 2 f p - |dq| at the ends of the stick
zone. The square of the traction is smooth, and the root of the square is the end. Polynomials of several degrees are
fitted to the square on windows of different length and distance from the end. Each fit gives an estimate of the end
with an uncertainty: the difference between degrees, and the noise. The estimate with the least uncertainty is taken.
Estimates of similar uncertainty elsewhere increase the uncertainty of the end: smoothing, or friction with a penalty,
spreads an end over some length.
"""

from collections.abc import Sequence
from itertools import chain, islice, pairwise
from typing import NamedTuple

import numpy as np

from partialslip.arrays import Array, Indices

_POINTS = (4, 5, 6, 8, 11, 16, 24, 36, 54, 80, 120, 180, 270, 400, 600, 900)  # accuracy: of the windows that are tried
_MANY = 60  # accuracy: most points of a fit; longer windows are thinned out
_FEW = 8  # accuracy: most points of a window whose scatter about the polynomial is noise alone
_SKIPPED = (0, 1, 2, 4, 7, 12, 20, 34, 56, 90, 150, 240, 400)  # accuracy: points between the window and the end
_PART = 0.6  # accuracy: of the zone: largest distance of a window, beyond which the other end matters
_NEAREST = 2.0  # accuracy: of a window's points: most points skipped
_NEAR = 3  # accuracy: number of distances that count as near the end
_AGREE = 3.0  # accuracy: largest difference of estimates from near and far, in their uncertainties
_FADES = 0.35  # accuracy: of the value three points further in: if the last values are less, the traction fades out
_RISEN = 0.1  # accuracy: of the mean: a square root rises to this within a fortieth of the zone
_RISE = 0.1  # accuracy: of the zone: a traction that takes longer to rise to _RISEN fades out
_STEEP = 3.0  # accuracy: times the median slope: steeper polynomials are due to noise
_ABOVE = 2.0  # accuracy: times the noise: least value of a window that gives a slope
_FALL = 0.05  # accuracy: least ratio of the neglected terms from one degree to the next
_SAFE = 2.6  # accuracy: factor on the least uncertainty, as selecting the least one is biased
_COMPARABLE = 5.0  # accuracy: times the least uncertainty: largest uncertainty of an estimate that counts for the drift
_SPREAD = 0.5  # accuracy: of the length over which an end is spread: error of the end
_CELL = 0.06  # accuracy: of a cell: shift of the end of a square root by taking means over cells
_DRIFTS = 1e-6  # accuracy: of the largest value: least one of a zone that has drifted
_CLEAR = 10.0  # accuracy: times the noise: least value beyond the end of a square root that a few points tell
# accuracy: times the length over which the contact's ends are spread: shortest drift that smoothing does not mimic
_BLURS = 5.0
_LEADS = 1e-30  # accuracy: of the largest coefficient of a polynomial: least first one, whose root is far away
FEWEST = 3  # accuracy: points beyond the end of a square root that show a drift
NOISE_FACTOR = 4.0  # accuracy: standard deviations of the noise: smaller values count as noise
ZERO_LEVEL = 1e-9  # accuracy: of the largest value: smaller values count as zero


class ZoneEnd(NamedTuple):
    """End of a zone at ``x``, m, its ``uncertainty``, m, and the part of it due to the ``spread`` of the end, m."""

    x: float
    uncertainty: float
    spread: float = 0.0


class _Estimate(NamedTuple):
    """End of a zone from one window, m: its ``uncertainty`` if polynomials of rising degree converge, its ``doubt`` if
    they do not, and the ``slope`` of the polynomial there."""

    x: float
    uncertainty: float
    doubt: float
    slope: float


class _Root(NamedTuple):
    """Root of a polynomial.

    Parameters
    ----------
    x : float
        The root, m.
    points : int
        Number of points fitted.
    highest : float
        Largest value in the window.
    slope : float
        Of the polynomial at the root.
    scatter : float
        Mean square deviation of the points from the polynomial.
    gain : float
        Standard error of the root divided by the root of ``scatter``.
    moved : float
        Shift of the root by the slack, m.
    """

    x: float
    points: int
    highest: float
    slope: float
    scatter: float
    gain: float
    moved: float


def noise_level(values: Array, x: Array) -> float:
    """Standard deviation of the noise in ``values`` at ``x``, (n,) each.

    It is estimated from the deviations from the straight line through both neighbours, so that curvature between
    neighbouring points is included.
    """
    share = (x[1:-1] - x[:-2]) / (x[2:] - x[:-2])
    off = values[1:-1] - (1 - share) * values[:-2] - share * values[2:]
    return float(1.4826 * np.median(np.abs(off)) / np.sqrt(1.5))


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


def read_right_end(
    x: Array, values: Array, last: int, first: int, *, cells: bool = False, slack: Array | None = None, least: float = 0
) -> ZoneEnd:
    """Right end of a zone, where ``values`` vanish like a square root.

    If the values fade out instead, the uncertainty is the length over which they do.

    Parameters
    ----------
    x, values : (n,) arrays
        Points, ascending, m, and the values that vanish.
    last, first : int
        Last and first point inside the zone.
    cells : bool
        Whether values are means over cells. The mean over the cell with the end is left out.
    slack : (n,) array, optional
        Common error of all values.
    least : float
        Largest value that counts as noise.
    """
    end = _end(x, values, last, first, cells, np.zeros_like(values) if slack is None else slack, least)
    mean = float(np.trapezoid(values[first : last + 1], x[first : last + 1])) / max(x[last] - x[first], 1e-300)
    risen = x[first + np.flatnonzero(values[first : last + 1] >= _RISEN * mean)[-1]]
    faded = end.x - risen
    return ZoneEnd(end.x, faded, faded) if faded > _RISE * (x[last] - x[first]) else end


def _end(x: Array, values: Array, last: int, first: int, cells: bool, slack: Array, least: float) -> ZoneEnd:
    """The end and its uncertainty, from polynomials through the squares of the values."""
    spacing = x[last] - x[max(last - 1, 0)]
    beyond = x[last + 1] if last + 1 < len(x) else x[last] + 2 * spacing
    outermost = max(x[-1], beyond) + (beyond - x[last]) / 2
    reach = min(last - int(_PART * (last - first)), max(last - _FEW, first))
    windows: list[list[Indices]] = []
    for skipped in reversed(_SKIPPED):
        at = last - int(cells) - skipped
        counts = [count for count in _POINTS if at - count + 1 >= reach and _NEAREST * count >= skipped]
        windows.append([at - np.arange(0, count, -(-count // _MANY))[::-1] for count in counts])
    found_on = iter(_roots(x, values, slack, list(chain.from_iterable(windows)), outermost, spacing))
    levels = [list(islice(found_on, len(level))) for level in windows]
    every = [root for level in levels for roots in level for root in roots if root]
    # only the highest degree: the scatter about lower degrees includes curvature
    close = [roots[-1] for level in levels[-_NEAR:] for roots in level if roots]
    few = [root.scatter for root in close if root and root.points <= _FEW]
    floor = float(np.median(few)) if few else 0.0
    clear = [root for root in every if root.points > _FEW and root.highest > _ABOVE * least]
    slope = float(np.median([abs(root.slope) for root in clear])) if clear else np.inf
    # Two expressions for the length that noise hides: here by the median slope, below (outside) by each estimate's own.
    # They are kept as they are, as the published figures depend on both.
    hidden, steepest = least**2 / slope, _STEEP * slope
    every_level = [[end for roots in level for end in _estimates(roots, floor, steepest)] for level in levels]
    found = _agreeing(every_level)
    # over the three points before the last a square root falls to half; a steeper fall is fading out
    fades = last - first >= _FEW and values[last - 1] < _FADES * values[last - 4]
    apart = 0.0
    if len(found) < len([level for level in every_level if level]) and not fades:
        # a kink may mislead the estimates from far windows: prefer those between the last point and the next
        within = [end for level in every_level[-_NEAR:] for end in level if x[last] <= end.x <= beyond]
        if within:
            nearest = min(within, key=lambda end: end.uncertainty)
            apart = abs(nearest.x - min(found, key=lambda end: end.uncertainty).x) if found else 0.0
            found = [nearest]
    if not found:
        return ZoneEnd(float(x[last] + beyond) / 2, float(x[last] - x[first] if fades else (beyond - x[last]) / 2))
    outside = [max(end.x - beyond - least**2 / abs(end.slope), 0.0) for end in found]
    off, best = min(zip(outside, found, strict=True), key=lambda pair: np.hypot(pair[0], pair[1].uncertainty))
    spread = _SPREAD * max(x[last] - cells * spacing - best.x, off, 0.0)
    drift = max(abs(end.x - best.x) for end in found if end.uncertainty <= _COMPARABLE * best.uncertainty)
    own = float(np.linalg.norm((_SAFE * best.uncertainty, _SPREAD * apart, drift)))
    if x[last] <= best.x <= beyond and not fades:  # the end lies between two points, except for the hidden length
        own = min(own, beyond - x[last] + hidden)
    return ZoneEnd(best.x, float(np.linalg.norm((own, spread, _CELL * cells * spacing))), spread)


def read_left_end(
    x: Array, values: Array, first: int, last: int, *, cells: bool = False, slack: Array | None = None, least: float = 0
) -> ZoneEnd:
    """Left end of a zone: :func:`right_end` of the mirror image.

    ``x``, ``values``, ``first``, ``last``, ``cells``, ``slack`` and ``least`` as there.
    """
    count, slack = len(x) - 1, None if slack is None else slack[::-1]
    end = read_right_end(-x[::-1], values[::-1], count - first, count - last, cells=cells, slack=slack, least=least)
    return end._replace(x=-end.x)


def blur(contact: tuple[ZoneEnd, ZoneEnd], whole: bool) -> float:
    """Length over which the ends of the ``contact`` are spread, m; infinite unless the ``whole`` of it is seen."""
    return max(end.spread for end in contact) / _SPREAD if whole else np.inf


def drifted_right_end(x: Array, values: Array, end: ZoneEnd, last: int, least: float, spread: float) -> ZoneEnd:
    """Right end of a zone that may have drifted there: beyond the ``end`` of a square root, ``values`` then fall with
    the power 3/2 of the distance (docs/theory.md, section 7). The ``end`` itself if they do not, less sure if they may.

    A square root that was averaged over some length falls with the same power: only ends of the contact that are
    ``spread`` (:func:`blur`) over much less than the drift show that nothing was averaged.

    ``x``, ``values``, ``last`` and ``least`` as for :func:`right_end`.
    """
    high = values > max(least, _DRIFTS * values.max())
    beyond = np.flatnonzero(high & (x > end.x) & (np.arange(len(x)) <= last + 1))
    if not len(beyond) or (len(beyond) < FEWEST and values[beyond[0]] < _CLEAR * least):
        return end
    farthest = float(x[min(beyond[-1] + 1, len(x) - 1)])
    unsure = end._replace(uncertainty=float(np.hypot(end.uncertainty, farthest - end.x)))
    told = len(beyond) >= FEWEST and x[beyond[-1]] - end.x >= _BLURS * spread
    if not told or (np.diff(values[beyond]) >= 0).any() or (np.diff(beyond) > 1).any():
        return unsure
    height = np.cbrt(values[beyond] / values.max()) ** 2
    t, found = x[beyond] - x[beyond[-1]], []
    for count, degree in ((max(len(t) // 2, 2), 1), (len(t), 2), (len(t), 3)):
        fitted = np.polyfit(t[-count:], height[-count:], min(degree, count - 1))
        root = float(_nearest_root(fitted[None], 0.0, np.inf)[0])
        if np.isnan(root):
            return unsure
        found.append(float(x[beyond[-1]]) + root)
    uncertainty = _SAFE * float(np.ptp(found))
    return ZoneEnd(found[1], uncertainty) if uncertainty < end.spread else unsure


def drifted_left_end(x: Array, values: Array, end: ZoneEnd, first: int, least: float, spread: float) -> ZoneEnd:
    """Left end of a zone that has drifted there: :func:`drifted_right_end` of the mirror image."""
    mirrored = end._replace(x=-end.x)
    found = drifted_right_end(-x[::-1], values[::-1], mirrored, len(x) - 1 - first, least, spread)
    return found._replace(x=-found.x)


def _agreeing(levels: list[list[_Estimate]]) -> list[_Estimate]:
    """The best estimate from each distance (``levels``), from far to near, until one disagrees with those before."""
    found: list[_Estimate] = []
    left, right = -np.inf, np.inf
    for level in levels:
        if level:
            surest = min(level, key=lambda end: end.doubt)
            left, right = max(left, surest.x - _AGREE * surest.doubt), min(right, surest.x + _AGREE * surest.doubt)
            if left > right:
                break
            found.append(min(level, key=lambda end: end.uncertainty))
    return found


def _estimates(roots: list[_Root | None], floor: float, steepest: float) -> list[_Estimate]:
    """Estimates of the end from ``roots`` of polynomials of neighbouring degrees.

    ``floor`` is the least mean square of the noise, and the bias of y^2. Slopes above ``steepest`` are due to noise.
    """
    found, before = [], np.inf
    for lower, higher in pairwise(roots):
        if lower and higher:
            others = np.hypot(higher.gain * np.sqrt(max(higher.scatter, floor)), higher.moved)
            apart = abs(lower.x - higher.x)
            left_out = apart * max(min(apart / before, 1.0), _FALL) if before < np.inf else apart
            steep = max(abs(higher.slope) / steepest, 1.0)
            doubt, uncertainty = (steep * float(np.hypot(others, part)) for part in (apart, left_out))
            found.append(_Estimate(higher.x + floor / higher.slope, uncertainty, doubt, higher.slope))
            before = max(apart, 1e-300)
    return found


def _roots(
    x: Array, y: Array, slack: Array, windows: Sequence[Indices], far: float, spacing: float
) -> list[list[_Root | None]]:
    """Roots of polynomials through y^2 on each of the ``windows``, by degree, between the last point of the window less
    the ``spacing`` and ``far``.

    The error of ``y`` is the same at all points, so that the error of y^2 is proportional to y. Shorter windows are
    filled up with points of no weight.
    """
    found: list[list[_Root | None]] = [[] for _ in windows]
    if not windows:
        return found
    counts = np.array([len(window) for window in windows])
    places = np.arange(counts.max()) - (counts.max() - counts)[:, None]
    points = np.concatenate(windows)[np.maximum(places, 0) + (np.cumsum(counts) - counts)[:, None]]
    end, highest = x[points[:, -1]], np.where(places >= 0, np.abs(y[points]), 0.0).max(axis=1)
    scale = end - x[points[:, 0]]
    t, size = (x[points] - end[:, None]) / scale[:, None], np.abs(y[points])
    weights = (places >= 0) / np.maximum(size, 0.03 * highest[:, None])
    right = np.stack([y[points] * size, 2 * size * slack[points]], axis=-1) * weights[..., None]
    rising, kept = np.stack([t**3, t**2, t, np.ones_like(t)], axis=-1) * weights[..., None], np.arange(len(windows))
    for degree in (1, 2, 3):
        kept = kept[counts[kept] > degree + 1]
        A = rising[kept, :, 3 - degree :]
        Q, R = np.linalg.qr(A)
        full = np.abs(R.diagonal(axis1=1, axis2=2)).min(axis=1) > 1e-13 * np.abs(R).max(axis=(1, 2))
        kept, A, Q, R = kept[full], A[full], Q[full], R[full]
        if not len(kept):
            return found
        inverse = np.linalg.inv(R)
        solution, shift = np.moveaxis(inverse @ (Q.mT @ right[kept]), -1, 0)
        root = _nearest_root(solution, -spacing / scale[kept], (far - end[kept]) / scale[kept])
        powers = np.where(np.isnan(root), 0.0, root)[:, None] ** np.arange(degree, -1, -1)
        slope = (solution[:, :-1] * np.arange(degree, 0, -1) * powers[:, 1:]).sum(axis=1)
        freedom = counts[kept] - degree - 1
        residual = (A @ solution[..., None])[..., 0] - right[kept, :, 0]
        scatter = (residual**2).sum(axis=1) / freedom + (1e-12 * highest[kept]) ** 2  # at least rounding
        known = np.isfinite(root) & (slope != 0)
        per = scale[kept] / np.where(known, np.abs(slope), 1.0)
        few = 1 + 2 / freedom  # few degrees of freedom underestimate the scatter
        gain = few * per * np.linalg.norm((powers[:, None] @ inverse)[:, 0], axis=1)
        moved = per * np.abs((powers * shift).sum(axis=1))
        at = end[kept] + root * scale[kept]
        rows = np.column_stack([at, counts[kept], highest[kept], slope / scale[kept], scatter, gain, moved])
        for window, good, row in zip(kept.tolist(), known.tolist(), rows.tolist(), strict=True):
            found[window].append(_Root(row[0], int(row[1]), *row[2:]) if good else None)
    return found


def _nearest_root(polynomials: Array, near: Array | float, far: Array | float) -> Array:
    """The real root nearest to 0 of each of the ``polynomials`` (k, d + 1), from the highest power on, (k,); nan where
    none lies between ``near`` and ``far``, numbers or (k,)."""
    count, degree = len(polynomials), polynomials.shape[1] - 1
    leading, least = polynomials[:, :1], _LEADS * np.abs(polynomials).max(axis=1, keepdims=True)
    companion = np.zeros((count, degree, degree))
    companion[:, 1:, :-1] = np.eye(degree - 1)
    companion[:, 0] = -polynomials[:, 1:] / np.where(np.abs(leading) > least, leading, least)
    roots = np.linalg.eigvals(companion)
    low, high = np.reshape(near, (-1, 1)), np.reshape(far, (-1, 1))
    inside = (np.abs(roots.imag) < 1e-12) & (roots.real > low) & (roots.real < high)
    distance = np.where(inside, np.abs(roots.real), np.inf)
    best = np.take_along_axis(roots.real, distance.argmin(axis=1)[:, None], axis=1)[:, 0]
    return np.where(inside.any(axis=1), best, np.nan)
