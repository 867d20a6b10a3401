"""Packages whose names are imported when they are used first, so that importing one name does not import all."""

import importlib
import sys
from collections.abc import Mapping
from types import ModuleType
from typing import Any


class Lazy(ModuleType):
    """A package whose public names are in ``_homes``, by name the module that defines it. A function keeps its name
    when the module of the same name is imported (``run``, ``plan``)."""

    _homes: Mapping[str, str]

    def __setattr__(self, name: str, value: Any) -> None:
        if not (name in self._homes and isinstance(value, ModuleType)):
            super().__setattr__(name, value)

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self._homes})

    def __getattr__(self, name: str) -> Any:
        if name not in self._homes:
            raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}")
        value = getattr(importlib.import_module(f"{self.__name__}.{self._homes[name]}"), name)
        setattr(self, name, value)
        return value


def homes_of(names: Mapping[str, str]) -> dict[str, str]:
    """The module of each name, from the ``names`` of each module, separated by blanks."""
    return {name: module for module, some in names.items() for name in some.split()}


def make_lazy(package: str, homes: Mapping[str, str], kind: type[Lazy] = Lazy) -> None:
    """Let the ``package`` import each name of ``homes``, from the module named there, when it is used first."""
    module = sys.modules[package]
    vars(module)["_homes"] = homes
    module.__class__ = kind
