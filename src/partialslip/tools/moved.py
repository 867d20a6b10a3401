"""Module names of version 1.0, deprecated: ``partialslip.fatigue`` is ``partialslip.study.fatigue`` now."""

import importlib
import sys
import warnings
from importlib.machinery import ModuleSpec
from types import ModuleType

_MOVED = {
    "run": "judge methods",
    "report": "record",
    "codes": "score export",
    "study": "batch map live fatigue",
    "verify": "benchmark",
    "march": "equivalent",
    "result": "rig",
    "scene": "plan gradual units",
    "tools": (
        "allowance bars arrays errors groups threads telling frame shown strictjson inputfile seal origin "
        "convergence output"
    ),
}
NEW_NAMES = {name: f"{folder}.{name}" for folder, names in _MOVED.items() for name in names.split()}


class _SameModule:
    """Gives the module under its new name."""

    def __init__(self, name: str) -> None:
        self.name = name

    def create_module(self, spec: ModuleSpec) -> ModuleType:  # noqa: ARG002
        module = importlib.import_module(self.name)
        self.spec = module.__spec__
        return module

    def exec_module(self, module: ModuleType) -> None:
        module.__spec__ = self.spec  # importlib has put that of the old name there


class MovedNames:
    """Finds ``partialslip.<old name>`` under its new name, and warns once for each place of use."""

    def find_spec(self, fullname: str, *_: object) -> ModuleSpec | None:
        """Return the module under its new name; None for all other names."""
        package, __, rest = fullname.partition(".")
        old, dot, deeper = rest.partition(".")
        if package != "partialslip" or old not in NEW_NAMES:
            return None
        new = f"partialslip.{NEW_NAMES[old]}{dot}{deeper}"
        warnings.warn(f"{fullname} is now {new}", DeprecationWarning, stacklevel=2)
        return ModuleSpec(fullname, _SameModule(new))  # type: ignore[arg-type]  # importlib.abc imports slowly


def keep_old_names() -> None:
    """Let old module names be imported."""
    if not any(isinstance(each, MovedNames) for each in sys.meta_path):
        sys.meta_path.insert(0, MovedNames())  # before the path is searched: each module once
