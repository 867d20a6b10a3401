"""Consoles: tables and results on stdout, progress and messages on stderr.

Progress is a line that changes on a terminal. In a log it is a new line at an event, but at most one every few seconds,
so that short commands write none.
"""

import math
import shutil
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import NoReturn

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

EVERY = 5.0  # display: s between lines of progress in a log
_WIDEST = 1000  # display: columns


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
    """Show progress of the work on ``name`` while the block runs.

    Yields ``tell(line)``, which shows what is done now.
    """
    console = messages()
    if not _live(console):
        yield _Log(name, console)
        return
    spinner = "dots" if console.encoding.startswith("utf") else "line"
    with console.status(f"{name} ...", spinner=spinner) as status:
        yield lambda line: status.update(f"{name}: {line}")


@contextmanager
def counting(name: str, closing: str = "") -> Iterator[Callable[[int, int, float], None]]:
    """Show how many cases of ``name`` are done while the block runs.

    Yields ``progress(done, total, seconds_left)``. The first call starts the bar: input errors come before.
    ``closing`` is the work after the last case.
    """
    console = messages()
    columns = (
        TextColumn(name),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("{task.fields[left]}"),
    )
    bar = Progress(*columns, console=console, transient=True)
    task = bar.add_task("", total=None, left="")
    log = None if _live(console) else _Log(name, console)
    began = False
    with ExitStack() as running:

        def progress(done: int, total: int, left: float) -> None:
            nonlocal began
            if not began and not log:
                running.enter_context(bar)
            if not began and done:
                console.print(f"{done} case{'s were' if done > 1 else ' was'} finished before", markup=False)
            began = True
            text = closing if done == total else "" if math.isnan(left) else f"{left:.0f} s left"
            if log:
                log(", ".join(filter(None, [f"{done:,} of {total:,} cases", text])))
            else:
                bar.update(task, completed=done, total=total, left=text)

        yield progress


class _Log:
    """Print lines of progress on ``console``, not more often than every ``EVERY`` seconds."""

    def __init__(self, name: str, console: Console) -> None:
        self._name, self._console = name, console
        self._began = self._last = time.monotonic()

    def __call__(self, line: str) -> None:
        now = time.monotonic()
        if now - self._last >= EVERY:
            self._last = now
            text = f"{self._name}: {line} ({now - self._began:.0f} s)"
            self._console.print(text, soft_wrap=True, markup=False)


def _live(console: Console) -> bool:
    """Return whether lines of ``console`` can change: FORCE_COLOR asks for colours in a log, not for that."""
    return console.is_interactive and console.file.isatty()


def _fitted(console: Console) -> Console:
    if console.width < 1:  # COLUMNS=0 means unknown
        console.width = shutil.get_terminal_size().columns
    console.width = min(console.width, _WIDEST)
    return console
