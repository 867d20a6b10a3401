"""Characterise a rig: linear solutions of each finite body, without contact."""

from collections.abc import Sequence

import numpy as np
from numpy.polynomial import chebyshev

from partialslip.result.rig import Rig, Terms, key_of
from partialslip.scene import Scene
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError
from partialslip_fem.elasticity import triangles_of
from partialslip_fem.factor import Backend, default_backend
from partialslip_fem.problem import Part, parts_of
from partialslip_fem.surroundings import height, surroundings

_REACH = 0.5  # accuracy: range of the polynomials, in the smallest half-width or height of the bodies
_FLAT = 1e-6  # accuracy: of the height: distance from the face that counts as rounding
_TERMS = 11  # accuracy: of each polynomial
_ORDER = 4  # accuracy: of the elements
# element size in the middle, tolerance of singular corners, distance of round faces from the sides of elements; and
# order of the elements on a given mesh
_FINE, _ROUGH = ((0.1, 1e-7, 1e-5), _ORDER), ((0.2, 1e-6, 1e-4), _ORDER - 1)


def characterise_bodies(scene: Scene) -> Rig:
    """Characterise the bodies of ``scene``.

    Loads, friction and, without a pad, the profile do not matter. Both solutions take well under a second.

    Raises
    ------
    InputError
        If no body of the scene is finite, a body pivots, or a mesh file cannot be read.
    """
    if not scene.finite:
        raise InputError("bodies: must have upper or lower: half-planes need no equivalent")
    scene.bodies.require_no_pin("for a rig, whose bodies do not turn")
    length = _smallest(parts_of(scene, 1.0))
    parts = [part for part in parts_of(scene, length) if part.finite]
    backend = scene.fem.factor or default_backend()
    fine, rough = (_terms(parts, *sizes, backend) for sizes in (_FINE, _ROUGH))
    return Rig(key_of(scene), _REACH * length, fine, rough)


def _terms(parts: Sequence[Part], sizes: tuple[float, float, float], order: int, backend: Backend) -> Terms:
    """Sum of the terms of all bodies, on a mesh of these ``sizes``, or by elements of this ``order`` on a given one."""
    points, places = chebyshev.chebpts1(_TERMS), chebyshev.chebpts1(_TERMS + 1)
    along, across = _to_powers(points), _to_powers(places)
    even = not any(part.pulled or part.mesh for part in parts)  # bodies are their own mirror images, meshes are not
    found, pulled = (
        {"lower": np.zeros((3, _TERMS, _TERMS)), "upper": np.zeros((3, _TERMS, _TERMS))},
        np.zeros((2, _TERMS)),
    )
    for part in parts:
        around = surroundings(part, _REACH * points, _REACH * places, order if part.mesh else _ORDER, sizes, backend)
        # the mesh of the upper body is mirrored: along y, forces and displacements have the other sign
        way = 1 if part.name == "lower" else -1
        forced = np.array([[1, way], [way, 1]])[..., None, None] * around.forced
        found[part.name] = _symmetric((along @ forced @ across.T)[..., :_TERMS], even)
        pulled -= around.stretched  # of the lower body
    xx, yy, xy = found["lower"] + found["upper"]
    return Terms(xx, yy, xy, pulled @ along.T / _REACH, *found["lower"])


def _symmetric(forced: Array, even: bool) -> Array:
    """xx, yy and xy (3, k, k) from ``forced`` (2, 2, k, k), by reciprocity; zeros where ``even`` bodies have none."""
    (xx, xy), (yx, yy) = forced
    xx, yy, xy = (xx + xx.T) / 2, (yy + yy.T) / 2, (xy + yx.T) / 2
    if even:
        odd = np.add.outer(range(_TERMS), range(_TERMS)) % 2 == 1
        xx, yy, xy = np.where(odd, 0.0, xx), np.where(odd, 0.0, yy), np.where(odd, xy, 0.0)
    return np.array([xx, yy, xy])


def _to_powers(points: Array) -> Array:
    """Matrix from values at ``points`` (k,) to coefficients of powers (k,)."""
    count = len(points)
    powers = np.zeros((count, count))
    for n in range(count):
        powers[: n + 1, n] = chebyshev.cheb2poly(np.eye(count)[n, : n + 1])
    return powers @ np.linalg.inv(chebyshev.chebvander(points, count - 1))


def _smallest(parts: Sequence[Part]) -> float:
    """Smallest half-width or height of the finite ``parts``; less where the contact line of a mesh ends before."""
    sizes = []
    for part in parts:
        if part.mesh:
            line = part.mesh.points[part.mesh.lines["contact"], 0]
            sizes += [_clearance(part), -line.min() / _REACH, line.max() / _REACH]
        elif part.extent:
            sizes += [part.extent[0], part.extent[1] + (part.holder[1] if part.holder else 0.0)]
    return float(min(sizes))


def _clearance(part: Part) -> float:
    """Distance of the middle of the face from the nearest point of the boundary that is not on the face; the contact
    line of a mesh may be a part of the face only."""
    assert part.mesh
    triangles = triangles_of(part.mesh)
    x, y = triangles.p[:, np.unique(triangles.facets[:, triangles.boundary_facets()])]
    below = np.abs(y - height(part, x)) > _FLAT * np.ptp(y)
    return float(np.hypot(x, y)[below].min())
