"""Where zones end, below the spacing of the points, from tractions that may be coarse, noisy or smoothed.

What vanishes at an end, p at the ends of the contact and 2 f p - |dq| at those of the stick zone, does so like a square
root: its square is smooth, and its root is the end. Polynomials of two degrees through more and fewer points, near the
end and farther from it, each give one; they differ by what the curve bends, and scatter with the noise. The one that is
known best is taken. Where others that are known as well lie elsewhere, the end is known no better than they differ: a
table that was smoothed, or friction with a penalty, spreads the end over some length, and shows it there.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from partialslip.arrays import Array

_POINTS = (4, 5, 6, 8, 11, 16, 24, 36, 54, 80, 120, 180, 270, 400, 600, 900)
_MANY = 60  # points that tell as much as more of them
_FEW = 8  # points, whose scatter about their polynomial is noise
_SKIPPED = (0, 1, 2, 4, 7, 12, 20, 34, 56, 90, 150, 240, 400)  # points next to the end that are left out
_PART = 0.6  # of the zone: farther points know of its other end
_NEAREST = 2.0  # of the points skipped: windows are at least half as long as they are far from the end
_NEAR = 3  # of the levels, which are near the end
_AGREE = 3.0  # times their uncertainties, by which ends seen from near and from afar may differ
_FADES = 0.35  # of the value three points further in: less of it at the last points fades out
_RISEN = 0.1  # of their mean, to which values that vanish like a square root rise within a fortieth of the zone
_RISE = 0.1  # of the zone: values that take longer for that fade out
_STEEP = 3.0  # times the median slope: what is steeper is due to noise
_ABOVE = 2.0  # times the noise, to which points tell how steep the square is
_FALL = 0.05  # at best, from one degree to the next, of what polynomials leave out
_SAFE = 2.6  # times the uncertainty of the best one: it is the best by some luck, too
_LEVEL = 5.0  # times the uncertainty of the best one, up to which others that lie elsewhere count
_SPREAD = 0.5  # of the length over which an end is spread, that it may be off
_CELL = 0.06  # of a cell, that means over cells displace the end of a square root
NOISE = 4.0  # times the standard deviation, below which a value is no more than noise
ROUNDING = 1e-9


class End(NamedTuple):
    """A place, m, and how far it may be off; how much of that is due to an end that is ``spread`` over some length."""

    x: float
    uncertainty: float
    spread: float = 0.0


class _Estimate(NamedTuple):
    """An end by one window, m: how far it may be off if polynomials of rising degree converge, and if they do not
    (``doubt``); ``slope`` of the polynomial there."""

    x: float
    uncertainty: float
    doubt: float
    slope: float


class _Root(NamedTuple):
    """Root ``x`` of a polynomial through so many ``points``, the ``highest`` of the values there, m, and its ``slope``
    there; the mean square ``scatter`` of the points about it, by which factor (``gain``) its root gives standard
    errors, and how far the slack moves it."""

    x: float
    points: int
    highest: float
    slope: float
    scatter: float
    gain: float
    moved: float


def noise(values: Array, x: Array) -> float:
    """Standard deviation of what is not smooth in ``values`` at ``x``, (n,) each: of the deviations from the line
    through both neighbours. What the curve bends from point to point is in it."""
    share = (x[1:-1] - x[:-2]) / (x[2:] - x[:-2])
    off = values[1:-1] - (1 - share) * values[:-2] - share * values[2:]
    return float(1.4826 * np.median(np.abs(off)) / np.sqrt(1.5))


def zone(values: Array, least: Array | float) -> tuple[int, int] | None:
    """First and last index of the points around the largest value that are more than ``least``; None if there are
    none."""
    peak = int(values.argmax())
    inside = values > np.maximum(least, ROUNDING * values[peak])
    if not inside[peak]:
        return None
    outside = np.flatnonzero(~inside)
    place = np.searchsorted(outside, peak)
    first = outside[place - 1] + 1 if place > 0 else 0
    last = outside[place] - 1 if place < len(outside) else len(values) - 1
    return int(first), int(last)


def right_end(
    x: Array, values: Array, last: int, first: int, *, cells: bool = False, slack: Array | None = None, least: float = 0
) -> End:
    """Where ``values`` vanish like a square root. Where they fade out instead, the end is known no better than the
    length over which they do.

    Parameters
    ----------
    x, values : (n,) arrays
        Points, ascending, and what vanishes.
    last, first : int
        Last and first point inside the zone.
    cells : bool
        Whether values are means over cells: the one that the end is in says something else.
    slack : (n,) array, optional
        By how much all values may be off together.
    least : float
        Values that are no more than noise.
    """
    end = _end(x, values, last, first, cells, np.zeros_like(values) if slack is None else slack, least)
    mean = float(np.trapezoid(values[first : last + 1], x[first : last + 1])) / max(x[last] - x[first], 1e-300)
    risen = x[first + np.flatnonzero(values[first : last + 1] >= _RISEN * mean)[-1]]
    faded = end.x - risen
    return End(end.x, faded, faded) if faded > _RISE * (x[last] - x[first]) else end


def _end(x: Array, values: Array, last: int, first: int, cells: bool, slack: Array, least: float) -> End:
    """The end and its uncertainty, by polynomials through the squares of the values."""
    spacing = x[last] - x[max(last - 1, 0)]
    beyond = x[last + 1] if last + 1 < len(x) else x[last] + 2 * spacing
    outermost = max(x[-1], beyond) + (beyond - x[last]) / 2
    reach = min(last - int(_PART * (last - first)), max(last - _FEW, first))
    levels: list[list[list[_Root | None]]] = []
    for skipped in reversed(_SKIPPED):
        at = last - int(cells) - skipped
        counts = [count for count in _POINTS if at - count + 1 >= reach and _NEAREST * count >= skipped]
        windows = [at - np.arange(0, count, -(-count // _MANY))[::-1] for count in counts]
        levels.append([_roots(x[w], values[w], slack[w], x[at] - spacing, outermost) for w in windows])
    every = [root for level in levels for roots in level for root in roots if root]
    # of the highest degree: what lower ones leave out is the curve's bend, too
    close = [roots[-1] for level in levels[-_NEAR:] for roots in level if roots]
    few = [root.scatter for root in close if root and root.points <= _FEW]
    floor = float(np.median(few)) if few else 0.0
    told = [root for root in every if root.points > _FEW and root.highest > _ABOVE * least]
    slope = float(np.median([abs(root.slope) for root in told])) if told else np.inf
    hidden, steepest = least**2 / slope, _STEEP * slope
    every_level = [[end for roots in level for end in _estimates(roots, floor, steepest)] for level in levels]
    found = _agreeing(every_level)
    # over three points before the last a square root falls to half; what falls by more fades out
    fades = last - first >= _FEW and values[last - 1] < _FADES * values[last - 4]
    apart = 0.0
    if len(found) < len([level for level in every_level if level]) and not fades:
        # from afar a kink may mislead: the end is where the points have it
        within = [end for level in every_level[-_NEAR:] for end in level if x[last] <= end.x <= beyond]
        if within:
            nearest = min(within, key=lambda end: end.uncertainty)
            apart = abs(nearest.x - min(found, key=lambda end: end.uncertainty).x) if found else 0.0
            found = [nearest]
    if not found:
        return End(float(x[last] + beyond) / 2, float(x[last] - x[first] if fades else (beyond - x[last]) / 2))
    outside = [max(end.x - beyond - least**2 / abs(end.slope), 0.0) for end in found]  # noise hides as much of the zone
    off, best = min(zip(outside, found, strict=True), key=lambda pair: np.hypot(pair[0], pair[1].uncertainty))
    spread = _SPREAD * max(x[last] - cells * spacing - best.x, off, 0.0)
    drift = max(abs(end.x - best.x) for end in found if end.uncertainty <= _LEVEL * best.uncertainty)
    own = float(np.linalg.norm((_SAFE * best.uncertainty, _SPREAD * apart, drift)))
    if x[last] <= best.x <= beyond and not fades:  # the points are on either side of it, but for what noise hides
        own = min(own, beyond - x[last] + hidden)
    return End(best.x, float(np.linalg.norm((own, spread, _CELL * cells * spacing))), spread)


def left_end(
    x: Array, values: Array, first: int, last: int, *, cells: bool = False, slack: Array | None = None, least: float = 0
) -> End:
    """Likewise on the left: :func:`right_end` of the mirror image."""
    count, slack = len(x) - 1, None if slack is None else slack[::-1]
    end = right_end(-x[::-1], values[::-1], count - first, count - last, cells=cells, slack=slack, least=least)
    return end._replace(x=-end.x)


def _agreeing(levels: list[list[_Estimate]]) -> list[_Estimate]:
    """The best of each level, from afar to the end, as long as each agrees with those before."""
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
    """Ends from polynomials of neighbouring degrees. The mean square of the noise is no less than ``floor``; so much of
    y^2 is noise. Slopes beyond the ``steepest`` are due to it."""
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


def _roots(x: Array, y: Array, slack: Array, near: float, far: float) -> list[_Root | None]:
    """Roots between ``near`` and ``far`` of the polynomials through y^2, by degree. y is equally uncertain everywhere,
    so y^2 is in proportion to y."""
    scale = x[-1] - x[0]
    t, size = (x - x[-1]) / scale, np.abs(y)
    weights = 1 / np.maximum(size, 0.03 * size.max())
    right = np.column_stack([y * size, 2 * size * slack]) * weights[:, None]
    found: list[_Root | None] = []
    for degree in range(1, min(3, len(x) - 2) + 1):
        A = np.vander(t, degree + 1) * weights[:, None]
        Q, R = np.linalg.qr(A)
        if np.abs(np.diag(R)).min() <= 1e-13 * np.abs(R).max():
            return found
        inverse = np.linalg.inv(R)
        solution, shift = (inverse @ (Q.T @ right)).T
        roots = np.roots(solution)
        roots = roots[np.abs(roots.imag) < 1e-12].real
        roots = roots[(roots > (near - x[-1]) / scale) & (roots < (far - x[-1]) / scale)]
        slope = 0.0
        if len(roots):
            root = float(roots[np.abs(roots).argmin()])
            slope = float(np.polyval(np.polyder(solution), root))
        if not slope:
            found.append(None)
            continue
        residual, freedom = A @ solution - right[:, 0], len(x) - degree - 1
        scatter = float(residual @ residual) / freedom + (1e-12 * float(size.max())) ** 2  # rounding leaves some
        powers, per = root ** np.arange(degree, -1, -1), scale / abs(slope)
        few = 1 + 2 / freedom  # degrees of freedom, which may show too little scatter
        gain, moved = few * per * np.linalg.norm(powers @ inverse), per * abs(powers @ shift)
        found.append(
            _Root(x[-1] + root * scale, len(x), float(size.max()), slope / scale, scatter, float(gain), float(moved))
        )
    return found
