"""The frame of a command that finds something: choose a folder, find, write files and report, print."""

import argparse
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from partialslip.cli.common import origin, print_written, results_folder

if TYPE_CHECKING:
    from partialslip.report.page import Section
    from partialslip.scene import Scene


@dataclass(frozen=True)
class Findings:
    """What a command found.

    Parameters
    ----------
    files : sequence of Path
        Files that are written already.
    heading : str
        Line to print first; empty for none.
    printed : sequence of str and Section
        Lines and tables to print: of a section the title, if it has one, and the table.
    title, sections : str and sequence of Section
        The report; without sections there is none.
    code : int
        Exit code.
    """

    files: Sequence[Path]
    heading: str = ""
    printed: "Sequence[str | Section]" = ()
    title: str = ""
    sections: "Sequence[Section]" = ()
    code: int = 0


def present(
    options: argparse.Namespace,
    command: str,
    name: str,
    scene: "Scene | None",
    find: Callable[[Path], Findings],
    *more: Any,
) -> int:
    """Find what a command asks for, write and print it, and return the exit code.

    Parameters
    ----------
    options, command, name, scene, more : optional
        As for :func:`partialslip.cli.common.results_folder`. A command with a report has a scene.
    find : callable
        ``find(folder)`` writes its files into the folder, which is locked meanwhile.
    """
    from partialslip.cli.consoles import output
    from partialslip.tools.output.tables import print_table

    with results_folder(options, command, name, scene, *more) as (folder, elsewhere):
        found = find(folder)
        files = [*found.files]
        if scene and found.sections:
            from partialslip.report.files import write_page
            from partialslip.report.page import study_page

            html = study_page(found.title, scene, origin(options), found.sections)
            files += write_page(html, folder, pdf=options.pdf)
    console = output()
    if found.heading:
        console.print(found.heading, style="bold", soft_wrap=True, markup=False)
    for part in found.printed:
        if isinstance(part, str):
            console.print(part, soft_wrap=True, markup=False)
            continue
        if part.title:
            console.print(f"\n{part.title}", style="bold", markup=False)
        print_table(console, part.headings, part.rows, (0, *part.words))
    print_written(files, console, elsewhere)
    return found.code
