"""Error measures between two results of one scene. They are fixed, so that errors compare across versions and codes.

Both values of a measure have one scale, taken from the reference and the scene. The error is their difference. Norms
have an error but no values.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from partialslip.result import RATCHETS, Result, Traction
from partialslip.run.judge.means import Pair, integrals, means, paired
from partialslip.scene import Scene

NORM = "norm"
_SHEAR = ("m", "n", "dQ", "q", "q_max", "q1", "q2")  # quantities of friction in steady partial slip


_NEAR = 3.0  # accuracy: contact half-widths within which stresses inside are compared
_POINTS = 60  # accuracy: along each side of the square of points


@dataclass(frozen=True)
class Measure:
    """Difference between a result and the reference in one quantity.

    Parameters
    ----------
    quantity, scale : str
        Key of the quantity, and unit of values and error; :data:`NORM` if the error is relative to the reference's
        norm.
    reference, found : float or None
        Value of the reference and of the result; None for norms, and where there is no value.
    error : float or None
        NaN if one of the values is NaN; None if one of the values is None.
    undetermined : str
        Why the quantity is not judged; usually empty.
    unsteady : str
        Why an error is none of the method: one of both results alone is of too few cycles; usually empty.
    """

    quantity: str
    scale: str
    reference: float | None
    found: float | None
    error: float | None
    undetermined: str = ""
    unsteady: str = ""


def pressures_of(of: Traction, to: Traction) -> tuple[str, ...]:
    """Return the keys of the pressures of two tractions: at load points 1 and 2 if one of both varies."""
    return ("p",) if of.p1 is None and to.p1 is None else ("p_1", "p")


def levels_of(of: Traction, to: Traction) -> tuple[str, ...]:
    """Return the keys of the shear at the load points, if both tractions have it."""
    return ("q1", "q2") if of.values.levels and to.values.levels else ()


def pair_of(result: Result, reference: Result) -> Pair:
    """Return the tractions of ``result`` and ``reference``, like with like, in all quantities that both have."""
    of, to = result.traction, reference.traction
    return paired(of, to, (*pressures_of(of, to), "q", *levels_of(of, to)))


def measures(
    result: Result,
    reference: Result,
    scene: Scene,
    unknown: Mapping[str, str],
    *,
    stresses: bool = True,
    pair: Pair | None = None,
) -> Iterator[Measure]:
    """Yield the measures between ``result`` and ``reference`` for the ``scene``, those of ``stresses`` if wanted; with
    their tractions' ``pair`` if it is known already.

    A quantity that does not exist has no values and no error. An undetermined quantity has values and an error, but
    is not judged; nor is one that is ``unknown`` for the scene (by quantity, why).
    """
    known = pair or pair_of(result, reference)
    for quantity, scale, true, found, error in _measured(result, reference, known, scene, stresses):
        if absent := _absent(quantity, reference, scene):
            yield Measure(quantity, scale, None, None, None, absent)
        else:
            few = unsteady(result, reference) if quantity in _SHEAR and quantity != "dQ" else ""
            why = _undetermined(quantity, result, reference, unknown)
            yield Measure(quantity, scale, true, found, error, why, few)


def _absent(quantity: str, reference: Result, scene: Scene) -> str:
    """Return why the quantity does not exist; empty if it exists."""
    if quantity not in _SHEAR:
        return ""
    if scene.friction.f == 0 and quantity not in ("q", "q1", "q2"):  # q = 0
        return "there is no friction"
    if reference.regime == "sliding":  # q = f p, where it is known
        return "the contact slides" if quantity in ("m", "n", "dQ") else reference.undetermined.get("q", "")
    if reference.regime == "ratchets":
        return RATCHETS
    if quantity == "dQ" and not scene.load.in_phase:
        return "Q and sigma are out of phase: dq is the range of q at each point, and need not add up to dQ"
    return ""


def unsteady(result: Result, reference: Result) -> str:
    """Return which of both alone is not of the steady state, and why; empty if both are, or none is."""
    calls = [
        f"{each.method}: {each.undetermined['steady']}" for each in (result, reference) if "steady" in each.undetermined
    ]
    return calls[0] if len(calls) == 1 else ""


def _undetermined(quantity: str, result: Result, reference: Result, unknown: Mapping[str, str]) -> str:
    """Return why the quantity is ``unknown``, or which method leaves it undetermined and why; empty if it is known."""
    key = "q" if quantity == "q_max" else quantity
    if key in unknown:
        return unknown[key]
    calls = (f"{each.method}: {each.undetermined[key]}" for each in (reference, result) if key in each.undetermined)
    return next(calls, "")


_Values = tuple[str, str, float | None, float | None, float | None]


def _measured(result: Result, reference: Result, pair: Pair, scene: Scene, stresses: bool) -> Iterator[_Values]:
    """Yield (quantity, scale, reference value, value, error)."""
    a, p0, f = reference.a, reference.p0, scene.friction.f
    yield _apart("a", "a", 1.0, result.a / a)
    yield from _contact_ends(result, reference)
    yield from _stick_ends(result, reference)
    of, to = result.traction, reference.traction
    pressures, levels = pressures_of(of, to), levels_of(of, to)
    errors, sums = pair.errors(f), _integrals(of, to, pair, (*pressures, "q"))
    applied = dict(zip(("p_1", "p"), scene.end_pressing, strict=True))
    for key in pressures:
        yield _apart(key.replace("p", "P"), "P", applied[key].P / scene.P, sums[key] / scene.P)
        yield key, NORM, None, None, errors[key]
    known, found = ({}, {}) if scene.even else (integrals(to, pressures, 1), _integrals(of, to, pair, pressures, 1))
    for key, M in found.items():
        given = applied[key].M
        true = known[key] if given is None else given
        yield _apart(key.replace("p", "M"), "P a", *(each / (scene.P * a) for each in (true, M)))
    yield _apart("p_max", "p0", to.p_max / p0, of.p_max / p0)
    if of.observed and (pull := float(of.p.min())) < 0:  # a contact does not pull
        yield _apart("p_least", "p0", min(float(to.p.min()), 0.0) / p0, pull / p0)
    limit = f * scene.P
    yield _apart("dQ", "2 f P", *((half / limit if limit else math.nan) for half in (scene.load.dQ / 2, sums["q"])))
    yield "q", NORM, None, None, errors["q"]
    yield _apart("q_max", "f p0", *((_q_max(each) / (f * p0) if f else math.nan) for each in (to, of)))
    for key in levels:
        yield key, NORM, None, None, errors[key]
    if not stresses:
        return
    if result.surface and reference.surface:
        largest, true = result.surface.largest[1], reference.surface.largest[1]
        yield _apart("largest", "of exact", math.copysign(1.0, true), largest / abs(true))
    for key, error in (("surface", surface_error(result, reference)), ("inside", inside_error(result, reference))):
        if error is not None:
            yield key, NORM, None, None, error


def _integrals(of: Traction, to: Traction, pair: Pair, keys: tuple[str, ...], arm: int = 0) -> dict[str, float]:
    """Return integrals by key of x to the power ``arm`` times the traction, N/m or N. Those of a table are the
    reference's and the sums of the differences from it: what lies between points is in both."""
    if of.observed is None:
        return integrals(of, keys, arm)
    off = pair.off(arm)
    return {key: true + off[key] for key, true in integrals(to, keys, arm).items()}


def _apart(quantity: str, scale: str, reference: float, found: float) -> _Values:
    return quantity, scale, reference, found, abs(found - reference)


def _contact_ends(result: Result, reference: Result) -> Iterator[_Values]:
    """Yield both ends of the contact, in a; at load points 1 and 2 if the ends differ there in one of the results."""
    same = all(first == second for first, second in (result.ends, reference.ends))
    for point, (found, true) in enumerate(zip(result.ends, reference.ends, strict=True), start=1):
        for side, end, exact in zip(("left", "right"), found, true, strict=True):
            if not same or point == 2:
                yield _apart(side if same else f"{side}_{point}", "a", exact / reference.a, end / reference.a)


def _stick_ends(result: Result, reference: Result) -> Iterator[_Values]:
    """Yield m and n, in a. The errors are computed from centre and half-width, without cancellation in tiny zones."""
    a = reference.a
    error: dict[str, float | None] = {"m": None, "n": None}
    found, true = ((each.stick_centre, each.stick_half_width) for each in (result, reference))
    if None not in (*found, *true):
        centre, half_width = (off - exact for off, exact in zip(found, true, strict=True))  # type: ignore[operator]
        error = {"m": abs(half_width - centre) / a, "n": abs(half_width + centre) / a}
    for key, off in error.items():
        values = (None if end is None else end / a for end in (getattr(reference, key), getattr(result, key)))
        yield key, "a", *values, off  # type: ignore[misc]


def _q_max(traction: Traction) -> float:
    """Return the largest |q| = |dq|/2, Pa, at the points and breaks of the traction."""
    found = traction.at(np.union1d(traction.x, traction.breaks))
    return float(np.abs(found.dq).max()) / 2


def surface_error(result: Result, reference: Result) -> float | None:
    """Return the relative L2 error of sigma_xx along both surfaces, by averages over the cells of ``result``.

    None if ``result`` or ``reference`` has no surface stresses, or ``result`` no cells.
    """
    cells = result.traction.cells
    if not result.surface or not reference.surface or cells is None:
        return None
    breaks = np.union1d(result.traction.breaks, reference.traction.breaks)
    found, true = (means(each.at, cells, breaks) for each in (result.surface, reference.surface))
    widths = np.diff(cells)
    return float(np.sqrt(((found - true) ** 2 @ widths).sum() / (true**2 @ widths).sum()))


def inside_error(result: Result, reference: Result) -> float | None:
    """Return the relative L2 error, by area, of the stresses within 3 a of both bodies, at fixed points.

    None if ``result`` or ``reference`` has no stresses inside. Points outside a body do not count.
    """
    if not result.stress_at or not reference.stress_at:
        return None
    line = (np.arange(_POINTS) + 0.5) * (2 / _POINTS) - 1
    x, y = (_NEAR * reference.a * each.ravel() for each in np.meshgrid(line, line))
    found, true = (stresses(x, y) for stresses in (result.stress_at, reference.stress_at))
    both = np.isfinite(found).all(axis=(0, 1)) & np.isfinite(true).all(axis=(0, 1))
    off, norm = (np.linalg.norm(each[..., both]) for each in (found - true, true))
    return float(off / norm)
