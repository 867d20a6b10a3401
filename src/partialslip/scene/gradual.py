"""Whether slip reverses during gradual loading between the load points (docs/theory.md, section 7).

If slip does not reverse, a single step from load point to load point gives the result of gradual loading. If it does,
only small steps do. Formulas are for similar half-planes and loads in phase; scaled: lengths by a,
``Qf`` = \\|dQ\\|/(2 f P), ``sf`` = \\|dsigma\\|/(f p0), p0 = 2 P/(pi a).
"""

import math

import numpy as np

from partialslip.scene import Hertz, Scene
from partialslip.tools.arrays import Array, Mask

# cost: Hertz, large tension: slip does not reverse for Qf <= _QF and _SLOPE Qf <= sf <= _SF, a box inside the exact
# domain of `turns_round` (checked in tests/halfplane/test_gradual.py).
_QF, _SLOPE, _SF = 0.44, 6.0, 10.0
_Numbers = Array | float


def left_end_turns(Qf: _Numbers, sf: _Numbers, s: _Numbers, half_width: _Numbers) -> Mask:
    """Whether slip in the left slip zone reverses while the stick zone shrinks to ``half_width``; arrays broadcast.

    At a half-width c of the stick zone, slip at the left end is driven by dQ/pi - c dsigma/4, from the adhered traction
    of the stick zone (for positive changes). Slip does not reverse if this keeps one sign: positive from c = 1 on if
    both ends slip the same way (``s`` = 1), negative down to the last c if they slip opposite ways (-1).
    """
    return np.where(np.asarray(s) > 0, sf > 4 * Qf, half_width * sf < 4 * Qf)


def turns_round(Qf: _Numbers, sf: _Numbers, s: _Numbers, centre: _Numbers, half_width: _Numbers) -> Mask:
    """Whether slip reverses between the load points of cycles whose stick zones, from a single step, have this
    ``centre`` and ``half_width`` (for positive changes of both loads), at any pressure; arrays broadcast.

    Besides :func:`left_end_turns`: points that slip must be pushed in the direction of slip from the beginning of the
    half cycle. If the ends slip opposite ways, the point x = -4 dQ/(pi dsigma), at which the adhered traction of the
    whole contact changes sign, must therefore lie in the final stick zone.
    """
    left = left_end_turns(Qf, sf, s, half_width)
    # -4 Qf/sf is outside; multiplied by sf, which may be 0
    pushed = (np.asarray(s) < 0) & (np.abs(4 * Qf + sf * centre) > sf * half_width)
    return left | pushed


def may_turn_round(scene: Scene) -> bool:
    """Whether slip may reverse between the load points of ``scene``, decided without solving: False if a reversal is
    ruled out, True otherwise."""
    load, f = scene.load, scene.friction.f
    if not (load.in_phase and scene.mirrored):
        return True
    if f == 0 or scene.slides:
        return False
    if scene.presses_anew or load.dslope or scene.friction.varies:
        return True
    if load.dsigma == 0:
        return False
    if scene.finite or not isinstance(scene.profile, Hertz):
        return True
    p0 = math.sqrt(2 / math.pi) * scene.P / scene.length  # 2 P/(pi a), a^2 = 2 A R P/pi
    Qf, sf = abs(load.dQ) / (2 * f * scene.P), abs(load.dsigma) / (f * p0)
    return not (small_tension(scene) or (Qf <= _QF and _SLOPE * Qf <= sf <= _SF))


def small_tension(scene: Scene) -> bool:
    """Whether both ends of a Hertz contact of half-planes slip the same way at all loads: dsigma a < 4 dQ/pi."""
    load, f = scene.load, scene.friction.f
    if not isinstance(scene.profile, Hertz) or scene.finite or not scene.mirrored or scene.slides or f == 0:
        return False
    if scene.presses_anew or load.dslope or scene.friction.varies:
        return False
    a = math.sqrt(2 / math.pi) * scene.length
    return load.in_phase and 0 < abs(load.dsigma) * a < 4 / math.pi * abs(load.dQ)
