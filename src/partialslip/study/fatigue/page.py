"""Files, report and notebook cells of an assessment."""

from collections.abc import Mapping
from pathlib import Path

from partialslip.report.page import Section
from partialslip.study.fatigue import tables
from partialslip.study.fatigue.assessment import Assessment
from partialslip.study.fatigue.figure import criteria_svg, planes_svg, stress_svg
from partialslip.tools.output.files import json_text, write_texts
from partialslip.tools.output.page import template

_CURVES = {"surface": "along-surface.csv", "depth": "over-depth.csv"}


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
