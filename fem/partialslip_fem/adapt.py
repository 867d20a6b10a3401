"""Adaptive refinement: each mesh is fine where the mesh before found the ends of the contact and of the stick zone."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from partialslip.result import Clock, Pace
from partialslip.result.refining import Refinable, refine, worst
from partialslip.tools.errors import InputError
from partialslip_fem import estimate, goals, solving
from partialslip_fem.bodies import Kept
from partialslip_fem.first_mesh import FIRST_SIZE, contact_line_limit, solve_on_first_mesh, too_narrow, widened
from partialslip_fem.goals import Goal, MeshPlan, NextMesh
from partialslip_fem.grading import EndErrors, graded
from partialslip_fem.load_steps import LoadSteps
from partialslip_fem.mesh_solution import Adapted, MeshSolution
from partialslip_fem.plates import compliance_error
from partialslip_fem.problem import ScaledProblem

_CALMER = (0.4, 0.85)  # cost: smallest and largest factor of the growth after a mesh whose error is too large
# cost: error aimed below, and inverse power of the growth that errors fall with where zone ends wander
_WANDERING = 1.5, 0.5
# cost: factor by which the error must fall from mesh to mesh for another one to be made; where zone ends wander, the
# error falls with the elements at both ends of the zone, by 1.2 to 1.4 a mesh
_FALLS = {False: 2.0, True: 1.25}
_WAITS = 2  # cost: meshes in a row without an estimate of the error away from the ends, after a first one
_MOST_UNKNOWNS = 200_000  # limit: on a mesh from which no finer one is made
_MOST_CUTS = 16  # limit: meshes whose contact line cuts the contact; the next line is a tenth of a wider on both sides
_WITH_ESTIMATE = 2  # cost: seconds of a mesh and of the second solution of its error estimate, in those of the mesh
# accuracy: The order below costs least, but P2 and P1 lock towards nu = 0.5, so that their differences are no errors.
_NEIGHBOUR = {1: 2, 2: 3, 3: 4, 4: 3, 6: 5}


def adapt(
    problem: ScaledProblem,
    accuracy: float,
    width: float,
    clock: Clock,
    progress: Callable[[str], None],
    keep: Kept | None = None,
) -> Adapted:
    """Refine until the ends are known to ``accuracy``, by the estimates of :mod:`partialslip_fem.estimate`.

    Errors of elements of order k decrease with the 2 k-th power of their growth away from the ends; from them follows
    the growth of the next mesh. The error away from the ends costs a second solution and is estimated only where the
    elements at the ends are small enough. Load steps are chosen on the first mesh that is fine enough and kept; the
    mesh is not refined to make up for their error.

    With an allowance of CPU seconds the same meshes are made until the next one is not likely to fit, by the growth of
    the last two; errors are estimated once at least. The solution with the smallest estimate is returned.

    Parameters
    ----------
    problem : Problem
    accuracy : float
        In contact half-widths for ends; tractions have bars in proportion (:data:`partialslip.tools.bars.BARS`).
    width : float
        Half-width of blocks that stand for half-planes, in contact half-widths.
    clock : Clock
        Counts the CPU seconds; may have an allowance.
    progress : callable
        Called with one line after each mesh.
    keep : Kept, optional
        Condensed bodies of the first mesh, to reuse and to add to.

    Raises
    ------
    InputError
        If the contact does not fit on a finite body, or wider and wider contact lines do not enclose it.
    """
    refinement = _Refinement(problem, accuracy, width, clock, keep)
    found = refine(refinement, progress)
    settled = max(problem.accuracy, found.error / goals.BAR) if clock.limited else None
    meshes, factored, iterations = refinement.work
    return replace(found, meshes=meshes, factorizations=factored, iterations=iterations, settled=settled)


@dataclass(frozen=True, kw_only=True)
class _OnMesh(Adapted):
    """The solution on a mesh with blocks of half-width ``block_width``, and whether this is ``eased``; its errors due
    to the elements at the ``ends``, besides all errors, which are empty where those away from the ends are not
    estimated. ``calmer``: factor of the growth of the next mesh."""

    block_width: float
    eased: bool
    ends: EndErrors
    calmer: float = 1.0

    @property
    def unknowns(self) -> str:
        return f"{self.solution.dofs:,} unknowns"

    @property
    def error(self) -> float:
        """The worst error, infinite where it is not estimated."""
        return worst(self.errors) if self.errors else math.inf

    @property
    def located(self) -> bool:
        """Whether the contact is enclosed and the elements at its ends are small enough for error estimates."""
        return self.solution.enclosed and bool(self.ends.largest <= goals.COARSEST)


class _Refinement(Refinable[_OnMesh]):
    """What the next mesh follows from besides the one before: the ``goal``, the load ``steps``, the ``plan`` of that
    mesh, the ``least`` growth, and the last error that was estimated on meshes before (``error_before``)."""

    def __init__(self, problem: ScaledProblem, accuracy: float, width: float, clock: Clock, keep: Kept | None) -> None:
        self.clock, self.width, self.steps = clock, width, LoadSteps(problem, clock)
        self.first, self.meshes, self.factored = solve_on_first_mesh(problem, width, clock, keep, alone=True)
        self.iterations = self.first.iterations
        self.goal = goal = Goal.at(accuracy, problem)
        self.least, first = goal.growth, NextMesh(FIRST_SIZE, 0.0, goals.FINER)
        self.plan = MeshPlan(first, problem.order, 0.0, goal.outline)
        self.error_before = math.inf
        self.waited = self.cuts = 0

    def refined(self, before: _OnMesh | None) -> _OnMesh:
        """Solve on the next mesh; choose the load steps on the first one that is fine enough."""
        last, problem = self.first, self.steps.problem
        if before:
            last = before.solution
            self._learn(before)
        a = last.half_width
        self.plan = plan = self.goal.plan(self.plan, last, problem, self.least)
        grading, width = graded(last, problem, self.goal, plan), widened(self.width, last)
        choose = not self.steps.chosen and plan.mesh.size <= goals.COARSEST
        on_mesh = replace(problem, order=plan.order)
        solution = solving.mesh_and_solve(on_mesh, width * a, grading, self.clock, None, choose, last)
        self.meshes, self.factored = self.meshes + 1, self.factored + solution.factored
        self.iterations += solution.iterations
        solution = self.steps.on_mesh(solution, last, choose)
        if choose and not solution.coupled:
            self.goal = Goal.at(max(self.goal.accuracy, worst(solution.step_errors)), problem)
        if not solution.enclosed and max(-solution.reach[0], solution.reach[1]) >= contact_line_limit(problem):
            raise too_narrow(problem)
        ends, eased = EndErrors.of(solution, problem, plan, grading, a), grading.eased is not None
        found = _OnMesh(solution, {}, *self.work, width, block_width=width * a, eased=eased, ends=ends)
        return self._estimated_in_time(found)

    def finished(self, found: _OnMesh) -> bool:
        """Whether ``found`` is accurate enough, or a finer mesh would not improve it; never where the contact line cuts
        the contact."""
        accurate = found.located and found.error <= self._bar(found.solution)
        stagnates = self.error_before / _FALLS[found.solution.wanders] < found.error < math.inf
        large = found.solution.dofs > _MOST_UNKNOWNS * found.calmer**2
        return self.valid(found) and (accurate or stagnates or large)

    def fits(self, pace: Pace, found: _OnMesh) -> bool:
        return pace.fits(1 if found.errors else _WITH_ESTIMATE)

    def valid(self, found: _OnMesh) -> bool:
        """Whether the contact line encloses the contact; finer load steps may lead to a wider one."""
        return found.solution.enclosed

    def checked(self, found: _OnMesh) -> _OnMesh:
        return replace(found, solution=self.steps.checked(found.solution))

    def estimated(self, found: _OnMesh) -> _OnMesh:
        """Solve once more with elements of the neighbouring order, for the errors away from the ends."""
        if found.errors:
            return found
        solution = found.solution
        problem = replace(self.steps.problem, order=solution.lower.order)
        other = neighbour(solution, problem, found.block_width, self.clock)
        self.factored, self.iterations = self.factored + other.factored, self.iterations + other.iterations
        corner = goals.corner(solution, problem)
        smooth = estimate.smooth_errors(solution, other, found.eased, problem.breaks, corner)
        errors = estimate.combined(solution, smooth, found.ends.errors)
        plates = compliance_error(problem, solution, other, errors["a"])
        times, power = _WANDERING if solution.wanders else (3, 0.5 / self.steps.problem.order)
        calmer = float(np.clip((times * worst(smooth) / self._bar(solution)) ** -power, *_CALMER))
        return replace(found, errors=errors, plates_error=plates, other=other.history, calmer=calmer)

    @property
    def work(self) -> tuple[int, int, int]:
        """Meshes, factorisations and linear solves up to now."""
        return self.meshes, self.factored, self.iterations + self.steps.iterations

    def _bar(self, solution: MeshSolution) -> float:
        """Largest error of the mesh that is accepted; the load steps have their share, but for those of coupled bodies,
        which are as many as their errors call for."""
        steps = 0.0 if solution.coupled else worst(solution.step_errors)
        return max(self.goal.bar - steps, self.goal.bar / 2)

    def _learn(self, before: _OnMesh) -> None:
        """Choose growth and refinement of the next mesh from the errors of the mesh ``before``.

        Raises InputError if too many contact lines cut the contact.
        """
        self.cuts += not before.solution.enclosed
        if self.cuts > _MOST_CUTS:
            raise InputError(
                f"fem.accuracy = {self.steps.problem.accuracy:g}: must be replaced by fem.size, or use march: the "
                f"contact reaches the ends of {self.cuts} contact lines"
            )
        if before.errors:
            self.error_before, self.least = before.error, self.least * before.calmer
        if self.plan.arrived:
            # an end inside an element needs a vertex, not smaller elements; these where it had one that did not help
            mesh, ends, bar = self.plan.mesh, before.ends, self._bar(before.solution)
            error = ends.at_ends if mesh.finer == 1 and ends.at_ends > bar else ends.at_vertices
            self.plan = self.plan._replace(mesh=mesh._replace(finer=min(max(3 * error / bar, 1.0), goals.FINER)))

    def _estimated_in_time(self, found: _OnMesh) -> _OnMesh:
        """Estimate the error away from the ends, if the error of the ends is small enough or no smaller one is to
        come. A contact that is cut is not the one whose errors count."""
        solution, bar = found.solution, self._bar(found.solution)
        if solution.lower.order < self.steps.problem.order:
            return found  # a mesh on the way
        fine = found.located and found.ends.at_ends <= bar
        self.waited = self.waited + 1 if self.error_before < math.inf or fine else 0
        last = self.plan.mesh.size <= goals.FINEST or solution.dofs > _MOST_UNKNOWNS or self.waited > _WAITS
        if not solution.enclosed or not (last or (fine and worst(found.ends.errors) <= bar)):
            return found
        self.waited = 0
        return self.estimated(found)


def neighbour(solution: MeshSolution, problem: ScaledProblem, width: float, clock: Clock) -> MeshSolution:
    """Solve ``problem`` on the meshes of ``solution`` with elements of the neighbouring order.

    ``width`` and ``clock`` as for :func:`partialslip_fem.solving.solve_on_meshes`.
    """
    return solving.solve_on_meshes(
        [body.mesh for body in solution.bodies],
        replace(problem, order=_NEIGHBOUR[problem.order]),
        width,
        clock,
        before=solution,
    )
