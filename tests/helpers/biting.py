"""A deliberate fault proves something only while the program still asks for what the fault patches."""

import contextlib
import functools
import pkgutil
from types import FunctionType

import pytest


@contextlib.contextmanager
def biting():
    """Fail if a name that is patched here with ``monkeypatch.setattr`` does not exist, or if a function or property put
    in its place is never called before the end.

    Constants cannot be counted. A fault that patches a constant is seen by its check alone, which passes without it.
    """
    true, patched = pytest.MonkeyPatch.setattr, []

    def setattr_counted(self, target, *name_and_value):
        if isinstance(target, str):
            path, _, name = target.rpartition(".")
            target, (value,) = pkgutil.resolve_name(path), name_and_value
        else:
            name, value = name_and_value
        if not hasattr(target, name):
            pytest.fail(f"the deliberate fault patches {_full(target, name)}, which does not exist", pytrace=False)
        calls = []
        if _is_counted(value):
            patched.append((_full(target, name), calls))
        true(self, target, name, _counted(value, calls))

    with pytest.MonkeyPatch.context() as outer:
        true(outer, pytest.MonkeyPatch, "setattr", setattr_counted)
        yield
    if idle := [name for name, calls in patched if not calls]:
        pytest.fail(f"the deliberate fault patches {', '.join(idle)}, which nothing has called", pytrace=False)


def _full(target, name):
    if isinstance(target, type):
        return f"{target.__module__}.{target.__qualname__}.{name}"
    return f"{getattr(target, '__name__', target)}.{name}"


def _is_counted(value):
    return isinstance(value, FunctionType | functools.partial | property)


def _counted(value, calls):
    """``value``, which adds to ``calls`` whenever it is called or, if it is a property, read."""
    if isinstance(value, property):
        return property(_counted(value.fget, calls))
    if not _is_counted(value):
        return value

    def called(*args, **kwargs):
        calls.append(None)
        return value(*args, **kwargs)

    return functools.update_wrapper(called, value)
