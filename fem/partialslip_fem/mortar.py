"""L2 projection onto contact lines: between those whose nodes do not match, and of gaps."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla
from scipy.interpolate import PPoly

from partialslip.tools.arrays import Array, Indices
from partialslip_fem.elasticity import DiscreteBody
from partialslip_fem.elements import shapes
from partialslip_fem.recovery import inside_elements

_ON_VERTEX = 1e-6  # accuracy: distance of a jump of the gap's curvature from a vertex, in the cell, that counts as none


def transfer(onto: DiscreteBody, other: DiscreteBody) -> Array:
    """L2 projection T from the contact line of ``other`` to the contact line of ``onto``, (n, n_other).

    T projects displacements. T^T takes nodal forces back: the other body gets nodal forces of the same traction. T
    preserves constant and linear functions, so that T^T preserves forces and moments. If the nodes match, T is the
    identity. The other line may be longer.
    """
    return spla.spsolve(onto.mass.tocsc(), _products(onto, other).toarray())


def nodal_forces(body: DiscreteBody, traction: PPoly) -> Array:
    """Nodal forces on the contact line of ``body``, (n,), of a piecewise ``traction`` that is zero off its cells."""
    order = (body.order + len(traction.c)) // 2 + 1
    rule = _rule(np.clip(np.union1d(body.x[:: body.order], traction.x), body.x[0], body.x[-1]), order)
    nodes, values = shape_functions(body, rule.starts, rule.offsets)
    products = (rule.weights * inside_elements(traction, rule.starts + rule.offsets))[:, None] * values
    return np.bincount(nodes.ravel(), products.ravel(), len(body.x)).astype(float)


def projected(body: DiscreteBody, gap: Callable[[Array], Array], breaks: Sequence[float]) -> Array:
    """Values on the contact line of ``body``, (n,), of a piecewise polynomial ``gap`` of the second degree.

    Where its curvature jumps (``breaks``) within a cell, the gap is projected, as its work with the traction counts. An
    interpolated gap does work that is off like the jump times size^3, whatever the order of the elements. With the
    projection the error is like jump^2 size^4.
    """
    values, vertices = gap(body.x), body.x[:: body.order]
    points = within_cells(vertices, breaks)
    if not len(points):
        return values
    cells = np.unique(np.searchsorted(vertices, points))
    ends = np.union1d(np.union1d(vertices[cells - 1], vertices[cells]), points)
    starts, offsets, weights = _rule(ends, body.order + 1)
    nodes, shape = shape_functions(body, starts, offsets)
    missing = weights * (gap(starts + offsets) - (shape * values[nodes]).sum(axis=1))
    missing[~np.isin(np.searchsorted(vertices, starts + offsets), cells)] = 0.0
    work = np.bincount(nodes.ravel(), (missing[:, None] * shape).ravel(), len(body.x))
    return values + body.mass_factor.solve(work)


def within_cells(vertices: Array, points: Sequence[float]) -> Array:
    """``points`` inside the cells between ``vertices`` (c + 1,), without points at vertices, (k,)."""
    inside = np.array([each for each in points if vertices[0] < each < vertices[-1]])
    after = np.searchsorted(vertices, inside)
    beside = np.minimum(vertices[after] - inside, inside - vertices[after - 1])
    return inside[beside > _ON_VERTEX * (vertices[after] - vertices[after - 1])]


def _products(onto: DiscreteBody, other: DiscreteBody) -> sp.csr_matrix:
    """Integrals of products of shape functions of both bodies, (n, n_other); the quadrature is exact."""
    vertices = np.union1d(onto.x[:: onto.order], other.x[:: other.order])
    vertices = vertices[(vertices >= max(onto.x[0], other.x[0])) & (vertices <= min(onto.x[-1], other.x[-1]))]
    starts, offsets, weights = _rule(vertices, (onto.order + other.order) // 2 + 1)
    rows, left = shape_functions(onto, starts, offsets)
    columns, right = shape_functions(other, starts, offsets)
    values = weights[:, None, None] * left[:, :, None] * right[:, None, :]
    where = (np.broadcast_to(index, values.shape).ravel() for index in (rows[:, :, None], columns[:, None, :]))
    return sp.coo_array((values.ravel(), tuple(where)), (len(onto.x), len(other.x))).tocsr()


class _Rule(NamedTuple):
    """Quadrature points (k,), each by where its interval ``starts`` and its ``offsets`` from there, and ``weights``."""

    starts: Array
    offsets: Array
    weights: Array


def _rule(vertices: Array, count: int) -> _Rule:
    """Gauss's rule with ``count`` points between neighbouring ``vertices``."""
    points, weights = np.polynomial.legendre.leggauss(count)
    half = np.diff(vertices)[:, None] / 2
    return _Rule(np.repeat(vertices[:-1], count), (half * (1 + points)).ravel(), (half * weights).ravel())


def shape_functions(body: DiscreteBody, x: Array, offsets: Array | float = 0.0) -> tuple[Indices, Array]:
    """Nodes whose shape functions do not vanish at ``x`` + ``offsets`` (k,), and the values, (k, order + 1) each.

    A point and its ``x`` are in the same cell. The offset counts from the cell's first node, as coordinates resolve a
    cell of the size h only to eps/h of it. Compliances that are projected with such errors make p oscillate by eps/h^2.
    """
    k, vertices = body.order, body.x[:: body.order]
    cell = np.clip(np.searchsorted(vertices, x, "right") - 1, 0, len(vertices) - 2)
    local = ((x - vertices[cell]) + offsets) / np.diff(vertices)[cell]
    values = shapes(k, local)
    nodes: Indices = k * cell[:, None] + np.arange(k + 1)
    return nodes, values
