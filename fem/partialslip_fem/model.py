"""The finite-element method: scene and plan in, result out."""

from collections.abc import Callable

import numpy as np
from scipy.interpolate import PPoly
from threadpoolctl import threadpool_limits

from partialslip.errors import InputError
from partialslip.plan import Plan
from partialslip.result import Array, Clock, Regime, Result, Traction
from partialslip.scene import Scene
from partialslip_fem.adapt import Adapted, adapt
from partialslip_fem.fields import displaced
from partialslip_fem.level import Level, Problem

_WIDTH = {"half-plane": 16.0, "box": 4096.0}  # in contact half-widths
_LARGEST_NU = 0.4999999
_STEADY = 1e-6  # change of q in a cycle, in f p0, that counts as none


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
    with threadpool_limits(limits=1):  # the dense algebra is small: two threads on two busy cores are slower
        adapted = adapt(problem, scene.fem.accuracy, width, clock, progress)
        return _result(scene, plan, problem, adapted, clock)


def _scaled(scene: Scene, plan: Plan) -> Problem:
    """The scene in lengths of sqrt(A R P), forces of P, displacements of A P."""
    P, A, L, load = scene.P, scene.material.A, scene.length, scene.load
    loads = []
    if plan.needs("friction") and not _slides(scene):
        point1, point2 = ((Q / P, sigma * L / (4 * P)) for Q, sigma in zip(load.Q, load.sigma, strict=True))
        loads = [point2] + [point1, point2] * load.cycles
    return Problem(
        gap=lambda x: scene.profile.gap(x * L) / (A * P),
        kinks=tuple(kink / L for kink in scene.profile.kinks),
        f=scene.friction.f,
        loads=loads,
        kappa=scene.material.kappa,
        order=scene.fem.order,
        far_field=scene.fem.far_field,
    )


def _slides(scene: Scene) -> bool:
    """Whether friction cannot carry Q: no nodal forces within the bound could sum to it."""
    return max(map(abs, scene.load.Q)) >= scene.friction.f * scene.P


def _result(scene: Scene, plan: Plan, problem: Problem, adapted: Adapted, clock: Clock) -> Result:
    level, L, stress = adapted.level, scene.length, scene.P / scene.length
    pressure = level.pressure()
    x = level.body.x[level.nodes]
    p0 = 2 / (np.pi * level.half_width)
    regime, notes = _regime(scene, level)
    certificate = _certificate(problem, level, p0)
    if max(adapted.errors.values()) > scene.fem.accuracy:
        notes += (f"accuracy {scene.fem.accuracy:g} not reached: the ends are known to {_listed(adapted.errors)} a",)
    if (change := certificate.get("steady", 0.0)) > max(scene.fem.accuracy, _STEADY):
        notes += (f"not steady: q changed by {change:.1e} f p0 in the last cycle; take more of them (load.cycles)",)

    shear = [level.shear(step) for step in range(len(level.steps))]
    dq = _difference(shear[-1], shear[-2]) if shear else None
    q1, q2 = (stress * shear[-2](x), stress * shear[-1](x)) if shear else (np.zeros_like(x), np.zeros_like(x))

    def at(points: Array) -> tuple[Array, Array]:
        scaled = points / L
        return stress * _inside(pressure, scaled), stress * _inside(dq, scaled)

    stick = level.stick
    whole = regime == "stuck"  # nothing changes over the cycle: all of the contact sticks
    return Result(
        method="fem",
        a=level.half_width * L,
        p0=p0 * stress,
        regime=regime,
        stick_centre=0.0 if whole else (stick.right + stick.left) / 2 * L if stick else None,
        stick_half_width=level.half_width * L if whole else (stick.right - stick.left) / 2 * L if stick else None,
        traction=Traction(
            x=x * L,
            p=stress * pressure(x),
            dq=q2 - q1,
            q1=q1 if regime != "sliding" else None,
            q2=q2 if regime != "sliding" else None,
            at=at,
            breaks=np.sort([*level.ends, *problem.kinks]) * L,
            cells=level.body.x[:: level.body.order] * L,
        ),
        cost=clock.cost(),
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
            "factorizations": adapted.meshes,
            "load_steps": len(level.steps),
            "iterations": adapted.iterations,
        },
        certificate=certificate,
        estimate=adapted.errors,
        notes=notes,
        bodies=displaced(level, problem, L, scene.material.A * scene.P) if plan.needs("subsurface") else (),
    )


def _regime(scene: Scene, level: Level) -> tuple[Regime, tuple[str, ...]]:
    load = scene.load
    if _slides(scene):
        return "sliding", ("the contact slides: |Q| >= f P at a load point; there is no steady partial slip",)
    if level.stick is None or (load.dQ == 0 and load.dsigma == 0):
        return "stuck", ()
    notes: tuple[str, ...] = ()
    if level.stick.left == level.stick.right:
        notes = ("the stick zone is smaller than an element: m and n are where the slip turns round",)
    return ("small tension" if level.stick.signs[0] == level.stick.signs[1] else "large tension"), notes


def _certificate(problem: Problem, level: Level, p0: float) -> dict[str, float]:
    """``kkt``: residuals as tractions, in p0 (normal) and f p0 (friction); ``equilibrium``: of P and of Q, relative to
    P and f P; ``steady``: change of q between the last two visits of load point 2, in f p0."""
    weights = np.asarray(level.body.mass.sum(axis=1)).ravel()
    pressing, steps = level.pressing, level.steps
    kkt, equilibrium = [float((pressing.residual / weights).max() / p0)], [pressing.imbalance]
    if not steps:
        return {"kkt": max(kkt), "equilibrium": max(equilibrium)}
    held = weights[level.nodes] * problem.f * p0
    kkt += [float((step.residual / held).max()) for step in steps]
    equilibrium += [step.imbalance / problem.f for step in steps]
    steady = float((np.abs(steps[-1].x - steps[-3].x) / held).max())
    return {"kkt": max(kkt), "equilibrium": max(equilibrium), "steady": steady}


def _difference(after: PPoly, before: PPoly) -> PPoly:
    return PPoly(after.c - before.c, after.x)


def _inside(polynomial: PPoly | None, points: Array) -> Array:
    """Its values, zero off the contact line."""
    if polynomial is None:
        return np.zeros_like(points)
    values: Array = np.nan_to_num(polynomial(points, extrapolate=False), nan=0.0)
    return values


def _listed(errors: dict[str, float]) -> str:
    return ", ".join(f"{key} {value:.1e}" for key, value in errors.items())
