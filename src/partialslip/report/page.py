"""The page: one self-contained HTML file."""

from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from partialslip.report import rows
from partialslip.run import Run


def page(run: Run, data: dict[str, Any], figure: str) -> str:
    """The report of a run as HTML. ``data`` is its record, ``figure`` the traction plot as SVG."""
    environment = Environment(
        loader=PackageLoader("partialslip.report", "."),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    template = environment.get_template("page.html")
    return template.render(run=run, data=data, figure=figure[figure.index("<svg") :], rows=rows) + "\n"
