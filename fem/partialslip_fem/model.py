"""The finite-element method: scene and plan in, result out."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from scipy.interpolate import PPoly

from partialslip.condensed.friction import certificate, doubts, judge, load_path
from partialslip.condensed.threads import one_thread
from partialslip.errors import InputError
from partialslip.plan import Plan
from partialslip.result import Array, Clock, Result, Slip, Traction
from partialslip.scene import Scene
from partialslip.state import State
from partialslip_fem.adapt import Adapted, adapt, uniform
from partialslip_fem.displacements import solve_back
from partialslip_fem.factor import default_backend
from partialslip_fem.fields import along_surfaces, deformed
from partialslip_fem.level import Level, Part, Problem, solve_on
from partialslip_fem.recovery import inside
from partialslip_meshes import Mesh

_WIDTH = {"half-plane": 16.0, "box": 4096.0}  # in contact half-widths
_LARGEST_NU = 0.4999999


@one_thread
def solve(
    scene: Scene, plan: Plan, progress: Callable[[str], None] = lambda _: None, start: State | None = None
) -> Result:
    """Solve ``scene`` by finite elements: two blocks, Lagrange multipliers, Coulomb friction.

    Parameters
    ----------
    scene, plan
        The scene, and which effects it calls for.
    progress : callable, optional
        Called with one line after each mesh.
    start : State, optional
        What the path of the loads begins with, instead of bodies without shear.

    Raises
    ------
    InputError
        If a material is all but incompressible (beyond that the stiffness is of rounding only), or the contact does
        not fit on a finite body.
    MissingLibraryError
        If gmsh, a system library that it needs, or the factorisation that is asked for, is not there.
    """
    material = scene.material
    for name, elastic in (("", material), (".upper", material.upper), (".lower", material.lower)):
        if elastic and material.plane == "strain" and elastic.nu > _LARGEST_NU:
            raise InputError(
                f"material{name}.nu = {elastic.nu}: must be <= {_LARGEST_NU} in plane strain by finite elements"
            )
    clock = Clock()
    width = scene.fem.width or _WIDTH[scene.fem.far_field]
    problem = _scaled(scene, plan, start)
    if scene.fem.size is None:
        adapted = adapt(problem, scene.fem.accuracy, width, clock, progress)
    else:
        adapted = uniform(problem, scene.fem.size, width, clock)
    return _result(scene, plan, problem, adapted, clock)


def solve_meshed(scene: Scene, plan: Plan, meshes: Sequence[Mesh]) -> Result:
    """Solve ``scene`` on meshes of one's own, in m, of the lower body and, unless the bodies are mirror images, of the
    upper one (turned over); nothing is refined, and no error estimated."""
    clock = Clock()
    problem = _scaled(scene, plan)
    scaled = [replace(mesh, points=mesh.points / scene.length) for mesh in meshes]
    width = float(np.abs(scaled[0].points[:, 0]).max())
    level = solve_on(scaled, problem, width, clock)
    adapted = Adapted(level, {}, 1, level.factored, level.iterations, width / level.half_width)
    return _result(scene, plan, problem, adapted, clock)


def _scaled(scene: Scene, plan: Plan, start: State | None = None) -> Problem:
    """The scene in lengths of sqrt(A R P), forces of P, displacements of A P."""
    P, A, L = scene.P, scene.material.A, scene.length
    bodies = (("lower", scene.bodies.lower, scene.fem.lower_size), ("upper", scene.bodies.upper, 1.0))
    parts = tuple(
        Part(name, constants.kappa, constants.A / A, (own.width / 2 / L, own.height / L) if own else None, fineness)
        for (name, own, fineness), constants in zip(bodies, scene.material.bodies, strict=True)
    )
    return Problem(
        gap=lambda x: scene.profile.gap_at(x * L) / (A * P),
        kinks=tuple(kink / L for kink in scene.profile.kinks),
        f=scene.friction.f,
        path=load_path(scene, plan, start),
        parts=parts[:1] if mirrored(scene) else parts,
        order=scene.fem.order,
        far_field=scene.fem.far_field,
        backend=scene.fem.factor or default_backend(),
        start=tuple(_rescaled(q, L / P, 1 / L) for q in (start.p, start.q)) if start else None,
    )


def _rescaled(polynomials: PPoly, value: float, length: float) -> PPoly:
    """In units that are so many times smaller."""
    powers = np.arange(len(polynomials.c) - 1, -1, -1)[:, None]
    return PPoly(polynomials.c * value / length**powers, polynomials.x * length)


def _state(scene: Scene, level: Level) -> State | None:
    """What the path of the loads ends with."""
    if not level.history:
        return None
    shear, bound = level.history.end
    p, q = (level.shear(forces) for forces in (bound / scene.friction.f, shear))
    L = scene.length
    return State(
        scene.P, scene.material.A, *scene.load.points[-1], *(_rescaled(each, scene.P / L, L) for each in (p, q))
    )


def mirrored(scene: Scene) -> bool:
    """Whether one body, and its mesh, is the mirror image of the other."""
    return scene.mirrored and scene.fem.lower_size == 1


def _result(scene: Scene, plan: Plan, problem: Problem, adapted: Adapted, clock: Clock) -> Result:
    level, L, stress = adapted.level, scene.length, scene.P / scene.length
    pressure = level.pressure()
    x = level.body.x[level.nodes]
    p0 = 2 / (np.pi * level.half_width)
    unit = scene.material.A * scene.P  # of displacement
    certified = _certificate(problem, level, p0)
    found = judge(scene, level.history, level.stick, level.half_width)

    q1, q2, dq = np.zeros_like(x), np.zeros_like(x), None
    history = level.history
    if history:
        at1, at2 = level.shear(history.q1), level.shear(history.q2)
        q1, q2, dq = stress * at1(x), stress * at2(x), PPoly(at2.c - at1.c, at2.x)

    moved = solve_back(level, problem) if plan.needs("subsurface") else ()

    def at(points: Array) -> tuple[Array, Array]:
        scaled = points / L
        return stress * inside(pressure, scaled), stress * inside(dq, scaled)

    return Result(
        method="fem",
        a=level.half_width * L,
        p0=p0 * stress,
        regime=found.regime,
        stick_centre=None if found.centre is None else found.centre * L,
        stick_half_width=None if found.half_width is None else found.half_width * L,
        traction=Traction(
            x=x * L,
            p=stress * pressure(x),
            dq=q2 - q1,
            q1=q1 if found.regime != "sliding" else None,
            q2=q2 if found.regime != "sliding" else None,
            at=at,
            breaks=np.sort([*level.ends, *problem.kinks]) * L,
            cells=level.body.x[:: level.body.order] * L,
        ),
        cost=clock.cost(),
        slip=Slip(x * L, history.slip * unit, history.dissipated * unit * scene.P) if history else None,
        settings={
            "bodies": "two, coupled" if len(level.halves) > 1 else "mirror images, one factored",
            "elements": f"P{problem.order}",
            "factorisation": problem.backend,
            **_extents(problem, adapted.width),
            **({"accuracy": scene.fem.accuracy} if scene.fem.size is None else {"element_size_over_a": scene.fem.size}),
        },
        counts={
            "dofs": level.dofs,
            "contact_nodes": len(level.nodes),
            "meshes": adapted.meshes,
            "factorizations": adapted.factorizations,
            "cycles": history.cycles if history else 0,
            "load_steps": history.load_steps if history else 0,
            "iterations": adapted.iterations,
        },
        certificate=certified,
        estimate=adapted.errors,
        notes=found.notes + doubts(certified, adapted.errors, scene.fem.accuracy),
        bodies=tuple(deformed(body, L, unit, stress) for body in moved),
        state=_state(scene, level),
        surface=along_surfaces(moved, level.contact_ends, L, stress) if moved else None,
    )


def _extents(problem: Problem, width: float) -> dict[str, str | float]:
    """What stands for half-planes, and how wide it is."""
    if all(part.extent for part in problem.parts):
        return {"far_field": "none, finite bodies"}
    return {"far_field": problem.far_field, "block_half_width_over_a": width}


def _certificate(problem: Problem, level: Level, p0: float) -> dict[str, float]:
    """That of friction, together with normal contact's: residuals in p0, equilibrium relative to P."""
    weights = np.asarray(level.body.mass.sum(axis=1)).ravel()
    pressing = level.pressing
    closed = {"kkt": float((pressing.residual / weights).max() / p0), "equilibrium": pressing.imbalance}
    if not level.history:
        return closed
    slid = certificate(level.history, weights[level.nodes], problem.f, p0)
    return slid | {key: max(closed[key], slid[key]) for key in closed}
