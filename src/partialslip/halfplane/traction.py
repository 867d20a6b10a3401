"""The change of shear traction over a steady cycle, Hertz contact.

Scaled as in :mod:`partialslip.halfplane.steady`: lengths by a, tractions by f p0.
"""

import numpy as np

from partialslip.halfplane.hertz import pressure
from partialslip.halfplane.steady import StickZone
from partialslip.result import Array

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(120)


def half_range(x: Array, zone: StickZone) -> Array:
    """dq/(2 f p0) at ``x`` (fractions of a), for loads of positive dQ and dsigma; zero outside [-1, 1].

    In the slip zones dq/2 = p on the right and s p on the left. In the stick zone, from the bounded inversion of
    the paper's eq. (14),

        dq/2 = sqrt((n-x)(x+m))/pi [ int_n^1 p(t)/(w(t)(t-x)) dt + s int_{-1}^{-m} p(t)/(w(t)(x-t)) dt ],

    w(t) = sqrt((t-n)(t+m)). For small tension it is p - sqrt((n-x)(x+m)).
    """
    m, n = zone.half_width - zone.centre, zone.half_width + zone.centre
    p = pressure(x, 1.0, 1.0)
    result = np.where(x < zone.centre, zone.s * p, p)
    sticks = (x > -m) & (x < n)
    if zone.s > 0:
        result[sticks] -= np.sqrt((n - x[sticks]) * (x[sticks] + m))
    elif sticks.any():
        result[sticks] = _opposing(x[sticks], zone)
    return result


def mean_load_bound(zone: StickZone) -> float:
    """The largest \\|Q_mean\\|/(f P) that a steady state can hold: int (f p - \\|dq\\|/2) dx over the stick zone.

    Beyond it no locked-in mean traction fits under the friction bound and the contact ratchets (the frictional
    Melan argument: Klarbring, Ciavarella and Barber, 2007).
    """
    angle = np.pi / 2 * (_NODES + 1)
    x = zone.centre + zone.half_width * np.cos(angle)
    room = pressure(x, 1.0, 1.0) - np.abs(half_range(x, zone))
    return float(np.sum(_WEIGHTS * room * np.sin(angle)) * zone.half_width)  # weights pi/2, and P = pi/2


def _opposing(x: Array, zone: StickZone) -> Array:
    """The stick zone's traction for large tension.

    p(t) is split into p(x), whose integrals are arc tangents, and p(t) - p(x), whose integrand is smooth: for
    Hertz (p(t) - p(x))/(t - x) = -(t + x)/(p(t) + p(x)).
    """
    centre, c = zone.centre, zone.half_width
    to_left, to_right = np.sqrt(x - centre + c), np.sqrt(centre + c - x)
    p = pressure(x, 1.0, 1.0)
    arcs, smooth = np.zeros_like(x), np.zeros_like(x)
    for side, sign, near, far in ((1, 1, to_right, to_left), (-1, zone.s, to_left, to_right)):
        # t = centre +- c cosh(theta) takes away w; theta = end (1 - u^2) the square root of p at the contact's end
        end = np.arccosh(max((1 - side * centre) / c, 1.0))
        u = (_NODES + 1) / 2
        t = centre + side * c * np.cosh(end * (1 - u**2))
        arcs += sign * 2 * np.arctan2(np.tanh(end / 2) * far, near)
        integrand = -side * (t + x[:, None]) / (pressure(t, 1.0, 1.0) + p[:, None])
        smooth += sign * integrand @ (_WEIGHTS * end * u)
    result: Array = (p * arcs + to_left * to_right * smooth) / np.pi
    return result
