"""Cells of constant shear traction on two half-planes, and their compliance. Scaled so that A = 1."""

import itertools

import numpy as np

from partialslip.arrays import Array
from partialslip.halfplane.shape import Shape

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(6)
_NEAR = 4.0  # cells within so many of the wider one's widths are integrated in closed form


def graded(points: Array, size: float | Array, growth: float) -> Array:
    """Ends of cells from the first to the last of ``points`` (ascending), each of them an end.

    Cells are about ``size`` wide at the points (one size, or one for each) and gain ``growth`` times their distance
    from the nearest.
    """
    sizes = np.broadcast_to(size, points.shape)
    vertices = [points[:1]]
    for (left, right), (first, last) in zip(itertools.pairwise(points), itertools.pairwise(sizes), strict=True):
        # where the cells that grow from the left are as large as those from the right
        middle = float(np.clip((right - left + (last - first) / growth) / 2, 0.0, right - left))
        steps = _growing(first, growth, middle), _growing(last, growth, right - left - middle)
        vertices += [left + steps[0][1:], right - steps[1][-2::-1]]
    return np.concatenate(vertices)


def _growing(size: float, growth: float, distance: float) -> Array:
    """Distances from a point of the ends of cells, up to ``distance``."""
    reach = np.log1p(growth * distance / size)
    count = max(int(np.ceil(reach / growth)), 1) if distance > 0 else 0
    result: Array = size / growth * np.expm1(np.linspace(0, reach, count + 1))
    return result


def forces(shape: Shape, vertices: Array) -> Array:
    """Normal force on each cell of [-1, 1], as a fraction of the whole: in the angle x = sin(phi) the square roots at
    the contact's ends are smooth, and cells are cut at kinks. What the rule leaves out is shared by all, so that the
    bounds of friction add up to f P and shear just short of sliding finds room."""
    kinks = np.asarray(shape.kinks, float)
    ends = np.unique(np.concatenate([vertices, kinks[np.abs(kinks) < 1]]))
    angles = np.arcsin(np.clip(ends, -1, 1))
    half = np.diff(angles)[:, None] / 2
    phi = (angles[1:] + angles[:-1])[:, None] / 2 + half * _NODES
    values = shape.pressure(np.sin(phi)) * np.cos(phi)
    result: Array = np.add.reduceat((values * half) @ _WEIGHTS, np.searchsorted(ends, vertices[:-1]))
    return result / float(result.sum())


def compliance(vertices: Array) -> Array:
    """Mean relative displacement of each cell under a unit force spread over each other one, (c, c).

    -1/pi times the mean of log|x - s| over both cells (Galerkin): symmetric, and positive definite for a contact
    narrower than 2, to which lengths are to be scaled; that is a rigid shift.
    """
    middle, width = (vertices[1:] + vertices[:-1]) / 2, np.diff(vertices)
    # far apart: a product of Gauss rules, in which nothing cancels
    points = (middle[:, None] + width[:, None] / 2 * _NODES).ravel()
    weights = _WEIGHTS / 2
    count = len(middle)
    distance = np.abs(middle[:, None] - middle)
    near = distance < _NEAR * np.maximum(width[:, None], width)
    result = np.empty((count, count))
    for rows in np.array_split(np.arange(count), max(count // 64, 1)):
        x = points.reshape(count, -1)[rows].ravel()
        logs = np.log(np.abs(x[:, None] - points) + 1e-300).reshape(len(rows), len(_NODES), count, len(_NODES))
        result[rows] = np.einsum("iajb,a,b->ij", logs, weights, weights, optimize=True)
    i, j = np.nonzero(near)
    offset = middle[i] - middle[j]
    total, apart = (width[i] + width[j]) / 2, (width[i] - width[j]) / 2
    outer = _primitive(offset + total) + _primitive(offset - total)
    closed = outer - _primitive(offset - apart) - _primitive(offset + apart)
    result[i, j] = closed / (width[i] * width[j])
    return -(result + result.T) / (2 * np.pi)


def _primitive(z: Array) -> Array:
    """Twice the integral of log|z|."""
    result: Array = z**2 / 2 * np.log(np.abs(z) + (z == 0)) - 3 / 4 * z**2
    return result
