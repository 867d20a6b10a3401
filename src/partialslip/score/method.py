"""Tractions from outside as a result, like that of any method."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from partialslip.errors import InputError
from partialslip.result import Array, Clock, Regime, Result, Traction
from partialslip.scene import Scene
from partialslip.score.ends import NOISE, End, left_end, noise, right_end, zone
from partialslip.score.samples import FEWEST, Samples

_SLIDES = 0.02  # of 2 f p0: with less room than that, or than noise, nothing is seen to stick
_ROUNDING = 1e-9
_OFF = 0.05  # relative difference of resultants that is worth a note
_LOOSE = 0.1  # by which |dq| may be beyond 2 f p
_TIGHT = 1e-3  # by which it may stay below where it slips


class Stick(NamedTuple):
    """The stick zone, and the signs of dq in the slip zones on its left and right."""

    left: End
    right: End
    signs: tuple[int, int]


def scored(scene: Scene, samples: Samples, name: str, origin: str) -> Result:
    """What ``samples`` say of ``scene``: contact, stick zone and regime are read from the tractions alone, with the
    scene's coefficient of friction.

    Parameters
    ----------
    name, origin : str
        Of the method, and where the samples are from.

    Raises
    ------
    InputError
        If there is no contact in them that is more than noise.
    """
    clock = Clock()
    x, p, dq, f = samples.x, samples.p, samples.dq, scene.friction.f
    touching = zone(p, x)
    if touching is None or touching[1] - touching[0] + 1 < FEWEST:
        hint = "" if samples.cells is None else "; or are the elements of another order (--order)?"
        raise InputError(f"{origin}: p: must stand out from its noise at {FEWEST} or more neighbouring points{hint}")
    first, last = touching
    skip = 0 if samples.cells is None else 1
    left, right = left_end(x, p, first, last, skip), right_end(x, p, last, first, skip)
    a = (right.x - left.x) / 2
    if not a > 0:
        raise InputError(f"{origin}: p: no contact of any width is found in it")
    p0 = 2 * scene.P / (np.pi * a)
    inside = slice(first, last + 1)
    stick = _stick(x[inside], p[inside], dq[inside], f, p0, skip) if f > 0 else None
    regime, ends = _regime(scene, x, dq, stick, left, right, p0)
    uncertainty = {"a": float(np.hypot(left.uncertainty, right.uncertainty)) / 2 / a}
    if ends:
        uncertainty |= {"m": ends[0].uncertainty / a, "n": ends[1].uncertainty / a}
    traction = _traction(samples, left.x, right.x)
    return Result(
        method=name,
        a=a,
        p0=p0,
        regime=regime,
        stick_centre=(ends[0].x + ends[1].x) / 2 if ends else None,
        stick_half_width=(ends[1].x - ends[0].x) / 2 if ends else None,
        traction=traction,
        cost=clock.cost(),
        settings={
            "read": "means over cells" if samples.cells is not None else "values at points",
            "spacing_over_a": _rounded(float(np.median(np.diff(x[inside]))) / a),
            "noise_over_p0": _rounded(noise(p[inside], x[inside]) / p0),
        },
        counts={"points": len(x), "contact_nodes": last - first + 1},
        estimate=uncertainty,
        notes=_notes(scene, traction, left, right),
    )


def _stick(x: Array, p: Array, dq: Array, f: float, p0: float, skip: int) -> Stick | None:
    """From the room 2 f p - |dq| that points in contact leave; None where nothing sticks."""
    room = 2 * f * p - np.abs(dq)
    found = zone(room, x)
    if found is None or room.max() < 2 * f * p0 * min(_SLIDES, 4 / len(x)):
        return None
    signs = (1 if dq[: found[0] + 1].sum() >= 0 else -1), (1 if dq[found[1] :].sum() >= 0 else -1)
    first, last = found
    left = left_end(x, 2 * f * p - signs[0] * dq, first, last, skip)
    right = right_end(x, 2 * f * p - signs[1] * dq, last, first, skip)
    return Stick(left, right if right.x > left.x else End(left.x, right.uncertainty), signs)


def _regime(
    scene: Scene, x: Array, dq: Array, stick: Stick | None, left: End, right: End, p0: float
) -> tuple[Regime, tuple[End, End] | None]:
    """What the tractions show, and the ends of the stick zone, within the contact's."""
    if stick is None:
        return "sliding", None
    if not np.abs(dq).max() > max(_ROUNDING * p0, NOISE * noise(dq, x)):
        return "stuck", (left, right)
    ends = (max(stick.left, left), min(stick.right, right))
    if not scene.load.in_phase:
        return "out of phase", ends
    return ("small tension" if stick.signs[0] == stick.signs[1] else "large tension"), ends


def _traction(samples: Samples, left: float, right: float) -> Traction:
    """Means over cells are as they are; between points tractions go linearly, and to zero at the contact's ends."""
    x, p, dq, cells = samples.x, samples.p, samples.dq, samples.cells
    at: Callable[[Array], tuple[Array, Array]]
    if cells is None:
        ends = np.array([end for end in (left, right) if not x[0] <= end <= x[-1]])
        breaks, order = np.unique(np.concatenate([x, ends]), return_index=True)
        values = [np.concatenate([column, np.zeros(len(ends))])[order] for column in (p, dq)]

        def at(points: Array) -> tuple[Array, Array]:
            on_p, on_dq = (np.interp(points, breaks, column, left=0.0, right=0.0) for column in values)
            return on_p, on_dq
    else:
        breaks = cells

        def at(points: Array) -> tuple[Array, Array]:
            cell = np.clip(np.searchsorted(cells, points) - 1, 0, len(x) - 1)
            within = (points >= cells[0]) & (points <= cells[-1])
            return np.where(within, p[cell], 0.0), np.where(within, dq[cell], 0.0)

    return Traction(x, p, dq, samples.q1, samples.q2, at, breaks, breaks)


def _notes(scene: Scene, traction: Traction, left: End, right: End) -> tuple[str, ...]:
    """What looks like a slip of whoever wrote the file."""
    notes, f, a = [], scene.friction.f, (right.x - left.x) / 2
    middle = (left.x + right.x) / 2
    if abs(middle) > max(_ROUNDING * a, 2 * np.hypot(left.uncertainty, right.uncertainty)):
        notes.append(f"the contact's middle is at x = {middle / a:.2g} a")
    widths = np.diff(traction.breaks)
    centres = (traction.breaks[1:] + traction.breaks[:-1]) / 2
    P, dQ = (float(column @ widths) for column in traction.at(centres))
    notes += _resultant("p", P, scene.P, "P")
    notes += (of_dq := _resultant("dq", dQ, scene.load.dQ, "dQ"))
    beyond = np.abs(traction.dq) > (1 + _LOOSE) * 2 * f * np.maximum(traction.p, 0.0)
    if f > 0 and np.count_nonzero(beyond) > np.count_nonzero(traction.p > 0) / 4:
        notes.append("|dq| is beyond 2 f p at many points: another coefficient of friction?")
    pressed, shear = traction.p > _ROUNDING * traction.p.max(), np.abs(traction.dq)
    share = float((shear[pressed] / (2 * f * traction.p[pressed])).max()) if f > 0 else 0.0
    if 0 < share < 1 - _TIGHT and scene.load.dQ > 0 and not of_dq:
        why = "points too far apart, or another coefficient of friction?"
        notes.append(f"|dq| is {share:.3g} of 2 f p at most, so that nothing is seen to slip: {why}")
    return tuple(notes)


def _resultant(column: str, found: float, load: float, name: str) -> list[str]:
    """A note where a traction does not add up to its load, with what it looks like."""
    if load == 0 or abs(found / load - 1) <= _OFF:
        return []
    ratio = found / load
    looks = {-1.0: ": turned round?", 0.5: ": of half a cycle?", 2.0: ": twice too much?", 1e-6: ": in MPa?"}
    guess = next((text for value, text in looks.items() if abs(ratio / value - 1) < 0.1), "")
    return [f"{column} adds up to {ratio:.3g} of the scene's {name}{guess}"]


def _rounded(number: float) -> float:
    return float(f"{number:.3g}")
