"""Adaptive refinement: each mesh is fine where the mesh before found the ends of the contact and of the stick zone."""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from partialslip.friction.coulomb_coupled import HALF
from partialslip.friction.history import History
from partialslip.friction.step_errors import more_steps, steps_matter
from partialslip.friction.zone_ends import apart
from partialslip.result import Clock, Pace
from partialslip.tools.arrays import Array
from partialslip.tools.bars import BARS
from partialslip.tools.errors import InputError
from partialslip_fem import estimate, goals, solving
from partialslip_fem.bodies import Grading, Kept
from partialslip_fem.first_mesh import FIRST_SIZE, contact_line_limit, solve_on_first_mesh, too_narrow, widened
from partialslip_fem.goals import Goal, NextMesh, OutlineErrors, course, gaps, size_reached, worst
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
_MERGED = 0.1  # cost: of the smallest element: points nearer to each other are one
# cost: of the element size that a kink needs: the mesh is refined at kinks where it is coarser than this
_KINK_SLACK = 1.5
_MOST_UNKNOWNS = 200_000  # limit: on a mesh from which no finer one is made
_MOST_CUTS = 16  # limit: meshes whose contact line cuts the contact; the next line is a tenth of a wider on both sides
# cost: element size where bodies of unlike materials touch first, in half-widths over the accuracy: p is off there by
# 0.03 times the size (measured). The mesh is refined where elements are larger than this many times
_AT_FIRST, _FIRST_SLACK = 10.0, 3.0
_AT_BENDS = 0.5  # cost: of the error at the ends: error of tractions where the gap's curvature jumps
_OF_HALF = 0.01  # cost: element size at the corners of the second punch of pressing, in half-widths of the contact
_WITH_ESTIMATE = 2  # cost: seconds of a mesh and of the second solution of its error estimate, in those of the mesh


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
    refinement, pace = _Refinement(problem, accuracy, width, clock, keep), Pace(clock)
    while True:
        refinement.solve_on_next_mesh()
        refinement.estimate_errors()
        pace.took()
        progress(refinement.message())
        if refinement.finished:
            refinement.check_steps()
            if refinement.solution.enclosed:  # finer steps may lead to a wider contact
                return refinement.best()
        elif refinement.solution.enclosed and not pace.fits(1 if refinement.error < np.inf else _WITH_ESTIMATE):
            return refinement.best()
        elif clock.limited and refinement.error < np.inf:
            refinement.keep_best()
        refinement.plan_next_mesh()


class _Refinement:
    """The present solution, its errors, and what the next mesh is to be like.

    ``size``, ``finer`` and ``least`` are the arguments of :func:`partialslip_fem.goals.course`. ``error`` is the worst
    error of the present solution, infinite where the error away from the ends is not estimated; ``error_before`` is
    the last such error.
    """

    def __init__(self, problem: ScaledProblem, accuracy: float, width: float, clock: Clock, keep: Kept | None) -> None:
        self.problem, self.clock = problem, clock
        self.solution, self.meshes, self.factored = solve_on_first_mesh(problem, width, clock, keep, alone=True)
        self.kept: Adapted | None = None  # where seconds are limited: the best solution so far
        self.iterations = self.solution.iterations
        self.asked_width = self.width = width  # of the blocks, in contact half-widths: asked for, and of the next mesh
        self.limit = contact_line_limit(problem)
        self.coarsest = max(part.fineness for part in problem.parts)  # element sizes are those of the coarsest body
        self.goal = Goal.at(accuracy, problem)
        self.size, self.finer, self.least = FIRST_SIZE, goals.FINER, self.goal.growth
        self.size_goal, self.outline = 0.0, self.goal.outline  # of the present mesh
        self.growth = 0.0  # of the present mesh away from the ends
        self.eased = False  # whether the present mesh grows faster near the ends
        self.block_width = 0.0  # width of the blocks of the present mesh
        self.errors, self.end_errors = dict[str, float](), dict[str, float]()
        self.bend_errors: Mapping[str, float] = {}  # of tractions, due to the elements where the gap's curvature jumps
        self.error_at_ends = np.inf  # error due to the elements at ends of zones and at bends, not at kinks of q
        self.error_at_vertices = np.inf  # the same if the ends were at vertices
        self.largest_end_element = np.inf
        self.error, self.error_before, self.calmer = np.inf, np.inf, 1.0
        self.step_errors: Mapping[str, float] | None = None  # None until the steps are chosen
        self.path_errors: Mapping[str, float] = {}  # of the steps of coupled bodies
        self.path_moves = self.solution.path_moves
        self.plates_error: float | None = None  # None until it is estimated
        self.other: History | None = None  # by elements of the neighbouring order, on the present mesh
        self.waited = self.cuts = 0

    @property
    def located(self) -> bool:
        """Whether the contact is enclosed and the elements at its ends are small enough for error estimates."""
        return self.solution.enclosed and bool(self.largest_end_element <= goals.COARSEST)

    @property
    def bar(self) -> float:
        """Largest error of the mesh that is accepted; the load steps have their share."""
        return max(self.goal.bar - worst(self.step_errors or {}), self.goal.bar / 2)

    @property
    def finished(self) -> bool:
        """Whether the present solution is accurate enough, or a finer mesh would not improve it; never where the
        contact line cuts the contact."""
        accurate = self.located and self.error <= self.bar
        falls = _FALLS[self.solution.wanders]
        stagnates = self.error_before / falls < self.error < np.inf
        large = self.solution.dofs > _MOST_UNKNOWNS * self.calmer**2
        return self.solution.enclosed and (accurate or stagnates or large)

    def message(self) -> str:
        """One line on the present mesh."""
        known = f", {', '.join(self.errors)} known to {self.error:.1e} a" if self.error < np.inf else ""
        return f"mesh {self.meshes}: {self.solution.dofs:,} unknowns{known}"

    def check_steps(self) -> None:
        """Check the load steps on the present mesh and estimate their errors anew, where steps matter: the mesh on
        which they were chosen saw less of a stick zone that moves while the loads change. Those of coupled bodies may
        be too few as soon as the errors of pressing have fallen below theirs."""
        if self.solution.coupled:
            self._refine_steps()
            return
        if not steps_matter(self.step_errors or {}, self.problem.accuracy):
            return
        fine = self._solved_again()
        self.solution, self.step_errors = fine, fine.step_errors
        self.iterations += fine.iterations

    def keep_best(self) -> None:
        """Keep the present solution if its estimated errors are smaller than those of the solutions before."""
        error = worst(self.errors)
        if self.kept and error >= worst(self.kept.errors):
            return
        settled = max(self.problem.accuracy, error / goals.BAR) if self.clock.limited else None
        self.kept = Adapted(self.solution, self.errors, 0, 0, 0, self.width, settled, self.plates_error, self.other)

    def best(self) -> Adapted:
        """The solution with the smallest estimate, which is made where there is none, and the work on all meshes."""
        if self.error == np.inf and not self.kept:
            self._estimate_together()
            self.error = worst(self.errors)
        if self.error < np.inf:
            self.keep_best()
        assert self.kept
        made, factored, iterations = self.meshes, self.factored, self.iterations
        return replace(self.kept, meshes=made, factorizations=factored, iterations=iterations)

    def solve_on_next_mesh(self) -> None:
        """Make the next mesh, solve on it, and choose the load steps on the first mesh that is fine enough."""
        problem, a = self.problem, self.solution.half_width
        self.size_goal = self.goal.element_size(self.solution, problem)
        ahead = course(self.size, self.finer, self.size_goal, self.least, problem.order)
        if len(ahead) > 1 and problem.order > goals.ON_THE_WAY:
            problem = replace(problem, order=goals.ON_THE_WAY)
            least = goals.growth_at(self.goal.accuracy, problem.order)
            ahead = course(self.size, self.finer, self.size_goal, least, problem.order)
        if self.solution.enclosed:
            self.size, self.growth, self.finer = ahead[0]
            arrives = size_reached(self.size, self.size_goal)
            self.outline = OutlineErrors.at(self.goal.accuracy, problem, None if arrives else ahead[0])
        planned = NextMesh(self.size, self.growth, self.finer)
        grading = self._grading(self.goal, problem.order, planned)
        self.eased = grading.eased is not None
        self.width = widened(self.asked_width, self.solution)
        self.block_width = self.width * a
        choose = self.step_errors is None and not self.path_errors and self.size <= goals.COARSEST
        self.solution = solving.mesh_and_solve(
            problem, self.block_width, grading, self.clock, None, choose, self.solution
        )
        if choose:
            self._keep_steps()
            self._refine_steps()
        elif self.step_errors is not None:
            self.solution = replace(self.solution, step_errors=self.step_errors)
        if self.solution.path_errors:
            self.path_errors, self.path_moves = self.solution.path_errors, self.solution.path_moves
        self.solution = replace(self.solution, path_errors=self.path_errors, path_moves=self.path_moves)
        solution = self.solution
        self.meshes, self.factored = self.meshes + 1, self.factored + solution.factored
        self.iterations += solution.iterations
        if not solution.enclosed and max(-solution.reach[0], solution.reach[1]) >= self.limit:
            raise too_narrow(self.problem)
        in_coarsest = self.coarsest / problem.parts[0].fineness / a
        at_ends, at_kinks = (
            solution.element_sizes(points) * in_coarsest for points in (solution.zone_ends, np.array(solution.kinks))
        )
        if self.eased:  # beside the point that it is graded to, a mesh that grows fast is a poor one
            beside = np.abs(solution.zone_ends[:, None] - np.array([*grading.sizes])).min(axis=1)
            at_ends = at_ends * (1 + beside / (self.size * a))
        kinks, bends = problem.bent(solution.left, solution.right)
        self.bend_errors = estimate.bend_errors(solution, bends, solution.element_sizes(kinks) * in_coarsest)
        self.largest_end_element = grading.at(solution.zone_ends).max() * self.coarsest / a
        inside = solution.inside(solution.zone_ends)
        self.errors = self.end_errors = self._errors_of_ends(at_ends, inside, at_kinks)
        self.error_at_ends = worst(self._errors_of_ends(at_ends, inside, 0 * at_kinks))
        self.error_at_vertices = worst(self._errors_of_ends(at_ends, 0 * inside, 0 * at_kinks))

    def estimate_errors(self) -> None:
        """Estimate the error away from the ends, if the error of the ends is small enough or no smaller one is to
        come. A contact that is cut is not the one whose errors count."""
        self.error, self.calmer = np.inf, 1.0
        if self.solution.lower.order < self.problem.order:
            return  # a mesh on the way
        fine = self.located and self.error_at_ends <= self.bar
        self.waited = self.waited + 1 if self.error_before < np.inf or fine else 0
        if self.solution.enclosed and (
            (fine and worst(self.end_errors) <= self.bar)
            or self.size <= goals.FINEST
            or self.solution.dofs > _MOST_UNKNOWNS
            or self.waited > _WAITS
        ):
            smooth = self._estimate_together()
            self.error = worst(self.errors)
            times, power = _WANDERING if self.solution.wanders else (3, 0.5 / self.problem.order)
            self.calmer = float(np.clip((times * worst(smooth) / self.bar) ** -power, *_CALMER))
            self.waited = 0

    def plan_next_mesh(self) -> None:
        """Choose refinement and growth of the next mesh from the errors of the present solution.

        Raises InputError if too many contact lines cut the contact.
        """
        self.cuts += not self.solution.enclosed
        if self.cuts > _MOST_CUTS:
            raise InputError(
                f"fem.accuracy = {self.problem.accuracy:g}: must be replaced by fem.size, or use march: the contact "
                f"reaches the ends of {self.cuts} contact lines"
            )
        if size_reached(self.size, self.size_goal):
            # an end inside an element needs a vertex, not smaller elements; these where it had one that did not help
            missed = self.finer == 1 and self.error_at_ends > self.bar
            error = self.error_at_ends if missed else self.error_at_vertices
            self.finer = min(max(3 * error / self.bar, 1.0), goals.FINER)
        if self.error < np.inf:
            self.error_before, self.least = self.error, self.least * self.calmer

    def _grading(self, goal: Goal, order: int, mesh: NextMesh) -> Grading:
        """Grading of the next ``mesh``, with elements of ``order``, on the way to ``goal``: to the zone ends of the
        present solution, to the profile's kinks, and to kinks of q1 and q2."""
        solution, a, coarsest = self.solution, self.solution.half_width, self.coarsest
        margin = (0.1 + 2 * mesh.finer * mesh.size) * a  # for safety, and for the error of the present ends
        leftmost, rightmost = solution.reach
        contact = (max(leftmost - margin, -self.limit), min(rightmost + margin, self.limit))
        kinks, bends = self.problem.bent(*contact)  # others are not in contact
        ends = solution.zone_ends.tolist()
        points = apart([*ends, *kinks.tolist()], mesh.size * a)
        sizes = dict.fromkeys(points, mesh.size * a / coarsest)
        if not solution.dissimilar:  # between unlike bodies q has a kink there that no slip makes, of unknown strength
            at_bends = np.maximum(estimate.bend_sizes(solution, bends, _AT_BENDS * goal.end_error), mesh.size)
            needed = dict(zip(kinks.tolist(), (at_bends * a / coarsest).tolist(), strict=True))
            sizes |= {point: needed[point] for point in points if point in needed and point not in ends}
        at_kinks = np.clip(estimate.kink_sizes(solution, goal.end_error * BARS["q1"]), mesh.size, None)
        eased = goals.eased(solution, self.problem, order, mesh.growth)
        outline = self.outline
        grading = Grading(
            contact, sizes, mesh.growth / coarsest, None, outline.facet_error, outline.corner_error, eased
        )

        def refine(point: float, size: float, slack: float = 1.0) -> None:
            """Elements of the ``size``, in half-widths, at a ``point`` where they are larger than ``slack`` times."""
            size = size * a / coarsest
            if grading.at(np.array([point]))[0] > slack * size:
                sizes[point] = size

        for kink, needed in zip(solution.kinks, at_kinks.tolist(), strict=True):
            refine(kink, needed, _KINK_SLACK)
        for kink in solution.passing:
            refine(kink, goals.PASSING * math.sqrt(goal.accuracy), _KINK_SLACK)
        for low, high, wanted in goals.swept(solution, goal.accuracy):
            size = wanted / coarsest
            count = int(np.ceil((high - low) / (2 * size * coarsest)))
            sizes |= {
                point: size for point in np.linspace(low, high, count + 2)[1:-1].tolist() if size > sizes[points[0]]
            }
        if self.problem.sized:
            middle = (solution.left + solution.right) / 2
            for point in (middle - HALF * a, middle + HALF * a):  # corners of the second punch of pressing
                refine(point, _OF_HALF)
        if (first := self.problem.touches_first) is not None:
            refine(first, _AT_FIRST * goal.accuracy, _FIRST_SLACK)
        sizes |= goals.at_kinks_of_friction(solution, self.problem, goal.accuracy, grading, coarsest)
        # two vertices far nearer to each other than elements are wide make an element without an area
        kept = apart(sorted(sizes, key=lambda point: sizes[point]), _MERGED * min(sizes.values()))
        for point in set(sizes).difference(kept):
            del sizes[point]
        return grading

    def _keep_steps(self) -> None:
        """Keep the load steps of the present solution for all meshes to come, and their errors."""
        solution = self.solution
        if not solution.history or not (solution.coupled or solution.enclosed):
            return
        self.problem = replace(self.problem, path=replace(solution.history.path, before=None))
        if not solution.coupled:
            self.step_errors = solution.step_errors
            self.goal = Goal.at(max(self.goal.accuracy, worst(self.step_errors)), self.problem)

    def _refine_steps(self) -> None:
        """Take more load steps of coupled bodies for all meshes to come, as long as their errors count and
        CPU seconds are left."""
        while (path := self.problem.path) and (before := self.solution).path_errors:
            more = more_steps(path, before.path_errors, before.step_errors, self.problem.accuracy)
            if not more or self.clock.remaining() <= 0:
                return
            self.problem = replace(self.problem, path=more)
            self.solution = self._solved_again()
            self.path_errors, self.path_moves = self.solution.path_errors, self.solution.path_moves
            self._keep_steps()
            self.iterations += before.iterations

    def _solved_again(self) -> MeshSolution:
        """Solve contact and friction once more on the present mesh, and check the load steps."""
        before = self.solution
        return solving.solve_contact(self.problem, before.bodies, before.factored, self.clock, True, before=before)

    def _errors_of_ends(self, at_ends: Array, inside: Array, at_kinks: Array) -> dict[str, float]:
        """Errors due to elements of given sizes at ends, ``inside`` which these lie, and at kinks, to jumps of the
        gap's curvature, to round faces and to corners."""
        found = estimate.end_errors(self.solution, at_ends, inside, gaps(self.solution, self.problem), at_kinks)
        for key, error in self.bend_errors.items():
            found[key] = math.hypot(found[key], error)
        return {key: error + self.outline.errors.get(key, 0.0) for key, error in found.items()}

    def _estimate_together(self) -> dict[str, float]:
        """Solve once more with elements of the neighbouring order and add the errors away from the ends to ``errors``.

        Returns the errors away from the ends.
        """
        problem = replace(self.problem, order=self.solution.lower.order)
        other = estimate.neighbour(self.solution, problem, self.block_width, self.clock)
        self.factored, self.iterations = self.factored + other.factored, self.iterations + other.iterations
        corner = goals.corner(self.solution, self.problem)
        smooth = estimate.smooth_errors(self.solution, other, self.eased, self.problem.breaks, corner)
        self.errors = estimate.combined(self.solution, smooth, self.end_errors)
        self.plates_error = compliance_error(self.problem, self.solution, other, self.errors["a"])
        self.other = other.history
        return smooth
