"""Hooks for notebook display: the tables of the page and the plot of the tractions."""

from typing import TYPE_CHECKING

from partialslip.report import answer, rows
from partialslip.report.figure import in_order
from partialslip.report.levels import Shown, draw_levels
from partialslip.result import Result
from partialslip.run import Run
from partialslip.run.judge import Comparison
from partialslip.scene import Scene
from partialslip.scene.units import SI
from partialslip.tools.output.page import template

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def html(what: Scene | Result | Comparison | Run) -> str:
    """Return the tables of ``what`` as HTML."""
    named = {"kind": type(what).__name__, "what": what, "rows": rows, "answer": answer}
    return template("partialslip.report", "notebook.html").render(named)


def plot(what: Result | Run, axes: "Axes | None", shown: Shown, in_units: bool) -> "Axes":
    """Draw ``what`` on ``axes`` (default: axes of a new pyplot figure), as
    :func:`partialslip.report.levels.draw_levels`. Returns the axes."""
    if axes is None:
        from matplotlib import pyplot

        axes = pyplot.subplots(layout="constrained")[1]
    if isinstance(what, Result):
        draw_levels(axes, {what.method: what}, shown, None, SI if in_units else None)
    else:
        draw_levels(axes, in_order(what), shown, what.scene.friction, what.scene.units if in_units else None)
    return axes
