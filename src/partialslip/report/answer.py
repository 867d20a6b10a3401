"""The answer of a run: what was asked for, in the scene's units, with the digits that are known."""

import math
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from partialslip.result import RATCHETS, Result, Slip
from partialslip.result.peak import peak_error, pressure_peaks
from partialslip.run import Run
from partialslip.run.judge.reference import error_of, reference
from partialslip.scene import Tabulated
from partialslip.scene.units import LENGTHS, PREFIXES, SI, Dimension, Units

_DIGITS = 7  # display: significant

_Value = Callable[[Result], float | None]
_LENGTHS = {"a": "a, half-width", "m": "m, stick from -m", "n": "n, stick to n"}
_OTHERS: Mapping[str, tuple[Dimension, _Value]] = {
    "p_max, largest p": ("Pa", lambda found: found.traction.p_max),
    "q = (q2 - q1)/2, largest": ("Pa", lambda found: float(np.abs(found.traction.dq).max()) / 2),
    "slip, largest each way": ("m", lambda found: float(np.abs(found.slip.slip).max()) if found.slip else None),
}


def amounts(results: Mapping[str, Result], units: Units = SI) -> tuple[list[str], list[list[str]]]:
    """Return headings and rows of quantity, unit and the value of each method.

    All methods share a row's unit, that of ``units``; in SI with a prefix. a, m and n share one unit, in SI mm from
    1e-6 m to 1 m.
    """
    found = list(results.values())
    largest = max(result.a for result in found)
    lengths = (-3, "mm") if 1e-6 <= largest < 1 else scale(largest, "m", units)
    rows = [
        [text, lengths[1], *(_length(result, key, lengths[0]) for result in found)] for key, text in _LENGTHS.items()
    ]
    for quantity, (of, value) in _OTHERS.items():
        values = [value(result) for result in found]
        largest = max((abs(each) for each in values if each is not None and math.isfinite(each)), default=0.0)
        if largest:
            rows.append(_quantity_row(quantity, scale(largest, of, units), values))
    if worn := [result.slip.dissipated for result in found if result.slip and result.slip.dissipated]:
        exponent, label = scale(max(worn), "J/m", units)
        works = [dissipated(result.slip, exponent) if result.slip else "none" for result in found]
        rows.append(["dissipated in a cycle", label, *works])
    return ["quantity", "unit", *results], rows


def scale(size: float, of: Dimension, units: Units) -> tuple[int, str]:
    """Return the exponent of ten, and the label of the unit, for values up to ``size`` (SI) of dimension ``of``; in SI
    with a prefix."""
    label, power = units.units[of]
    if units != SI:
        return power, label
    return next(((exp, prefix + label) for exp, prefix in PREFIXES if 1 <= size / 10.0**exp < 1000), (0, label))


def _quantity_row(quantity: str, unit: tuple[int, str], values: list[float | None]) -> list[str]:
    return [quantity, unit[1], *(_digits(value, unit[0]) for value in values)]


def _digits(value: float | None, exponent: int) -> str:
    return "none" if value is None else f"{value / 10.0**exponent:.{_DIGITS}g}"


def _length(result: Result, key: str, exponent: int) -> str:
    """Return a, m or n (``key``) of ``result``, few digits without an estimate of its error."""
    value = getattr(result, key) if result.steady or key == "a" else None
    if value is None or math.isfinite(error := _error_of(result, key)):
        return _digits(value, exponent)
    return with_error(value, error, exponent) + NOT_ESTIMATED


_ROUNDING = 1e-9  # display: of a
NOT_ESTIMATED = ", no error estimate"  # display: beside values whose error is not estimated
_ROUGH = 4  # display: significant, of values whose error is not estimated
HALF_PLANES = ("exact", "march")  # methods that know no finite bodies


class Known(NamedTuple):
    """The ``result`` that a value is taken from, and the name of its ``method`` if it is not the one of the answer."""

    result: Result
    method: str


def whose(run: Run, name: str) -> str:
    """Return whose values those of method ``name`` of ``run`` are: half-planes are named where bodies are finite."""
    return f"half-planes ({name})" if run.scene.sized and name in HALF_PLANES else name


def answer_heading(run: Run) -> str:
    """Return the method that answers, the regime, and why the answer is not known to hold, in one line."""
    name, unknown = run.answering, reference(run.scene).unknown
    return f"{whose(run, name)}: {run.results[name].regime}" + (f"; {unknown['m']}" if unknown else "")


def answers(run: Run) -> list[tuple[str, str]]:
    """Return pairs of quantity and value of ``run``.

    Quantities are the stick zone, a, p0 = 2 P/(pi a), the largest pressure p_max, at both load points the largest shear
    and the largest sigma_xx along the surface of the lower body, the forces, displacements and stiffnesses of the
    plates of two finite bodies, and what a grip on the right side bears. A contact that ratchets has no stick zone.

    A value has the digits that the method's own estimate of its error leaves, and the error: ``0.888 +- 0.003``. One
    without an estimate has few digits, and is marked: ``0.8881, no error estimate``. Values
    that the answering method does not know come from the first that knows them, which is named. What the noise and
    the spacing of a given profile make has lines of its own.
    """
    result = run.results[run.answering]
    own = [*_stick(run, result), *_profile_rows(run), *_noise(run), *_spacing(run), *_contact_rows(run, result)]
    return [*own, *_shears(run), *_stresses(run), *_plates(run), *_right_grip(run)]


def _stick(run: Run, result: Result) -> Iterator[tuple[str, str]]:
    if not result.steady:
        yield "stick zone", f"none: {RATCHETS}"
        return
    if result.m is None or result.n is None:
        yield "stick zone", "none" + (f": {result.undetermined['m']}" if "m" in result.undetermined else "")
        return
    errors = [_error_of(result, key) * result.a for key in "mn"]
    exponent, label = _unit(run, result.a, "m")
    ends = [with_error(end, error, exponent) for end, error in zip((-result.m, result.n), errors, strict=True)]
    yield "stick zone", f"[{ends[0]}, {ends[1]}] {label}{_mark(*errors)}"
    shares = [
        with_error(end / result.a, error / result.a) for end, error in zip((result.m, result.n), errors, strict=True)
    ]
    yield "m, n", f"{shares[0]} a, {shares[1]} a{_mark(*errors)}"
    if result.permanent is None:
        return
    apart = max(abs(result.permanent[0] + result.m), abs(result.permanent[1] - result.n))
    if apart <= _ROUNDING * result.a:
        return
    if math.isnan(result.permanent[0]):
        yield "never slips", "no point: the stick zone moves across the contact"
    else:
        ends = [with_error(end, error, exponent) for end, error in zip(result.permanent, errors, strict=True)]
        yield "never slips", f"[{ends[0]}, {ends[1]}] {label}"


def _profile_rows(run: Run) -> Iterator[tuple[str, str]]:
    """Yield the number of points of a measured profile, and the units in which they were read."""
    if not isinstance(run.scene.profile, Tabulated) or (known := run.scene.profile.measured) is None:
        return
    names = {factor: name for name, factor in reversed(LENGTHS.items())}
    x, gap = (names.get(float(f"{abs(unit):.12g}"), f"{abs(unit):g} m") for unit in known.unit)
    told = f"{known.points} of {Path(known.file).name}, x in {x}, {'gap' if known.unit[1] > 0 else 'heights'} in {gap}"
    if known.columns != (1, 2):
        told += f", columns {known.columns[0]} and {known.columns[1]}"
    if known.centre:
        told += f", x = 0 at {run.scene.units.labelled(known.centre, 'm', 4)}"
    yield "points of the profile", told


def _noise(run: Run) -> Iterator[tuple[str, str]]:
    """Yield the scatter due to the noise of a measured profile, and the smoothing length that scatters less."""
    if (noise := run.noise) is None:
        return
    yield "noise of the profile", _scatter({"a": noise.a, "m": noise.m, "n": noise.n}) + f", from {noise.copies} copies"
    if noise.smooth and noise.a_then is not None:
        exponent, label = _unit(run, noise.smooth, "m")
        then = _scatter({"a": noise.a_then, "m": noise.m_then, "n": noise.n_then})
        yield "with a longer smooth", f"{noise.smooth / 10.0**exponent:.3g} {label}: {then}; the points allow it"


def _spacing(run: Run) -> Iterator[tuple[str, str]]:
    """Yield the errors of the ends due to the spacing of a table."""
    if known := [f"{key} {run.spacing[key]:.1e} a" for key in "amn" if run.spacing.get(key, 0.0) > _ROUNDING]:
        yield "spacing of the table", "off by about " + ", ".join(known)


def _scatter(deviations: Mapping[str, float | None]) -> str:
    known = {key: each for key, each in deviations.items() if each is not None}
    return ", ".join(f"{key} +- {each:.1e} a" for key, each in known.items()) + " (standard deviation)"


def _contact_rows(run: Run, result: Result) -> Iterator[tuple[str, str]]:
    error = _error_of(result, "a")
    exponent, label = _unit(run, result.a, "m")
    yield "a", f"{with_error(result.a, error * result.a, exponent)} {label}{_mark(error)}"
    if not run.scene.even or run.scene.presses_anew:
        for point, ends in enumerate(result.ends, start=1):
            left, right = (with_error(end, error * result.a, exponent) for end in ends)
            yield f"contact, load point {point}", f"[{left}, {right}] {label}{_mark(error)}"
    exponent, label = _unit(run, result.p0, "Pa")
    yield "p0", f"{with_error(result.p0, error * result.p0, exponent)} {label}{_mark(error)}"
    peaks = pressure_peaks(result, _error_of(result, "p"))
    for point, (peak, error) in enumerate(peaks, start=1):
        where = f", load point {point}" if len(peaks) > 1 else ""
        yield f"p_max{where}", f"{with_error(peak, error, exponent)} {label}{_mark(error)}"


def _shears(run: Run) -> Iterator[tuple[str, str]]:
    """Yield the largest shear at both load points; out of phase, where it may be largest elsewhere, in the cycle."""
    if run.scene.friction.f == 0:
        return
    known = first_knowing(run, lambda result: result.traction.q1 is not None and result.traction.q2 is not None)
    if known and not run.scene.load.in_phase:
        traction = known.result.traction
        largest = max(float(np.abs(q).max()) for q in (traction.q1, traction.q2) if q is not None)
        yield "largest |q|", _stress(run, largest, known, "q") + _by(known)
        return
    for key in ("q1", "q2"):
        if not known:
            yield f"largest |{key}|", f"not known: {_why(run, key)}"
            continue
        q = getattr(known.result.traction, key)
        yield f"largest |{key}|", _stress(run, float(np.abs(q).max()), known, key) + _by(known)


def _stresses(run: Run) -> Iterator[tuple[str, str]]:
    """Yield the largest sigma_xx along the surface of the lower body, and its place, at both load points."""
    known = first_knowing(run, lambda result: result.surface is not None)
    if not known or not known.result.surface:
        return
    surface, off = known.result.surface, peak_error(known.result)
    exponent, label = _unit(run, known.result.a, "m")
    for point, sigma in enumerate(surface.sigma[0]):
        index, last = int(sigma.argmax()), len(sigma) - 1
        place = float(surface.x[index])
        beside = np.abs(surface.x[[max(index - 1, 0), min(index + 1, last)]] - place).max()
        error = _error_of(known.result, "a") * known.result.a if _at_an_end(place, known.result) else float(beside)
        far = index in (0, last)
        where = "away from the contact" if far else f"at x = {with_error(place, error, exponent)} {label}"
        power, unit = _unit(run, float(sigma.max()), "Pa")
        off = math.nan if off is None else off
        value = with_error(float(sigma.max()), off, power)
        yield f"largest sigma_xx, {point + 1}", f"{value} {unit} {where}{_mark(off)}{_by(known)}"


def _plates(run: Run) -> Iterator[tuple[str, str]]:
    """Yield what moves the plates of two finite bodies along x, by how much, and what they resist per unit depth."""
    known = first_knowing(run, lambda result: result.plates is not None)
    if not known or not (plates := known.result.plates):
        return
    error, off = (math.nan if each is None else each for each in (plates.error, plates.displacement_error))
    load, by = run.scene.load, _by(known)
    if load.displacement is not None:
        exponent, label = _unit(run, float(np.abs(plates.at_points).max()), "N/m")
        forces = [with_error(Q, off * plates.stiffness[0], exponent) for Q in plates.at_points]
        yield "Q", f"{', '.join(forces)} {label}{_mark(off)}{by}"
    exponent, label = _unit(run, float(np.abs(plates.displacement).max()), "m")
    if np.isfinite(plates.displacement).all():
        off = 0.0 if load.displacement is not None and load.spring is None else off
        moved = [with_error(each, off, exponent) for each in plates.displacement]
        yield "plates along x", f"{', '.join(moved)} {label} at load points 1, 2{_mark(off)}{by}"
    if plates.turn is not None:
        turned = [with_error(each, math.nan) for each in plates.turn]
        yield "plate turns by", f"{', '.join(turned)} rad at load points 1, 2{NOT_ESTIMATED}{by}"
    exponent, label = _unit(run, max(plates.stiffness), "Pa")
    along = [with_error(each, error * each, exponent) for each in plates.stiffness]
    yield "stiffness, x and y", f"{', '.join(along)} {label} per unit depth, while all sticks{_mark(error)}{by}"


def _right_grip(run: Run) -> Iterator[tuple[str, str]]:
    """Yield the force on the plate that holds the right side of the lower body, and its share of Q."""
    known = first_knowing(run, lambda result: result.right_grip is not None)
    if not known or (forces := known.result.right_grip) is None:
        return
    exponent, label = _unit(run, float(np.abs(forces).max()), "N/m")
    borne = ", ".join(with_error(force, math.nan, exponent) for force in forces)
    load = known.result.plates.told(run.scene).load if known.result.plates else run.scene.load
    share = f", {np.diff(forces)[0] / load.dQ:.1%} of the change of Q" if load.dQ and not run.scene.presses_anew else ""
    yield "right grip", f"{borne} {label} besides sigma at load points 1, 2{share}{NOT_ESTIMATED}{_by(known)}"


def first_knowing(run: Run, knows: Callable[[Result], bool]) -> Known | None:
    """Return the first result that ``knows`` a value and claims to hold, the answering one before all others; None if
    none does. Half-planes do not hold for finite bodies."""
    best, finite = run.answering, run.scene.sized
    others = [
        name for name, result in run.results.items() if not (result.path_dependent or (finite and name in HALF_PLANES))
    ]
    for name in dict.fromkeys([best, *others]):
        if knows(run.results[name]):
            return Known(run.results[name], "" if name == best else name)
    return None


def _at_an_end(x: float, result: Result) -> bool:
    """Return whether ``x``, m, is an end of the contact at a load point."""
    return bool(np.isclose(x, np.ravel(result.ends), rtol=0.0, atol=_ROUNDING * result.a).any())


def _by(known: Known) -> str:
    return f" ({known.method})" if known.method else ""


def _why(run: Run, key: str) -> str:
    """Return why no method knows ``key``."""
    reasons = (result.undetermined[key] for result in run.results.values() if key in result.undetermined)
    return next(reasons, "no method of this run finds it")


def _stress(run: Run, value: float, known: Known, key: str) -> str:
    """Return a stress as text.

    Beside an end of the stick zone q has a kink like a square root. An error that is spread over a length h is as high
    as the square root of h there, and adds h to the norm: the largest value is known to the root of the norm's error.
    """
    exponent, label = _unit(run, value, "Pa")
    error = math.sqrt(_error_of(known.result, key)) * abs(value)
    return f"{with_error(value, error, exponent)} {label}{_mark(error)}"


def _error_of(result: Result, key: str) -> float:
    return error_of(result, key, result.method)


def _mark(*errors: float) -> str:
    """Return that there is no estimate, if one of the ``errors`` is NaN."""
    return "" if all(map(math.isfinite, errors)) else NOT_ESTIMATED


def dissipated(slip: Slip, exponent: int = 0, label: str = "") -> str:
    """Return the work of friction in a cycle in units of ten to the ``exponent``, with its error and the unit's
    ``label``, as text."""
    error = math.nan if slip.dissipated_error is None else slip.dissipated_error
    if error > slip.dissipated:
        return f"at most {(slip.dissipated + error) / 10.0**exponent:.1g} {label}".rstrip()
    return f"{with_error(slip.dissipated, error, exponent)} {label}".rstrip() + _mark(error)


def _unit(run: Run, size: float, of: Dimension) -> tuple[int, str]:
    """Return exponent of ten and label of the unit for values of about ``size``; lengths in mm from 1e-6 m to 1 m."""
    units = run.scene.units
    if of == "m" and 1e-6 <= size < 1 and units.label("m") in ("m", "mm"):
        return -3, "mm"
    return scale(abs(size), of, units)


def with_error(value: float, error: float, exponent: int = 0) -> str:
    """Return ``value`` in units of ten to the ``exponent``, with the decimals that the ``error`` leaves, and the error
    rounded up to one digit; with few digits if the error is NaN."""
    value, error = value / 10.0**exponent, error / 10.0**exponent
    if not math.isfinite(error):
        return f"{value:.{_ROUGH}g}"
    if error < abs(value) * 10.0**-_DIGITS or not error:
        return f"{value:.{_DIGITS}g}"
    place = math.floor(math.log10(error))
    up = math.ceil(error / 10.0**place - 1e-9)
    if up == 10:
        up, place = 1, place + 1
    decimals = max(-place, 0)
    return f"{round(value, -place):.{decimals}f} +- {up * 10.0**place:.{decimals}f}"
