"""Every public name is documented: modules, classes, functions and properties by a docstring, fields and parameters by
name in it."""

import dataclasses
import functools
import importlib
import inspect
import pkgutil
import re

import msgspec
import pytest

PACKAGES = ("partialslip", "partialslip_fem", "partialslip_meshes")


def modules():
    """All modules of the packages, public and private, but for those that run when they are imported."""
    for package in PACKAGES:
        top = importlib.import_module(package)
        yield top
        for found in pkgutil.walk_packages(top.__path__, f"{package}."):
            if not found.name.endswith("__main__"):
                yield importlib.import_module(found.name)


def members(owner):
    """Public names that are defined in a module or a class, as (name, object); functions without what wraps them."""
    for name, value in vars(owner).items():
        found = value.__func__ if isinstance(value, (staticmethod, classmethod)) else value
        found = found.func if isinstance(found, functools.cached_property) else found
        found = found.fget if isinstance(found, property) else inspect.unwrap(found)
        if name.startswith("_") or not (inspect.isclass(found) or inspect.isfunction(found)):
            continue
        home = owner.__name__ if inspect.ismodule(owner) else owner.__module__
        if getattr(found, "__module__", None) == home:
            yield name, found, isinstance(value, (property, functools.cached_property))


def fields(kind):
    """Names of the public fields of a record that are its own, not inherited."""
    if dataclasses.is_dataclass(kind):
        names = [field.name for field in dataclasses.fields(kind)]
    elif issubclass(kind, msgspec.Struct):
        names = list(kind.__struct_fields__)
    else:
        names = list(getattr(kind, "_fields", ()))
    own = vars(kind).get("__annotations__", {})
    return [name for name in names if name in own and not name.startswith("_")]


def says(doc, name):
    """Whether a docstring names a field or parameter: in double backticks or in a list of parameters."""
    return bool(re.search(rf"``[^`]*\b{name}\b[^`]*``|^\s*(?:\*?\w+, )*\*{{0,2}}{name}(?:, \w+)*(?: :.*)?$", doc, re.M))


def public():
    """All there is to document, as (what, how it is named, its docstring or the one that should name it)."""
    for module in modules():
        yield module.__name__, "", module.__doc__
        for name, found, _ in members(module):
            where = f"{module.__name__}.{name}"
            yield where, "", found.__doc__
            if inspect.isfunction(found):
                yield from parameters(where, found)
            else:
                yield from ((f"{where}.{field}", field, found.__doc__) for field in fields(found))
                for below, method, is_property in members(found):
                    yield f"{where}.{below}", "", method.__doc__
                    if not is_property:
                        yield from parameters(f"{where}.{below}", method)


def parameters(where, function):
    names = [name for name in inspect.signature(function).parameters if name not in ("self", "cls")]
    return ((f"{where}({name})", name, function.__doc__) for name in names if not name.startswith("_"))


if __name__ == "__main__":
    missing = {}
    count = {}
    for what, name, doc in public():
        kind = "param" if "(" in what else "field" if name else "name"
        count[kind] = count.get(kind, 0) + 1
        if not doc or (name and not says(doc, name)):
            missing.setdefault(kind, []).append(what)
    for kind in count:
        print(kind, count[kind], len(missing.get(kind, [])))
    for kind in ("name", "field", "param"):
        print(kind, *missing.get(kind, []), sep="\n   ")
