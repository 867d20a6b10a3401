"""The first mesh: a contact line that encloses the contact, with no knowledge of where the contact ends."""

import numpy as np

from partialslip.friction.coulomb_coupled import SlidesError
from partialslip.result import Clock
from partialslip.tools.errors import InputError
from partialslip_fem import solving
from partialslip_fem.bodies import Grading, Kept
from partialslip_fem.mesh_solution import MeshSolution
from partialslip_fem.problem import Part, ScaledProblem

FIRST_SIZE = 0.1  # cost: element size, in half-widths of the contact line
_GROWTH = 1.0  # cost: of the first mesh
_POINTS = 16  # cost: points of that element size, evenly spaced along the contact line
_WIDER = 8.0  # cost: largest first contact line over the usual one: elements of more than it are wider than the contact
# limit: smallest half-width of a block, in the largest |x| in contact: less than the smallest `fem.width`
_BEYOND = 3.9
_FINEST = 8  # limit: first meshes are as many times finer where a displacement makes the bodies slide on coarser ones
_FILLS = 0.95  # limit: largest contact line, in the width of a finite block: it keeps off the block's corners


def solve_on_first_mesh(
    problem: ScaledProblem, width: float, clock: Clock, keep: Kept | None = None, alone: bool = False
) -> tuple[MeshSolution, int, int]:
    """Double the contact line until it encloses the contact. Coarse meshes are stiff: a displacement that makes the
    bodies slide on them is tried on finer ones.

    Parameters
    ----------
    problem : Problem
    width : float
        Half-width of blocks that stand for half-planes, in half-widths of the contact line.
    clock, keep, alone
        As for :func:`partialslip_fem.solving.mesh_and_solve`.

    Returns
    -------
    MeshSolution, int, int
        The solution, and the number of meshes and of factorisations.

    Raises
    ------
    InputError
        If the contact does not fit on a finite body, a moment moves it by many times its width, or a displacement makes
        the bodies slide.
    """
    reach, limit, meshes, factored = 1.5 + max(map(abs, problem.kinks), default=0.0), contact_line_limit(problem), 0, 0
    check = problem.meshed  # on meshes from files this solution is also the last
    farthest, most = max(map(abs, problem.lines), default=0.0), _WIDER * reach
    if farthest >= most:
        movers, instead = "load.M, load.e", "; use march"
        if problem.pin is not None:
            pivots = next(part.name for part in problem.parts if part.support == "pivot")
            movers, instead = f"load.Q, load.M, load.e, bodies.{pivots}.pivot_height", ""
        raise InputError(
            f"{movers}: must move the line of action of P by less than {most:.3g} sqrt(A R P) for fem, not "
            f"{farthest:.3g}{instead}"
        )
    if farthest >= limit:
        raise too_narrow(problem)
    while reach <= farthest:  # no pressure within the contact line has this moment
        reach *= 2
    finer = 1
    while True:
        reach = min(reach, limit)
        sizes = dict.fromkeys(np.linspace(-reach, reach, _POINTS).tolist(), 2 * FIRST_SIZE * reach / finer)
        grading = Grading((-reach, reach), sizes, _GROWTH / finer)
        try:
            solution = solving.mesh_and_solve(problem, width * reach, grading, clock, keep, check, alone=alone)
        except SlidesError as slides:
            if finer >= _FINEST or problem.meshed:
                raise
            meshes, factored, finer = meshes + 1, factored + slides.factored, 2 * finer
            continue
        meshes, factored = meshes + 1, factored + solution.factored
        if solution.enclosed:
            return solution, meshes, factored
        if reach == limit:
            raise too_narrow(problem)
        reach *= 2


def widened(width: float, solution: MeshSolution) -> float:
    """Half-width of blocks that stand for half-planes, in contact half-widths, for meshes that follow ``solution``:
    ``width``, or more where a moment moves the contact far from the middle of the blocks."""
    return max(width, _BEYOND * max(-solution.reach[0], solution.reach[1]) / solution.half_width)


def contact_line_limit(problem: ScaledProblem) -> float:
    """Largest |x| of the contact line; infinite on half-planes.

    Raises
    ------
    InputError
        If a kink of the profile lies beyond it.
    """
    limit = min(_limit(part) for part in problem.parts)
    if max(map(abs, problem.kinks), default=0.0) >= limit:
        raise too_narrow(problem)
    return limit


def too_narrow(problem: ScaledProblem) -> InputError:
    """The error for finite bodies that are too narrow for the contact."""
    names = (f"bodies.{part.name}.{'mesh' if part.mesh else 'width'}" for part in problem.parts if part.finite)
    return InputError(
        f"{' and '.join(names)}: must be wider than the contact, which fills more than {_FILLS:.0%} of the body"
    )


def _limit(part: Part) -> float:
    if part.mesh:
        return float(np.abs(part.mesh.points[part.mesh.lines["contact"], 0]).max())
    return _FILLS * part.extent[0] if part.extent else np.inf
