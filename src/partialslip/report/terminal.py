"""Print a run on the terminal."""

from rich.console import Console

from partialslip.output.tables import print_lines, print_table
from partialslip.report import rows
from partialslip.run import Run


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
    methods = rows.methods(run.results, compared=bool(run.comparisons), units=run.scene.units)
    print_lines(console, [*methods, *rows.effects(run.plan)])
    console.print(rows.verdict(run), style="bold", markup=False)
