"""f from the width of a scar: the stick zone, or the wider slip zone, that half-planes have under the scene's loads."""

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from partialslip.halfplane import Contact, contact, stick_zone
from partialslip.scene import Scene
from partialslip.study.identify.half_planes import half_planes
from partialslip.study.identify.interval import Interval
from partialslip.tools.errors import InputError

_NEARLY, _HIGHEST = 1 + 1e-9, 1e6  # limit: f over its least, at which the contact slides
_TENSE = 80.0  # limit: dsigma/(f p0) of the least f under tension alone


def from_width(
    scene: Scene, width: float, error: float | None = None, slip: bool = False
) -> tuple[Interval, tuple[str, ...]]:
    """f from the ``width`` (m) of the stick zone, or with ``slip`` of the wider slip zone, and remarks. The interval is
    that of widths within +-``error`` (m, 95 %); NaN without it. It has no upper end if nothing may slip.

    Raises
    ------
    InputError
        If no load changes, no f gives this width, or the scene is none of two half-planes under constant P and one f.
    """
    scene, remarks = half_planes(scene)
    pressed = contact(scene)
    widths, least = _widths(scene, pressed, slip)
    most = widths(least * _NEARLY) if slip else 2 * pressed.a
    option, text = "--slip-scar" if slip else "--stick-width", scene.units.length
    if not 0 < width < most:
        what = "the largest slip zone, just before sliding" if slip else "the contact"
        raise InputError(f"{option} {text(width)}: must be between 0 and {text(most)}, the width of {what}")

    def friction(of: float) -> float:
        if of <= 0 or of >= most:
            return np.inf if (of <= 0) == slip else least
        if (widths(least * _HIGHEST) - of) * (1 if slip else -1) > 0:
            return np.inf
        ends = np.log(least * np.array([_NEARLY, _HIGHEST]))
        return float(np.exp(brentq(lambda log: widths(np.exp(log)) - of, *ends)))

    if error is None:
        remarks += ("No interval without the error of the width: give --error.",)
        return Interval(friction(width), np.nan, np.nan), remarks
    low, high = sorted((friction(width - error), friction(width + error)))
    if np.isinf(high):
        remarks += (f"Within its error the width is that of no slip: f is at least {low:.3g}.",)
    if low <= least:
        remarks += ("Within its error the width is that of sliding: the lower end is Q/P.",)
    return Interval(friction(width), low, high), remarks


def _widths(scene: Scene, pressed: Contact, slip: bool) -> tuple[Callable[[float], float], float]:
    """The width (m) as a function of f, and the f below which the contact slides."""
    load = scene.load
    least = max(abs(load.dQ) / (2 * pressed.P), abs(load.dsigma) / (_TENSE * pressed.p0))
    if not least:
        raise InputError("load.Q, load.sigma: the same at load points 1 and 2: must change, or nothing slips")

    def widths(f: float) -> float:
        zone = stick_zone(pressed, np.array([f]), load.dQ, load.dsigma)  # of an array: by a table under slip reversal
        if np.isnan(zone.half_width).any():
            raise InputError(f"load.sigma: slip reverses, and at f = {f:.3g} the stick zone is not known: must be less")
        left, right = pressed.ends
        return float(max(zone.left[0] - left, right - zone.right[0]) if slip else 2 * zone.half_width[0])

    return widths, least
