"""An assessment as tables, texts and plain data."""

import math
from collections.abc import Iterator
from functools import lru_cache
from typing import Any

import numpy as np

from partialslip.arrays import Array
from partialslip.fatigue.assessment import Assessment, Rating, Spot, rough_points
from partialslip.fatigue.cycle import dense, stress_path
from partialslip.fatigue.edges import Coefficient
from partialslip.fatigue.places import OVER, depths, surface_points
from partialslip.output.files import csv_text
from partialslip.report.answer import scale
from partialslip.units import Dimension

RATINGS = ("criterion", "unit", "surface", "x/a", "angle", "tilt", "largest", "x/a", "depth/a")
AVERAGES = ("criterion", "unit", *OVER)
EDGES = ("end", "K_N", "error", "K_T", "predicted slip/a", "slip/a", "K_S", "error")
_DIGITS = 6  # display: significant
_CURVE = 48  # display: intervals of curves between points where stresses may have cusps, and of depth


def assessment_heading(found: Assessment) -> str:
    """Return scene, method, body and the number of load points in one line."""
    scene, changes = found.scene, [rating.change for rating in found.ratings.values()]
    settled = not any(math.isnan(change) for change in changes) and bool(changes)
    half = f"; half as many change the criteria by {max(changes):.1e}" if settled else ""
    return f"{scene.name}, {found.body} body, by {found.result.method}: {len(found.phases)} load points{half}"


def rating_rows(found: Assessment) -> list[tuple[str, ...]]:
    """Return the rows of the table with headings RATINGS: largest values along the surface and in the body, and where
    they are; angles of the normal of the critical plane, degrees."""
    a = found.result.a
    return [
        (
            name,
            unit,
            number(rating.surface),
            f"{rating.surface.x / a:.4f}",
            _degrees(rating.surface.angle),
            _degrees(rating.surface.tilt),
            number(rating.peak),
            f"{rating.peak.x / a:.4f}",
            f"{rating.peak.depth / a:.4f}",
        )
        for name, rating, unit, number in _each(found)
    ]


def average_rows(found: Assessment) -> list[tuple[str, ...]]:
    """Return the rows of the table with headings AVERAGES; empty without distance."""
    return [
        (name, unit, *(number(rating.averages[over]) for over in OVER))
        for name, rating, unit, number in _each(found)
        if rating.averages
    ]


def _each(found: Assessment) -> Iterator[tuple[str, Rating, str, Any]]:
    """Name, rating, unit, and a function from spots to texts, of each criterion."""
    for name, rating in found.ratings.items():
        exponent, unit = 0, ""
        if rating.criterion.of != "1":
            exponent, unit = scale(abs(rating.surface.value), rating.criterion.of, found.scene.units)

        def number(spot: Spot, size: float = 10.0**exponent) -> str:
            return f"{spot.value / size:.{_DIGITS}g}"

        yield name, rating, unit, number


def edge_rows(found: Assessment) -> list[tuple[str, ...]]:
    """Return the rows of the table with headings EDGES, in the units that :func:`edge_units` tells."""
    a, units = found.result.a, found.scene.units
    stress, root = units.size("Pa"), math.sqrt(units.size("m"))
    return [
        (
            edge.side,
            *_coefficient(edge.K_N, stress / root),
            _coefficient(edge.K_T, stress * root)[0],
            "" if edge.predicted is None else f"{edge.predicted / a:.4f}",
            "" if edge.found is None else f"{edge.found / a:.4f}",
            *_coefficient(edge.K_S, stress / root),
        )
        for edge in found.edges
    ]


def edge_units(found: Assessment) -> str:
    """Return the units of the coefficients at the ends of the contact, in words."""
    stress, length = (found.scene.units.label(of) for of in ("Pa", "m"))
    return f"K_N and K_S in {stress}/{length}^0.5, K_T in {stress} {length}^0.5"


def assessment_notes(found: Assessment) -> list[str]:
    """Return Ruiz's parameters and remarks as lines."""
    lines = []
    if found.ruiz:
        text, a = found.scene.units.labelled, found.result.a
        lines += [
            f"ruiz F1 = {text(found.ruiz.F1, 'Pa^2 m')}, tau delta largest at x = {found.ruiz.x1 / a:.4f} a",
            f"ruiz F2 = {text(found.ruiz.F2, 'Pa^2 m')} at x = {found.ruiz.x2 / a:.4f} a",
        ]
    return [*lines, *found.notes]


def assessment_record(found: Assessment) -> dict[str, Any]:
    """Return the assessment as plain data, in SI units; angles in rad."""
    ruiz = found.ruiz and {key: getattr(found.ruiz, key) for key in ("F1", "F2", "x1", "x2")}
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
    return "" if math.isnan(angle) else f"{math.degrees(angle) + 0.0:.1f}"


def _coefficient(found: Coefficient | None, unit: float) -> tuple[str, str]:
    return ("", "") if found is None else (f"{found.value / unit:.6g}", f"{found.error / unit:.1e}")
