"""Functions along the contact line from what is known at its nodes."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse.linalg as spla
from scipy.interpolate import PPoly

from partialslip.arrays import Array
from partialslip_fem.elasticity import Body


def traction(body: Body, forces: Array) -> PPoly:
    """The traction, of the elements' own order along the contact line, that is equivalent to nodal ``forces`` (n,).

    Nodal forces are integrals of the traction times shape functions. Dividing them by the integrals of the shape
    functions gives values that waver by h^2 p''; the mass matrix takes them back exactly, and keeps their resultant.
    """
    return polynomials(body.x, spla.spsolve(body.mass.tocsc(), forces), body.order)


def polynomials(x: Array, values: Array, order: int) -> PPoly:
    """Piecewise polynomials through ``values`` at nodes ``x``, every ``order``-th of which ends a cell."""
    k, vertices = order, x[::order]
    cells = np.lib.stride_tricks.sliding_window_view(values, k + 1)[::k]
    coefficients = np.linalg.solve(np.vander(np.linspace(0, 1, k + 1)), cells.T)
    return PPoly(coefficients / np.diff(vertices) ** np.arange(k, -1, -1)[:, None], vertices)


def inside(polynomial: PPoly | None, points: Array) -> Array:
    """Its values, zero off its cells."""
    if polynomial is None:
        return np.zeros_like(points)
    values: Array = np.nan_to_num(polynomial(points, extrapolate=False), nan=0.0)
    return values


@dataclass(frozen=True)
class Pair:
    """Two functions along the contact line, piecewise polynomials in lengths of ``length`` (m) and stresses of
    ``stress`` (Pa); None is zero."""

    first: PPoly | None
    second: PPoly | None
    length: float
    stress: float

    def at(self, x: Array) -> tuple[Array, Array]:
        """Both at ``x`` (m), Pa; zero off their cells."""
        points = x / self.length
        return self.stress * inside(self.first, points), self.stress * inside(self.second, points)
