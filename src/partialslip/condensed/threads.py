"""Small dense algebra on one thread: two threads on two busy cores make it up to a hundred times slower."""

import functools
from collections.abc import Callable
from typing import ParamSpec, TypeVar

import scipy.linalg  # noqa: F401 - the controller sees the libraries that are loaded by now
from threadpoolctl import ThreadpoolController

_CONTROLLER = ThreadpoolController()
_P = ParamSpec("_P")
_T = TypeVar("_T")


def one_thread(function: Callable[_P, _T]) -> Callable[_P, _T]:
    """Decorator: run ``function`` with BLAS on one thread."""

    @functools.wraps(function)
    def limited(*args: _P.args, **kwargs: _P.kwargs) -> _T:
        with _CONTROLLER.limit(limits=1):
            return function(*args, **kwargs)

    return limited
