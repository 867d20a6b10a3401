"""The change of shear traction over a steady cycle, scaled as in :mod:`partialslip.halfplane.shape`."""

import math

import numpy as np

from partialslip.arrays import Array, Mask
from partialslip.halfplane.shape import Shape
from partialslip.result import StickZone

_AT_ONCE = 2**22  # pairs of points in memory
# Places in a stick zone at which tractions are compared with the bound: few, and many where few leave little room
_FEW, _MANY, _CLOSE = np.cos(np.arange(1, 8) / 8 * np.pi), np.cos(np.arange(1, 64) / 64 * np.pi), 0.3
_ROUNDING = 1e-9
_ANGLES = 65  # at which changes of the sign of dq are looked for


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
        result[sticks] = _inside(y, zone, shape)
        if gf:
            result[sticks] -= gf / 8 * np.sqrt((zone.right - y) * (y - zone.left))
    return result


def within_bound(zones: StickZone[Array], shape: Shape, gf: Array) -> Mask:
    """Whether \\|dq\\| <= 2 f p at places in stick ``zones`` (k,) under changes of tension that vary as ``gf`` x. More
    places are looked at where little is left."""
    left = _room(zones, shape, gf, _FEW)
    close = np.flatnonzero(left < _CLOSE)
    if len(close):
        left[close] = _room(StickZone(*(each[close] for each in zones)), shape, gf[close], _MANY)
    result: Mask = left > -_ROUNDING
    return result


def _room(zones: StickZone[Array], shape: Shape, gf: Array, places: Array) -> Array:
    """Least p - \\|dq\\|/2 in stick ``zones`` (k,), in f p0 sqrt((n-x)(x+m))/a, at ``places`` between -1 and 1."""
    centre, c, s = (np.asarray(each)[:, None, None] for each in zones)
    y = places[:, None]
    x, half = centre + c * y, c * np.sqrt((1 - y) * (1 + y))
    p, h = shape.pressure(x), -gf[:, None, None] / 8 * half
    for side, sign in ((1, 1), (-1, s)):
        # the integral of p(x) between the ends of the slip zone is an arc tangent, see _inside
        gap = np.maximum(1 - side * centre - c, 0.0)
        arc = 2 * np.arctan(np.sqrt(gap / (gap + 2 * c) * (1 + side * y) / (1 - side * y)))
        t, _, weights = shape.rule(zones.left + 1, zones.half_width, side)
        smooth = (shape.difference(t[:, None], x) * weights[:, None]).sum(axis=-1)[..., None]
        h = h + sign * (p * arc + side * half * smooth) / np.pi
    result: Array = ((p - np.abs(h)) / half).min(axis=(1, 2))
    return result


def mean_load_bound(zone: StickZone[float], shape: Shape, gf: float = 0.0) -> float:
    """Largest \\|Q_mean\\|/(f P) of a steady state: int (f p - \\|dq\\|/2) dx over the stick zone.

    Above it no locked-in mean traction fits under the friction bound and the contact ratchets (frictional Melan
    theorem: Klarbring, Ciavarella and Barber, 2007).
    """
    centre, c = zone.centre, zone.half_width
    edge = 1 + centre - c
    rules = {side: shape.rule(edge, c, side) for side in (1, -1)}
    slips = {side: (rule.weights * shape.pressure(rule.t), rule.theta) for side, rule in rules.items()}
    # f P, half of pi/2, less the slip zones: int p dt, dt = c sinh(theta) dtheta
    room = np.pi / 2 - sum(float(weights @ (c * np.sinh(theta))) for weights, theta in slips.values())
    if zone.s > 0 and gf <= 0:
        return (room - _resultant(np.pi, slips, zone, gf)) * 2 / np.pi

    def sign(angle: float) -> float:
        """Sign of dq/2 at e + c cos(``angle``): positive at n, where dq/2 = p, and negative at -m, where dq/2 = -p."""
        if angle in (0.0, math.pi):
            return 1.0 - (1.0 - zone.s) * (angle > 0)
        return float(half_range(np.array([centre + c * math.cos(angle)]), zone, shape, gf)[0])

    from scipy.optimize import brentq  # takes long to import

    if gf:
        angles = np.linspace(0.0, math.pi, _ANGLES).tolist()
        signs = [sign(angle) > 0 for angle in angles]
        turns = [brentq(sign, angles[i], angles[i + 1]) for i in range(len(angles) - 1) if signs[i] != signs[i + 1]]
        shares = np.diff([_resultant(angle, slips, zone, gf) for angle in (0.0, *turns, math.pi)])
        return float(room - np.abs(shares).sum()) * 2 / np.pi
    turn = brentq(sign, 0.0, math.pi)
    return (room - 2 * _resultant(turn, slips, zone) + _resultant(math.pi, slips, zone)) * 2 / np.pi


def _resultant(angle: float, slips: dict[int, tuple[Array, Array]], zone: StickZone[float], gf: float = 0.0) -> float:
    """int dq/2 dx from the stick zone's right end to x = e + c cos(``angle``), with the order of integration swapped:

        int sin^2(y)/(cosh(theta) -+ cos(y)) dy = y cosh(theta) +- sin(y) - 2 sinh(theta) arctan(tan(y/2) r),

    r = coth(theta/2) for traction in the right slip zone and tanh(theta/2) for the left one.
    """
    total = 0.0
    for side, (weights, theta) in slips.items():
        half = np.tanh(theta / 2)
        sine, cosine = math.sin(angle / 2), math.cos(angle / 2)
        arc = np.arctan2(sine, cosine * half) if side > 0 else np.arctan2(sine * half, cosine)
        kernel = angle * np.cosh(theta) + side * math.sin(angle) - 2 * np.sinh(theta) * arc
        total += (1 if side > 0 else zone.s) * float(weights @ kernel)
    by_slope = gf / 16 * zone.half_width**2 * (angle - math.sin(2 * angle) / 2)
    return total * zone.half_width / np.pi - by_slope


def _inside(x: Array, zone: StickZone[float], shape: Shape) -> Array:
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
    result: Array = (shape.pressure(x) * arcs + to_left * to_right * smooth) / np.pi
    return result
