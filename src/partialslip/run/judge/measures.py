"""What differs between two results of one scene: fixed measures, so that errors compare across versions and codes.

Both values of a measure have one scale, taken from the reference and the scene. The error is their difference. Norms
have an error but no values: relative L2 of cell averages, or of the values of a table.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from partialslip.result import RATCHETS, Result, Traction, TractionAt
from partialslip.scene import Scene
from partialslip.tools.arrays import Array
from partialslip.tools.bars import LEAST_SHEAR

NORM = "norm"
_SHEAR = ("m", "n", "dQ", "q", "q_max", "q1", "q2")  # quantities of friction in steady partial slip


_NEAR = 3.0  # fixed: contact half-widths within which stresses inside are compared
_POINTS = 60  # fixed: along each side of the square of points
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(24)


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


class Pair(NamedTuple):
    """Values of a traction and of its reference, like with like.

    Parameters
    ----------
    keys : tuple of str
        Quantities, as for :func:`fields`; the first is p.
    places, widths : (n,) arrays
        Of the cells, m.
    found, true : (keys, n) arrays
        Averages over cells that cover the reference's contact. Of a table its own values and those that it would have
        of the reference, and averages over the parts of the reference's contact for which no value stands.
    """

    keys: tuple[str, ...]
    places: Array
    widths: Array
    found: Array
    true: Array

    def errors(self, f: float) -> dict[str, float]:
        """Relative L2 errors by key (:func:`norm_errors`)."""
        off, norms = (np.sqrt(values**2 @ self.widths) for values in (self.found - self.true, self.true))
        return relative(off, norms, f, self.keys)

    def off(self, arm: int = 0) -> dict[str, float]:
        """Integrals of the differences by key, times x to the power ``arm``."""
        sums = (self.found - self.true) @ (self.widths * self.places**arm)
        return dict(zip(self.keys, sums.tolist(), strict=True))


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


def calls(key: str, *results: Result) -> list[str]:
    """Return which of the ``results`` call the quantity ``key`` undetermined, and why."""
    return [f"{each.method}: {each.undetermined[key]}" for each in results if key in each.undetermined]


def unsteady(result: Result, reference: Result) -> str:
    """Return which of both alone is not of the steady state, and why; empty if both are, or none is."""
    told = calls("steady", result, reference)
    return told[0] if len(told) == 1 else ""


def _undetermined(quantity: str, result: Result, reference: Result, unknown: Mapping[str, str]) -> str:
    """Return why the quantity is ``unknown``, or which method leaves it undetermined and why; empty if it is known."""
    key = "q" if quantity == "q_max" else quantity
    return unknown[key] if key in unknown else next(iter(calls(key, reference, result)), "")


_Values = tuple[str, str, float | None, float | None, float | None]


def _measured(result: Result, reference: Result, pair: Pair, scene: Scene, stresses: bool) -> Iterator[_Values]:
    """Yield (quantity, scale, reference value, value, error)."""
    a, p0, f = reference.a, reference.p0, scene.friction.f
    yield _difference("a", "a", 1.0, result.a / a)
    yield from _contact_ends(result, reference)
    yield from _stick_ends(result, reference)
    of, to = result.traction, reference.traction
    pressures, levels = pressures_of(of, to), levels_of(of, to)
    errors, sums = pair.errors(f), _integrals(of, to, pair, (*pressures, "q"))
    applied = dict(zip(("p_1", "p"), scene.end_pressing, strict=True))
    for key in pressures:
        yield _difference(key.replace("p", "P"), "P", applied[key].P / scene.P, sums[key] / scene.P)
        yield key, NORM, None, None, errors[key]
    known, found = ({}, {}) if scene.even else (integrals(to, pressures, 1), _integrals(of, to, pair, pressures, 1))
    for key, M in found.items():
        given = applied[key].M
        true = known[key] if given is None else given
        yield _difference(key.replace("p", "M"), "P a", *(each / (scene.P * a) for each in (true, M)))
    yield _difference("p_max", "p0", to.p_max / p0, of.p_max / p0)
    if of.observed and (pull := float(of.p.min())) < 0:  # a contact does not pull
        yield _difference("p_least", "p0", min(float(to.p.min()), 0.0) / p0, pull / p0)
    limit = f * scene.P
    yield _difference(
        "dQ", "2 f P", *((half / limit if limit else math.nan) for half in (scene.load.dQ / 2, sums["q"]))
    )
    yield "q", NORM, None, None, errors["q"]
    yield _difference("q_max", "f p0", *((_q_max(each) / (f * p0) if f else math.nan) for each in (to, of)))
    for key in levels:
        yield key, NORM, None, None, errors[key]
    if not stresses:
        return
    if result.surface and reference.surface:
        largest, true = result.surface.largest[1], reference.surface.largest[1]
        yield _difference("largest", "of exact", math.copysign(1.0, true), largest / abs(true))
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


def _difference(quantity: str, scale: str, reference: float, found: float) -> _Values:
    return quantity, scale, reference, found, abs(found - reference)


def _contact_ends(result: Result, reference: Result) -> Iterator[_Values]:
    """Yield both ends of the contact, in a; at load points 1 and 2 if the ends differ there in one of the results."""
    same = all(first == second for first, second in (result.ends, reference.ends))
    for point, (found, true) in enumerate(zip(result.ends, reference.ends, strict=True), start=1):
        for side, end, exact in zip(("left", "right"), found, true, strict=True):
            if not same or point == 2:
                yield _difference(side if same else f"{side}_{point}", "a", exact / reference.a, end / reference.a)


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


def nodal_errors(
    result: Result, reference: Result, pair: Pair, f: float
) -> tuple[float | None, float | None, float, float | None]:
    """Return relative L2 errors of nodal p and q, and the largest nodal errors, in p0 and f p0."""
    x = result.traction.x
    if result.traction.observed:
        true = dict(zip(pair.keys, pair.true[:, : len(x)], strict=True))
        p, dq = true["p"], 2 * true["q"]
    else:
        p, dq, *_ = reference.traction.at(x)
    p_off, q_off = result.traction.p - p, (result.traction.dq - dq) / 2
    largest = float(np.abs(p_off).max() / reference.p0)
    if not dq.any() or f == 0 or reference.regime == "ratchets":
        return _nodal(p_off, p, x), None, largest, None
    return _nodal(p_off, p, x), _nodal(q_off, dq / 2, x), largest, float(np.abs(q_off).max() / (f * reference.p0))


def _nodal(error: Array, true: Array, x: Array) -> float | None:
    norm = np.trapezoid(true**2, x)
    return float(np.sqrt(np.trapezoid(error**2, x) / norm)) if norm > 0 else None


def cell_errors(traction: Traction, reference: Traction, f: float = 0.0) -> tuple[float, float]:
    """Return relative L2 errors of the cell averages of p and of q = dq/2 over the reference's contact.

    Parameters
    ----------
    traction, reference : Traction
        Tractions of the result and of the reference.
    f : float, optional
        Coefficient of friction. The error of q is relative to the larger of q's norm and 1e-3 of f p's norm; if f is 0,
        to the larger of the norms of q and p.
    """
    errors = norm_errors(traction, reference, f, ("p", "q"))
    return errors["p"], errors["q"]


def paired(traction: Traction, reference: Traction, keys: tuple[str, ...]) -> Pair:
    """Return the values of ``traction`` and ``reference`` for the ``keys`` and, first, for p."""
    keys = tuple(dict.fromkeys(("p", *keys)))
    own, true = (partial(fields, each, keys=keys) for each in (traction, reference))
    if traction.observed is None:
        cells = _averaging_cells(traction, reference)
        averages = (means(of, cells, each.breaks) for of, each in ((own, traction), (true, reference)))
        return Pair(keys, (cells[1:] + cells[:-1]) / 2, np.diff(cells), *averages)
    (starts, ends), of = traction.observed.cells.T, traction.observed.of
    places, widths = traction.x, ends - starts
    found, wanted = _by_key(traction.values, keys), of(true, reference.breaks)
    # from the end of each part to the start of the next, within the reference's contact
    contact = reference.breaks.min(), reference.breaks.max()
    left, right = np.clip(np.stack([np.append(contact[0], ends), np.append(starts, contact[1])]), *contact)
    if (bare := right > left).any():
        cells = np.stack([left[bare], right[bare]], axis=1).ravel()
        between = (means(of, cells, each.breaks)[..., ::2] for of, each in ((own, traction), (true, reference)))
        found, wanted = (np.concatenate(pair, axis=-1) for pair in zip((found, wanted), between, strict=True))
        places = np.append(places, (left + right)[bare] / 2)
        widths = np.append(widths, (right - left)[bare])
    return Pair(keys, places, widths, found, wanted)


def norm_errors(traction: Traction, reference: Traction, f: float, keys: tuple[str, ...]) -> dict[str, float]:
    """Return relative L2 errors by key: of cell averages, or of the values of a table.

    Parameters
    ----------
    traction, reference : Traction
        Tractions of the result and of the reference.
    f : float
        Coefficient of friction.
    keys : tuple of str
        ``p`` and ``p_1`` (load points 2 and 1): relative to the norm of the quantity; ``q``, ``q1``, ``q2``: relative
        to the larger of the norm of the quantity and 1e-3 of f p's norm; without friction, where q = 0, relative to
        the norm of p. Zero if both are zero.
    """
    errors = paired(traction, reference, keys).errors(f)
    return {key: errors[key] for key in keys}


def relative(off: Array, norms: Array, f: float, keys: tuple[str, ...]) -> dict[str, float]:
    """Return errors by key from norms of errors, ``off``, and of tractions, (keys,), first of p; ``f`` and ``keys`` as
    for :func:`norm_errors`."""
    least = LEAST_SHEAR * f * norms[0] if f else norms[0]
    return {
        key: _ratio(error, norm if key.startswith("p") else max(norm, least))
        for key, error, norm in zip(keys, off.tolist(), norms.tolist(), strict=True)
    }


def integrals(traction: Traction, keys: tuple[str, ...], arm: int = 0) -> dict[str, float]:
    """Return integrals of p, p_1 or q times x to the power ``arm`` over all cells, N/m or N; ``keys`` names them."""
    cells = np.unique(np.concatenate([traction.breaks, [] if traction.cells is None else traction.cells]))
    sums = means(lambda x: x**arm * fields(traction, x, keys), cells, cells) @ np.diff(cells)
    return dict(zip(keys, sums.tolist(), strict=True))


def fields(traction: Traction, x: Array, keys: tuple[str, ...]) -> Array:
    """Return tractions at ``x`` (n,), (keys, n), Pa.

    ``keys`` are p and p_1 (pressure at load points 2 and 1), q = dq/2, and q1 and q2, if the ``traction`` has them.
    """
    return _by_key(traction.at(x), keys)


def _by_key(found: TractionAt, keys: tuple[str, ...]) -> Array:
    known = {"p_1": found.pressures[0], "p": found.p, "q": found.dq / 2, "q1": found.q1, "q2": found.q2}
    return np.array([known[key] for key in keys])


def cell_means(traction: Traction, cells: Array) -> tuple[Array, Array]:
    """Return means (c,) of p and dq of a ``traction``, Pa, over the cells with ascending ends ``cells`` (c + 1,), m."""
    p, dq = means(lambda x: np.stack(traction.at(x)[:2]), cells, traction.breaks)
    return p, dq


def means(function: Callable[[Array], Array], cells: Array, breaks: Array) -> Array:
    """Return means of ``function``, (k,) -> (..., k), over the cells, (..., c).

    Gauss quadrature in an angle over each piece between ``cells`` ends and ``breaks`` of the traction. Square roots at
    the breaks are integrated exactly.
    """
    ends = np.unique(np.concatenate([cells, breaks]))
    ends = ends[(ends >= cells[0]) & (ends <= cells[-1])]
    middle, half = (ends[1:] + ends[:-1]) / 2, np.diff(ends) / 2
    angle = np.pi / 2 * (_NODES + 1)
    weights = np.pi / 2 * _WEIGHTS * np.sin(angle)
    points = middle[:, None] - half[:, None] * np.cos(angle)
    values = function(points.ravel())
    pieces = half * (values.reshape(*values.shape[:-1], *points.shape) @ weights)
    first = np.searchsorted(ends, cells[:-1])
    return np.add.reduceat(pieces, first, axis=-1) / np.diff(cells)


def _averaging_cells(traction: Traction, reference: Traction) -> Array:
    """Return the ends of the cells to average over, m; the cells cover the reference's contact.

    The cells are the method's, else the reference's, else the intervals between the method's points. If both have
    cells, each cell end of the method moves to the nearest one of the reference, because the reference resolves
    nothing within a cell.
    """
    known = (each.cells for each in (traction, reference) if each.cells is not None)
    cells = next(known, np.unique(traction.x))
    left, right = reference.breaks.min(), reference.breaks.max()
    first, last = np.searchsorted(cells, left, "right") - 1, np.searchsorted(cells, right, "left")
    own = cells[max(first, 0) : last + 1]
    if traction.cells is not None and reference.cells is not None:
        ends = reference.cells
        nearest = ends[np.searchsorted((ends[1:] + ends[:-1]) / 2, own)]
        within = (own > left) & (own < right) & (nearest > left) & (nearest < right)
        own = np.union1d(own[(own <= left) | (own >= right)], nearest[within])
    return np.union1d(own, [end for end in (left, right) if not own[0] <= end <= own[-1]])


def _ratio(error: float, norm: float) -> float:
    return 0.0 if error == 0 else float(error / norm) if norm else math.inf
