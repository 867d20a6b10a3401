"""Module names of version 1.0, deprecated: ``partialslip.fatigue`` is ``partialslip.study.fatigue`` now."""

import importlib
import sys
import warnings
from importlib.machinery import ModuleSpec
from types import ModuleType

_MOVED = {
    "run": "judge",
    "report": "record",
    "codes": "score export",
    "study": "batch map live fatigue",
    "march": "equivalent",
    "result": "rig",
    "scene": "plan gradual units",
    "tools": (
        "allowance bars arrays errors groups threads telling frame shown strictjson inputfile seal origin "
        "convergence output methods"
    ),
}
NEW_NAMES = {name: f"{folder}.{name}" for folder, names in _MOVED.items() for name in names.split()}
_MERGED = {  # modules that became part of another one
    "codes.export.inp": "codes.export: abaqus calculix inp_lines",
    "result.below": "result: piecewise",
    "result.cost": "result: memory",
    "result.rig": "result.rig: file rig",
    "run.judge.measures": "run.judge: means",
    "run.judge.reference": "run.judge: known",
    "run.judge.verdicts": "run.judge: verdict outcome estimates",
    "scene.measured": "scene: points",
    "scene.reading": "scene: writing",
    "study.cost": "study.cost: ladder figure",
    "study.effects": "study.effects: worth figure",
    "study.fatigue.assessment": "study.fatigue: accuracy",
    "study.fatigue.criteria": "study.fatigue: invariants",
    "study.fatigue.page": "study.fatigue: of_run",
    "study.live": "study.live: page",
    "study.map.figure": "study.map: varying_figure",
    "verify.benchmark.book": "verify.benchmark: figure",
    "verify.benchmark.scoreboard": "verify.benchmark: badge",
    "verify.hard_cases": "verify.hard_cases: scenes",
    "verify.hard_cases.bodies": "verify.hard_cases: finite",
}
_NEW_MODULES = {
    f"{folder}.{name}": new
    for new, told in _MERGED.items()
    for folder, _, names in [told.partition(": ")]
    for name in names.split()
}


def new_name(old: str) -> str:
    """Return the name under ``partialslip`` of what was the module ``old``; the same name if it has not moved."""
    first, dot, deeper = old.partition(".")
    moved = f"{NEW_NAMES.get(first, first)}{dot}{deeper}"
    return _NEW_MODULES.get(moved, moved)


class _Keeping(ModuleType):
    """A module whose functions keep their names when a former module of the same name is imported."""

    def __setattr__(self, name: str, value: object) -> None:
        if not (isinstance(value, ModuleType) and callable(vars(self).get(name))):
            super().__setattr__(name, value)


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

    def find_spec(self, fullname: str, *__: object) -> ModuleSpec | None:
        """Return the module under its new name; None for all other names."""
        package, _, old = fullname.partition(".")
        new = f"{package}.{new_name(old)}"
        if package != "partialslip" or new == fullname:
            return None
        parent, _, child = fullname.rpartition(".")
        holds = sys.modules[parent]
        if type(holds) is ModuleType and callable(vars(holds).get(child)):
            holds.__class__ = _Keeping
        warnings.warn(f"{fullname} is now {new}", DeprecationWarning, stacklevel=2)
        return ModuleSpec(fullname, _SameModule(new))  # type: ignore[arg-type]  # importlib.abc imports slowly


def keep_old_names() -> None:
    """Let old module names be imported."""
    if not any(isinstance(each, MovedNames) for each in sys.meta_path):
        sys.meta_path.insert(0, MovedNames())  # before the path is searched: each module once
