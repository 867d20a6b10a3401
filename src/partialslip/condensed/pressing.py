"""Self-similar pressing of coupled half-planes under a parabolic gap.

With friction, points that stick keep the relative displacement at which they stuck. For half-planes and a parabola all
stages of pressing are similar. At a half-width s the contact grows as under a flat punch of half-width s, in which the
part |x| < c s sticks, with the same c at all stages (Spence 1968, 1975). Tractions are therefore integrals of the
tractions under flat punches,

    q(x) = int_x^a q_flat(x/s) 2 s ds / (s a^2),    p likewise,

and the problem of one punch determines all stages. One small last step from an earlier stage is then solved with all
conditions of contact and friction, which gives the certificate.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from partialslip.arrays import Array

_TELLING = 1e-9  # tolerance of lengths, relative to the half-width


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
