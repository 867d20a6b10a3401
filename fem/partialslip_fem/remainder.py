"""What a body of a size adds to the stresses of a half-plane under the same tractions on its contact line.

Elements follow the stresses near the contact poorly, as the tractions end like square roots. So stresses are those of a
half-plane, from Cauchy integrals of the tractions, and elements approximate the remainder alone, on a mesh of its own
(:func:`partialslip_fem.surroundings.left_over`): it is smooth, as it comes from the other sides of the body.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import skfem
from numpy.polynomial import chebyshev
from scipy.interpolate import PPoly

from partialslip.tools.arrays import Array, Indices
from partialslip_fem.bodies import Grading, block_of
from partialslip_fem.elasticity import triangles_of
from partialslip_fem.elements import ELEMENTS
from partialslip_fem.factor import Backend
from partialslip_fem.locate import Locator
from partialslip_fem.problem import Part
from partialslip_fem.surroundings import left_over
from partialslip_meshes import Mesh

_PLACES = 24  # accuracy: forces that stand for the tractions far from the contact
_SIZE, _GROWTH, _CORNERS, _FACETS = 0.1, 0.25, 1e-7, 1e-5  # accuracy: of the mesh, in the smallest half-width or height
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(_PLACES // 2 + 4)


@dataclass(frozen=True)
class Remainder:
    """Displacements of a body on ``mesh``, which lies below its contact line, in s states; scaled.

    Parameters
    ----------
    part : Part
    mesh : Mesh
    order : int
    fields : (r, 2, N) array
        Displacements of all nodes.
    weights : (s, r) array
        Of the fields, by state.
    face : (2, n) array
        Nodes of the side with the contact line, ascending in x.
    """

    part: Part
    mesh: Mesh
    order: int
    fields: Array
    weights: Array
    face: Array

    @classmethod
    def of(
        cls, part: Part, width: float, order: int, tractions: PPoly, way: int, strains: Array, backend: Backend
    ) -> "Remainder":
        """Remainder of a finite body, or of a block of the half-width ``width`` that is clamped.

        Parameters
        ----------
        part : Part
        width : float
        order : int
            Order of the elements.
        tractions : PPoly
            Pressures, then shears that the body below exerts, in s states, (2 s) in the last axis.
        way : int
            1 for the lower body, -1 for the upper body.
        strains : (s,) array
            Bulk strains of a body that is pulled at its end.
        backend : "superlu" or "cholmod"
        """
        left, right = float(tractions.x[0]), float(tractions.x[-1])
        places = (left + right) / 2 + (right - left) / 2 * chebyshev.chebpts1(_PLACES)
        smallest = min(part.extent or (width,))
        reach = max(-left, right)
        grading = Grading((-reach, reach), {0.0: _SIZE * smallest}, _GROWTH, None, _FACETS, _CORNERS)
        mesh = part.mesh or block_of(part, width, grading)
        own, known = left_over(part, mesh, order, places, backend)
        normal, shear = np.array_split(_forces(tractions), 2)
        weights = np.concatenate([-way * shear, -normal, 4 / part.compliance * strains[:, None]], axis=1)
        fields = own.inner_nodes.everywhere(known.T.reshape(2 * _PLACES + 1, 2, -1))
        return cls(part, mesh, order, fields, weights, own.points[:, own.face])

    def stresses(self, x: Array, y: Array, states: list[int]) -> Array:
        """Stresses (s, 3, k) at points below the face, in ``states``; NaN outside the mesh."""
        y = np.minimum(y, np.interp(x, *self.face))  # sides of elements are straight
        cells, local = self._locator(np.column_stack([x, y]))
        known = cells >= 0
        result = np.full((len(states), 3, len(x)), np.nan)
        moved = np.tensordot(self.weights[states], self.fields, 1)
        result[..., known] = self._strained(moved, cells[known], local[:, known])
        return result

    @cached_property
    def _locator(self) -> Locator:
        triangles = self._basis.mesh  # its corners are in another order than those of the mesh
        return Locator(triangles.p.T, triangles.t.T)

    @cached_property
    def _basis(self) -> skfem.Basis:
        return skfem.Basis(triangles_of(self.mesh), ELEMENTS[self.order](), intorder=1)

    def _strained(self, moved: Array, cells: Indices, local: Array) -> Array:
        """Stresses (s, 3, k) of displacements (s, 2, N) at ``local`` coordinates (2, k) in ``cells`` (k,)."""
        basis, (kappa, compliance) = self._basis, (self.part.kappa, self.part.compliance)
        gradient = np.zeros((*moved.shape[:2], 2, len(cells)))
        for number in range(basis.Nbfun):
            slope = basis.elem.gbasis(basis.mapping, local[:, :, None], number, tind=cells)[0].grad[..., 0]
            gradient += moved[:, :, None, basis.element_dofs[number, cells]] * slope
        (xx, xy), (yx, yy) = np.moveaxis(gradient, 0, 2)
        mu = (kappa + 1) / (2 * compliance)
        volume = mu * (3 - kappa) / (kappa - 1) * (xx + yy)
        return np.stack([volume + 2 * mu * xx, volume + 2 * mu * yy, mu * (xy + yx)], axis=1)


def _forces(tractions: PPoly) -> Array:
    """Forces (2 s, l) at the Chebyshev points of the contact line with the moments of the ``tractions``."""
    ends = tractions.x
    half = np.diff(ends)[:, None] / 2
    x = ends[:-1, None] + half * (1 + _NODES)
    scaled = (2 * x - ends[0] - ends[-1]) / (ends[-1] - ends[0])
    values = chebyshev.chebvander(scaled.ravel(), _PLACES - 1)
    moments = np.einsum("cgs,cg,cgk->sk", tractions(x), half * _WEIGHTS, values.reshape(*x.shape, -1), optimize=True)
    back = chebyshev.chebvander(chebyshev.chebpts1(_PLACES), _PLACES - 1) * 2 / _PLACES
    back[:, 0] /= 2
    return moments @ back.T
