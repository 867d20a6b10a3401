"""The exact method under varying normal load and moment: the steady cycle as a result; SI units."""

import math
from dataclasses import dataclass, replace

import numpy as np

from partialslip.halfplane.contact import Contact
from partialslip.halfplane.loading import Loading, loading
from partialslip.halfplane.mean_pressure import PressurePath, common
from partialslip.halfplane.remarks import no_stresses, remarks, undetermined
from partialslip.halfplane.states import Around, sliding_state, varying, without_shear
from partialslip.halfplane.stress import SURFACE_REACH, along_surface
from partialslip.halfplane.tractions import sample
from partialslip.halfplane.varying import Cycle, steady_cycle
from partialslip.result import PATH_DEPENDENT, Clock, Regime, Result, Slip, SteadyState, StressAt, Traction, TractionAt
from partialslip.scene import Scene
from partialslip.scene.plan import Plan
from partialslip.tools.arrays import Array

_ROUNDING = 1e-9  # accuracy: lengths in a, tractions in f p0
_STAGES = np.linspace(0, 1, 9)
_PLACES = np.cos(np.linspace(np.pi, 0, 81))[1:-1]
_ROOM = 1e-12  # accuracy: of Q, in f P, beyond the bounds that is rounding
_SLIDES = "the contact slides: |Q| >= f P at a load point; there is no steady partial slip"
_RATCHETS = "the mean of Q is outside the bounds for a steady state: the contact ratchets"


@dataclass(frozen=True)
class VaryingTractions:
    """Tractions at any points: the contacts ``first`` and ``second`` at load points 1 and 2, the steady ``cycle`` (None
    without friction and in sliding), and the ``loaded`` contact and the first loading to load point 2, where they give
    q2 (None elsewhere); ``still``: there is no shear."""

    first: Contact
    second: Contact
    cycle: Cycle | None
    f: float
    loaded: Loading | None
    still: bool

    def at(self, x: Array) -> TractionAt:
        """Tractions at ``x`` (m), Pa; zero outside the contact."""
        p1, p, q1, q2 = self.first.pressure(x), self.second.pressure(x), None, None
        dq = self.cycle.dq(x) if self.cycle else np.zeros_like(p)
        if self.loaded:
            q2 = self.f * self.second.p0 * self.loaded.traction(self.second.scaled(x))
            q1 = q2 - dq
        elif self.still:
            q1, q2 = np.zeros_like(p), np.zeros_like(p)
        return TractionAt(p, dq, q1, q2, p1)


def solve_varying(scene: Scene, plan: Plan, started: bool, clock: Clock) -> Result:
    """Solve ``scene`` exactly, in the steady state.

    Parameters
    ----------
    scene : Scene
        Loads in phase; P or M varies.
    plan : Plan
    started : bool
        Whether the path begins in a state, on which q1 and q2 then depend.
    clock : Clock
    """
    f = scene.friction.f
    slipping = plan.needs("friction")
    cycle = steady_cycle(scene) if slipping else None
    way = PressurePath(scene)
    first, second = (cycle.first, cycle.second) if cycle else (way.begin, way.at(1.0))
    largest = (first, second)[scene.largest - 1]
    regime = _regime(scene, cycle)
    loaded = _first_loading(scene, cycle, started) if cycle and regime != "ratchets" else _no_levels(regime)
    still = not slipping and regime == "stuck"
    tractions = VaryingTractions(first, second, cycle, f, None if isinstance(loaded, str) else loaded, still)
    inside = plan.needs("subsurface")
    stress = _stresses(scene, cycle, loaded) if inside else None
    left, right = cycle.stick if cycle else common(first, second) if still else (math.nan, math.nan)
    known = math.isfinite(left)
    breaks = _breaks(scene, first, second, (left, right) if known else (), tractions)
    x = sample(breaks)
    turns = cycle is not None and cycle.turns_round
    why = {} if still else undetermined(regime, turns, loaded)
    if inside and not stress:
        why |= no_stresses(loaded)
    far = np.array([-1.0, 1.0]) * (abs(sum(largest.ends)) / 2 + SURFACE_REACH * largest.a)
    centre, half_width = ((left + right) / 2, (right - left) / 2) if known else (None, None)
    notes = remarks(regime, turns, why, _SLIDES, _RATCHETS)
    state = SteadyState(regime, centre, half_width, notes, cycle.slips if cycle else None)
    traction = Traction(x, tractions.at(x), tractions.at, breaks)
    return replace(
        Result.of("exact", state, largest.a, largest.p0, traction, clock),
        slip=_slip(cycle) if cycle and cycle.change and regime != "ratchets" else None,
        settings={"model": "two half-planes, steady state under varying pressure"},
        limits=_limits(scene, cycle) if cycle else {},
        certificate=cycle.change.certificate if cycle and cycle.change else {},
        surface=along_surface(stress.surface, np.sort([*far, *breaks])) if stress else None,
        stress_at=StressAt(stress.inside) if stress else None,
        undetermined=why,
        path_dependent=turns,
        contact_ends=(first.ends, second.ends),
    )


def _slip(cycle: Cycle) -> Slip:
    """Slip of the ``cycle``; the error of its work is not known where slip reverses on the way."""
    worn = cycle.slip()
    return Slip(worn.x, worn.slip, worn.dissipated, None if cycle.turns_round else worn.error)


def _regime(scene: Scene, cycle: Cycle | None) -> Regime:
    if scene.free:
        return "frictionless"
    if scene.slides:
        return "sliding"
    if cycle is None:
        return "stuck"
    first, _ = scene.load.ends
    low, high = cycle.bounds_of_Q1
    room = _ROOM * scene.friction.f * scene.P
    if not low - room <= scene.load.points[first][0] <= high + room:
        return "ratchets"
    if cycle.change is None:
        return "no slip"
    return "small tension" if cycle.change.zone.s > 0 else "large tension"


def _stresses(scene: Scene, cycle: Cycle | None, loaded: Loading | str) -> Around | None:
    """Stresses of the steady state; None where q1 and q2 are not known."""
    if isinstance(loaded, Loading) and cycle:
        return varying(scene, cycle.second, loaded, "slip reverses" if cycle.turns_round else "")
    if scene.slides:
        return sliding_state(scene)
    return None if cycle else without_shear(scene)


def _no_levels(regime: Regime) -> str:
    return {"ratchets": "the contact ratchets", "sliding": "the contact slides"}.get(regime, "there is no friction")


def _first_loading(scene: Scene, cycle: Cycle, started: bool) -> Loading | str:
    """The first loading to load point 2, if its traction is that of the steady cycle; otherwise why not.

    As under constant pressure (:func:`partialslip.halfplane.levels.levels`): the first loading slips wherever the cycle
    slips, and the same way, and the traction less the change stays within the bound all the way to load point 1.
    """
    f, load = scene.friction.f, scene.load
    if started:
        return "the path goes on from a state, which the closed form cannot follow"
    if cycle.change is None:
        return "where an end sticks, what the first cycles lock in has no closed form; use march"
    if load.ends[1] != len(load.points) - 1 or len(load.points) > 2:
        return "the path goes through more than two load points; use march"
    end = cycle.second
    loads = load.along[load.ends[1]]
    if not any(loads):
        return "no load acts along x at load point 2, and the cycle slips; use march"
    first = loading(end, f, *loads, bound=1)
    if first.left_end_turns():
        return f"{PATH_DEPENDENT}during the first loading; use march"
    left, right = end.places(first.ends)
    room = _ROUNDING * end.a
    if not (cycle.stick[0] - room <= left and right <= cycle.stick[1] + room) or first.signs != cycle.change.signs:
        return "mean loads act, and the cycle slips where the first loading sticks; use march"
    for back in (True, False):
        way = PressurePath(scene, back)
        for share in _STAGES[1:].tolist():
            now, mean, part = way.stage(share)
            x = mean.places(_PLACES)
            q = f * end.p0 * first.traction(end.scaled(x)) + f * mean.p0 * part.traction(mean.scaled(x))
            if not back:
                q = q - cycle.dq(x)
            if (np.abs(q) > f * (now.pressure(x) + _ROUNDING * mean.p0)).any():
                return "mean loads act, and the first loading less the change exceeds f p; use march"
    return first


def _breaks(
    scene: Scene, first: Contact, second: Contact, stick: tuple[float, ...], tractions: VaryingTractions
) -> Array:
    """Points where tractions are not smooth, m, ascending: ends of contacts and of stick zones, and kinks of p."""
    ends = [*first.ends, *second.ends]
    inner = [*stick, *scene.profile.kinks]
    if tractions.loaded:
        inner += second.places(tractions.loaded.ends).tolist()
    return np.unique([*ends, *(point for point in inner if min(ends) < point < max(ends))])


def _limits(scene: Scene, cycle: Cycle) -> dict[str, float]:
    low, high = cycle.bounds_of_Q1
    return {"Q_mean_least": low + scene.load.dQ / 2, "Q_mean_most": high + scene.load.dQ / 2}
