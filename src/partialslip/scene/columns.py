"""Names of columns, and the units that stand beside them."""

import re

from partialslip.scene.units import LENGTHS, Dimension

#: Lengths by name, in lower case, m.
LENGTH_WORDS = {
    **LENGTHS, **dict.fromkeys(("micron", "microns"), 1e-6),
    **{f"{prefix}met{end}": size for prefix, size in {"micro": 1e-6, "milli": 1e-3, "nano": 1e-9}.items()
       for end in ("er", "re", "ers", "res")},
}  # fmt: skip
#: Units by name, in lower case, in SI units.
SI_FACTORS = {
    **LENGTH_WORDS,
    "pa": 1.0, "kpa": 1e3, "mpa": 1e6, "gpa": 1e9, "psi": 6894.757293168, "ksi": 6894757.293168,
    "n/m": 1.0, "n/mm": 1e3, "n/m^2": 1.0, "n/mm^2": 1e6, "n/mm2": 1e6, "n/m2": 1.0, "n/um^2": 1e12,
    "n/mm\N{SUPERSCRIPT TWO}": 1e6, "n/m\N{SUPERSCRIPT TWO}": 1.0,
}  # fmt: skip
_BRACKETS = re.compile(r"^(?P<name>.*?[^\s_])[\s_]*[\[({](?P<unit>[^\[\]()]*)[\])}]$")
# a unit of one letter, or one that is a word, stands behind a slash only
_BEHIND = re.compile(
    r"^(?P<name>[^/]*?[^\s/_])(?:\s*/\s*(?P<unit>\S+)|(?:\s+in\s+|[\s_])(?P<other>(?!in$)[^\s_]{2,}))$", re.I
)


def is_unit(text: str) -> bool:
    """Whether ``text`` is the name of a unit, with or without brackets."""
    return text.strip(" []()").lower() in SI_FACTORS


def split_unit(name: str) -> tuple[str, float | None]:
    """Split a column's name into the name and the unit, as a factor to SI units; None if there is no unit. The unit is
    in brackets, or behind a slash, an underscore or a blank."""
    own, unit = _parted(name)
    return (own, SI_FACTORS[unit]) if unit in SI_FACTORS else (name, None)


def dimension_of(name: str) -> Dimension | None:
    """Dimension of the unit that a column's name states; None if there is none that is known."""
    _, unit = _parted(name)
    if unit not in SI_FACTORS:
        return None
    return "m" if unit in LENGTH_WORDS else "N/m" if unit in ("n/m", "n/mm") else "Pa"


def unknown_unit(name: str) -> str:
    """What stands in brackets behind a column's name and is no known unit; empty if there is none."""
    parts = _BRACKETS.match(name)
    unit = parts["unit"].strip() if parts else ""
    return unit if any(map(str.isalpha, unit)) and unit.lower() not in SI_FACTORS else ""


def _parted(name: str) -> tuple[str, str]:
    """A column's name and what may be its unit, in lower case."""
    parts = _BRACKETS.match(name) or _BEHIND.match(name)
    if not parts:
        return name, ""
    return parts["name"], (parts["unit"] or parts.groupdict().get("other") or "").strip().lower()


def place_of(name: str, names: list[str]) -> int | None:
    """Index of the column ``name``, with or without unit, or number from 1, among ``names``; None if there is none, or
    more than one."""
    places = [k for k, each in enumerate(names) if name in (each, split_unit(each)[0])]
    places = places or [k for k, each in enumerate(names) if name.lower() == each.lower()]
    if not places and name.isdecimal() and 1 <= int(name) <= len(names):
        places = [int(name) - 1]
    return places[0] if len(places) == 1 else None
