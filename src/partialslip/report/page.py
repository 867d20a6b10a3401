"""Reports as self-contained HTML pages: of a run, and of a study."""

from collections.abc import Sequence
from dataclasses import dataclass

from partialslip.report import answer, rows
from partialslip.report.answer import amounts
from partialslip.report.figure import error_svg, mesh_svg, profile_svg, traction_svg
from partialslip.report.levels import levels_svg
from partialslip.report.loop import loop_remark, loop_rows, loop_svg
from partialslip.report.sketch import sketch_svg
from partialslip.report.tolerance import (
    HEADINGS,
    TORNADO,
    allowed_lines,
    tolerance_heading,
    tolerance_lines,
    tolerance_rows,
    tornado_svg,
)
from partialslip.run import Run
from partialslip.scene import Scene
from partialslip.tools.origin import Made, origin_lines
from partialslip.tools.output.page import render_page


@dataclass(frozen=True)
class Section:
    """A section of a report: paragraphs, then a figure, then a table.

    Parameters
    ----------
    title : str
    lines : sequence of str
        Paragraphs.
    figure, caption : str
        SVG and caption; empty for no figure.
    headings, rows : sequence of str, sequence of rows of str
        The table; without rows there is none.
    words : sequence of int
        Columns of words besides the first; all other columns are numbers.
    """

    title: str
    lines: Sequence[str] = ()
    figure: str = ""
    caption: str = ""
    headings: Sequence[str] = ()
    rows: Sequence[Sequence[str]] = ()
    words: Sequence[int] = ()


def tolerance_section(run: Run) -> Section:
    """Return the section on what the tolerances of the scene of ``run`` allow."""
    found, units = run.tolerance, run.scene.units
    assert found
    lines = [f"{line}." for line in (tolerance_heading(found), *tolerance_lines(found, units), *allowed_lines(run))]
    rows = tolerance_rows(found, units)
    return Section("Tolerances of the inputs", lines, tornado_svg(found), TORNADO, HEADINGS, rows, (1, 5))


def run_page(run: Run, made: Made, sections: Sequence[Section] = ()) -> str:
    """Return the report of ``run``, of the origin ``made``, as HTML; with further ``sections``."""
    return render_page(
        "partialslip.report",
        "run.html",
        title=run.scene.name,
        subtitle=run.scene.title,
        verdict=rows.verdict(run),
        origin=origin_lines([made]),
        run=run,
        rows=rows,
        answer=answer,
        figure=traction_svg(run, errors=False),
        errors=error_svg(run),
        amounts=amounts({answer.whose(run, name): each for name, each in run.results.items()}, run.scene.units),
        levels=levels_svg(run),
        sections=[*([tolerance_section(run)] if run.tolerance else []), *sections],
        plates={"figure": loop_svg(run), "rows": loop_rows(run), "remark": loop_remark(run)},
        mesh=mesh_svg(run),
        profile=profile_svg(run.scene),
        sketch=sketch_svg(run.scene),
        settings=rows.settings(run.scene),
    )


def study_page(title: str, scene: Scene, made: Made, sections: Sequence[Section]) -> str:
    """Return the report of a study of ``scene`` as HTML.

    Parameters
    ----------
    title : str
    scene : Scene
    made : Made
        Origin of the study.
    sections : sequence of Section
    """
    return render_page(
        "partialslip.report",
        "study.html",
        title=title,
        subtitle=scene.title,
        origin=origin_lines([made]),
        sections=sections,
        sketch=sketch_svg(scene),
        settings=rows.settings(scene),
        units=scene.units.words,
    )
