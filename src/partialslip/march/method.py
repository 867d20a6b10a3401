"""Marching in time through any load history, as two half-planes on cells.

Unlike the closed form of the steady state, marching includes the tractions that the first cycles lock in. Each step is
a convex problem with a certificate.
"""

from collections.abc import Callable

from partialslip.march import similar, unlike
from partialslip.march.driver import march
from partialslip.result import Clock, Result
from partialslip.result.state import State
from partialslip.scene import Scene
from partialslip.scene.plan import Plan
from partialslip.tools.allowance import Allowance
from partialslip.tools.threads import one_thread


@one_thread
def solve(
    scene: Scene,
    plan: Plan,
    progress: Callable[[str], None] = lambda _: None,
    start: State | None = None,
    allowance: Allowance | None = None,
    added: similar.Added | None = None,
) -> Result:
    """Solve ``scene`` by marching through the load history, as two half-planes.

    Parameters
    ----------
    scene : Scene
    plan : Plan
        Effects that the scene calls for.
    progress : callable, optional
        Called with one line of text after each mesh.
    start : State, optional
        State in which the path of the loads begins; default: no shear.
    allowance : Allowance, optional
        CPU seconds. Once the errors are estimated, a mesh is not begun that does not fit
        (:class:`partialslip.result.Pace`). Load steps are compared with finer steps once.
    added : callable, optional
        ``added(places) -> (c, c)``: what unit shear forces on cells with ends at ``places`` (c + 1,), m, add to the
        mean displacements of the cells of half-planes along x, in A. Of bodies of like materials.
    """
    clock, scene = Clock(allowance), scene.evenly_gripped
    scene.load.require_forces(scene.units)
    if not scene.material.alike:
        scene.require_no_moment("by march with bodies of different materials")
        return march(unlike.UnlikeBodies(scene, plan, start, clock), progress)[0]
    problem = similar.SimilarBodies(scene, plan, start, clock, added)
    found, level = march(problem, progress)
    return similar.add_stresses(found, problem.normal, level, clock) if plan.needs("subsurface") else found
