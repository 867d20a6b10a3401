"""What the size and the supports of a body add to the displacements of a half-plane's surface.

A force on the surface of a body moves the surface as it moves that of a half-plane, and a little more, because the body
ends somewhere and is held there. This more is found by itself: it is the displacement of the body under the tractions,
and at the supports, that Flamant's solution for a half-plane leaves over on the body's boundary. They are far from the
contact, so that the displacement is smooth on the contact line, and a coarse mesh gives many digits.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
import skfem

from partialslip.tools.arrays import Array, Complex
from partialslip_fem.bodies import Grading, block_of
from partialslip_fem.elasticity import DiscreteBody, body, facets_of, triangles_of
from partialslip_fem.elements import ELEMENTS
from partialslip_fem.factor import Backend, factor
from partialslip_fem.mortar import shape_functions
from partialslip_fem.problem import Part
from partialslip_meshes import Mesh

_GROWTH = 0.4  # accuracy: element size gained per unit of distance from the contact line
_STEP = 1e-5  # accuracy: of x, for the slope of a round face


@dataclass(frozen=True)
class Surroundings:
    """Displacements of a body's surface less those of a half-plane's.

    Parameters
    ----------
    forced : (2, 2, k, l) array
        Displacements at the points (k,) due to unit forces at l places: along x or y, forces along x or y, points,
        forces.
    stretched : (2, k) array
        Displacements at the points under the tension that strains a long body by 1, less those of uniform strain.
    """

    forced: Array
    stretched: Array


def surroundings(
    part: Part, points: Array, places: Array, order: int, sizes: tuple[float, float, float], backend: Backend
) -> Surroundings:
    """Surroundings of the finite body ``part``, which lies below its contact line.

    Parameters
    ----------
    part : Part
    points, places : (k,), (l,) array
        Points x at which displacements are wanted, and places x of the forces; no point is a place.
    order : int
        Polynomial order of the elements.
    sizes : (float, float, float)
        Element size in the middle of the contact line; largest error due to singular corners, relative to the
        displacements of the contact line; largest distance of a round face from the sides of elements, in ranges of
        the points. A mesh from a file has its own.
    backend : "superlu" or "cholmod"
    """
    reach = max(np.abs(points).max(), np.abs(places).max())
    size, corners, facets = sizes
    grading = Grading((-reach, reach), {0.0: size}, _GROWTH, None, facets, corners)
    mesh = part.mesh or block_of(part, 0.0, grading)
    own, known = left_over(part, mesh, order, places, backend)
    origins = _on_face(part, places)
    at, values = shape_functions(own, points)
    moved = np.einsum("kj,ckjm->ckm", values, known[own.contact[:, at]])
    forced = moved[..., :-1].reshape(2, len(points), 2, len(places)).transpose(0, 2, 1, 3)
    stretched = np.zeros((2, len(points)))
    if own.pull is not None:
        stretched = 4 / part.compliance * moved[..., -1] - np.array([points, 0 * points])
    off_line = _flamant(part, _on_face(part, points), origins)
    on_line = _flamant(part, points.astype(complex), places.astype(complex))
    return Surroundings(forced + off_line - on_line, stretched)


def left_over(part: Part, mesh: Mesh, order: int, places: Array, backend: Backend) -> tuple[DiscreteBody, Array]:
    """The body ``part`` on ``mesh``, and displacements (2 N, 2 l + 1) of its nodes, less those of Flamant's solutions:
    under unit forces at ``places`` (l,) along x, then along y; and those under a unit tension at its end, if it is
    pulled there."""
    own = body(mesh, part.kappa, order, part.compliance, part.held, part.pulled, part.gripped)
    nodes = own.points.shape[1]
    z = own.points[0] + 1j * own.points[1]
    known = np.zeros((2 * nodes, 2 * len(places) + 1))
    along_y = own.held >= nodes
    held = _flamant(part, z[own.held % nodes], _on_face(part, places))  # (2, 2, h, l)
    known[own.held, :-1] = -np.where(along_y[:, None], held[1], held[0]).transpose(1, 0, 2).reshape(len(own.held), -1)
    load = np.zeros_like(known)
    load[:, :-1] = _tractions_left(part, mesh, order, nodes, places)
    load[:, :-1] -= own.stiffness @ known[:, :-1]
    if own.pull is not None:
        known[:, -1], load[:, -1] = own.pulling()
    free = np.setdiff1d(np.arange(2 * nodes), own.held)
    known[free] = factor(own.stiffness, free[:-1], free[-1:], backend).back_substitute(load[free])
    if own.pull is not None:
        known[:, -1] = own.under_unit_tension(known[:, -1])
    return own, known


def _flamant(part: Part, z: Complex, origins: Complex) -> Array:
    """Displacements (2, 2, k, l) of a half-plane at ``z`` (k,), complex, under unit forces at ``origins`` (l,).

    4 pi mu w = -F (kappa log zeta + conj(log zeta)) + conj(F) zeta/conj(zeta), zeta = z - s, in Muskhelishvili's form.
    The logarithm is cut above the half-plane.
    """
    zeta = z[:, None] - origins
    logarithm = np.log(1j * zeta)
    same = -(part.kappa * logarithm + logarithm.conj())
    ratio = zeta / zeta.conj()
    w = part.compliance / (2 * np.pi * (part.kappa + 1)) * np.array([same + ratio, 1j * same - 1j * ratio])
    return np.array([w.real, w.imag])


def _tractions_left(part: Part, mesh: Mesh, order: int, count: int, places: Array) -> Array:
    """Nodal forces (2 N, 2 l) of the tractions with which Flamant's solutions for forces at ``places`` load the body's
    boundary, reversed; N is the ``count`` of nodes on sides of elements. Forces on nodes that are held do not count.

    The traction of a force F at the distance vector r on a surface with the outward normal n is
    -2/pi (F.r) (r.n) r/r^4, along r. It vanishes on a flat face.
    """
    triangles, element = triangles_of(mesh), ELEMENTS[order]()
    face = facets_of(triangles, np.concatenate([mesh.lines["contact"], mesh.lines.get("face", mesh.lines["contact"])]))
    boundary = np.setdiff1d(triangles.boundary_facets(), [] if part.face else face)
    basis = skfem.FacetBasis(triangles, element, facets=boundary, intorder=2 * order + 2)
    x, y = np.asarray(basis.global_coordinates())
    n_x, n_y = np.asarray(basis.normals)
    ds = basis.dx
    if part.face:  # a straight side stands for a part of the round face: its true place and normal count
        on = np.isin(boundary, face)[:, None] & np.ones_like(x, dtype=bool)
        slope = (part.face(x[on] + _STEP) - part.face(x[on] - _STEP)) / (2 * _STEP)
        y[on], n_x[on], ds[on] = -part.face(x[on]), slope, ds[on] * n_y[on]
        n_y[on] = 1.0
    r_x = x.ravel()[:, None] - places
    r_y = y.ravel()[:, None] - height(part, places)
    to_n = r_x * n_x.ravel()[:, None] + r_y * n_y.ravel()[:, None]
    tractions = 2 / np.pi * to_n / (r_x**2 + r_y**2) ** 2
    columns = np.concatenate([tractions * r_x, tractions * r_y], axis=1)
    rows = np.concatenate([np.repeat(nodes, x.shape[1]) for nodes in basis.element_dofs])
    values = np.concatenate([(np.broadcast_to(np.asarray(each[0]), x.shape) * ds).ravel() for each in basis.basis])
    quadrature = sp.coo_array((values, (rows, np.tile(np.arange(x.size), len(basis.basis)))), (basis.N, x.size)).tocsr()
    both = np.tile(r_x, 2), np.tile(r_y, 2)
    return np.concatenate([quadrature[:count] @ (columns * each) for each in both])


def _on_face(part: Part, x: Array) -> Complex:
    """Points x + iy of the face at ``x``."""
    return x + 1j * height(part, x)


def height(part: Part, x: Array) -> Array:
    """Height of the face at ``x``: 0 or less."""
    return -part.face(x) if part.face else np.zeros_like(x)
