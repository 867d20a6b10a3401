"""The exact method: scene and plan in, result out."""

from collections.abc import Callable

import numpy as np

from partialslip.halfplane.contact import contact
from partialslip.halfplane.shape import Shape, StickZone
from partialslip.halfplane.steady import stick_zone
from partialslip.halfplane.traction import half_range, mean_load_bound
from partialslip.plan import Plan
from partialslip.result import Array, Clock, Regime, Result, Traction
from partialslip.scene import Scene

_POINTS_PER_ZONE = 101


def solve(scene: Scene, plan: Plan, progress: Callable[[str], None] = lambda _: None) -> Result:
    """Solve ``scene`` exactly, as two elastically similar half-planes in the steady state; SI units.

    It is done before there is any ``progress`` to tell.
    """
    del progress
    clock = Clock()
    f, load = scene.friction.f, scene.load
    a, shape = contact(scene)
    p0 = 2 * scene.P / (np.pi * a)
    regime, zone = _steady_state(scene, plan, p0, shape)

    # zone is the one for positive dQ and dsigma: turning q round, and mirroring x, brings it to the signs here
    turn = -1 if load.dQ < 0 else 1
    mirror = turn * (-1 if load.dsigma < 0 else 1)

    def at(x: Array) -> tuple[Array, Array]:
        p = p0 * shape.pressure(x / a)
        if not zone or regime == "stuck":
            return p, np.zeros_like(p)
        return p, turn * 2 * f * p0 * half_range(mirror * x / a, zone, shape)

    ends = [zone.centre - zone.half_width, zone.centre + zone.half_width] if zone else []
    breaks = a * np.unique(np.clip([-1.0, *shape.kinks, *(mirror * end for end in ends), 1.0], -1, 1))
    x = _sample(np.union1d(breaks, [0.0]))
    p, dq = at(x)
    levels = load.fully_reversed and regime != "sliding"
    return Result(
        method="exact",
        a=a,
        p0=p0,
        regime=regime,
        stick_centre=mirror * zone.centre * a if zone else None,
        stick_half_width=zone.half_width * a if zone else None,
        traction=Traction(x, p, dq, -dq / 2 if levels else None, dq / 2 if levels else None, at, breaks),
        cost=clock.cost(),
        settings={"model": "two half-planes, steady state"},
        notes=_notes(regime, levels, _turns_round(scene, p0, zone)),
    )


def _steady_state(scene: Scene, plan: Plan, p0: float, shape: Shape) -> tuple[Regime, StickZone | None]:
    """Regime and stick zone (scaled, for positive dQ and dsigma; None where the contact slides)."""
    f, load, limit = scene.friction.f, scene.load, scene.friction.f * scene.P
    if plan.needs("friction") and (abs(load.dQ) >= 2 * limit or max(map(abs, load.Q)) >= limit):
        return "sliding", None
    if not plan.needs("friction"):
        return ("sliding", None) if f == 0 else ("stuck", StickZone(0.0, 1.0, 1))
    if load.dQ == 0 and load.dsigma == 0:
        return "stuck", StickZone(0.0, 1.0, 1)
    zone = stick_zone(abs(load.dQ) / (2 * limit), abs(load.dsigma) / (f * p0), shape)
    if abs(sum(load.Q)) / 2 > limit * mean_load_bound(zone, shape):
        return "ratchets", zone
    return ("small tension" if zone.s > 0 else "large tension"), zone


def _sample(breaks: Array) -> Array:
    """Points that crowd towards the breaks, where tractions go like square roots."""
    crowd = (1 - np.cos(np.linspace(0, np.pi, _POINTS_PER_ZONE))) / 2
    return np.unique(breaks[:-1, None] + np.diff(breaks)[:, None] * crowd)


def _turns_round(scene: Scene, p0: float, zone: StickZone | None) -> bool:
    """Whether slip at one end turns round on a gradual way between the load points.

    On such a way the stick zone's left end, at a half-width c, recedes by slip in the direction of dQ/pi - c dsigma/4
    (the adhered traction of the zone). With one direction throughout that is positive from c = a on (small tension),
    or negative down to the last c (large tension).
    """
    if zone is None or scene.load.dsigma == 0:
        return False
    Qf = abs(scene.load.dQ) / (2 * scene.friction.f * scene.P)
    sf = abs(scene.load.dsigma) / (scene.friction.f * p0)
    return sf > 4 * Qf if zone.s > 0 else zone.half_width * sf < 4 * Qf


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
            "slip at one end turns round on a gradual way between these load points: dq then differs from the closed "
            "form; march with load.steps shows by how much"
        )
    return tuple(notes)
