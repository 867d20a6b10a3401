"""Print a run on the terminal."""

from collections.abc import Sequence

from rich.console import Console
from rich.text import Text

from partialslip.report import rows
from partialslip.report.answer import answer_heading, answers
from partialslip.report.tolerance import HEADINGS, allowed_lines, tolerance_heading, tolerance_lines, tolerance_rows
from partialslip.run import Run
from partialslip.tools.output.tables import print_lines, print_table


def print_run(run: Run, console: Console, *, verbose: bool = False, lines: Sequence[str] = (), where: str = "") -> None:
    """Print ``run``: the answer, errors, one line a method, notes, and a last line with the verdict.

    Parameters
    ----------
    run : Run
    console : rich Console
    verbose : bool
        Whether to print all errors, everything that is known of each method, and the effects, instead of one line a
        method.
    lines : sequence of str
        Lines to print before the last one.
    where : str
        End of the last line: where the files are.
    """
    title = f"{run.scene.name}: {run.scene.title}" if run.scene.title else run.scene.name
    console.print(title, style="bold", markup=False)
    console.print(answer_heading(run), markup=False)
    print_lines(console, [("", *line) for line in answers(run)])
    if run.tolerance:
        console.print(tolerance_heading(run.tolerance), soft_wrap=True, markup=False)
        print_table(console, HEADINGS, tolerance_rows(run.tolerance, run.scene.units), words=(0, 1, 5))
        for line in tolerance_lines(run.tolerance, run.scene.units):
            console.print(line, soft_wrap=True, markup=False)
    compared = bool(run.comparisons)
    for name, comparison in run.comparisons.items():
        errors = [(*row, f"{bar} {word}".strip()) for *row, bar, word in rows.error_rows(comparison, every=verbose)]
        print_table(console, rows.error_headings(run, name)[:-1], errors, words=(0, 1, 6))
    if compared:
        console.print(f"units of {rows.units(run)}", markup=False)
    if verbose:
        methods = rows.methods(run.results, compared=True, units=run.scene.units)
        print_lines(console, [*methods, *rows.effects(run.plan)])
    else:
        print_lines(console, rows.methods_in_short(run.results))
    notes = [] if verbose else rows.run_notes(run)
    unjudged = [line for comparison in run.comparisons.values() for line in rows.unjudged(comparison)]
    for line in (*rows.implausible(run.scene), *unjudged, *notes, *allowed_lines(run)):
        console.print(line, markup=False)
    *asked, verdict = rows.verdict_lines(run)
    for line in (*lines, *asked):
        console.print(line, soft_wrap=True, markup=False)
    console.print(Text.assemble((verdict, "bold"), f"; {where}" if where else ""), soft_wrap=True)
