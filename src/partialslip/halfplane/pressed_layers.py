"""Two equal layers on frictionless planes, pressed together: the half-planes that have the same ends of the contact,
and a series.

Lengths are scaled by a. Let p_h be the pressure of half-planes under the force P' that has these ends, and k the smooth
kernel of :mod:`partialslip.halfplane.layer`. The pressure of the layers is p_h + sqrt(1 - x^2) sum c_j U_j(x), and

    sum c_j T_(j+1)(x) + (1/pi) int p(t) k(x - t) dt = tilt/A

fixes the c_j, as (1/pi) PV int sqrt(1 - t^2) U_j(t)/(x - t) dt = T_(j+1)(x). The term with T_0 is the tilt by which the
half-planes are turned; it vanishes if the pressure is even. P' follows from P. A profile comes in with p_h alone.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.layer import Layer
from partialslip.halfplane.shape import Conditions, Shape, rule_over
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

if TYPE_CHECKING:
    from partialslip.halfplane.contact import Contact

COUNT = 48  # accuracy: terms of series
_ANGLES = np.pi * (np.arange(COUNT + 1) + 0.5) / (COUNT + 1)
NODES = np.cos(_ANGLES)
#: From values at the nodes to Chebyshev coefficients.
TO_SERIES = 2 / (COUNT + 1) * np.cos(np.arange(COUNT + 1)[:, None] * _ANGLES)
TO_SERIES[0] /= 2
_INNER = np.pi * np.arange(1, 2 * COUNT + 1) / (2 * COUNT + 1)
POINTS = np.cos(_INNER)
#: Forces at the points, (terms, points), of the tractions sqrt(1 - x^2) U_j(x): Gauss's rule.
FORCES = np.pi / (2 * COUNT + 1) * np.sin(_INNER) * np.sin(np.arange(1, COUNT + 1)[:, None] * _INNER)
_LOST = 1e-9  # limit: last terms of a series, relative to the largest
_STEPS = 60  # cost: of the secant rule
_SETTLED = 1e-14  # accuracy: of the force, relative
_ROUNDING = 1e-17  # accuracy: of a series


class Pressed(NamedTuple):
    """Half-planes that stand for layers, ``below``, the series that is to be added to their pressure (k,), Pa, the
    ``force`` of both, and the ``tilt`` that the series leaves."""

    below: "Contact"
    series: Array
    force: float
    tilt: float


class OnLayers(Shape):
    """Pressure ``share`` times that of half-planes, and a ``series`` of sqrt(1 - x^2) U_j(x); scaled as in
    :mod:`partialslip.halfplane.shape`."""

    def __init__(self, below: Shape, share: float, series: Array) -> None:
        self._below, self._share, self._rest = below, share, _Series(series)
        self.kinks, self.even = below.kinks, below.even

    @property
    def strong_kinks(self) -> tuple[float, ...]:
        return self._below.strong_kinks

    @property
    def convex(self) -> bool:
        return self._below.convex

    def pressure(self, x: Array) -> Array:
        return self._share * self._below.pressure(x) + self._rest.pressure(x)

    def difference(self, t: Array, x: Array) -> Array:
        return self._share * self._below.difference(t, x) + self._rest.difference(t, x)

    def conditions(self, edge: Array, c: Array, s: Array) -> Conditions:
        """Linear in the pressure: of half-planes as they are known best, and of a series without kinks."""
        both = self._below.conditions(edge, c, s), self._rest.conditions(edge, c, s)
        return Conditions(*(self._share * below + rest for below, rest in zip(*both, strict=True)))


class _Series(Shape):
    """Pressure by a ``series`` of sqrt(1 - x^2) U_j(x)."""

    def __init__(self, series: Array) -> None:
        self._series = trimmed(series)

    def pressure(self, x: Array) -> Array:
        return _ROUND.pressure(x) * second_kind(self._series, x)

    def difference(self, t: Array, x: Array) -> Array:
        step = t - x
        at_t, at_x = second_kind(self._series, t), second_kind(self._series, x)
        smooth = (at_t - at_x) / np.where(step == 0, np.inf, step)
        return _ROUND.difference(t, x) * at_t + _ROUND.pressure(x) * smooth


_ROUND = HertzShape()


def trimmed(series: Array) -> Array:
    """The ``series`` without its last terms, as far as they are rounding."""
    large = np.flatnonzero(np.abs(series) > _ROUNDING * np.abs(series).max(initial=0.0))
    return series[: large[-1] + 1] if len(large) else series[:1]


def second_kind(coefficients: Array, x: Array) -> Array:
    """sum c_j U_j(x) of the ``coefficients`` c (k,), of any shape of ``x``, by Clenshaw's rule."""
    one, two, twice = np.zeros_like(x), np.zeros_like(x), 2 * x
    for coefficient in coefficients[::-1].tolist():
        # two becomes twice * one + coefficient - two, in place
        np.subtract(twice * one + coefficient, two, out=two)
        one, two = two, one
    return one


def on_layers(layer: Layer, A: float, P: float, press: Callable[[float, float], "Contact"], even: bool) -> "Contact":
    """Contact of two layers under the force ``P``, N/m, that do not turn.

    Parameters
    ----------
    layer : Layer
    A : float
        Compliance of the pair, 1/Pa.
    P : float
    press : callable
        ``press(force, tilt)``: half-planes of the same profile.
    even : bool
        Whether the pressure is even.

    Raises
    ------
    InputError
        As ``press``, and if the layers are too thin for the series.
    """
    found = _even(layer, A, P, press) if even else _uneven(layer, A, P, press)
    below, series = found.below, found.series
    if np.abs(series[-4:]).max() > _LOST * (np.abs(series).max() + below.p0):
        raise _too_thin(layer, below)
    p0 = 2 * P / (math.pi * below.a)
    return replace(below, P=P, tilt=0.0, shape=OnLayers(below.shape, below.p0 / p0, series / p0), layer=layer)


def _even(layer: Layer, A: float, P: float, press: Callable[[float, float], "Contact"]) -> Pressed:
    """Secant steps of log P' over log P, whose slope is about 1."""
    force, before = P, None
    for _ in range(_STEPS):
        found = _loaded(layer, A, press(force, 0.0))
        off = math.log(found.force / P)
        if abs(off) < _SETTLED or (before and off == before[1]):
            return found
        slope = (off - before[1]) / math.log(force / before[0]) if before and force != before[0] else 1.0
        before, force = (force, off), force * math.exp(-off / slope)
    return found


def _uneven(layer: Layer, A: float, P: float, press: Callable[[float, float], "Contact"]) -> Pressed:
    """P' and the tilt of the half-planes, by Broyden's method; a tilt in units of the slope at the end of a contact."""
    from scipy.optimize import root  # takes long to import

    unit = A * press(P, 0.0).p0

    def off(unknown: Array) -> Array:
        found = _loaded(layer, A, press(P * math.exp(unknown[0]), unknown[1] * unit))
        return np.array([math.log(found.force / P), found.tilt / unit - unknown[1]])

    solved = root(off, np.zeros(2), method="hybr", options={"xtol": _SETTLED})
    log_force, tilt = solved.x.tolist()
    return _loaded(layer, A, press(P * math.exp(log_force), tilt * unit))


def _loaded(layer: Layer, A: float, below: "Contact") -> Pressed:
    """The series of layers that are pressed together where the half-planes ``below`` are."""
    x, weights = rule_over(np.unique([-1.0, *below.shape.kinks, 1.0]))
    at, points = below.a * NODES, below.a * POINTS
    given = TO_SERIES @ layer.smooth("normal", at, below.a * x, below.a * weights * below.p0 * below.shape.pressure(x))
    own = TO_SERIES @ layer.smooth("normal", at, points, below.a * FORCES).T
    series = np.asarray(np.linalg.solve(np.eye(COUNT) + own[1:], -given[1:]), float)
    tilt = A * float(given[0] + own[0] @ series)
    force = below.P + math.pi / 2 * below.a * float(series[0])
    if not force > 0:
        raise _too_thin(layer, below)
    return Pressed(below, series, force, tilt)


def _too_thin(layer: Layer, below: "Contact") -> InputError:
    times = f"{layer.height / below.a:.2g} times a"
    return InputError(f"bodies.upper.height, bodies.lower.height: must be larger, not {times}, for exact; use fem")
