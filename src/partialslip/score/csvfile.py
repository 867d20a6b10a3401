"""Read tractions from a table: values separated by commas, semicolons, tabs or blanks, with a header line."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from partialslip.arrays import Array
from partialslip.errors import InputError
from partialslip.scene import Scene
from partialslip.score.headers import COLUMN_DIMENSIONS, headings, known, selected
from partialslip.score.samples import PLAUSIBLE, unusable
from partialslip.units import SI, Units

_NO_VALUE = ("", "-", "--", "novalue", "no value", "n/a", "na")
_MOST_ROWS = 1_000_000  # limit: rows of a table
_TEMPLATE_ROWS = 81  # display: rows of the template
_TEMPLATE_REACH = 1.1  # display: largest |x| of the template, in contact half-widths


class Columns(NamedTuple):
    """Columns of a file.

    Parameters
    ----------
    values : dict of (n,) arrays
        By name.
    made_of : str
        Expressions for the columns, if they differ from the columns' names.
    notes : tuple of str
    moment : bool
        Whether the shear is known at one load point only.
    """

    values: dict[str, Array]
    made_of: str = ""
    notes: tuple[str, ...] = ()
    moment: bool = False


def read_csv(
    text: str, origin: str, chosen: Mapping[str, str] | None = None, units: Units = SI, anew: bool = False
) -> Columns:
    """Read columns x, p (or Fn) and shear from a table with a header line, in SI units.

    ``#`` begins a comment. Separators are commas, semicolons, tabs or blanks. Decimal commas are allowed where commas
    do not separate. Column names are x, p, Fn, p1, Fn1, dq, q, q1, q2, dFt, Ft, Ft1, Ft2 or those of other codes
    (:data:`partialslip.score.headers.NAMES`), with a unit in brackets if not in ``units``. Rows without values
    are skipped.

    Parameters
    ----------
    text, origin : str
        Content of the file, and its name for messages.
    chosen : mapping of str to str, optional
        Expression for each column: a name or number (from 1) of a column of the table, or sums and differences.
    units : Units
        Units of the columns without a unit in brackets.
    anew : bool
        Whether the pressure varies: then p1 (or Fn1) is read, too.

    Raises
    ------
    InputError
        If the table cannot be read; the message names line and column.
    """
    lines = [(number, line) for number, line in enumerate(text.splitlines(), start=1) if line.partition("#")[0].strip()]
    if not lines:
        raise InputError(f"{origin}: empty: must have a header line with x, p and dq")
    if len(lines) > _MOST_ROWS:
        raise InputError(f"{origin}: {len(lines)} lines: must be at most {_MOST_ROWS}")
    numbers = [number for number, _ in lines]
    bare = [line.partition("#")[0].strip(" \r") for _, line in lines]
    separator = max(",;\t", key=bare[0].count)
    separator = separator if separator in bare[0] else ""
    rows = [_fields(line, separator) for line in bare]
    names = headings(bare[0]) if not separator else [name.strip() for name in rows[0]]
    headless = chosen is not None and all(map(_is_number, rows[0]))
    if not headless and all(map(_is_number, rows[0])):
        raise InputError(f"{origin}: line {numbers[0]}: must be a header line with x, p and dq; or give --columns")
    if headless:
        names = [str(k + 1) for k in range(len(names))]
    else:
        rows, numbers = rows[1:], numbers[1:]
    if short := next((n for n, row in zip(numbers, rows, strict=True) if len(row) != len(names)), None):
        raise InputError(f"{origin}: line {short}: must have {len(names)} fields, like the header line")
    wanted = selected(names, chosen, origin, anew) if chosen else known(names, origin, anew)
    used = sorted({column for each in wanted.values() for column in each.parts})
    full = [all(row[column].lower() not in _NO_VALUE for column in used) for row in rows]
    kept = [row for row, whole in zip(rows, full, strict=True) if whole]
    numbers = [number for number, whole in zip(numbers, full, strict=True) if whole]
    table = {column: _numbers([row[column] for row in kept], numbers, names[column], origin) for column in used}
    sums = {name: sum((sign * table[column] for column, sign in each.parts.items()), np.zeros(len(kept)))
            for name, each in wanted.items()}  # fmt: skip
    values = {
        name: column * unit if (unit := wanted[name].unit) else units.to_si(column, COLUMN_DIMENSIONS[name])
        for name, column in sums.items()
    }
    left_out = len(rows) - len(kept)
    notes = [f"left out: {left_out} row{'s' * (left_out > 1)} without values"] if left_out else []
    expressions = [f"{name} = {each.text}" for name, each in wanted.items() if each.text != name]
    return Columns(values, ", ".join(expressions), tuple(notes), any(each.moment for each in wanted.values()))


def _fields(line: str, separator: str) -> list[str]:
    """Fields of a line, split at blanks if ``separator`` is empty. Commas that do not separate are decimal commas."""
    fields = line.split(separator) if separator else line.split()
    if separator == ",":
        return [_unquoted(field) for field in fields]
    return [_unquoted(field).replace(",", ".") for field in fields]


def _unquoted(field: str) -> str:
    """Strip blanks and one pair of quotes from ``field``."""
    bare = field.strip()
    return bare[1:-1] if len(bare) > 1 and bare[0] == bare[-1] == '"' else bare


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


def _numbers(values: list[str], lines: list[int], name: str, origin: str) -> Array:
    try:
        found = np.fromiter(map(float, values), float, len(values))
    except ValueError:
        line, value = next((n, v) for n, v in zip(lines, values, strict=True) if not _is_number(v))
        raise InputError(f"{origin}: line {line}: {name} = {value[:40]!r}: must be a number") from None
    if (wrong := unusable(found)).any():
        first = int(wrong.argmax())
        raise InputError(f"{origin}: line {lines[first]}: {name} = {values[first][:40]}: must be {PLAUSIBLE}")
    return found


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
