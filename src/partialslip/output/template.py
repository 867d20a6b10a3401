"""Templates of HTML pages."""

import re

from jinja2 import ChoiceLoader, Environment, PackageLoader, StrictUndefined, Template
from markupsafe import Markup


def template(package: str, name: str) -> Template:
    """Return the template ``name`` of ``package``; the template may include the templates of this package."""
    environment = Environment(
        loader=ChoiceLoader([PackageLoader(package, "."), PackageLoader("partialslip.output", ".")]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["inline"] = _inline
    return environment.get_template(name)


def _inline(svg: str, name: str = "") -> Markup:
    """Return a figure for embedding in a page. The prefix ``name`` makes the figure's ids unique in the page."""
    own = re.sub(r'(\bid="|href="#|url\(#)', lambda found: found[0] + name, svg[svg.index("<svg") :])
    return Markup(own)
