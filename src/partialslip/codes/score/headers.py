"""Columns of tables: quantity and unit of each, by the names of this package and of other codes."""

import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from partialslip.scene.columns import place_of, split_unit
from partialslip.scene.units import Dimension
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
_ALONE = {"q2": "q", "Ft2": "Ft"}  # shear at load point 2 alone

#: Other names of x, p and the shear traction at one load point, in lower case, with the sign that makes p positive.
NAMES = {
    "x": dict.fromkeys(
        ("x", "coor1", "coord1", "coord.coor1", "coor_x", "coord_x", "x_coord", "xcoord", "x coordinate",
         "x-coordinate", "x_coordinate", "points:0", "points_0", "coordinates:0", "coord:0", "coords:0", "x location",
         "xloc"), 1
    ),
    "p": {
        "cpress": 1, "contact pressure": 1, "contact_pressure": 1, "pressure": 1,  # Abaqus, CalculiX, MOOSE, ANSYS
        "pres": 1, "contpres": 1, "cont,pres": 1,  # ANSYS
        "lags_c": -1,  # Code_Aster: negative in contact
        "normal_lm": 1, "frictional_normal_lm": 1, "lambda_n": 1,  # MOOSE, GetFEM's examples
    },
    "q": {
        "cshear1": 1, "cshear": 1, "taur": 1, "lags_f1": 1, "tangential_lm": 1, "frictional_tangential_lm": 1,
        "frictional_lm": 1, "lambda_t": 1, "shear": 1, "shear stress": 1, "shear_stress": 1, "shear traction": 1,
    },
}  # fmt: skip
#: Names of the way along a path, in lower case: x of a table that has no other.
PATHS = ("true distance along path", "distance along path", "path distance", "distance", "arc_length")
#: Names of numbers of nodes, in lower case.
NODES = ("node", "node label", "node number", "node_number", "node id", "node_id", "nodeid", "nodal number", "id")

_ENDS = 9  # fixed: letters from which on a name may stand behind another one, as in pad_normal_lm
_PAIR = re.compile(r"^(\S+(?: \S+)*?)(?:\s{2,}(?=\S)|\s+(?=\S{2,}/\S{2,}$))(\S.*)$")  # CPRESS   SLAVE/MASTER
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
        Whether the column is the shear at one load point.
    """

    parts: dict[int, float]
    unit: float | None
    text: str
    moment: bool = False


class Asked(NamedTuple):
    """What a table must have, by its scene.

    Parameters
    ----------
    origin : str
        Name of the file, for messages.
    anew : bool or None
        Whether the pressure varies: then p1 (or Fn1) is asked for, too; None: it is read if it is there.
    shear : bool
        Whether there is friction, and so a shear traction.
    part : bool
        Whether the table may be a part of several: without pressure or shear, or with nodes' numbers instead of x.
    scales : mapping of str to float
        a, p0, fp0 and 2fp0 of the scene, SI units, for normalised columns.
    """

    origin: str
    anew: bool | None = False
    shear: bool = True
    part: bool = False
    scales: Mapping[str, float] = {}


def known(names: list[str], asked: Asked) -> dict[str, Wanted]:
    """Find x, p or Fn, p1 or Fn1 if the pressure varies, and the shear among the ``names`` of a header line.

    Raises
    ------
    InputError
        If one is missing or ambiguous.
    """
    plain = [_plain(name, asked.scales) for name in names]
    found = {
        name: [Wanted({k: 1.0}, unit, names[k]) for k, (own, unit) in enumerate(plain) if own == name] for name in _OWN
    }
    for name, group in (("x", ("x",)), ("p", NORMAL), ("q", _SHEAR)):
        if not any(found[each] for each in group):
            signs = NAMES[name]
            others = [(k, _listed(own.lower(), signs), unit) for k, (own, unit) in enumerate(plain)]
            found[name] = [Wanted({k: signs[own]}, unit, names[k], name == "q") for k, own, unit in others if own]
    if not found["x"]:
        found["x"] = [Wanted({k: 1.0}, unit, names[k]) for k, (own, unit) in enumerate(plain) if own.lower() in PATHS]
    for name, places in found.items():
        if len(places) > 1:
            told = " and ".join(repr(place.text) for place in places)
            raise InputError(
                f"{asked.origin}: column {name!r}: must be there once, not {len(places)} times ({told}); use --columns"
            )
    wanted = {name: each[0] for name, each in found.items() if each}
    of = pairs(wanted)
    if len(of) > 1:
        raise InputError(f"{asked.origin}: columns of the pairs {', '.join(sorted(of))}: must be of one; use --columns")
    return _complete(wanted, names, asked)


def numbered(names: list[str], asked: Asked) -> dict[str, Wanted]:
    """Take the columns of a table without header line as x, p and q, or as x and p where there is no friction.

    Raises
    ------
    InputError
        If there are more or less.
    """
    own = ("x", "p", "q") if asked.shear or len(names) > len(NORMAL) else ("x", "p")
    if len(names) != len(own):
        raise InputError(
            f"{asked.origin}: line 1: must be a header line with x, p and dq, as it has {len(names)} columns; or give "
            "--columns, for example x=1,p=2,q=3"
        )
    wanted = {name: Wanted({k: 1.0}, None, f"column {k + 1}", name == "q") for k, name in enumerate(own)}
    return _complete(wanted, names, asked)


def selected(names: list[str], chosen: Mapping[str, str], asked: Asked) -> dict[str, Wanted]:
    """Parse the expressions ``chosen`` for the columns of :func:`known`: names or numbers of columns, sums and
    differences.

    Raises
    ------
    InputError
        If an expression has unknown columns or mixed units, or one is missing.
    """
    if unknown := [name for name in chosen if name not in _OWN]:
        raise InputError(f"--columns {unknown[0]}: must be one of {', '.join(_OWN)}")
    if asked.anew is False and (first := next((name for name in FIRST.values() if name in chosen), None)):
        raise InputError(f"--columns {first}: must be left out, as the scene's pressure does not vary")
    wanted: dict[str, Wanted] = {}
    for name in _OWN:
        try:
            wanted |= {name: _made_of(chosen[name], names, asked)} if name in chosen else {}
        except InputError:
            if not asked.part:
                raise
    return _complete(wanted, names, asked)


def check_no_heading(before: Sequence[str], origin: str) -> None:
    """Raise InputError if a line ``before`` the first row of a table without heading has a name of p or of the
    shear."""
    names = {*NAMES["p"], *NAMES["q"], *map(str.lower, _OWN)} - {"x"}
    for number, line in enumerate(before, start=1):
        if names & set(re.findall(r"[^\W\d]\w*", line.lower())):
            told = "must name each column, or give --columns x=...,p=...,q2=..."
            raise InputError(f"{origin}: line {number} seems to be a heading: {told}")


def pairs(wanted: Mapping[str, Wanted]) -> set[str]:
    """Pairs of surfaces that the names of the ``wanted`` columns state."""
    return {match[2] for each in wanted.values() if (match := _PAIR.match(split_unit(each.text)[0]))}


def shown(names: list[str]) -> str:
    """``names`` of columns for a message."""
    return ", ".join(repr(name) for name in names)[:100]


def _complete(wanted: dict[str, Wanted], names: list[str], asked: Asked) -> dict[str, Wanted]:
    """Check for x, one of p and Fn, its value at load point 1 if the pressure varies, and the matching shear, and put
    them in this order."""
    normal = [name for name in NORMAL if name in wanted]
    shears = [shear for shear in SHEAR_COLUMNS if set(shear) <= set(wanted)]
    shears = [shear for shear in shears if len(shear) == 2] or shears  # their difference is dq
    if not shears and (alone := next((name for name in _ALONE if name in wanted), None)):
        shears, wanted = [(_ALONE[alone],)], wanted | {_ALONE[alone]: wanted[alone]._replace(moment=True)}
    if asked.part:
        if len(normal) < 2 and len(shears) < 2 and (normal or shears or "x" in wanted):
            return {name: wanted[name] for name in ("x", *normal, *(shears[0] if shears else ())) if name in wanted}
    elif "x" in wanted and len(normal) == 1 and not shears and not asked.shear:
        shears = [()]  # type: ignore[list-item]
    if "x" not in wanted or len(normal) != 1 or len(shears) != 1:
        raise InputError(
            f"{asked.origin}: columns {shown(names)}: must be x; p or Fn; and one of dq, q, q1 and q2, dFt, Ft, Ft1 "
            "and Ft2; name them with --columns x=...,p=...,dq=..."
        )
    if shears[0] and (normal[0] == "Fn") != shears[0][0].endswith(("Ft", "Ft1")):
        raise InputError(
            f"{asked.origin}: columns {normal[0]} and {shears[0][0]}: must be both tractions or both forces"
        )
    first = FIRST[normal[0]]
    if asked.anew and first not in wanted:
        at = f"{first}, {normal[0]} at load point 1, as the scene's pressure varies"
        raise InputError(f"{asked.origin}: columns: must include {at}; name it with --columns {first}=...")
    pressures = (*normal, first) if asked.anew or (asked.anew is None and first in wanted) else normal
    return {name: wanted[name] for name in ("x", *pressures, *shears[0])}


def _made_of(text: str, names: list[str], asked: Asked) -> Wanted:
    """Parse ``text``: a column's name, with or without unit, or number; or sums and differences of columns."""
    place = place_of(text, names)
    if place is not None:
        return Wanted({place: 1.0}, _plain(names[place], asked.scales)[1], text)
    for sign in reversed(list(_TERM.finditer(text))):
        first = _made_of(text[: sign.start()], names, asked)
        second = _made_of(text[sign.end() :], names, asked)
        if first.unit != second.unit:
            raise InputError(f"--columns {text}: {first.text} and {second.text} must be in the same unit")
        turn = 1.0 if sign[1] == "+" else -1.0
        parts = dict(first.parts)
        for column, own in second.parts.items():
            parts[column] = parts.get(column, 0.0) + turn * own
        return Wanted(parts, first.unit, text)
    if text.startswith("-"):
        first = _made_of(text[1:].strip(), names, asked)
        return Wanted({column: -sign for column, sign in first.parts.items()}, first.unit, text)
    raise InputError(
        f"--columns {text}: {asked.origin} has the columns {shown(names)}; must be one of them once, or a number from 1"
    )


def _listed(name: str, signs: Mapping[str, int]) -> str:
    """The name in ``signs`` that ``name`` is or ends in; empty if there is none."""
    return name if name in signs else next(
        (each for each in signs if len(each) >= _ENDS and name.endswith(f"_{each}") and name[:3] not in ("max", "min")),
        "",
    )  # fmt: skip


def _plain(name: str, scales: Mapping[str, float]) -> tuple[str, float | None]:
    """Split a column's name into the name, without the names of surfaces, and the unit in SI units: that behind it, or
    the scale that it is divided by; None if there is neither."""
    own, unit = split_unit(name)
    over, _, by = own.partition("/")
    scale = re.sub(r"[\s()*.·]", "", by).lower()
    if unit is None and scale in scales:
        return over.strip(" ()"), scales[scale]
    match = _PAIR.match(own)
    return (match[1] if match else own), unit
