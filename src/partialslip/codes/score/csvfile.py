"""Columns of x, pressure and shear of a table, and a table to fill in."""

import itertools
import re
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from partialslip.codes.score.headers import (
    COLUMN_DIMENSIONS,
    NODES,
    Asked,
    Wanted,
    check_no_heading,
    known,
    numbered,
    pairs,
    selected,
    shown,
)
from partialslip.codes.score.rows import Label, check_equal_x, check_passes
from partialslip.codes.score.samples import PLAUSIBLE, unusable
from partialslip.scene import Scene
from partialslip.scene.columns import dimension_of, place_of, split_unit, unknown_unit
from partialslip.scene.texttable import TextTable
from partialslip.scene.units import SI, Units
from partialslip.tools.arrays import Array, Mask
from partialslip.tools.errors import InputError

#: Columns by which rows of several states and surfaces are told apart.
_TELLS = re.compile(
    r"(?:part|surf(?:ace)?|side|body|instance|region|pair|set|load.?case|case|load.?point|step|frame|inc(?:rement)?|time|inst|nume_ordre|"
    r"block|source|file|method)(?:[ _.-]?(?:id|no|name|number))?",
    re.IGNORECASE,
)
_ACROSS = re.compile(
    r"(?:y|z|coord?\.?(?:coor)?[23]|coord?_[yz]|[yz] location|(?:points|coord(?:inate)?s?)[:_][12])", re.I
)
_FLAT = 0.05  # limit: of the extent of the contact along x: largest extent of its points across
_FEW = 12  # display: most lines of points of which one is to be kept
_SHOWN = 6  # display: values of a column in a message
_TEMPLATE_ROWS = 81  # display: rows of the template
_TEMPLATE_REACH = 1.1  # display: largest |x| of the template, in contact half-widths


class Columns(NamedTuple):
    """Columns of a file.

    Parameters
    ----------
    values : dict of (n,) arrays
        By name, SI units.
    made_of : str
        Expressions for the columns, if they differ from the columns' names.
    notes : tuple of str
    moment : bool
        Whether the shear is known at one load point only.
    nodes : list or None
        Numbers of the nodes, by row, if the file has them.
    of : dict of str to str
        What the file says that all of them are of: part, step, frame, and pair of surfaces.
    """

    values: dict[str, Array]
    made_of: str = ""
    notes: tuple[str, ...] = ()
    moment: bool = False
    nodes: list[str] | None = None
    of: dict[str, str] = {}  # noqa: RUF012


def columns_of(table: TextTable, asked: Asked, chosen: Mapping[str, str] | None = None, units: Units = SI) -> Columns:
    """Columns x, p (or Fn) and shear of a ``table``, in SI units. Rows without values are left out.

    Parameters
    ----------
    table : TextTable
    asked : Asked
    chosen : mapping of str to str, optional
        Expression for each column: a name or number (from 1) of a column of the table, or sums and differences.
    units : Units
        Units of the columns that state none.

    Raises
    ------
    InputError
        If a column is missing, a value is no number, or rows are of several surfaces or load points.
    """
    names, notes = table.names, list(table.notes)
    if chosen:
        wanted = selected(names, chosen, asked)
    elif not table.head:
        check_no_heading(table.before, asked.origin)
        wanted = numbered(names, asked)
        told = ", ".join(f"{name}={k + 1}" for k, name in enumerate(wanted))
        notes.append(f"no heading: read as --columns {told}")
    else:  # a column without values is none
        filled = [not table.lines or not isinstance(each, list) or any(each) for each in table.columns]
        wanted = known([name if some else "" for name, some in zip(names, filled, strict=True)], asked)
    notes += _units(wanted, names, units, asked.origin)
    used = sorted({each for column in wanted.values() for each in column.parts})
    numbers = {k: table.numbers(k, asked.origin) for k in used}
    missing = np.isnan(np.stack([*numbers.values()])).any(axis=0)
    if missing.any():
        table = table.only(np.flatnonzero(~missing).tolist())
        numbers = {k: column[~missing] for k, column in numbers.items()}
        count = int(np.count_nonzero(missing))
        notes.append(f"left out: {count} row{'s' * (count > 1)} without values")
    for k, column in numbers.items():
        if (wrong := unusable(column)).any():
            first = int(wrong.argmax())
            told = f"line {table.lines[first]}: {names[k]} = {str(table.columns[k][first])[:40]}"
            raise InputError(f"{asked.origin}: {told}: must be {PLAUSIBLE}")
    sums = {name: sum((sign * numbers[column] for column, sign in each.parts.items()), np.zeros(len(table.lines)))
            for name, each in wanted.items()}  # fmt: skip
    values = {
        name: column * unit if (unit := wanted[name].unit) else units.to_si(column, COLUMN_DIMENSIONS[name])
        for name, column in sums.items()
    }
    scaled = sorted({name for each in wanted.values() for name in asked.scales if _is_over(each.text, name)})
    if scaled and any(each.unit == asked.scales.get(name) for each in wanted.values() for name in scaled):
        notes.append(f"normalised columns: times the scene's {', '.join(_scale(n, asked, units) for n in scaled)}")
    length = wanted["x"].unit or units.size("m") if "x" in wanted else 1.0
    kept, left_out = _of_one(table, used, values, length, asked.origin)
    notes += left_out
    node = next((place_of(name, [each.lower() for each in names]) for name in NODES
                 if name in map(str.lower, names)), None)  # fmt: skip
    labels = None if node is None else [str(value) for value, one in zip(table.columns[node], kept, strict=True) if one]
    expressions = [f"{name} = {each.text}" for name, each in wanted.items() if each.text != name]
    moment = any(each.moment for each in wanted.values())
    values = {name: column[kept] for name, column in values.items()}
    of = table.labels | dict(zip(("pair",), pairs(wanted), strict=False))
    return Columns(values, ", ".join(expressions), tuple(notes), moment, labels, of)


def _units(wanted: Mapping[str, Wanted], names: list[str], units: Units, origin: str) -> list[str]:
    """Notes on the ``wanted`` columns in a unit that is not known.

    Raises InputError if a unit is of another dimension than the column.
    """
    notes = []
    for name, each in wanted.items():
        unit = units.label(COLUMN_DIMENSIONS[name])
        for k in each.parts:
            if dimension_of(names[k]) not in (None, COLUMN_DIMENSIONS[name]):
                raise InputError(f"{origin}: column {names[k]!r}: must be in a unit of {name}, as {unit}")
            if stated := unknown_unit(names[k]):
                notes.append(f"unit {stated} of {name} is not known: read in {unit}; correct with --factors")
    return notes


def _is_over(text: str, scale: str) -> bool:
    return re.sub(r"[\s()*.·]", "", text.partition("/")[2]).lower() == scale


def _scale(name: str, asked: Asked, units: Units) -> str:
    """A scale of the scene and its value, as text."""
    return f"{name} = {units.labelled(asked.scales[name], 'm' if name == 'a' else 'Pa', 7)}"


def where(table: TextTable, asked: Mapping[str, str], origin: str) -> list[TextTable]:
    """The rows of ``table`` in which each column of ``asked`` has the value asked for; or a table for each load point,
    where that is several values, with commas between them.

    Raises
    ------
    InputError
        If there is no such column, or no row with the value.
    """
    tables = [table]
    for name, value in asked.items():
        place = place_of(name, table.names)
        if place is None:
            raise InputError(
                f"--where {name}={value}: {origin} has the columns {shown(table.names)}; must be one of them"
            )
        kinds = _kinds(table, place)
        values = [value] if any(_same(value, kind) for kind in kinds) else value.split(",")
        for one in values:
            if not any(_same(one, kind) for kind in kinds):
                raise InputError(f"--where {name}={one}: must be one of {_listed(kinds)}, as {origin} has it")
        if len(values) > 1 and len(tables) > 1:
            raise InputError(
                f"--where {name}={value}: must be one value, as another column has one for each load point"
            )
        tables = [each.only([row for row, own in enumerate(each.columns[place]) if _same(one, str(own))])
                  ._replace(labels=each.labels | {name.lower(): one}) for one in values for each in tables]  # fmt: skip
    if asked and any(not each.lines for each in tables):
        raise InputError(f"--where {', '.join(f'{n}={v}' for n, v in asked.items())}: {origin} has no such row")
    return tables


def _kinds(table: TextTable, place: int) -> list[str]:
    """Values of a column, each once."""
    return list(dict.fromkeys(map(_shown, table.columns[place])))


def _shown(value: object) -> str:
    return f"{value:.10g}" if isinstance(value, float) else str(value)


def _same(one: str, other: str) -> bool:
    """Whether two values of a column are the same text or number."""
    if one.strip().lower() == other.strip().lower():
        return True
    try:
        return abs(float(one) - float(other)) <= 1e-9 * abs(float(other))
    except ValueError:
        return False


def _listed(kinds: list[str]) -> str:
    more = f" ... ({len(kinds)} values)" if len(kinds) > _SHOWN else ""
    return ", ".join(kinds[:_SHOWN]) + more


def _of_one(
    table: TextTable, used: list[int], values: Mapping[str, Array], unit: float, origin: str
) -> tuple[Mask, list[str]]:
    """The rows of one surface, state and method, (n,), and notes; ``used`` columns do not tell rows apart. x is in
    ``unit``, m.

    Raises InputError with what to type to keep some of them.
    """
    every, notes = np.ones(len(table.lines), bool), list[str]()
    if not {"x"} < set(values):
        return every, notes
    x, pressed = values["x"], np.any([column != 0 for name, column in values.items() if name != "x"], axis=0)
    for k, name in enumerate(table.names):
        if k in used or not _TELLS.fullmatch(split_unit(name)[0].strip()) or len(kinds := _kinds(table, k)) < 2:
            continue
        places = {kind: at for at, kind in enumerate(kinds)}
        own = np.array([places[_shown(each)] for each in table.columns[k]])
        told = np.unique(own[pressed & every])
        if len(told) == 1:
            every &= own == told[0]
            if not every.all():
                others = _listed([kind for at, kind in enumerate(kinds) if at != told[0]])
                notes.append(f"left out: rows with {name} {others}, where tractions are zero")
            continue
        spans = sorted((x[own == at].min(), x[own == at].max()) for at in told)
        if name.lower() == "method" or any(after[0] < before[1] for before, after in itertools.pairwise(spans)):
            raise InputError(
                f"{origin}: {name} is {_listed(kinds)}: must be one: keep one, as by {_type(name, kinds[-1])}"
                + (f", or both load points by {_type(name, ','.join(kinds))}" if len(kinds) == 2 else "")
            )
    x, pressed = x[every], pressed[every]
    across = {k: name for k, name in enumerate(table.names) if k not in used and _ACROSS.fullmatch(split_unit(name)[0])}
    if pressed.any():
        low, high = x[pressed].min(), x[pressed].max()
        for k, name in across.items():
            inside = table.numbers(k, origin)[every][(x >= low) & (x <= high)]
            length = split_unit(name)[1] or unit
            if np.ptp(inside) * length > _FLAT * (high - low):
                kinds = list(map(_shown, np.unique(inside)[::-1].tolist()))
                keep = f"keep one, as by {_type(name, kinds[0])}" if len(kinds) <= _FEW else "keep those of the contact"
                apart = f"points with p lie apart across x: must be on one line; {name} is {_listed(kinds)}"
                raise InputError(f"{origin}: {apart}: {keep}")
    kept = table.only(np.flatnonzero(every).tolist())
    labels = [Label(name, k + 1, list(kept.columns[k])) for k, name in enumerate(table.names) if k not in used]
    advice = f"keep one, as by {_type('{name}', '{kept}')}"
    values = {name: each[every] for name, each in values.items()}
    check_equal_x(values, labels, origin, advice)
    if "p" in values:  # forces of corners and middles of sides differ
        check_passes(values, labels, origin, advice)
    return every, notes


def _type(name: str, kind: str) -> str:
    """The option that keeps the rows in which column ``name`` is ``kind``."""
    return f'--where "{name}={kind}"'


def csv_template(scene: Scene, a: float) -> str:
    """A table to fill in for ``scene``: points on a contact of half-width ``a`` (m) and beyond, zero tractions; in the
    scene's units."""
    units, load = scene.units, scene.load
    x = units.from_si(_TEMPLATE_REACH * a * np.linspace(-1, 1, _TEMPLATE_ROWS), "m")
    m, Pa, forces = (units.label(of) for of in ("m", "Pa", "N/m"))
    names = ("x", "p", "p1", "dq") if scene.presses_anew else ("x", "p", "dq")
    of_p, of_Fn, P = "pressure", "Fn", f"P = {units.labelled(scene.P, 'N/m', 10)}"
    if scene.presses_anew:
        P1, P2 = (units.labelled(P, "N/m", 10) for P, _ in scene.end_pressing)
        of_p, of_Fn, P = "pressure at load point 2, p1 at load point 1", "Fn and Fn1", f"P1 = {P1}, P2 = {P2}"
    head = (
        f"# {scene.name}: put your tractions here and run: partialslip score {scene.name} THIS-FILE\n"
        f"# x: along the contact, {m}, its middle at 0 (any points will do); p: {of_p}, {Pa};\n"
        f"# dq: change q2 - q1 of the shear traction between load points 1 and 2, {Pa}, positive where Q is.\n"
        "# Instead of dq: q (half of it), or q1 and q2. "
        f"Nodal forces per depth, {forces}: {of_Fn}, and dFt or Ft1, Ft2.\n"
        f"# The scene: {P}, dQ = {units.labelled(load.dQ, 'N/m', 10)}, "
        f"dsigma = {units.labelled(load.dsigma, 'Pa', 10)}, f = {scene.friction.shown}\n"
        f"{','.join(units.heading(name, COLUMN_DIMENSIONS[name]) for name in names)}\n"
    )
    return head + "".join(f"{point:.9e}{',0' * (len(names) - 1)}\n" for point in x)
