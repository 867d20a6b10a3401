"""Print tables on a terminal."""

from collections.abc import Container, Iterable, Sequence

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

_WIDEST = 1000  # limit: columns of a table
_NARROW = 60  # display: columns of a narrow table


def print_table(
    console: Console, headings: Sequence[str], rows: Iterable[Sequence[str]], words: Container[int] = (0,)
) -> None:
    """Print a table on ``console``.

    Parameters
    ----------
    console : Console
    headings : sequence of str
    rows : iterable of sequences of str
    words : container of int
        Columns of words, left-aligned; all other columns hold numbers, right-aligned.

    Notes
    -----
    No digits are cut: the table may be wider than the terminal. On a terminal narrower than 60 columns, such a table is
    printed as lines of heading and value.
    """
    rows = list(rows)
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))
    for number, heading in enumerate(headings):
        table.add_column(Text(heading), justify="left" if number in words else "right", no_wrap=True)
    for row in rows:
        table.add_row(*row)
    needed = console.measure(table, options=console.options.update(width=_WIDEST)).maximum
    if needed > console.width:  # narrower gaps
        table.padding = (0, 0, 0, 0)
        needed = console.measure(table, options=console.options.update(width=_WIDEST)).maximum
    if needed > console.width and console.width < _NARROW:
        print_lines(console, [line for row in rows for line in (*zip(headings, row, strict=True), ("", ""))])
        return
    table.width = needed if needed > console.width else None
    console.print(table, crop=False)


def print_lines(console: Console, lines: Iterable[Sequence[str]]) -> None:
    """Print ``lines`` of cells on ``console`` in aligned columns, without headings."""
    grid = Table.grid(padding=(0, 2))
    for line in lines:
        grid.add_row(*map(Text, line))
    console.print(grid)
