"""Hertz pressure in the paper's closed and elliptic forms; scaled as in :mod:`partialslip.halfplane.shape`."""

import numpy as np
import numpy.typing as npt

from partialslip.halfplane.shape import Conditions, Shape
from partialslip.tools.arrays import Array


class HertzShape(Shape):
    """Hertz pressure, p/p0 = sqrt(1 - x^2)."""

    def pressure(self, x: Array) -> Array:
        return np.sqrt(np.maximum((1 - x) * (1 + x), 0.0))

    def difference(self, t: Array, x: Array) -> Array:
        total = self.pressure(t) + self.pressure(x)
        return -(t + x) / np.where(total == 0, np.inf, total)

    def conditions(self, edge: Array, c: Array, s: Array) -> Conditions:
        """Loads of the stick zone: paper, eqs. (21), (22) and (24)-(26).

        The paper's two Pi are related: the difference of the two integrals is a residue at infinity. They are replaced
        by X = K - Pi((m-1)/(m+1)), which is small with ``edge``. Terms that are small with c or edge are formed without
        cancellation.
        """
        edge, c, s = np.broadcast_arrays(np.asarray(edge, float), c, s)
        large = s < 0
        small = Conditions(8 * (1 - c - edge), (1 - c) * (1 + c), c.copy(), c.copy(), np.zeros_like(c))
        if not large.any():
            return small
        if large.all():
            return _opposite(edge, c)
        for values, found in zip(small, _opposite(edge[large], c[large]), strict=True):
            values[large] = found
        return small

    def guess(self, Qf: Array, sf: Array) -> tuple[Array, Array, npt.NDArray[np.bool_]]:
        """First iterate of the stick zone: s * edge, c, and a mask of the iterates that are exact for Hertz.

        Exact for small tension (paper, eqs. (21) and (22)): the centre is -sf/8. For large tension an interpolation
        between the transition and the limit of narrow stick zones.
        """
        c = np.sqrt(1 - Qf)
        edge = Qf / (1 + c) - sf / 8  # 1 - c - sf/8 without cancellation
        large = edge < 0
        if not large.any():
            return edge, c, ~large
        c_touching = c[large]
        b, decay = _narrow(Qf[large], -8 * edge[large])
        c[large] = c_touching * decay
        centre = -np.sin(b) + (c_touching - 1 + np.sin(b)) * decay
        edge[large] = -np.clip(1 + centre - c[large], 1e-6 * (1 - c[large]), 1 - c[large])
        return edge, c, ~large

    def sloped_guess(self, Qf: Array, sf: Array, gf: Array) -> tuple[Array, Array, npt.NDArray[np.bool_]]:
        """:meth:`guess` under a change of tension that varies as ``gf`` x: the stick zone for small tension is that of
        a contact whose curvature is 1 + gf/8 times as large."""
        stiffness = 1 + gf / 8
        c = np.sqrt((1 - Qf) / stiffness)
        edge = (Qf + gf / 8) / stiffness / (1 + c) - sf / (8 * stiffness)
        large = edge < 0
        touching = c[large]
        b, decay = _narrow(np.abs(Qf[large]), -8 * stiffness[large] * edge[large])
        c[large] = touching * decay
        middle = -np.copysign(np.sin(b), Qf[large])
        centre = middle + (touching - 1 - middle) * decay
        edge[large] = -np.clip(1 + centre - c[large], 1e-6 * (1 - c[large]), (2 - 1e-6) * (1 - c[large]))
        return edge, c, ~large


def _narrow(Qf: Array, beyond: Array) -> tuple[Array, Array]:
    """b of narrow stick zones, whose centre is at -sin(b), and about the factor by which tension reduces the half-width
    ``beyond`` the transition; b + sin(b) cos(b) = pi/2 Qf from the condition on dQ."""
    y = np.pi / 2 * Qf
    b = y / 2
    for _ in range(3):
        b = np.clip(b - (b + np.sin(2 * b) / 2 - y) / (1 + np.cos(2 * b) + 1e-9), 0.0, np.pi / 2)
    return b, np.exp(np.maximum(-np.pi * beyond / (16 * np.maximum(np.cos(b), 1e-3)), -230.0))


def _opposite(edge: Array, c: Array) -> Conditions:
    """Loads for large tension, eqs. (24)-(26); the modulus chi of K and E has 1 - chi^2 = 4 c/((1+m)(1+n))."""
    from scipy.special import ellipe, ellipkm1, elliprj  # takes long to import

    centre, from_left = edge + c - 1, edge + 2 * c  # 1 + n
    square = (2 - edge) * from_left  # (1+m)(1+n)
    root, complement = np.sqrt(square), 4 * c / square
    K, E = ellipkm1(complement), ellipe(1 - complement)
    X = edge / (2 - edge) / 3 * elliprj(0.0, complement, 1.0, 2 / (2 - edge))
    first = -2 * root * E + (4 * from_left * K - 8 * centre * X) / root - np.pi * centre
    second = -centre * root * E + (1 - c) * ((4 * (1 + c) * X - 2 * from_left * K) / root + np.pi / 2 * (1 + c))
    right = c + 2 / np.pi * (root * E - 4 * c * (K - X) / root)
    skew = 2 + 8 * (2 * X - K) / (np.pi * root)
    return Conditions(8 / np.pi * first, 2 / np.pi * second, right, right - c * skew, skew)
