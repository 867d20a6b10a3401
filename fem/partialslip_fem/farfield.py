"""Displacements of a half-plane at the outer boundary of a block, under the contact's nodal forces."""

import math
from dataclasses import dataclass

import numpy as np

from partialslip.tools.arrays import Array


@dataclass(frozen=True)
class FarField:
    """Displacements of the outer boundary: ``fields`` (2 k, 2 t) times ``moments`` (2 t, 2 n) times nodal forces."""

    fields: Array
    moments: Array

    @property
    def along_y(self) -> "FarField":
        """The far field of forces along y alone: ``fields`` (2 k, t) and ``moments`` (t, n)."""
        count, nodes = (size // 2 for size in self.moments.shape)
        return FarField(self.fields[:, count:], self.moments[count:, nodes:])


def half_plane(points: Array, x: Array, width: float, kappa: float, compliance: float = 1.0) -> FarField:
    """Displacements of a half-plane at ``points`` (2, k) under forces at ``x`` (n,), in powers of x/width.

    ``width`` is the distance of the nearest point. The neglected powers are less than 1e-15, relative. ``kappa`` and
    ``compliance`` as for :class:`partialslip_fem.elasticity.Body`.
    """
    count = math.ceil(math.log(1e15) / math.log(width / np.abs(x).max()))
    powers = (x / width) ** np.arange(count)[:, None]
    zero = np.zeros_like(powers)
    return FarField(compliance * _multipoles(points, kappa, width, count), np.block([[powers, zero], [zero, powers]]))


def _multipoles(points: Array, kappa: float, width: float, count: int) -> Array:
    """Displacements at ``points`` (2, k) of the half-plane y <= 0 under moments of forces on its surface.

    Returns a (2 k, 2 count) array: rows are displacements along x, then along y. Column j belongs to the moment
    sum X (s/width)^j of forces X along x at s, column count + j to the same moment of forces along y. mu = (kappa+1)/2.

    A force F = X + iY at s has Kolosov's potentials phi = -F log(z-s)/(2 pi), psi = conj(F) log(z-s)/(2 pi)
    (Flamant's solution in Muskhelishvili's form), so that with 2 mu w = kappa phi - (z-s) conj(phi') - conj(psi)

        4 pi mu w = -F (kappa log(z-s) + conj(log(z-s))) + conj(F) (z-s)/conj(z-s),

    expanded here in powers of s. The logarithm is cut above the half-plane.
    """
    z = (points[0] + 1j * points[1])[:, None] / width
    k = np.arange(count)
    logarithm = np.where(k == 0, np.log(1j * z), -(z**-k) / np.maximum(k, 1))
    ratio = z * z.conj() ** -(k + 1) - np.where(k == 0, 0, z.conj() ** -k)
    same = -(kappa * logarithm + logarithm.conj())
    along_x, along_y = same + ratio, 1j * same - 1j * ratio
    fields = np.hstack([along_x, along_y]) / (2 * np.pi * (kappa + 1))
    return np.vstack([fields.real, fields.imag])
