"""Every public name is documented: modules, classes, functions and properties by a docstring; and of what the reference
shows, fields and parameters, too, by name in one."""

import dataclasses
import functools
import importlib
import inspect
import pkgutil
import re
from pathlib import Path

import msgspec

REFERENCE = Path(__file__).parents[1] / "docs" / "reference" / "api.md"
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


def docstring(owner, name, found):
    """The docstring of a member; what overrides another needs none of its own."""
    lines = (vars(base).get(name) for base in getattr(owner, "__mro__", ()))
    return found.__doc__ or next((line.__doc__ for line in lines if line is not None and line.__doc__), None)


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
                    doc = docstring(found, below, method)
                    yield f"{where}.{below}", "", doc
                    if not is_property and method.__doc__:
                        yield from parameters(f"{where}.{below}", method)


def parameters(where, function):
    names = [name for name in inspect.signature(function).parameters if name not in ("self", "cls")]
    return ((f"{where}({name})", name, function.__doc__) for name in names if not name.startswith("_"))


def shown():
    """Names that the reference shows one by one, as they are called where they are defined."""
    text, found = REFERENCE.read_text("utf-8"), set()
    for module, entries in re.findall(
        r"^\.\. currentmodule:: (\S+)\n(.*?)(?=^\.\. currentmodule|^```)", text, re.M | re.S
    ):
        for name in re.findall(r"^\.\. auto(?:function|class):: (\w+)$", entries, re.M):
            value = getattr(importlib.import_module(module), name)
            found.add(f"{value.__module__}.{value.__qualname__}")
    return found


def undocumented(items):
    return [what for what, name, doc in items if not doc or (name and not says(doc, name))]


def test_all_names_have_docstrings():
    names = [item for item in public() if not item[1]]
    assert len(names) > 500
    assert undocumented(names) == []


def test_fields_and_parameters_of_the_reference_are_named():
    of = shown()
    items = [item for item in public() if item[1]]
    owners = {what: re.split(r"\(", what)[0] for what, _, _ in items}
    chosen = [item for item in items if owners[item[0]] in of or owners[item[0]].rpartition(".")[0] in of]
    assert len(chosen) > 150
    assert undocumented(chosen) == []


def test_missing_docstrings_are_noticed():
    def halved(force):
        """Half of it."""

    assert undocumented([("force", "force", halved.__doc__)]) == ["force"]
    assert undocumented([("force", "force", "Half of ``force``, N.")]) == []
    assert undocumented([("force", "force", "Half of it.\n\nParameters\n----------\nP, force : float\n    N.")]) == []
