"""Files of measured points: their columns, units and rows. What is no single trace along x is refused."""

import re
from typing import NamedTuple

import numpy as np

from partialslip.scene.columns import LENGTH_WORDS, place_of, split_unit
from partialslip.scene.table import LARGEST, SMALLEST
from partialslip.scene.texttable import TextTable, decoded, read_table
from partialslip.scene.units import LENGTHS
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError
from partialslip.tools.inputfile import read_bytes

_LARGEST = 20_000_000  # limit: bytes of a file of points
_FEWEST = 10  # limit: points
_COLUMNS = 2  # fixed: x and gap
_ROUNDING = 1e-12  # accuracy: relative difference of units that is taken for rounding
_ASLANT = 1e-3  # limit: change of y in that of x
# fixed: first words of the names of columns
_ALONG = {"x", "length", "distance", "position", "pos", "lateral", "way"}
_GAPS = {"gap", "depth", "z", "height", "profile", "h"}
_BRACKETS = re.compile(r"\[([^\[\]]*)\]|\(([^()]*)\)")
_WORD = re.compile(r"[^\W\d_]+")
_CELLS = re.compile(r"[,;\t]|\s{2,}")
_AMOUNT = re.compile(r"\d\s*[^\W\d_]+(?:/\w+)?")  # fixed: such as 0.5 mm/s: the unit of no column
_ONE = re.compile(r"(?<![\d.,])1(?:[.,]0+)?\s*([^\W\d_]+)(?![\w/])")  # fixed: 1 mm, which may be a unit
_SCALE = re.compile(r"(?<![^\W_])(?:scale|units?|einheit(?:en)?)(?![^\W_])", re.IGNORECASE)
_BLOCKS = {"block", "part", "step", "frame", "source"}  # fixed: columns that tell blocks of a file apart
_ENGLISH = {"m", "in"}  # fixed: units that are also names or words
_IN_FULL = re.compile(
    r"(?:milli|micro|nano|centi|kilo)?met(?:er|re)s?|microns?|inch(?:es)?|mils?|thou|foot|feet|ft|\N{ANGSTROM SIGN}|"
    r"\N{LATIN CAPITAL LETTER A WITH RING ABOVE}|angstroms?|pm|km|dm",
    re.IGNORECASE,
)


class PointColumns(NamedTuple):
    """Columns of a file of points: their numbers from 1, x first, and their units, m; that of heights is negative."""

    numbers: tuple[int, int]
    unit: tuple[float, float]


def columns_of(
    file: str, given: float | tuple[float, ...] | None, length: float, chosen: tuple[int | str, ...] | None = None
) -> PointColumns:
    """Return the columns x and gap of ``file``, and their units in ``length`` (m).

    Parameters
    ----------
    file : str
    given : float or tuple of float or None
        ``profile.unit``, of both columns or of each, in ``length``.
    length : float
    chosen : (int or str, int or str), optional
        ``profile.columns``, names or numbers from 1; by default those of a file of two, or those that are named so.

    Raises
    ------
    InputError
        If columns are not found, the file has more than one block or a scan aslant, ``given`` is not that of the
        heading, nothing is given and the heading names units that cannot be read, or the heading names x as the second
        column.
    """
    table = _table(file)
    _require_one_block(table, file)
    x, gap = _places(table, file, chosen)
    lines, above = table.before, list[str]()
    if len(table.names) > _COLUMNS:
        above = lines[: table.head - 1] if table.head else lines
        lines = [f"{table.names[x]}; {table.names[gap]}"] if table.head else []
    elif not chosen and (swapped := next((line for line in lines if _is_swapped(line)), "")):
        raise InputError(f"profile.file: {file}: heading {swapped.strip()!r:.60}: the columns must be x, then gap")
    units = _units(file, lines, above, given, length)
    _require_along_x(table, file, (x, gap), units[0], length)
    return PointColumns((x + 1, gap + 1), units)


def is_named_gap(file: str, column: int) -> bool:
    """Whether ``column`` of ``file``, from 1, has a name that says that it is no height."""
    table = _table(file)
    return table.head > 0 and "gap" in table.names[column - 1].lower()


def _table(file: str) -> TextTable:
    origin = f"profile.file: {file}"
    return read_table(decoded(read_bytes(file, _LARGEST), origin)[0], origin, loose=True)


def _places(table: TextTable, file: str, chosen: tuple[int | str, ...] | None) -> tuple[int, int]:
    """Indices of the columns x and gap."""
    names, shown = table.names, ", ".join(map(repr, table.names))[:100]
    if chosen:
        places = [place_of(str(each), names) for each in chosen]
        for each, place in zip(chosen, places, strict=True):
            if place is None:
                raise InputError(f"profile.columns: {each!r}: must be one of {shown}, once, or a number from 1")
        return tuple(places)  # type: ignore[return-value]
    filled = [k for k, column in enumerate(table.columns) if any(column)]
    if len(filled) == _COLUMNS:
        return filled[0], filled[1]
    first = [(_WORD.findall(name) or [""])[0].lower() for name in names]
    x, gap = ([k for k in filled if first[k] in words] for words in (_ALONG, _GAPS))
    if not (table.head and len(x) == len(gap) == 1):
        raise InputError(
            f"profile.file: {file}: {len(names)} columns, {shown}: must have two, x and gap; or name both by "
            "profile.columns, for example [2, 3]"
        )
    return x[0], gap[0]


def _units(
    file: str, lines: list[str], above: list[str], given: float | tuple[float, ...] | None, length: float
) -> tuple[float, float]:
    """Units of x and gap in ``length``: those ``given`` or those in the ``lines`` of a heading. Lines ``above`` it are
    of other columns, too."""
    words = next(filter(None, map(_stated, reversed(lines))), [])
    known = [LENGTH_WORDS.get(word.strip().lower()) for word in words]
    shown = " and ".join(f"[{word}]" for word in words)
    stated = None if None in known else [factor / length for factor in known if factor]
    if given is None:
        if stated is None:
            allowed = ", ".join(dict.fromkeys(LENGTHS))
            raise InputError(
                f"profile.file: {file}: units {shown} in the heading: must be of {allowed}, or give profile.unit"
            )
        if not stated and (unread := next(filter(None, map(_unread, [*lines, *above])), "")):
            raise InputError(
                f"profile.file: {file}: unit {unread!r} in the heading: must stand behind the name of each column, as "
                "in x [mm], gap [um], or give profile.unit"
            )
        return (stated[0], stated[-1]) if stated else (1.0, 1.0)
    x, gap = given if isinstance(given, tuple) else (given, given)
    if stated and not np.allclose((x, gap), stated, rtol=_ROUNDING, atol=0.0):
        raise InputError(f"profile.unit = {[x, gap]}: must be that of the heading of {file}, {shown}, or be left out")
    return x, gap


def _stated(line: str) -> list[str]:
    """Words for the units of both columns in a ``line`` of the heading, or one that stands for both; empty if there are
    none.

    They are in brackets, in round ones only if they are units, or the last words of the columns' names.
    """
    words = ["".join(pair) for pair in _BRACKETS.findall(line)]
    known = all(word.strip().lower() in LENGTH_WORDS for word in words)
    if len(words) == _COLUMNS and (known or all(square for square, _ in _BRACKETS.findall(line))):
        return words
    cells = _column_words(line)
    last = [names[-1] for names in cells]
    if len(cells) == 1:
        last = [word for word in cells[0] if word.lower() in LENGTH_WORDS.keys() - _ENGLISH]
    if len(last) == _COLUMNS and all(word.lower() in LENGTH_WORDS for word in last):
        return last
    alone = len(words) == 1 and len(cells) == 1 and known and not _unread(line.replace(words[0], "", 1))
    return words if alone else []


def _column_words(line: str) -> list[list[str]]:
    """Words of each column in a ``line`` of the heading."""
    return [words for cell in _CELLS.split(line) if (words := _WORD.findall(cell))]


def _is_swapped(line: str) -> bool:
    """Whether a ``line`` of the heading names x as the second of two columns."""
    first = [words[0].lower() for words in _column_words(line)]
    return len(first) == _COLUMNS and first[1] == "x" != first[0]


def _unread(line: str) -> str:
    """First word of a ``line`` that is a unit of length, but not of an amount; empty if there is none. One unit, and
    what is called a scale or a unit, is no amount."""
    scale = _SCALE.search(line)
    words = _WORD.findall(line if scale else _AMOUNT.sub("", _ONE.sub(r" \1", line)))
    known = LENGTHS.keys() - (_ENGLISH - {"m"} if scale else _ENGLISH)
    return next((each for each in words if each.lower() in known or _IN_FULL.fullmatch(each)), "")


def _require_one_block(table: TextTable, file: str) -> None:
    """Raise InputError if the reader of tables has added a column that tells blocks of the file apart."""
    for name, column in zip(table.names, table.columns, strict=True):
        kinds = (
            list(dict.fromkeys(column)) if name in _BLOCKS and not any(name in line for line in table.before) else []
        )
        if len(kinds) > 1:
            raise InputError(
                f"profile.file: {file}: {len(kinds)} blocks, {name} {kinds[0]} and {kinds[1]}: two traces? keep one, "
                "under one heading"
            )


def _require_along_x(table: TextTable, file: str, chosen: tuple[int, int], unit: float, length: float) -> None:
    """Raise InputError if y, which is none of the columns ``chosen``, changes along x."""
    bare = [split_unit(name)[0].strip().lower() for name in table.names]
    others = [k for k, name in enumerate(bare) if name == "y" and k not in chosen]
    if bare[chosen[0]] != "x" or not others or not table.head:
        return
    x, y = (table.numbers(k, f"profile.file: {file}") for k in (chosen[0], others[0]))
    known = np.isfinite(x) & np.isfinite(y)
    own = split_unit(table.names[others[0]])[1]
    spans = [
        float(np.ptp(of[known])) * size for of, size in ((x, unit), (y, own / length if own else unit)) if any(known)
    ]
    if spans and spans[1] > _ASLANT * spans[0]:
        raise InputError(
            f"profile.file: {file}: y changes by {spans[1] / (spans[0] or 1):.2g} times the change of x: give the "
            "distance along the scan as x, or leave out y if it is no place"
        )


def read_points(
    file: str,
    unit: tuple[float, float],
    columns: tuple[int, int] = (1, 2),
    centre: float = 0.0,
    back: float = np.inf,
) -> tuple[Array, Array]:
    """Read x and gap, (n,) each, times their ``unit``, sorted by x, from ``columns`` (from 1) of a table; x from
    ``centre`` (m) on. Rows without values are left out.

    Raises
    ------
    InputError
        If the file is no table with these columns and at least ten different x, a number is neither zero nor of a
        size that a scene allows, or x runs ``back`` from row to row, in the unit of x.
    """
    x, gap, rows, table = _rows_of(file, unit, columns)
    if len(np.unique(x)) < _FEWEST:
        raise InputError(f"profile.file: {file}: must have at least {_FEWEST} different x, not {len(np.unique(x))}")
    forward = x if x[-1] >= x[0] else -x
    lost = np.maximum.accumulate(forward) - forward
    if lost.max() > back:
        row = rows[int((lost > back).argmax())]
        raise InputError(
            f"profile.file: {file}: x runs back at line {table.lines[row]}, to {table.columns[columns[0] - 1][row]}: "
            "two traces? keep one, in the order of x; or columns in the wrong order?"
        )
    order = np.lexsort((gap, x))
    return x[order] - centre, gap[order]


def line_of_gap(file: str, unit: tuple[float, float], columns: tuple[int, int], gap: float) -> str:
    """Return the number as it stands in the ``file`` and the first line of the point that has the ``gap``."""
    _, gaps, rows, table = _rows_of(file, unit, columns)
    row = rows[int(np.abs(gaps - gap).argmin())]
    return f"{table.columns[columns[1] - 1][row]} at line {table.lines[row]}"


def _rows_of(
    file: str, unit: tuple[float, float], columns: tuple[int, int]
) -> tuple[Array, Array, list[int], TextTable]:
    """x and gap in the order of the file, (n,) each, the rows of the table in which they are, and the table."""
    table = _table(file)
    if max(columns) > len(table.names):
        raise InputError(f"profile.file: {file}: {len(table.names)} columns: must have a column {max(columns)}")
    numbers = [table.numbers(k - 1, f"profile.file: {file}") for k in columns]
    for k, column, each in zip(columns, numbers, unit, strict=True):
        size = np.abs(column * each)
        if (wrong := (size > 0) & ((size < SMALLEST) | (size > LARGEST))).any():
            row, sizes = int(wrong.argmax()), f"zero or of a size from {SMALLEST} to {LARGEST}"
            field = table.columns[k - 1][row]
            raise InputError(f"profile.file: {file}: line {table.lines[row]}: {field}: must be {sizes}")
    known = np.isfinite(numbers[0]) & np.isfinite(numbers[1])
    x, gap = (column[known] * each for column, each in zip(numbers, unit, strict=True))
    return x, gap, np.flatnonzero(known).tolist(), table
