"""The report shows what notebooks ask for (:mod:`partialslip.views`). It is imported when it is first asked."""

from typing import TYPE_CHECKING

from partialslip import views
from partialslip.judge import Comparison
from partialslip.result import Result
from partialslip.run import Run
from partialslip.scene import Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def _html(what: Scene | Result | Comparison | Run) -> str:
    from partialslip.report.cells import html

    return html(what)


def _plot(what: Result | Run, axes: "Axes | None" = None) -> "Axes":
    from partialslip.report.cells import plot

    return plot(what, axes)


for _kind in (Scene, Result, Comparison, Run):
    views.html.register(_kind, _html)
for _kind in (Result, Run):
    views.plot.register(_kind, _plot)
