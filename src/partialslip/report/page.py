"""The page: one self-contained HTML file."""

from partialslip.output.template import template
from partialslip.record import Record
from partialslip.report import rows
from partialslip.run import Run


def page(run: Run, data: Record, figure: str) -> str:
    """The report of a run as HTML. ``data`` is its record, ``figure`` the traction plot as SVG."""
    return template("partialslip.report", "page.html").render(run=run, data=data, figure=figure, rows=rows) + "\n"
