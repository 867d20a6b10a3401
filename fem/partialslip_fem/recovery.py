"""Piecewise polynomials along the contact line from nodal forces and nodal values."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PPoly

from partialslip.arrays import Array
from partialslip_fem.elasticity import Body
from partialslip_fem.elements import nodes_of


def traction(body: Body, forces: Array) -> PPoly:
    """Traction on the contact line of ``body`` that is equivalent to nodal ``forces`` (n,), of the elements' order.

    Nodal forces are integrals of the traction times shape functions. Dividing by the integrals of the shape functions
    would give an oscillating error of h^2 p''; the mass matrix inverts the integrals and preserves the resultant.
    """
    return polynomials(body.x, body.mass_factor.solve(forces), body.order)


def polynomials(x: Array, values: Array, order: int) -> PPoly:
    """Piecewise polynomials of ``order`` through ``values`` at ``x``, (n,) each; every ``order``-th x is a vertex."""
    k, vertices = order, x[::order]
    cells = np.lib.stride_tricks.sliding_window_view(values, k + 1)[::k]
    coefficients = np.linalg.solve(np.vander(nodes_of(k)), cells.T)
    return PPoly(coefficients / np.diff(vertices) ** np.arange(k, -1, -1)[:, None], vertices)


def inside_elements(polynomial: PPoly | None, points: Array) -> Array:
    """Values of ``polynomial`` at ``points`` (k,); zero off its cells, and everywhere if it is None."""
    if polynomial is None:
        return np.zeros_like(points)
    values: Array = np.nan_to_num(polynomial(points, extrapolate=False), nan=0.0)
    return values


@dataclass(frozen=True)
class Pair:
    """Two scaled tractions along the contact line, ``first`` and ``second``; None is zero.

    Lengths are scaled by ``length`` (m) from the ``origin`` (m), stresses by ``stress`` (Pa).
    """

    first: PPoly | None
    second: PPoly | None
    length: float
    stress: float
    origin: float = 0.0

    def at(self, x: Array) -> tuple[Array, Array]:
        """Both tractions at ``x`` (k,), m, in Pa; zero off their cells."""
        points = (x - self.origin) / self.length
        return self.stress * inside_elements(self.first, points), self.stress * inside_elements(self.second, points)
