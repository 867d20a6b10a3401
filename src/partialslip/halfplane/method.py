"""The exact method: scene and plan in, result out."""

from collections.abc import Callable

import numpy as np

from partialslip.errors import InputError
from partialslip.halfplane.contact import Contact, contact
from partialslip.halfplane.slip import dissipation
from partialslip.halfplane.steady import NARROWEST, StickZone, stick_zone, transition
from partialslip.halfplane.stress import Stress
from partialslip.halfplane.traction import half_range, mean_load_bound
from partialslip.plan import Plan
from partialslip.result import Array, Clock, Regime, Result, Slip, SurfaceStress, Traction
from partialslip.scene import Scene
from partialslip.state import State

_POINTS_PER_ZONE = 101
_BEYOND = 4.0  # surface stresses are reported up to so many half-widths


def solve(
    scene: Scene, plan: Plan, progress: Callable[[str], None] = lambda _: None, start: State | None = None
) -> Result:
    """Solve ``scene`` exactly, as two elastically similar half-planes in the steady state; SI units.
    ``plan`` is what the scene calls for (:func:`partialslip.plan`).

    It is done before there is any ``progress`` to tell; and a steady state does not remember its ``start``.

    Raises
    ------
    InputError
        If Q and sigma are out of phase: there is no closed form.
    """
    del progress, start
    clock = Clock()
    f, load = scene.friction.f, scene.load
    if not load.in_phase:
        raise InputError("load.sigma: out of phase with load.Q; the exact method is for loads in phase, take march")
    pressed = contact(scene)
    a, p0, shape = pressed.a, pressed.p0, pressed.shape
    regime, zone = _steady_state(scene, plan, pressed)

    # zone is the one for positive dQ and dsigma: turning q round, and mirroring x, brings it to the signs here
    turn = -1 if load.dQ < 0 else 1
    mirror = turn * (-1 if load.dsigma < 0 else 1)

    def at(x: Array) -> tuple[Array, Array]:
        p = pressed.pressure(x)
        if not zone or regime == "stuck":
            return p, np.zeros_like(p)
        return p, turn * 2 * f * p0 * half_range(mirror * x / a, zone, shape)

    ends = [mirror * (zone.centre + way * zone.half_width) for way in (-1, 1)] if zone else []
    kinks = [kink for kink in scene.profile.kinks if abs(kink) < a]
    breaks = np.unique([-a, *kinks, *(a * np.clip(ends, -1, 1)), a])
    x = _sample(np.union1d(breaks, [0.0]))
    p, dq = at(x)
    levels = load.fully_reversed and regime != "sliding"
    stress = Stress(pressed, f, load.dQ, load.dsigma) if plan.needs("subsurface") and levels else None
    surface = _surface(stress, np.concatenate([[-_BEYOND * a], breaks, [_BEYOND * a]])) if stress else None
    return Result(
        method="exact",
        a=a,
        p0=p0,
        regime=regime,
        stick_centre=mirror * zone.centre * a if zone else None,
        stick_half_width=zone.half_width * a if zone else None,
        traction=Traction(x, p, dq, -dq / 2 if levels else None, dq / 2 if levels else None, at, breaks),
        cost=clock.cost(),
        slip=_slip(scene, pressed, zone, turn, mirror) if zone and regime not in ("stuck", "ratchets") else None,
        settings={"model": "two half-planes, steady state"},
        limits=_limits(scene, pressed, zone) if plan.needs("friction") or (scene.slides and f > 0) else {},
        certificate=_certificate(scene, pressed, zone) if zone and regime != "stuck" else {},
        notes=_notes(regime, levels, _turns_round(scene, p0, zone)),
        surface=surface,
        stress_at=stress.inside if stress else None,
    )


def _steady_state(scene: Scene, plan: Plan, pressed: Contact) -> tuple[Regime, StickZone | None]:
    """Regime and stick zone (scaled, for positive dQ and dsigma; None where the contact slides)."""
    f, load, limit = scene.friction.f, scene.load, scene.friction.f * scene.P
    if scene.slides:
        return "sliding", None
    if not plan.needs("friction"):
        return "stuck", StickZone(0.0, 1.0, 1)
    if load.dQ == 0 and load.dsigma == 0:
        return "stuck", StickZone(0.0, 1.0, 1)
    zone = stick_zone(abs(load.dQ) / (2 * limit), abs(load.dsigma) / (f * pressed.p0), pressed.shape)
    # for small tension the bound is gross sliding, which has been ruled out
    if zone.s < 0 and abs(load.Q_mean) > limit * mean_load_bound(zone, pressed.shape):
        return "ratchets", zone
    return ("small tension" if zone.s > 0 else "large tension"), zone


def _limits(scene: Scene, pressed: Contact, zone: StickZone | None) -> dict[str, float]:
    limit = scene.friction.f * scene.P
    limits = {"Q_sliding": limit}
    if zone:
        turns = transition(abs(scene.load.dQ) / (2 * limit), pressed.shape)
        limits["dsigma_transition"] = float(turns) * scene.friction.f * pressed.p0
        limits["Q_mean"] = limit * mean_load_bound(zone, pressed.shape)
    return limits


def _certificate(scene: Scene, pressed: Contact, zone: StickZone) -> dict[str, float]:
    """How far the loads that belong to the zone are off: ``tension`` in f p0, or relative where it is more than that,
    and ``shear`` in 2 f P. Zones narrower than can be told apart belong to any larger tension. What dQ leaves to
    sliding, which places a zone near it, is known to the rounding of dQ only: that is no fault of the zone's."""
    c, load, f = zone.half_width, scene.load, scene.friction.f
    found = pressed.shape.conditions(*map(np.array, (1 + zone.centre - c, c, zone.s)))
    sf, Qf = abs(load.dsigma) / (f * pressed.p0), abs(load.dQ) / (2 * f * scene.P)
    tension = 0.0 if c <= NARROWEST and sf > found.sf else abs(float(found.sf) - sf) / max(sf, 1.0)
    rounding = np.finfo(float).eps / max(1 - Qf, np.finfo(float).eps)
    return {"tension": max(tension - float(rounding), 0.0), "shear": abs(float(found.Qf) - Qf)}


def _slip(scene: Scene, pressed: Contact, zone: StickZone, turn: int, mirror: int) -> Slip:
    x, slips, dissipated = dissipation(zone, pressed.shape)
    stress, unit = scene.friction.f * pressed.p0, scene.material.A * scene.friction.f * pressed.p0 * pressed.a
    return Slip(mirror * pressed.a * x[::mirror], turn * unit * slips[::mirror], dissipated * unit * stress * pressed.a)


def _surface(stress: Stress, breaks: Array) -> SurfaceStress:
    x = _sample(breaks)
    return SurfaceStress(x, stress.surface(x), stress.surface)


def _sample(breaks: Array) -> Array:
    """Points that crowd towards the breaks, where tractions go like square roots."""
    crowd = (1 - np.cos(np.linspace(0, np.pi, _POINTS_PER_ZONE))) / 2
    return np.unique(breaks[:-1, None] + np.diff(breaks)[:, None] * crowd)


def _turns_round(scene: Scene, p0: float, zone: StickZone | None) -> bool:
    """Whether slip turns round somewhere on a gradual way between the load points.

    On such a way the stick zone's left end, at a half-width c, recedes by slip in the direction of dQ/pi - c dsigma/4
    (the adhered traction of the zone). With one direction throughout that is positive from c = a on (small tension),
    or negative down to the last c (large tension). And what is to slip must have been pushed that way from the first,
    or it slips the other way when the loads turn: the adhered traction of the whole contact changes sign at
    x = -4 dQ/(pi dsigma), which has to be in the last stick zone.
    """
    if zone is None or scene.load.dsigma == 0:
        return False
    Qf = abs(scene.load.dQ) / (2 * scene.friction.f * scene.P)
    sf = abs(scene.load.dsigma) / (scene.friction.f * p0)
    if zone.s > 0:
        return sf > 4 * Qf
    return zone.half_width * sf < 4 * Qf or not abs(-4 * Qf / sf - zone.centre) <= zone.half_width


def _notes(regime: Regime, levels: bool, turns_round: bool) -> tuple[str, ...]:
    if regime == "sliding":
        return ("the contact slides: |Q| >= f P at a load point, or dQ >= 2 f P; there is no steady partial slip",)
    notes: list[str] = []
    if regime == "ratchets":
        notes.append(
            "the mean of Q is beyond what a steady state can hold: the contact ratchets, m and n are not reached"
        )
    elif not levels:
        notes.append("with mean loads the steady state fixes the change dq = q2 - q1, not q1 and q2 themselves")
    if turns_round:
        notes.append(
            "slip turns round on a gradual way between these load points: dq may then differ from the closed form; "
            "march with load.steps shows by how much"
        )
    return tuple(notes)
