"""The catalogue of hard cases: scenes on which contact codes may fail, reasons, and bars for each method.

Cases are grouped in families by what is hard: loads, load histories, bodies or meshes, a module each.
"""

import textwrap
from collections.abc import Iterable, Iterator

from partialslip.scene.reading import load_scene, shipped_scenes
from partialslip.tools.groups import grouped
from partialslip.verify.case import Case
from partialslip.verify.hard_cases import Family, bodies, histories, loads, meshes

_HEAD = """# Hard cases

Scenes that are hard for contact codes, in families with one reason each. The reasons come from mechanics and from the
development of partialslip. No other code was run on these scenes: what is said of codes may happen.

`partialslip verify --suite full` runs all scenes, after the shipped ones; `--only NAME` runs one. Brackets name the
methods that solve the scene. [The last section](#loads-and-what-was-measured) has loads, errors and costs.

Unless an entry has other bars, every result must

- be finite and certified, and have the regime of the reference;
- have the ends of the contact and of the stick zone within the accuracy of the scene (2e-5 of a, but for the cases
  listed in the last section), however narrow the zone is;
- have pressure within ten times and shear within fifteen times this accuracy (relative L2 of cell averages)."""


FAMILIES: tuple[Family, ...] = (  # in the order of the page
    loads.near_sliding,
    loads.near_stuck,
    loads.at_transition,
    loads.huge_tension,
    loads.no_shear,
    loads.no_tension,
    loads.beside,
    bodies.poisson,
    bodies.friction,
    bodies.sharp,
    bodies.unlike_punches,
    histories.mean_loads,
    histories.cycles,
    histories.varying_pressure,
    meshes.few_nodes,
    meshes.poor_meshes,
    loads.uneven_friction,
    loads.mirrored,
    histories.turning,
    bodies.plates,
)


def shipped() -> list[Case]:
    """Return the shipped scenes as cases, by every method, with the usual bars."""
    return [Case(name, load_scene(name)) for name in shipped_scenes()]


def hard_cases() -> list[Case]:
    """Return the cases of all families."""
    return [case for family in FAMILIES for case in family.cases]


def catalogue_page() -> str:
    """Return the catalogue as Markdown, the first part of docs/hard-cases.md."""
    lines = [_HEAD]
    for family in FAMILIES:
        lines += [f"## {family.title}", _filled(family.hard)]
        lines += ["\n".join(_case_items(family.cases))]
    return "\n\n".join(lines) + "\n"


def _case_items(cases: Iterable[Case]) -> Iterator[str]:
    """Yield items of a list: names of ``cases`` with the same methods and bars, the methods, the bars."""
    for told, names in grouped((_judged(case), f"`{case.name}`") for case in cases).items():
        yield _filled(f"- {', '.join(names)} {told}", "  ")


def _judged(case: Case) -> str:
    bars = grouped(
        (bar.reason, f"{key} " + ("not judged" if bar.value is None else f"{bar.value:g}"))
        for key, bar in case.bars.items()
    )
    looser = "".join(f" {', '.join(keys)}: {reason}." for reason, keys in bars.items())
    return f"({', '.join(case.methods)}).{looser}"


def _filled(text: str, indent: str = "") -> str:
    return textwrap.fill(text, 120, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)
