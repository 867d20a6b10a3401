"""Solving on one mesh with a given element size, or on meshes from files: no refinement, no error estimate."""

from dataclasses import replace

import numpy as np

from partialslip.result import Clock
from partialslip.tools.errors import InputError
from partialslip_fem import solving
from partialslip_fem.bodies import Grading, Kept
from partialslip_fem.first_mesh import contact_line_limit, solve_on_first_mesh, too_narrow, widened
from partialslip_fem.goals import growth_for
from partialslip_fem.mesh_solution import Adapted, MeshSolution
from partialslip_fem.problem import ScaledProblem

_FEWEST = 4  # limit: elements in the contact on a mesh from a file


def uniform(
    problem: ScaledProblem, size: float | None, width: float, clock: Clock, keep: Kept | None = None
) -> Adapted:
    """Solve on one mesh with elements of one size all along the contact line.

    The mesh does not depend on friction and shear: with ``keep`` these can change without a new factorisation.

    Parameters
    ----------
    problem : Problem
    size : float or None
        Element size in contact half-widths. None: the size of the elements in the mesh files. If all bodies have mesh
        files, the solution on these meshes is returned.
    width : float
        Half-width of blocks that stand for half-planes, in contact half-widths.
    clock, keep
        As for :func:`partialslip_fem.solving.mesh_and_solve`.

    Raises
    ------
    InputError
        If the contact does not fit on a finite body, or has too few elements of a mesh file.
    """
    apart = not (problem.coupled or problem.pressing or problem.meshed)  # friction does not change where the contact is
    first = replace(problem, path=None, strains=((0.0, 0.0), (0.0, 0.0))) if apart and problem.path else problem
    solution, meshes, factored = solve_on_first_mesh(first, width, clock, keep)
    iterations, sizes = solution.iterations, _sizes_in_files(problem, solution)
    if problem.meshed:
        return Adapted(solution, {}, meshes, factored, iterations, width)
    size = size or min(sizes) / solution.half_width
    growth = growth_for(size / 10, problem.order)  # the error below the contact line is to be smaller than along it
    a = float(f"{solution.half_width:.2g}")  # rounded, so that similar loads and profiles share a mesh
    reach, limit = 1.25 * max(-solution.reach[0], solution.reach[1]), contact_line_limit(problem)
    width = widened(width, solution)
    while True:
        reach = min(float(f"{reach:.2g}"), limit)
        grading = Grading((-reach, reach), {}, growth, size * a)
        solution = solving.mesh_and_solve(problem, width * a, grading, clock, keep, True, solution)
        meshes, factored = meshes + 1, factored + solution.factored
        iterations += solution.iterations
        if solution.enclosed:
            return Adapted(solution, {}, meshes, factored, iterations, width)
        if reach == limit:
            raise too_narrow(problem)
        reach *= 1.5


def _sizes_in_files(problem: ScaledProblem, solution: MeshSolution) -> list[float]:
    """Mean element size in the contact of each mesh from a file."""
    sizes = []
    for part, condensed in zip(problem.parts, solution.bodies, strict=True):
        vertices = condensed.body.x[:: condensed.body.order]
        inside = vertices[(vertices > solution.left) & (vertices < solution.right)]
        if part.mesh and len(inside) <= _FEWEST:
            raise InputError(
                f"bodies.{part.name}.mesh: must have more than {_FEWEST} elements in the contact, not {len(inside) + 1}"
                f"; is bodies.{part.name}.unit right?"
            )
        if part.mesh:
            sizes.append(float(np.diff(inside).mean()))
    return sizes
