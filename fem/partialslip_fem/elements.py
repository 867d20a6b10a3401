"""Triangles of any order in scikit-fem, with evenly spaced nodes."""

from functools import lru_cache

import numpy as np
import skfem
from numpy.polynomial import Polynomial
from skfem.refdom import RefTri

from partialslip.arrays import Array


class Lagrange(skfem.ElementH1):
    """Lagrange's polynomials of a given order on evenly spaced nodes.

    The node at the barycentric coordinates (i, j, l)/k has the shape function P_i P_j P_l, where P_i is the polynomial
    of degree i in its coordinate that is zero at 0, 1/k ... (i - 1)/k and one at i/k (Silvester 1969).
    """

    nodal_dofs = 1
    refdom = RefTri

    def __init__(self, order: int) -> None:
        k = self.maxdeg = order
        self.facet_dofs, self.interior_dofs = k - 1, (k - 1) * (k - 2) // 2
        self.dofnames = ["u"] * (1 + self.facet_dofs + self.interior_dofs)
        along = range(1, k)
        edges = [[(i, 0) for i in along], [(k - i, i) for i in along], [(0, i) for i in along]]
        inside = [(i, j) for j in along for i in range(1, k - j)]
        self._places = [(0, 0), (k, 0), (0, k), *sum(edges, []), *inside]
        self.doflocs = np.array(self._places) / k
        zeros = [Polynomial([1.0])]
        for i in along:
            zeros.append(zeros[-1] * Polynomial([1 - i, k]) / i)
        zeros.append(zeros[-1] * Polynomial([1 - k, k]) / k)
        self._in_one = [(each, each.deriv()) for each in zeros]

    def lbasis(self, X: Array, i: int) -> tuple[Array, Array]:
        """Shape function ``i`` at the points ``X`` (2, ...), and its gradient, (2, ...)."""
        along_x, along_y = self._places[i]
        last = self.maxdeg - along_x - along_y
        (p, dp), (q, dq), (r, dr) = (
            tuple(polynomial(at) for polynomial in self._in_one[degree])
            for degree, at in ((along_x, X[0]), (along_y, X[1]), (last, 1 - X[0] - X[1]))
        )
        return p * q * r, np.array([dp * q * r - p * q * dr, p * dq * r - p * q * dr])
