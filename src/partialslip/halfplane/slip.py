"""Slip over half a steady cycle and the dissipated energy; scaled as in :mod:`partialslip.halfplane.shape`.

Slip is the displacement along +x, from load point 1 to 2, of the lower body, which exerts q on the upper one, relative
to the upper body. All functions are for positive dQ and dsigma.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from partialslip.halfplane.shape import Rule, Shape, places_between, rule_between
from partialslip.result import StickZone
from partialslip.tools.arrays import Array

# accuracy: Gauss points in a slip zone, and in each of its pieces: of the work, and of the rule that tells its error
_NODES, _FEWEST = (32, 21), (6, 4)
_HARDLY = 1e-9  # accuracy: width of a slip zone, in a, that is rounding
_ROUNDING = 1e-9  # accuracy: of slip, in the largest
_TINY = 1e-300  # accuracy: length that is not zero


class Worn(NamedTuple):
    """Slip over half a cycle: points ``x`` (k,), ascending, net ``slip`` there (k,), and the energy that a whole cycle
    dissipates, ``dissipated``, with the ``error`` of its quadrature; in A f p0 a and A (f p0 a)^2."""

    x: Array
    slip: Array
    dissipated: float
    error: float

    def turned(self, mirror: int, turn: int) -> "Worn":
        """Slip mirrored in x (``mirror`` -1) and with opposite sign (``turn`` -1)."""
        return self._replace(x=mirror * self.x[::mirror], slip=turn * self.slip[::mirror])


def density(x: Array, zone: StickZone[float], shape: Shape, gf: float = 0.0) -> Array:
    """Slope of the slip at ``x``, the paper's density of glide dislocations, in A f p0; zero outside the slip zones.

    In the slip zone on the side tau = +-1,

        D(y) = 2 tau w(y)/pi [ PV int_n^1 p/(w(t)(y-t)) dt - s PV int_{-1}^{-m} p/(w(t)(y-t)) dt ],

    w(t) = sqrt(|(t-n)(t+m)|). The integral of p(y) is a logarithm; (p(t) - p(y))/(y - t) has no pole. A change of
    tension that varies as ``gf`` x adds tau w(y) gf/4.
    """
    result = np.zeros_like(x)
    edge = 1 + zone.centre - zone.half_width
    rules = {side: shape.rule(edge, zone.half_width, side) for side in (1, -1)}
    for side, sign in ((1, 1), (-1, zone.s)):
        here = _slips(x, zone, side)
        y = x[here]
        beyond = np.maximum(side * (y - zone.centre) - zone.half_width, 0.0)
        width = 1 - side * zone.centre - zone.half_width
        w = np.sqrt(beyond * (beyond + 2 * zone.half_width))
        # 2 artanh of the ratio of tanh(theta/2) at y and at the contact's end, without cancellation in narrow zones
        both = np.sqrt(beyond / (beyond + 2 * zone.half_width)) + np.sqrt(width / (width + 2 * zone.half_width))
        ratio = both**2 * (width + 2 * zone.half_width) * (beyond + 2 * zone.half_width)
        logarithm = np.log(ratio / (2 * zone.half_width)) - np.log(np.maximum(1 - side * y, _TINY))
        own, other = rules[side], rules[-side]
        smooth = shape.difference(own.t, y[:, None]) @ own.weights
        across = (shape.pressure(other.t) * other.weights / (y[:, None] - other.t)).sum(axis=-1)
        same = shape.pressure(y) * logarithm - side * w * smooth
        result[here] = side * 2 / np.pi * (sign * same - (zone.s if side > 0 else -1) * w * across)
        result[here] += side * w * gf / 4
    return result


def slip(x: Array, zone: StickZone[float], shape: Shape, gf: float = 0.0) -> Array:
    """Slip at ``x``, in A f p0 a; zero in the stick zone. The integral of :func:`density` from the stick zone's end,
    with the order of integration swapped."""
    result = np.zeros_like(x)
    c, edge = zone.half_width, 1 + zone.centre - zone.half_width
    for side, sign in ((1, 1), (-1, zone.s)):
        here = _slips(x, zone, side)
        y = x[here][:, None]
        if not len(y):
            continue
        eta = 2 * np.arcsinh(np.sqrt(np.maximum(side * (y - zone.centre) - c, 0.0) / (2 * c)))
        same, across = _kernels(eta)
        other = shape.rule(edge, c, -side)
        by_other = across(other) @ (other.weights * shape.pressure(other.t))
        # the kernel of the same side has a logarithm at eta: split the piece around eta
        ends = shape.pieces(edge, c, side)
        piece = np.clip(np.searchsorted(ends, eta, "left") - 1, 0, len(ends) - 2)
        own = rule_between(ends, edge, c, side)
        elsewhere = np.arange(len(own.t)) // (len(own.t) // (len(ends) - 1)) != piece
        around = rule_between(np.concatenate([ends[piece], eta, ends[piece + 1]], axis=-1), edge, c, side)
        by_own = np.where(elsewhere, same(own), 0.0) @ (own.weights * shape.pressure(own.t))
        by_own += (around.weights * shape.pressure(around.t) * same(around)).sum(axis=-1)
        result[here] = 2 / np.pi * c * (sign * by_own - (zone.s if side > 0 else 1) * by_other)
        result[here] += gf / 8 * c**2 * (np.sinh(2 * eta[:, 0]) / 2 - eta[:, 0])
    return result


def slips_on(zone: StickZone[float], shape: Shape, gf: float = 0.0) -> bool:
    """Whether all points beside a stick ``zone`` slip in the direction of their traction: at the sharp kinks of p, at
    places between them, and as close to the stick zone as the nearest kink inside it."""
    found = []
    for side, sign in ((1, 1), (-1, zone.s)):
        beyond = np.abs(side * (np.array(shape.sharp_kinks) - zone.centre) - zone.half_width) / zone.half_width
        width = 1 - side * zone.centre - zone.half_width
        if width <= _HARDLY:
            continue
        eta = places_between(np.arccosh(1 + beyond), 0.0, float(np.arccosh(1 + width / zone.half_width)))
        x = zone.centre + side * zone.half_width * np.cosh(eta)
        found.append(sign * slip(np.clip(x, -1.0, 1.0), zone, shape, gf))
    slips = np.concatenate([np.zeros(1), *found])
    return bool(slips.min() >= -_ROUNDING * slips.max())


def dissipation(
    zone: StickZone[float], shape: Shape, gf: float = 0.0, slip_at: Callable[[Array], Array] | None = None
) -> Worn:
    """Slip in the slip zones and at the contact's ends, by default :func:`slip`, and the energy dissipated in a whole
    cycle, 2 int f p |slip| dx, by a Gauss rule between all kinks of p; its error is the difference from a rule of fewer
    points."""
    rules = [_rule(zone, shape, *counts) for counts in zip(_NODES, _FEWEST, strict=True)]
    points = np.concatenate([[-1.0], *(x for x, _ in rules), [1.0]])
    slips = slip_at(points) if slip_at else slip(points, zone, shape, gf)
    worn = shape.pressure(points) * np.abs(slips)
    count = len(rules[0][0])
    work, other = 2 * rules[0][1] @ worn[1 : count + 1], 2 * rules[1][1] @ worn[count + 1 : -1]
    of = np.array([0, *range(1, count + 1), len(points) - 1])
    return Worn(points[of], slips[of], float(work), abs(float(work - other)))


def _rule(zone: StickZone[float], shape: Shape, count: int, fewest: int) -> tuple[Array, Array]:
    """Points in the slip zones, ascending, and weights: ``count`` a zone, but the ``fewest`` at least between kinks."""
    x, weights = [], []
    for low, high in ((-1.0, zone.left), (zone.right, 1.0)):
        ends = np.array([low, *(kink for kink in shape.kinks if low < kink < high), high])
        nodes, factors = np.polynomial.legendre.leggauss(max(count // (len(ends) - 1), fewest))
        angle, half = np.pi / 2 * (1 + nodes), np.diff(ends)[:, None] / 2
        x.append((ends[:-1, None] + half * (1 - np.cos(angle))).ravel())
        weights.append((half * np.pi / 2 * factors * np.sin(angle)).ravel())
    return np.concatenate(x), np.concatenate(weights)


def _slips(x: Array, zone: StickZone[float], side: int) -> npt.NDArray[np.bool_]:
    return (side * (x - zone.centre) > zone.half_width) & (np.abs(x) <= 1)


def _kernels(eta: Array) -> tuple[Callable[[Rule], Array], Callable[[Rule], Array]]:
    """int_0^eta sinh^2(y)/(cosh(y) -+ cosh(theta)) dy: slip at eta due to a unit of traction at theta, on the same and
    on the other side, together with the traction in the stick zone that the unit causes."""

    def same(rule: Rule) -> Array:
        theta = rule.theta
        apart = np.abs(np.sinh((eta - theta) / 2))
        logarithm = np.log(np.sinh((eta + theta) / 2) / np.where(apart == 0, 1.0, apart))
        return np.sinh(eta) + eta * np.cosh(theta) - np.sinh(theta) * logarithm

    def across(rule: Rule) -> Array:
        theta = rule.theta
        logarithm = np.log(np.cosh((eta + theta) / 2) / np.cosh((eta - theta) / 2))
        return np.sinh(eta) - eta * np.cosh(theta) + np.sinh(theta) * logarithm

    return same, across
