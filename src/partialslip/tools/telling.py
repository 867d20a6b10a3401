"""What a method is doing now, told from deep inside it: the load step of a long path, within one mesh."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

EVERY = 0.2  # display: s between two lines; telling each of many short steps would take as long as they do


class _Teller:
    """Passes on lines to ``progress``, the first and then not more often than ``EVERY`` seconds."""

    def __init__(self, progress: Callable[[str], None]) -> None:
        self._progress, self._last = progress, -EVERY

    def __call__(self, line: str) -> None:
        now = time.monotonic()
        if now - self._last >= EVERY:
            self._last = now
            self._progress(line)


_teller: ContextVar[_Teller | None] = ContextVar("teller", default=None)


@contextmanager
def told_to(progress: Callable[[str], None]) -> Iterator[None]:
    """Pass on what is told while the block runs, in this thread, to ``progress``."""
    token = _teller.set(_Teller(progress))
    try:
        yield
    finally:
        _teller.reset(token)


def tell(line: str) -> None:
    """Tell what is being done now; nobody need listen."""
    if teller := _teller.get():
        teller(line)
