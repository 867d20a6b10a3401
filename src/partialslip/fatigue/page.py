"""Files, report and notebook cells of an assessment."""

from pathlib import Path

from partialslip.fatigue import tables
from partialslip.fatigue.assessment import Assessment
from partialslip.fatigue.figure import criteria_svg, planes_svg, stress_svg
from partialslip.output.files import write_texts
from partialslip.output.json import json_text
from partialslip.output.template import template
from partialslip.report.page import Section

_CURVES = {"surface": "along-surface.csv", "depth": "over-depth.csv"}


def write_assessment(found: Assessment, folder: Path) -> list[Path]:
    """Write fatigue.json, along-surface.csv, over-depth.csv, stresses.svg, criteria.svg and planes.svg into ``folder``.
    Returns the paths.

    Raises
    ------
    InputError
        If the folder cannot be written.
    """
    texts = {"fatigue.json": json_text(tables.record(found)), "stresses.svg": stress_svg(found)}
    if found.ratings:
        texts |= {name: tables.curve_csv(found, along) for along, name in _CURVES.items()}
        texts["criteria.svg"] = criteria_svg(found)
    if planes := planes_svg(found):
        texts["planes.svg"] = planes
    return write_texts(folder, texts)


def sections(found: Assessment) -> list[Section]:
    """Return the sections of the report."""
    distance = found.scene.fatigue.distance
    parts = [
        Section(
            "Criteria",
            [tables.heading(found) + ".", *(f"{line}." for line in tables.notes(found))],
            criteria_svg(found) if found.ratings else "",
            "Criteria along the surface and over the depth. In a slip zone the curves have teeth: the stress peaks "
            "where the stick zone ends at one of the load points. With more load points the tips become the curve.",
            tables.RATINGS,
            tables.rating_rows(found),
            (1,),
        )
    ]
    if distance:
        length = found.scene.units.length(distance)
        lines = [f"Stresses at a depth of {length}, averaged over a line to this depth, and over a half disc."]
        parts.append(Section("Averages", lines, headings=tables.AVERAGES, rows=tables.average_rows(found), words=(1,)))
    if planes := planes_svg(found):
        caption = (
            "Criteria over the angle of the plane's normal; dashed: normal of the critical plane, grey: its trace."
        )
        parts.append(Section("Critical planes", (), planes, caption))
    parts.append(Section("Stresses", (), stress_svg(found), "Stresses in both bodies; the thick line is the contact."))
    if found.edges:
        lines = ["p = K_N sqrt(d) and adhered dq = K_T/sqrt(d), d from the end; K_S of f p - |dq|/2 in the stick zone."]
        parts.append(Section("Ends of the contact", lines, headings=tables.EDGES, rows=tables.edge_rows(found)))
    return parts


def notebook_html(found: Assessment) -> str:
    """Return tables and the figure of the criteria as HTML for a notebook."""
    return template("partialslip.fatigue", "notebook.html").render(
        found=found, tables_of=tables, figure=criteria_svg(found) if found.ratings else ""
    )
