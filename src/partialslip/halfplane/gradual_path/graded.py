"""Quadrature and interpolation of functions with square roots and logarithms at the ends of intervals."""

import math
from collections.abc import Callable

import numpy as np

from partialslip.halfplane.shape import double_exponential
from partialslip.tools.arrays import Array

_FEW, _LEAST = 200, 1e-300  # cost: points up to which the barycentric formula is faster; a distance that is not zero
DEGREES = 40  # accuracy: coefficients, and nodes, of an interpolant
_TAIL = 1e-10  # accuracy: size of the last coefficients above which an interval is halved
_HALVINGS = 20  # limit: of an interval
_NARROW = 1e-7  # accuracy: length of intervals that are not halved: rounding of coordinates shows in their interpolants
_HALF_PI = math.pi / 2
_INNER, _TO_END, _WEIGHTS = double_exponential(97, 3.85)
_FROM_LOW = np.where(_INNER < 0, _TO_END[::-1], 1 + _INNER)
_FROM_HIGH = np.where(_INNER < 0, 1 - _INNER, _TO_END)


def spans(low: Array, high: Array) -> tuple[Array, Array, Array]:
    """Tanh-sinh rule on intervals (k,): distances of the nodes from ``low`` and from ``high``, and weights, (k, nodes)
    each. The distances keep their digits."""
    half = ((high - low) / 2)[..., None]
    return _FROM_LOW * half, _FROM_HIGH * half, _WEIGHTS * half


def at_share(share: Array, rest: Array) -> tuple[Array, Array]:
    """s, and the slope d(share)/ds, at the ``share`` of an interval; ``rest`` = 1 - share.

    share = sin^2(pi/2 sin^2(pi/2 s)) is of the fourth order in s at both ends: roots and logarithms at the ends become
    smooth enough for polynomials in s.
    """
    inner = np.arctan2(np.sqrt(share), np.sqrt(rest)) / _HALF_PI
    outer = np.arctan2(np.sqrt(rest), np.sqrt(share)) / _HALF_PI
    s = np.arctan2(np.sqrt(inner), np.sqrt(outer)) / _HALF_PI
    return s, 4 * _HALF_PI**2 * np.sqrt(share * rest * inner * outer)


def share_at(s: Array) -> tuple[Array, Array]:
    """Share of an interval at ``s``, and 1 - share; the inverse of :func:`at_share`."""
    inner = _HALF_PI * np.sin(_HALF_PI * s) ** 2
    return np.sin(inner) ** 2, np.cos(inner) ** 2


def powers(s: Array) -> Array:
    """Chebyshev polynomials on [0, 1] at ``s``, (..., DEGREES)."""
    return np.moveaxis(_polynomials(s, DEGREES), 0, -1)


def _polynomials(s: Array, count: int) -> Array:
    """Chebyshev polynomials on [0, 1] at ``s``, (count, ...)."""
    found = np.empty((count, *np.shape(s)))
    twice = 4 * s - 2
    found[0], found[1] = 1.0, twice / 2
    for degree in range(2, count):
        found[degree] = twice * found[degree - 1] - found[degree - 2]
    return found


NODES = (1 - np.cos(np.pi * (np.arange(DEGREES) + 0.5) / DEGREES)) / 2
SHARES, RESTS = share_at(NODES)
_TO_COEFFICIENTS = powers(NODES).T * 2 / DEGREES
_TO_COEFFICIENTS[0] /= 2
_VALUES = powers(NODES).T  # at the nodes, of polynomials with given coefficients
_BARYCENTRIC = (-1.0) ** np.arange(DEGREES) * np.sin(np.pi * (np.arange(DEGREES) + 0.5) / DEGREES)
_INTEGRALS = np.stack(  # coefficients of the integrals from s = 0 of the polynomials
    [np.polynomial.chebyshev.chebint(row, lbnd=-1) / 2 for row in np.eye(DEGREES)], axis=1
)


def integrals(s: Array) -> Array:
    """Integrals from 0 to ``s`` of the polynomials, (..., DEGREES)."""
    return np.moveaxis(_polynomials(s, DEGREES + 1), 0, -1) @ _INTEGRALS


class Smooth:
    """Interpolant of a function on an interval from ``low`` to ``high``, which may have square roots and weaker
    singularities at both ends. The interval is halved until the coefficients have decayed.

    Parameters
    ----------
    low, high : float
    function : callable
        ``function(from_low, from_high)``: values (n,) at points given by their distances from both ends.
    """

    def __init__(self, low: float, high: float, function: Callable[[Array, Array], Array]) -> None:
        self.low, self.high, width = low, high, high - low
        ends, pieces = [0.0], list[Array]()

        def add(end: float, halvings: int) -> None:
            begin = ends[-1]
            length = end - begin
            found = _TO_COEFFICIENTS @ function(begin + length * SHARES, (width - end) + length * RESTS)
            if halvings and length > _NARROW and np.abs(found[-3:]).max() > _TAIL:
                add(begin + length / 2, halvings - 1)
                add(end, halvings - 1)
            else:
                ends.append(end)
                pieces.append(found)

        add(width, _HALVINGS)
        self._ends, self._pieces = np.array(ends), np.array(pieces)
        self._values = self._pieces @ _VALUES

    @property
    def cuts(self) -> Array:
        """Places at which the interpolant changes."""
        return self.low + self._ends[1:-1]

    def __call__(self, x: Array) -> Array:
        return self.near(x - self.low, self.high - x)

    def near(self, from_low: Array, from_high: Array) -> Array:
        """Values at distances from both ends, which keep their digits."""
        ends = self._ends
        number = np.searchsorted(ends[1:-1], from_low, side="right")
        length = ends[number + 1] - ends[number]
        share = np.clip((from_low - ends[number]) / length, 0.0, 1.0)
        rest = np.clip((from_high - (ends[-1] - ends[number + 1])) / length, 0.0, 1.0)
        s = at_share(share, rest)[0]
        result: Array
        if len(s) > _FEW:
            result = np.einsum("ji,ij->i", _polynomials(s, DEGREES), self._pieces[number])
            return result
        apart = s[:, None] - NODES
        shares = _BARYCENTRIC / np.where(apart == 0, _LEAST, apart)
        result = (shares * self._values[number]).sum(axis=-1) / shares.sum(axis=-1)
        return result

    def __neg__(self) -> "Smooth":
        result = object.__new__(Smooth)
        result.low, result.high, result._ends = self.low, self.high, self._ends
        result._pieces, result._values = -self._pieces, -self._values
        return result
