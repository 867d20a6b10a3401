"""Self-contained HTML pages from templates, and the same as PDF."""

import functools
import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NoReturn

from jinja2 import ChoiceLoader, Environment, PackageLoader, StrictUndefined, Template
from markupsafe import Markup

from partialslip.tools.errors import MissingLibraryError
from partialslip.tools.output.files import write_files

_NARROW = 420.0  # display: pt


@functools.cache
def template(package: str, name: str) -> Template:
    """Return the template ``name`` of ``package``; the template may include the templates of this package."""
    environment = Environment(
        loader=ChoiceLoader([PackageLoader(package, "."), PackageLoader("partialslip.tools.output", ".")]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["inline"] = _inline
    environment.tests["narrow"] = _narrow
    return environment.get_template(name)


def _inline(svg: str, name: str = "") -> Markup:
    """Return a figure for embedding in a page. The prefix ``name`` makes the figure's ids unique in the page."""
    own = re.sub(r'(\bid="|href="#|url\(#)', lambda found: found[0] + name, svg[svg.index("<svg") :])
    return Markup(own)


def _narrow(svg: str) -> bool:
    """Return whether a figure is too narrow to fill the width of a page."""
    width = re.search(r'<svg[^>]*\bwidth="([\d.]+)pt"', svg)
    return width is not None and float(width[1]) < _NARROW


def render_page(
    package: str,
    name: str,
    *,
    title: str,
    origin: Sequence[tuple[str, str]],
    subtitle: str = "",
    verdict: str = "",
    **content: object,
) -> str:
    """Return a page as HTML: title, verdict and origin, then the blocks of a template.

    Parameters
    ----------
    package, name : str
        Package and name of a template that extends ``page.html``.
    title, subtitle : str
    origin : sequence of (str, str)
        Rows of key and text: date, command, versions.
    verdict : str
        Text of the verdict box; empty for no box.
    **content
        Variables of the template.
    """
    frame = {"title": title, "subtitle": subtitle, "origin": origin, "verdict": verdict}
    return template(package, name).render(**frame, **content) + "\n"


LIBRARIES = "libpango-1.0-0 libpangoft2-1.0-0 libharfbuzz-subset0"


def write_pdf(html: str, folder: Path, name: str) -> list[Path]:
    """Write a self-contained page ``html`` as the PDF file ``name`` in ``folder``. Returns the path in a list.

    Raises
    ------
    MissingLibraryError
        If WeasyPrint, or a system library of WeasyPrint, is missing.
    InputError
        If the folder cannot be written.
    """
    return write_files(folder, {name: lambda path: _writer(name)(html, path)})


def check_pdf(name: str) -> None:
    """Raise MissingLibraryError if a library for the PDF file ``name`` is missing."""
    _writer(name)


def _writer(name: str) -> Callable[[str, Path], object]:
    try:
        from weasyprint import HTML
    except ImportError:
        raise MissingLibraryError(f"{name} needs WeasyPrint: pip install 'partialslip[pdf]'") from None
    except OSError:
        raise MissingLibraryError(f"{name} needs libraries of Pango: apt-get install {LIBRARIES}") from None
    return lambda html, path: HTML(string=html, url_fetcher=_refuse).write_pdf(path)


def _refuse(url: str, *_: object, **__: object) -> NoReturn:
    """Refuse to fetch: a self-contained page needs nothing."""
    raise ValueError(f"{url}: not fetched")
