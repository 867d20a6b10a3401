"""Names of columns, and the units that stand beside them."""

import re

from partialslip.scene.units import LENGTHS

#: Units by name, in lower case, in SI units.
SI_FACTORS = {
    **LENGTHS, "micron": 1e-6, "microns": 1e-6, "micrometer": 1e-6, "micrometre": 1e-6, "micrometers": 1e-6,
    "micrometres": 1e-6, "millimeter": 1e-3, "millimetre": 1e-3, "millimeters": 1e-3, "millimetres": 1e-3,
    "pa": 1.0, "kpa": 1e3, "mpa": 1e6, "gpa": 1e9, "psi": 6894.757293168, "ksi": 6894757.293168,
    "n/m": 1.0, "n/mm": 1e3, "n/m^2": 1.0, "n/mm^2": 1e6, "n/mm2": 1e6, "n/m2": 1.0, "n/um^2": 1e12,
    "n/mm\N{SUPERSCRIPT TWO}": 1e6, "n/m\N{SUPERSCRIPT TWO}": 1.0,
}  # fmt: skip
_BRACKETS = re.compile(r"^(?P<name>.*?[^\s_])[\s_]*[\[({](?P<unit>[^\[\]()]*)[\])}]$")


def is_unit(text: str) -> bool:
    """Whether ``text`` is the name of a unit, with or without brackets."""
    return text.strip(" []()").lower() in SI_FACTORS


def split_unit(name: str) -> tuple[str, float | None]:
    """Split a column's name into the name and the unit, as a factor to SI units; None if there is no unit."""
    parts = _BRACKETS.match(name)
    unit = parts["unit"].strip().lower() if parts else ""
    return (parts["name"], SI_FACTORS[unit]) if parts and unit in SI_FACTORS else (name, None)
