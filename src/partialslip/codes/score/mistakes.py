"""Likely mistakes in a file of tractions: units, signs, half a cycle, loads, friction, origin of x."""

from typing import NamedTuple

import numpy as np

from partialslip.result import Result
from partialslip.run.judge.measures import fields, integrals
from partialslip.scene import Scene
from partialslip.scene.units import UNITS, Dimension
from partialslip.tools.arrays import Array

# fixed: units of length that may have been meant
_LENGTHS = {"in m": 1.0, "in mm": 1e-3, "in um": 1e-6, "in cm": 1e-2, "in inches": 0.0254}
# fixed: units of stress that may have been meant
_STRESSES = {"in Pa": 1.0, "in MPa": 1e6, "in GPa": 1e9, "in kPa": 1e3, "in N/um^2": 1e12, "in psi": 6894.757}
_COLUMNS: tuple[Dimension, ...] = ("m", "Pa")
# fixed: signs that may have been meant
_TURNS = {"": 1.0, "of the opposite sign": -1.0, "of half a cycle": 2.0,
          "of half a cycle and of the opposite sign": -2.0, "twice too large": 0.5}  # fmt: skip
_LIKE = 0.15  # limit: relative difference up to which another unit explains a sum
_OFF = 0.01  # limit: least relative difference of a resultant from the load that is reported
_FRICTION = 3e-3  # limit: least relative difference of the coefficient of friction that is reported
_LITTLE = 1e-3  # limit: of a: least offset of the stick zone that counts
_SIGMAS = 3.0  # limit: uncertainties: smaller differences are not reported


class _Guess(NamedTuple):
    """``name`` of a likely mistake in a column, and the ``factor`` that corrects it."""

    name: str
    factor: float


def in_another_unit(scene: Scene, result: Result, reference: Result) -> bool:
    """Whether x in the file of ``result`` is in another unit than ``scene``."""
    return _guess(result.a / reference.a, _others(_LENGTHS, scene.units.size("m"))) is not None


def mistakes(scene: Scene, result: Result, reference: Result) -> tuple[str, ...]:
    """A note on each likely mistake in the file of ``result``, with the ``--factors`` that correct it if there are any.

    ``reference`` is the result of ``scene`` to compare with.
    """
    f_seen, f_known = (result.settings.get(key) for key in ("f_seen", "f_seen_to"))
    seen = float(f_seen) if isinstance(f_seen, float) and scene.friction.f > 0 else None
    (P, P_off), (dQ, dQ_off), *sums_1 = _sums(result)
    P1, P2 = (P for P, _ in scene.end_pressing)
    stresses = _others(_STRESSES, scene.units.size("Pa"))
    x = _guess(result.a / reference.a, _others(_LENGTHS, scene.units.size("m"))) or _Guess("", 1.0)
    P, dQ = P * x.factor, dQ * x.factor
    load = _sum_of_dq(scene, reference)
    cut = _cut(scene, result, reference)  # sums of a part tell no factor
    none = _Guess("", 1.0)
    p = none if cut else _guess(P / P2, stresses) or none
    share = 1.0 if seen is None else seen / scene.friction.f / p.factor  # of dq, in the dq that friction requires
    q = none if cut else _shear(dQ, share, seen is not None, load, scene, stresses)
    dQ, share = dQ * q.factor, abs(share * q.factor)
    columns = zip(("x", "p", "dq"), (x, p, q), strict=True)
    notes = []
    if found := [f"{column} may be {guess.name}" for column, guess in columns if guess.name]:
        factors = ",".join(f"{guess.factor:g}" for guess in (x, p, q))
        notes.append(f"{', '.join(found)}: correct with --factors {factors}{_or_shown_in(scene, x, p, q)}")
    pressed = [("p", P / P2, P_off, " at load point 2" if sums_1 else "")]
    pressed += [("p1", sum_1 * x.factor / P1, off, " at load point 1") for sum_1, off in sums_1]
    for column, share_of_P, off, where in pressed:
        if abs(share_of_P * p.factor - 1) > max(_OFF, _SIGMAS * off):
            notes.append(f"{column} adds up to {share_of_P * p.factor:.3g} of the scene's P{where}")
    slides = scene.friction.f * (P1 + P2)
    if one := at_one_load_point(scene, result):
        notes.append(one)
    elif abs(dQ - load) > max(_OFF, _SIGMAS * dQ_off) * max(abs(load), 0.1 * slides):
        notes.append(
            f"dq adds up to {dQ / load:.3g} of the scene's dQ"
            if load
            else f"dq adds up to {scene.units.labelled(dQ, 'N/m', 3)}, not 0"
        )
    unsure = float(f_known) / seen if seen and isinstance(f_known, float) else 0.0
    told = seen is not None and "p_1" not in result.undetermined  # else p1 + p is not known
    if told and not one and abs(share - 1) > max(_FRICTION, _SIGMAS * unsure):
        f = scene.friction.f
        notes.append(f"|dq|/(2 p) is {share * f:.4g} in the slip zones, but the scene's f is {f:g}: is f another?")
    return (*notes, *_pulls(scene, result, reference), *_places(scene, result, reference, x.factor, cut))


def at_one_load_point(scene: Scene, result: Result) -> str:
    """Return that the shear in the file of ``result`` is that at one load point, and not a change or half of it; empty
    if it is not. It adds up to Q there, and reaches f p, not 2 f p, in the slip zones."""
    f_seen, f = result.settings.get("f_seen"), scene.friction.f
    if not isinstance(f_seen, float) or not f or not scene.load.in_phase or scene.load.fully_reversed:
        return ""
    _, (dQ, off), *_ = _sums(result)
    slides = f * sum(P for P, _ in scene.end_pressing)
    near = max(_OFF, _SIGMAS * off)
    for name, times in (("q", 2.0), ("dq", 1.0)):
        if abs(f_seen / f / (times / 2) - 1) > _LIKE:
            continue
        for point, end in enumerate(scene.load.ends, start=1):
            Q = scene.load.points[end][0]
            if name == "q" and abs(times * Q - scene.load.dQ) <= near * abs(scene.load.dQ):  # half of the change
                continue
            if Q and abs(dQ - times * Q) <= near * max(abs(times * Q), 0.1 * slides):
                told = f"{name} adds up to Q at load point {point}, and its slip zones are at f p"
                return f"{told}: it is the shear at one load point: give both with --columns q1=...,q2=..."
    return ""


def _sum_of_dq(scene: Scene, reference: Result) -> float:
    """The sum of dq that is expected, N/m: dQ. That of the ``reference`` counts out of phase, where dq is the range of
    q at each point, and where the contact cannot bear dQ."""
    bears = scene.load.in_phase and reference.regime not in ("sliding", "ratchets")
    return scene.load.dQ if bears else 2 * integrals(reference.traction, ("q",))["q"]


def _pulls(scene: Scene, result: Result, reference: Result) -> list[str]:
    """A note where the pressure is negative, and that of the ``reference``, as the table would have it, is not."""
    traction, to = result.traction, reference.traction
    lowest, largest = int(traction.p.argmin()), float(traction.p.max())
    if traction.p[lowest] >= -_OFF * largest:
        return []
    (true,) = traction.observed.of(lambda x: fields(to, x, ("p",)), to.breaks) if traction.observed else (0 * to.p,)
    if true[lowest] < -_OFF * reference.p0:
        return []
    place = scene.units.labelled(float(traction.x[lowest]), "m", 4)
    return [f"p is {traction.p[lowest] / largest:.2g} of its largest at x = {place}: a contact does not pull: is it a "
            "stress extrapolated to the nodes?"]  # fmt: skip


def _shear(dQ: float, share: float, seen: bool, load: float, scene: Scene, stresses: dict[str, float]) -> _Guess:
    """Likely mistake in dq, from its resultant ``dQ``, where ``load`` is expected, and from ``share``, dq in the dq
    that friction requires."""
    turned = {f"{unit} {turn}".strip(): size * sign for unit, size in ({"": 1.0} | stresses).items()
              for turn, sign in _TURNS.items() if unit or turn}  # fmt: skip
    of = dQ / load if abs(load) > 0.1 * scene.friction.f * scene.P else np.copysign(share, 1.0)
    if load == 0 and not seen:
        return _Guess("", 1.0)
    fits = [
        _Guess(name, size)
        for name, size in turned.items()
        if abs(of * size - 1) < _LIKE and (not seen or abs(abs(share * size) - 1) < _LIKE)
    ]
    return fits[0] if fits and abs(of - 1) > _LIKE else _Guess("", 1.0)


def _places(scene: Scene, result: Result, reference: Result, factor: float, cut: str) -> list[str]:
    """Notes on the position of the contact and of the stick zone; ``factor`` corrects x, ``cut`` says that the table
    has a part of the contact only."""
    notes = []
    middle, expected = (sum(each.ends[1]) / 2 for each in (result, reference))
    off = middle / result.a - expected / reference.a
    known = max(result.estimate.get(key, 0.0) for key in ("a", "left", "right"))
    if cut:
        notes.append(cut)
    elif abs(off) > max(2 * known, 1e-9):
        place = f"the contact's middle is at x = {middle / result.a:.2g} a"
        advice = " (--centre auto puts x = 0 there)" if scene.even else f", not at {expected / reference.a:.2g} a"
        notes.append(place + advice)
    centre, true = result.stick_centre, reference.stick_centre
    if centre is None or true is None or not scene.load.dsigma or not scene.load.dQ:
        return notes
    centre, true = (centre - middle) * factor / reference.a, (true - expected) / reference.a
    little = max(_SIGMAS * max(result.estimate["m"], result.estimate["n"]), _LITTLE)
    if abs(true) > 10 * little and abs(centre) <= little:
        notes.append("the stick zone is in the middle of the contact: was the tension left out?")
    elif abs(true) > 10 * little and abs(centre + true) <= 0.2 * abs(true):
        notes.append("the stick zone is on the other side: is the sign of x, or of the tension, reversed?")
    return notes


def _cut(scene: Scene, result: Result, reference: Result) -> str:
    """Return that the table shows a part of the contact only; empty if it shows all of it. It ends within the contact
    of the ``reference``, and two points before an end tell that it is farther than a spacing: p rises like a root."""
    traction = result.traction
    left, right = reference.traction.breaks.min(), reference.traction.breaks.max()
    sides = (("begins", traction.x, traction.p, left, 1), ("ends", traction.x[::-1], traction.p[::-1], right, -1))
    for word, x, p, end, way in sides:
        if way * (2 * x[0] - x[1] - end) > 0 and p[0] > max(p[1], 0.0) / np.sqrt(2):
            place = scene.units.labelled(float(x[0]), "m", 4)
            advice = "give all of it, as shear differs from side to side"
            return f"the table {word} at x = {place}, within the contact: {advice}"
    return ""


def _others(units: dict[str, float], own: float) -> dict[str, float]:
    """Sizes of ``units`` in the scene's ``own`` unit, of all others than that."""
    return {name: float(f"{size / own:.7g}") for name, size in units.items() if size != own}


def _or_shown_in(scene: Scene, x: _Guess, p: _Guess, q: _Guess) -> str:
    """Advice to show the scene in the units of the table, if these are units of scenes."""
    own, found = scene.units, (x.factor, p.factor, q.factor)
    for name, other in UNITS.items():
        length, stress = (float(f"{other.size(of) / own.size(of):.7g}") for of in _COLUMNS)
        if other != own and found == (length, stress, stress):
            return f" or --set shown_in={name}"
    return ""


def _guess(ratio: float, units: dict[str, float]) -> _Guess | None:
    """The unit that explains ``ratio``: a number as read over the number that it should be; None if no unit does."""
    return next((_Guess(name, size) for name, size in units.items() if abs(ratio * size - 1) < _LIKE), None)


def _sums(result: Result) -> list[tuple[float, float]]:
    """Resultants of p and dq, and of p1 if the pressure varies, N/m, each with its error.

    The error is the change on every second point, relative to the resultant of p.
    """
    traction, breaks = result.traction, result.traction.breaks

    def values(x: Array) -> Array:
        found = traction.at(x)
        return np.stack([found.p, found.dq, *(() if found.p1 is None else (found.p1,))])

    centres, widths = (breaks[1:] + breaks[:-1]) / 2, np.diff(breaks)
    fine = values(centres) @ widths
    coarse = np.trapezoid(values(breaks)[:, ::2], breaks[::2], axis=1)
    means = result.settings["read"] == "means over cells"
    off = 0.0 * fine if means else np.abs(fine - coarse) / max(abs(float(fine[0])), 1e-300)
    return list(zip(fine.tolist(), off.tolist(), strict=True))
