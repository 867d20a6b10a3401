"""Self-similar pressing of coupled half-planes under an even gap, a parabola first.

With friction, points that stick keep the relative displacement at which they stuck. For half-planes and a parabola all
stages of pressing are similar. At a half-width s the contact grows as under a flat punch of half-width s, in which the
part |x| < c s sticks, with the same c at all stages (Spence 1968, 1975). Tractions are therefore integrals of the
tractions under flat punches,

    q(x) = int_x^a q_flat(x/s) 2 s ds / (s a^2),    p likewise,

and the problem of one punch determines all stages. One small last step from an earlier stage is then solved with all
conditions of contact and friction, which gives the certificate.

Half-planes of the same material move alike along x, but in bodies of a size both are strained by the force, with the
same strain wherever it acts. Then q under a flat punch with one force grows like its half-width, and

    q(x) = int_x^a q_flat(x/s) 2 s ds / a^3,

with a second punch to tell how far that is true. Under another even gap the contact grows as under a flat punch, too,
and only the force P(s) of the half-width s differs:

    q(x) = int_x^a q_flat(x/s) P'(s) ds / s,    of like bodies of a size q_flat(x/s) P'(s) ds / a,

where a step w of the gap's curvature at |x| = b adds w s arccos(b/s) to P'(s), as on half-planes of like materials; of
dissimilar ones see :mod:`partialslip.friction.even_gap`.

In other bodies of a size the stages are nearly similar: what a punch
does at x/s depends on (s/W)^2, W being the size. What counts of an earlier stage are the displacements at which points
stick,

    u(x) = int_0^a u_flat(x/s; s) P'(s) ds,

which vanish where they stick under the punch. A few punches suffice, between which u_flat is interpolated. P'(s)
follows from the gap, which the displacements along y close in the same way.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.special import hyp2f1

from partialslip.friction.active_set import Solution
from partialslip.friction.even_gap import PARABOLA, EvenGap
from partialslip.friction.zone_ends import StickInterval
from partialslip.tools.arrays import Array, Indices, Mask

_STICKS = 1e-9  # accuracy: relative tolerance of the friction bound
_TELLING = 1e-9  # accuracy: tolerance of lengths, relative to the half-width
_POINTS, _WEIGHTS = (np.polynomial.legendre.leggauss(16) + np.array([[1.0], [0.0]])) / 2
# accuracy: points between the half-widths at which a place is covered first and last (measured: q is off by 1e-8, by
# 1.5e-4 where slip leaves kinks)
_STAGES, _BY_STAGE = (np.polynomial.legendre.leggauss(256) + np.array([[1.0], [0.0]])) / 2
_NEAR, _SOME = 1.05, 64  # accuracy: nodes that matter, in half-widths of the contact; how many are enough for the gap
_ROOTS = np.linspace(0.0, 1.0, 401)  # accuracy: roots of angles up to the corner of a flat punch
_FAR = np.geomspace(1.01, 1e3, 40)  # beyond the last node, in its distance
_CLOSED = 0.98  # accuracy: nodes that are certainly closed, in half-widths of the contact
_INNER = 0.8  # accuracy: the same, where the slope at the last node begins


@dataclass(frozen=True)
class Pressed:
    """Bodies pressed together: ``normal`` and ``tangential`` forces, number of ``steps``, and ``errors`` due to the
    steps, of q (relative L2) and a (relative). ``growth`` are the increments (n,) of the forces along y and x at the
    end of pressing: nodes at which these are within the bound with ``f`` (n,) have stuck since they touched. They are
    those under a flat punch between ``corners``, if there are any."""

    normal: Solution
    tangential: Solution
    steps: int
    errors: dict[str, float]
    growth: tuple[Array, Array]
    f: Array
    corners: tuple[float, float] | None = None

    def on(self, nodes: Indices) -> "Pressed":
        """Pressed bodies with the growth at the ``nodes`` (indices) only."""
        return replace(self, growth=(self.growth[0][nodes], self.growth[1][nodes]), f=self.f[nodes])

    def slipped(self) -> bool:
        """Whether any node has slipped."""
        p, q = self.growth
        return bool((np.abs(q)[p > 0] >= (1 - _STICKS) * self.f[p > 0] * p[p > 0]).any())

    def scaled(self, stick: StickInterval, left: float, right: float) -> StickInterval:
        """Stick zone of the contact from ``left`` to ``right``, from the ``stick`` zone under the flat punch of the
        ``growth``: the same fraction of the contact as of the punch width between its corner nodes."""
        if not self.corners:
            return stick
        first, last = self.corners
        at = [left + (end - first) * (right - left) / (last - first) for end in (stick.left, stick.right)]
        return replace(stick, left=at[0], right=at[1])


class Stages(Protocol):
    """Stages of self-similar pressing: forces under the parabola, and their growth."""

    @property
    def last(self) -> float:
        """Last step of pressing, in half-widths."""

    @property
    def gap(self) -> EvenGap:
        """The gap, and how well the punches' forces close it."""

    def growth(self, half_width: float, /) -> tuple[Array, Array]:
        """Nodal forces along y and x (n,) under the flat punch of ``half_width`` and the force 1: the increments of
        pressing."""

    def stage(self, half_width: float, share: float) -> tuple[Array, Array]:
        """Nodal forces along y and x (n,) under the parabola, pressed up to ``share`` of the ``half_width`` of the
        contact, which belongs to the force 1."""


@dataclass(frozen=True)
class FlatPunch:
    """Flat punch under the force 1, on nodes, of bodies that are pressed together under an even gap.

    Parameters
    ----------
    corners : (float, float)
        Where the punch ends, as its forces tell: a node covers part of the space to the next one.
    x : (n,) array
        Nodes, from the vertex of the gap.
    weights : (n,) array
        Factors that turn tractions into forces.
    forces : two of (n,) array
        Nodal forces along y and x.
    points : (k,) array
        Points between the corners, ascending, which may be few.
    left : two of (k,) array
        Forces along y and x on the left of the ``points``.
    sized : bool
        Whether bodies are alike and of a size: the strain with which their surfaces move along x under a force is the
        same for all punches, so that q under one force grows like the half-width.
    gap : EvenGap
        The gap, from its vertex; default: a parabola.
    """

    corners: tuple[float, float]
    x: Array
    weights: Array
    forces: tuple[Array, Array]
    points: Array
    left: tuple[Array, Array]
    sized: bool = False
    gap: EvenGap = PARABOLA
    last: float = 2.5e-3

    @property
    def half_width(self) -> float:
        """Half of the distance of the corners."""
        return (self.corners[1] - self.corners[0]) / 2

    def beyond(self, pushes: float) -> tuple[Array, Array]:
        """Ends of cells from the middle, 0, to the corner, 1, and the forces along y on these, the means of both sides,
        for f times the size of Dundurs' beta ``pushes``: near corners p has the power -1/2 + arctan(pushes)/pi."""

        def even(t: Array) -> Array:  # the integral of (1 - t^2) to that power: forces are nearly linear in it
            return np.asarray(t * hyp2f1(0.5, 0.5 - np.arctan(pushes) / np.pi, 1.5, t**2), float)

        ends = np.sin(np.pi / 2 * (1 - _ROOTS[::-1] ** 2))
        at = (self.points - sum(self.corners) / 2) / self.half_width
        known, total = np.abs(at) < 1, float(self.forces[0].sum())
        own = even(np.concatenate([[-1.0], at[known], [1.0]]))
        left = np.concatenate([[0.0], self.left[0][known], [total]])
        both = (np.interp(even(ends), own, left) - np.interp(-even(ends), own, left)) / 2
        return ends, np.diff(both)

    def growth(self, _: float, /) -> tuple[Array, Array]:
        """As of :class:`Stages`: the forces, as the punch has about the half-width."""
        return self.forces

    def stage(self, half_width: float, share: float) -> tuple[Array, Array]:
        """As of :class:`Stages`: punches of all half-widths have tractions of the same form."""
        reach = half_width * share
        if reach <= self.gap.places[0] > 0:  # a flat that bears nothing yet
            return 0 * self.x, 0 * self.x
        totals, overs = [float(forces.sum()) for forces in self.forces], (None, half_width if self.sized else None)
        if self.gap.parabolic and not self.sized:  # sums over cells are exact, also where slip leaves kinks
            p, q = (self.weights * self._summed(self.x / reach, *each) for each in zip(totals, self.left, strict=True))
        else:
            of = zip(totals, self.left, overs, strict=True)
            p, q = (self.weights * self._integrated(reach, *each) for each in of)
        borne = self.gap.force(reach) / self.gap.force(half_width)
        # correct the sums: the discretisation error is small, but not compared with the increment of the last step
        return p * borne / p.sum(), (q - q.sum() / p.sum() * p) * borne / p.sum()

    def _integrated(self, reach: float, total: float, left: Array, over: float | None) -> Array:
        """Integral of traction(x/s) P'(s)/s over the half-widths s up to ``reach`` at the nodes (n,), with ``over`` in
        place of the last s if given; from the forces on the ``left`` (k,) of the points and the ``total``. With w =
        sqrt(s^2 - x^2), it is that of the force by angle (:meth:`_summed`) P'(s)/s dw."""
        at = (self.points - sum(self.corners) / 2) / self.half_width
        known = np.abs(at) < 1
        angle = np.concatenate([[-np.pi / 2], np.arcsin(at[known]), [np.pi / 2]])
        # between points the force must be what it is: interpolated tractions leave shear of the same sign all along
        by_angle = PchipInterpolator(angle, np.concatenate([[0.0], left[known], [total]])).derivative()
        inside = np.abs(self.x) < reach
        x = self.x[inside, None]
        first, last = (np.sqrt(np.maximum(end**2 - x**2, 0.0)) for end in (self.gap.places[0], reach))
        w = first + (last - first) * _STAGES**2
        s = np.hypot(x, w)
        weights = 2 * (last - first) * _STAGES * _BY_STAGE
        result = np.zeros(len(self.x))
        result[inside] = (by_angle(np.arctan2(x, w)) * self.gap.rate(s) / (over or s) * weights).sum(axis=-1)
        return result

    def _summed(self, x: Array, total: float, left: Array) -> Array:
        """2 |x| times the integral of traction(t)/t^2 from |x| to 1 at ``x`` (m,), lengths in half-widths; from the
        forces on the ``left`` (k,) of the points and the ``total``. With t = sin(angle), they are nearly linear in the
        angle, even beside the corners, where nodal tractions are inaccurate."""
        middle = sum(self.corners) / 2
        points = np.concatenate([[-1.0], (self.points - middle) / self.half_width, [1.0]])
        left, result = np.concatenate([[0.0], left, [total]]), np.zeros(len(x))
        for way in (1, -1):
            at, outside = way * points[::way], (total - left if way > 0 else left)[::way]
            beyond = (at > _TELLING) & (at < 1)
            angle = np.concatenate([[0.0], np.arcsin(at[beyond]), [np.pi / 2]])
            force = np.concatenate([[np.interp(0.0, at, outside)], outside[beyond], [0.0]])
            # 1/tan(angle) is the integral of 1/sin^2 from the angle to pi/2
            density, kernel = -np.diff(force) / np.diff(angle), np.append(1 / np.tan(angle[1:-1]), 0.0)
            sums = np.append(np.cumsum((density[1:] * -np.diff(kernel))[::-1])[::-1], 0.0)
            side = np.flatnonzero((way * x < 1) & ((way * x > 0) | ((x == 0) & (way > 0))))
            own = np.arcsin(way * x[side])
            cell = np.searchsorted(angle, own, "right") - 1
            inner, near = sums[cell] - density[cell] * kernel[cell], np.maximum(own, _TELLING)
            result[side] = 2 * np.sin(near) * (inner + density[cell] / np.tan(near))
        return result


def disproportion(x: Array, punch: tuple[Array, Array], other: tuple[Array, Array]) -> float:
    """Relative error of q under the force 1 if it is assumed to grow like the half-width.

    From the forces along y and x under two flat punches, (n,) each, at ``x`` (n,) from their middle: forces along x on
    either side are in proportion to the spread of those along y, a better measure of the half-width than corners,
    beside which elements may be large.
    """
    sides = np.array([x < 0, x > 0])
    own, its = ((sides * q).sum(axis=1) / np.sqrt(p @ x**2) for p, q in (punch, other))
    scale = float(np.abs(own).max())
    return float(np.abs(its - own).max() / scale) if scale > 0 else 0.0


@dataclass(frozen=True)
class Punches:
    """Displacements under flat punches with the force 1, in bodies of a size.

    Parameters
    ----------
    half_widths : (k,) array
        Descending.
    x : (n,) array
        Nodes, ascending.
    along, opening : (k, n) arrays
        Relative displacements along x, and opening of the gap, less the rigid motion: zero where nodes stick or touch.
    stick : float
        Smallest half-width of a stick zone, in that of its punch.
    """

    half_widths: Array
    x: Array
    along: Array
    opening: Array
    stick: float
    last = 2.5e-3  # last step of pressing, in half-widths

    @classmethod
    def of(cls, half_widths: Array, x: Array, under: Sequence[tuple[Mask, Mask, Array, Array]]) -> "Punches":
        """Punches with these ``half_widths`` (k,), descending, at the nodes ``x`` (n,), ascending; ``under`` each the
        nodes that touch and those that stick, and the relative displacements along x and y, (n,) each."""
        along = [np.where(sticks, 0.0, moved - np.median(moved[sticks])) for _, sticks, moved, _ in under]
        opening = [np.where(touch, 0.0, opened - np.median(opened[touch])) for touch, _, _, opened in under]
        stick = min(np.abs(x[sticks]).max() / np.abs(x[touch]).max() for touch, sticks, _, _ in under)
        return cls(half_widths, x, np.array(along), np.array(opening), float(stick))

    def kept(self, gap: Array, reach: float, share: float, count: int) -> Array:
        """Relative displacements (n,) under the ``gap`` (n,), pressed up to ``share`` of the half-width ``reach``, from
        the first ``count`` punches."""
        near = np.flatnonzero(np.abs(self.x) < _NEAR * reach)
        closed = near[np.abs(self.x[near]) < _CLOSED * reach]
        half = np.arange(0, (len(closed) + 1) // 2, max(len(closed) // _SOME, 1))
        some = closed[np.concatenate([half, -1 - half])]  # mirror images of each other, as far as nodes are
        under = self._sums(self._tables(self.opening[:count], np.log), self.x[some], reach, 1.0)
        grown = np.linalg.lstsq(under.T, gap[closed].min() - gap[some], rcond=None)[0]
        along = self._tables(self.along[:count], lambda ratio: (1 - ratio**-2) / 2)
        found = grown @ self._sums(along, self.x[near], reach, share)
        return np.interp(self.x, self.x[near], found)

    def _sums(self, tables: list[tuple[Array, Array]], x: Array, reach: float, share: float) -> Array:
        """Integrals at ``x`` (m,) over half-widths s up to ``share``, of what the ``tables`` tell of the first punches,
        for P'(s) like s and, with more than one punch, s^3: (1 or 2, m); lengths in ``reach``.

        Displacements are square roots beside the ends of a punch, which cancel with s = |x| (1 - v^2), and slip ends at
        the stick zone.
        """
        ends, sign = np.abs(x)[:, None] / reach, np.sign(x)[:, None]
        begins = np.sqrt(np.maximum(1 - share / np.maximum(ends, _TELLING), 0.0))
        v = begins + (1 - begins) * _POINTS
        past, by_past = ends * (1 - v**2), 2 * ends * v * (1 - begins) * _WEIGHTS
        wide = np.maximum(np.minimum(share, ends / self.stick) - ends, 0.0)
        s = np.hstack([past, ends + wide * _POINTS**2])
        by = np.hstack([by_past, wide * 2 * _POINTS * _WEIGHTS])
        at = sign * ends / np.maximum(s, _TELLING)
        places, total = (self.half_widths[: len(tables)] / reach) ** 2, np.zeros_like(s)
        for number, table in enumerate(tables):
            others = np.delete(places, number)
            total += np.interp(at, *table) * np.prod((s[..., None] ** 2 - others) / (places[number] - others), axis=-1)
        return np.array([(total * s**power * by).sum(axis=-1) for power in (1, 3)[: len(tables)]])

    def _tables(self, of: Array, far: Callable[[Array], Array]) -> list[tuple[Array, Array]]:
        """Abscissae x/s and values of what is known ``of`` the first punches, (k, n). Beyond the nodes a larger punch
        goes on like the next smaller one, and the smallest like ``far`` of the distance: the field of a line load."""
        found: list[tuple[Array, Array]] = []
        for half_width, values in zip(self.half_widths[: len(of)][::-1], of[::-1], strict=True):
            at = self.x / half_width
            places, beyond = [at], [values]
            for end, side in ((0, -1), (-1, 1)):
                if found:
                    past = side * found[-1][0] > side * at[end]
                    more, known = found[-1][0][past], found[-1][1][past] - np.interp(at[end], *found[-1])
                else:
                    slope = (values[end] - np.interp(_INNER * at[end], at, values)) / -far(np.array(_INNER))
                    more, known = at[end] * _FAR[::side], slope * far(_FAR[::side])
                places.insert(len(places) * (side > 0), more)
                beyond.insert(len(beyond) * (side > 0), known + values[end])
            found.append((np.concatenate(places), np.concatenate(beyond)))
        return found[::-1]
