"""The finite-element method: scene and plan in, result out."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from scipy.interpolate import PPoly

from partialslip.allowance import Allowance
from partialslip.condensed.coupled import Pressed
from partialslip.condensed.history import certificate, last_cycle_change
from partialslip.condensed.path import load_path, lower_strain
from partialslip.condensed.regime import doubts, steady_state
from partialslip.condensed.steps import MOST
from partialslip.condensed.threads import one_thread
from partialslip.errors import InputError
from partialslip.plan import Plan
from partialslip.result import Clock, Result, Slip, Traction
from partialslip.result.state import State
from partialslip.scene import WIDTHS, Hertz, Scene
from partialslip.scene.bodies import Body
from partialslip_fem.adapt import Adapted, adapt, uniform
from partialslip_fem.displacements import solve_back
from partialslip_fem.estimate import rounding
from partialslip_fem.factor import default_backend
from partialslip_fem.fields import along_surfaces, deformed
from partialslip_fem.level import Face, Kept, Level, Part, Problem, solve_on
from partialslip_fem.recovery import Pair
from partialslip_meshes import Mesh, read

_SIZES = 1e-3, 1e5  # of finite bodies, in sqrt(A R P)
_FLATTEST = 1e9  # profile, likewise
_SLENDER = 1e3  # of height to width
_LARGEST_NU = 0.4999999


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
        The scene, and which effects it calls for.
    progress : callable, optional
        Called with one line after each mesh.
    start : State, optional
        What the path of the loads begins with, instead of bodies without shear.
    keep : Kept, optional
        Condensed bodies to take, and to add to, where the size of the elements is given.
    allowance : Allowance, optional
        CPU seconds that meshes may take, where they follow an accuracy: if it takes more, the one that these suffice
        for is settled for.

    Raises
    ------
    InputError
        If a material is all but incompressible (beyond that the stiffness is of rounding only), the contact does
        not fit on a finite body, or a size of that is out of all proportion.
    MissingLibraryError
        If gmsh, a system library that it needs, or the factorisation that is asked for, is not there.
    """
    material = scene.material
    for name, elastic in (("", material), (".upper", material.upper), (".lower", material.lower)):
        if elastic and material.plane == "strain" and elastic.nu > _LARGEST_NU:
            raise InputError(
                f"material{name}.nu = {elastic.nu}: must be <= {_LARGEST_NU} in plane strain by finite elements"
            )
    _check_sizes(scene)
    clock = Clock(allowance)
    width = scene.fem.width or WIDTHS[scene.fem.far_field]
    with clock.phase("mesh"):
        problem = _scaled(scene, plan, start)
    if scene.fem.size is None and not scene.meshed:
        adapted = adapt(problem, scene.fem.accuracy, width, clock, progress)
    else:
        adapted = uniform(problem, scene.fem.size, width, clock, keep)
    return _result(scene, plan, problem, adapted, clock)


def _check_sizes(scene: Scene) -> None:
    """That rounding swallows neither the contact in the mesher, nor a slender body's stiffness."""
    if max(scene.profile.kinks, default=0.0) > _FLATTEST * scene.length:
        raise InputError(f"load.P = {scene.P:g}: must press the contact beyond its flat")
    for name, own in (("lower", scene.bodies.lower), ("upper", scene.bodies.upper)):
        for key, size in (("width", own.width), ("height", own.height)) if own else ():
            if size is not None and not _SIZES[0] <= size / scene.length <= _SIZES[1]:
                low, high = (share * scene.length for share in _SIZES)
                raise InputError(f"bodies.{name}.{key} = {size}: must be from {low:.2g} to {high:.2g} in this contact")
        if own and own.height and own.width and own.height > _SLENDER * own.width:
            raise InputError(f"bodies.{name}.height = {own.height}: must be <= {_SLENDER:g} times bodies.{name}.width")


def solve_meshed(scene: Scene, plan: Plan, meshes: Sequence[Mesh]) -> Result:
    """Solve ``scene`` on meshes of one's own, in m, of the lower body and, unless the bodies are mirror images, of the
    upper one (turned over); nothing is refined, and no error estimated."""
    clock = Clock()
    problem = _scaled(scene, plan)
    scaled = [replace(mesh, points=mesh.points / scene.length) for mesh in meshes]
    width = float(np.abs(scaled[0].points[:, 0]).max())
    level = solve_on(scaled, problem, width, clock, steps=MOST)
    adapted = Adapted(level, {}, 1, level.factored, level.iterations, width / level.half_width)
    return _result(scene, plan, problem, adapted, clock)


def _scaled(scene: Scene, plan: Plan, start: State | None = None) -> Problem:
    """The scene in lengths of sqrt(A R P), forces of P, displacements of A P."""
    P, A, L = scene.P, scene.material.A, scene.length
    sides = (("lower", scene.bodies.lower, scene.fem.lower_size), ("upper", scene.bodies.upper, 1.0))
    kinds = zip(sides, scene.material.bodies, strict=True)
    parts = tuple(_part(Part(name, own.kappa, own.A / A, size), body, scene) for (name, body, size), own in kinds)
    return Problem(
        gap=lambda x: scene.gap_at(x * L) / (A * P),
        kinks=tuple(kink / L for kink in scene.profile.kinks),
        f=scene.friction.f,
        path=load_path(scene, plan, start),
        parts=parts[:1] if scene.fem.lower_size == 1 and not plan.needs("coupling") and scene.mirrored else parts,
        order=scene.fem.order,
        far_field=scene.fem.far_field,
        backend=scene.fem.factor or default_backend(),
        start=tuple(_rescaled(q, L / P, 1 / L) for q in (start.p, start.q)) if start else None,
        coupled=plan.needs("coupling"),
        inside=plan.needs("subsurface"),
        strain=lower_strain(scene, scene.load.points[scene.load.ends[1]][1]),
        similar=isinstance(scene.profile, Hertz) and not scene.finite,
        accuracy=scene.fem.accuracy,
    )


def _part(plain: Part, body: Body | None, scene: Scene) -> Part:
    """The part, which would stand for a half-plane, as the body that it is."""
    if not body:
        return plain
    L, holder = scene.length, body.holder
    face = Face(scene.profile, L) if body.kind == "pad" else None
    part = replace(plain, face=face, support=body.support, pulled=body.pulled)
    if body.mesh is not None:
        needed = {line for lines in part.held for line in lines} | ({"right"} if body.pulled else set())
        field = f"bodies.{part.name}.mesh"
        return replace(part, mesh=read(field, body.mesh, (body.unit or 1.0) / L, face, sorted(needed)))
    return replace(
        part,
        extent=((body.width or 0.0) / 2 / L, (body.height or 0.0) / L),
        holder=(holder.width / 2 / L, holder.height / L) if holder else None,
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


def _result(scene: Scene, plan: Plan, problem: Problem, adapted: Adapted, clock: Clock) -> Result:
    level, L, stress = adapted.level, scene.length, scene.P / scene.length
    accuracy = adapted.settled or scene.fem.accuracy
    pressure = level.pressure()
    x = level.body.x[level.nodes]
    p0 = 2 / (np.pi * level.half_width)
    unit = scene.material.A * scene.P  # of displacement
    certified = _certificate(problem, level, p0)
    weights = level.body.weights[level.nodes]
    change = last_cycle_change(level.history, weights, problem.f, p0) if level.history else None
    found = steady_state(scene, level.history, level.stick, level.half_width, level.slips_when_pressed)

    q1, q2, at1, at2, dq = np.zeros_like(x), np.zeros_like(x), None, None, None
    history, pressures = level.history, level.pressures(problem.f)
    if history:
        at1, at2 = level.shear(history.q1), level.shear(history.q2)
        q1, q2, dq = stress * at1(x), stress * at2(x), PPoly(at2.c - at1.c, at2.x)

    made = _factorizations(level)
    moved = solve_back(level, problem) if plan.needs("subsurface") else ()
    extra = {"back_solves": len(moved), "factorizations": adapted.factorizations + _factorizations(level) - made}

    shares = {"discretisation": adapted.errors, "rounding": dict.fromkeys(adapted.errors, rounding(level))}
    if stepped := level.stepped:
        shares["steps"] = dict(stepped)
    keys = [*adapted.errors, *(key for key in stepped if key not in adapted.errors)]
    estimate = {key: float(sum(share.get(key, 0.0) for share in shares.values())) for key in keys}
    known = found.centre is not None
    (left1, right1), (left2, right2) = level.contact_ends
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
            q1=q1 if known else None,
            q2=q2 if known else None,
            at=Pair(pressure, dq, L, stress).at,
            breaks=np.unique([*level.ends, *level.kinks, *problem.kinks]) * L,
            cells=level.body.x[:: level.body.order] * L,
            levels_at=Pair(at1, at2, L, stress).at if known else None,
            p1=stress * pressures[0](x) if pressures else None,
            pressures_at=Pair(*pressures, L, stress).at if pressures else None,
        ),
        cost=clock.cost(),
        slip=Slip(x * L, history.slip * unit, history.dissipated * unit * scene.P) if history else None,
        settings={
            "bodies": _bodies(level, problem),
            "elements": f"P{problem.order}",
            "factorisation": problem.backend,
            **_extents(problem, adapted.width),
            **_fineness(scene, problem, accuracy),
        },
        counts=_counts(level, adapted, extra),
        certificate=certified,
        last_cycle_change=change,
        estimate=estimate,
        shares=shares if estimate else {},
        notes=found.notes
        + _apart(level)
        + _taken(level)
        + _beside(scene, level, adapted)
        + _settled(adapted, scene)
        + doubts(change, estimate, accuracy),
        bodies=tuple(deformed(body, L, unit, stress) for body in moved),
        contact_ends=((left1 * L, right1 * L), (left2 * L, right2 * L)),
        state=_state(scene, level),
        surface=along_surfaces(moved, level.contact_ends, L, stress) if moved else None,
    )


def _bodies(level: Level, problem: Problem) -> str:
    if len(level.halves) == 1:
        return "mirror images, one factored"
    return "two, coupled" if problem.coupled else "two, not coupled"


def _factorizations(level: Level) -> int:
    return sum(half.condensed.factorizations for half in level.halves)


def _counts(level: Level, adapted: Adapted, extra: dict[str, int]) -> dict[str, int]:
    """Work: meshes, factorisations and iterations (faces solved) of all meshes, all else on the last one. Multipliers
    are ``normal`` and ``tangential`` ``unknowns``, ``columns`` those of the compliances that hold them; iterations of
    either are changes of what touches, and of what sticks, after the first linear solve."""
    history, pressing = level.history, level.pressing
    both = history and level.coupled
    return {
        "dofs": level.dofs,
        "contact_nodes": len(level.nodes),
        "bodies": len(level.halves),
        "normal_unknowns": len(level.body.x),
        "tangential_unknowns": (len(level.body.x) if both else len(level.nodes)) if history else 0,
        "columns": sum(half.condensed.columns for half in level.halves),
        "far_field_columns": sum(half.condensed.far_columns for half in level.halves),
        "meshes": adapted.meshes,
        "cycles": history.cycles if history else 0,
        "load_steps": history.load_steps if history else 0,
        "steps": history.path.most_steps if history else 0,
        "pressing_steps": _pressing_steps(level.pressed),
        "normal_solves": history.load_steps + _pressing_steps(level.pressed) if history and both else 1,
        "normal_iterations": 0 if both else pressing.changes,
        "friction_iterations": (pressing.changes if both else history.changes) if history else 0,
        "opposing_nodes": history.opposing if history else 0,
        "iterations": adapted.iterations,
        **extra,
    }


def _pressing_steps(pressed: Pressed | None) -> int:
    """Steps that press coupled bodies together, before the loads of the path."""
    return pressed.steps if pressed else 0


def _extents(problem: Problem, width: float) -> dict[str, str | float]:
    """What stands for half-planes, and how wide it is."""
    if all(part.finite for part in problem.parts):
        return {"far_field": "none, finite bodies"}
    return {"far_field": problem.far_field, "block_half_width_over_a": width}


def _apart(level: Level) -> tuple[str, ...]:
    """A note on a contact that is not in one piece."""
    if level.pieces == 1:
        return ()
    return (f"the contact is in {level.pieces} pieces: a, m and n are of the outermost ends",)


def _taken(level: Level) -> tuple[str, ...]:
    """A note on steps of coupled bodies, which are those that were asked for."""
    if not level.history or not level.coupled or not level.history.path.moves:
        return ()
    steps = level.history.path.substeps
    return (
        f"coupled bodies go from load point to load point in {steps} steps (load.steps), whose error is not estimated",
    )


def _beside(scene: Scene, level: Level, adapted: Adapted) -> tuple[str, ...]:
    """A note on a contact whose middle is off x = 0 by more than its ends are known to."""
    a = level.half_width
    middles = [(left + right) / 2 / a for left, right in level.contact_ends]
    if not adapted.errors or max(map(abs, middles)) <= scene.fem.accuracy:
        return ()
    at = " and ".join(f"{middle:+.2g} a" for middle in middles)
    return (f"the middle of the contact is off x = 0: by {at} at load points 1 and 2",)


def _settled(adapted: Adapted, scene: Scene) -> tuple[str, ...]:
    """A note on an accuracy that the allowance did not suffice for."""
    if not adapted.settled or adapted.settled <= scene.fem.accuracy:
        return ()
    return (f"the CPU seconds allowed suffice for an accuracy of {adapted.settled:.1e}, not {scene.fem.accuracy:.1e}",)


def _fineness(scene: Scene, problem: Problem, accuracy: float) -> dict[str, str | float]:
    """What the size of the elements follows."""
    if problem.meshed:
        return {"meshes": "as given"}
    if scene.fem.size is not None:
        return {"element_size_over_a": scene.fem.size}
    return {"meshes": "of the size of the given one"} if scene.meshed else {"accuracy": accuracy}


def _certificate(problem: Problem, level: Level, p0: float) -> dict[str, float]:
    """That of friction, together with normal contact's: residuals in p0, equilibrium relative to P."""
    weights = level.body.weights
    pressing = level.pressing
    closed = {"kkt": float((pressing.residual / weights).max() / p0), "equilibrium": pressing.imbalance}
    if not level.history:
        return closed
    slid = certificate(level.history, weights[level.nodes], problem.f, p0)
    return {key: max(closed[key], slid[key]) for key in closed}
