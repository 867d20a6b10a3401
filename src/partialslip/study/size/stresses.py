"""The stresses of a size study as headings, rows, sentences and CSV: what breaks a body, beside where it sticks."""

import math
from collections.abc import Iterable, Sequence

from partialslip.report.answer import scale, with_error
from partialslip.scene import Fatigue, Scene
from partialslip.scene.plan import asks_for_stresses
from partialslip.scene.units import Dimension
from partialslip.study.fatigue import HotSpot
from partialslip.study.fatigue.criteria import CRITERIA, RUIZ, chosen
from partialslip.study.fatigue.places import OVER
from partialslip.study.fatigue.spots import SIGMA
from partialslip.study.size.case import EQUIVALENT, FEM, HALF_PLANE, STRIPS
from partialslip.study.size.law import Sizes
from partialslip.study.size.sizes import DIFFERENCES
from partialslip.study.size.tables import Rows, SizeStudy, marked, mesh_share, row_text
from partialslip.tools.errors import InputError
from partialslip.tools.output.files import csv_text

USUAL = ("m", "n", SIGMA)  # display: quantities of which the answer tells
_SURFACE = "surface"
_CRITERION = "swt"  # display: the criterion of scenes that have no constants of a criterion
_MODELS = (FEM, HALF_PLANE, EQUIVALENT, STRIPS)
_UNLIKE = "stresses of the half-plane are not known: no method finds them in half-planes of unlike materials"
NOT_ASKED = "no stresses: the table fatigue has no constant; --set effects.subsurface=true tells the largest sigma_xx"


def criteria_of(scene: Scene, names: Sequence[str] | None) -> list[str]:
    """Return the fatigue criteria that a study of ``scene`` shows: ``names``, or all whose constants the scene has; swt
    if it has none.

    Raises
    ------
    InputError
        If a criterion is unknown or is not evaluated by the study, or a constant is missing.
    """
    if names is None:
        return [name for name in chosen(scene, None) if CRITERIA[name].needs] or [_CRITERION]
    found = chosen(scene, names)
    if RUIZ in found:
        raise InputError(f"--criterion {RUIZ}: must be another for a study of sizes; use partialslip fatigue")
    if scene.fatigue == Fatigue():
        needs = "a constant in the table fatigue, for example --set fatigue.distance=LENGTH"
        raise InputError(f"--criterion {','.join(found)}: must be given only with {needs}")
    return found


def quantities_of(scene: Scene, names: Sequence[str] | None, criteria: Sequence[str], asked: bool) -> list[str]:
    """Return the quantities of which a study of ``scene`` answers: ``names``; by default m, n, the largest sigma_xx
    and, if ``asked`` for, the ``criteria``.

    Raises
    ------
    InputError
        If a quantity is unknown, or the study has no stresses.
    """
    if names is None:
        return [*USUAL, *(criteria if asked else ())]
    averaged = [f"{name}.{place}" for name in criteria for place in OVER]
    known = [*DIFFERENCES, *((SIGMA, *criteria, *averaged) if asks_for_stresses(scene) else ())]
    for name in names:
        if name not in known:
            why = "" if asks_for_stresses(scene) else f"; {NOT_ASKED}"
            raise InputError(f"--show {name}: must be of {', '.join(known)}{why}")
    return [*names]


def stresses_of(study: SizeStudy) -> SizeStudy:
    """Return the part of ``study`` that compares stresses."""
    return study.part([key for key in study.quantities if key not in DIFFERENCES])


def largest_table(study: SizeStudy) -> tuple[tuple[str, ...], Rows]:
    """Return headings and rows of the largest stresses along the surface of the lower body, by quantity and size:
    values of finite elements and half-planes, and their places x."""
    units = study.scene.units
    keys = [key for key in study.quantities if key not in DIFFERENCES and "." not in key]
    known = [name for name in _MODELS if any(found.get(name) for found in study.spots.values())]
    largest = max((abs(spot.x) for found in study.spots.values() for spot in found[FEM].values()), default=0.0)
    length = scale(largest, "m", units)
    rows: Rows = []
    for key in keys:
        of, top = _largest(study, key)
        unit = scale(top, of, units) if of != "1" else (0, "")
        for size, found in study.spots.items():
            spots = [found.get(name, {}).get(key) for name in known]
            rows.append(
                (
                    key,
                    unit[1],
                    row_text(study.models[0], size),
                    *(cell for spot in spots for cell in _spot_cells(spot, unit[0], length[0])),
                )
            )
    heads = [head for name in known for head in (name, f"x, {length[1]}")]
    return ("largest", "unit", "size", *heads), rows


def _largest(study: SizeStudy, key: str) -> tuple[Dimension, float]:
    spots = [found[FEM][key] for found in study.spots.values() if key in found[FEM]]
    return spots[0].of, max(abs(spot.value) for spot in spots)


def _spot_cells(spot: HotSpot | None, exponent: int, length: int) -> tuple[str, str]:
    """Value with its error, and place."""
    if spot is None:
        return "-", ""
    error = math.nan if spot.error is None else spot.error * abs(spot.value)
    return with_error(spot.value, error, exponent), f"{spot.x / 10.0**length:.4g}"


def stress_differences_table(study: SizeStudy, model: Sizes) -> tuple[tuple[str, ...], Rows]:
    """Return headings and rows of the relative differences of stresses, by size and place; stars as in
    :func:`partialslip.study.size.tables.differences_table`."""
    part = model.part(stresses_of(study).quantities)
    sizes, points = part, {trend.quantity: trend.points for trend in part.trends}
    columns = dict.fromkeys(key.partition(".")[0] for key in points)
    rows: Rows = []
    for k, size in enumerate(sizes.size.tolist()):
        for place in (_SURFACE, *OVER):
            keys = [column if place == _SURFACE else f"{column}.{place}" for column in columns]
            shown = [key for key in keys if key in points and not math.isnan(sizes.off[key][k])]
            if shown:
                cells = [marked(sizes.off[key][k], points[key][k]) if key in shown else "" for key in keys]
                rows.append((row_text(sizes, size), place, *cells, mesh_share(sizes, shown, k)))
    return ("size", "stresses", *columns, "mesh"), rows


def in_short(study: SizeStudy) -> list[str]:
    """Return by how much the half-plane is off in the largest stresses, and in m and n, a line for each size."""
    sizes = study.models[0]
    keys = [key for key in stresses_of(study).quantities if "." not in key]
    lines = []
    if not study.scene.material.alike and study.spots:
        lines.append(_UNLIKE)
    for k, size in enumerate(sizes.size.tolist()):
        stresses, ends = _percents(sizes, keys, k, ""), _percents(sizes, ("m", "n"), k, " of a")
        if stresses:
            lines.append(
                "; ".join(filter(None, (f"size {row_text(sizes, size)}: the half-plane is off by {stresses}", ends)))
            )
    return lines


def _percents(sizes: Sizes, quantities: Iterable[str], k: int, of: str) -> str:
    known = {key: sizes.off[key][k] for key in quantities if not math.isnan(sizes.off[key][k])}
    return ", ".join(f"{100 * off:.2g} %{of} in {key}" for key, off in known.items())


def stresses_csv(study: SizeStudy) -> str:
    """Return the hot spots of ``study`` as CSV, one row per size, model and quantity, in the scene's units."""
    units = study.scene.units
    rows = [
        (size, name, key, units.from_si(spot.value, spot.of), units.label(spot.of), units.from_si(spot.x, "m"),
         "" if spot.error is None or math.isnan(spot.error) else spot.error)
        for size, found in study.spots.items()
        for name, spots in found.items()
        for key, spot in spots.items()
    ]  # fmt: skip
    return csv_text(
        (study.heading(), "by", "quantity", "value", "unit", units.heading("x", "m"), "relative error"), rows
    )
