"""An assessment as tables, texts and plain data."""

import math
from collections.abc import Callable, Iterator, Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from partialslip.report.answer import answer_heading, answers, scale, with_error
from partialslip.run import Run
from partialslip.scene import Scene
from partialslip.scene.plan import plan
from partialslip.scene.plausible import implausible
from partialslip.scene.units import SI, Dimension, Units
from partialslip.study.fatigue.assessment import Assessment, CriterionErrors, Rating, Spot, rough_points
from partialslip.study.fatigue.cycle import dense, stress_path
from partialslip.study.fatigue.edges import Coefficient
from partialslip.study.fatigue.places import OVER, depths, surface_points
from partialslip.tools.arrays import Array
from partialslip.tools.output.files import csv_text

HeadedRows = tuple[Sequence[str], Sequence[Sequence[str]]]
_SAME = 1e-9  # display: relative change that is none
_PLACE = 5  # display: significant digits of a place
_POWER = 6  # display: powers of ten from which on numbers have an exponent
_CURVE = 48  # display: intervals of curves between points where stresses may have cusps, and of depth


def assessment_heading(found: Assessment) -> str:
    """Return scene, method, body and the number of load points in one line."""
    scene, changes = found.scene, [rating.change for rating in found.ratings.values()]
    settled = not any(math.isnan(change) for change in changes) and bool(changes)
    half = "; half as many " if settled else ""
    if settled:
        half += "give the same" if max(changes) <= _SAME else f"change the criteria by {max(changes):.1e}"
    return f"{scene.name}, {found.body} body, by {found.result.method}: {len(found.phases)} load points{half}"


def assessment_answer(found: Assessment) -> str:
    """Return the regime, m and n, and a, with their errors, in one line."""
    run = Run(found.scene, plan(found.scene), {found.result.method: found.result}, {})
    told = dict(answers(run))
    return "; ".join([answer_heading(run), *(f"{key} {told[key]}" for key in ("m, n", "a") if key in told)])


def rating_table(found: Assessment) -> HeadedRows:
    """Return headings and rows of the largest values along the surface and, where these are larger, in the body, with
    their errors and places; angles of the normal of the critical plane, degrees."""
    a = found.result.a
    exponent, unit = unit_of_places(found.scene, found.result.a)
    deeper = any(rating.peak != rating.surface for rating in found.ratings.values())
    inside = ("largest", "x/a", f"x, {unit}", "depth/a") if deeper else ()

    def place(spot: Spot) -> tuple[str, str]:
        return f"{spot.x / a:.4f}", f"{spot.x / 10.0**exponent:.{_PLACE}g}"

    rows = [
        (
            name,
            label,
            number(rating.surface, True),
            *place(rating.surface),
            _degrees(rating.surface.angle),
            _degrees(rating.surface.tilt),
            *((number(peak, peak == rating.surface), *place(peak), f"{peak.depth / a:.4f}") if deeper else ()),
        )
        for name, rating, label, number in _each(found)
        for peak in [rating.peak]
    ]
    return ("criterion", "unit", "surface", "x/a", f"x, {unit}", "angle", "tilt", *inside), rows


def average_table(found: Assessment) -> HeadedRows:
    """Return headings and rows of the criteria of averaged stresses, with their errors; no rows without distance."""
    rows = [
        (name, unit, *(number(rating.averages[over], False) for over in OVER))
        for name, rating, unit, number in _each(found)
        if rating.averages
    ]
    return ("criterion", "unit", *OVER), rows


def _each(found: Assessment) -> Iterator[tuple[str, Rating, str, Callable[[Spot, bool], str]]]:
    """Name, rating, unit, and a function from spots, and whether they are at the surface, to texts, of each
    criterion."""
    for name, rating in found.ratings.items():
        exponent, unit = 0, ""
        if rating.criterion.of != "1":
            exponent, unit = scale(abs(rating.surface.value), rating.criterion.of, found.scene.units)

        def number(
            spot: Spot, surface: bool, errors: CriterionErrors | None = rating.errors, exponent: int = exponent
        ) -> str:
            share = math.nan if errors is None else errors.surface if surface else errors.below
            return with_error(spot.value, share * abs(spot.value), exponent)

        yield name, rating, unit, number


def edge_table(found: Assessment) -> HeadedRows:
    """Return headings and rows of the ends of the contact, in the units that :func:`edge_units` tells; without what is
    not known at either end."""
    a, root = found.result.a, math.sqrt(found.scene.units.size("m"))
    (over, _), (times, _) = _edge_stresses(found)
    headings = ("end", "K_N", "K_T", "predicted slip/a", "slip/a", "K_S")
    rows = [
        (
            edge.side,
            _coefficient(edge.K_N, root, over),
            _coefficient(edge.K_T, 1 / root, times),
            "" if edge.predicted is None else f"{edge.predicted / a:.4f}",
            "" if edge.found is None else f"{edge.found / a:.4f}",
            _coefficient(edge.K_S, root, over),
        )
        for edge in found.edges
    ]
    known = [number for number, cells in enumerate(zip(*rows, strict=True)) if any(cells)]
    return [headings[number] for number in known], [[row[number] for number in known] for row in rows]


def edge_units(found: Assessment) -> str:
    """Return the units of the coefficients at the ends of the contact that are known, in words."""
    (_, over), (_, times) = _edge_stresses(found)
    length = found.scene.units.label("m")
    names = "K_N and K_S" if any(edge.K_S for edge in found.edges) else "K_N"
    adhered = f", K_T in {times} {length}^0.5" if any(edge.K_T for edge in found.edges) else ""
    return f"{names} in {over}/{length}^0.5{adhered}"


def assessment_notes(found: Assessment) -> list[str]:
    """Return Ruiz's parameters, why errors are not known, and remarks, also on the scene and by the method, as
    lines."""
    lines, result = [], found.result
    if found.ruiz:
        exponent, unit = unit_of_places(found.scene, found.result.a)
        off, units = found.ruiz.errors or (math.nan, math.nan), found.scene.units
        first, second = (
            f"x = {x / result.a:.4f} a, {x / 10.0**exponent:.{_PLACE}g} {unit}" for x in (found.ruiz.x1, found.ruiz.x2)
        )
        lines += [
            f"ruiz F1 = {_of_ruiz(found.ruiz.F1, off[0], units)}, tau delta largest at {first}",
            f"ruiz F2 = {_of_ruiz(found.ruiz.F2, off[1], units)} at {second}",
        ]
    without = any(rating.errors is None for rating in found.ratings.values())
    if without or (found.ruiz and found.ruiz.errors is None):
        lines.append(f"errors of the criteria are not known: {_without_errors(found)}")
    return [*lines, *implausible(found.scene), *found.notes, *(f"{result.method}: {note}" for note in result.notes)]


def _of_ruiz(value: float, error: float, units: Units) -> str:
    """F1 or F2 (Pa^2 m), with its relative ``error``, as text in ``units``."""
    value = units.from_si(value, "Pa^2 m")
    power = math.floor(math.log10(value)) if value else 0
    power = power if abs(power) >= _POWER else 0
    text = with_error(value, error * value, power)
    text = f"({text})" if power and " " in text else text
    return text + (f"e{power:+03d}" if power else "") + f" {units.label('Pa^2 m')}"


def _without_errors(found: Assessment) -> str:
    """Why the errors of criteria are not known."""
    result = found.result
    if found.body != "lower":
        return "they are estimated in the lower body alone"
    if result.path_dependent:
        return "slip reverses where the result does not follow"
    fixed = result.method == "fem" and found.scene.fem.size is not None
    return f"{result.method} has no estimate of q" + (", as fem.size fixes the mesh; give fem.accuracy" * fixed)


def assessment_record(found: Assessment) -> dict[str, Any]:
    """Return the assessment as plain data, in SI units; angles in rad."""
    ruiz = found.ruiz and {key: getattr(found.ruiz, key) for key in ("F1", "F2", "x1", "x2", "errors")}
    return {
        "scene": found.scene.name,
        "method": found.result.method,
        "body": found.body,
        "a": found.result.a,
        "phases": found.phases.tolist(),
        "distance": found.scene.fatigue.distance,
        "criteria": {
            name: {
                "unit": rating.criterion.of,
                "surface": rating.surface,
                "peak": rating.peak,
                "averages": dict(rating.averages),
                "change": rating.change,
                "errors": rating.errors and rating.errors._asdict(),
            }
            for name, rating in found.ratings.items()
        },
        "ruiz": ruiz,
        "edges": list(found.edges),
        "notes": list(found.notes),
    }


@lru_cache(maxsize=2)  # figure and file show the same
def curve(found: Assessment, along: str) -> tuple[Array, Array, dict[str, Array]]:
    """Return points x and depth, m, and the values of each criterion, along the "surface" or over the "depth" below the
    point where the first criterion is largest at the surface."""
    if along == "surface":
        x = surface_points(rough_points(found.scene, found.result), found.result.a, _CURVE)
        depth = np.zeros_like(x)
    else:
        depth = depths(found.result.a, _CURVE)
        x = np.full_like(depth, next(iter(found.ratings.values())).surface.x)
    stress = stress_path(found.scene, found.result, found.body, dense(found.scene.load, found.phases), x, depth)
    return x, depth, {name: rating.criterion.at(stress).value for name, rating in found.ratings.items()}


def curve_csv(found: Assessment, along: str) -> str:
    """Return :func:`curve` as CSV in the scene's units."""
    x, depth, values = curve(found, along)
    units, of = found.scene.units, {name: rating.criterion.of for name, rating in found.ratings.items()}
    columns: dict[str, tuple[Array, Dimension]] = {"x": (x, "m"), "depth": (depth, "m")}
    columns |= {name: (each, of[name]) for name, each in values.items()}
    return csv_text(
        [units.heading(name, dimension) for name, (_, dimension) in columns.items()],
        zip(*(units.from_si(each, dimension).tolist() for each, dimension in columns.values()), strict=True),
    )


def _degrees(angle: float) -> str:
    return "" if math.isnan(angle) else f"{round(math.degrees(angle), 1) + 0.0:.1f}"


def unit_of_places(scene: Scene, a: float) -> tuple[int, str]:
    """Exponent of ten and label of the unit of places in contacts of half-width ``a`` (m): mm in SI, where that is
    near."""
    units = scene.units
    return (-3, "mm") if units == SI and 1e-6 <= a < 1 else scale(a, "m", units)


def _coefficient(found: Coefficient | None, times: float, exponent: int) -> str:
    return "" if found is None else with_error(found.value * times, found.error * times, exponent)


def _edge_stresses(found: Assessment) -> tuple[tuple[int, str], tuple[int, str]]:
    """Exponent of ten and label of the unit of stress in K_N and K_S, and in K_T."""
    over = [each for edge in found.edges for each in (edge.K_N, edge.K_S)]
    largest = [
        max((abs(each.value) for each in of if each), default=0.0) for of in (over, [edge.K_T for edge in found.edges])
    ]
    return scale(largest[0], "Pa", found.scene.units), scale(largest[1], "Pa", found.scene.units)
