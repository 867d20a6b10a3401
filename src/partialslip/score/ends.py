"""Where zones end, below the spacing of the points, from tractions that may be coarse and noisy.

What vanishes at an end, p at the ends of the contact and 2 f p - |dq| at those of the stick zone, does so like a square
root: its square is smooth, and its root is the end. Polynomials of two degrees through more and fewer points nearby
each give one; they differ by what the curve bends, and scatter with the noise. The one that is known best is taken.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from partialslip.result import Array

_POINTS = (4, 5, 6, 8, 11, 16, 24, 36, 54, 80)
_SKIPPED = (0, 1, 2)  # nearest to the end, where codes with a mesh have their largest errors
NOISE = 4.0  # times the standard deviation, below which a value is no more than noise
_ROUNDING = 1e-9


class End(NamedTuple):
    """A place, m, and how far it may be off."""

    x: float
    uncertainty: float


def noise(values: Array, x: Array) -> float:
    """Standard deviation of what is not smooth in ``values`` at ``x``, (n,) each: of the deviations from the line
    through both neighbours. What the curve bends from point to point is in it."""
    share = (x[1:-1] - x[:-2]) / (x[2:] - x[:-2])
    off = values[1:-1] - (1 - share) * values[:-2] - share * values[2:]
    return float(1.4826 * np.median(np.abs(off)) / np.sqrt(1.5))


def zone(values: Array, x: Array) -> tuple[int, int] | None:
    """First and last index of the points around the largest value that are more than noise; None if there are none."""
    peak = int(values.argmax())
    inside = values > max(NOISE * noise(values, x), _ROUNDING * values[peak])
    if not inside[peak]:
        return None
    outside = np.flatnonzero(~inside)
    place = np.searchsorted(outside, peak)
    first = outside[place - 1] + 1 if place > 0 else 0
    last = outside[place] - 1 if place < len(outside) else len(x) - 1
    return int(first), int(last)


def right_end(x: Array, values: Array, last: int, first: int, skip: int = 0) -> End:
    """Where ``values`` vanish like a square root.

    Parameters
    ----------
    x, values : (n,) arrays
        Points, ascending, and what vanishes.
    last, first : int
        Last and first point inside the zone.
    skip : int
        How many points next to the end are not looked at in any case: a mean over a cell that the end is in says
        something else.
    """
    spacing = x[last] - x[max(last - 1, 0)]
    beyond = x[last + 1] if last + 1 < len(x) else x[last] + 2 * spacing
    near, far = x[last] - spacing, beyond + (beyond - x[last]) / 2
    candidates = []
    for at in (last - skip - skipped for skipped in _SKIPPED):
        for count in _POINTS:
            window = slice(at - count + 1, at + 1)
            if window.start >= first:
                candidates += _fits(x[window], values[window], near, far)
    if candidates:
        return min(candidates, key=lambda end: end.uncertainty)
    return End(float(x[last] + beyond) / 2, float(beyond - x[last]) / 2)


def left_end(x: Array, values: Array, first: int, last: int, skip: int = 0) -> End:
    """Likewise on the left: :func:`right_end` of the mirror image."""
    end = right_end(-x[::-1], values[::-1], len(x) - 1 - first, len(x) - 1 - last, skip)
    return End(-end.x, end.uncertainty)


def _fits(x: Array, y: Array, near: float, far: float) -> list[End]:
    """Ends by polynomials of neighbouring degrees through y^2."""
    found = []
    roots = [_root(x, y, degree, near, far) for degree in (1, 2, 3) if degree + 2 <= len(x)]
    for lower, higher in pairwise(roots):
        if lower and higher:
            apart = abs(lower.x - higher.x)
            found.append(End(higher.x, float(np.hypot(higher.uncertainty, apart))))
    return found


def _root(x: Array, y: Array, degree: int, near: float, far: float) -> End | None:
    """Root of the polynomial through y^2, and its standard error. y is equally uncertain everywhere, so y^2 is in
    proportion to y."""
    scale = x[-1] - x[0]
    t = (x - x[-1]) / scale
    weights = 1 / np.maximum(np.abs(y), 0.03 * np.abs(y).max())
    A = np.vander(t, degree + 1)
    solution, _, rank, _ = np.linalg.lstsq(A * weights[:, None], y * np.abs(y) * weights, rcond=None)
    if rank <= degree:
        return None
    roots = np.roots(solution)
    roots = roots[np.abs(roots.imag) < 1e-12].real * scale + x[-1]
    roots = roots[(roots > near) & (roots < far)]
    if len(roots) == 0:
        return None
    root = float(roots[np.abs(roots - x[-1]).argmin()])
    at = (root - x[-1]) / scale
    slope = float(np.polyval(np.polyder(solution), at))
    residual = (A @ solution - y * np.abs(y)) * weights
    freedom = len(x) - degree - 1
    # mean square of the residual, but not by luck less than what rounding leaves
    variance = max(float(residual @ residual) / freedom, (1e-12 * float(np.abs(y).max())) ** 2)
    powers = at ** np.arange(degree, -1, -1)
    covariance = np.linalg.inv((A * weights[:, None]).T @ (A * weights[:, None])) * variance
    error = float(np.sqrt(powers @ covariance @ powers))
    return End(root, scale * error / abs(slope)) if slope else None
