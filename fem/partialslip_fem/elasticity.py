"""The elastic body: triangles of order 1 to 4 in scikit-fem, scaled by a pair's compliance A."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp
import scipy.sparse.linalg as spla
import skfem

from partialslip.arrays import Array
from partialslip_meshes import Mesh

ELEMENTS = {1: skfem.ElementTriP1, 2: skfem.ElementTriP2, 3: skfem.ElementTriP3, 4: skfem.ElementTriP4}
Indices = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Body:
    """A discretised body: stiffness, contact line and outer boundary.

    Parameters
    ----------
    order : int
        Polynomial order of the elements.
    kappa, compliance : float
        Kolosov's constant, which differs in plane strain and plane stress, and (kappa+1)/(2 mu).
    stiffness : (2 N, 2 N) sparse matrix
        Degrees of freedom are the displacements of all nodes along x, then those along y.
    x : (n,) array
        Nodes on the contact line, ascending; between two vertices lie ``order`` - 1 evenly spaced nodes.
    mass : (n, n) sparse matrix
        Integrals over x of products of the contact line's shape functions. The row sums are the closed Newton-Cotes
        weights, positive up to order 4, so that nodal forces have the signs of tractions.
    contact, vertices : (2, n), (2, v) int arrays
        Degrees of freedom, along x and along y, of the contact line and the mesh's points.
    held : (k,) int array
        Held degrees of freedom, first along x, then along y.
    points : (2, N) array
        All nodes.
    face : (s,) int array
        Nodes of the whole side with the contact line, from left to right.
    pull : (2 N,) array or None
        Nodal forces of a unit tension on the right side, if the body is pulled there.
    """

    order: int
    kappa: float
    compliance: float
    stiffness: sp.csr_matrix
    x: Array
    mass: sp.csr_matrix
    contact: Indices
    held: Indices
    vertices: Indices
    points: Array
    face: Indices
    pull: Array | None = None

    @property
    def weights(self) -> Array:
        """Length of the contact line per node, (n,): row sums of ``mass``. Traction times weight is the nodal force."""
        result: Array = np.asarray(self.mass.sum(axis=1)).ravel()
        return result

    @cached_property
    def mass_factor(self) -> spla.SuperLU:
        """Factor of ``mass``."""
        return spla.splu(self.mass.tocsc())

    @property
    def held_points(self) -> Array:
        """Coordinates of the nodes held along x, (2, h)."""
        result: Array = self.points[:, self.held[self.held < self.points.shape[1]]]
        return result

    @property
    def face_x(self) -> Array:
        """x of the nodes of the face, (s,)."""
        result: Array = self.points[0, self.face]
        return result


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
def _product(u, v, w):  # type: ignore[no-untyped-def]
    return u * v * np.abs(w.n[1])


@skfem.LinearForm
def _tension(v, w):  # type: ignore[no-untyped-def]
    return v * w.n[0]


Held = tuple[Sequence[str], Sequence[str]]
ALL_AROUND = ("back", "left", "right")


def body(
    mesh: Mesh,
    kappa: float,
    order: int,
    compliance: float = 1.0,
    held: Held = (ALL_AROUND, ALL_AROUND),
    pulled: bool = False,
) -> Body:
    """Assemble a body on ``mesh``.

    Parameters
    ----------
    mesh : Mesh
    kappa, order, compliance
        As for :class:`Body`.
    held : two of sequence of str
        Lines of the mesh that are held along x, and along y.
    pulled : bool
        Whether to assemble the nodal forces of a tension on the right side.
    """
    triangles, element = triangles_of(mesh), ELEMENTS[order]()
    # gradients are of order - 1, and straight triangles have constant Jacobians: this quadrature is exact
    basis = skfem.Basis(triangles, element, intorder=2 * (order - 1))
    both = np.array([[0], [basis.N]])

    def on(lines: Indices) -> Indices:
        nodes = basis.get_dofs(facets_of(triangles, lines)).flatten()
        in_order: Indices = nodes[np.argsort(basis.doflocs[0, nodes], kind="stable")]
        return in_order

    line = mesh.lines["contact"]
    contact, face = on(line), on(np.concatenate([line, mesh.lines.get("face", line)]))
    along_x, along_y = (on(np.concatenate([mesh.lines[name] for name in names])) for names in held)
    along = skfem.FacetBasis(triangles, element, facets=facets_of(triangles, line))
    pull = None
    if pulled:
        end = skfem.FacetBasis(triangles, element, facets=facets_of(triangles, mesh.lines["right"]))
        pull = np.concatenate([_tension.assemble(end), np.zeros(basis.N)])
    return Body(
        order=order,
        kappa=kappa,
        compliance=compliance,
        stiffness=_stiffness(basis, kappa, compliance),
        x=basis.doflocs[0, contact],
        mass=_product.assemble(along)[contact][:, contact],
        contact=contact + both,
        held=np.concatenate([along_x, basis.N + along_y]),
        vertices=basis.nodal_dofs[0] + both,
        points=basis.doflocs,
        face=face,
        pull=pull,
    )


def gradients(mesh: Mesh, order: int, u: Array) -> Array:
    """Gradients of ``u`` (c, N) in the middle of the triangles of ``mesh``, (c, 2, t); elements of ``order``."""
    middle = np.full((2, 1), 1 / 3), np.full(1, 1 / 2)
    basis = skfem.Basis(triangles_of(mesh), ELEMENTS[order](), quadrature=middle)
    return np.stack([basis.interpolate(component).grad[..., 0] for component in u])


def triangles_of(mesh: Mesh) -> skfem.MeshTri:
    """The triangles of ``mesh``."""
    return skfem.MeshTri(mesh.points.T.copy(), mesh.triangles.T.copy())


def _stiffness(basis: skfem.Basis, kappa: float, compliance: float) -> sp.csr_matrix:
    """Stiffness of plane isotropic elasticity, from scalar forms: far cheaper than vector elements."""
    mu = (kappa + 1) / (2 * compliance)
    lam = mu * (3 - kappa) / (kappa - 1)
    xx, xy, yy = (form.assemble(basis) for form in (_xx, _xy, _yy))
    across = lam * xy + mu * xy.T
    return sp.block_array(
        [[(lam + 2 * mu) * xx + mu * yy, across], [across.T, (lam + 2 * mu) * yy + mu * xx]], format="csr"
    )


def facets_of(triangles: skfem.MeshTri, lines: Indices) -> Indices:
    """Indices of the facets with the end points ``lines`` (k, 2)."""
    count = triangles.p.shape[1]
    ends = np.sort(lines, axis=1)
    known = triangles.facets[0].astype(np.int64) * count + triangles.facets[1]
    order = np.argsort(known)
    found: Indices = order[np.searchsorted(known, ends[:, 0] * count + ends[:, 1], sorter=order)]
    return found
