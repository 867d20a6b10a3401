"""Cells of constant shear traction on two half-planes, and the compliance of the cells. Scaled so that A = 1."""

import itertools
from collections.abc import Sequence

import numpy as np
from scipy.interpolate import PchipInterpolator, PPoly

from partialslip.friction.contact_line import ContactLine
from partialslip.friction.zone_ends import apart
from partialslip.halfplane.shape import Shape
from partialslip.scene import Friction
from partialslip.tools.arrays import Array

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(6)
# accuracy: distance, in widths of the wider cell, within which pairs of cells are integrated in closed form
_NEAR = 4.0
NEAR_ENDS = 10.0  # accuracy: cells at ends closer to each other than a/10 are reduced in proportion
_SMALLEST = 3e-9  # accuracy: in a: closer ends are one; of smaller cells rounding leaves residuals of 1e-7 f p0
AT_KINKS = 8.0  # cost: size of cells at kinks of q over the size at the ends: kinks hardly affect m and n
_PASSING = 32.0  # cost: the same at kinks that neither q1 nor q2 has
_ROWS = 64  # cost: rows of the compliance at once, whose parts fit into the memory of the processor


def contact_line(vertices: Array, beta: float = 0.0) -> ContactLine:
    """The line of the cells between ``vertices`` (c + 1,), for Dundurs' ``beta``."""
    return ContactLine((vertices[1:] + vertices[:-1]) / 2, np.diff(vertices), vertices, beta)


def cells_around(
    ends: Sequence[float],
    mesh: tuple[float, float],
    a: float = 1.0,
    kinks: Sequence[float] = (),
    passing: Sequence[float] = (),
    bends: Sequence[float] = (),
    at_bends: float = AT_KINKS,
    outer: Sequence[tuple[float, float]] = (),
) -> Array:
    """Ends of cells (c + 1,) of a ``mesh``, the size of cells at the ``ends`` of zones, in the half-width ``a``, and
    growth; cells are larger at ``kinks`` of q, and the largest at those that are ``passing``.

    Cells are small compared with the distance of neighbouring ends: q is steep in narrow slip zones and stick zones.
    Each of the ``bends`` of the coefficient of friction is an end of a cell, and as many cells as the growth tells lie
    between two of them: no dip is left out. There cells have at most ``at_bends`` times the size at the ends. ``outer``
    are further points, and sizes of cells there.
    """
    size, growth = mesh
    fine = apart(ends, _SMALLEST * a)
    bends = apart(bends, _SMALLEST * a, fine)[len(fine) :]
    known = [*fine, *bends]
    coarser = apart(kinks, AT_KINKS * size * a, fine)[len(fine) :]
    known += coarser
    passing = apart(passing, _PASSING * size * a, known)[len(known) :]
    gap = nearest(np.array([*fine, *bends])) / a
    sizes = (
        np.maximum(size * np.minimum(NEAR_ENDS * gap[: len(fine)], 1.0), _SMALLEST),
        np.minimum(at_bends * size, growth * gap[len(fine) :]),
        np.full(len(coarser), AT_KINKS * size),
        np.full(len(passing), _PASSING * size),
    )
    points = np.array([*known, *passing, *(point for point, _ in outer)])
    every = np.concatenate([np.concatenate(sizes) * a, [size for _, size in outer]])
    order = np.argsort(points)
    return graded_cells(points[order], every[order], growth)


def graded_cells(points: Array, size: float | Array, growth: float) -> Array:
    """Ends of cells from the first to the last of ``points`` (k,), ascending; every point is an end.

    Cells are about ``size`` wide at the points (one size, or (k,)) and wider by ``growth`` times the distance from the
    nearest point.
    """
    sizes = np.broadcast_to(size, points.shape)
    vertices = [points[:1]]
    for (left, right), (first, last) in zip(itertools.pairwise(points), itertools.pairwise(sizes), strict=True):
        # the point at which cells that grow from the left and from the right have equal size
        middle = float(np.clip((right - left + (last - first) / growth) / 2, 0.0, right - left))
        steps = _growing(first, growth, middle), _growing(last, growth, right - left - middle)
        vertices += [left + steps[0][1:], right - steps[1][-2::-1]]
    return np.concatenate(vertices)


def nearest(points: Array) -> Array:
    """Distance of each of the ``points`` (k,) from the nearest other one."""
    order = np.argsort(points)
    gaps = np.diff(points[order], prepend=-np.inf, append=np.inf)
    result = np.empty(len(points))
    result[order] = np.minimum(gaps[1:], gaps[:-1])
    return result


def friction_on(friction: Friction, places: Array) -> Array:
    """Means (c,) of the coefficient of ``friction`` over the cells between ``places`` (c + 1,), m: no dip is lost."""
    if not friction.varies:
        return np.full(len(places) - 1, friction.f)
    kinks = np.array(friction.kinks)
    ends = np.union1d(places, kinks[(kinks > places[0]) & (kinks < places[-1])])
    f = friction.at(ends)
    sums = np.add.reduceat(np.diff(ends) * (f[1:] + f[:-1]) / 2, np.searchsorted(ends, places[:-1]))
    return sums / np.diff(places)


def _growing(size: float, growth: float, distance: float) -> Array:
    """Distances of the ends of cells from a point, from 0 to ``distance``."""
    reach = np.log1p(growth * distance / size)
    count = max(int(np.ceil(reach / growth)), 1) if distance > 0 else 0
    return size / growth * np.expm1(np.linspace(0, reach, count + 1))


def on_cells(traction: PPoly, places: Array) -> Array:
    """Forces (c,) of a piecewise ``traction`` on the cells between ``places`` (c + 1,); none beyond its ends."""
    resultant, known = traction.antiderivative(), traction.x
    return np.diff(resultant(np.clip(places, known[0], known[-1])))


def off_cells(forces: Array, places: Array) -> PPoly:
    """Traction with given ``forces`` (c,) on the cells between ``places`` (c + 1,): what :func:`on_cells` takes back.

    Within wide cells it is of second order, so that it can be taken to other cells; a constant on each is of first
    order. It is the slope of the sum of the forces, which cubics between the places follow without overshooting.
    """
    resultant = PchipInterpolator(places, np.concatenate([[0.0], np.cumsum(forces)])).derivative()
    return PPoly(resultant.c, places)


def forces(shape: Shape, vertices: Array) -> Array:
    """Normal forces (c,) on the cells of [-1, 1] between ``vertices`` (c + 1,), as fractions of P.

    Gauss's rule in phi, x = sin(phi), which removes the square roots at the contact's ends; cells are cut at kinks. The
    forces are normalised to sum to 1: the friction bounds then sum to f P, and any |Q| < f P is feasible.
    """
    kinks = np.asarray(shape.kinks, float)
    ends = np.unique(np.concatenate([vertices, kinks[np.abs(kinks) < 1]]))
    angles = np.arcsin(np.clip(ends, -1, 1))
    half = np.diff(angles)[:, None] / 2
    phi = (angles[1:] + angles[:-1])[:, None] / 2 + half * _NODES
    values = shape.pressure(np.sin(phi)) * np.cos(phi)
    result: Array = np.add.reduceat((values * half) @ _WEIGHTS, np.searchsorted(ends, vertices[:-1]))
    return result / float(result.sum())


def compliance(vertices: Array) -> Array:
    """Compliance (c, c): mean relative displacement of one cell under a unit force spread over another.

    -1/pi times the mean of log|x - s| over both cells (Galerkin): symmetric, and positive definite if the contact is
    narrower than 2. Scaling the ``vertices`` (c + 1,) to such a width adds a rigid shift only.
    """
    middle, width = (vertices[1:] + vertices[:-1]) / 2, np.diff(vertices)
    count = len(middle)
    distance = np.abs(middle[:, None] - middle)
    near = distance < _NEAR * np.maximum(width[:, None], width)
    result = np.empty((count, count))
    for rows in np.array_split(np.arange(count), max(count // _ROWS, 1)):
        others = slice(rows[0], None)  # pairs with earlier cells are known by symmetry
        apart = np.where(near[rows, others], np.inf, distance[rows, others])
        result[rows, others] = _mean_log(apart, width[rows, None] / 2, width[others] / 2)
        result[others, rows] = result[rows, others].T
    i, j = np.nonzero(near)
    offset = middle[i] - middle[j]
    total, apart = (width[i] + width[j]) / 2, (width[i] - width[j]) / 2
    outer = _primitive(offset + total) + _primitive(offset - total)
    closed = outer - _primitive(offset - apart) - _primitive(offset + apart)
    result[i, j] = closed / (width[i] * width[j])
    return -(result + result.T) / (2 * np.pi)


def _mean_log(distance: Array, half: Array, others: Array) -> Array:
    """Mean of log|x - s| over far cells at a ``distance`` of their middles, of half-widths ``half`` and ``others``.

    A product of Gauss rules, without cancellation. As logarithms cost most, there is one for all pairs of nodes of the
    same weight: of the product of their distances.
    """
    square = distance**2

    def four(node: float, other: float) -> Array:
        """Product of the distances of the nodes at +-``node`` and +-``other``."""
        return (square - (half * node + others * other) ** 2) * (square - (half * node - others * other) ** 2)

    mean: Array = np.zeros_like(square)
    right = list(zip(_NODES[_NODES > 0].tolist(), _WEIGHTS[_NODES > 0].tolist(), strict=True))
    for (node, weight), (other, its) in itertools.combinations_with_replacement(right, 2):
        product = four(node, other) if node == other else four(node, other) * four(other, node)
        mean += weight * its / 4 * np.log(product)
    return mean


def _primitive(z: Array) -> Array:
    """Second antiderivative of log|z|."""
    return z**2 / 2 * np.log(np.abs(z) + (z == 0)) - 3 / 4 * z**2
