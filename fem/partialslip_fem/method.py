"""The finite-element method: check the scene, scale it, refine the mesh, hand over the result."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from partialslip.result import Clock, Result
from partialslip.result.state import State
from partialslip.scene import WIDTHS, Scene
from partialslip.scene.plan import Plan
from partialslip.tools.allowance import Allowance
from partialslip.tools.errors import InputError
from partialslip.tools.threads import one_thread
from partialslip_fem.adapt import adapt
from partialslip_fem.bodies import Kept
from partialslip_fem.mesh_solution import Adapted
from partialslip_fem.problem import scaled
from partialslip_fem.result import to_result
from partialslip_fem.solving import solve_on_meshes
from partialslip_fem.uniform import uniform
from partialslip_meshes import Mesh

# limit: Beyond these limits rounding errors of coordinates or of the stiffness are too large.
_SIZES = 1e-3, 1e5  # limit: smallest and largest width or height of a body, in sqrt(A R P)
_FLATTEST = 1e9  # limit: largest kink of the profile, in sqrt(A R P)
_SLENDER = 1e3  # limit: largest height of a body, in the body's width
_LARGEST_NU = 0.4999999  # limit: in plane strain


@one_thread
def solve(
    scene: Scene,
    plan: Plan,
    progress: Callable[[str], None] = lambda _: None,
    start: State | None = None,
    keep: Kept | None = None,
    allowance: Allowance | None = None,
) -> Result:
    """Solve ``scene`` by finite elements: two blocks, Lagrange multipliers, Coulomb friction.

    Parameters
    ----------
    scene, plan
        The scene, and the effects to include.
    progress : callable, optional
        Called with one line after each mesh.
    start : State, optional
        State at the beginning of the load path; by default bodies without shear.
    keep : Kept, optional
        Condensed bodies to reuse, and to add the new ones to: of all meshes where the element size is given, otherwise
        of the first mesh.
    allowance : Allowance, optional
        CPU seconds that the refinement may take: no mesh is begun that is not likely to fit.

    Raises
    ------
    InputError
        If a material is nearly incompressible, the contact does not fit on a finite body, or a body is too small, too
        large or too slender.
    MissingLibraryError
        If gmsh, a system library that gmsh needs, or the factorisation asked for is missing.
    """
    scene = scene.left_gripped
    _check_incompressibility(scene)
    _check_sizes(scene)
    _check_pivot(scene)
    clock = Clock(allowance)
    width = scene.fem.width or WIDTHS[scene.fem.far_field]
    with clock.phase("mesh"):
        problem = scaled(scene, plan, start)
    if scene.fem.size is None and not scene.meshed:
        adapted = adapt(problem, scene.fem.accuracy, width, clock, progress, None if allowance else keep)
        problem = replace(problem, order=adapted.solution.lower.order)
    else:
        adapted = uniform(problem, scene.fem.size, width, clock, keep)
    return to_result(scene, plan, problem, adapted, clock, start)


def solve_meshed(scene: Scene, plan: Plan, meshes: Sequence[Mesh]) -> Result:
    """Solve ``scene`` with the effects in ``plan`` on ``meshes``; no refinement, no error estimate.

    Lengths of the meshes are in m. The first mesh is the lower body's. Unless the bodies are mirror images, the second
    is the upper body's, turned over to lie below its contact line.
    """
    scene, clock = scene.left_gripped, Clock()
    problem = scaled(scene, plan)
    in_lengths = [replace(mesh, points=mesh.points / scene.length) for mesh in meshes]
    width = float(np.abs(in_lengths[0].points[:, 0]).max())
    solution = solve_on_meshes(in_lengths, problem, width, clock, check=True)
    adapted = Adapted(solution, {}, 1, solution.factored, solution.iterations, width / solution.half_width)
    return to_result(scene, plan, problem, adapted, clock)


def _check_incompressibility(scene: Scene) -> None:
    """Raise InputError for materials whose stiffness would be lost to rounding."""
    for name, elastic in scene.material:
        if scene.material.plane == "strain" and elastic.nu > _LARGEST_NU:
            raise InputError(f"{name}.nu = {elastic.nu}: must be <= {_LARGEST_NU} in plane strain by finite elements")


def _check_pivot(scene: Scene) -> None:
    """Raise InputError for a body that pivots on a contact that slides: its pressure would depend on the slip."""
    if scene.pin is not None and scene.slides:
        where = "must keep |Q| below f P at each load point on a body with support 'pivot'"
        raise InputError(f"load.Q = {scene.load.shown('Q')}: {where}")


def _check_sizes(scene: Scene) -> None:
    """Raise InputError for flats and bodies whose size would be lost to rounding, and for infinite ones."""
    scene.bodies.require_widths("for fem")
    if max(map(abs, scene.profile.kinks), default=0.0) > _FLATTEST * scene.length:
        raise InputError(f"load.P = {scene.units.plain(scene.P, 'N/m')}: must press the contact beyond its flat")
    for name, own in (("lower", scene.bodies.lower), ("upper", scene.bodies.upper)):
        for key, size in (("width", own.span), ("height", own.height)) if own and not own.mesh else ():
            if size is not None and not _SIZES[0] <= size / scene.length <= _SIZES[1]:
                low, high = (scene.units.plain(share * scene.length, "m", 2) for share in _SIZES)
                given = scene.units.from_si(size, "m")
                raise InputError(f"bodies.{name}.{key} = {given}: must be from {low} to {high} in this contact")
        if own and own.height and own.height > _SLENDER * own.span:
            height = scene.units.from_si(own.height, "m")
            raise InputError(f"bodies.{name}.height = {height}: must be <= {_SLENDER:g} times bodies.{name}.width")
