"""The page: one self-contained HTML file."""

from typing import Any

from partialslip.report import rows
from partialslip.report.template import template
from partialslip.run import Run


def page(run: Run, data: dict[str, Any], figure: str) -> str:
    """The report of a run as HTML. ``data`` is its record, ``figure`` the traction plot as SVG."""
    return template("page.html").render(run=run, data=data, figure=figure, rows=rows) + "\n"
