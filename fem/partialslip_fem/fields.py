"""Stresses along the surfaces and inside the bodies, and displaced meshes, in SI units."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PPoly

from partialslip.result import DeformedBody, SurfaceStress
from partialslip.tools.arrays import Array
from partialslip_fem.displacements import DisplacedBody
from partialslip_fem.elasticity import gradients
from partialslip_fem.mesh_solution import MeshSolution
from partialslip_fem.recovery import inside_elements, polynomials

_CELLS, _TERMS = 6, 4  # accuracy: cells and terms of the fit at the ends of the contact
_REACH, _SHORTEST = 1.5, 0.01  # display: of the edges drawn near the contact, in contact half-widths


@dataclass(frozen=True)
class _Surface:
    """One body's surface: ``displacements`` along x and ``pressures``, by load point, scaled."""

    compliance: float
    kappa: float
    displacements: tuple[PPoly, ...]
    pressures: tuple[PPoly, ...]

    def at(self, x: Array) -> list[Array]:
        """sigma_xx at ``x`` (k,), by load point, scaled."""
        return [
            4 / self.compliance * inside_elements(u.derivative(), x)
            - (3 - self.kappa) / (self.kappa + 1) * inside_elements(p, x)
            for u, p in zip(self.displacements, self.pressures, strict=True)
        ]


@dataclass(frozen=True)
class _Surfaces:
    """Surfaces of the lower and the upper body; units of ``length`` (m) and ``stress`` (Pa), and ``origin`` (m)."""

    bodies: tuple[_Surface, ...]
    length: float
    stress: float
    origin: float

    def at(self, x: Array) -> Array:
        """sigma_xx at ``x`` (k,), m, by body and load point: (2, 2, k), Pa."""
        scaled = (np.asarray(x, float) - self.origin) / self.length
        return self.stress * np.array([body.at(scaled) for body in self.bodies])


def along_surfaces(
    bodies: Sequence[DisplacedBody],
    contact_ends: Sequence[tuple[float, float]],
    length: float,
    stress: float,
    origin: float,
) -> SurfaceStress:
    """sigma_xx along the surfaces of the lower and the upper body.

    With the strain e of the surface, the pressure p on it and the compliance A = (kappa+1)/(2 mu) of the body,

        sigma_xx = (4/A) e - (3-kappa)/(kappa+1) p.

    Beyond the body sigma_xx is zero.

    Parameters
    ----------
    bodies : two of DisplacedBody
    contact_ends : two of (float, float)
        Ends of the contact at load points 1 and 2, scaled.
    length, stress : float
        Units of length and stress, m and Pa.
    origin : float
        Origin of the scaled x, m.
    """
    surfaces = tuple(
        _Surface(
            body.part.compliance,
            body.part.kappa,
            tuple(polynomials(mesh.face_x, u, mesh.order) for u in body.u[:, 0, mesh.face]),
            tuple(body.pressures),
        )
        for body in bodies
        for mesh in (body.condensed.body,)
    )
    stresses = _Surfaces(surfaces, length, stress, origin)
    nodes = bodies[0].condensed.body.face_x
    x = np.union1d(nodes, contact_ends)
    sigma = stresses.at(length * x + origin)
    for number, surface in enumerate(surfaces):
        for load, (u, (left, right)) in enumerate(zip(surface.displacements, contact_ends, strict=True)):
            for end, side in ((left, -1), (right, 1)):
                at_end = stress * 4 / surface.compliance * _strain_beyond(u, end, side)
                sigma[number, load, np.searchsorted(x, end)] = at_end
    return SurfaceStress(length * x + origin, sigma, stresses.at)


def _strain_beyond(u: PPoly, end: float, side: int) -> float:
    """Strain of the surface at the contact's ``end``, as a limit from outside (``side``).

    The strain is c_0 + c_1 r^(1/2) + c_2 r + ... at the distance r, which polynomials do not follow. Means over cells
    are far more accurate than point values: the series is fitted to the means of the cells next to the cell at the end.
    Where a mesh has fewer cells than terms there, the series is shorter; where it has none, the element at the end
    tells the strain.
    """
    distance = np.sort(side * (u.x - end))
    distance = distance[distance > 0][1 : _CELLS + 2]
    if len(distance) <= 1:
        return float(inside_elements(u.derivative(), np.array([end]))[0])
    powers, scale = np.arange(min(_TERMS, len(distance) - 1)) / 2, distance[-1]
    grown = (distance[:, None] / scale) ** (powers + 1) / (powers + 1)
    means = np.diff(u(end + side * distance)) * side
    weights = 1 / np.diff(distance)
    fit, *_ = np.linalg.lstsq(np.diff(grown, axis=0) * scale * weights[:, None], means * weights)
    return float(fit[0])


def deformed(body: DisplacedBody, length: float, unit: float, stress: float, origin: float) -> DeformedBody:
    """Displacements of the mesh points and stresses in the middle of the triangles of ``body``.

    Parameters
    ----------
    length, unit, stress : float
        Units of length and displacement, m, and of stress, Pa.
    origin : float
        Origin of the scaled x, m.
    """
    mesh, mirror = body.condensed.mesh, np.array([[1.0], [body.way]])
    moved = body.u[..., body.condensed.body.vertices[0]]
    stresses = _in_the_middle(body)
    return DeformedBody(
        "lower" if body.way > 0 else "upper",
        length * (mesh.points.T * mirror).T + np.array([origin, 0.0]),
        mesh.triangles[:, :: body.way],
        mesh.lines,
        {f"displacement_{point}": unit * (u * mirror).T for point, u in enumerate(moved, start=1)},
        {f"stress_{point}": stress * sigma.T for point, sigma in enumerate(stresses, start=1)},
    )


def edges_near_contact(solution: MeshSolution, length: float, origin: float) -> tuple[Array, Array]:
    """Element edges of the lower and the upper body near the contact, (k, 2, 2) by edge, end and x, y, m.

    Edges of :data:`_REACH` contact half-widths around the contact, without edges too short to be seen. ``length`` is
    the unit of length, and ``origin`` the origin of the scaled x, m.
    """
    found, middle = [], np.array([(solution.left + solution.right) / 2, 0.0])
    for condensed, way in zip((solution.bodies * 2)[:2], (1, -1), strict=True):
        ends = (condensed.mesh.points[condensed.mesh.edges] - middle) / solution.half_width
        low, high = ends.min(axis=1), ends.max(axis=1)
        near = (low[:, 0] < _REACH) & (high[:, 0] > -_REACH) & (high[:, 1] > -_REACH)
        seen = np.hypot(*(ends[:, 1] - ends[:, 0]).T) > _SHORTEST
        scaled = (ends[near & seen] * solution.half_width + middle) * (length, way * length) + (origin, 0.0)
        found.append(scaled.astype(np.float32))
    return found[0], found[1]


def _in_the_middle(body: DisplacedBody) -> Array:
    """sigma_xx, sigma_yy and sigma_xy in the middle of the triangles, by load point, (2, 3, t), scaled."""
    kappa = body.part.kappa
    mu = (kappa + 1) / (2 * body.part.compliance)
    lam = mu * (3 - kappa) / (kappa - 1)
    result = []
    discrete = body.condensed.body
    for u in discrete.inner_nodes.everywhere(body.u):
        (xx, xy), (yx, yy) = gradients(body.condensed.mesh, discrete.order, u)
        volume = lam * (xx + yy)
        result.append([volume + 2 * mu * xx, volume + 2 * mu * yy, body.way * mu * (xy + yx)])
    return np.array(result)
