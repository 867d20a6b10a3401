"""The result of the last mesh, in SI units: tractions, zones, certificate, estimates, counts, notes."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from partialslip.friction.history import History, certificate, last_cycle_change
from partialslip.friction.pressing import Pressed
from partialslip.friction.regime import doubts, steady_state, steps_of_coupled
from partialslip.friction.restart import begun, end_state
from partialslip.friction.step_errors import summed
from partialslip.friction.work import work, work_error
from partialslip.result import Clock, Result, Slip, StressAt, Traction
from partialslip.result.plates import Plates
from partialslip.result.state import State
from partialslip.scene import Scene
from partialslip.scene.plan import Plan
from partialslip.tools.arrays import Array
from partialslip_fem.displacements import displace_bodies
from partialslip_fem.estimate import rounding_error
from partialslip_fem.fields import along_surfaces, deformed, edges_near_contact
from partialslip_fem.mesh_solution import Adapted, MeshSolution
from partialslip_fem.mortar import nodal_forces
from partialslip_fem.plates import displacement_error, plates_of
from partialslip_fem.problem import ScaledProblem, rescaled
from partialslip_fem.recovery import Polynomials
from partialslip_fem.stresses import BodyStresses

_SLIDES = "q1 and q2 are not known: the contact slides"


def to_result(
    scene: Scene, plan: Plan, problem: ScaledProblem, adapted: Adapted, clock: Clock, start: State | None = None
) -> Result:
    """Convert the ``adapted`` solution of ``problem``, the scaled ``scene`` from the state ``start``, to SI units.

    ``plan`` says whether to solve for displacements inside the bodies; ``clock`` has counted the CPU seconds.
    """
    solution, L, stress = adapted.solution, scene.length, scene.P / scene.length
    plates = _plates(problem, adapted, scene)
    if plates:
        scene = plates.told(scene)
    origin = problem.origin * L
    accuracy = adapted.settled or scene.fem.accuracy
    pressure = solution.pressure()
    x = solution.lower.x[solution.nodes]
    p0 = 2 / (np.pi * solution.half_width)
    unit = scene.material.A * scene.P  # of displacement
    certified = _certificate(problem, solution, p0)
    weights = solution.lower.weights[solution.nodes]
    history, pressures = solution.history, solution.pressures()
    change = last_cycle_change(history, weights, problem.f, p0) if history else None
    pushed = solution.slips_when_pressed
    found = steady_state(scene, history, solution.stick, solution.half_width, pushed, x, solution.common)
    found = found.placed(origin, L)

    made = _factorizations(solution)
    inside = plan.needs("subsurface")
    known_inside = inside and not scene.slides
    displaced = displace_bodies(solution, problem) if known_inside else ()
    restored = _factorizations(solution) - made
    extra = {"back_solves": len(displaced), "factorizations": adapted.factorizations + restored}

    shares = {"discretisation": adapted.errors, "rounding": dict.fromkeys(adapted.errors, rounding_error(solution))}
    if step_errors := summed(solution.step_errors, solution.path_errors):
        shares["steps"] = step_errors

    def forces(state: State) -> Array:
        p = rescaled(state.p, L / scene.P, 1 / L, -origin / L)
        return nodal_forces(solution.lower, p)[solution.nodes]

    begins, doubted = begun(adapted.errors, history, weights, start, forces)
    if begins:
        shares["start"] = begins
    known = found.centre is not None
    shear = (solution.shear(history.q1), solution.shear(history.q2)) if history else None
    tractions = Polynomials(pressure, shear, pressures[0] if pressures else None, known, L, stress, origin)
    keys = [key for key in adapted.errors if known or key not in ("m", "n")]
    # errors of the steps alone say nothing of quantities whose discretisation errors are not known: meshes as given
    estimate = {key: float(sum(share.get(key, 0.0) for share in shares.values())) for key in keys}
    (left1, right1), (left2, right2) = solution.contact_ends
    traction = Traction(
        x=x * L + origin,
        values=tractions.scaled(x),
        at=tractions.at,
        breaks=np.unique([*solution.zone_ends, *solution.kinks, *problem.kinks]) * L + origin,
        cells=solution.lower.x[:: solution.lower.order] * L + origin,
    )
    return replace(
        Result.of("fem", found, solution.half_width * L, p0 * stress, traction, clock),
        slip=_slip_and_work(history, adapted.other, estimate, x * L + origin, unit, scene.P) if history else None,
        settings={
            "bodies": _bodies(solution, problem),
            "elements": f"P{problem.order}",
            "factorisation": problem.backend,
            **_extents(problem, adapted.width),
            **_fineness(scene, problem, accuracy),
        },
        counts=_counts(solution, adapted, extra),
        certificate=certified,
        last_cycle_change=change,
        estimate=estimate,
        shares={name: share for name, share in shares.items() if share},
        notes=found.notes
        + doubted
        + _note_on_pieces(solution)
        + (steps_of_coupled(history, solution.path_errors, accuracy) if solution.coupled else ())
        + _note_on_the_middle(scene, solution, adapted)
        + _note_on_the_allowance(adapted, scene)
        + doubts(change, estimate, accuracy),
        bodies=tuple(deformed(body, L, unit, stress, origin) for body in displaced),
        contact_ends=((left1 * L + origin, right1 * L + origin), (left2 * L + origin, right2 * L + origin)),
        state=_state(scene, problem, solution, estimate if adapted.errors else {}),
        stress_at=StressAt(BodyStresses.of(scene, problem, solution).inside) if known_inside else None,
        undetermined={**found.undetermined, **({"stresses": _SLIDES} if inside and not known_inside else {})},
        surface=along_surfaces(displaced, solution.contact_ends, L, stress, origin) if displaced else None,
        edges=edges_near_contact(solution, L, origin),
        plates=plates,
        right_grip=_right_grip(problem, solution, scene.P),
    )


def _slip_and_work(
    history: History, other: History | None, errors: Mapping[str, float], x: Array, unit: float, P: float
) -> Slip:
    """Slip at ``x`` and work of friction; ``unit`` (m) is that of displacements."""
    off = work_error(history, other, errors)
    return Slip(x, history.slip * unit, work(history) * unit * P, None if off is None else off * unit * P)


def _right_grip(problem: ScaledProblem, solution: MeshSolution, P: float) -> Array | None:
    """Forces on the plate that holds the right side of the lower body, (2,), N/m."""
    if not problem.parts[0].gripped:
        return None
    return P * np.array([solution.bodies[0].at_right_grip(*forces) for forces in solution.forces])


def _plates(problem: ScaledProblem, adapted: Adapted, scene: Scene) -> Plates | None:
    """Plates of two finite bodies, in SI units."""
    if not (found := plates_of(problem, adapted.solution)):
        return None
    A, P, load = scene.material.A, scene.P, scene.load
    off = displacement_error(adapted.solution, found, adapted.plates_error)
    moved = A * P * found.displacement
    if load.displacement is not None:  # known, however many cycles were skipped: less what the spring gives way
        given = np.array(load.driving) - (P * found.at_points / load.spring if load.spring else 0.0)
        moved = given[list(load.ends)]
    return Plates(
        at_points=P * found.at_points,
        displacement=moved,
        approach=A * P * found.approach,
        compliance=A * found.compliance,
        loop=found.loop * [A * P, P],
        error=adapted.plates_error,
        displacement_error=None if off is None else A * P * off,
        turn=None if found.turn is None else A * P / scene.length * found.turn,
    )


def _state(scene: Scene, problem: ScaledProblem, solution: MeshSolution, errors: dict[str, float]) -> State | None:
    """Loads and tractions at the end of the load path, None without friction; ``errors`` are the estimated ones."""
    if not solution.history:
        return None
    history = solution.history
    p, q = (solution.shear(forces) for forces in history.end[::-1])
    L, origin = scene.length, problem.origin * scene.length
    p, q = (rescaled(each, scene.P / L, L, origin) for each in (p, q))
    return end_state(scene, p, q, errors, solution.history, solution.lower.weights[solution.nodes])


def _certificate(problem: ScaledProblem, solution: MeshSolution, p0: float) -> dict[str, float]:
    """Largest residual of normal contact and friction and largest tension, in p0; of equilibrium, relative to P."""
    weights = solution.lower.weights
    pressing = solution.pressing
    residual = max(float((pressing.residual / weights).max()), solution.tension())
    normal = {"kkt": residual / p0, "equilibrium": pressing.imbalance}
    if not solution.history:
        return normal
    friction = certificate(solution.history, weights[solution.nodes], problem.f, p0)
    return {key: max(normal[key], friction[key]) for key in normal}


def _bodies(solution: MeshSolution, problem: ScaledProblem) -> str:
    if len(solution.bodies) == 1:
        return "mirror images, one factored"
    return "two, coupled" if problem.coupled else "two, not coupled"


def _extents(problem: ScaledProblem, width: float) -> dict[str, str | float]:
    """Settings: far field and half-width of the blocks that stand for half-planes."""
    if all(part.finite for part in problem.parts):
        return {"far_field": "none, finite bodies"}
    return {"far_field": problem.far_field, "block_half_width_over_a": width}


def _fineness(scene: Scene, problem: ScaledProblem, accuracy: float) -> dict[str, str | float]:
    """Settings: where the element size comes from."""
    if problem.meshed:
        return {"meshes": "as given"}
    if scene.fem.size is not None:
        return {"element_size_over_a": scene.fem.size}
    return {"meshes": "of the size of the given one"} if scene.meshed else {"accuracy": accuracy}


def _counts(solution: MeshSolution, adapted: Adapted, extra: dict[str, int]) -> dict[str, int]:
    """Counts of work. ``meshes``, ``factorizations`` and ``iterations`` (linear solves of the active-set iteration)
    are of all meshes, the rest of the last mesh.

    ``normal_unknowns`` and ``tangential_unknowns`` are multipliers, ``columns`` the columns of the compliances.
    ``normal_iterations`` and ``friction_iterations`` are changes of the active set after the first linear solve.
    """
    history, pressing = solution.history, solution.pressing
    both, anew = history and solution.coupled, solution.moving
    return {
        "dofs": solution.dofs,
        "contact_nodes": len(solution.nodes),
        "bodies": len(solution.bodies),
        "normal_unknowns": len(solution.lower.x),
        "tangential_unknowns": (len(solution.lower.x) if both else len(solution.nodes)) if history else 0,
        "columns": sum(each.condensation.columns for each in solution.bodies),
        "far_field_columns": sum(each.condensation.far_columns for each in solution.bodies),
        "meshes": adapted.meshes,
        "cycles": history.cycles if history else 0,
        "load_steps": history.load_steps if history else 0,
        "steps": history.path.most_steps if history else 0,
        "events": history.events if history else 0,
        "pressing_steps": _pressing_steps(solution.pressed),
        "normal_solves": history.load_steps + _pressing_steps(solution.pressed) if history and (both or anew) else 1,
        "normal_iterations": 0 if both else pressing.changes,
        "friction_iterations": (pressing.changes if both else history.changes) if history else 0,
        "opposing_nodes": history.opposing if history else 0,
        "iterations": adapted.iterations,
        **extra,
    }


def _pressing_steps(pressed: Pressed | None) -> int:
    """Steps that press coupled bodies together, before the loads of the path."""
    return pressed.steps if pressed else 0


def _factorizations(solution: MeshSolution) -> int:
    return sum(each.condensation.factorizations for each in solution.bodies)


def _note_on_pieces(solution: MeshSolution) -> tuple[str, ...]:
    if solution.pieces == 1:
        return ()
    return (f"the contact is in {solution.pieces} pieces: a, m and n are of the outermost ends",)


def _note_on_the_middle(scene: Scene, solution: MeshSolution, adapted: Adapted) -> tuple[str, ...]:
    """A note on a contact whose middle is farther from x = 0 than the accuracy."""
    a = solution.half_width
    middles = [(left + right) / 2 / a for left, right in solution.contact_ends]
    if not adapted.errors or not scene.even or max(map(abs, middles)) <= scene.fem.accuracy:
        return ()
    at = " and ".join(f"{middle:+.2g} a" for middle in middles)
    return (f"the middle of the contact is off x = 0: by {at} at load points 1 and 2",)


def _note_on_the_allowance(adapted: Adapted, scene: Scene) -> tuple[str, ...]:
    if not adapted.settled or adapted.settled <= scene.fem.accuracy:
        return ()
    return (f"the CPU seconds allowed suffice for an accuracy of {adapted.settled:.1e}, not {scene.fem.accuracy:.1e}",)
