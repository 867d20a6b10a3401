"""The elastic body: triangles in scikit-fem, scaled by a pair's compliance A."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla
import skfem

from partialslip.tools.arrays import Array, Indices
from partialslip_fem.elements import ELEMENTS, shapes
from partialslip_meshes import Mesh


@dataclass(frozen=True)
class InnerNodes:
    """Nodes inside elements, which no other element shares: eliminated from the stiffness, element by element.

    Parameters
    ----------
    around : (t, 2 o) int array
        Degrees of freedom on the sides of each triangle, along x, then along y.
    moved : (t, 2 i, 2 o) array
        Displacements of the nodes inside under unit displacements of those around, without forces inside.
    """

    around: Indices
    moved: Array

    @property
    def count(self) -> int:
        """Number of nodes inside elements."""
        return self.moved.shape[0] * self.moved.shape[1] // 2

    def everywhere(self, u: Array) -> Array:
        """Displacements of all nodes of scikit-fem's elements, (..., 2, N + count), from those of the nodes on sides,
        ``u`` (..., 2, N)."""
        along = u.reshape(*u.shape[:-2], -1)[..., self.around, None]
        inside = (self.moved @ along)[..., 0].reshape(*u.shape[:-2], len(self.moved), 2, -1)
        return np.concatenate([u, np.moveaxis(inside, -2, -3).reshape(*u.shape[:-1], -1)], axis=-1)


@dataclass(frozen=True)
class DiscreteBody:
    """A discretised body: stiffness, contact line and outer boundary.

    Its nodes are those on the sides of elements. Those inside have no forces, and their displacements follow from
    these.

    Parameters
    ----------
    order : int
        Polynomial order of the elements.
    kappa, compliance : float
        Kolosov's constant, which differs in plane strain and plane stress, and (kappa+1)/(2 mu).
    stiffness : (2 N, 2 N) sparse matrix
        Degrees of freedom are the displacements of all nodes along x, then those along y.
    inner_nodes : InnerNodes
        The nodes inside elements.
    x : (n,) array
        Nodes on the contact line, ascending; those of each cell lie as :func:`partialslip_fem.elements.nodes_of`.
    mass : (n, n) sparse matrix
        Integrals over x of products of the contact line's shape functions. The row sums are the weights of
        Newton and Cotes, positive up to order 4, or of Lobatto, so that nodal forces have the signs of tractions.
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
    gripped : (g,) int array
        Held degrees of freedom along x of a right side that a plate pulls; empty if it is free.
    """

    order: int
    kappa: float
    compliance: float
    stiffness: sp.csr_matrix
    inner_nodes: InnerNodes
    x: Array
    mass: sp.csr_matrix
    contact: Indices
    held: Indices
    vertices: Indices
    points: Array
    face: Indices
    pull: Array | None = None
    gripped: Indices = field(default_factory=lambda: np.empty(0, np.int64))

    @property
    def unknowns(self) -> int:
        """Number of degrees of freedom, with those inside elements."""
        return self.stiffness.shape[0] + 2 * self.inner_nodes.count

    def pulling(self) -> tuple[Array, Array]:
        """Displacements u of all nodes and nodal forces that pull the body along x, (2 N,) each.

        With a plate that grips the pulled side, u is 1 along x at the gripped nodes and 0 elsewhere, and the forces are
        -K u; without one u = 0, and the forces are those of a traction. :meth:`under_unit_tension` scales the response.
        """
        assert self.pull is not None
        moved = np.zeros(len(self.pull))
        moved[self.gripped] = 1.0
        return moved, -(self.stiffness @ moved) if len(self.gripped) else self.pull

    def under_unit_tension(self, u: Array) -> Array:
        """Displacements (2 N,) under a unit tension, from those that :meth:`pulling` causes, ``u`` (2 N,): the mean
        tension on a side that a plate moves follows from them."""
        assert self.pull is not None
        if not len(self.gripped):
            return u
        return u * (self.pull.sum() / (self.stiffness[self.gripped] @ u).sum())

    @property
    def weights(self) -> Array:
        """Length of the contact line per node, (n,): row sums of ``mass``. Traction times weight is the nodal force."""
        return np.asarray(self.mass.sum(axis=1)).ravel()

    @cached_property
    def mass_factor(self) -> spla.SuperLU:
        """Factor of ``mass``."""
        return spla.splu(self.mass.tocsc())

    @property
    def held_points(self) -> Array:
        """Coordinates of the nodes held along x, (2, h)."""
        return self.points[:, self.held[self.held < self.points.shape[1]]]

    @property
    def face_x(self) -> Array:
        """x of the nodes of the face, (s,)."""
        return self.points[0, self.face]


@skfem.LinearForm
def _tension(v, w):  # type: ignore[no-untyped-def]
    return v * w.n[0]


HeldSides = tuple[Sequence[str], Sequence[str]]
ALL_AROUND = ("back", "left", "right")


def body(
    mesh: Mesh,
    kappa: float,
    order: int,
    compliance: float = 1.0,
    held: HeldSides = (ALL_AROUND, ALL_AROUND),
    pulled: bool = False,
    gripped: bool = False,
) -> DiscreteBody:
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
    gripped : bool
        Whether a plate that is held pulls this side.
    """
    triangles, element = triangles_of(mesh), ELEMENTS[order]()
    basis = skfem.Basis(triangles, element, intorder=1)  # for the numbers of unknowns only
    stiffness, inner_nodes = _stiffness(basis, kappa, compliance)
    count = basis.N - inner_nodes.count
    both = np.array([[0], [count]])

    def on(lines: Indices) -> Indices:
        nodes = basis.get_dofs(facets_of(triangles, lines)).flatten()
        return nodes[np.argsort(basis.doflocs[0, nodes], kind="stable")]

    line = mesh.lines["contact"]
    contact, face = on(line), on(np.concatenate([line, mesh.lines.get("face", line)]))
    along_x, along_y = (on(np.concatenate([mesh.lines[name] for name in names])) for names in held)
    pull = None
    if pulled:
        end = skfem.FacetBasis(triangles, element, facets=facets_of(triangles, mesh.lines["right"]))
        pull = np.concatenate([_tension.assemble(end)[:count], np.zeros(count)])
    return DiscreteBody(
        order=order,
        kappa=kappa,
        compliance=compliance,
        stiffness=stiffness,
        inner_nodes=inner_nodes,
        x=basis.doflocs[0, contact],
        mass=_mass(basis.doflocs[0, contact], order),
        contact=contact + both,
        held=np.concatenate([along_x, count + along_y]),
        vertices=basis.nodal_dofs[0] + both,
        points=basis.doflocs[:, :count],
        face=face,
        pull=pull,
        gripped=on(mesh.lines["right"]) if gripped else np.empty(0, np.int64),
    )


def gradients(mesh: Mesh, order: int, u: Array) -> Array:
    """Gradients of ``u`` (c, N), at all nodes of elements of ``order``, in the middle of the triangles of ``mesh``,
    (c, 2, t)."""
    middle = np.full((2, 1), 1 / 3), np.full(1, 1 / 2)
    basis = skfem.Basis(triangles_of(mesh), ELEMENTS[order](), quadrature=middle)
    return np.stack([basis.interpolate(component).grad[..., 0] for component in u])


def triangles_of(mesh: Mesh) -> skfem.MeshTri:
    """The triangles of ``mesh``."""
    return skfem.MeshTri(mesh.points.T.copy(), mesh.triangles.T.copy())


def _stiffness(basis: skfem.Basis, kappa: float, compliance: float) -> tuple[sp.csr_matrix, InnerNodes]:
    """Stiffness of plane isotropic elasticity for the nodes on the sides of elements. Derivatives are constant
    multiples of those in the reference triangle, as triangles are straight: the products are integrated there, once.

    scikit-fem numbers nodes inside elements last, element by element.
    """
    mu = (kappa + 1) / (2 * compliance)
    lam = mu * (3 - kappa) / (kappa - 1)
    inverse, area = basis.mapping.invA, np.abs(basis.mapping.detA)
    reference = _reference(basis.elem.maxdeg)
    triangles, size = inverse.shape[2], basis.Nbfun

    def block(*parts: tuple[float, int, int]) -> Array:
        """Sum of factor times the integral of d_i v d_j u, for the ``parts`` (factor, i, j), in each triangle."""
        weights = sum(factor * np.einsum("ce,de->ecd", inverse[:, i], inverse[:, j]) for factor, i, j in parts)
        values = (weights * area[:, None, None]).reshape(triangles, 4) @ reference
        return values.reshape(triangles, size, size)

    of_each = np.empty((triangles, 2, size, 2, size))
    of_each[:, 0, :, 1] = across = block((lam, 0, 1), (mu, 1, 0))
    of_each[:, 1, :, 0] = across.transpose(0, 2, 1)
    for i in (0, 1):
        of_each[:, i, :, i] = block((lam + 2 * mu, i, i), (mu, 1 - i, 1 - i))

    outer = size - basis.elem.interior_dofs
    count = basis.N - triangles * basis.elem.interior_dofs
    values, moved = _without_inside(of_each, outer)
    sides = basis.element_dofs[:outer].T
    around = np.concatenate([sides, count + sides], axis=1)
    rows, columns = (np.broadcast_to(index, values.shape).ravel() for index in (around[:, :, None], around[:, None]))
    stiffness = sp.coo_matrix((values.ravel(), (rows, columns)), (2 * count, 2 * count)).tocsr()
    return stiffness, InnerNodes(around, moved)


def _without_inside(of_each: Array, outer: int) -> tuple[Array, Array]:
    """Stiffness of the first ``outer`` nodes of each triangle, (t, 2 o, 2 o), while the others have no forces, and the
    displacements of these, (t, 2 i, 2 o), from the stiffness ``of_each`` (t, 2, o + i, 2, o + i)."""
    count, sides = len(of_each), 2 * outer
    own = of_each[:, :, :outer, :, :outer].reshape(count, sides, sides)
    to_inside = of_each[:, :, outer:, :, :outer].reshape(count, -1, sides)
    inside = of_each[:, :, outer:, :, outer:].reshape(count, *[to_inside.shape[1]] * 2)
    moved: Array = -np.linalg.solve(inside, to_inside).astype(np.float64, copy=False)
    return own + to_inside.transpose(0, 2, 1) @ moved, moved


@lru_cache
def _reference(order: int) -> Array:
    """Integrals of d_c v d_d u over the reference triangle by (c, d), (4, k^2), of all pairs (v, u) of its k shape
    functions."""
    basis = skfem.Basis(skfem.MeshTri.init_refdom(), ELEMENTS[order](), intorder=2 * (order - 1))
    gradients = np.array([field.grad[:, 0] for (field,) in basis.basis])
    integrals = np.einsum("icq,jdq,q->cdij", gradients, gradients, basis.dx[0])
    return np.ascontiguousarray(integrals.reshape(4, -1))


@lru_cache
def _along(order: int) -> Array:
    """Integrals of the products of the shape functions of an edge of the length 1, (order + 1, order + 1)."""
    points, weights = np.polynomial.legendre.leggauss(order + 1)
    values = shapes(order, (1 + points) / 2)
    return values.T @ (values * weights[:, None] / 2)


def _mass(x: Array, order: int) -> sp.csr_matrix:
    """Integrals over x of products of the shape functions of the nodes ``x`` (n,) of a line, (n, n)."""
    cells = order * np.arange((len(x) - 1) // order)[:, None] + np.arange(order + 1)
    values = np.diff(x[::order])[:, None, None] * _along(order)
    where = (np.broadcast_to(index, values.shape).ravel() for index in (cells[:, :, None], cells[:, None, :]))
    return sp.coo_matrix((values.ravel(), tuple(where)), (len(x), len(x))).tocsr()


def facets_of(triangles: skfem.MeshTri, lines: Indices) -> Indices:
    """Indices of the facets with the end points ``lines`` (k, 2)."""
    count = triangles.p.shape[1]
    ends = np.sort(lines, axis=1)
    known = triangles.facets[0].astype(np.int64) * count + triangles.facets[1]
    order = np.argsort(known)
    return order[np.searchsorted(known, ends[:, 0] * count + ends[:, 1], sorter=order)]
