"""Solving a problem on one mesh of each body: mesh, condense, contact and friction, zones."""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from partialslip.friction import coulomb_constant_pressure, coulomb_coupled, coulomb_varying_pressure, step_errors
from partialslip.friction.active_set import Solution, spread
from partialslip.friction.contact_line import ContactLine, Ends, common_ends, passing
from partialslip.friction.coupled_step import Pivot, Relative
from partialslip.friction.even_gap import PARABOLA
from partialslip.friction.history import History, certified
from partialslip.friction.load_path import Path, stretched
from partialslip.friction.normal import Presses
from partialslip.friction.pressing import Pressed
from partialslip.friction.steps import follow_or_step
from partialslip.friction.warm_start import Trail
from partialslip.friction.work import told_by_finer
from partialslip.friction.zone_ends import NEAREST, VERTICES, apart, finest
from partialslip.result import Clock
from partialslip.tools.arrays import Array
from partialslip.tools.bars import BARS
from partialslip_fem.bodies import Grading, Kept, Shared, bodies_key, condense, mesh_bodies
from partialslip_fem.contact import CondensedBody, relative_compliances
from partialslip_fem.mesh_solution import ContactForces, MeshSolution, Zones
from partialslip_fem.mortar import nodal_forces, projected
from partialslip_fem.problem import ScaledProblem
from partialslip_fem.recovery import contact_line
from partialslip_meshes import Mesh

_SAME_KINK = 1e-3  # accuracy: of the contact half-width: kinks nearer to each other count as one


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
        contact = _Contact(problem, relative, bodies[0], before)
        forces = contact.forces(check, shared)
        zones = contact.zones(forces)
        return MeshSolution(
            bodies=bodies,
            factored=factored,
            relative=replace(relative) if all(part.finite for part in problem.parts) else None,  # without its factors
            coupled=contact.together,
            dissimilar=contact.together and problem.beta != 0,
            moving=problem.contact_moves,
            largest=problem.largest,
            **vars(forces),
            **vars(zones),
        )


class _Contact:
    """Contact and friction on the lower contact line of two condensed bodies with the relative compliances ``C``.

    p and q are solved ``together``, step by step, where ``C`` couples them, or plates are moved; otherwise p first, and
    then q along the load path.
    """

    def __init__(self, problem: ScaledProblem, C: Relative, lower: CondensedBody, before: MeshSolution | None) -> None:
        body = lower.body
        self.problem, self.C, self.before, self.path = problem, C, before, problem.path
        self.line = contact_line(body, problem.beta)
        self.gap, self.f = projected(body, problem.gap, problem.breaks), problem.f_at(body.x)
        self.stretch = lower.stretch
        if not self.path:  # tension is part of the path
            self.gap = self.gap - problem.strains[1][0] * self.stretch[1]
        self.moved = np.array([self.stretch[0], stretched(body.x, problem.origin)[1]])
        self.arms = body.x if problem.turns else None
        self.pressed: Array | None = None  # normal forces at the beginning of the path
        if self.path and problem.start:
            self.pressed, locked = (nodal_forces(body, traction) for traction in problem.start)
            self.path = replace(self.path, before=locked)
        self.together = C.xy is not None or (self.path is not None and self.path.actuator is not None)

    def forces(self, check: bool, shared: Shared) -> ContactForces:
        """Forces along the load path; ``check`` and ``shared`` as for :func:`solve_contact`."""
        if self.path and self.together:
            return self._of_both_together(self.path, check)
        if self.problem.pressing:
            return self._under_varying_pressure(self.problem.pressing, check)
        return self._under_constant_pressure(shared)

    def _of_both_together(self, path: Path, check: bool) -> ContactForces:
        problem, line, before = self.problem, self.line, self.before
        growth = coulomb_coupled.Growth(
            problem.similar,
            problem.sized,
            problem.nearly_similar,
            near=before.half_width if before else None,
            under=problem.even_gap or PARABOLA,
        )

        def march(path: Path, trail: Trail | None) -> tuple[History, Solution, Pressed | None]:
            loaded = self.C, self.gap, self.stretch, self.moved[1], self.f, path, line, growth, self.pressed
            pivot = None if problem.pin is None else Pivot(line.x, problem.pin, 0.0)
            return coulomb_coupled.march(*loaded, BARS["q"] * problem.accuracy, trail, pivot)

        trail = Trail(line.x, before.trail if before else None)
        history, pressing, pressed = march(path, trail)
        most = np.max([pressing.x, *history.pressures, *history.around.pressures], axis=0)
        nodes = np.flatnonzero(history.bound > 0)
        own, first = history.of(nodes), history.pressures[0]
        locked = step_errors.pressed_together(own, pressed, line.weights, nodes) if pressed else {}
        found = ContactForces(nodes, pressing, most, own, first, pressed, locked, trail=trail)
        if check and path.moves:
            finer, *_ = march(step_errors.other_steps(path), None)
            errors = step_errors.along_path(line, history, finer, problem.largest)
            moves, known = step_errors.of_plates(history, finer), told_by_finer(history, finer).of(nodes)
            found = replace(found, history=known, path_errors=errors, path_moves=moves)
        return found

    def _under_constant_pressure(self, shared: Shared) -> ContactForces:
        line, before = self.line, self.before
        apart = -((line.x < before.left) | (line.x > before.right)).astype(np.int8) if before else None
        pressing = shared.press(self.C.yy, self.gap, self.arms, apart, self.problem.moment)
        nodes, path = np.flatnonzero(pressing.x > 0), self.path
        if not path:
            return ContactForces(nodes, pressing, pressing.x)
        if path.before is not None:
            path = replace(path, before=path.before[nodes])
        assert self.C.xx is not None
        slipping = before.slipping(line.x[nodes]) if before else None
        tangential = shared.tangential(self.C.xx, nodes)
        known = tangential.C, self.moved[:, nodes], pressing.x[nodes], self.f[nodes]
        history = coulomb_constant_pressure.march(*known, path, tangential, slipping, self.problem.order)
        return ContactForces(nodes, pressing, pressing.x, history)

    def _under_varying_pressure(self, loads: Sequence[tuple[float, float]], check: bool) -> ContactForces:
        """p anew at each step of the load path, and under the ``loads`` P and M at load points 1 and 2."""
        problem, line, path, history, errors = self.problem, self.line, self.path, None, step_errors.Errors()
        presses = holding = Presses(self.C.yy, self.gap, self.arms)
        first, second = (presses(*each) for each in loads)
        if path:
            assert self.C.xx is not None
            left, right = line.ends((first if problem.largest == 1 else second).x)
            # see partialslip.friction.coulomb_varying_pressure.march
            if not any(part.finite for part in problem.parts):
                holding = Presses(self.C.xx, self.gap, self.arms)
            along = partial(
                coulomb_varying_pressure.march, line.x, self.C.xx, self.moved, self.f, holding, few=problem.order
            )
            # where the stick zone ends with the contact, errors count as they are read
            off = partial(step_errors.of_steps, line, half_width=(right - left) / 2, common=(-np.inf, np.inf))
            history, errors = follow_or_step(along, path, problem.accuracy, off if check else None)
        done = [*presses.solutions, *(holding.solutions if holding is not presses else [])]
        most = np.maximum.reduce([each.x for each in done])
        pressing = replace(certified(done), x=second.x, rest=second.rest)
        nodes = np.flatnonzero((first.x > 0) | (second.x > 0))
        return ContactForces(nodes, pressing, most, history.of(nodes) if history else None, first.x, step_errors=errors)

    def zones(self, forces: ContactForces) -> Zones:
        """Ends and kinks of the zones under the ``forces``."""
        line, history, nodes = self.line, forces.history, forces.nodes
        q1, q2 = (spread(q, nodes, len(line.x)) for q in (history.q1, history.q2)) if history else (None, None)
        under = [(forces.pressing.x, q2), *([] if forces.first is None else [(forces.first, q1)])]
        many, few = ([line.ends(*each, count=count) for each in under] for count in (VERTICES, NEAREST))
        fits, ends_at_1 = np.abs(np.subtract(many, few)).ravel(), many[1] if len(many) > 1 else ()
        if not history:
            return Zones(*many[0], ends_at_1, fits, None, (), ())
        touching, pressed = line.on(nodes), forces.pressed and forces.pressed.on(nodes)
        stick = touching.stick_zone(history, common_ends(many), pressed)
        kinks = self._kinks(touching, history, many)
        gone = () if self.together else passing(kinks, stick, history)
        return Zones(*many[0], ends_at_1, fits, stick, tuple(kink for kink in kinks if kink not in gone), gone)

    def _kinks(self, touching: ContactLine, history: History, ends: Sequence[Ends]) -> tuple[float, ...]:
        """Points between the outermost ``ends`` where slip, or the traction at the start of the path, leaves a kink in
        q1 or q2. If half a cycle suffices, the only kinks are the ends of the stick zone, and there are none."""
        if history.path.half:
            return ()
        x, (lefts, rights) = touching.x, zip(*ends, strict=True)
        before = finest(self.problem.start[1].x) if self.problem.start else []
        found = apart([*before, *touching.kinks(history)], _SAME_KINK * (x[-1] - x[0]) / 2)
        return tuple(kink for kink in found if min(lefts) < kink < max(rights))
