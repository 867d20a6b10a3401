"""The change of shear traction over a steady cycle, scaled as in :mod:`partialslip.halfplane.shape`."""

import functools

import numpy as np
import numpy.typing as npt

from partialslip.halfplane.panels import NODES, TO_COEFFICIENTS, clenshaw
from partialslip.halfplane.shape import Shape, places_between
from partialslip.result import StickZone
from partialslip.tools.arrays import Array, Mask


def adhered(x: npt.ArrayLike, a: float, dQ: float, dsigma: float) -> Array:
    """Change of shear traction without slip, Pa, at ``x`` (m, |x| < a, of any shape); singular at both ends.

    dq = (dQ/pi + x dsigma/4)/sqrt(a^2 - x^2): paper, eq. (1). ``a`` in m, ``dQ`` in N/m, ``dsigma`` in Pa.
    """
    x = np.asarray(x, float)
    return (dQ / np.pi + x * dsigma / 4) / np.sqrt((a - x) * (a + x))


_AT_ONCE = 2**22  # cost: pairs of points in memory
# Places in a stick zone at which tractions are compared with the bound: few, and many where few leave little room
_FEW, _MANY, _CLOSE = np.cos(np.arange(1, 8) / 8 * np.pi), np.cos(np.arange(1, 64) / 64 * np.pi), 0.3
_ROUNDING = 1e-9  # accuracy: distance, in a, at which a point is at an end
_INSIDE = 1e-12  # accuracy: distance from an end, in c, from which on the room is told from rounding
_PLENTY = 2**24  # cost: pairs of a point and a node of a slip zone, from which on tractions are interpolated
_HALVINGS = 40  # accuracy: panels towards either end of a stick zone, each half as wide as the one before


def half_range(x: Array, zone: StickZone[float], shape: Shape, gf: float = 0.0) -> Array:
    """dq/(2 f p0) at ``x`` (fractions of a), for positive dQ and dsigma; zero outside [-1, 1].

    In the slip zones dq/2 = p on the right and s p on the left. In the stick zone, from the bounded inversion of
    the paper's eq. (14),

        dq/2 = sqrt((n-x)(x+m))/pi [ int_n^1 p(t)/(w(t)(t-x)) dt + s int_{-1}^{-m} p(t)/(w(t)(x-t)) dt ],

    w(t) = sqrt((t-n)(t+m)). For small tension and Hertz it is p - sqrt((n-x)(x+m)). If the change of tension varies as
    ``gf`` x, it is less by gf/8 sqrt((n-x)(x+m)).
    """
    p = shape.pressure(x)
    result = np.where(x < zone.centre, zone.s * p, p)
    sticks = (x > zone.left) & (x < zone.right)
    if sticks.any():
        y = x[sticks]
        result[sticks] = _shear_in_stick(y, zone, shape)
        if gf:
            result[sticks] -= gf / 8 * np.sqrt((zone.right - y) * (y - zone.left))
    return result


def within_bound(zones: StickZone[Array], shape: Shape, gf: Array) -> Mask:
    """Whether \\|dq\\| <= 2 f p in stick ``zones`` (k,) under changes of tension that vary as ``gf`` x. More places are
    looked at where little is left, and all kinks of the bound, with places between them."""
    left = _room(zones, shape, gf, _FEW)
    close = np.flatnonzero(left < _CLOSE)
    if len(close):
        left[close] = _room(StickZone(*(each[close] for each in zones)), shape, gf[close], _MANY)
    held = left > -_ROUNDING
    if shape.strong_kinks:
        for number in np.flatnonzero(held).tolist():  # a zone takes as long as all its places together
            centre, c, s = (each[number] for each in zones)
            zone = StickZone(float(centre), float(c), int(s))
            held[number] = _room_at_kinks(zone, shape, float(gf[number])) > -_ROUNDING
    return held


def _room_at_kinks(zone: StickZone[float], shape: Shape, gf: float) -> float:
    """As :func:`_room`, at the kinks of the bound in a ``zone`` and between them; towards the ends of the zone as close
    as the nearest kinks beyond them: as far from an end as these dq changes its course."""
    y = (np.array(shape.strong_kinks) - zone.centre) / zone.half_width
    angle = places_between(np.arccos(np.clip(np.where(np.abs(y) > 1, np.copysign(2, y) - y, y), -1, 1)), 0.0, np.pi)
    y = np.cos(angle)
    y = y[np.abs(y) < 1 - _INSIDE]
    x = zone.centre + zone.half_width * y
    half = zone.half_width * np.sqrt((1 - y) * (1 + y))
    return float(((shape.pressure(x) - np.abs(half_range(x, zone, shape, gf))) / half).min())


def _room(zones: StickZone[Array], shape: Shape, gf: Array, places: Array) -> Array:
    """Least p - \\|dq\\|/2 in stick ``zones`` (k,), in f p0 sqrt((n-x)(x+m))/a, at ``places`` between -1 and 1."""
    p, h, half = inside(zones, np.broadcast_to(places, (len(gf), len(places))), shape, gf)
    return ((p - np.abs(h)) / half).min(axis=1)


def inside(zones: StickZone[Array], y: Array, shape: Shape, gf: Array) -> tuple[Array, Array, Array]:
    """p/p0, dq/(2 f p0) and sqrt((n-x)(x+m)) in stick ``zones`` (k,) at x = e + c ``y``, -1 < y < 1, (k, n) each; see
    :func:`half_range`."""
    centre, c, s = (np.asarray(each)[:, None, None] for each in zones)
    y = y[..., None]
    x, half = centre + c * y, c * np.sqrt((1 - y) * (1 + y))
    p, h = shape.pressure(x), -gf[:, None, None] / 8 * half
    for side, sign in ((1, 1), (-1, s)):
        # the integral of p(x) between the ends of the slip zone is an arc tangent, see _shear_in_stick
        gap = np.maximum(1 - side * centre - c, 0.0)
        arc = 2 * np.arctan(np.sqrt(gap / (gap + 2 * c) * (1 + side * y) / (1 - side * y)))
        t, _, weights = shape.rule(zones.left + 1, zones.half_width, side)
        smooth = (shape.difference(t[:, None], x) * weights[:, None]).sum(axis=-1)[..., None]
        h = h + sign * (p * arc + side * half * smooth) / np.pi
    return p[..., 0], h[..., 0], half[..., 0]


def _shear_in_stick(x: Array, zone: StickZone[float], shape: Shape) -> Array:
    """dq/(2 f p0) in the stick zone; of a great many points interpolated, as it is smooth there, whatever p is."""
    nodes = sum(len(shape.rule(1 + zone.centre - zone.half_width, zone.half_width, side).t) for side in (1, -1))
    if len(x) * nodes < _PLENTY:
        return _inverted(x, zone, shape)
    coefficients = _interpolant(zone, shape)
    beyond = np.minimum(x - zone.left, zone.right - x) / zone.half_width
    halvings = np.floor(-np.log2(np.clip(beyond, 1.5 * 2.0**-_HALVINGS, 0.75))).astype(int)  # panels 2^-(k+1) to 2^-k
    place = 4 * np.ldexp(beyond, halvings) - 3
    result = clenshaw(place, coefficients, halvings + _HALVINGS * (x > zone.centre))
    close = beyond < 2.0**-_HALVINGS
    result[close] = _inverted(x[close], zone, shape)
    return result


@functools.lru_cache(maxsize=8)
def _interpolant(zone: StickZone[float], shape: Shape) -> Array:
    """Chebyshev coefficients (degrees, panels) of dq/(2 f p0) on panels that are halved towards the left and then the
    right end of the stick zone: its singularities, in the slip zones, are at least a panel's width away."""
    beyond = zone.half_width * np.ldexp((NODES[:, None] + 3) / 4, -np.arange(_HALVINGS))
    x = np.concatenate([zone.left + beyond, zone.right - beyond], axis=1)
    coefficients: Array = TO_COEFFICIENTS @ _inverted(x.ravel(), zone, shape).reshape(x.shape)
    return coefficients


def _inverted(x: Array, zone: StickZone[float], shape: Shape) -> Array:
    """dq/(2 f p0) in the stick zone. The integrals of p(x) are arc tangents; (p(t) - p(x))/(t - x) has no pole."""
    centre, c = zone.centre, zone.half_width
    edge = 1 + centre - c
    to_left, to_right = np.sqrt(c + (x - centre)), np.sqrt(c - (x - centre))
    arcs, smooth = np.zeros_like(x), np.zeros_like(x)
    for side, sign, near, far in ((1, 1, to_right, to_left), (-1, zone.s, to_left, to_right)):
        gap = 2 - edge - 2 * c if side > 0 else edge
        tangent = np.sqrt(max(gap, 0.0) / (max(gap, 0.0) + 2 * c))  # tanh(theta/2) at the contact's end
        t, _, weights = shape.rule(edge, c, side)
        arcs += sign * 2 * np.arctan2(tangent * far, near)
        for part in np.array_split(np.arange(len(x)), len(x) * len(t) // _AT_ONCE + 1):
            smooth[part] += side * sign * (shape.difference(t, x[part, None]) @ weights)
    return (shape.pressure(x) * arcs + to_left * to_right * smooth) / np.pi
