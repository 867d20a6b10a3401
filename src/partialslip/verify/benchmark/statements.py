"""Statements: tasks with closed targets that need no scene of partialslip, such as a patch, a wedge, a hold, a restart,
and spheres. One file each; the grader is that of the problems."""

import math
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import Any

import msgspec

from partialslip.scene.reading import parse_toml
from partialslip.scene.units import Dimension
from partialslip.verify.benchmark.problem import Source, Target

_UNSURE = 1e-12  # accuracy: of a closed formula in double precision, in the scale


class Asked(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A target: ``formula`` and ``scale`` in the data and the targets before it, ``unit`` and ``group``."""

    formula: str
    unit: Dimension
    scale: str
    group: str


class Statement(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A task: ``title``, ``statement``, the ``data`` that it names, SI units, ``targets`` and ``sources``."""

    title: str
    statement: str
    data: dict[str, float]
    targets: dict[str, Asked]
    sources: tuple[Source, ...] = ()
    number: str = ""

    @property
    def measured(self) -> Mapping[str, Target]:
        """Targets with their values."""
        known: dict[str, Any] = {"sqrt": math.sqrt, "pi": math.pi, **self.data}
        found = {}
        for key, asked in self.targets.items():
            known[key] = float(eval(asked.formula, {"__builtins__": {}}, known))  # of a file of the package
            scale = float(eval(asked.scale, {"__builtins__": {}}, known))
            found[key] = Target(
                value=known[key],
                unit=asked.unit,
                scale=scale,
                uncertainty=_UNSURE,
                known=asked.formula,
                group=asked.group,
            )
        return found


@cache
def read_statements() -> dict[str, Statement]:
    """All statements by number, ST-01 and so on."""
    folder = files("partialslip.verify.benchmark") / "statements"
    found = {}
    for entry in sorted(folder.iterdir(), key=lambda entry: entry.name):
        if entry.name.endswith(".toml"):
            number = entry.name.removesuffix(".toml")
            read = msgspec.convert(parse_toml(entry.read_text("utf-8"), entry.name), Statement)
            found[number] = msgspec.structs.replace(read, number=number)
    return found
