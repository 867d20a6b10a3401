"""Tables on a terminal."""

from collections.abc import Container, Iterable, Sequence

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

_WIDEST = 1000


_NARROW = 60


def print_table(
    console: Console, headings: Sequence[str], rows: Iterable[Sequence[str]], words: Container[int] = (0,)
) -> None:
    """Print ``rows`` under ``headings``; columns ``words`` are of words, the others of numbers. A table is as wide as
    its numbers are long: beyond a narrow terminal rather than with digits left out. On one of fewer than 60 columns
    each row is printed as lines of its own, a heading and a value each."""
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
    """Print ``lines`` of cells in columns, without headings."""
    grid = Table.grid(padding=(0, 2))
    for line in lines:
        grid.add_row(*map(Text, line))
    console.print(grid)
