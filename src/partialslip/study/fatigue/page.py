"""Files, report and notebook cells of an assessment, and hot spots in the report of a run."""

from collections.abc import Mapping
from pathlib import Path

from partialslip.report.answer import first_knowing, scale, whose, with_error
from partialslip.report.page import Section
from partialslip.result import Result
from partialslip.run import Run
from partialslip.scene import Fatigue
from partialslip.study.fatigue import tables
from partialslip.study.fatigue.assessment import Assessment
from partialslip.study.fatigue.figure import criteria_svg, planes_svg, stress_svg
from partialslip.study.fatigue.spots import SIGMA, HotSpot, hot_spots
from partialslip.study.fatigue.tables import unit_of_places
from partialslip.tools.errors import InputError
from partialslip.tools.output.files import json_text, write_texts
from partialslip.tools.output.page import template

_CURVES = {"surface": "along-surface.csv", "depth": "over-depth.csv"}
_TITLE = "Fatigue criteria"
_HEADINGS = ("lower body", "unit", "value", "x/a")


def drawn(found: Assessment) -> dict[str, str]:
    """Return figures as SVG by the names of their files: stresses.svg, criteria.svg and planes.svg, as far as there
    is anything to draw."""
    figures = {
        "stresses.svg": stress_svg(found),
        "criteria.svg": criteria_svg(found) if found.ratings else "",
        "planes.svg": planes_svg(found),
    }
    return {name: figure for name, figure in figures.items() if figure}


def write_assessment(found: Assessment, figures: Mapping[str, str], folder: Path) -> list[Path]:
    """Write fatigue.json, along-surface.csv, over-depth.csv and the ``figures`` into ``folder``. Returns the paths.

    Raises
    ------
    InputError
        If the folder cannot be written.
    """
    curves = {name: tables.curve_csv(found, along) for along, name in _CURVES.items() if found.ratings}
    return write_texts(folder, {"fatigue.json": json_text(tables.assessment_record(found)), **curves, **figures})


def sections(found: Assessment, figures: Mapping[str, str]) -> list[Section]:
    """Return the sections of the report, with the ``figures`` by :func:`drawn`."""
    distance = found.scene.fatigue.distance
    lines = [tables.assessment_heading(found), tables.assessment_answer(found), *tables.assessment_notes(found)]
    parts = [
        Section(
            "Criteria",
            [f"{line}." for line in lines],
            figures.get("criteria.svg", ""),
            "Criteria along the surface and over the depth. In a slip zone the curves have teeth: the stress peaks "
            "where the stick zone ends at one of the load points. With more load points the tips become the curve.",
            *tables.rating_table(found),
            (1,),
        )
    ]
    if distance:
        length = found.scene.units.length(distance)
        lines = [f"Stresses at a depth of {length}, averaged over a line to this depth, and over a half disc."]
        parts.append(Section("Averages", lines, "", "", *tables.average_table(found), (1,)))
    if planes := figures.get("planes.svg"):
        caption = (
            "Criteria over the angle of the plane's normal; dashed: normal of the critical plane, grey: its trace."
        )
        parts.append(Section("Critical planes", (), planes, caption))
    parts.append(
        Section("Stresses", (), figures["stresses.svg"], "Stresses in both bodies; the thick line is the contact.")
    )
    if found.edges:
        lines = [
            "p = K_N sqrt(d) and adhered dq = K_T/sqrt(d), d from the end; K_S of f p - |dq|/2 in the stick zone:",
            f"{tables.edge_units(found)}.",
        ]
        parts.append(Section("Ends of the contact", lines, "", "", *tables.edge_table(found)))
    return parts


def notebook_html(found: Assessment) -> str:
    """Return tables and the figure of the criteria as HTML for a notebook."""
    return template("partialslip.study.fatigue", "notebook.html").render(
        found=found, tables_of=tables, figure=criteria_svg(found) if found.ratings else ""
    )


def criteria_sections(run: Run) -> list[Section]:
    """Return the section of hot spots of ``run``: of the answering result, or the first other that holds and knows its
    stresses. Empty without a table ``fatigue`` in the scene, and without such a result."""
    known = first_knowing(run, lambda result: result.stress_at is not None and not result.path_dependent)
    if run.scene.fatigue == Fatigue() or not known:
        return []
    result = known.result
    try:
        found = hot_spots(run.scene, result)
    except InputError as error:
        return [Section(_TITLE, [f"Not known: {error}."])]
    distance = run.scene.fatigue.distance
    averages = f" Averages are over {run.scene.units.length(distance)} from the surface." if distance else ""
    line = f"By {whose(run, result.method)}.{averages} partialslip fatigue has the critical planes and figures."
    exponent, unit = unit_of_places(run.scene, result.a)
    rows = [
        (
            *_hot_spot_row(run, result, key, spot, found.get(key.partition(".")[0], spot).value),
            f"{spot.x / 10.0**exponent:.4g}",
        )
        for key, spot in found.items()
    ]
    return [Section(_TITLE, [line], headings=(*_HEADINGS, f"x, {unit}"), rows=rows, words=(1,))]


def _hot_spot_row(run: Run, result: Result, key: str, spot: HotSpot, largest: float) -> tuple[str, ...]:
    """Cells of a hot spot but for its place in a unit of length, in the unit of the ``largest`` of its criterion, which
    stands at the surface."""
    name, _, over = key.partition(".")
    text = f"{name}, largest" if key == SIGMA else f"{name}, {f'averaged, {over}' if over else 'at the surface'}"
    exponent, unit = scale(largest, spot.of, run.scene.units)
    error = float("nan") if spot.error is None else spot.error * spot.value
    return text, unit, with_error(spot.value, error, exponent), f"{spot.x / result.a:.4f}"
