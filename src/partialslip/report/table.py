"""The terminal's view of a run."""

from collections.abc import Container, Iterable, Sequence

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from partialslip.report import rows
from partialslip.run import Run

_WIDEST = 1000
_NARROW = 60


def print_run(run: Run, console: Console) -> None:
    """Print regimes, errors, certificates and costs of ``run`` on rich's ``console``."""
    title = f"{run.scene.name}: {run.scene.title}" if run.scene.title else run.scene.name
    console.print(title, style="bold", markup=False)
    if run.comparisons:
        console.print(rows.units(run), markup=False)
    for name, comparison in run.comparisons.items():
        print_table(console, rows.headings(run, name), rows.error_rows(comparison), words=(0, 1, 7))
        for line in rows.unjudged(comparison):
            console.print(line, markup=False)
    methods = rows.methods(run.results, compared=bool(run.comparisons))
    _print_lines(console, [*methods, *rows.effects(run.plan)])
    console.print(rows.verdict(run), style="bold", markup=False)


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
        _print_lines(console, [line for row in rows for line in (*zip(headings, row, strict=True), ("", ""))])
        return
    table.width = needed if needed > console.width else None
    console.print(table, crop=False)


def _print_lines(console: Console, lines: Iterable[Sequence[str]]) -> None:
    grid = Table.grid(padding=(0, 2))
    for line in lines:
        grid.add_row(*map(Text, line))
    console.print(grid)
