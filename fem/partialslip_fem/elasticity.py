"""The elastic body: triangles of order 1 to 4 in scikit-fem, scaled so that the pair's compliance A is 1."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp
import skfem

from partialslip.result import Array
from partialslip_meshes import Mesh

_ELEMENTS = {1: skfem.ElementTriP1, 2: skfem.ElementTriP2, 3: skfem.ElementTriP3, 4: skfem.ElementTriP4}
Indices = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Body:
    """A discretised body: stiffness, and where its contact line and outer boundary are.

    Parameters
    ----------
    order : int
        Of the elements' polynomials.
    stiffness : (2 N, 2 N) sparse matrix
        Degrees of freedom are the displacements of all nodes along x, then those along y.
    x : (n,) array
        Nodes on the contact line, ascending; between two corners lie ``order`` - 1 evenly spaced ones.
    mass : (n, n) sparse matrix
        Integrals of products of their shape functions along the line. Its row sums are the closed Newton-Cotes
        weights, all positive up to order 4, so that nodal forces have the signs of tractions.
    contact, far, vertices : (2, n), (2, k), (2, v) int arrays
        Degrees of freedom, along x and along y, of the contact line, the outer boundary and the mesh's points.
    far_points : (2, k) array
        Nodes of the outer boundary.
    """

    order: int
    stiffness: sp.csr_matrix
    x: Array
    mass: sp.csr_matrix
    contact: Indices
    far: Indices
    vertices: Indices
    far_points: Array


@skfem.BilinearForm
def _xx(u, v, _):  # type: ignore[no-untyped-def]
    return u.grad[0] * v.grad[0]


@skfem.BilinearForm
def _xy(u, v, _):  # type: ignore[no-untyped-def]
    return u.grad[1] * v.grad[0]


@skfem.BilinearForm
def _yy(u, v, _):  # type: ignore[no-untyped-def]
    return u.grad[1] * v.grad[1]


@skfem.BilinearForm
def _product(u, v, _):  # type: ignore[no-untyped-def]
    return u * v


def body(mesh: Mesh, kappa: float, order: int) -> Body:
    """Assemble a body whose Kolosov constant is ``kappa`` (it says plane strain or stress), at compliance A = 1."""
    triangles = skfem.MeshTri(mesh.points.T.copy(), mesh.triangles.T.copy())
    element = _ELEMENTS[order]()
    # gradients are of order - 1, and straight triangles have constant Jacobians: this quadrature is exact
    basis = skfem.Basis(triangles, element, intorder=2 * (order - 1))
    both = np.array([[0], [basis.N]])

    def on_line(name: str) -> Indices:
        nodes = basis.get_dofs(_facets(triangles, mesh.lines[name])).flatten()
        in_order: Indices = nodes[np.argsort(basis.doflocs[0, nodes], kind="stable")]
        return in_order

    contact, far = on_line("contact"), on_line("far")
    along = skfem.FacetBasis(triangles, element, facets=_facets(triangles, mesh.lines["contact"]))
    return Body(
        order=order,
        stiffness=_stiffness(basis, kappa),
        x=basis.doflocs[0, contact],
        mass=_product.assemble(along)[contact][:, contact],
        contact=contact + both,
        far=far + both,
        vertices=basis.nodal_dofs[0] + both,
        far_points=basis.doflocs[:, far],
    )


def _stiffness(basis: skfem.Basis, kappa: float) -> sp.csr_matrix:
    """Plane isotropic elasticity from the three products of scalar gradients: far cheaper than vector elements."""
    mu = (kappa + 1) / 2
    lam = mu * (3 - kappa) / (kappa - 1)
    xx, xy, yy = (form.assemble(basis) for form in (_xx, _xy, _yy))
    across = lam * xy + mu * xy.T
    return sp.block_array(
        [[(lam + 2 * mu) * xx + mu * yy, across], [across.T, (lam + 2 * mu) * yy + mu * xx]], format="csr"
    )


def _facets(triangles: skfem.MeshTri, lines: Indices) -> Indices:
    """Numbers of the facets with the given end points."""
    count = triangles.p.shape[1]
    ends = np.sort(lines, axis=1)
    known = triangles.facets[0].astype(np.int64) * count + triangles.facets[1]
    order = np.argsort(known)
    found: Indices = order[np.searchsorted(known, ends[:, 0] * count + ends[:, 1], sorter=order)]
    return found
