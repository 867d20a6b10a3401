"""Report of a run as one self-contained HTML page."""

from partialslip.output.template import template
from partialslip.record import Record
from partialslip.report import rows
from partialslip.run import Run


def page(run: Run, data: Record, figure: str) -> str:
    """Return the report of ``run`` as HTML. ``data`` is the run's record, ``figure`` the traction plot as SVG."""
    return template("partialslip.report", "page.html").render(run=run, data=data, figure=figure, rows=rows) + "\n"
