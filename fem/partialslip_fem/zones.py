"""Ends of contact and stick zone, and kinks of the shear traction, from nodal forces."""

from functools import partial

import numpy as np

from partialslip.arrays import Array, Indices
from partialslip.condensed.coupled import Pressed
from partialslip.condensed.ends import (
    StickInterval,
    apart,
    finest,
    kinks,
    left_end,
    right_end,
    stick_zone,
    turning_points,
)
from partialslip.condensed.history import History
from partialslip_fem.elasticity import Body
from partialslip_fem.problem import Problem
from partialslip_fem.recovery import traction

_SAME_KINK = 1e-3  # of the contact half-width: kinks nearer to each other count as one


def contact_ends(line: Body, normal: Array) -> tuple[float, float]:
    """Ends of the contact under ``normal`` forces (n,) on the nodes of the contact line."""
    forces, touching = _cell_forces(line, normal), line.x[normal > 0]
    vertices = line.x[:: line.order]
    return left_end(vertices, forces, touching), right_end(vertices, forces, touching)


def stick_zone_of(
    line: Body, nodes: Indices, history: History, growth: tuple[Array, Array] | None = None
) -> StickInterval:
    """Stick zone of ``history`` on the contact ``nodes`` of the ``line``.

    ``growth`` are the bound and the change of q to use instead of the history's, (k,) each (see
    :func:`growth_when_pressed`).
    """
    bound, change = growth or (history.bound, history.change)
    forces_of = partial(_forces_of, line, nodes)
    return stick_zone(line.x[nodes], bound, change, line.x[:: line.order], forces_of, history.changed, history.unsteady)


def growth_when_pressed(first: Pressed | None, nodes: Indices, problem: Problem) -> tuple[Array, Array] | None:
    """Bound f dp and shear 2 dq of the last increment of P, where P alone acts on coupled bodies; otherwise None."""
    if not first or not problem.path or problem.path.moves:
        return None
    p, q = first.growth
    return problem.f * np.maximum(p[nodes], 0.0), 2 * q[nodes]


def shear_kinks(problem: Problem, line: Body, nodes: Indices, history: History) -> tuple[float, ...]:
    """Points where slip, or the traction at the start of the path, leaves a kink in q1 or q2.

    If half a cycle suffices, the only kinks are the ends of the stick zone, and the result is empty.
    """
    if history.path.half:
        return ()
    x, vertices, forces = line.x[nodes], line.x[:: line.order], partial(_forces_of, line, nodes)
    found = finest(problem.start[1].x) if problem.start else []
    for q, bound in reversed(history.visited):
        found += kinks(x, bound, q, vertices, forces)
    if history.turns and history.never_slips is not None:
        found += turning_points(x, history.never_slips, history.slips)
    return tuple(apart(found, _SAME_KINK * (x[-1] - x[0]) / 2))


def _forces_of(line: Body, nodes: Indices, forces: Array) -> Array:
    """Force on each cell of the contact line, from ``forces`` on some ``nodes``."""
    on_line = np.zeros(len(line.x))
    on_line[nodes] = forces
    return _cell_forces(line, on_line)


def _cell_forces(line: Body, forces: Array) -> Array:
    """Integral over each cell of the traction that is equivalent to nodal ``forces`` (n,)."""
    resultant = traction(line, forces).antiderivative()
    return np.diff(resultant(line.x[:: line.order]))
