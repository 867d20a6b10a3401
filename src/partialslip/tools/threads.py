"""Small dense algebra on one BLAS thread: on busy cores, two threads are up to a hundred times slower."""

import functools
import os
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, ParamSpec, TypeVar

from threadpoolctl import OpenBLASController, ThreadpoolController

_P = ParamSpec("_P")
_T = TypeVar("_T")


class _Limit:
    """Process-wide limit of BLAS threads: the first function that enters sets it, the last that leaves restores it.
    Functions that enter meanwhile limit the libraries that were loaded since."""

    def __init__(self) -> None:
        self._lock, self._running, self._seen = threading.Lock(), 0, 0
        self._limits: list[Any] = []
        if hasattr(os, "register_at_fork"):  # the lock may be held by a thread that the child does not have
            os.register_at_fork(after_in_child=self._begin_anew)

    @contextmanager
    def held(self) -> Iterator[None]:
        """Limit BLAS to one thread."""
        with self._lock:
            if not self._running or self._seen != len(sys.modules):
                self._seen = len(sys.modules)
                _take_over()
                self._limits.append(_controller(self._seen).limit(limits=1, user_api="blas"))
            self._running += 1
        try:
            yield
        finally:
            with self._lock:
                self._running -= 1
                if not self._running:
                    _take_over()
                    while self._limits:  # the last one knows what the ones before had set
                        self._limits.pop().restore_original_limits()
                    _take_over()

    def _begin_anew(self) -> None:
        self._lock = threading.Lock()


@functools.lru_cache(maxsize=1)
def _controller(modules: int) -> ThreadpoolController:
    """Controller of the libraries that are loaded after so many ``modules``: SciPy brings a library of its own. To look
    for them takes forty times as long as to limit them."""
    del modules
    return ThreadpoolController()


def _take_over() -> None:
    """Make this thread the controlling thread of newer threadpoolctl, by default the thread of the first limit."""
    if release := getattr(OpenBLASController, "clear_controlling_thread", None):
        release(force=True)


_limit = _Limit()


def one_thread(function: Callable[_P, _T]) -> Callable[_P, _T]:
    """Decorator: run ``function`` with BLAS on one thread."""

    @functools.wraps(function)
    def limited(*args: _P.args, **kwargs: _P.kwargs) -> _T:
        with _limit.held():
            return function(*args, **kwargs)

    return limited
