"""The change of shear traction over a steady cycle, scaled as in :mod:`partialslip.halfplane.shape`."""

import math

import numpy as np

from partialslip.arrays import Array
from partialslip.halfplane.shape import Shape
from partialslip.result import StickZone

_AT_ONCE = 2**22  # pairs of points in memory


def half_range(x: Array, zone: StickZone[float], shape: Shape) -> Array:
    """dq/(2 f p0) at ``x`` (fractions of a), for positive dQ and dsigma; zero outside [-1, 1].

    In the slip zones dq/2 = p on the right and s p on the left. In the stick zone, from the bounded inversion of
    the paper's eq. (14),

        dq/2 = sqrt((n-x)(x+m))/pi [ int_n^1 p(t)/(w(t)(t-x)) dt + s int_{-1}^{-m} p(t)/(w(t)(x-t)) dt ],

    w(t) = sqrt((t-n)(t+m)). For small tension and Hertz it is p - sqrt((n-x)(x+m)).
    """
    p = shape.pressure(x)
    result = np.where(x < zone.centre, zone.s * p, p)
    sticks = (x > zone.left) & (x < zone.right)
    if sticks.any():
        result[sticks] = _inside(x[sticks], zone, shape)
    return result


def mean_load_bound(zone: StickZone[float], shape: Shape) -> float:
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
    if zone.s > 0:
        return (room - _resultant(np.pi, slips, zone)) * 2 / np.pi

    def sign(angle: float) -> float:
        """Sign of dq/2 at e + c cos(``angle``): positive at n, where dq/2 = p, and negative at -m, where dq/2 = -p."""
        if angle in (0.0, math.pi):
            return 1.0 - 2.0 * (angle > 0)
        return float(half_range(np.array([centre + c * math.cos(angle)]), zone, shape)[0])

    from scipy.optimize import brentq  # takes long to import

    turn = brentq(sign, 0.0, math.pi)
    return (room - 2 * _resultant(turn, slips, zone) + _resultant(math.pi, slips, zone)) * 2 / np.pi


def _resultant(angle: float, slips: dict[int, tuple[Array, Array]], zone: StickZone[float]) -> float:
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
    return total * zone.half_width / np.pi


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
