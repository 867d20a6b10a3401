"""The errors of one mesh: due to the elements at the ends of zones, and together with those away from the ends."""

import math
from typing import NamedTuple

import numpy as np

from partialslip.friction.history import History
from partialslip.result.refining import worst
from partialslip.tools.arrays import Array
from partialslip_fem import estimate, goals
from partialslip_fem.bodies import Grading
from partialslip_fem.goals import MeshPlan
from partialslip_fem.mesh_solution import MeshSolution
from partialslip_fem.plates import compliance_error
from partialslip_fem.problem import ScaledProblem


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
        """Those of ``solution`` on the mesh that was made by ``plan`` and ``grading``, for a contact of half-width
        ``a``."""
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


class AllErrors(NamedTuple):
    """Errors of a mesh, from a second solution with elements of the neighbouring order.

    Parameters
    ----------
    errors : dict of float
        Of ends in contact half-widths, of tractions relative.
    smooth : float
        The worst one away from the ends.
    plates : float or None
        Of the compliance of the plates, relative.
    other : History or None
        The load path by elements of the neighbouring order.
    """

    errors: dict[str, float]
    smooth: float
    plates: float | None
    other: History | None

    @classmethod
    def of(
        cls, solution: MeshSolution, other: MeshSolution, ends: EndErrors, problem: ScaledProblem, eased: bool
    ) -> "AllErrors":
        """Those of ``solution`` beside the ``other`` one, with the errors at its ``ends``; ``eased``: whether its mesh
        grows faster near these."""
        corner = goals.corner(solution, problem)
        smooth = estimate.smooth_errors(solution, other, eased, problem.breaks, corner)
        errors = estimate.combined(solution, smooth, ends.errors)
        return cls(errors, worst(smooth), compliance_error(problem, solution, other, errors["a"]), other.history)
