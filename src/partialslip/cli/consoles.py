"""Consoles: tables and results on stdout, progress and messages on stderr."""

import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from typing import NoReturn

from rich.console import Console
from rich.progress import Progress

_WIDEST = 1000  # columns


class _Console(Console):
    def on_broken_pipe(self) -> NoReturn:
        """Raise BrokenPipeError again: the command line sets the exit code."""
        raise


def output() -> Console:
    """Return the console for results, stdout."""
    return _fitted(_Console(highlight=False))


def messages() -> Console:
    """Return the console for progress and messages, stderr."""
    return _fitted(_Console(stderr=True, highlight=False))


@contextmanager
def working(name: str) -> Iterator[Callable[[str], None]]:
    """Show a status line with ``name`` while the block runs, on a terminal only.

    Yields ``tell(line)``, which changes the line.
    """
    console = messages()
    spinner = "dots" if console.encoding.startswith("utf") else "line"
    with console.status(f"{name} ...", spinner=spinner) as status:
        yield lambda line: status.update(f"{name}: {line}")


@contextmanager
def shown(bar: Progress) -> Iterator[None]:
    """Show the progress ``bar`` while the block runs; print nothing if the output is not a terminal."""
    with bar if bar.console.is_interactive else nullcontext():
        yield


def _fitted(console: Console) -> Console:
    if console.width < 1:  # COLUMNS=0 means unknown
        console.width = shutil.get_terminal_size().columns
    console.width = min(console.width, _WIDEST)
    return console
