"""Pages are made of templates."""

from jinja2 import Environment, PackageLoader, StrictUndefined, Template
from markupsafe import Markup


def template(name: str) -> Template:
    """The template ``name`` of this package."""
    environment = Environment(
        loader=PackageLoader("partialslip.report", "."),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["inline"] = lambda svg: Markup(svg[svg.index("<svg") :])
    return environment.get_template(name)
