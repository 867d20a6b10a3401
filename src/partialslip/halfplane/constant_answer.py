"""Steady states under constant pressure; SI units."""

import math
from functools import partial

from partialslip.halfplane.answer import Answer, AtLoadPoints
from partialslip.halfplane.change import Change
from partialslip.halfplane.contact import Contact
from partialslip.halfplane.levels import RATCHETS, STARTED, Levels, levels
from partialslip.halfplane.loading import Loading
from partialslip.halfplane.states import constant
from partialslip.halfplane.steady import transition
from partialslip.result import Regime, Slip, SteadyState
from partialslip.scene import Scene


def under_constant_pressure(scene: Scene, pressed: Contact, change: Change, started: bool, inside: bool) -> Answer:
    """The steady cycle of ``scene`` in the contact ``pressed``, by its ``change`` of shear; ``started`` and ``inside``
    as of :func:`partialslip.halfplane.varying_answer.under_varying_pressure`."""
    a, zone, regime, slips = pressed.a, change.zone, _regime(scene, pressed, change), not change.nothing
    found = _levels(scene, pressed, regime, change, started)
    state = SteadyState(regime, pressed.centre + change.mirror * zone.centre * a, zone.half_width * a)
    steady = slips and regime != "ratchets"
    if steady and change.holds:
        left, right = pressed.places(change.permanent or (math.nan, math.nan)).tolist()
        state = state._replace(permanent=(left, right))
    return Answer(
        pressed,
        pressed,
        state,
        found,
        constant(scene, found) if inside and isinstance(found, Levels) else None,
        partial(change.within, pressed, pressed.f),
        pressed.places(change.breaks).tolist(),
        not change.holds,
        _slip_of_change(scene, pressed, change) if steady else None,
        change.certificate if slips else {},
    )


def limits(scene: Scene, pressed: Contact, change: Change | None) -> dict[str, float]:
    """Loads up to which the contact does not slide, tension is small, and the cycle is steady."""
    limit = pressed.f * scene.P
    known = {"Q_sliding": limit}
    if change:
        if not (change.gf or pressed.layer):
            known["dsigma_transition"] = float(transition(change.Qf, change.seen)) * pressed.f * pressed.p0
        known["Q_mean"] = limit * change.mean_load_bound
    return known


def _regime(scene: Scene, pressed: Contact, change: Change) -> Regime:
    if change.nothing:
        return "stuck"
    # where dq has one sign the bound is gross sliding, ruled out before; a zero mean is within any bound, even one that
    # rounding makes negative
    mean = abs(scene.load.Q_mean)
    if not change.one_way and mean > 0 and mean > pressed.f * scene.P * change.mean_load_bound:
        return "ratchets"
    return "small tension" if change.zone.s > 0 else "large tension"


def _levels(scene: Scene, pressed: Contact, regime: Regime, change: Change, started: bool) -> AtLoadPoints | str:
    """q1 and q2, or the reason why there are none."""
    if regime == "ratchets":
        return RATCHETS
    if started:
        return STARTED
    if not scene.friction.f and isinstance(change, Loading):
        return Levels(pressed, pressed.f, change, change, 1)
    return levels(pressed, pressed.f, scene.load, change)


def _slip_of_change(scene: Scene, pressed: Contact, change: Change) -> Slip:
    worn, stress = change.worn, pressed.f * pressed.p0
    unit = scene.material.A * stress * pressed.a
    energy = unit * stress * pressed.a
    error = energy * worn.error if change.holds else None
    return Slip(pressed.centre + pressed.a * worn.x, unit * worn.slip, energy * worn.dissipated, error)
