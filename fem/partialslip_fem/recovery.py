"""Piecewise polynomials along the contact line from nodal forces and nodal values."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PPoly

from partialslip.friction.contact_line import ContactLine
from partialslip.result import TractionAt
from partialslip.tools.arrays import Array
from partialslip_fem.elasticity import DiscreteBody
from partialslip_fem.elements import nodes_of


def traction(body: DiscreteBody, forces: Array) -> PPoly:
    """Traction on the contact line of ``body`` that is equivalent to nodal ``forces`` (n,), of the elements' order.

    Nodal forces are integrals of the traction times shape functions. Dividing by the integrals of the shape functions
    would give an oscillating error of h^2 p''; the mass matrix inverts the integrals and preserves the resultant.
    """
    return polynomials(body.x, body.mass_factor.solve(forces), body.order)


def contact_line(body: DiscreteBody, beta: float = 0.0) -> ContactLine:
    """The contact line of ``body``, for Dundurs' ``beta``: cells bear the integrals of the equivalent traction."""
    vertices = body.x[:: body.order]

    def left_of(forces: Array, points: Array) -> Array:
        resultant: Array = traction(body, forces).antiderivative()(points)
        return resultant

    def cell_forces(forces: Array) -> Array:
        return np.diff(left_of(forces, vertices))

    return ContactLine(body.x, body.weights, vertices, beta, cell_forces, left_of)


def polynomials(x: Array, values: Array, order: int) -> PPoly:
    """Piecewise polynomials of ``order`` through ``values`` at ``x``, (n,) each; every ``order``-th x is a vertex."""
    k, vertices = order, x[::order]
    cells = np.lib.stride_tricks.sliding_window_view(values, k + 1)[::k]
    coefficients = np.linalg.solve(np.vander(nodes_of(k)), cells.T)
    return PPoly(coefficients / np.diff(vertices) ** np.arange(k, -1, -1)[:, None], vertices)


@dataclass(frozen=True)
class Polynomials:
    """Tractions as scaled piecewise polynomials: ``p`` and ``p1`` at load points 2 and 1 (None if the same), and the
    ``shear`` at load points 1 and 2, None for zero; ``known`` says whether it is that, or only its change counts.

    Lengths are scaled by ``length`` (m) from the ``origin`` (m), stresses by ``stress`` (Pa).
    """

    p: PPoly
    shear: tuple[PPoly, PPoly] | None
    p1: PPoly | None
    known: bool
    length: float
    stress: float
    origin: float

    def at(self, x: Array) -> TractionAt:
        """p, q1 and q2 (Pa) at ``x`` (k,), m; zero outside the cells of the polynomials."""
        return self.scaled((x - self.origin) / self.length)

    def scaled(self, x: Array) -> TractionAt:
        """Tractions at ``x`` (k,), scaled, in Pa; zero off their cells."""
        q1, q2 = (
            (self._values_on_cells(each, x) for each in self.shear)
            if self.shear
            else (np.zeros_like(x), np.zeros_like(x))
        )
        p1 = None if self.p1 is None else self._values_on_cells(self.p1, x)
        return TractionAt.between(self._values_on_cells(self.p, x), q1, q2, self.known, p1)

    def _values_on_cells(self, polynomial: PPoly, x: Array) -> Array:
        return self.stress * inside_elements(polynomial, x)


def inside_elements(polynomial: PPoly, points: Array) -> Array:
    """Values of ``polynomial`` at ``points`` (k,); zero off its cells."""
    return np.nan_to_num(polynomial(points, extrapolate=False), nan=0.0)
