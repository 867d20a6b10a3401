"""Quadrature and interpolation of functions with square roots and logarithms at the ends of intervals."""

import math
from collections.abc import Callable

import numpy as np

from partialslip.arrays import Array
from partialslip.halfplane.shape import double_exponential

DEGREES = 40  # coefficients, and nodes, of an interpolant
_HALF_PI = math.pi / 2
_INNER, _TO_END, _WEIGHTS = double_exponential(81)
_FROM_LOW = np.where(_INNER < 0, _TO_END[::-1], 1 + _INNER)
_FROM_HIGH = np.where(_INNER < 0, 1 - _INNER, _TO_END)


def spans(low: Array, high: Array) -> tuple[Array, Array, Array]:
    """Tanh-sinh rule on intervals (k,): distances of the nodes from ``low`` and from ``high``, and weights, (k, nodes)
    each. The distances keep their digits."""
    half = ((high - low) / 2)[..., None]
    return _FROM_LOW * half, _FROM_HIGH * half, _WEIGHTS * half


def place(share: Array, rest: Array) -> tuple[Array, Array]:
    """s, and the slope d(share)/ds, at the ``share`` of an interval; ``rest`` = 1 - share.

    share = sin^2(pi/2 sin^2(pi/2 s)) is of the fourth order in s at both ends: roots and logarithms at the ends become
    smooth enough for polynomials in s.
    """
    inner = np.arctan2(np.sqrt(share), np.sqrt(rest)) / _HALF_PI
    outer = np.arctan2(np.sqrt(rest), np.sqrt(share)) / _HALF_PI
    s = np.arctan2(np.sqrt(inner), np.sqrt(outer)) / _HALF_PI
    return s, 4 * _HALF_PI**2 * np.sqrt(share * rest * inner * outer)


def shares(s: Array) -> tuple[Array, Array]:
    """Share of an interval at ``s``, and 1 - share; the inverse of :func:`place`."""
    inner = _HALF_PI * np.sin(_HALF_PI * s) ** 2
    return np.sin(inner) ** 2, np.cos(inner) ** 2


def powers(s: Array) -> Array:
    """Chebyshev polynomials on [0, 1] at ``s``, (..., DEGREES)."""
    return np.asarray(np.polynomial.chebyshev.chebvander(2 * s - 1, DEGREES - 1), dtype=np.float64)


NODES = (1 - np.cos(np.pi * (np.arange(DEGREES) + 0.5) / DEGREES)) / 2
SHARES, RESTS = shares(NODES)
_TO_COEFFICIENTS = powers(NODES).T * 2 / DEGREES
_TO_COEFFICIENTS[0] /= 2
_INTEGRALS = np.stack(  # coefficients of the integrals from s = 0 of the polynomials
    [np.polynomial.chebyshev.chebint(row, lbnd=-1) / 2 for row in np.eye(DEGREES)], axis=1
)


def integrals(s: Array) -> Array:
    """Integrals from 0 to ``s`` of the polynomials, (..., DEGREES)."""
    result: Array = (np.polynomial.chebyshev.chebvander(2 * s - 1, DEGREES) @ _INTEGRALS).reshape(*s.shape, DEGREES)
    return result


class Smooth:
    """Interpolant of a function on an interval from ``low`` to ``high``, which may have square roots and weaker
    singularities at both ends.

    Parameters
    ----------
    low, high : float
    function : callable
        ``function(from_low, from_high)``: values (n,) at points given by their distances from both ends.
    """

    def __init__(self, low: float, high: float, function: Callable[[Array, Array], Array]) -> None:
        self.low, self.high = low, high
        width = high - low
        self._coefficients = _TO_COEFFICIENTS @ function(width * SHARES, width * RESTS)

    def __call__(self, x: Array) -> Array:
        share = np.clip((x - self.low) / (self.high - self.low), 0.0, 1.0)
        result: Array = powers(place(share, 1 - share)[0]) @ self._coefficients
        return result

    @property
    def tail(self) -> float:
        """Size of the last coefficients: the error of the interpolant, about."""
        return float(np.abs(self._coefficients[-3:]).max())

    def __neg__(self) -> "Smooth":
        result = object.__new__(Smooth)
        result.low, result.high, result._coefficients = self.low, self.high, -self._coefficients
        return result
