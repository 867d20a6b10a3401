"""The grading of the next mesh: to the zone ends of the present solution, to kinks and to jumps of curvature; and the
errors that the elements at these ends leave."""

import math
from typing import NamedTuple

import numpy as np

from partialslip.friction.coulomb_coupled import HALF
from partialslip.friction.zone_ends import apart
from partialslip.result.refining import worst
from partialslip.tools.arrays import Array
from partialslip.tools.bars import BARS
from partialslip_fem import estimate, goals
from partialslip_fem.bodies import Grading
from partialslip_fem.first_mesh import contact_line_limit
from partialslip_fem.goals import Goal, MeshPlan
from partialslip_fem.mesh_solution import MeshSolution
from partialslip_fem.problem import ScaledProblem

_MERGED = 0.1  # cost: of the smallest element: points nearer to each other are one
# cost: of the element size that a kink needs: the mesh is refined at kinks where it is coarser than this
_KINK_SLACK = 1.5
# cost: element size where bodies of dissimilar materials touch first, in half-widths over the accuracy: p is off there
# by 0.03 times the size (measured). The mesh is refined where elements are larger than this many times
_AT_FIRST, _FIRST_SLACK = 10.0, 3.0
_AT_BENDS = 0.5  # cost: of the error at the ends: error of tractions where the gap's curvature jumps
_OF_HALF = 0.01  # cost: element size at the corners of the second punch of pressing, in half-widths of the contact


def graded(solution: MeshSolution, problem: ScaledProblem, goal: Goal, plan: MeshPlan) -> Grading:
    """Grading of the next mesh, which follows ``plan`` on the way to ``goal``: to the zone ends of ``solution``, to the
    profile's kinks, and to kinks of q1 and q2."""
    a, coarsest, limit = solution.half_width, problem.coarsest, contact_line_limit(problem)
    size, growth, finer = plan.mesh
    margin = (0.1 + 2 * finer * size) * a  # for safety, and for the error of the present ends
    leftmost, rightmost = solution.reach
    contact = (max(leftmost - margin, -limit), min(rightmost + margin, limit))
    kinks, bends = problem.bent(*contact)  # others are not in contact
    ends = solution.zone_ends.tolist()
    points = apart([*ends, *kinks.tolist()], size * a)
    sizes = dict.fromkeys(points, size * a / coarsest)
    if not solution.dissimilar:  # between dissimilar bodies q has a kink there that no slip makes, of unknown strength
        at_bends = np.maximum(estimate.bend_sizes(solution, bends, _AT_BENDS * goal.end_error), size)
        needed = dict(zip(kinks.tolist(), (at_bends * a / coarsest).tolist(), strict=True))
        sizes |= {point: needed[point] for point in points if point in needed and point not in ends}
    eased = goals.eased(solution, problem, plan.order, growth)
    outline = plan.outline
    grading = Grading(contact, sizes, growth / coarsest, None, outline.facet_error, outline.corner_error, eased)

    def refine(point: float, size: float, slack: float = 1.0) -> None:
        """Elements of the ``size``, in half-widths, at a ``point`` where they are larger than ``slack`` times."""
        size = size * a / coarsest
        if grading.at(np.array([point]))[0] > slack * size:
            sizes[point] = size

    at_kinks = np.clip(estimate.kink_sizes(solution, goal.end_error * BARS["q1"]), size, None)
    for kink, wanted in zip(solution.kinks, at_kinks.tolist(), strict=True):
        refine(kink, wanted, _KINK_SLACK)
    for kink in solution.passing:
        refine(kink, goals.PASSING * math.sqrt(goal.accuracy), _KINK_SLACK)
    for low, high, wanted in goals.swept(solution, goal.accuracy):
        inner = wanted / coarsest
        count = int(np.ceil((high - low) / (2 * inner * coarsest)))
        if inner > sizes[points[0]]:
            sizes |= dict.fromkeys(np.linspace(low, high, count + 2)[1:-1].tolist(), inner)
    if problem.sized:
        middle = (solution.left + solution.right) / 2
        for point in (middle - HALF * a, middle + HALF * a):  # corners of the second punch of pressing
            refine(point, _OF_HALF)
    if (first := problem.touches_first) is not None:
        refine(first, _AT_FIRST * goal.accuracy, _FIRST_SLACK)
    sizes |= goals.at_kinks_of_friction(solution, problem, goal.accuracy, grading, coarsest)
    # two vertices far nearer to each other than elements are wide make an element without an area
    kept = apart(sorted(sizes, key=lambda point: sizes[point]), _MERGED * min(sizes.values()))
    for point in set(sizes).difference(kept):
        del sizes[point]
    return grading


class EndErrors(NamedTuple):
    """Errors due to the elements at the ends of zones, to jumps of the gap's curvature, to round faces and to corners.

    Parameters
    ----------
    errors : dict of float
        Of ends in contact half-widths, of tractions relative.
    at_ends, at_vertices : float
        The worst without those at kinks of q; the same if the ends were at vertices.
    largest : float
        Size of the largest element at an end as it was planned, in contact half-widths.
    """

    errors: dict[str, float]
    at_ends: float
    at_vertices: float
    largest: float

    @classmethod
    def of(
        cls, solution: MeshSolution, problem: ScaledProblem, plan: MeshPlan, grading: Grading, a: float
    ) -> "EndErrors":
        """Errors at the zone ends of ``solution`` on the mesh made by ``plan`` and ``grading``; ``a`` is the contact
        half-width."""
        ends = solution.zone_ends
        in_coarsest = problem.coarsest / problem.parts[0].fineness / a
        at_ends, at_kinks = (
            solution.element_sizes(points) * in_coarsest for points in (ends, np.array(solution.kinks))
        )
        if grading.eased:  # beside the point that it is graded to, a mesh that grows fast is a poor one
            beside = np.abs(ends[:, None] - np.array([*grading.sizes])).min(axis=1)
            at_ends = at_ends * (1 + beside / (plan.mesh.size * a))
        kinks, bends = problem.bent(solution.left, solution.right)
        of_bends = estimate.bend_errors(solution, bends, solution.element_sizes(kinks) * in_coarsest)
        gaps = goals.gaps(solution, problem)

        def errors(inside: Array, at_kinks: Array) -> dict[str, float]:
            found = estimate.end_errors(solution, at_ends, inside, gaps, at_kinks)
            found |= {key: math.hypot(found[key], error) for key, error in of_bends.items()}
            return {key: error + plan.outline.errors.get(key, 0.0) for key, error in found.items()}

        inside, none = solution.inside(ends), 0 * at_kinks
        largest = grading.at(ends).max() * problem.coarsest / a
        return cls(errors(inside, at_kinks), worst(errors(inside, none)), worst(errors(0 * inside, none)), largest)
