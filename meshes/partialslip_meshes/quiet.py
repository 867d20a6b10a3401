"""meshio prints what it cannot read, and what it doubts: neither is for the terminal."""

import io
import sys
import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from typing import Any

_one = threading.Lock()  # sys.stdout, sys.stderr and the filters of warnings belong to all threads


class _Caught:
    """A stream that catches what the thread that made it prints, and passes on what others do."""

    def __init__(self, said: io.StringIO, stream: Any) -> None:
        self._said, self._stream, self._thread = said, stream, threading.get_ident()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._said if threading.get_ident() == self._thread else self._stream, name)


@contextmanager
def quiet() -> Iterator[io.StringIO]:
    """Keep what this thread prints, and warnings, from the terminal; gives what was printed."""
    said = io.StringIO()
    with _one, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        out, err = _Caught(said, sys.stdout), _Caught(said, sys.stderr)
        with redirect_stdout(out), redirect_stderr(err):
            yield said
