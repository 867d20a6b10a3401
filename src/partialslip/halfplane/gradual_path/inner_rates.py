"""Rates of q in two stick intervals, (l, a) and (b, r), and panels of the ways of their ends. Scaled as in
:mod:`partialslip.halfplane.shape`."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from partialslip.tools.arrays import Array

L, A, B, R, Z = range(5)  # the four ends, and z0
PANEL_NODES = 20  # accuracy: nodes of a panel
PAST = 28  # accuracy: nodes of integrals over part of a panel, or over panels that are past
_LEAST = 1e-300  # accuracy: a distance that is not zero
_STILL = 1e-3  # accuracy: way below which an end hardly moves
_FALLS = 0.1  # cost: a Newton step over the one before
RATE = 1.6  # accuracy: logarithm by which the width of a vanishing interval falls in a panel


_ANGLES = np.pi * (np.arange(PANEL_NODES) + 0.5) / PANEL_NODES
_NODES = (1 - np.cos(_ANGLES)) / 2
TO_COEFFICIENTS = np.polynomial.chebyshev.chebvander(2 * _NODES - 1, PANEL_NODES - 1).T * 2 / PANEL_NODES
TO_COEFFICIENTS[0] /= 2
_BARYCENTRIC = (-1.0) ** np.arange(PANEL_NODES) * np.sin(_ANGLES)


def cardinal(s: Array) -> Array:
    """Polynomials that are 1 at one node each, (..., nodes)."""
    apart = np.asarray(s)[..., None] - _NODES
    result: Array = _BARYCENTRIC / np.where(apart == 0, _LEAST, apart)
    result /= result.sum(axis=-1, keepdims=True)
    return result


LAST = cardinal(np.array(1.0))
_CELLS = 1024  # accuracy: of a panel, in which b is sought by halving
_AT_CELLS = cardinal(np.arange(1, _CELLS) / _CELLS)


# integrals over a whole span, the trapezoidal rule in log(share/rest): singularities beyond its ends do no harm
_U = np.arange(-40.0, 40.1, 0.5)
SHARES, RESTS = 1 / (1 + np.exp(-_U)), 1 / (1 + np.exp(_U))
WEIGHTS = 0.5 * SHARES * RESTS


class Map(NamedTuple):
    """How lambda runs in a panel of unit length: ``share`` of s, s of a share and its ``rest``; nodes and weights of
    integrals up to the collocation points, singular there like a square root, and polynomials there, less those at the
    collocation points; ``whole``: polynomials at the nodes of integrals over the panel; ``past``, ``past_weights``:
    those of integrals that are smooth in s."""

    share: Callable[[Array], Array]
    place: Callable[[Array, Array], Array]
    own: Array
    own_weights: Array
    own_cardinal: Array
    own_change: Array
    shares: Array
    whole: Array
    past: Array
    past_weights: Array


def _map(
    share: Callable[[Array], Array], slope: Callable[[Array], Array], place: Callable[[Array, Array], Array]
) -> Map:
    y, weights = np.polynomial.legendre.leggauss(PAST)
    y, weights = (1 + y) / 2, weights / 2
    own = _NODES[:, None] * (1 - y**2)
    return Map(
        share,
        place,
        own,
        weights * 2 * _NODES[:, None] * y * slope(own),
        cardinal(own),
        cardinal(own) - np.eye(PANEL_NODES)[:, None],
        share(_NODES),
        cardinal(place(SHARES, RESTS)),
        cardinal(y),
        weights * slope(y),
    )


SINE = _map(  # square roots at both ends of the panel
    lambda s: np.sin(np.pi / 2 * s) ** 2,
    lambda s: np.pi / 2 * np.sin(np.pi * s),
    lambda share, rest: 2 / np.pi * np.arctan2(np.sqrt(share), np.sqrt(rest)),
)
_LEFT = float(np.exp(-2 * RATE))
DECAY = _map(  # an interval vanishes: its width falls like the square root of what is left
    lambda s: -np.expm1(-2 * RATE * s) / (1 - _LEFT),
    lambda s: 2 * RATE * np.exp(-2 * RATE * s) / (1 - _LEFT),
    lambda share, rest: -np.log(_LEFT + (1 - _LEFT) * rest) / (2 * RATE) + 0 * share,
)

_G, _WG = np.polynomial.legendre.leggauss(40)
_G, _WG = (1 + _G) / 2, _WG / 2


def other_root(ends: Array, zero: float, least: float) -> float:
    """z1 of the ``ends`` (4,) and z0."""
    return float(ends.sum() / 2 - least - zero)


def root(ends: Array, least: float) -> Array:
    """z0 (n,) of the ``ends`` (4, n); ``least`` is c*."""
    left, low, high, right = ends
    width, gap = (low - left)[:, None], (high - low)[:, None]
    most = np.arcsinh(np.sqrt(gap / width))
    angle, rest = most * (1 - _G**2), most * _G**2
    to_low, to_high = width * np.sinh(angle) ** 2, width * np.sinh(rest) * np.sinh(angle + most)
    weights = _WG * 2 * _G * most / np.sqrt(to_high * ((right - high)[:, None] + to_high))
    first, second, third = (weights * to_low**k for k in range(3))
    total = (left + low + high + right) / 2 - least - 2 * low  # (z0 - a) + (z1 - a)
    product = (total * second.sum(axis=1) - third.sum(axis=1)) / first.sum(axis=1)
    return low + total / 2 + np.sqrt(np.maximum(total**2 / 4 - product, 0.0))


def taken(ends: Array, least: float) -> Array:
    """b (n,) at which z0 = b, near that of ``ends`` (4, n)."""
    left, low, high, right = ends
    slope, before = np.zeros(0), np.inf
    for _ in range(40):
        gap = np.minimum(high - low, right - high)
        at = root(np.array([left, low, high, right]), least) - high
        if not slope.size:
            more = 1e-5 * gap
            slope = (root(np.array([left, low, high + more, right]), least) - high - more - at) / more
        step = np.clip(-at / slope, -0.5 * gap, 0.5 * gap)
        high = high + step
        largest = np.abs(step).max()
        if not largest > 1e-15 + 1e-14 * gap.min():
            break
        if largest > _FALLS * before:  # the slope has changed
            slope = np.zeros(0)
        before = largest
    return high


Event = tuple[str | int, float]


class Panel(NamedTuple):
    """Ways over a span ``length`` of lambda, from ``progress`` on: ``begin`` (5,) plus ``offsets`` (5, nodes).
    ``event``: an end and its place, or "width" or "gap" and its size, at the end of the panel. ``takes``: b takes
    points back; ``turns``: b reverses at the end."""

    progress: float
    length: float
    begin: Array
    offsets: Array
    by: Map
    takes: bool
    kink: bool
    event: Event | None = None
    turns: bool = False

    @property
    def end(self) -> Array:
        """Ends and z0 at the end of the panel."""
        return self.begin + self.offsets @ LAST

    def at(self, s: Array) -> Array:
        """Offsets (5, ...) at ``s``."""
        return (self.offsets @ cardinal(np.ravel(s)).T).reshape(5, *np.shape(s))

    @property
    def tail(self) -> float:
        """Last coefficients of the ways, relative to the largest ones."""
        found = np.abs(self.offsets @ TO_COEFFICIENTS.T)
        return float((found[:, -2:].max(axis=1) / (_STILL + found[:, 1:].max(axis=1))).max())

    def cut(self, length: float, by: Map) -> Array:
        """Offsets (5, nodes) over the first ``length`` of the panel."""
        share = np.clip(by.shares * length / self.length, 0, 1)
        return self.at(self.by.place(share, 1 - share))

    def speeds(self, s: Array) -> Array:
        """Mean speeds (5,) of the ends and z0 between two places."""
        at, share = self.at(s), self.by.share(s)
        return (at[:, 1] - at[:, 0]) / (self.length * (share[1] - share[0]))

    def place(self, x: Array) -> Array:
        """s (n,) at which b, which moves to the left, is at ``x``."""
        way, offsets = self.offsets[B], x - self.begin[B]
        cells = np.searchsorted(-np.minimum.accumulate(_AT_CELLS @ way), -offsets)
        low, high = cells / _CELLS, (cells + 1) / _CELLS
        for _ in range(42):
            middle = (low + high) / 2
            later = cardinal(middle) @ way > offsets
            low, high = np.where(later, middle, low), np.where(later, high, middle)
        return (low + high) / 2


def ways(panels: list[Panel], progress: Array) -> Array:
    """Ends and z0 (5, k) at ``progress`` (k,)."""
    begins = np.array([panel.progress for panel in panels])
    number = np.maximum(np.searchsorted(begins, progress) - 1, 0)
    result = np.empty((5, len(progress)))
    for each in np.unique(number):
        panel, here = panels[each], number == each
        share = np.clip((progress[here] - panel.progress) / panel.length, 0.0, 1.0)
        result[:, here] = panel.begin[:, None] + panel.at(panel.by.place(share, 1 - share))
    return result
