"""The catalogue of hard cases: scenes on which contact codes may fail, reasons, and bars for each method.

Cases are grouped in families by what is hard: loads, load histories, bodies, meshes or rigs, a module each.
"""

import textwrap

from partialslip.scene.reading import load_scene, shipped_scenes
from partialslip.tools.groups import grouped
from partialslip.verify.case import Case
from partialslip.verify.hard_cases import bodies, finite, histories, loads, meshes
from partialslip.verify.hard_cases.scenes import Family

_HEAD = """# Hard cases

We expect these scenes to be hard for contact codes. For each family this page gives the reasons and the requirements.
The reasons are those of mechanics and of earlier versions of partialslip; no other code was run on these scenes: what
the page says of codes is what may happen.
`partialslip verify --suite full` runs all scenes after the shipped scenes, and `partialslip verify --suite full --only
NAME` runs one scene. The methods in brackets solve the scene. [The last section](#loads-and-what-was-measured) has the
loads of every case, and errors and cost of every method.

Unless an entry has other bars, every result must meet these requirements:

- The result is finite and certified.
- The regime is that of the reference.
- The ends of the contact and of the stick zone are within the accuracy of the scene (2e-5 of a; the last section
  lists the cases with another one), however narrow the zone is.
- Pressure is within ten times and shear within fifteen times this accuracy (relative L2 of cell averages)."""


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
    finite.plates,
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
        lines += ["\n".join(map(_listed, family.cases))]
    return "\n\n".join(lines) + "\n"


def _listed(case: Case) -> str:
    bars = grouped(
        (bar.reason, f"{key} " + ("not judged" if bar.value is None else f"{bar.value:g}"))
        for key, bar in case.bars.items()
    )
    looser = "".join(f" {', '.join(keys)}: {reason}." for reason, keys in bars.items())
    return _filled(f"- `{case.name}` ({', '.join(case.methods)}).{looser}", "  ")


def _filled(text: str, indent: str = "") -> str:
    return textwrap.fill(text, 120, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)
