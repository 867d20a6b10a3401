"""Room that gradual loads leave for a mean of Q; scaled as in :mod:`partialslip.halfplane.shape`."""

import math

import numpy as np

from partialslip.halfplane.gradual_path.half_cycle import HalfCycle
from partialslip.halfplane.gradual_path.phases import Retreating
from partialslip.halfplane.gradual_path.retreat import Zone
from partialslip.tools.arrays import Array

# accuracy: stages between which extremes are looked for, and places at which extremes are found
_STAGES, _PLACES = 24, 16
_PANELS = 64  # accuracy: of the zone that never slips; the integrand bends where another extreme is the largest
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(6)


def gradual_mean_load_bound(way: HalfCycle) -> float:
    """Room for a mean of Q, relative to f P: int (p - max \\|dq_t - dq/2\\|) dx over the points that never slip, dq_t
    being the change of q so far; 0 if there are no such points.

    dq_t falls while the rate of q is negative, which it is on the left of the distance c* from the middle of the stick
    zone, and rises from then on. So it has one extreme on the way, while the stick zone is wider than 2 c*. While a
    zone inside slips, it falls at all points that never slip, which are on the left.
    """
    low, high = way.stuck
    if not low < high:
        return 0.0
    ends = np.linspace(low, high, _PANELS + 1)
    half = np.diff(ends)[:, None] / 2
    x, weights = (ends[:-1, None] + half * (1 + _NODES)).ravel(), (half * _WEIGHTS).ravel()
    change = way.last.q(x) - way.start(x)
    largest = np.maximum(np.abs(change) / 2, np.abs(_lowest(way, x) - change / 2))
    return float(weights @ (way.start.shape.pressure(x) - largest)) * 2 / math.pi


def _lowest(way: HalfCycle, x: Array) -> Array:
    """Lowest change of q at points ``x`` (k,) that never slip, ascending."""
    first = next((phase for phase in way.phases if isinstance(phase, Retreating) and phase.retreat.sign < 0), None)
    if not first:
        return np.zeros_like(x)
    result: Array = first.first.q(x) - way.start(x)
    begin, end, least = first.first.zone, first.last.zone, way.loads.least
    low, high = max(x[0], end.centre - least), min(x[-1], begin.centre - least)
    if not low < high:
        return result
    shares = np.linspace(1, 0, _STAGES + 1)[1:-1] ** 2
    zones, more = [end], first.last.progress - first.first.progress
    for share in shares.tolist():
        zones.append(first.zone(first.first.progress + share * more, zones[-1]))
    zones.append(begin)
    progress = first.first.progress + more * np.array([1.0, *shares, 0.0])
    turning = np.array([zone.centre - least for zone in zones])  # the rate of q changes its sign there
    angle = np.pi * (np.arange(_PLACES) + 0.5) / _PLACES
    places = low + (high - low) * (1 - np.cos(angle)) / 2
    lowest = []
    for place, at in zip(places.tolist(), np.interp(places, turning, progress).tolist(), strict=True):
        # the error of an extreme is the square of that of its stage
        near = zones[int(np.argmin(np.abs(progress - at)))]
        zone: Zone = first.zone(at, near)
        lowest.append(first.retreat.inside(zone, np.array([place - zone.left]), np.array([zone.right - place]))[0])
    fitted = np.polynomial.Chebyshev.fit(places, np.array(lowest), _PLACES - 1, domain=[low, high])
    here = x < high
    result[here] += fitted(np.maximum(x[here], low))
    return result
