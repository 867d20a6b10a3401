"""Convert an HTML page to PDF with WeasyPrint."""

from collections.abc import Callable
from pathlib import Path
from typing import NoReturn

from partialslip.errors import MissingLibraryError
from partialslip.output.files import write_files

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
