"""Header lines of tables: quantity and unit of each column, by the names of this package and of other codes."""

import re
from collections.abc import Mapping
from typing import NamedTuple

from partialslip.scene.units import LENGTHS, Dimension
from partialslip.tools.errors import InputError

NORMAL = ("p", "Fn")
FIRST = {"p": "p1", "Fn": "Fn1"}  # the same at load point 1, where the pressure varies
SHEAR_COLUMNS = (("dq",), ("q",), ("q1", "q2"), ("dFt",), ("Ft",), ("Ft1", "Ft2"))

#: Dimensions of the columns.
COLUMN_DIMENSIONS: dict[str, Dimension] = {
    "x": "m", "p": "Pa", "Fn": "N/m",
    "dq": "Pa", "q": "Pa", "q1": "Pa", "q2": "Pa", "dFt": "N/m", "Ft": "N/m", "Ft1": "N/m", "Ft2": "N/m",
    "p1": "Pa", "Fn1": "N/m",
}  # fmt: skip
_OWN = tuple(COLUMN_DIMENSIONS)
_SHEAR = tuple(name for names in SHEAR_COLUMNS for name in names)

#: Other names of x, p and the shear traction at one load point, in lower case, with the sign that makes p positive.
NAMES = {
    "x": dict.fromkeys(
        ("x", "coor1", "coord1", "coor_x", "coord_x", "points:0", "points_0", "x location", "xloc"), 1
    ),
    "p": {
        "cpress": 1, "contact pressure": 1, "contact_pressure": 1, "pressure": 1,  # Abaqus, CalculiX, MOOSE, ANSYS
        "pres": 1, "contpres": 1, "cont,pres": 1,  # ANSYS
        "lags_c": -1,  # Code_Aster: negative in contact
        "normal_lm": 1, "frictional_normal_lm": 1, "lambda_n": 1,  # MOOSE, GetFEM's examples
    },
    "q": {
        "cshear1": 1, "cshear": 1, "taur": 1, "lags_f1": 1, "tangential_lm": 1, "frictional_tangential_lm": 1,
        "lambda_t": 1,
    },
}  # fmt: skip

#: Units by name, in SI units.
SI_FACTORS = {
    **LENGTHS, "pa": 1.0, "kpa": 1e3, "mpa": 1e6, "gpa": 1e9, "psi": 6894.757293168, "ksi": 6894757.293168,
    "n/m": 1.0, "n/mm": 1e3, "n/m^2": 1.0, "n/mm^2": 1e6, "n/mm2": 1e6, "n/um^2": 1e12,
}  # fmt: skip
_UNIT = re.compile(r"^(?P<name>.*?\S)\s*[\[(](?P<unit>[^\[\]()]*)[\])]$")
_TERM = re.compile(r"(?<=\S)\s*([+-])\s*(?=\S)")


class Wanted(NamedTuple):
    """Expression for one column.

    Parameters
    ----------
    parts : dict of int to float
        Signs of the table's columns in the sum, by index.
    unit : float or None
        Unit of the columns, in SI units; None if the header does not state it.
    text : str
        The expression in words.
    moment : bool
        Whether the column is the shear at one load point, under another code's name.
    """

    parts: dict[int, float]
    unit: float | None
    text: str
    moment: bool = False


def headings(line: str) -> list[str]:
    """Split a header ``line`` at blanks, or at two or more blanks if names contain blanks.

    A unit in brackets stays with the name before it.
    """
    wide = re.split(r"\s{2,}", line.strip())
    parts = wide if len(wide) > 2 else line.split()
    names: list[str] = []
    for part in parts:
        if names and part[0] in "[(":
            names[-1] += f" {part}"
        else:
            names.append(part)
    return names


def known(names: list[str], origin: str, anew: bool | None = False) -> dict[str, Wanted]:
    """Find x, p or Fn, p1 or Fn1 if the pressure varies (``anew``; None: if it is there), and the shear among the
    ``names`` of a header line, in this order.

    Raises
    ------
    InputError
        If one is missing or ambiguous; ``origin`` is the file's name.
    """
    plain = [_split(name) for name in names]
    found = {
        name: [Wanted({k: 1.0}, unit, names[k]) for k, (own, unit) in enumerate(plain) if own == name] for name in _OWN
    }
    for name, group in (("x", ("x",)), ("p", NORMAL), ("q", _SHEAR)):
        if not any(found[each] for each in group):
            signs, others = NAMES[name], [(k, own.lower(), unit) for k, (own, unit) in enumerate(plain)]
            found[name] = [
                Wanted({k: signs[own]}, unit, names[k], name == "q") for k, own, unit in others if own in signs
            ]
    for name, places in found.items():
        if len(places) > 1:
            told = " and ".join(repr(place.text) for place in places)
            raise InputError(
                f"{origin}: column {name!r}: must be there once, not {len(places)} times ({told}); use --columns"
            )
    return _complete({name: each[0] for name, each in found.items() if each}, names, origin, anew)


def selected(names: list[str], chosen: Mapping[str, str], origin: str, anew: bool | None = False) -> dict[str, Wanted]:
    """Parse the expressions ``chosen`` for the columns of :func:`known`: names or numbers of columns, sums and
    differences.

    Raises
    ------
    InputError
        If an expression has unknown columns or mixed units, or one is missing; ``origin`` is the file's name.
    """
    if unknown := [name for name in chosen if name not in _OWN]:
        raise InputError(f"--columns {unknown[0]}: must be one of {', '.join(_OWN)}")
    if anew is False and (first := next((name for name in FIRST.values() if name in chosen), None)):
        raise InputError(f"--columns {first}: must be left out, as the scene's pressure does not vary")
    wanted = {name: _made_of(chosen[name], names, origin) for name in _OWN if name in chosen}
    return _complete(wanted, names, origin, anew)


def _complete(wanted: dict[str, Wanted], names: list[str], origin: str, anew: bool | None) -> dict[str, Wanted]:
    """Check for x, one of p and Fn, its value at load point 1 if the pressure varies (``anew``; None: if it is there),
    and the matching shear, and put them in this order."""
    normal = [name for name in NORMAL if name in wanted]
    shears = [shear for shear in SHEAR_COLUMNS if set(shear) <= set(wanted)]
    shears = [shear for shear in shears if len(shear) == 2] or shears  # their difference is dq
    if "x" not in wanted or len(normal) != 1 or len(shears) != 1:
        shown = ", ".join(repr(name) for name in names)[:100]
        raise InputError(
            f"{origin}: columns {shown}: must be x; p or Fn; and one of dq, q, q1 and q2, dFt, Ft, Ft1 and Ft2; "
            "name them with --columns x=...,p=...,dq=..."
        )
    if (normal[0] == "Fn") != shears[0][0].endswith(("Ft", "Ft1")):
        raise InputError(f"{origin}: columns {normal[0]} and {shears[0][0]}: must be both tractions or both forces")
    first = FIRST[normal[0]]
    if anew and first not in wanted:
        at = f"{first}, {normal[0]} at load point 1, as the scene's pressure varies"
        raise InputError(f"{origin}: columns: must include {at}; name it with --columns {first}=...")
    pressures = (*normal, first) if anew or (anew is None and first in wanted) else normal
    return {name: wanted[name] for name in ("x", *pressures, *shears[0])}


def _made_of(text: str, names: list[str], origin: str) -> Wanted:
    """Parse ``text``: a column's name, with or without unit, or number; or sums and differences of columns."""
    plain = [_split(name) for name in names]
    places = [k for k, name in enumerate(names) if text in (name, plain[k][0])]
    if not places and text.isdigit() and 1 <= int(text) <= len(names):
        places = [int(text) - 1]
    if len(places) == 1:
        return Wanted({places[0]: 1.0}, plain[places[0]][1], text)
    for sign in reversed(list(_TERM.finditer(text))):
        first = _made_of(text[: sign.start()], names, origin)
        second = _made_of(text[sign.end() :], names, origin)
        if first.unit != second.unit:
            raise InputError(f"--columns {text}: {first.text} and {second.text} must be in the same unit")
        turn = 1.0 if sign[1] == "+" else -1.0
        parts = dict(first.parts)
        for column, own in second.parts.items():
            parts[column] = parts.get(column, 0.0) + turn * own
        return Wanted(parts, first.unit, text)
    if not places and text.startswith("-"):
        first = _made_of(text[1:].strip(), names, origin)
        return Wanted({column: -sign for column, sign in first.parts.items()}, first.unit, text)
    shown = ", ".join(repr(name) for name in names)[:100]
    raise InputError(
        f"--columns {text}: {origin} has the columns {shown}; must be one of them once, or a number from 1"
    )


def _split(name: str) -> tuple[str, float | None]:
    """Split a column's name into the name and the unit, as a factor to SI units; None if there is no unit."""
    parts = _UNIT.match(name)
    if parts is None:
        return name, None
    unit = parts["unit"].strip().lower()
    if unit not in SI_FACTORS:
        return name, None
    return parts["name"], SI_FACTORS[unit]
