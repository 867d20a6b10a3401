"""Read tractions from a table: values separated by commas, semicolons, tabs or blanks, with a header line."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from partialslip.codes.score.headers import COLUMN_DIMENSIONS, headings, known, selected
from partialslip.codes.score.rows import Label, check_equal_x
from partialslip.codes.score.samples import PLAUSIBLE, unusable
from partialslip.scene import Scene
from partialslip.scene.units import SI, Units
from partialslip.tools.arrays import Array, Mask
from partialslip.tools.errors import InputError

_NO_VALUE = ("", "-", "--", "novalue", "no value", "n/a", "na")
_METHOD = "method"  # fixed: column of the tables that run writes
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
    text: str, origin: str, chosen: Mapping[str, str] | None = None, units: Units = SI, anew: bool | None = False
) -> Columns:
    """Read columns x, p (or Fn) and shear from a table with a header line, in SI units.

    ``#`` begins a comment. Separators are commas, semicolons, tabs or blanks. Decimal commas are allowed where commas
    do not separate. Column names are x, p, Fn, p1, Fn1, dq, q, q1, q2, dFt, Ft, Ft1, Ft2 or those of other codes
    (:data:`partialslip.codes.score.headers.NAMES`), with a unit in brackets if not in ``units``. Rows without values
    are skipped.

    Parameters
    ----------
    text, origin : str
        Content of the file, and its name for messages.
    chosen : mapping of str to str, optional
        Expression for each column: a name or number (from 1) of a column of the table, or sums and differences.
    units : Units
        Units of the columns without a unit in brackets.
    anew : bool or None
        Whether the pressure varies: then p1 (or Fn1) is read, too; None: if it is there.

    Raises
    ------
    InputError
        If the table cannot be read; the message names line and column.
    """
    table = _table(text, origin, headless=chosen is not None)
    names = table.names
    if chosen:
        wanted = selected(names, chosen, origin, anew)
    else:  # a column without values is none
        filled = [not table.lines or not all(map(_no_value, table.column(k))) for k in range(len(names))]
        wanted = known([name if some else "" for name, some in zip(names, filled, strict=True)], origin, anew)
    used = sorted({each for column in wanted.values() for each in column.parts})
    kept = np.flatnonzero(~np.any([_empty(table.column(k)) for k in used], axis=0))
    left_out = len(table.lines) - len(kept)
    if left_out:
        table = table.only(kept.tolist())
    numbers = {k: _numbers(table.column(k), table.lines, names[k], origin) for k in used}
    sums = {name: sum((sign * numbers[column] for column, sign in each.parts.items()), np.zeros(len(kept)))
            for name, each in wanted.items()}  # fmt: skip
    values = {
        name: column * unit if (unit := wanted[name].unit) else units.to_si(column, COLUMN_DIMENSIONS[name])
        for name, column in sums.items()
    }
    _check_single(table, used, values, origin)
    notes = [f"left out: {left_out} row{'s' * (left_out > 1)} without values"] if left_out else []
    expressions = [f"{name} = {each.text}" for name, each in wanted.items() if each.text != name]
    return Columns(values, ", ".join(expressions), tuple(notes), any(each.moment for each in wanted.values()))


class _Table(NamedTuple):
    """Fields of a table: ``names`` of the ``columns``, the ``lines`` of the file in which its rows are, and the line
    with the header, ``head``. The ``separator`` is empty for blanks; ``plain`` fields are numbers as they stand."""

    names: list[str]
    columns: list[list[str]]
    lines: list[int]
    head: int
    separator: str
    plain: bool

    def column(self, k: int) -> list[str]:
        """Fields of column ``k``."""
        return self.columns[k] if self.plain else [_field(field, self.separator) for field in self.columns[k]]

    def only(self, kept: list[int]) -> "_Table":
        """The table with the ``kept`` rows alone."""
        columns = [[column[row] for row in kept] for column in self.columns]
        return self._replace(columns=columns, lines=[self.lines[row] for row in kept])


def _table(text: str, origin: str, headless: bool) -> _Table:
    """Split ``text`` into fields; a table without a header line is allowed if ``headless``."""
    bare = text.splitlines()
    if "#" in text:
        bare = [line.partition("#")[0] for line in bare]
    numbers = [number for number, line in enumerate(bare, start=1) if line and not line.isspace()]
    if not numbers:
        raise InputError(f"{origin}: empty: must have a header line with x, p and dq")
    bare = [bare[number - 1] for number in numbers]
    first, head = bare[0].strip(" \r"), numbers[0]
    separator = max(",;\t", key=first.count)
    separator = separator if separator in first else ""
    fields = [_field(field, separator) for field in first.split(separator or None)]
    if all(map(_is_number, fields)):
        if not headless:
            raise InputError(f"{origin}: line {head}: must be a header line with x, p and dq; or give --columns")
        names = [str(k + 1) for k in range(len(fields))]
    else:
        names = fields if separator else headings(first)
        bare, numbers = bare[1:], numbers[1:]
    if len(bare) > _MOST_ROWS:
        raise InputError(f"{origin}: {len(bare)} rows: must be at most {_MOST_ROWS}")
    width = len(names)
    counts = (line.count(separator) + 1 if separator else len(line.split()) for line in bare)
    if short := next((n for n, count in zip(numbers, counts, strict=True) if count != width), None):
        raise InputError(f"{origin}: line {short}: must have {width} fields, like the header line")
    every = (separator or " ").join(bare).split(separator or None) if bare else []  # a list a row would take far longer
    plain = '"' not in text and (separator == "," or "," not in text)
    return _Table(names, [every[k::width] for k in range(width)], numbers, head, separator, plain)


def _check_single(table: _Table, used: list[int], values: Mapping[str, Array], origin: str) -> None:
    """Check that the rows are of one method, surface and load point; ``used`` columns do not tell them apart.

    Raises InputError with a command that keeps some of them.
    """
    split = f"-F'{table.separator}' ".replace("\t", "\\t") if table.separator else ""
    advice = f"keep one, as by awk {split}'NR == {table.head} || ${{number}} == \"{{kept}}\"' {origin} > one.csv"
    labels = (Label(name, k + 1, table.column(k)) for k, name in enumerate(table.names) if k not in used)
    check_equal_x(values, labels, origin, advice)
    if _METHOD in table.names:
        label = Label(_METHOD, 1 + (k := table.names.index(_METHOD)), table.column(k))
        if len(kinds := label.kinds) > 1:
            kept = advice.format(number=label.number, kept=kinds[0])
            raise InputError(f"{origin}: tractions by {', '.join(kinds)}: must be by one method: {kept}")


def _field(text: str, separator: str) -> str:
    """A field without blanks and one pair of quotes around it. Commas that do not separate are decimal commas."""
    bare = text.strip()
    bare = bare[1:-1] if len(bare) > 1 and bare[0] == bare[-1] == '"' else bare
    return bare if separator == "," else bare.replace(",", ".")


def _no_value(field: str) -> bool:
    return field.strip().lower() in _NO_VALUE


def _empty(fields: list[str]) -> Mask:
    """Where ``fields`` (n,) hold no value, (n,)."""
    try:
        np.fromiter(map(float, fields), float, len(fields))
    except ValueError:
        return np.array([_no_value(field) for field in fields], bool)
    return np.zeros(len(fields), bool)


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
