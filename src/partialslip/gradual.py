"""Whether slip turns round on a gradual way between the load points (docs/theory.md, section 7).

Where it does not, a single step from load point to load point ends where the gradual way does. Where it does, only
small steps find the outcome. Formulas are for similar half-planes and loads in phase; scaled: lengths by a,
``Qf`` = \\|dQ\\|/(2 f P), ``sf`` = \\|dsigma\\|/(f p0), p0 = 2 P/(pi a).
"""

import math

from partialslip.scene import Hertz, Scene

# For Hertz, large tension within these limits does not turn round: a box inside the exact domain, which
# `turns_round` bounds (tests/halfplane/test_gradual.py goes round it).
_QF, _SLOPE, _SF = 0.44, 6.0, 10.0


def left_end_turns(Qf: float, sf: float, s: float, half_width: float) -> bool:
    """Whether the slip zone at the left end turns round while the stick zone shrinks to ``half_width``.

    At a half-width c of the stick zone its left end is driven by dQ/pi - c dsigma/4 (the adhered traction of the
    stick zone of that moment, for positive changes). Its sign must be one: positive from c = 1 on where both ends slip
    the same way (``s`` = 1), negative down to the last c where they slip opposite ways (-1).
    """
    return sf > 4 * Qf if s > 0 else half_width * sf < 4 * Qf


def turns_round(Qf: float, sf: float, s: float, centre: float, half_width: float) -> bool:
    """Whether slip turns round between the load points of a cycle that one step from one to the other leaves with the
    stick zone of that ``centre`` and ``half_width`` (for positive changes of both loads), at any pressure.

    Beside :func:`left_end_turns`: what is to slip must have been pushed that way from the first, or it slips the other
    way when the loads turn. The adhered traction of the whole contact changes sign at x = -4 dQ/(pi dsigma), which
    has to be in the last stick zone where the ends slip opposite ways.
    """
    if s > 0 or sf == 0:
        return sf > 4 * Qf
    return left_end_turns(Qf, sf, s, half_width) or abs(-4 * Qf / sf - centre) > half_width


def may_turn_round(scene: Scene) -> bool:
    """Whether slip may turn round between the load points of ``scene``: False where that is ruled out without solving
    anything, True where it happens or is not known."""
    load, f = scene.load, scene.friction.f
    if not (load.in_phase and scene.mirrored):
        return True
    if f == 0 or scene.slides or load.dsigma == 0:
        return False
    if scene.finite or not isinstance(scene.profile, Hertz):
        return True
    p0 = math.sqrt(2 / math.pi) * scene.P / scene.length  # 2 P/(pi a), a^2 = 2 A R P/pi
    Qf, sf = abs(load.dQ) / (2 * f * scene.P), abs(load.dsigma) / (f * p0)
    return not (small_tension(scene) or (Qf <= _QF and _SLOPE * Qf <= sf <= _SF))


def small_tension(scene: Scene) -> bool:
    """Whether both ends of a Hertz contact of half-planes slip the same way, all the way: dsigma a < 4 dQ/pi."""
    load, f = scene.load, scene.friction.f
    if not isinstance(scene.profile, Hertz) or scene.finite or not scene.mirrored or scene.slides or f == 0:
        return False
    a = math.sqrt(2 / math.pi) * scene.length
    return load.in_phase and 0 < abs(load.dsigma) * a < 4 / math.pi * abs(load.dQ)
