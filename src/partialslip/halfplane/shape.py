"""Pressures over [-1, 1] and the consistency conditions on the stick zone (paper, eqs. (17) and (18)).

Scaled: lengths by a, pressures by p0 = 2 P/(pi a) (for Hertz the largest pressure), so that every pressure has the
resultant pi/2; loads Qf = dQ/(2 f P), sf = dsigma/(f p0) and gf = a dslope/(f p0), the change of tension being
sf + gf x. A stick zone is given by ``edge`` = 1 - m, the width of
the left slip zone, and by the half-width ``c`` = (n + m)/2, which keep their digits when they are small; ``s`` is +1
where both ends slip the same way and -1 where they slip opposite ways. All arguments may be arrays.
"""

import functools
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

_THIN = 1e-12  # accuracy: width of a slip zone below which the stiffness of the stick zone's end is that at this width
_CHECKED = 1000  # limit: points at which a given pressure is checked
_EVEN = 1e-9  # limit: tolerance of p(x) - p(-x), relative to the largest p, of an even pressure
_BETWEEN = (1 - np.cos(np.pi * (np.arange(6) + 0.5) / 6)) / 2  # accuracy: places between two kinks
NARROW = 1e-5  # accuracy: half-width of a stick zone below which right - left cancels


class Rule(NamedTuple):
    """Quadrature over a slip zone: int g(t)/w(t) dt = sum of ``weights`` g(``t``), w(t) = sqrt(|(t-n)(t+m)|) =
    c sinh(``theta``); (..., points) each."""

    t: Array
    theta: Array
    weights: Array


class Conditions(NamedTuple):
    """Loads ``sf`` and ``Qf`` of a stick zone, and the stiffness of the zone's ends.

    ``right`` and ``left`` are c K, with f p - |dq|/2 = K sqrt(2 c r) at a small distance r inside the end (in f p0).
    ``skew`` is (right - left)/c; by quadrature 0 in stick zones narrower than ``NARROW``, where the difference cancels.
    """

    sf: Array
    Qf: Array
    right: Array
    left: Array
    skew: Array

    def sloped(self, gf: Array, edge: Array, c: Array, s: Array) -> "Conditions":
        """Conditions under a change of tension that varies as ``gf`` x: the traction in the stick zone is less by
        gf/8 sqrt((n-x)(x+m)) (docs/theory.md, section 4)."""
        return Conditions(
            self.sf - gf * (edge + c - 1),
            self.Qf - gf * c**2 / 8,
            self.right + c * gf / 8,
            self.left + s * c * gf / 8,
            self.skew + (1 - s) * gf / 8,
        )


class Shape:
    """Pressure, given by values and by ``kinks``, the points at which it is not smooth; ``even`` or not."""

    kinks: tuple[float, ...] = ()
    even = True

    @property
    def strong_kinks(self) -> tuple[float, ...]:
        """Kinks that quadrature of functions smoother than p must respect."""
        return self.kinks

    @property
    def sharp_kinks(self) -> tuple[float, ...]:
        """Kinks beside which points of a slip zone may stick."""
        return self.strong_kinks

    @property
    def convex(self) -> bool:
        """Whether this is the pressure under a convex profile: the ends of the contact then slip before points
        inside."""
        return True

    @functools.cached_property
    def mirrored(self) -> "Shape":
        """The mirror image."""
        return self if self.even else Mirrored(self)

    def pressure(self, x: Array) -> Array:
        """p/p0 at ``x``; zero outside [-1, 1]."""
        raise NotImplementedError

    def difference(self, t: Array, x: Array) -> Array:
        """(p(t) - p(x))/(t - x), in p0."""
        return _quotient(t, self.pressure(t), x, self.pressure(x))

    def conditions(self, edge: Array, c: Array, s: Array) -> Conditions:
        """Loads of the stick zone by quadrature of the consistency conditions, eqs. (17) and (18), moments being taken
        about the zone's centre."""
        edge, c, s = np.asarray(edge, float), np.asarray(c, float), np.asarray(s, float)
        centre = edge + c - 1
        # the stiffness of an end tends to a limit as the slip zone beside the end vanishes
        gap, near = np.maximum(1 - centre - c, _THIN), np.maximum(edge, _THIN)
        ends = 1 - gap, near - 1
        at_ends = [self.pressure(end) for end in ends]
        first = second = right = left = np.zeros(np.shape(c))
        for side, sign in ((1, np.ones_like(s)), (-1, -s)):
            t, _, weights = self.rule(edge, c, side)
            p = self.pressure(t)
            first = first + sign * (weights * p).sum(axis=-1)
            second = second + sign * (weights * p * (t - centre[..., None])).sum(axis=-1)
            # minus the smooth part of the traction in the stick zone, see _inside in partialslip.halfplane.traction
            smooth = [
                (_quotient(t, p, end[..., None], at_end[..., None]) * weights).sum(axis=-1)
                for end, at_end in zip(ends, at_ends, strict=True)
            ]
            right = right - side * np.abs(sign) * np.where(side > 0, 1, s) * c * smooth[0]
            left = left - side * np.where(side > 0, s, 1) * c * smooth[1]
        to_right, to_left = np.sqrt(gap / (gap + 2 * c)), np.sqrt(near / (near + 2 * c))
        right = (right + at_ends[0] * (1 / to_right - s * to_left)) / np.pi
        left = (left + at_ends[1] * (1 / to_left - s * to_right)) / np.pi
        skew = np.where(c > NARROW, (right - left) / c, 0.0)
        return Conditions(8 / np.pi * first, 2 / np.pi * second, right, left, skew)

    def rule(self, edge: Array | float, c: Array | float, side: int) -> Rule:
        """Quadrature over the slip zone on the right (``side`` = 1) or left (-1); see :func:`rule_between`."""
        return rule_between(self.pieces(edge, c, side), edge, c, side)

    def pieces(self, edge: Array | float, c: Array | float, side: int) -> Array:
        """theta (..., k) at the ends of the pieces of a slip zone inside which the pressure is smooth."""
        edge, c = np.asarray(edge, float), np.asarray(c, float)
        centre = edge + c - 1

        def theta(width: Array) -> Array:
            """theta at the distance ``width`` from the stick zone: cosh(theta) - 1 = width/c in half-angle form."""
            return 2 * np.arcsinh(np.sqrt(np.maximum(width, 0.0) / (2 * c[..., None])))

        end = theta((1 - centre - c if side > 0 else edge)[..., None])
        inner = theta(side * (np.array(self.kinks) - centre[..., None]) - c[..., None])
        ends = np.concatenate([0 * end, end - 3.0, end, inner], axis=-1)
        ends = np.sort(np.clip(ends, 0.0, end), axis=-1)
        # drop empty pieces, which belong to kinks outside this slip zone
        widest = np.diff(ends).reshape(-1, ends.shape[-1] - 1).max(axis=0, initial=0.0)
        return ends[..., np.append(True, (widest > 0) | (widest.max() == 0))]


class Mirrored(Shape):
    """Mirror image of the pressure ``of``."""

    even = False

    def __init__(self, of: Shape) -> None:
        self._of = of
        self.kinks = tuple(-kink for kink in reversed(of.kinks))

    @property
    def convex(self) -> bool:
        return self._of.convex

    @functools.cached_property
    def mirrored(self) -> Shape:
        return self._of

    @property
    def strong_kinks(self) -> tuple[float, ...]:
        return tuple(-kink for kink in reversed(self._of.strong_kinks))

    @property
    def sharp_kinks(self) -> tuple[float, ...]:
        return tuple(-kink for kink in reversed(self._of.sharp_kinks))

    def pressure(self, x: Array) -> Array:
        return self._of.pressure(-x)

    def difference(self, t: Array, x: Array) -> Array:
        return -self._of.difference(-t, -x)


def places_between(kinks: Array, low: float, high: float) -> Array:
    """The ``kinks`` (k,) between ``low`` and ``high``, and places between each two of these: where something that is
    smooth between them may be extreme."""
    ends = np.unique([low, *kinks[(kinks > low) & (kinks < high)], high])
    return np.concatenate([ends[1:-1], (ends[:-1] + np.diff(ends) * _BETWEEN[:, None]).ravel()])


def _quotient(t: Array, at_t: Array, x: Array, at_x: Array) -> Array:
    step = t - x
    return (at_t - at_x) / np.where(step == 0, np.inf, step)


def rule_between(ends: Array, edge: Array | float, c: Array | float, side: int) -> Rule:
    """Quadrature between ``ends`` (..., k) in theta, ascending, over the right (``side`` = 1) or left (-1) slip zone.

    The substitution t = centre +- c cosh(theta) removes w. The square root of p at the contact's end and the kinks of p
    remain: the tanh-sinh rule on each piece handles both.
    """
    edge, c = np.asarray(edge, float), np.asarray(c, float)
    nodes, to_end, factors = _rule_for(ends.shape[-1])
    half = np.diff(ends)[..., None] / 2
    points = np.where(nodes < 0, ends[..., :-1, None] + half * (1 + nodes), ends[..., 1:, None] - half * to_end)
    points = points.reshape(*points.shape[:-2], -1)
    t = (edge + c - 1)[..., None] + side * c[..., None] * np.cosh(points)
    return Rule(np.clip(t, -1.0, 1.0), points, (half * factors).reshape(points.shape))


def rule_over(ends: Array) -> tuple[Array, Array]:
    """Points (n,) and weights of quadrature between neighbouring ``ends`` (k,), ascending, of functions that may have
    any weak singularities there, by the tanh-sinh rule."""
    nodes, to_end, factors = _rule_for(len(ends))
    half = np.diff(ends)[:, None] / 2
    points = np.where(nodes < 0, ends[:-1, None] + half * (1 + nodes), ends[1:, None] - half * to_end)
    return points.ravel(), (half * factors).ravel()


def double_exponential(count: int, span: float = 3.2) -> tuple[Array, Array, Array]:
    """Nodes (``count``,) in (-1, 1), their distances from 1, and weights of the tanh-sinh rule, truncated at +-``span``
    and normalised to be exact for constants."""
    k = np.linspace(-span, span, count)
    u = np.pi / 2 * np.sinh(k)
    weights = np.pi / 2 * np.cosh(k) / np.cosh(u) ** 2
    return np.tanh(u), 2 / (1 + np.exp(2 * u)), 2 * weights / weights.sum()


@functools.cache
def _rule_for(ends: int) -> tuple[Array, Array, Array]:
    """Tanh-sinh rule for each piece of an integral between ``ends`` piece ends: the more pieces, the shorter they are
    and the weaker their kinks, and the fewer nodes suffice."""
    return double_exponential(*next(rule for most, rule in _RULES if ends <= most))


_RULES = ((40, (81, 3.2)), (160, (33, 3.0)), (np.inf, (11, 2.2)))  # largest number of ends, (nodes, span)


class Given(Shape):
    """Pressure, given as a function on [-1, 1].

    Parameters
    ----------
    function : callable
        Points (n,) to pressures (n,), in any unit; ``scale`` is p0 in this unit.
    kinks : sequence of float
        Points at which the pressure is not smooth; -x is added for each x.

    Raises
    ------
    InputError
        If the pressure is not finite and positive inside.
    """

    def __init__(self, function: Callable[[Array], Array], kinks: Sequence[float] = ()) -> None:
        self._function, self.scale = function, 1.0
        self.kinks = tuple(sorted({sign * float(kink) for kink in kinks if abs(kink) < 1 for sign in (-1, 1)}))
        x = np.cos((np.arange(_CHECKED) + 0.5) * np.pi / (2 * _CHECKED))
        p, mirrored = self.pressure(x), self.pressure(-x)
        at, both = np.append(x, -x), np.append(p, mirrored)
        for right, allowed in ((np.isfinite(both), "finite"), (~(both <= 0), "> 0 inside the contact")):
            if not right.all():
                raise InputError(f"pressure at x = {at[~right][0]:g} a: must be {allowed}, not {both[~right][0]:g}")
        self.even = bool((np.abs(p - mirrored) <= _EVEN * np.abs(p).max()).all())
        # P = pi/2 p0 at half-width 1, by the rule for a slip zone beside a stick zone that shrinks to nothing
        rules = (self.rule(1.0, 1e-30, side) for side in (1, -1))
        self.scale = 2 / np.pi * sum(float((weights * self.pressure(t) * np.abs(t)).sum()) for t, _, weights in rules)

    def pressure(self, x: Array) -> Array:
        values = np.asarray(self._function(np.clip(x, -1.0, 1.0).ravel()), float)
        if values.shape != (np.size(x),):
            raise InputError(f"pressure: must return one value for each point, {np.size(x)}, not {values.shape}")
        return np.where(np.abs(x) < 1, values.reshape(np.shape(x)) / self.scale, 0.0)


class Bound(Given):
    """Friction bound f(x) p where the coefficient of friction f varies along the contact: ``function`` is f times the
    scaled pressure, and ``scale`` the mean of f over the pressure; ``sharp`` are the :attr:`sharp_kinks`."""

    def __init__(self, function: Callable[[Array], Array], kinks: Sequence[float], sharp: Sequence[float]) -> None:
        super().__init__(function, kinks)
        self._sharp = tuple(sharp)

    @property
    def sharp_kinks(self) -> tuple[float, ...]:
        return self._sharp

    @property
    def convex(self) -> bool:
        return False
