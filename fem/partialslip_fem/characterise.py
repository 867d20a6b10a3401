"""Characterise a rig: linear solutions of each finite body, without contact."""

from collections.abc import Sequence

import numpy as np
from numpy.polynomial import chebyshev

from partialslip.arrays import Array
from partialslip.errors import InputError
from partialslip.rig import Rig, key_of
from partialslip.scene import Scene
from partialslip_fem.factor import Backend, default_backend
from partialslip_fem.problem import Part, parts_of
from partialslip_fem.surroundings import surroundings

_REACH = 0.5  # range of the polynomials, in the smallest half-width or height of the bodies
_TERMS = 11  # of each polynomial
_ORDER = 4  # of the elements
_FINE, _ROUGH = (0.1, 1e-7), (0.2, 1e-6)  # element size in the middle, and tolerance of singular corners


def characterise(scene: Scene) -> Rig:
    """Characterise the bodies of ``scene``.

    Loads, friction and, without a pad, the profile do not matter. Both solutions take well under a second.

    Raises
    ------
    InputError
        If no body of the scene is finite, or a mesh file cannot be read.
    """
    if not scene.finite:
        raise InputError("bodies: must have upper or lower: half-planes need no equivalent")
    length = _smallest(parts_of(scene, 1.0))
    parts = [part for part in parts_of(scene, length) if part.finite]
    backend = scene.fem.factor or default_backend()
    terms, pulled = _terms(parts, *_FINE, backend)
    rough, rough_pulled = _terms(parts, *_ROUGH, backend)
    xx, xy, yx, yy = (each[:, :_TERMS] for each in terms.reshape(4, _TERMS, -1))
    errors = _largest(terms - rough).ravel()
    uneven = [_largest(xx - xx.T), _largest(xy - yx.T), _largest(yy - yy.T)]  # reciprocity
    return Rig(
        key=key_of(scene),
        reach=_REACH * length,
        xx=(xx + xx.T) / 2,
        yy=(yy + yy.T) / 2,
        xy=(xy + yx.T) / 2,
        pulled=pulled / _REACH,
        errors={
            "xx": max(errors[0], uneven[0]),
            "xy": max(errors[1], errors[2], uneven[1]),
            "yy": max(errors[3], uneven[2]),
            "pulled": float(_largest(pulled - rough_pulled).max()) / _REACH,
        },
    )


def _terms(parts: Sequence[Part], size: float, corners: float, backend: Backend) -> tuple[Array, Array]:
    """Coefficients of the powers of x and t, (2, 2, k, k + 1), of the relative displacements (u, v) due to tractions
    (q, p), and of the powers of x, (2, k), due to tension; x and t in the range of the polynomials."""
    points, places = chebyshev.chebpts1(_TERMS), chebyshev.chebpts1(_TERMS + 1)
    forced, pulled = np.zeros((2, 2, _TERMS, _TERMS + 1)), np.zeros((2, _TERMS))
    for part in parts:
        found = surroundings(part, _REACH * points, _REACH * places, _ORDER, size, corners, backend)
        # the mesh of the upper body is mirrored: along y, forces and displacements have the other sign
        way = 1 if part.name == "lower" else -1
        forced += np.array([[1, way], [way, 1]])[..., None, None] * found.forced
        pulled -= found.stretched  # of the lower body
    along, across = _to_powers(points), _to_powers(places)
    return along @ forced @ across.T, pulled @ along.T


def _to_powers(points: Array) -> Array:
    """Matrix from values at ``points`` (k,) to coefficients of powers (k,)."""
    basis = np.array([np.pad(chebyshev.cheb2poly(row), (0, len(points) - 1 - n)) for n, row in enumerate(np.eye(len(points)))])  # fmt: skip
    result: Array = basis.T @ np.linalg.inv(chebyshev.chebvander(points, len(points) - 1))
    return result


def _largest(coefficients: Array) -> Array:
    """Largest values (...) of polynomials of x and t with ``coefficients`` (..., k, l) in their range."""
    x = np.linspace(-1, 1, 41)
    along, across = (np.vander(x, count, increasing=True) for count in coefficients.shape[-2:])
    values = along @ coefficients @ across.T
    values[...] -= values.mean(axis=-2, keepdims=True)  # a rigid shift
    result: Array = np.abs(values).max(axis=(-2, -1))
    return result


def _smallest(parts: Sequence[Part]) -> float:
    """Smallest half-width or height of the finite ``parts``."""
    sizes = []
    for part in parts:
        if part.mesh:
            line, points = part.mesh.points[part.mesh.lines["contact"], 0], part.mesh.points
            sizes += [-line.min(), line.max(), -points[:, 1].min()]
        elif part.extent:
            sizes += [part.extent[0], part.extent[1] + (part.holder[1] if part.holder else 0.0)]
    return float(min(sizes))
