"""Tables as CSV."""

import csv
import io
import itertools
from collections.abc import Iterable, Sequence

from partialslip.errors import printable

_FORMULA = ("=", "+", "-", "@")  # what a formula begins with


def csv_text(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Return a table with headings ``head`` and ``rows`` as the text of a CSV file.

    Text that a spreadsheet would take for a formula, such as the name of a file that begins with =, begins with an
    apostrophe instead.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerows([_plain(cell) for cell in row] for row in itertools.chain([head], rows))
    return text.getvalue()


def _plain(cell: object) -> object:
    """Return ``cell``; text without control characters, and with an apostrophe if it would be a formula. Numbers are
    none, in text neither."""
    if not isinstance(cell, str):
        return cell
    cell = printable(cell)
    if not cell.startswith(_FORMULA):
        return cell
    try:
        float(cell)
    except ValueError:
        return f"'{cell}"
    return cell
