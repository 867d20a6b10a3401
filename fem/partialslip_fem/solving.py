"""Solving a problem on one mesh of each body: mesh, condense, contact and friction, zones."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from partialslip.friction import coulomb_constant_pressure, coulomb_coupled, coulomb_varying_pressure, step_errors
from partialslip.friction.active_set import Solution
from partialslip.friction.coupled_step import Pivot, Relative
from partialslip.friction.even_gap import PARABOLA
from partialslip.friction.history import History, certified
from partialslip.friction.load_path import Path, stretched
from partialslip.friction.normal import Presses
from partialslip.friction.pressing import Pressed
from partialslip.friction.steps import follow_or_step
from partialslip.friction.warm_start import Trail
from partialslip.friction.work import told_by_finer
from partialslip.friction.zone_ends import NEAREST, VERTICES, within
from partialslip.result import Clock
from partialslip.tools.arrays import Array, Indices
from partialslip.tools.bars import BARS
from partialslip_fem.bodies import Grading, Kept, Shared, bodies_key, condense, mesh_bodies
from partialslip_fem.contact import CondensedBody, relative_compliances
from partialslip_fem.elasticity import DiscreteBody
from partialslip_fem.mesh_solution import MeshSolution
from partialslip_fem.mortar import nodal_forces, projected
from partialslip_fem.problem import ScaledProblem
from partialslip_fem.zones import (
    contact_ends_of,
    growth_when_pressed,
    resultants_of,
    shear_kinks,
    stick_zone_of,
    weighted_means,
)
from partialslip_meshes import Mesh


def mesh_and_solve(
    problem: ScaledProblem,
    width: float,
    grading: Grading,
    clock: Clock,
    keep: Kept | None = None,
    check: bool = False,
    before: MeshSolution | None = None,
    alone: bool = False,
) -> MeshSolution:
    """Mesh the bodies and solve ``problem`` on them.

    Parameters
    ----------
    problem : Problem
    width : float
        Half-width of the blocks that stand for half-planes.
    grading : Grading
        Element sizes.
    clock : Clock
        Counts the CPU seconds of the phases.
    keep : Kept, optional
        Condensed bodies to reuse, and to add the new ones to.
    check : bool
        Whether to check if the load steps suffice (:func:`partialslip.friction.steps.follow_or_step`), and to estimate
        their errors (:attr:`MeshSolution.step_errors`).
    before : MeshSolution, optional
        Solution on other meshes: the search for the zones begins at its zones.
    alone : bool
        Whether the solution shares nothing but kept bodies with earlier ones, so that it is the same to the last digit:
        meshes refined by it are then the same, too.
    """
    key = bodies_key(problem, width, grading)
    if keep and (known := keep.find(key)):
        bodies, shared = known
        return solve_contact(problem, bodies, 0, clock, check, None if alone else shared, before)
    bodies, shared = condense(mesh_bodies(problem, width, grading, clock), problem, width, clock), Shared()
    if keep:
        keep.add(key, bodies, shared)
    try:
        return solve_contact(problem, bodies, len(bodies), clock, check, shared, before)
    except coulomb_coupled.SlidesError as slides:
        slides.factored = len(bodies)
        raise


def solve_on_meshes(
    meshes: Sequence[Mesh],
    problem: ScaledProblem,
    width: float,
    clock: Clock,
    check: bool = False,
    before: MeshSolution | None = None,
) -> MeshSolution:
    """Solve ``problem`` on ``meshes``, in the order of the problem's parts.

    ``width``, ``clock``, ``check`` and ``before`` as for :func:`mesh_and_solve`.
    """
    bodies = condense(meshes, problem, width, clock)
    return solve_contact(problem, bodies, len(bodies), clock, check, before=before)


def solve_contact(
    problem: ScaledProblem,
    bodies: tuple[CondensedBody, ...],
    factored: int,
    clock: Clock,
    check: bool = False,
    shared: Shared | None = None,
    before: MeshSolution | None = None,
) -> MeshSolution:
    """Solve contact and friction of condensed ``bodies`` and find the zones.

    ``factored`` is the number of factorisations made for them; ``clock``, ``check`` and ``before`` as for
    :func:`mesh_and_solve`; ``shared`` is what earlier solutions on these bodies have found.
    """
    shared = shared or Shared()
    with clock.phase("condensation"):
        if problem.coupled not in shared.relative:
            shared.relative[problem.coupled] = relative_compliances(bodies, problem.coupled)
        relative = shared.relative[problem.coupled]
    with clock.phase("contact"):
        line, both = bodies[0].body, _together(problem, relative)
        kept = replace(relative) if all(part.finite for part in problem.parts) else None  # without its factors
        forces = _contact_forces(problem, relative, bodies[0], check, shared, before)
        history, nodes, errors = forces.history, forces.nodes, forces.step_errors
        on_line = partial(_on_line, line, nodes)

        def ends_under(p: Array, q: Array | None) -> tuple[tuple[float, float], Array]:
            """Ends of the contact, and how far those are apart that many and few vertices of the mesh tell, (2,)."""
            read = partial(contact_ends_of, line, p, q, problem.beta if both else 0.0)
            many, few = (read(count=count) for count in (VERTICES, NEAREST))
            return many, np.abs(np.subtract(many, few))

        (left, right), fits = ends_under(forces.pressing.x, on_line(history.q2) if history else None)
        ends_at_1: tuple[float, float] | tuple[()] = ()
        at_first = forces.first
        if history and both and at_first is None:
            at_first = on_line(history.pressures[0])
        if at_first is not None:
            ends_at_1, fits_at_1 = ends_under(at_first, on_line(history.q1) if history else None)
            fits = np.concatenate([fits, fits_at_1])
        growth = growth_when_pressed(forces.pressed, nodes, problem)
        stick = stick_zone_of(line, nodes, history, growth) if history else None
        if stick and growth and forces.pressed:
            stick = forces.pressed.scaled(stick, left, right)
        if stick:  # on a coarse mesh the ends of the stick zone may lie outside the contact
            left_at_1, right_at_1 = ends_at_1 or (left, right)
            stick = replace(stick, left=max(stick.left, left, left_at_1), right=min(stick.right, right, right_at_1))
        if stick and problem.contact_moves:
            left_at_1, right_at_1 = ends_at_1 or (left, right)
            stick = within(stick, (max(left, left_at_1), min(right, right_at_1)), line.x[:: line.order])
        leftmost, rightmost = min([left, *ends_at_1[:1]]), max([right, *ends_at_1[1:]])
        kinks = shear_kinks(problem, line, nodes, history) if history else ()
        kinks = tuple(kink for kink in kinks if leftmost < kink < rightmost)
        passing: tuple[float, ...] = ()
        if stick and history and not (history.path.in_phase or history.path.presses_anew or both):
            # beside the stick zone q1 and q2 are -f p and f p
            passing = tuple(kink for kink in kinks if not stick.left < kink < stick.right)
            kinks = tuple(kink for kink in kinks if kink not in passing)
        path_errors: Mapping[str, float] = {}
        if both:
            path_errors, errors = errors, {}
        if history and forces.pressed:
            errors = step_errors.pressed_together(history, forces.pressed, line.weights, nodes)
        return MeshSolution(
            bodies, factored, nodes, forces.pressing, forces.most, history, left, right, stick, ends_at_1, kinks, both,
            forces.pressed, errors, forces.first, problem.contact_moves, problem.largest, passing, forces.trail,
            path_errors, forces.path_moves, both and problem.beta != 0, kept, fits,
        )  # fmt: skip


def _together(problem: ScaledProblem, C: Relative) -> bool:
    """Whether p and q are solved together, step by step: where ``C`` couples them, or plates are moved."""
    return C.xy is not None or (problem.path is not None and problem.path.actuator is not None)


def _on_line(line: DiscreteBody, nodes: Indices, values: Array) -> Array:
    """``values`` (k,) of the ``nodes``, with zeros at all other nodes of the contact line, (n,)."""
    result = np.zeros(len(line.x))
    result[nodes] = values
    return result


@dataclass(frozen=True)
class _ContactForces:
    """Contact forces on the lower contact line; fields as in :class:`MeshSolution`."""

    pressing: Solution
    most: Array
    history: History | None
    nodes: Indices
    pressed: Pressed | None = None
    step_errors: Mapping[str, float] = field(default_factory=dict)
    first: Array | None = None
    trail: Trail | None = None
    path_moves: Array = field(default_factory=lambda: np.zeros((2, 2)))


def _contact_forces(
    problem: ScaledProblem,
    C: Relative,
    lower: CondensedBody,
    check: bool,
    shared: Shared,
    before: MeshSolution | None,
) -> _ContactForces:
    """Solve p and q together if ``C`` couples them; otherwise p first, then q along the load path."""
    line, stretch = lower.body, lower.stretch
    moved = np.array([stretch[0], stretched(line.x, problem.origin)[1]])
    gap, path, pressed = projected(line, problem.gap, problem.breaks), problem.path, None
    if path and problem.start:
        pressed, locked = (nodal_forces(line, traction) for traction in problem.start)
        path = replace(path, before=locked)
    if path and _together(problem, C):
        trail = Trail(line.x, before.trail if before else None)
        ends = partial(contact_ends_of, line, beta=problem.beta)
        reach = before.half_width if before else None
        along = coulomb_coupled.Nodes(
            line.x,
            line.weights,
            ends,
            partial(resultants_of, line),
            problem.similar,
            problem.sized,
            problem.nearly_similar,
            reach,
            trail,
            means=partial(weighted_means, line),
            under=problem.even_gap or PARABOLA,
            beta=problem.beta,
        )
        near = BARS["q"] * problem.accuracy
        pivot = None if problem.pin is None else Pivot(line.x, problem.pin, 0.0)
        loaded = C, gap, stretch, moved[1], problem.f_at(line.x)
        history, pressing, first = coulomb_coupled.march(*loaded, path, pressed, along, near, pivot)
        nodes = np.flatnonzero(history.bound > 0)
        most = np.max([pressing.x, *history.pressures, *history.around.pressures], axis=0)
        left: step_errors.Errors = {}
        moves = np.zeros((2, 2))
        if check and path.moves:
            other = step_errors.other_steps(path), pressed, replace(along, trail=None), near, pivot
            finer, *_ = coulomb_coupled.march(*loaded, *other)
            left, moves = _path_errors(problem, line, history, finer), step_errors.of_plates(history, finer)
            history = told_by_finer(history, finer)
        return _ContactForces(pressing, most, history.of(nodes), nodes, first, left, None, trail, moves)
    opened = gap if path else gap - problem.strains[1][0] * stretch[1]
    arms = line.x if problem.turns else None
    if problem.pressing:
        presses = Presses(C.yy, opened, arms)
        return _under_varying_pressure(problem, C, lower, presses, problem.pressing, check)
    apart = -((line.x < before.left) | (line.x > before.right)).astype(np.int8) if before else None
    pressing = shared.press(C.yy, opened, arms, apart, problem.moment)
    nodes = np.flatnonzero(pressing.x > 0)
    if not path:
        return _ContactForces(pressing, pressing.x, None, nodes)
    if path.before is not None:
        path = replace(path, before=path.before[nodes])
    assert C.xx is not None
    slipping = before.slipping(line.x[nodes]) if before else None
    tangential = shared.tangential(C.xx, nodes)
    known = tangential.C, moved[:, nodes], pressing.x[nodes], problem.f_at(line.x[nodes])
    history = coulomb_constant_pressure.march(*known, path, tangential, slipping, problem.order)
    return _ContactForces(pressing, pressing.x, history, nodes)


def _path_errors(problem: ScaledProblem, line: DiscreteBody, history: History, finer: History) -> step_errors.Errors:
    """Errors of the load steps of coupled bodies; ``history`` and ``finer`` at all nodes of the contact ``line``."""

    def ends(each: History) -> tuple[float, ...]:
        forces = zip(each.pressures, (each.q1, each.q2), strict=True)
        return tuple(end for p, q in forces for end in contact_ends_of(line, p, q, problem.beta))

    on = [np.flatnonzero(each.bound > 0) for each in (history, finer)]
    zones = stick_zone_of(line, on[0], history.of(on[0])), stick_zone_of(line, on[1], finer.of(on[1]))
    left1, right1, left2, right2 = ends(history)
    half_width = (right1 - left1 if problem.largest == 1 else right2 - left2) / 2
    return step_errors.along_path(history, finer, zones, ends, line.weights, half_width)


def _under_varying_pressure(
    problem: ScaledProblem,
    C: Relative,
    lower: CondensedBody,
    presses: Presses,
    pressing: tuple[tuple[float, float], tuple[float, float]],
    check: bool,
) -> _ContactForces:
    """Solve p anew at each step of the load path, and q of bodies that are not coupled; ``pressing`` are P and M at
    load points 1 and 2."""
    line, path, history, holding = lower.body, problem.path, None, presses
    first, second = (presses(*loads) for loads in pressing)
    left: step_errors.Errors = {}
    if path:
        assert C.xx is not None
        if problem.start:
            path = replace(path, before=nodal_forces(line, problem.start[1]))
        at_largest = (first if problem.largest == 1 else second).x
        half_width = float(np.subtract(*contact_ends_of(line, at_largest)[::-1])) / 2
        if not any(part.finite for part in problem.parts):  # see partialslip.friction.coulomb_varying_pressure.march
            gap = projected(line, problem.gap, problem.breaks)
            holding = Presses(C.xx, gap, line.x if problem.turns else None)

        moved = np.array([lower.stretch[0], stretched(line.x, problem.origin)[1]])
        f = problem.f_at(line.x)

        def along(path: Path) -> History:
            return coulomb_varying_pressure.march(line.x, C.xx, moved, f, holding, path, problem.order)  # type: ignore[arg-type]

        def errors(history: History, gradual: History) -> step_errors.Errors:
            on = [np.flatnonzero(each.bound > 0) for each in (history, gradual)]
            zones = stick_zone_of(line, on[0], history.of(on[0])), stick_zone_of(line, on[1], gradual.of(on[1]))
            return step_errors.of_steps(history, gradual, zones, line.weights, half_width)

        history, left = follow_or_step(along, path, problem.accuracy, errors if check else None)
    done = [*presses.solutions, *(holding.solutions if holding is not presses else [])]
    most = np.maximum.reduce([each.x for each in done])
    together = replace(certified(done), x=second.x, rest=second.rest)
    nodes = np.flatnonzero((first.x > 0) | (second.x > 0))
    history = history.of(nodes) if history else None
    return _ContactForces(together, most, history, nodes, None, left, first.x)
