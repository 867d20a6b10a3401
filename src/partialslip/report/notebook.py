"""Hooks for notebook display: the tables of the page and the plot of the tractions."""

from typing import TYPE_CHECKING

from partialslip.judge import Comparison
from partialslip.output.page import template
from partialslip.report import answer, rows
from partialslip.report.figure import draw_run, draw_tractions
from partialslip.result import Result
from partialslip.run import Run
from partialslip.scene import Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def html(what: Scene | Result | Comparison | Run) -> str:
    """Return the tables of ``what`` as HTML."""
    named = {"kind": type(what).__name__, "what": what, "rows": rows, "answer": answer}
    return template("partialslip.report", "notebook.html").render(named)


def plot(what: Result | Run, axes: "Axes | None" = None) -> "Axes":
    """Draw the tractions of ``what`` on ``axes`` (default: axes of a new pyplot figure). Returns the axes."""
    if axes is None:
        from matplotlib import pyplot

        axes = pyplot.subplots(layout="constrained")[1]
    if isinstance(what, Result):
        draw_tractions(axes, {what.method: what})
    else:
        draw_run(axes, what)
    return axes
