"""The change of shear traction over a steady cycle, scaled as in :mod:`partialslip.halfplane.shape`."""

import math

import numpy as np
from scipy.optimize import brentq

from partialslip.halfplane.shape import Shape, double_exponential
from partialslip.halfplane.steady import StickZone
from partialslip.result import Array

_AT_ONCE = 2**22  # pairs of points in memory
_NODES, _, _WEIGHTS = double_exponential(81)  # kinks of p are logarithms


def half_range(x: Array, zone: StickZone, shape: Shape) -> Array:
    """dq/(2 f p0) at ``x`` (fractions of a), for loads of positive dQ and dsigma; zero outside [-1, 1].

    In the slip zones dq/2 = p on the right and s p on the left. In the stick zone, from the bounded inversion of
    the paper's eq. (14),

        dq/2 = sqrt((n-x)(x+m))/pi [ int_n^1 p(t)/(w(t)(t-x)) dt + s int_{-1}^{-m} p(t)/(w(t)(x-t)) dt ],

    w(t) = sqrt((t-n)(t+m)). For small tension and Hertz it is p - sqrt((n-x)(x+m)).
    """
    m, n = zone.half_width - zone.centre, zone.half_width + zone.centre
    p = shape.pressure(x)
    result = np.where(x < zone.centre, zone.s * p, p)
    sticks = (x > -m) & (x < n)
    if sticks.any():
        result[sticks] = _inside(x[sticks], zone, shape)
    return result


def mean_load_bound(zone: StickZone, shape: Shape) -> float:
    """The largest \\|Q_mean\\|/(f P) that a steady state can hold: int (f p - \\|dq\\|/2) dx over the stick zone.

    Beyond it no locked-in mean traction fits under the friction bound and the contact ratchets (the frictional
    Melan argument: Klarbring, Ciavarella and Barber, 2007).
    """
    centre, c = zone.centre, zone.half_width
    kinks = [kink for kink in shape.kinks if abs(kink - centre) < c]
    breaks = [math.acos((kink - centre) / c) for kink in kinks]
    if zone.s < 0:  # dq changes sign on the way from n, where it is p > 0, to -m, where it is -p

        def sign(angle: float) -> float:
            if angle in (0.0, math.pi):
                return 1.0 - 2.0 * (angle > 0)
            return float(half_range(np.array([centre + c * math.cos(angle)]), zone, shape)[0])

        breaks.append(brentq(sign, 0.0, math.pi))
    ends = np.array([0.0, *sorted(breaks), math.pi])
    angle = (ends[1:] + ends[:-1])[:, None] / 2 + np.diff(ends)[:, None] / 2 * _NODES
    weights = np.diff(ends)[:, None] / 2 * _WEIGHTS * np.sin(angle)
    x = (centre + c * np.cos(angle)).ravel()
    room = shape.pressure(x) - np.abs(half_range(x, zone, shape))
    return float(room @ weights.ravel()) * c * 2 / np.pi  # f P is pi/2


def _inside(x: Array, zone: StickZone, shape: Shape) -> Array:
    """The stick zone's traction: p(t) is split into p(x), whose integrals are arc tangents, and p(t) - p(x), which
    the factor t - x divides without a pole."""
    centre, c = zone.centre, zone.half_width
    edge = 1 + centre - c
    to_left, to_right = np.sqrt(c + (x - centre)), np.sqrt(c - (x - centre))
    arcs, smooth = np.zeros_like(x), np.zeros_like(x)
    for side, sign, near, far in ((1, 1, to_right, to_left), (-1, zone.s, to_left, to_right)):
        gap = 2 - edge - 2 * c if side > 0 else edge
        tangent = np.sqrt(max(gap, 0.0) / (max(gap, 0.0) + 2 * c))  # tanh of half of theta's end
        t, _, weights = shape.rule(edge, c, side)
        arcs += sign * 2 * np.arctan2(tangent * far, near)
        for part in np.array_split(np.arange(len(x)), len(x) * len(t) // _AT_ONCE + 1):
            smooth[part] += side * sign * (shape.difference(t, x[part, None]) @ weights)
    result: Array = (shape.pressure(x) * arcs + to_left * to_right * smooth) / np.pi
    return result
