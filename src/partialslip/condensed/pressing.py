"""Self-similar pressing of coupled bodies under a parabolic gap.

With friction, points that stick keep the relative displacement at which they stuck. At a half-width s the contact grows
as under a flat punch of half-width s, in which the part |x| < c s sticks. The tractions are therefore integrals of
the tractions t(x/s; s)/s under flat punches with the force 1,

    q(x) = int_x^a t(x/s; s) P'(s)/s ds,    p likewise.

Half-planes know no length: t does not depend on s, P'(s) is 2 s/a^2, c is the same at all stages, all of which are
similar, and the problem of one punch determines them (Spence 1968, 1975). In bodies of a size t and P'(s)/s depend on
s^2, and little: a few punches suffice, between which t is interpolated, and P'(s) follows from the pressure at the end.
One small last step from an earlier stage is then solved with all conditions of contact and friction, which gives the
certificate.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol

import numpy as np

from partialslip.arrays import Array

_TELLING = 1e-9  # tolerance of lengths, relative to the half-width
_POINTS, _WEIGHTS = ((nodes + shift) / 2 for nodes, shift in zip(np.polynomial.legendre.leggauss(24), (1, 0), strict=True))


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
class Punches:
    """Flat punches under the force 1 at the nodes ``x`` (n,), whose ``weights`` (n,) turn tractions into forces.

    ``half_widths`` (k,) are those of the punches, the first that of the contact; ``normal`` and ``tangential`` (k, n)
    the nodal forces under them; ``pressing`` (n,) are the normal forces of the contact. ``last`` as in
    :class:`Stages`.
    """

    half_widths: Array
    x: Array
    weights: Array
    normal: Array
    tangential: Array
    pressing: Array
    last: float = 2.5e-3

    @property
    def growth(self) -> tuple[Array, Array]:
        """Nodal forces along y and x (n,) under the punch of the contact's half-width."""
        return self.normal[0], self.tangential[0]

    @property
    def fewer(self) -> "Punches":
        """Without the last punch."""
        return replace(
            self, half_widths=self.half_widths[:-1], normal=self.normal[:-1], tangential=self.tangential[:-1]
        )

    def stage(self, share: float) -> tuple[Array, Array]:
        """Nodal forces along y and x (n,) under the parabola, pressed up to ``share`` of the contact's half-width."""
        p, q = self._grown @ self._sums(share)
        powers = 2.0 * np.arange(1, len(self._grown) + 1)
        force = self._grown @ (share**powers / powers) / np.sum(self._grown / powers)
        # correct the sums: the discretisation error is small, but not compared with the increment of the last step
        return p * force / p.sum(), q - q.sum() / p.sum() * p

    @cached_property
    def _grown(self) -> Array:
        """Coefficients (k,) of P'(s)/s by the powers of s^2, s in half-widths, from the pressure of the contact."""
        root = np.sqrt(self.weights)
        found: Array = np.linalg.lstsq((self._sums(1.0)[0] / root).T, self.pressing / root, rcond=None)[0]
        return found

    def _sums(self, share: float) -> Array:
        """Forces along y and x, (2, k, n), up to ``share``, for each power of s^2 in P'(s)/s.

        With s = x + (share - x) v^2 the square-root singularity of the tractions at x = s cancels. The tractions times
        cos(angle), x = s sin(angle), are regular and are interpolated linearly between nodes.
        """
        scaled = np.abs(self.x) / self.half_widths[0]
        inside = np.flatnonzero(scaled < share * (1 - _TELLING))
        x, signs = scaled[inside, None], np.sign(self.x[inside, None])
        s = x + (share - x) * _POINTS**2
        measure = 2 * _WEIGHTS * np.sqrt((share - x) / (s + x)) * s
        angles = np.arcsin(signs * x / s)
        powers = s ** (2 * np.arange(len(self.half_widths))[:, None, None])
        result = np.zeros((2, len(self.half_widths), len(self.x)))
        places = (self.half_widths / self.half_widths[0]) ** 2
        for number, half_width in enumerate(self.half_widths):
            others = np.delete(places, number)
            share_of = measure * np.prod((s[..., None] ** 2 - others) / (places[number] - others), axis=-1)
            for along, forces in enumerate((self.normal[number], self.tangential[number])):
                regular = self._regular(angles, half_width, forces)
                result[along][:, inside] += (powers * (share_of * regular)).sum(axis=-1)
        return result * self.weights

    def _regular(self, angles: Array, half_width: float, forces: Array) -> Array:
        """Tractions times cos(angle) times the half-width at ``angles``, from the ``forces`` (n,) under a punch."""
        on = np.abs(self.x) < half_width * (1 - _TELLING)
        at = np.arcsin(self.x[on] / half_width)
        regular = forces[on] / self.weights[on] * np.cos(at) * half_width
        # nodes beside the end are inaccurate due to the singularity; coarse meshes have no others
        beside = min(3, len(regular)) - 1
        regular[:2], regular[-2:] = regular[beside], regular[-1 - beside]
        result: Array = np.interp(angles, at, regular)
        return result
