"""Triangles for scikit-fem, of the orders that it has and of higher ones."""

from collections.abc import Callable
from functools import lru_cache, partial

import numpy as np
import skfem
from numpy.polynomial import Legendre, Polynomial
from skfem.refdom import RefTri

from partialslip.tools.arrays import Array

_EVEN = 4  # fixed: highest order with evenly spaced nodes on the edges


class _Lobatto(skfem.ElementH1):  # type: ignore[misc]
    """Lagrange's polynomials of the given ``order`` on nodes that are Lobatto's on the edges.

    With evenly spaced nodes of a high order, forces on nodes may have other signs than the traction that they stand
    for. Nodes inside follow from those of the edges (Blyth and Pozrikidis 2006).
    """

    nodal_dofs = 1
    refdom = RefTri

    def __init__(self, order: int) -> None:
        k = self.maxdeg = order
        self.facet_dofs, self.interior_dofs = k - 1, (k - 1) * (k - 2) // 2
        self.dofnames = ["u"] * (1 + self.facet_dofs + self.interior_dofs)
        along = range(1, k)
        edges = [(i, 0) for i in along] + [(k - i, i) for i in along] + [(0, i) for i in along]
        inside = [(i, j) for j in along for i in range(1, k - j)]
        places = np.array([(0, 0), (k, 0), (0, k), *edges, *inside])
        self._degrees = np.column_stack([places, k - places.sum(axis=1)])
        spaced = nodes_of(k)[self._degrees]
        self.doflocs = ((1 + 3 * spaced - spaced.sum(axis=1, keepdims=True)) / 3)[:, :2]
        # On evenly spaced nodes, that at the barycentric coordinates (i, j, l)/k has the shape function P_i P_j P_l,
        # where P_i is of degree i in its coordinate, zero at 0, 1/k ... (i - 1)/k and one at i/k (Silvester 1969).
        even = [Polynomial([1.0])]
        for i in range(1, k + 1):
            even.append(even[-1] * Polynomial([1 - i, k]) / i)
        self._even = [(each, each.deriv()) for each in even]
        self._shapes = np.linalg.inv(self._products(self.doflocs.T)[0]).T

    def lbasis(self, X: Array, i: int) -> tuple[Array, Array]:
        """Shape function ``i`` at the points ``X`` (2, ...), and its gradient, (2, ...)."""
        values, gradients = self._products(X)
        return np.tensordot(self._shapes[:, i], values, 1), np.tensordot(self._shapes[:, i], gradients, (0, 1))

    def _products(self, X: Array) -> tuple[Array, Array]:
        """Shape functions of the evenly spaced nodes at ``X`` (2, ...), (n, ...), and their gradients, (2, n, ...)."""
        (p, dp), (q, dq), (r, dr) = (
            tuple(np.array([each[way](at) for each in self._even])[degrees] for way in (0, 1))
            for at, degrees in zip((*X, 1 - X[0] - X[1]), self._degrees.T, strict=True)
        )
        return p * q * r, np.array([dp * q * r - p * q * dr, p * dq * r - p * q * dr])


ELEMENTS: dict[int, Callable[[], skfem.Element]] = {
    1: skfem.ElementTriP1,
    2: skfem.ElementTriP2,
    3: skfem.ElementTriP3,
    4: skfem.ElementTriP4,
    5: partial(_Lobatto, 5),
    6: partial(_Lobatto, 6),
}


@lru_cache
def nodes_of(order: int) -> Array:
    """Nodes of an edge of elements of ``order``, from 0 to 1, (order + 1,)."""
    if order <= _EVEN:
        return np.linspace(0, 1, order + 1)
    inner = Legendre.basis(order).deriv().roots()
    return (1 + np.array([-1.0, *inner, 1.0])) / 2


def shapes(order: int, x: Array) -> Array:
    """Shape functions of the nodes of an edge at ``x`` (n,) in [0, 1], (n, order + 1)."""
    return np.vander(x, order + 1) @ np.linalg.inv(np.vander(nodes_of(order)))
