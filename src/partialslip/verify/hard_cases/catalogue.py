"""The catalogue of hard cases: scenes on which contact codes fail, reasons, and bars for each method.

Cases are grouped in families, a module each with a ``TITLE``, the reason ``HARD`` and ``cases()``.
"""

import textwrap
from dataclasses import dataclass, replace
from typing import Any

from partialslip.scene.reading import load_scene, shipped_scenes
from partialslip.verify.case import Case
from partialslip.verify.hard_cases import (
    beside,
    cycles,
    few_nodes,
    friction,
    huge_tension,
    mean_loads,
    meshes,
    mirrored,
    near_sliding,
    near_stuck,
    no_shear,
    no_tension,
    poisson,
    sharp,
    transition,
    turning,
    varying_pressure,
)

_HEAD = """# Hard cases

These scenes make contact codes fail. For each family of scenes this page gives the reason and the requirements.
`partialslip verify --suite full` runs all scenes after the shipped scenes, and `partialslip verify --suite full --only
NAME` runs one scene. The methods in brackets solve the scene.

Unless an entry has other bars, every result must meet these requirements:

- The result is finite and certified.
- The regime is that of the exact solution.
- The ends of the contact and of the stick zone are within the accuracy of the scene (2e-5 of a), however narrow the
  zone is.
- Pressure is within ten times and shear within fifteen times this accuracy (relative L2 of cell averages)."""


_FAMILIES = {
    "near-sliding": near_sliding,
    "near-stuck": near_stuck,
    "transition": transition,
    "huge-tension": huge_tension,
    "no-shear": no_shear,
    "no-tension": no_tension,
    "beside": beside,
    "poisson": poisson,
    "friction": friction,
    "sharp": sharp,
    "mean-loads": mean_loads,
    "cycles": cycles,
    "varying-pressure": varying_pressure,
    "few-nodes": few_nodes,
    "meshes": meshes,
    "mirrored": mirrored,
    "turning": turning,
}


@dataclass(frozen=True)
class Family:
    """Cases that are hard for one common reason.

    Parameters
    ----------
    name, title : str
    hard : str
        Why the cases are hard, and how other codes fail.
    cases : tuple of Case
    """

    name: str
    title: str
    hard: str
    cases: tuple[Case, ...]


def shipped() -> list[Case]:
    """Return the shipped scenes as cases, by every method, with the usual bars."""
    return [Case(name, load_scene(name)) for name in shipped_scenes()]


def families() -> list[Family]:
    """Return the whole catalogue."""
    return [_family(name, module) for name, module in _FAMILIES.items()]


def _family(name: str, module: Any) -> Family:
    hard = " ".join(module.HARD.split())
    return Family(name, module.TITLE, hard, tuple(replace(case, hard=hard) for case in module.cases()))


def hard_cases() -> list[Case]:
    """Return the cases of all families."""
    return [case for family in families() for case in family.cases]


def document() -> str:
    """Return the catalogue as Markdown, the text of docs/hard-cases.md."""
    lines = [_HEAD]
    for family in families():
        lines += [f"## {family.title}", _filled(family.hard)]
        lines += ["\n".join(map(_listed, family.cases))]
    return "\n\n".join(lines) + "\n"


def _listed(case: Case) -> str:
    bars: dict[str, list[str]] = {}
    for key, bar in case.bars.items():
        bars.setdefault(bar.reason, []).append(f"{key} " + ("not judged" if bar.value is None else f"{bar.value:g}"))
    looser = "".join(f" {', '.join(keys)}: {reason}." for reason, keys in bars.items())
    return _filled(f"- `{case.name}` ({', '.join(case.methods)}).{looser}", "  ")


def _filled(text: str, indent: str = "") -> str:
    return textwrap.fill(text, 120, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)
