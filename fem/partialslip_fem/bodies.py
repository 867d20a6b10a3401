"""Meshing the bodies of a problem and condensing them to their contact lines."""

import math
import threading
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from partialslip.friction.active_set import Factored, Sides, Solution
from partialslip.friction.coupled_step import Relative
from partialslip.friction.normal import press
from partialslip.result import Clock
from partialslip.tools.arrays import Array, Indices, submatrix
from partialslip.tools.errors import InputError
from partialslip_fem.condensation import Condensation
from partialslip_fem.contact import CondensedBody
from partialslip_fem.elasticity import body
from partialslip_fem.farfield import half_plane
from partialslip_fem.problem import Part, ScaledProblem
from partialslip_meshes import Eased, Mesh, block, fanned, size_at

_OVERHANG = 1e-9  # limit: of the opposite contact line: overhang that counts as rounding of coordinates
# accuracy: lambda/mu (nu = 0.476 in plane strain) from which on three triangles meet at vertices of the contact line.
# Measured where two met in both bodies, the least compliance of the line by nu, with two and with three: 10, 16 (0.49);
# 1.4, 14 (0.499); 0.16, 13 (0.4999). At nu = 0.49 p was off by 1.7 times its estimate with two, by 0.5 with three
_INCOMPRESSIBLE = 20.0
_KEPT = 2  # cost: sets of bodies in Kept: those of the first mesh, and of the uniform mesh that follows


class Shared:
    """Data that solutions on the same bodies share: the last pressing, factors of the compliance at the nodes in
    contact, and the ``relative`` compliances, by whether p and q are coupled."""

    def __init__(self) -> None:
        self.relative: dict[bool, Relative] = {}
        self._pressed: tuple[Array, Solution] | None = None
        self._sheared: tuple[Indices, Factored] | None = None

    def press(self, normal: Array, gap: Array, arms: Array | None, near: Sides | None, moment: float = 0.0) -> Solution:
        """Normal forces (n,), as from :func:`partialslip.friction.normal.press` under a force of 1; ``near`` are sides
        (n,) to begin with."""
        key = gap if arms is None else np.concatenate([gap, arms, [moment]])
        if self._pressed and np.array_equal(self._pressed[0], key):
            return replace(self._pressed[1], iterations=0, changes=0)
        found = press(normal, gap, 1.0, arms, moment, near=None if near is None else (near, 0.0))
        self._pressed = key, found
        return found

    def tangential(self, compliance: Array, nodes: Indices) -> Factored:
        """Factors of the ``compliance`` of the ``nodes``, (k, k)."""
        if not self._sheared or not np.array_equal(self._sheared[0], nodes):
            self._sheared = nodes, Factored(submatrix(compliance, nodes, nodes))
        return self._sheared[1]


class Grading(NamedTuple):
    """Element sizes of a mesh.

    Parameters
    ----------
    contact, sizes, growth, along
        As for :func:`partialslip_meshes.block`.
    facet_error : float, optional
        Largest distance of a round face from the straight sides of the elements, in half-widths of the contact line.
    corner_error : float, optional
        Largest change of the contact by the elements at corners of finite bodies, relative.
    eased : Eased, optional
        Larger growth near the points of ``sizes``.
    """

    contact: tuple[float, float]
    sizes: Mapping[float, float]
    growth: float
    along: float | None = None
    facet_error: float | None = None
    corner_error: float | None = None
    eased: Eased | None = None

    def at(self, points: Array) -> Array:
        """Element sizes at ``points`` (k,) of the contact line."""
        places, sizes = np.array([*self.sizes]), np.array([*self.sizes.values()])
        return size_at(sizes, self.growth, np.abs(points[:, None] - places), self.eased).min(axis=1)


class Kept(threading.local):
    """Condensed bodies of the last meshes, for runs with other loads, friction or profiles on the same meshes.

    Pass one instance to several runs. Each thread has its own bodies in it.
    """

    def __init__(self) -> None:
        self._bodies: dict[tuple[object, ...], tuple[tuple[CondensedBody, ...], Shared]] = {}

    def find(self, key: tuple[object, ...]) -> tuple[tuple[CondensedBody, ...], Shared] | None:
        """Return the bodies stored under ``key``, and what solutions on them share; or None."""
        return self._bodies.get(key)

    def add(self, key: tuple[object, ...], bodies: tuple[CondensedBody, ...], shared: Shared) -> None:
        """Store ``bodies`` under ``key``; drop the oldest set if there are too many."""
        self._bodies[key] = bodies, shared
        for oldest in list(self._bodies)[:-_KEPT]:
            del self._bodies[oldest]


def bodies_key(problem: ScaledProblem, width: float, grading: Grading) -> tuple[object, ...]:
    """Key in :class:`Kept` of the bodies of ``problem`` on a mesh: everything that their compliances depend on."""
    kind = (problem.parts, problem.order, problem.far_field, problem.backend, problem.path is None, problem.inside)
    return (*kind, width, *grading._replace(sizes=tuple(grading.sizes.items())))  # type: ignore[arg-type]


def mesh_bodies(problem: ScaledProblem, width: float, grading: Grading, clock: Clock) -> list[Mesh]:
    """Mesh every part of ``problem``. ``width`` is the half-width of blocks that stand for half-planes."""
    meshes: list[Mesh] = []
    for part in problem.parts:
        with clock.phase("mesh"):
            if meshes and part.meshed_like(problem.parts[0]):
                mesh = meshes[0]
            else:
                mesh = part.mesh or _meshed(part, width, grading)
                clock.add_meshing(mesh.cpu_s)
        meshes.append(mesh)
    return meshes


def _meshed(part: Part, width: float, grading: Grading) -> Mesh:
    """Mesh a block as :func:`block_of`, so that contact forces are determined in a nearly incompressible body, too."""
    mesh = block_of(part, width, grading)
    return fanned(mesh) if (3 - part.kappa) / (part.kappa - 1) > _INCOMPRESSIBLE else mesh


def condense(meshes: Sequence[Mesh], problem: ScaledProblem, width: float, clock: Clock) -> tuple[CondensedBody, ...]:
    """Assemble and condense the bodies on ``meshes``, in the order of the problem's parts.

    Raises
    ------
    InputError
        If the contact lines of meshes from files do not lie opposite each other.
    """
    if len(meshes) > 1 and any(part.mesh for part in problem.parts):
        meshes = [_opposite(*meshes), *meshes[1:]]
    return tuple(_condensed(*pair, problem, width, clock) for pair in zip(meshes, problem.parts, strict=True))


def _condensed(mesh: Mesh, part: Part, problem: ScaledProblem, width: float, clock: Clock) -> CondensedBody:
    with clock.phase("assembly"):
        assembled = body(mesh, part.kappa, problem.order, part.compliance, part.held, part.pulled, part.gripped)
    far = None
    if problem.far_field == "half-plane" and not part.finite:
        with clock.phase("far field"):
            far = half_plane(assembled.held_points, assembled.x, width, part.kappa, part.compliance)
    with clock.phase("factorisation"):
        shear = problem.path is not None
        return CondensedBody(mesh, assembled, Condensation(assembled, far, problem.backend, shear, problem.inside))


def block_of(part: Part, width: float, grading: Grading) -> Mesh:
    """Mesh a block: ``part``, or a block of the half-width ``width`` that stands for a half-plane."""
    half_width, height = part.extent or (width, width)
    contact, sizes, growth, along, facet_error, corner_error, eased = grading
    finer = {x: size * part.fineness for x, size in sizes.items()}
    everywhere = None if along is None else along * part.fineness
    facets = None
    if part.face and facet_error:
        # a chord of length c is c^2/(8 R) off its arc; the effect on the contact decreases with the distance
        facets = math.sqrt(8 * facet_error * part.face.radius / (contact[1] - contact[0]) * 2)
    corners = part.corners(corner_error) if part.extent and corner_error else {}
    shape = (part.holder, part.face, facets, corners, eased)
    return block(half_width, contact, finer, growth * part.fineness, height, everywhere, *shape)


def _opposite(mesh: Mesh, other: Mesh) -> Mesh:
    """Restrict the contact line of ``mesh`` to the edges opposite the contact line of ``other``."""
    line, across = mesh.lines["contact"], other.points[other.lines["contact"], 0]
    x, room = mesh.points[line, 0], _OVERHANG * np.ptp(across)
    line = line[((x >= across.min() - room) & (x <= across.max() + room)).all(axis=1)]
    if not len(line):
        raise InputError(
            "bodies.lower, bodies.upper: the contact lines must lie opposite each other; is their unit right?"
        )
    return replace(mesh, lines=mesh.lines | {"contact": line})
