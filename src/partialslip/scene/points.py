"""Files of points: two columns, x and gap, and the units that their heading states."""

import re

import numpy as np

from partialslip.scene.table import LARGEST, SMALLEST
from partialslip.scene.units import LENGTHS
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError
from partialslip.tools.inputfile import read_text

_LARGEST = 20_000_000  # limit: bytes of a file of points
_FEWEST = 10  # limit: points
_COLUMNS = 2  # fixed: x and gap
_ROUNDING = 1e-12  # accuracy: difference of units, relative, that is rounding
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?")
_BRACKETS = re.compile(r"\[([^\[\]]*)\]|\(([^()]*)\)")
_WORD = re.compile(r"[^\W\d_]+")
_CELLS = re.compile(r"[,;\t]|\s{2,}")
_AMOUNT = re.compile(r"\d\s*[^\W\d_]+(?:/\w+)?")  # fixed: such as 0.5 mm/s: the unit of no column
_ENGLISH = {"m", "in"}  # fixed: units that are also names or words
_IN_FULL = re.compile(
    r"(?:milli|micro|nano|centi|kilo)?met(?:er|re)s?|microns?|inch(?:es)?|mils?|thou|foot|feet|ft|\N{ANGSTROM SIGN}|"
    r"\N{LATIN CAPITAL LETTER A WITH RING ABOVE}|angstroms?|pm|km|dm",
    re.IGNORECASE,
)


def column_units(file: str, given: float | tuple[float, ...] | None, length: float) -> tuple[float, float]:
    """Return the units of the columns x and gap of ``file``, in ``length`` (m).

    Parameters
    ----------
    file : str
    given : float or tuple of float or None
        ``profile.unit``, of both columns or of each, in ``length``.
    length : float

    Raises
    ------
    InputError
        If ``given`` is not that of the heading, nothing is given and the heading names units that cannot be read, or
        the heading names x as the second column.
    """
    lines = _heading(file)
    if swapped := next((line for line in lines if _is_swapped(line)), ""):
        raise InputError(f"profile.file: {file}: heading {swapped.strip()!r:.60}: the columns must be x, then gap")
    words = next(filter(None, map(_stated, reversed(lines))), [])
    known = [LENGTHS.get(word.strip().lower()) for word in words]
    shown = " and ".join(f"[{word}]" for word in words)
    stated = None if None in known else [factor / length for factor in known if factor]
    if given is None:
        if stated is None:
            allowed = ", ".join(dict.fromkeys(LENGTHS))
            raise InputError(
                f"profile.file: {file}: units {shown} in the heading: must be of {allowed}, or give profile.unit"
            )
        if not stated and (unread := next(filter(None, map(_unread, lines)), "")):
            raise InputError(
                f"profile.file: {file}: unit {unread!r} in the heading: must stand behind the name of each column, as "
                "in x [mm], gap [um], or give profile.unit"
            )
        return (stated[0], stated[-1]) if stated else (1.0, 1.0)
    x, gap = given if isinstance(given, tuple) else (given, given)
    if stated and not np.allclose((x, gap), stated, rtol=_ROUNDING, atol=0.0):
        raise InputError(f"profile.unit = {[x, gap]}: must be that of the heading of {file}, {shown}, or be left out")
    return x, gap


def _heading(file: str) -> list[str]:
    """Lines before the first number."""
    found: list[str] = []
    for line in read_text(file, _LARGEST).splitlines():
        if _NUMBER.fullmatch(_words(line)[0]):
            break
        found.append(line)
    return found


def _stated(line: str) -> list[str]:
    """Words for the units of both columns in a ``line`` of the heading, or one that stands for both; empty if there are
    none.

    They are in brackets, in round ones only if they are units, or the last words of the columns' names.
    """
    words = ["".join(pair) for pair in _BRACKETS.findall(line)]
    known = all(word.strip().lower() in LENGTHS for word in words)
    if len(words) == _COLUMNS and (known or all(square for square, _ in _BRACKETS.findall(line))):
        return words
    cells = _cells(line)
    last = [names[-1] for names in cells]
    if len(cells) == 1:
        last = [word for word in cells[0] if word.lower() in LENGTHS.keys() - _ENGLISH]
    if len(last) == _COLUMNS and all(word.lower() in LENGTHS for word in last):
        return last
    alone = len(words) == 1 and len(cells) == 1 and known and not _unread(line.replace(words[0], "", 1))
    return words if alone else []


def _cells(line: str) -> list[list[str]]:
    """Words of each column in a ``line`` of the heading."""
    return [words for cell in _CELLS.split(line) if (words := _WORD.findall(cell))]


def _is_swapped(line: str) -> bool:
    """Whether a ``line`` of the heading names x as the second of two columns."""
    first = [words[0].lower() for words in _cells(line)]
    return len(first) == _COLUMNS and first[1] == "x" != first[0]


def _unread(line: str) -> str:
    """First word of a ``line`` that is a unit of length, but not of an amount; empty if there is none."""
    words = _WORD.findall(_AMOUNT.sub("", line))
    return next((each for each in words if each.lower() in LENGTHS.keys() - _ENGLISH or _IN_FULL.fullmatch(each)), "")


def _words(line: str) -> list[str]:
    return re.split(r"[\s,;]+", line.strip().strip(",;"))


def read_points(file: str, unit: tuple[float, float]) -> tuple[Array, Array]:
    """Read x and gap, (n,) each, times their ``unit``, sorted by x.

    The columns are separated by spaces, tabs, commas or semicolons; lines before the first number, and lines that begin
    with #, are headings.

    Raises
    ------
    InputError
        If the file is no table of two columns with at least ten different x, or a number is neither zero nor of a size
        that a scene allows.
    """
    rows: list[tuple[float, float]] = []
    for number, line in enumerate(read_text(file, _LARGEST).splitlines(), start=1):
        words = _words(line)
        if line.lstrip().startswith("#") or not line.strip() or (not rows and not _NUMBER.fullmatch(words[0])):
            continue
        if len(words) != _COLUMNS or not all(map(_NUMBER.fullmatch, words)):
            raise InputError(f"profile.file: {file}: line {number}: must have two numbers, x and gap")
        place, height = (float(re.sub("[dD]", "e", word)) * each for word, each in zip(words, unit, strict=True))
        for word, value in zip(words, (place, height), strict=True):
            if value and not SMALLEST <= abs(value) <= LARGEST:
                sizes = f"zero or of a size from {SMALLEST} to {LARGEST}"
                raise InputError(f"profile.file: {file}: line {number}: {word}: must be {sizes}")
        rows.append((place, height))
    x, gap = np.array(sorted(rows)).reshape(-1, 2).T
    if len(np.unique(x)) < _FEWEST:
        raise InputError(f"profile.file: {file}: must have at least {_FEWEST} different x, not {len(np.unique(x))}")
    return x, gap
