"""How the plates of two finite bodies move, from the forces between the bodies; scaled."""

import math
from contextlib import suppress

import numpy as np
import scipy.linalg as la

from partialslip.friction.coupled_step import Relative
from partialslip.friction.load_path import stretched
from partialslip.friction.path_following import Bounds, Follower
from partialslip.result.plates import Plates
from partialslip.tools.arrays import Array, Indices, submatrix
from partialslip.tools.errors import PartialslipError
from partialslip_fem.mesh_solution import MeshSolution
from partialslip_fem.mortar import projected
from partialslip_fem.problem import ScaledProblem

_SAFE = 2.0  # accuracy: on the error of the elements away from the ends of the contact (measured on rigs)
# accuracy: of the error of q that pressing in steps locks in: that of the displacement, relative (measured on rigs)
_OF_LOCKED = 5e-3
_FEWEST = 4  # limit: nodes in contact of which two can be left out


def plates_of(problem: ScaledProblem, solution: MeshSolution) -> Plates | None:
    """Plates of the two finite bodies of ``solution``; None if a body is a half-plane, or without friction."""
    C, history = solution.relative, solution.history
    if not C or not history:
        return None
    last = solution.pressing.x
    first = last if solution.first is None else solution.first
    gap, lower = projected(solution.lower, problem.gap, problem.breaks), solution.bodies[0]
    opened = [gap - strain * lower.stretch[1] for strain, _ in problem.strains]
    sheared = [solution.on_line(q) for q in history.at_ends]
    x, pin, on = solution.lower.x, problem.pin, np.flatnonzero(last > 0)
    opened = [gap - angle * x for gap, angle in zip(opened, history.angles, strict=True)]
    at_points = np.array([float(each.x.sum()) for each in history.points[-len(history.path.cycle) :]])
    return Plates(
        at_points=at_points,
        displacement=np.array(history.shifts),
        approach=np.array([_approach(C, *each) for each in zip((first, last), sheared, opened, strict=True)]),
        compliance=_stuck_between(C, x, on, (solution.left, solution.right), pin),
        loop=_loop(problem, solution, C, at_points),
        turn=None if pin is None else np.array(history.angles),
    )


def _loop(problem: ScaledProblem, solution: MeshSolution, C: Relative, at_points: Array) -> Array:
    """Displacement of the plates, from where the last cycle begins, and Q, (k, 2), along this cycle.

    Mirror images under constant pressure are followed event by event; the loads, and Q ``at_points`` (c,), are known.
    Others are where their load steps end.
    """
    history = solution.history
    assert history
    assert C.xx is not None
    if C.xy is None and problem.pin is None and not history.path.presses_anew:
        with suppress(PartialslipError):  # so near to sliding, or so fine, that rounding decides which nodes stick
            return _followed(problem, solution, C.xx, at_points)
    moved, Q = history.around.shifts, history.around.forces.sum(axis=1)
    return np.column_stack([np.append(0.0, moved), np.append(Q[-1], Q)])


def _followed(problem: ScaledProblem, solution: MeshSolution, C: Array, at_points: Array) -> Array:
    """Loop of mirror images, event by event; see :func:`_loop`."""
    line, nodes, history = solution.lower, solution.nodes, solution.history
    assert history
    bound, follower = history.bound, Follower(submatrix(C, nodes, nodes))
    stretch = np.array([solution.bodies[0].stretch[0], stretched(line.x, problem.origin)[1]])[:, nodes]
    cycle = history.path.cycle
    forces, moved, Q = history.points[-1 - len(cycle)].x, 0.0, at_points[-1]
    loop = [np.array([[moved, Q]])]
    for before, load, at_end in zip((cycle[-1], *cycle), cycle, at_points, strict=False):
        change = np.subtract(load[1:3], before[1:3]) @ stretch
        leg = follower.leg(Bounds.constant(bound), np.clip(forces, -bound, bound), change, at_end - Q)
        share, shift = leg.moves.T
        loop.append(np.column_stack([moved + shift, Q + share * (at_end - Q)])[1:])
        forces, moved, Q = leg.forces, moved + leg.shift, at_end
    return np.concatenate(loop)


def compliance_error(
    problem: ScaledProblem, solution: MeshSolution, other: MeshSolution, of_ends: float
) -> float | None:
    """Error of the plates' compliance by ``solution``, relative; None if it has no plates.

    Two independent parts, as root of the sum of squares. Bodies that stick on the same elements are compared with
    those of the ``other`` solution, whose elements are of another order: errors of singular corners fall with the
    order k like k^(-4 e), with the exponent e of the displacements there. What sticks ends somewhere between the last
    node and the next, and so does the contact: they are apart by its distance from the farther of both nodes, and by
    the error ``of_ends`` (in contact half-widths) of the contact.
    """
    C, D = solution.relative, other.relative
    if not C or not D or not solution.history:
        return None
    (first, last), (another, final) = _touching(solution), _touching(other)
    k, j = solution.lower.order, other.lower.order
    begin, end = max(-(-first // k), -(-another // j)), min(last // k, final // j)  # vertices, which both share
    x, on, across = solution.lower.x, np.arange(begin * k, end * k + 1), np.arange(begin * j, end * j + 1)
    compliance, by_width = _answering(C, x, on, problem.pin)
    unit = np.abs(compliance).max()
    changed = np.abs(compliance - _stuck(D, other.lower.x, across, problem.pin)).max() / unit
    exponents = [exponent for part in problem.parts for exponent in part.exponents.values()]
    elements = _SAFE * changed / abs(1 - (k / j) ** (4 * min(exponents, default=1.0)))
    nodes, ends = x[[[first, first - 1], [last, last + 1]]], np.array([[solution.left], [solution.right]])
    apart = float(np.abs(nodes - ends).max(axis=1).sum()) / (x[last] - x[first])
    return math.hypot(elements, np.abs(by_width).max() / unit * (apart + of_ends))


def displacement_error(solution: MeshSolution, plates: Plates, of_compliance: float | None) -> float | None:
    """Error of the displacement of the ``plates`` by ``solution``, under given loads; None if the error of their
    compliance is not known. Q and tension may move the plates opposite ways: the error of the compliance counts for
    each. The load steps of coupled bodies add theirs, and so does the shear that pressing them in steps locks in."""
    if of_compliance is None:
        return None
    C = plates.compliance[0, 0]
    moved, Q = solution.path_moves
    known = plates.displacement[np.isfinite(plates.displacement)]  # not of cycles that were skipped
    most = max(np.abs(known).max(initial=0.0), C * np.abs(plates.at_points).max())
    locked = max(solution.step_errors.get(key, 0.0) for key in ("q1", "q2"))
    return float((of_compliance + _OF_LOCKED * locked) * most + np.nan_to_num(moved + C * Q).max())


def _touching(solution: MeshSolution) -> tuple[int, int]:
    """First and last node in contact at load point 2."""
    on = np.flatnonzero(solution.pressing.x > 0)
    return int(on[0]), int(on[-1])


def _approach(C: Relative, p: Array, q: Array, gap: Array) -> float:
    """Approach of the plates under the forces ``p`` and ``q``, by which the ``gap`` closes: (n,) each."""
    on = p > 0
    opening = C.yy[on] @ p + gap[on]
    if C.xy is not None:
        opening = opening + C.opening[on] @ q
    return float(opening.mean())


def _stuck_between(C: Relative, x: Array, on: Indices, ends: tuple[float, float], pin: float | None) -> Array:
    """Displacements of :func:`_stuck` of bodies that stick from end to end; the last nodes ``on`` the contact are off
    its ``ends`` by up to the distance of the next node."""
    compliance, by_width = _answering(C, x, on, pin)
    return compliance + by_width * np.log((ends[1] - ends[0]) / (x[on[-1]] - x[on[0]]))


def _answering(C: Relative, x: Array, on: Indices, pin: float | None) -> tuple[Array, Array]:
    """Displacements of :func:`_stuck`, and their derivative by the logarithm of the width, from a contact that is
    shorter by a node at both ends; (2, 2) each."""
    compliance = _stuck(C, x, on, pin)
    if len(on) < _FEWEST:
        return compliance, 0 * compliance
    wider = np.log((x[on[-1]] - x[on[0]]) / (x[on[-2]] - x[on[1]]))
    return compliance, (compliance - _stuck(C, x, on[1:-1], pin)) / wider


def _stuck(C: Relative, x: Array, on: Indices, pin: float | None) -> Array:
    """Displacements (2, 2), along x and y, of plates under unit forces, of bodies that stick to each other at the nodes
    ``on``: C F - R u = 0 and R^T F = 1, with one column of R for each direction. A plate on a ``pin`` turns: R has one
    more column, and F no moment about the pin."""
    assert C.xx is not None
    count = len(on)
    across = np.zeros((count, count)) if C.xy is None else submatrix(C.xy, on, on)
    every = np.block([[submatrix(C.xx, on, on), across], [across.T, submatrix(C.yy, on, on)]])
    rigid = np.kron(np.eye(2), np.ones((count, 1)))
    if pin is not None:
        rigid = np.column_stack([rigid, np.append(np.full(count, pin), x[on])])
    stiffness = rigid.T @ la.solve(every, rigid, assume_a="pos")
    return np.linalg.inv(stiffness)[:2, :2]
