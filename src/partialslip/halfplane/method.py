"""The exact method: solves a scene by formulas, elliptic integrals, quadratures or an integral equation."""

import functools
import time
from collections.abc import Callable
from typing import NamedTuple

from partialslip.halfplane.answer import result_of, without_cycle
from partialslip.halfplane.change import Change
from partialslip.halfplane.constant_answer import limits, under_constant_pressure
from partialslip.halfplane.contact import Contact, contact
from partialslip.halfplane.proportional import loading
from partialslip.halfplane.tables import table_error
from partialslip.halfplane.turning import half_cycle
from partialslip.halfplane.varying import closed_form, require_closed_form, steady_cycle
from partialslip.halfplane.varying_answer import under_varying_pressure
from partialslip.result import Clock, Result
from partialslip.result.state import State
from partialslip.scene import Scene, Tabulated
from partialslip.scene.gradual import may_turn_round
from partialslip.scene.model import require_carried
from partialslip.scene.plan import Plan, plan
from partialslip.tools.errors import InputError
from partialslip.tools.threads import one_thread


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
    clock, scene = Clock(), scene.evenly_gripped
    load = scene.load
    if not load.in_phase:
        raise InputError("load.sigma: out of phase with load.Q; must be in phase for the exact method, use march")
    slipping, started, inside = plan.needs("friction"), start is not None, plan.needs("subsurface")
    if scene.presses_anew:
        if scene.strips:
            raise InputError(f"load.{scene.varying[0]}: must be constant for exact, as strips take part; use march")
        if slipping:
            require_closed_form(scene)
        return result_of(scene, under_varying_pressure(scene, slipping, started, inside), inside, clock)
    pressed, change = _at_constant_pressure(scene, slipping, clock)
    if change:
        found = under_constant_pressure(scene, pressed, change, started, inside)
    else:
        found = without_cycle(scene, pressed, pressed, None, inside)
    if slipping or (scene.slides and pressed.f > 0):
        found = found._replace(limits=limits(scene, pressed, change))
    return result_of(scene, found, inside, clock)


def has_closed_form(scene: Scene) -> bool:
    """Whether the steady state of ``scene``, two similar half-planes under loads in phase, has an exact solution here:
    by formulas, quadratures or an integral equation; under constant pressure unless sigma_slope is too large or f
    varies so much along x that more than one zone sticks."""
    scene = scene.evenly_gripped
    if scene.strips and scene.presses_anew:
        return False
    if not (
        (scene.presses_anew or scene.load.dslope or scene.friction.varies or scene.strips)
        and plan(scene).needs("friction")
    ):
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
    half_planes = not scene.sized and scene.material.alike and scene.load.in_phase and not scene.presses_anew
    if not (isinstance(scene.profile, Tabulated) and half_planes) or (scene.load.dslope and not has_closed_form(scene)):
        return {}
    if scene.free or scene.slides or not plan(scene).needs("friction"):
        return table_error(scene, contact(scene), None)
    return table_error(scene, *_half_cycle(scene, parts=False))


def path_dependent(scene: Scene) -> bool:
    """Whether slip reverses between the load points of ``scene``, two similar half-planes under loads in phase, and the
    steady state under gradual loads is not known (:attr:`partialslip.Result.path_dependent`)."""
    scene = scene.evenly_gripped
    if scene.presses_anew:
        return steady_cycle(scene).turns_round
    return may_turn_round(scene) and not _change(scene).cycle.holds


class _Change(NamedTuple):
    """The contact ``pressed``, its change over half a ``cycle``, and the ``cpu`` and ``wall`` seconds that it took."""

    pressed: Contact
    cycle: Change
    cpu: float
    wall: float


@functools.lru_cache(maxsize=1)
def _change(scene: Scene) -> _Change:
    """Change from load point 1 to 2 of a ``scene`` that does not slide. Cached: :func:`path_dependent` is called before
    :func:`solve`."""
    cpu, wall = time.process_time(), time.perf_counter()
    found = _half_cycle(scene)
    return _Change(*found, time.process_time() - cpu, time.perf_counter() - wall)


def _half_cycle(scene: Scene, *, parts: bool = True) -> tuple[Contact, Change]:
    """The contact, and its change over half a cycle, as of :func:`half_cycle`."""
    pressed, load = contact(scene), scene.load
    require_carried([Q for Q, _ in load.points], pressed.f * scene.P)
    return pressed, half_cycle(pressed, pressed.f, load.dQ, load.dsigma, load.dslope, parts=parts)


def _at_constant_pressure(scene: Scene, slipping: bool, clock: Clock) -> tuple[Contact, Change | None]:
    """The contact, and its change from load point 1 to 2; None if nothing sticks. ``slipping``: whether there is
    friction."""
    if scene.free or scene.slides:
        return contact(scene), None
    if not slipping:
        pressed = contact(scene)
        return pressed, loading(pressed, 1.0, 0.0, 0.0, bound=2)
    begun = time.process_time(), time.perf_counter()
    pressed, change, cpu, wall = _change(scene)
    clock.add_earlier(max(cpu + begun[0] - time.process_time(), 0.0), max(wall + begun[1] - time.perf_counter(), 0.0))
    return pressed, change
