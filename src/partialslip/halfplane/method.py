"""The exact method: solves a scene by formulas, elliptic integrals, quadratures or an integral equation."""

import functools
import math
import time
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from partialslip.halfplane.contact import Contact, contact
from partialslip.halfplane.levels import Levels, levels
from partialslip.halfplane.loading import Loading, loading
from partialslip.halfplane.remarks import no_stresses, remarks, undetermined
from partialslip.halfplane.states import Around, constant, sliding_state, without_shear
from partialslip.halfplane.steady import transition
from partialslip.halfplane.stress import SURFACE_REACH, along_surface
from partialslip.halfplane.tables import table_error
from partialslip.halfplane.tractions import ExactTractions, sample
from partialslip.halfplane.turning import Turning, half_cycle
from partialslip.halfplane.varying import closed_form, require_closed_form, steady_cycle
from partialslip.halfplane.varying_result import solve_varying
from partialslip.result import Clock, Regime, Result, Slip, SteadyState, StressAt, Traction
from partialslip.result.state import State
from partialslip.scene import Scene, Tabulated
from partialslip.scene.gradual import may_turn_round
from partialslip.scene.model import require_carried
from partialslip.scene.plan import Plan, plan
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError
from partialslip.tools.threads import one_thread

_SLIDES = "the contact slides: |Q| >= f P at a load point, or dQ >= 2 f P; there is no steady partial slip"
_RATCHETS = "the mean of Q is above the bound for a steady state: the contact ratchets"


@one_thread
def solve(
    scene: Scene, plan: Plan, progress: Callable[[str], None] = lambda _: None, start: State | None = None
) -> Result:
    """Solve ``scene`` exactly, as two elastically similar half-planes in the steady state; SI units.

    Parameters
    ----------
    scene : Scene
    plan : Plan
        Effects that the scene calls for (:func:`partialslip.plan`).
    progress : callable, optional
        Not called.
    start : State, optional
        State from which the path goes on: q1 and q2 then have no closed form. The change q2 - q1 is independent of it.

    Raises
    ------
    InputError
        If there is no closed form: loads are out of phase, or P or M varies and an end of the contact does not slip.
    """
    del progress
    clock = Clock()
    load = scene.load
    if not load.in_phase:
        raise InputError("load.sigma: out of phase with load.Q; must be in phase for the exact method, use march")
    if scene.presses_anew:
        if plan.needs("friction"):
            require_closed_form(scene)
        return solve_varying(scene, plan, start is not None, clock)
    pressed, regime, cycle = _steady_state(scene, plan, clock)
    a, f = pressed.a, pressed.f
    found = _levels(scene, pressed, regime, cycle, start)
    turns = cycle is not None and not cycle.holds
    tractions = ExactTractions(pressed, f, cycle, found if isinstance(found, Levels) else None)
    breaks = _breaks(scene, pressed, cycle, found)
    x = sample(np.union1d(breaks, [pressed.centre]))
    far = abs(pressed.centre) + SURFACE_REACH * a
    inside = plan.needs("subsurface")
    stress = _stresses(scene, pressed, found) if inside else None
    surface = along_surface(stress.surface, np.concatenate([[-far], breaks, [far]])) if stress else None
    slips = cycle and not cycle.nothing
    why = undetermined(regime, turns, found) | (no_stresses(found) if inside and not stress else {})
    slip = _slip(scene, pressed, cycle) if cycle and slips and regime != "ratchets" else None
    state = SteadyState(regime, notes=remarks(regime, turns, why, _SLIDES, _RATCHETS))
    if cycle:
        zone = cycle.zone
        state = state._replace(centre=pressed.centre + cycle.mirror * zone.centre * a, half_width=zone.half_width * a)
        if slips and regime != "ratchets" and not turns:
            state = state._replace(permanent=_permanent(pressed, cycle))
    return replace(
        Result.of("exact", state, a, pressed.p0, Traction(x, tractions.at(x), tractions.at, breaks), clock),
        slip=slip,
        settings={"model": "two half-planes, steady state"},
        limits=_limits(scene, pressed, cycle) if plan.needs("friction") or (scene.slides and f > 0) else {},
        certificate=cycle.certificate if cycle and slips else {},
        surface=surface,
        stress_at=StressAt(stress.inside) if stress else None,
        undetermined=why,
        path_dependent=turns,
        contact_ends=(pressed.ends,) * 2 if pressed.centre else None,
    )


def has_closed_form(scene: Scene) -> bool:
    """Whether the steady state of ``scene``, two similar half-planes under loads in phase, has an exact solution here:
    by formulas, quadratures or an integral equation; under constant pressure unless sigma_slope is too large or f
    varies so much along x that more than one zone sticks."""
    if not ((scene.presses_anew or scene.load.dslope or scene.friction.varies) and plan(scene).needs("friction")):
        return True
    try:
        return not closed_form(scene) if scene.presses_anew else bool(_change(scene).cycle)
    except InputError:
        return False


def spacing_error(scene: Scene) -> dict[str, float]:
    """Errors of a, m and n (fractions of a), p and q (relative L2) that the spacing of a tabulated profile makes; empty
    where half-planes have no closed form, and for other profiles.

    An error of the input: it is the same for all methods, and no part of their estimates, bars and verdicts.
    """
    half_planes = not scene.finite and scene.material.alike and scene.load.in_phase and not scene.presses_anew
    if not (isinstance(scene.profile, Tabulated) and half_planes) or (scene.load.dslope and not has_closed_form(scene)):
        return {}
    if scene.free or scene.slides or not plan(scene).needs("friction"):
        return table_error(scene, contact(scene), None)
    return table_error(scene, *_half_cycle(scene, parts=False))


def path_dependent(scene: Scene) -> bool:
    """Whether slip reverses between the load points of ``scene``, two similar half-planes under loads in phase, and the
    steady state under gradual loads is not known (:attr:`partialslip.Result.path_dependent`)."""
    if scene.presses_anew:
        return steady_cycle(scene).turns_round
    return may_turn_round(scene) and not _change(scene).cycle.holds


def slip_turns_round(scene: Scene) -> bool:
    """Whether slip reverses between the load points of ``scene``, two similar half-planes under constant P and loads in
    phase, decided by a single step: no gradual way is followed."""
    if not may_turn_round(scene):
        return False
    pressed, load = contact(scene), scene.load
    return not loading(pressed, pressed.f, load.dQ, load.dsigma, load.dslope, bound=2).final


class _Change(NamedTuple):
    """The contact ``pressed``, its change over half a ``cycle``, and the ``cpu`` and ``wall`` seconds that it took."""

    pressed: Contact
    cycle: Loading | Turning
    cpu: float
    wall: float


@functools.lru_cache(maxsize=1)
def _change(scene: Scene) -> _Change:
    """Change from load point 1 to 2 of a ``scene`` that does not slide. Cached: :func:`path_dependent` is called before
    :func:`solve`."""
    cpu, wall = time.process_time(), time.perf_counter()
    found = _half_cycle(scene)
    return _Change(*found, time.process_time() - cpu, time.perf_counter() - wall)


def _half_cycle(scene: Scene, *, parts: bool = True) -> tuple[Contact, Loading | Turning]:
    """The contact, and its change over half a cycle, as of :func:`half_cycle`."""
    pressed, load = contact(scene), scene.load
    require_carried([Q for Q, _ in load.points], pressed.f * scene.P)
    return pressed, half_cycle(pressed, pressed.f, load.dQ, load.dsigma, load.dslope, parts=parts)


def _steady_state(scene: Scene, plan: Plan, clock: Clock) -> tuple[Contact, Regime, Loading | Turning | None]:
    """Contact, regime, and change from load point 1 to 2 (None if nothing sticks)."""
    load = scene.load
    if scene.free:
        return contact(scene), "frictionless", None
    if scene.slides:
        return contact(scene), "sliding", None
    if not plan.needs("friction"):
        pressed = contact(scene)
        return pressed, "stuck", loading(pressed, 1.0, 0.0, 0.0, bound=2)
    begun = time.process_time(), time.perf_counter()
    pressed, cycle, cpu, wall = _change(scene)
    clock.add_earlier(max(cpu + begun[0] - time.process_time(), 0.0), max(wall + begun[1] - time.perf_counter(), 0.0))
    if cycle.nothing:
        return pressed, "stuck", cycle
    # where dq has one sign the bound is gross sliding, ruled out above; a zero mean is within any bound, even one that
    # rounding makes negative
    mean = abs(load.Q_mean)
    if not cycle.one_way and mean > 0 and mean > pressed.f * scene.P * cycle.mean_load_bound:
        return pressed, "ratchets", cycle
    return pressed, ("small tension" if cycle.zone.s > 0 else "large tension"), cycle


def _levels(
    scene: Scene, pressed: Contact, regime: Regime, cycle: Loading | Turning | None, start: State | None
) -> Levels | str:
    """q1 and q2, or the reason why there are none."""
    if regime == "frictionless":
        return "there is no friction"
    if cycle is None:
        return "the contact slides"
    if regime == "ratchets":
        return "the contact ratchets"
    if start:
        return "the path goes on from a state, which the closed form cannot follow"
    if not scene.friction.f and isinstance(cycle, Loading):
        return Levels(cycle, cycle, 1)
    return levels(pressed, pressed.f, scene.load, cycle)


def _breaks(scene: Scene, pressed: Contact, cycle: Loading | Turning | None, found: Levels | str) -> Array:
    """Ends of the contact and of stick zones, and kinks of p (b,), ascending, m."""
    ends = [*(cycle.breaks if cycle else ()), *(found.first.breaks if isinstance(found, Levels) else ())]
    a, centre = pressed.a, pressed.centre
    kinks = [kink for kink in scene.profile.kinks if abs(kink - centre) < a]
    return np.unique([centre - a, *kinks, *(centre + a * np.clip(ends, -1, 1)), centre + a])


def _limits(scene: Scene, pressed: Contact, cycle: Loading | Turning | None) -> dict[str, float]:
    limit = pressed.f * scene.P
    limits = {"Q_sliding": limit}
    if cycle:
        if not cycle.gf:
            limits["dsigma_transition"] = float(transition(cycle.Qf, cycle.seen)) * pressed.f * pressed.p0
        limits["Q_mean"] = limit * cycle.mean_load_bound
    return limits


def _slip(scene: Scene, pressed: Contact, cycle: Loading | Turning) -> Slip:
    worn, stress = cycle.worn, pressed.f * pressed.p0
    unit = scene.material.A * stress * pressed.a
    energy = unit * stress * pressed.a
    return Slip(
        pressed.centre + pressed.a * worn.x,
        unit * worn.slip,
        energy * worn.dissipated,
        energy * worn.error if cycle.holds else None,
    )


def _permanent(pressed: Contact, cycle: Loading | Turning) -> tuple[float, float]:
    left, right = pressed.places(cycle.permanent or (math.nan, math.nan)).tolist()
    return left, right


def _stresses(scene: Scene, pressed: Contact, found: Levels | str) -> Around | None:
    """Stresses of the steady state; None where q1 and q2 are not known."""
    if isinstance(found, Levels):
        return constant(scene, pressed, found)
    return without_shear(scene) if scene.free else sliding_state(scene) if scene.slides else None
