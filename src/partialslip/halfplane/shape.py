"""Even pressures over [-1, 1] and the consistency conditions on the stick zone (paper, eqs. (17) and (18)).

Scaled: lengths by a, pressures by p0 = 2 P/(pi a) (for Hertz the largest pressure), so that every pressure has the
resultant pi/2; dQ and dsigma by the friction, as Qf = dQ/(2 f P) and sf = dsigma/(f p0).
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq
from scipy.special import elliprd, elliprf, elliprj

from partialslip.result import Array


class StickZone(NamedTuple):
    """Stick zone [-m, n] as fractions of a, by its centre (n - m)/2 and half-width (n + m)/2; ``s`` is +1 where
    both ends slip the same way (small tension) and -1 where they slip opposite ways (large tension)."""

    centre: float
    half_width: float
    s: int


LOG_TINY = -230.0  # stick zones narrower than 1e-100 a are not told apart


def root(function: Callable[[float], float], low: float, high: float) -> float:
    """Where a falling function changes sign; an end of the bracket where rounding, or a limit, leaves no change."""
    if function(high) >= 0:
        return high
    if function(low) <= 0:
        return low
    return float(brentq(function, low, high, xtol=1e-20, rtol=8.9e-16, maxiter=500))


class Rule(NamedTuple):
    """Quadrature over a slip zone: int g(t)/w(t) dt = sum weights g(t), w(t) = sqrt(|(t-n)(t+m)|)."""

    t: Array
    weights: Array


class Shape:
    """An even pressure, given by its values and the points where it is not smooth."""

    kinks: tuple[float, ...] = ()

    def pressure(self, x: Array) -> Array:
        """p/p0 at ``x``, zero outside [-1, 1]."""
        raise NotImplementedError

    def difference(self, t: Array, x: Array) -> Array:
        """(p(t) - p(x))/(t - x), for t in a slip zone and x in the stick zone."""
        step: Array = t - x
        result: Array = (self.pressure(t) - self.pressure(x)) / np.where(step == 0, 1.0, step)
        return result

    def loads(self, edge: float, c: float, s: int) -> tuple[float, float]:
        """The (sf, Qf) whose stick zone is [edge - 1, edge - 1 + 2c].

        The second condition is taken about the zone's centre, which leaves dQ/2 alone on its other side.
        """
        first = second = 0.0
        for side, sign in ((1, 1), (-1, -s)):
            t, weights = self.rule(edge, c, side)
            p = weights * self.pressure(t)
            first += sign * float(p.sum())
            second += sign * float(p @ (t - (edge + c - 1)))
        return 8 / math.pi * first, 2 / math.pi * second

    def touching(self, Qf: float) -> float:
        """Half-width of the zone that touches the contact's end under ``Qf``: where small tension turns large."""
        if Qf == 0:
            return 1.0
        return math.exp(root(lambda log_c: self.loads(0.0, math.exp(log_c), 1)[1] - Qf, LOG_TINY, 0.0))

    def small(self, Qf: float, sf: float) -> StickZone:
        """The zone under small tension: at a given half-width the tension fixes the place, and dQ falls as it grows."""

        def edge(c: float) -> float:
            return (1 - c) * root(lambda way: self.loads((1 - c) * way, c, 1)[0] - sf, 0.0, 1.0)

        centred = root(lambda c: self.loads(1 - c, c, 1)[1] - Qf, math.exp(LOG_TINY), 1.0)
        touching = self.touching(Qf)
        c = root(lambda c: self.loads(edge(c), c, 1)[1] - Qf, min(centred, touching), max(centred, touching))
        return StickZone(edge(c) + c - 1, c, 1)

    def rule(self, edge: float, c: float, side: int) -> Rule:
        """Points in the slip zone on the right (``side`` = 1) or left (-1).

        t = centre +- c cosh(theta) takes w away; what is left are a square root at the contact's end and kinks, to
        which the points of every piece crowd double exponentially.
        """
        centre = edge + c - 1
        # theta from its half-angle form: cosh(theta) - 1 = gap/c, where gap is the slip zone's width
        gap = (2 - edge - 2 * c) if side > 0 else edge

        def theta(width: float) -> float:
            return 2 * math.asinh(math.sqrt(max(width, 0.0) / (2 * c)))

        inner = [theta(side * kink - side * centre - c) for kink in self.kinks if side * kink > side * centre + c]
        end = theta(gap)
        ends = np.unique(np.clip([0.0, end - 3.0, *inner, end], 0.0, end))
        half = np.diff(ends)[:, None] / 2
        points = np.where(_NODES < 0, ends[:-1, None] + half * (1 + _NODES), ends[1:, None] - half * _TO_END)
        weights = half * _WEIGHTS
        t = centre + side * c * np.cosh(points)
        return Rule(np.clip(t, -1.0, 1.0).ravel(), weights.ravel())


class Hertz(Shape):
    """p/p0 = sqrt(1 - x^2), in the paper's closed and elliptic forms."""

    def pressure(self, x: Array) -> Array:
        result: Array = np.sqrt(np.maximum((1 - x) * (1 + x), 0.0))
        return result

    def difference(self, t: Array, x: Array) -> Array:
        return -(t + x) / (self.pressure(t) + self.pressure(x))

    def touching(self, Qf: float) -> float:
        return math.sqrt(1 - Qf)

    def small(self, Qf: float, sf: float) -> StickZone:
        return StickZone(-sf / 8, math.sqrt(1 - Qf), 1)

    def loads(self, edge: float, c: float, s: int) -> tuple[float, float]:
        """Paper, eqs. (21), (22) and (24)-(26). ``chi`` is the modulus. Carlson's forms take 1 - chi^2 =
        4 c/((1+m)(1+n)); all that is small with c or ``edge`` = 1 - m is formed without cancellation."""
        if s > 0 or edge == 0:
            return 8 * (1 - c - edge), (1 - c) * (1 + c)
        m, n, centre = 1 - edge, edge + 2 * c - 1, edge + c - 1
        root = math.sqrt((2 - edge) * (edge + 2 * c))  # sqrt((1+m)(1+n))
        complement = 4 * c / root**2
        phi, omega = -edge / (2 - edge), 1 - 2 * c / (2 - edge)  # (m-1)/(m+1), (1-n)/(1+m)

        K = elliprf(0.0, complement, 1.0)
        E = K - (1 - complement) / 3 * elliprd(0.0, complement, 1.0)
        Pi_phi = K + phi / 3 * elliprj(0.0, complement, 1.0, 2 / (2 - edge))
        Pi_omega = K + omega / 3 * elliprj(0.0, complement, 1.0, 2 * c / (2 - edge))

        cubic = n**2 - 2 * m * n / 3 + m**2 - 4 / 3
        first = (
            -2 * root * E
            + (2 * centre + 4) * (1 + m) / root * K
            + 4 * centre / root * Pi_phi
            - 4 * centre * c / root * Pi_omega
        )
        second = 1.5 * (
            -2 * centre * root * E
            - (1 + m) / root * ((n / 3 + 2) * m - (m**2 + n**2) / 2 - 2 * (1 + n) / 3) * K
            + cubic / root * Pi_phi
            - c * cubic / root * Pi_omega
        )
        return float(8 / math.pi * first), float(2 / math.pi * (second - centre * first))


class FlatRounded(Shape):
    """A flat of half-width ``flat`` (a fraction of a) with rounded edges (Ciavarella, Hills and Monno, 1998)."""

    def __init__(self, flat: float) -> None:
        self.flat, self.kinks = flat, (-flat, flat)
        self._angle = math.asin(flat)

    def pressure(self, x: Array) -> Array:
        flat, end = self.flat, self._angle
        x = np.minimum(np.abs(x), 1.0)
        angle = np.arcsin(x)
        apart = np.abs(np.sin(angle - end))
        logarithm = np.log(np.sin(angle + end) / np.where(apart == 0, 1.0, apart))
        # the two logarithms of the usual form, whose singularities at the flat's ends cancel, taken together
        rest = 2 * flat * np.log(np.sin((angle + end) / 2) / np.cos((angle - end) / 2))
        values = (math.pi - 2 * end) * np.cos(angle) + (x - flat) * logarithm + rest
        result: Array = np.where(x < 1, np.maximum(values, 0.0), 0.0) / (math.pi - 2 * end - math.sin(2 * end))
        return result


def _double_exponential(count: int) -> tuple[Array, Array, Array]:
    """Nodes in (-1, 1), their distances from 1, and weights of the tanh-sinh rule."""
    k = np.linspace(-3.2, 3.2, count)
    u = np.pi / 2 * np.sinh(k)
    weights = (k[1] - k[0]) * np.pi / 2 * np.cosh(k) / np.cosh(u) ** 2
    return np.tanh(u), 2 / (1 + np.exp(2 * u)), weights


_NODES, _TO_END, _WEIGHTS = _double_exponential(81)
