"""Turn tractions from a file into a result like that of a method."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from partialslip.codes.score.ends import (
    NOISE_FACTOR,
    ZERO_LEVEL,
    ZoneEnd,
    least_pressure,
    noise_level,
    read_left_end,
    read_right_end,
    zone_around_peak,
)
from partialslip.codes.score.friction import FrictionRead, alike, frictions
from partialslip.codes.score.kinds import Average
from partialslip.codes.score.observed import observed
from partialslip.codes.score.samples import FEWEST_POINTS, Samples
from partialslip.result import Clock, Regime, Result, SteadyState, Traction, TractionAt
from partialslip.scene import Scene
from partialslip.scene.gradual import may_turn_round
from partialslip.scene.units import Units
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

_SLIDES = 0.02  # limit: of 2 f p0: where 2 f p - |dq| is less everywhere, the contact slides
_F_SIGMAS = 3.0  # accuracy: uncertainties of f: largest error of 2 f p
_X_SIGMAS = 2.0  # accuracy: standard deviations of x: largest error of an end due to rounded x
_CERTAIN = 0.05  # accuracy: of a: largest uncertainty of ends of the stick zone that are given ...
_SPACINGS = 3.0  # accuracy: ... or this many spacings of the points


class SeenContact(NamedTuple):
    """Contact at a load point: indices of its ``first`` and ``last`` point, and its ends."""

    first: int
    last: int
    left: ZoneEnd
    right: ZoneEnd

    @property
    def ends(self) -> tuple[float, float]:
        """Left and right end, m."""
        return self.left.x, self.right.x

    @property
    def middle(self) -> float:
        """Middle between the ends, m."""
        return (self.left.x + self.right.x) / 2


class SeenStickZone(NamedTuple):
    """Ends of the stick zone, ``left`` and ``right``, and friction in the slip zones on either side (``sides``)."""

    left: ZoneEnd
    right: ZoneEnd
    sides: tuple[FrictionRead, FrictionRead]


def scored(scene: Scene, samples: Samples, name: str, origin: str) -> Result:
    """Find contact, stick zone and regime of ``scene`` from the tractions in ``samples`` alone.

    The coefficient of friction is the one in the slip zones. Uncertain ends of the stick zone are left out. Where the
    pressure varies, a and p0 are those of the load point with the larger P.

    Parameters
    ----------
    name, origin : str
        Name of the result, and of the file for messages.

    Raises
    ------
    InputError
        If the pressure does not exceed its noise.
    """
    clock = Clock()
    x, p, dq, f = samples.x, samples.p_mean, samples.dq, scene.friction.f
    if _pressed(scene) and samples.q2 is not None:
        dq = 2 * samples.q2  # |q| <= f p, as |dq| <= 2 f p in a cycle
    contacts = _contacts(samples, origin)
    larger = contacts[scene.largest - 1]
    cells, a = samples.cells is not None, (larger.right.x - larger.left.x) / 2
    middle = larger.middle if scene.even else 0.0  # where else it should be takes the solution
    pressure = samples.p1 if samples.p1 is not None and scene.largest == 1 else samples.p
    p0 = 2 * float(pressure @ _widths(samples)) / (np.pi * a)
    first, last = min(contact.first for contact in contacts), max(contact.last for contact in contacts)
    inside = slice(first, last + 1)
    slips = f > 0 and bool(np.abs(dq).max() > max(ZERO_LEVEL * p0, NOISE_FACTOR * noise_level(dq, x)))
    bound = p * scene.friction.at(x) / f if scene.friction.varies else p  # over the largest f
    stick = _stick_zone(x, bound, dq, inside, scene, p0, samples.averages) if slips else None
    # a point that is out of contact at a load point does not stick
    both = max(contact.left for contact in contacts), min(contact.right for contact in contacts)
    regime, ends = _regime(scene, stick, *both, slips)
    left, right = larger.left, larger.right
    either = float(np.linalg.norm((left.uncertainty, right.uncertainty, _X_SIGMAS * samples.resolution)))
    uncertainty = {
        "a": either / 2 / a,
        "left": max(contact.left.uncertainty for contact in contacts) / a,
        "right": max(contact.right.uncertainty for contact in contacts) / a,
    }
    if ends:
        shared = (_X_SIGMAS * samples.resolution, middle)
        uncertainty |= {
            key: float(np.linalg.norm((end.uncertainty, *shared))) / a for key, end in zip("mn", ends, strict=True)
        }
    spacing = float(np.median(np.diff(x[inside]))) / a
    uncertain = ends is not None and max(uncertainty["m"], uncertainty["n"]) > max(_CERTAIN, _SPACINGS * spacing)
    known = None if uncertain else ends
    why = _why(stick, uncertainty) if uncertain else ""
    if slips and stick is None and not _tells_sliding(bound[inside], dq[inside], f):
        why = "no slip zone is found from which f could be read, and so no stick zone"
    notes = samples.notes
    if why:
        notes += (f"m and n are not given: {why}",)
    if regime == "sliding" and not scene.slides and not why:
        notes += ("no stick zone found: |dq|/(2 p) is the same everywhere, within the uncertainty of the points",)
    centre, half_width = ((known[0].x + known[1].x) / 2, (known[1].x - known[0].x) / 2) if known else (None, None)
    traction = _traction(samples, [end for contact in contacts for end in contact.ends], scene.load.in_phase)
    return replace(
        Result.of(name, SteadyState(regime, centre, half_width, notes), a, p0, traction, clock),
        settings={
            "read": "means over cells" if cells else "values at points",
            "spacing_over_a": _rounded(spacing),
            "noise_over_p0": _rounded(_noise(p[inside], x[inside]) / p0),
            **(_friction(stick.sides, f) if stick else {}),
            **({"columns": samples.made_of} if samples.made_of else {}),
        },
        counts={"points": len(x), "contact_nodes": last - first + 1},
        estimate=uncertainty,
        contact_ends=(contacts[0].ends, contacts[1].ends),
        undetermined={**(dict.fromkeys("mn", why) if why else {}), **_first(scene, samples)},
    )


def centred(samples: Samples, origin: str, units: Units) -> Samples:
    """Move ``samples`` so that x = 0 is in the middle of the contact at load point 2, with a note in ``units``.

    Raises InputError like :func:`scored`.
    """
    middle = _contacts(samples, origin)[1].middle
    note = f"x = 0 was put in the middle of the contact, at x = {units.labelled(middle, 'm')}"
    return replace(samples.moved(-middle), notes=(*samples.notes, note))


def _contacts(samples: Samples, origin: str) -> tuple[SeenContact, SeenContact]:
    """Contacts at load points 1 and 2."""
    second = _contact(samples, samples.p, "p", origin)
    return second if samples.p1 is None else _contact(samples, samples.p1, "p1", origin), second


def _contact(samples: Samples, p: Array, name: str, origin: str) -> SeenContact:
    """Contact under the pressure ``p`` at the points of ``samples``, (n,); ``name`` is the column's for messages."""
    x, averages = samples.x, samples.averages
    least = least_pressure(x, p)
    touching = zone_around_peak(p, least)
    if touching is None or touching[1] - touching[0] + 1 < FEWEST_POINTS:
        hint = "; or are the elements of another order (--order)?" if samples.cells is not None else ""
        raise InputError(
            f"{origin}: {name}: must exceed its noise at {FEWEST_POINTS} or more neighbouring points{hint}"
        )
    first, last = touching
    left = read_left_end(x, p, first, last, averages, least=least)
    right = read_right_end(x, p, last, first, averages, least=least)
    if not right.x > left.x:
        wrong = "must have a contact of positive width; the ends found are in the wrong order"
        raise InputError(f"{origin}: {name}: {wrong}")
    return SeenContact(first, last, left, right)


def _first(scene: Scene, samples: Samples) -> dict[str, str]:
    """Why nothing is told of load point 1 where shear changes the pressure, and the table has no p1."""
    if samples.p1 is not None or scene.mirrored:
        return {}
    why = "the table has no p1, the pressure at load point 1, which shear changes"
    return dict.fromkeys(("P_1", "p_1", "left_1", "right_1"), why)


def _why(stick: SeenStickZone | None, uncertainty: dict[str, float]) -> str:
    """Reason why ends of the stick zone are left out."""
    known = f"they are known to {uncertainty['m']:.1g} and {uncertainty['n']:.1g} a only"
    unseen = stick is not None and not any(side.seen for side in stick.sides)
    return f"|dq|/(2 p) is constant nowhere, so that no slip zone is found; {known}" if unseen else known


def _tells_sliding(p: Array, dq: Array, asked: float) -> bool:
    """Whether \\|dq\\|/(2 p) is known well enough to tell a contact that slides from one that does not."""
    return max(side.uncertainty for side in frictions(p, dq, asked)) * _F_SIGMAS <= _SLIDES * asked


def _friction(sides: tuple[FrictionRead, FrictionRead], asked: float) -> dict[str, str | float]:
    """Settings: coefficient of friction in the slip zones, its uncertainty, and the scene's."""
    seen = [side for side in sides if side.seen]
    if not seen:
        return {"f_seen": "nowhere", "f_asked": asked}
    surest = min(seen, key=lambda side: side.uncertainty)
    return {"f_seen": float(f"{surest.f:.6g}"), "f_seen_to": float(f"{surest.uncertainty:.1g}"), "f_asked": asked}


def _widths(samples: Samples) -> Array:
    """Length of the contact line that each point stands for, (n,), m."""
    ends = samples.cells
    if ends is None:
        x = samples.x
        ends = np.concatenate([x[:1], (x[1:] + x[:-1]) / 2, x[-1:]])
    return np.diff(ends)


def _stick_zone(
    x: Array, p: Array, dq: Array, inside: slice, scene: Scene, p0: float, averages: tuple[Average, ...]
) -> SeenStickZone | None:
    """Stick zone from 2 f p - |dq| at the points in contact (``inside``); None if nothing sticks. ``p`` is the mean
    pressure, and where f varies the friction bound over the largest f.

    The room 2 f p - |dq| grows from the ends of the stick zone like a square root, where they drifted with the power
    3/2. Where bodies were only pressed it is the sum over all stages of pressing, and grows with the power 3/2: its
    cube root like a square root.
    """
    asked, pressed = scene.friction.f, _pressed(scene)
    p, dq, count = alike(p, dq, inside)
    x, averages = x[inside], tuple(dict.fromkeys(Average(each.kind, max(each.points, count)) for each in averages))
    sides = frictions(p, dq, asked)
    slacks = [2 * side.uncertainty * p for side in sides]
    room = 2 * min(side.f for side in sides) * p - np.abs(dq)
    hidden = [NOISE_FACTOR * (side.scatter if side.seen else noise_level(room, x)) for side in sides]
    found = [zone_around_peak(room, least + _F_SIGMAS * slack) for least, slack in zip(hidden, slacks, strict=True)]
    if None in found or room.max() < 2 * max(side.f for side in sides) * p0 * min(_SLIDES, 4 / len(x)):
        return None
    first, last = found[0][0], found[1][1]  # type: ignore[index]
    beyond = dq[: first + 1].sum(), dq[last:].sum()
    sides = tuple(  # type: ignore[assignment]
        side if side.seen else side._replace(sign=1 if shear >= 0 else -1)
        for side, shear in zip(sides, beyond, strict=True)
    )
    if scene.friction.varies and averages[0].kind != "sampled":  # f(x) p is then no more than about f p averaged
        uneven = np.abs(np.gradient(scene.friction.at(x), x) * np.gradient(p, x)) * np.gradient(x) ** 2
        slacks = [slack + uneven for slack in slacks]
    rooms = [2 * side.f * p - side.sign * dq for side in sides]
    told = [least if side.seen else 0.0 for least, side in zip(hidden, sides, strict=True)]
    if pressed:
        scale = 2 * asked * p0
        rooms = [scale * np.cbrt(room / scale) for room in rooms]
        told = [scale * float(np.cbrt(least / scale)) for least in told]
        slacks = [np.zeros_like(slack) for slack in slacks]  # f is the scene's
    drifts, slacks = not pressed and may_turn_round(scene), [_F_SIGMAS * slack for slack in slacks]
    left = read_left_end(x, rooms[0], first, last, averages, slack=slacks[0], least=told[0], drifts=drifts)
    right = read_right_end(x, rooms[1], last, first, averages, slack=slacks[1], least=told[1], drifts=drifts)
    return SeenStickZone(left, right if right.x > left.x else ZoneEnd(left.x, right.uncertainty), sides)


def _pressed(scene: Scene) -> bool:
    """Whether bodies that are not mirror images were pressed only: the shear traction is that of pressing."""
    return scene.only_pressed and not scene.mirrored


def _regime(
    scene: Scene, stick: SeenStickZone | None, left: ZoneEnd, right: ZoneEnd, slips: bool
) -> tuple[Regime, tuple[ZoneEnd, ZoneEnd] | None]:
    """Regime, and the ends of the stick zone limited to the points in contact at both load points."""
    if scene.free:
        return "frictionless", None
    if not slips:
        return "stuck", (left, right)
    if stick is None:
        return "sliding", None
    if _pressed(scene):
        return "pressing", (stick.left, stick.right)
    ends = _limited(stick.left, left, -1), _limited(stick.right, right, 1)
    if not scene.load.in_phase:
        return "out of phase", ends
    return ("small tension" if stick.sides[0].sign == stick.sides[1].sign else "large tension"), ends


def _limited(end: ZoneEnd, contact: ZoneEnd, way: int) -> ZoneEnd:
    """The ``end`` of the stick zone on the left (``way`` -1) or right (1), or the end of the ``contact`` where the end
    read lies beyond it; it is then as unsure as both."""
    if way * (end.x - contact.x) <= 0:
        return end
    return contact._replace(uncertainty=float(np.hypot(contact.uncertainty, end.uncertainty)))


@dataclass(frozen=True)
class Sampled:
    """Tractions of a table: linear between the points ``x`` (n,), m, or constant on the cells with the ends ``x``
    (n + 1,), and zero outside; ``values`` are (n,) each."""

    x: Array
    values: TractionAt

    def at(self, x: Array) -> TractionAt:
        """Tractions at ``x`` (m), Pa."""
        p, dq, *others = self.values
        return TractionAt(
            self._at(x, p), self._at(x, dq), *[None if each is None else self._at(x, each) for each in others]
        )

    def _at(self, x: Array, values: Array) -> Array:
        if len(values) == len(self.x):
            return np.interp(x, self.x, values, left=0.0, right=0.0)
        cell = np.clip(np.searchsorted(self.x, x) - 1, 0, len(values) - 1)
        return np.where((x >= self.x[0]) & (x <= self.x[-1]), values[cell], 0.0)


def _traction(samples: Samples, ends: list[float], in_phase: bool) -> Traction:
    """Tractions as functions of x: constant on cells, or linear between points and zero at the outermost ``ends`` (m)
    of the contacts. Out of phase (not ``in_phase``) the largest shear may be at any load point: not at 1 or 2."""
    x, cells = samples.x, samples.cells
    levels = (samples.q1, samples.q2) if in_phase else (None, None)
    values = TractionAt(samples.p, samples.dq, *levels, samples.p1)
    if cells is not None:
        return Traction(x, values, Sampled(cells, values).at, cells, cells, observed(samples))
    breaks = np.union1d(x, [end for end in (min(ends), max(ends)) if not x[0] <= end <= x[-1]])
    at = Sampled(breaks, Sampled(x, values).at(breaks)).at
    return Traction(x, values, at, breaks, breaks, observed(samples))


def _noise(values: Array, x: Array) -> float:
    """Standard deviation of the noise in ``values`` at ``x``, (n,) each, n > 4: from the deviations of points from the
    cubic through the two points on either side, so that what is left of the spacing is small."""
    count = len(x) - 4
    at = np.stack([x[shift : shift + count] for shift in (0, 1, 3, 4)]) - x[2:-2]
    weights = np.stack([np.prod([at[k] / (at[k] - at[j]) for k in range(4) if k != j], axis=0) for j in range(4)])
    around = np.stack([values[shift : shift + count] for shift in (0, 1, 3, 4)])
    off = (values[2:-2] - (weights * around).sum(axis=0)) / np.sqrt(1 + (weights**2).sum(axis=0))
    return float(1.4826 * np.median(np.abs(off)))


def _rounded(number: float) -> float:
    return float(f"{number:.3g}")
