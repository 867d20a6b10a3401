"""Units in which people read and write quantities: SI, or N, mm and MPa. All Python objects hold SI units."""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, TypeVar, get_args

from partialslip.tools.arrays import Array

System = Literal["SI", "N-mm"]
Dimension = Literal["m", "Pa", "Pa/m", "Pa^2 m", "N/m", "N", "J/m", "1"]
"""A dimension by its SI unit: length, stress, stress over length, stress squared times length, force, moment and energy
per unit depth, and pure numbers."""

_DIMENSIONS: tuple[Dimension, ...] = get_args(Dimension)
_T = TypeVar("_T", float, Array)
_LABELLED = re.compile(r"(?<=\d) (N/m|m|Pa)(?![\w/])")
# fixed: Lengths by the names, in lower case, that tables give in brackets, m.
LENGTHS = {
    "m": 1.0, "mm": 1e-3, "um": 1e-6, "\N{MICRO SIGN}m": 1e-6, "\N{GREEK SMALL LETTER MU}m": 1e-6, "nm": 1e-9,
    "cm": 1e-2, "in": 0.0254,
}  # fmt: skip
PREFIXES = ((9, "G"), (6, "M"), (3, "k"), (0, ""), (-3, "m"), (-6, "µ"), (-9, "n"))


@dataclass(frozen=True)
class Units:
    """A system of units.

    Parameters
    ----------
    name : str
    words : str
        The system in words.
    units : dict of str to (str, int)
        By dimension, the label of the unit and its size, as a power of ten of the SI unit.
    """

    name: str
    words: str
    units: Mapping[Dimension, tuple[str, int]]

    @property
    def identifier(self) -> str:
        """The name in capitals and underscores, as decks of other codes allow."""
        return self.name.upper().replace("-", "_")

    def label(self, of: Dimension) -> str:
        """Return the label of the unit of dimension ``of``."""
        return self.units[of][0]

    def size(self, of: Dimension) -> float:
        """Return the unit of dimension ``of`` in SI units."""
        return float(f"1e{self.units[of][1]}")

    def from_si(self, value: _T, of: Dimension) -> _T:
        """Convert ``value``, a number or an array of dimension ``of``, from SI units."""
        return _shifted(value, -self.units[of][1])

    def to_si(self, value: _T, of: Dimension) -> _T:
        """Convert ``value``, a number or an array of dimension ``of``, to SI units."""
        return _shifted(value, self.units[of][1])

    def relabelled(self, text: str) -> str:
        """Return a message that a check has written with SI labels, of numbers in this system, with its own labels."""
        return _LABELLED.sub(lambda found: f" {self.units[found[1]][0]}", text)  # type: ignore[index]

    def heading(self, name: str, of: Dimension) -> str:
        """Return the heading of a column of a CSV file: ``name``, with the unit in brackets unless SI."""
        return name if self == SI or of == "1" else f"{name} [{self.label(of)}]"

    def text(self, value: float, of: Dimension, digits: int) -> str:
        """Return ``value``, in SI units, as text with the unit and ``digits`` significant digits; SI with prefixes."""
        if self == SI:
            return engineering(value, self.label(of), digits)
        return self.labelled(value, of, digits)

    def labelled(self, value: float, of: Dimension, digits: int = 6) -> str:
        """Return ``value``, in SI units, as text with the unit, without prefix."""
        return f"{self.plain(value, of, digits)} {self.label(of)}"

    def plain(self, value: float, of: Dimension, digits: int = 6) -> str:
        """Return ``value``, in SI units, as text without unit or prefix."""
        return f"{self.from_si(value, of):.{digits}g}"

    def span(self, values: Sequence[float], of: Dimension) -> str:
        """Return the least and the largest of ``values``, in SI units, as text with the unit."""
        return f"{self.plain(min(values), of)} and {self.labelled(max(values), of)}"

    def length(self, a: float) -> str:
        """Return a length ``a``, m, as text: in mm; in SI below 1e-6 m and from 1 m on with another prefix."""
        if self != SI or 1e-6 <= a < 1:
            return f"{a * 1e3:.7g} mm"
        return engineering(a, "m", 7)


def _newton(name: str, words: str, length: str, stress: str, energy: str, power: int) -> Units:
    """Make a consistent system of N and the unit ``length``, 10**power m."""
    sizes = {
        "m": power,
        "Pa": -2 * power,
        "Pa/m": -3 * power,
        "Pa^2 m": -3 * power,
        "N/m": -power,
        "N": 0,
        "J/m": 0,
        "1": 0,
    }
    labels = {
        "m": length,
        "Pa": stress,
        "Pa/m": f"{stress}/{length}",
        "Pa^2 m": f"{'(' + stress + ')' if '/' in stress else stress}^2 {length}",
        "N/m": f"N/{length}",
        "N": "N",
        "J/m": energy,
        "1": "",
    }
    return Units(name, words, {of: (labels[of], sizes[of]) for of in _DIMENSIONS})


SI = _newton("SI", "SI units", "m", "Pa", "J/m", 0)
N_MM = _newton("N-mm", "N, mm and MPa", "mm", "MPa", "N mm/mm", -3)
N_UM = _newton("N-um", "N, um and N/um^2", "um", "N/um^2", "N um/um", -6)
N_NM = _newton("N-nm", "N, nm and N/nm^2", "nm", "N/nm^2", "N nm/nm", -9)
SYSTEMS = (SI, N_MM, N_UM, N_NM)  # from the largest unit of length on
UNITS: Mapping[str, Units] = {each.name: each for each in (SI, N_MM)}  # of scenes


def engineering(number: float, unit: str, digits: int) -> str:
    """Return ``number`` in ``unit`` with a suitable SI prefix and ``digits`` significant digits."""
    number = float(f"{number:.12g}")  # 1 - 1e-16 must become 1, not 1000 m
    for exponent, prefix in PREFIXES:
        if 1 <= abs(number) / 10.0**exponent < 1000:
            return f"{number / 10.0**exponent:.{digits}g} {prefix}{unit}"
    return f"{number:.4g} {unit}"


def _shifted(value: _T, power: int) -> _T:
    """Return ``value`` times ten to the ``power``.

    Of a number the decimal point moves: 0.3 mm becomes the number that 0.3e-3 is in a file, bit for bit.
    """
    if not power:
        return value
    if isinstance(value, (int, float)):
        digits, _, exponent = repr(float(value)).partition("e")
        return float(f"{digits}e{int(exponent or 0) + power}") if math.isfinite(value) else value
    return value * 10.0**power if power >= 0 else value / 10.0**-power
