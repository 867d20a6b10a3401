"""Self-similar pressing of coupled half-planes under a parabolic gap.

With friction, points that stick keep the relative displacement at which they stuck. For half-planes and a parabola all
stages of pressing are similar. At a half-width s the contact grows as under a flat punch of half-width s, in which the
part |x| < c s sticks, with the same c at all stages (Spence 1968, 1975). Tractions are therefore integrals of the
tractions under flat punches,

    q(x) = int_x^a q_flat(x/s) 2 s ds / (s a^2),    p likewise,

and the problem of one punch determines all stages. One small last step from an earlier stage is then solved with all
conditions of contact and friction, which gives the certificate.

In bodies of a size the stages are nearly similar: what a punch does at x/s depends on (s/W)^2, W being the size. What
counts of an earlier stage are the displacements at which points stick,

    u(x) = int_0^a u_flat(x/s; s) P'(s) ds,

which vanish where they stick under the punch. A few punches suffice, between which u_flat is interpolated. P'(s)
follows from the gap, which the displacements along y close in the same way.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from partialslip.arrays import Array, Mask

_TELLING = 1e-9  # tolerance of lengths, relative to the half-width
_POINTS, _WEIGHTS = (np.polynomial.legendre.leggauss(16) + np.array([[1.0], [0.0]])) / 2
_NEAR, _SOME = 1.05, 64  # nodes that matter, in half-widths of the contact; how many are enough for the gap
_FAR = np.geomspace(1.01, 1e3, 40)  # beyond the last node, in its distance
_CLOSED = 0.98  # nodes that are certainly closed, in half-widths of the contact
_INNER = 0.8  # the same, where the slope at the last node begins


class Stages(Protocol):
    """Stages of self-similar pressing: forces under the parabola, and their growth."""

    @property
    def last(self) -> float:
        """Last step of pressing, in half-widths."""

    @property
    def growth(self) -> tuple[Array, Array]:
        """Nodal forces along y and x (n,) under the flat punch: the increments of pressing."""

    def stage(self, share: float) -> tuple[Array, Array]:
        """Nodal forces along y and x (n,) under the parabola, pressed up to ``share`` of the half-width."""


@dataclass(frozen=True)
class Punch:
    """Flat punch of ``half_width`` under the force 1: ``normal`` and ``tangential`` nodal forces (n,) at the nodes
    ``x`` (n,), whose ``weights`` (n,) turn tractions into forces."""

    half_width: float
    x: Array
    weights: Array
    normal: Array
    tangential: Array
    last: float = 2.5e-3

    @property
    def growth(self) -> tuple[Array, Array]:
        """Nodal forces along y and x (n,) under the flat punch."""
        return self.normal, self.tangential

    def stage(self, share: float) -> tuple[Array, Array]:
        """Nodal forces along y and x (n,) under the parabola, pressed up to ``share`` of the punch's half-width."""
        reach = self.half_width * share
        inside = np.abs(self.x) < self.half_width * (1 - _TELLING)
        at = np.concatenate([[-1.0], self.x[inside] / self.half_width, [1.0]])

        def forces(of: Array) -> Array:
            values = np.concatenate([[0.0], self._summed(of)[inside], [0.0]])
            traction = np.interp(self.x / reach, at, values, left=0.0, right=0.0)
            result: Array = self.weights * traction * share
            return result

        p, q = forces(self.normal), forces(self.tangential)
        # correct the sums: the discretisation error is small, but not compared with the increment of the last step
        return p * share**2 / p.sum(), q - q.sum() / p.sum() * p

    def _summed(self, forces: Array) -> Array:
        """2 x times the integral of traction(t)/t^2 from x to 1, lengths in half-widths. With t = sin(angle), the
        traction times cos(angle) is regular at the ends; it is interpolated linearly between nodes."""
        scaled = self.x / self.half_width
        result = np.zeros(len(scaled))
        for way in (1, -1):
            side = np.flatnonzero((way * scaled > _TELLING) & (way * scaled < 1 - _TELLING))
            if not len(side):
                continue
            side = side[np.argsort(way * scaled[side])]
            angle = np.arcsin(way * scaled[side])
            regular = forces[side] / self.weights[side] * np.cos(angle)
            # nodes beside the end are inaccurate due to the singularity; coarse meshes have no others
            regular[-2:] = regular[-min(3, len(regular))]
            angle, regular = np.append(angle, np.pi / 2), np.append(regular, regular[-1])
            slope = np.diff(regular) / np.diff(angle)
            pieces = slope * np.diff(np.log(np.sin(angle))) - np.diff(regular / np.tan(angle))
            result[side] = 2 * np.sin(angle[:-1]) * np.cumsum(pieces[::-1])[::-1]
        middle, known = np.abs(scaled) <= _TELLING, np.abs(scaled) > _TELLING
        result[middle] = np.interp(scaled[middle], scaled[known], result[known])
        return result


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
        result: Array = np.interp(self.x, self.x[near], found)
        return result

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
