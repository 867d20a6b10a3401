"""The finite-element method: scene and plan in, result out."""

from collections.abc import Callable

import numpy as np
from scipy.interpolate import PPoly

from partialslip.condensed.friction import certificate, doubts, judge, load_path
from partialslip.condensed.threads import one_thread
from partialslip.errors import InputError
from partialslip.plan import Plan
from partialslip.result import Array, Clock, Result, Slip, Traction
from partialslip.scene import Scene
from partialslip_fem.adapt import Adapted, adapt
from partialslip_fem.fields import displaced
from partialslip_fem.level import Level, Problem

_WIDTH = {"half-plane": 16.0, "box": 4096.0}  # in contact half-widths
_LARGEST_NU = 0.4999999


@one_thread
def solve(scene: Scene, plan: Plan, progress: Callable[[str], None] = lambda _: None) -> Result:
    """Solve ``scene`` by finite elements: two mirror-image blocks, Lagrange multipliers, Coulomb friction.

    Parameters
    ----------
    scene, plan
        The scene, and which effects it calls for.
    progress : callable, optional
        Called with one line after each mesh.

    Raises
    ------
    InputError
        If the material is all but incompressible: beyond that the stiffness is of rounding only.
    MissingLibraryError
        If gmsh, or a system library that it needs, is not there.
    """
    if scene.material.plane == "strain" and scene.material.nu > _LARGEST_NU:
        raise InputError(
            f"material.nu = {scene.material.nu}: must be <= {_LARGEST_NU} in plane strain by finite elements"
        )
    clock = Clock()
    width = scene.fem.width or _WIDTH[scene.fem.far_field]
    problem = _scaled(scene, plan)
    adapted = adapt(problem, scene.fem.accuracy, width, clock, progress)
    return _result(scene, plan, problem, adapted, clock)


def _scaled(scene: Scene, plan: Plan) -> Problem:
    """The scene in lengths of sqrt(A R P), forces of P, displacements of A P."""
    P, A, L = scene.P, scene.material.A, scene.length
    return Problem(
        gap=lambda x: scene.profile.gap_at(x * L) / (A * P),
        kinks=tuple(kink / L for kink in scene.profile.kinks),
        f=scene.friction.f,
        path=load_path(scene, plan),
        kappa=scene.material.kappa,
        order=scene.fem.order,
        far_field=scene.fem.far_field,
    )


def _result(scene: Scene, plan: Plan, problem: Problem, adapted: Adapted, clock: Clock) -> Result:
    level, L, stress = adapted.level, scene.length, scene.P / scene.length
    pressure = level.pressure()
    x = level.body.x[level.nodes]
    p0 = 2 / (np.pi * level.half_width)
    unit = scene.material.A * scene.P  # of displacement
    certified = _certificate(problem, level, p0)
    found = judge(scene, level.history, level.stick, level.half_width, certified.get("steady", 0.0))

    q1, q2, dq = np.zeros_like(x), np.zeros_like(x), None
    history = level.history
    if history:
        at1, at2 = level.shear(history.q1), level.shear(history.q2)
        q1, q2, dq = stress * at1(x), stress * at2(x), PPoly(at2.c - at1.c, at2.x)

    def at(points: Array) -> tuple[Array, Array]:
        scaled = points / L
        return stress * _inside(pressure, scaled), stress * _inside(dq, scaled)

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
            "bodies": "mirror images, one factored",
            "elements": f"P{problem.order}",
            "far_field": problem.far_field,
            "block_half_width_over_a": adapted.width,
            "accuracy": scene.fem.accuracy,
        },
        counts={
            "dofs": level.body.stiffness.shape[0],
            "contact_nodes": len(level.nodes),
            "meshes": adapted.meshes,
            "factorizations": adapted.factorizations,
            "load_steps": history.load_steps if history else 0,
            "iterations": adapted.iterations,
        },
        certificate=certified,
        estimate=adapted.errors,
        notes=found.notes + doubts(certified, adapted.errors, scene.fem.accuracy),
        bodies=displaced(level, problem, L, unit) if plan.needs("subsurface") else (),
    )


def _certificate(problem: Problem, level: Level, p0: float) -> dict[str, float]:
    """That of friction, together with normal contact's: residuals in p0, equilibrium relative to P."""
    weights = np.asarray(level.body.mass.sum(axis=1)).ravel()
    pressing = level.pressing
    closed = {"kkt": float((pressing.residual / weights).max() / p0), "equilibrium": pressing.imbalance}
    if not level.history:
        return closed
    slid = certificate(level.history, weights[level.nodes], problem.f, p0)
    return slid | {key: max(closed[key], slid[key]) for key in closed}


def _inside(polynomial: PPoly | None, points: Array) -> Array:
    """Its values, zero off the contact line."""
    if polynomial is None:
        return np.zeros_like(points)
    values: Array = np.nan_to_num(polynomial(points, extrapolate=False), nan=0.0)
    return values
