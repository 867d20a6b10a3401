"""Pages are made of templates."""

import re

from jinja2 import ChoiceLoader, Environment, PackageLoader, StrictUndefined, Template
from markupsafe import Markup


def template(package: str, name: str) -> Template:
    """The template ``name`` of ``package``, which may include those beside this file."""
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
    """A figure as a part of a page; its own names begin with ``name`` there, as a page has each name once."""
    own = re.sub(r'(\bid="|href="#|url\(#)', lambda found: found[0] + name, svg[svg.index("<svg") :])
    return Markup(own)
