"""Ends of contact and stick zone, and kinks of the shear traction, from nodal forces."""

from functools import partial

import numpy as np

from partialslip.friction import zone_ends
from partialslip.friction.history import History
from partialslip.friction.pressing import Pressed
from partialslip.friction.zone_ends import StickInterval, apart, finest, kinks, read_stick_zone
from partialslip.tools.arrays import Array, Indices
from partialslip_fem.elasticity import DiscreteBody
from partialslip_fem.problem import ScaledProblem
from partialslip_fem.recovery import traction

_ROUGH = 3  # accuracy: cells at each end of the contact in which tractions are not smooth
_SAMPLES = 32  # accuracy: points in each other cell, between which the force is nearly linear
_SAME_KINK = 1e-3  # accuracy: of the contact half-width: kinks nearer to each other count as one


def contact_ends_of(
    line: DiscreteBody,
    normal: Array,
    shear: Array | None = None,
    beta: float = 0.0,
    rise: float = zone_ends.ROUNDED,
    count: int = zone_ends.VERTICES,
) -> tuple[float, float]:
    """Ends of the contact under ``normal`` forces and ``shear`` forces (n,) on the nodes of the contact line; ``beta``,
    ``rise`` and ``count`` as for :func:`partialslip.friction.zone_ends.contact_ends`."""
    tangential = _cell_forces(line, shear) if shear is not None and beta else None
    vertices = line.x[:: line.order]
    return zone_ends.contact_ends(
        vertices, _cell_forces(line, normal), line.x[normal > 0], tangential, beta, rise, count
    )


def resultants_of(line: DiscreteBody, normal: Array, shear: Array) -> tuple[Array, Array, Array]:
    """Points (k,) well inside the contact under ``normal`` and ``shear`` forces (n,), and the forces along y and x on
    their left, (k,) each. Near the ends, where tractions are not smooth, there are none."""
    first, last = np.flatnonzero(normal > 0)[[0, -1]] // line.order
    vertices = line.x[(first + _ROUGH) * line.order : (last + 2 - _ROUGH) * line.order : line.order]
    points = (vertices[:-1, None] + np.diff(vertices)[:, None] * np.linspace(0, 1, _SAMPLES, endpoint=False)).ravel()
    return points, *(traction(line, forces).antiderivative()(points) for forces in (normal, shear))


def weighted_means(line: DiscreteBody, forces: Array) -> Array:
    """Means over the cells of the contact line, (c,), of the traction that is equivalent to nodal ``forces`` (n,),
    times the roots of the cells' widths: their norm is an L2 norm."""
    return _cell_forces(line, forces) / np.sqrt(np.diff(line.x[:: line.order]))


def stick_zone_of(
    line: DiscreteBody, nodes: Indices, history: History, growth: tuple[Array, Array] | None = None
) -> StickInterval:
    """Stick zone of ``history`` on the contact ``nodes`` of the ``line``.

    ``growth`` are the bound and the change of q to use instead of the history's, (k,) each (see
    :func:`growth_when_pressed`).
    """
    bound, change = growth or (history.bound, history.change)
    forces_of = partial(_forces_of, line, nodes)
    return read_stick_zone(
        line.x[nodes], bound, change, line.x[:: line.order], forces_of, history.lasting, history.unsteady, history.stuck
    )


def growth_when_pressed(first: Pressed | None, nodes: Indices, problem: ScaledProblem) -> tuple[Array, Array] | None:
    """Bound f dp and shear 2 dq of the last increment of P, where P alone acts on coupled bodies; otherwise None."""
    if not first or not problem.path or problem.path.moves:
        return None
    p, q = first.growth
    return first.f[nodes] * np.maximum(p[nodes], 0.0), 2 * q[nodes]


def shear_kinks(problem: ScaledProblem, line: DiscreteBody, nodes: Indices, history: History) -> tuple[float, ...]:
    """Points where slip, or the traction at the start of the path, leaves a kink in q1 or q2.

    If half a cycle suffices, the only kinks are the ends of the stick zone, and the result is empty.
    """
    if history.path.half:
        return ()
    x, vertices, forces = line.x[nodes], line.x[:: line.order], partial(_forces_of, line, nodes)
    found = finest(problem.start[1].x) if problem.start else []
    for q, bound in reversed(history.visited):
        found += kinks(x, bound, q, vertices, forces)
    found += history.turning(x)
    return tuple(apart(found, _SAME_KINK * (x[-1] - x[0]) / 2))


def _forces_of(line: DiscreteBody, nodes: Indices, forces: Array) -> Array:
    """Force on each cell of the contact line, from ``forces`` on some ``nodes``."""
    on_line = np.zeros(len(line.x))
    on_line[nodes] = forces
    return _cell_forces(line, on_line)


def _cell_forces(line: DiscreteBody, forces: Array) -> Array:
    """Integral over each cell of the traction that is equivalent to nodal ``forces`` (n,)."""
    resultant = traction(line, forces).antiderivative()
    return np.diff(resultant(line.x[:: line.order]))
