"""Keep the messages and warnings that meshio prints from the terminal."""

import io
import sys
import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from typing import Any

_one = threading.Lock()  # sys.stdout, sys.stderr and the warning filters are shared by all threads


class _Caught:
    """A stream that collects the output of its own thread and passes on the output of other threads."""

    def __init__(self, printed: io.StringIO, stream: Any) -> None:
        self._printed, self._stream, self._thread = printed, stream, threading.get_ident()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._printed if threading.get_ident() == self._thread else self._stream, name)


@contextmanager
def quiet() -> Iterator[io.StringIO]:
    """Collect the output of this thread and suppress warnings; yields the stream with the output."""
    printed = io.StringIO()
    with _one, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        out, err = _Caught(printed, sys.stdout), _Caught(printed, sys.stderr)
        with redirect_stdout(out), redirect_stderr(err):
            yield printed
