"""What commands print on: tables and results on stdout, progress and messages on stderr."""

import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from typing import NoReturn

from rich.console import Console
from rich.progress import Progress

_WIDEST = 1000  # columns


class _Console(Console):
    def on_broken_pipe(self) -> NoReturn:
        """Called where BrokenPipeError is caught: leave it to the command line, which knows the exit code."""
        raise


def output() -> Console:
    """For what a command has found."""
    return _fitted(_Console(highlight=False))


def messages() -> Console:
    """For what is said while it works."""
    return _fitted(_Console(stderr=True, highlight=False))


@contextmanager
def working(name: str) -> Iterator[Callable[[str], None]]:
    """Show a line that says what is being done, where there is a person to see it; the block is given what says more
    of it."""
    console = messages()
    spinner = "dots" if console.encoding.startswith("utf") else "line"
    with console.status(f"{name} ...", spinner=spinner) as status:
        yield lambda line: status.update(f"{name}: {line}")


@contextmanager
def shown(bar: Progress) -> Iterator[None]:
    """Show a progress bar while the block runs; elsewhere than on a terminal print nothing, not even a line end."""
    with bar if bar.console.is_interactive else nullcontext():
        yield


def _fitted(console: Console) -> Console:
    if console.width < 1:  # COLUMNS=0 says that nobody knows
        console.width = shutil.get_terminal_size().columns
    console.width = min(console.width, _WIDEST)
    return console
