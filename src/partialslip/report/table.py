"""The terminal's view of a run."""

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from partialslip.report import rows
from partialslip.run import Run


def print_run(run: Run, console: Console) -> None:
    """Print regimes, errors, certificates and costs."""
    title = f"{run.scene.name}: {run.scene.title}" if run.scene.title else run.scene.name
    console.print(title, style="bold", markup=False)
    for name in run.comparisons:
        console.print(_errors(run, name))
    for name, result in run.results.items():
        _print_lines(console, name, rows.facts(result, compared=bool(run.comparisons)))
    console.print(rows.verdict(run), style="bold", markup=False)


def _errors(run: Run, name: str) -> Table:
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))
    for number, heading in enumerate(rows.headings(run, name)):
        table.add_column(heading, justify="left" if number in (0, 5) else "right", no_wrap=True)
    for row in rows.error_rows(run, name):
        table.add_row(*row)
    return table


def _print_lines(console: Console, name: str, lines: dict[str, str]) -> None:
    grid = Table.grid(padding=(0, 2))
    for number, (key, text) in enumerate(lines.items()):
        grid.add_row(name if number == 0 else "", key, Text(text))
    console.print(grid)
