"""Unlike half-planes that are pressed together under an even gap: the flat punch with friction that all stages are made
from (:mod:`partialslip.friction.pressing`), on cells of its own.

Scaled: lengths by the punch's half-width, forces by its force, displacements by A times the force.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipk, ellipkm1

from partialslip.friction.coupled_step import Relative, punched
from partialslip.friction.even_gap import EvenGap
from partialslip.friction.zone_ends import read_stick_zone
from partialslip.march.cells import compliance, graded_cells
from partialslip.tools.arrays import Array

_END, _GROWTH = 1e-8, 0.05  # accuracy: size of cells at the punch's ends; growth
# accuracy: size of cells in the middle, in the half-width of the stick zone: stages have the punch's tractions over the
# square of the distance from there. With cells as wide as they grow p(0) of stages is off by up to 2e-4
# (measured)
_MIDDLE = 0.01
# accuracy: sizes of cells at the stick zone's ends, in their distance from the punch's ends: the first mesh is refined
# at Goodman's stick zone, each other at that of the mesh before
_AT_STICK = (0.02, 0.002, 5e-4)


def relative(vertices: Array, beta: float, opening: bool = True) -> Relative:
    """Relative compliances of cells between ``vertices`` (c + 1,) on unlike half-planes; lengths in any unit.

    A unit normal force moves the surfaces by -beta/2 on its right and by beta/2 on its left along x, relative to each
    other: the mean of the sign of x - s over two cells is the sign of their order. ``opening``: whether shear opens
    the gap, too; not in Goodman's approximation.
    """
    along = compliance(vertices / (vertices[-1] - vertices[0]))  # scaling lengths adds a rigid shift only
    order = np.arange(len(along))
    xy = -beta / 2 * np.sign(order[:, None] - order)
    return Relative(along, along, xy, None if opening else 0 * xy)


def goodman_stick_zone(ratio: float) -> float:
    """Half-width c of the stick zone under a flat punch of half-width 1 in Goodman's approximation, K(c)/K'(c) =
    ``ratio`` = f/|beta| (Spence 1975)."""

    def off(log: float) -> float:
        c = 1 - np.exp(log) if log > -30 else 1.0
        return float(ellipk(c**2) / ellipkm1(c**2)) - ratio

    if ratio > 8:
        return 1.0
    if off(widest := np.log1p(-_END)) > 0:  # c is less than a cell
        return 0.0
    return float(1 - np.exp(brentq(off, -30.0, widest)))


@dataclass(frozen=True)
class PunchGrowth:
    """Tractions under a flat punch with friction, constant on the cells of [0, 1] between ``vertices`` (c + 1,):
    ``normal`` (c,), which is even, and ``tangential`` (c,), which is odd. The part |x| < ``stick`` sticks, known to
    about ``off``."""

    vertices: Array
    normal: Array
    tangential: Array
    stick: float
    off: float

    @classmethod
    def of(cls, beta: float, f: float, opening: bool = True) -> "PunchGrowth":
        """Solve the punch for Dundurs' ``beta`` and the coefficient of friction ``f``."""
        c = goodman_stick_zone(f / abs(beta))
        for size in _AT_STICK:
            beside = max(1 - c, _END)
            half, sizes = np.array([1.0]), np.array([_END])
            if beside > _END and c > _END:
                half, sizes = np.array([c, 1.0]), np.array([size * min(beside, c), _END])
            points = np.concatenate([-half[::-1], [0.0], half])
            sizes = np.concatenate([sizes[::-1], [_MIDDLE * half[0]], sizes])
            vertices = graded_cells(points, sizes, _GROWTH)
            middles = (vertices[1:] + vertices[:-1]) / 2
            sides = np.sign(beta * middles) * (np.abs(middles) > c)
            p, q = punched(relative(vertices, beta, opening), f, sides.astype(np.int8))
            before, c = c, read_stick_zone(middles, f * p, 2 * q, vertices, lambda forces: forces).right
        right = vertices[1:] > 0
        clipped = np.concatenate([[0.0], vertices[1:][right]])
        widths = np.diff(vertices)[right]
        return cls(clipped, p[right] / widths, q[right] / widths, c, abs(c - before))

    def resultants(self, x: Array) -> tuple[Array, Array]:
        """Forces of the punch on the right of ``x`` (k,), along y and x."""
        at = np.minimum(np.abs(x), 1.0)
        beyond = [np.interp(at, self.vertices, each) for each in self._sums(np.diff(self.vertices))]
        return _both_sides(x, *beyond)

    def stage(self, x: Array) -> tuple[Array, Array]:
        """Forces on the right of ``x`` (k,) under a parabola whose contact has the half-width and the force of the
        punch: T(x) = 2 x int_x^1 t(s)/s^2 ds has the resultant int_x^1 t(s) (1 - x^2/s^2) ds."""
        at, ends = np.minimum(np.abs(x), 1.0), self.vertices
        cell = np.clip(np.searchsorted(ends, at, "right") - 1, 0, len(self.normal) - 1)
        with np.errstate(divide="ignore"):
            inverse = 1 / ends
        whole, far = self._sums(np.diff(ends)), self._sums(np.append(0.0, -np.diff(inverse[1:])))
        found = []
        for traction, sums, moments in zip((self.normal, self.tangential), whole, far, strict=True):
            near = np.divide(at**2, at, out=np.zeros_like(at), where=at > 0)  # x^2/s at s = x
            rest = traction[cell] * (ends[cell + 1] - at + at**2 * inverse[cell + 1] - near)
            found.append(rest + sums[cell + 1] - at**2 * moments[cell + 1])
        return _both_sides(x, *found)

    def stage_under(
        self, x: Array, reach: float, force: float, weighed: Callable[[Array], Array]
    ) -> tuple[Array, Array]:
        """The same at ``x`` (k,) under another even gap, whose contact has the half-width ``reach`` under the ``force``
        P, over P: int r(x/s) P'(s) ds of the punch's resultants r is P r(x/reach) - x int t(s) P(x/s) ds by parts, and
        the latter is known cell by cell from ``weighed``, the integral of P(s)/s^2
        (:meth:`partialslip.friction.even_gap.EvenGap.weighed`)."""
        at, widths = np.minimum(np.abs(x), reach), np.diff(self.vertices)
        s = np.full((len(x), len(self.vertices)), reach)
        np.divide(at[:, None], self.vertices, out=s, where=self.vertices > 0)
        grown = -np.diff(weighed(np.minimum(s, reach)), axis=1) / force
        tractions = zip((self.normal, self.tangential), self._sums(widths), strict=True)
        beyond = (np.interp(at / reach, self.vertices, sums) - at * (grown @ each) for each, sums in tractions)
        return _both_sides(x, *beyond)

    def _sums(self, weights: Array) -> list[Array]:
        """Sums of the tractions times ``weights`` (c,) over all cells beyond each of the ``vertices``."""
        return [np.append(np.cumsum((weights * each)[::-1])[::-1], 0.0) for each in (self.normal, self.tangential)]


@dataclass(frozen=True)
class OnCells:
    """Stages of pressing under an even ``gap`` as forces on the cells between ``vertices`` (c + 1,)."""

    punch: PunchGrowth
    vertices: Array
    gap: EvenGap
    last: float = 1e-4  # last step of pressing, in half-widths: stages are as exact as cells are

    @cached_property
    def _weighed(self) -> Callable[[Array], Array]:
        return self.gap.weighed(float(np.abs(self.vertices).max()))

    def growth(self, half_width: float, /) -> tuple[Array, Array]:
        """As of :class:`partialslip.friction.pressing.Stages`."""
        p, q = self.punch.resultants(self.vertices / half_width)
        return -np.diff(p), -np.diff(q)

    def stage(self, half_width: float, share: float) -> tuple[Array, Array]:
        """As of :class:`partialslip.friction.pressing.Stages`."""
        reach = half_width * share
        if self.gap.parabolic:
            p, q = self.punch.stage(self.vertices / reach)
            return -np.diff(p) * share**2, -np.diff(q) * share**2
        if reach <= self.gap.places[0]:  # a flat that bears nothing yet
            return 0 * self.vertices[1:], 0 * self.vertices[1:]
        force = self.gap.force(reach)
        p, q = self.punch.stage_under(self.vertices, reach, force, self._weighed)
        borne = force / self.gap.force(half_width)
        return -np.diff(p) * borne, -np.diff(q) * borne


def _both_sides(x: Array, normal: Array, tangential: Array) -> tuple[Array, Array]:
    """Forces on the right of ``x``, from those on the right of |x|: ``normal`` is even with the sum 1, ``tangential``
    is odd."""
    return np.where(x < 0, 1 - normal, normal), tangential
