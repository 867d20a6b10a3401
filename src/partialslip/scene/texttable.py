"""Tables of text as codes, instruments and spreadsheets write them: encoding, separator, decimal mark, heading, rows.

Every line of a file belongs to the heading, is a row, or is left out with a note; else the file is refused.
"""

import csv
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from partialslip.scene.columns import is_unit
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

MOST_ROWS = 1_000_000  # limit: rows of a table
_LOOKED_AT = 2000  # cost: lines from which the separator and the number of columns are found
_TWO = 2  # fixed: fewest columns of a table, most lines of a heading above a rule, numbers without which no row begins
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?|[+-]?inf(?:inity)?", re.IGNORECASE)
_COMMA = re.compile(r"[+-]?\d*,\d+(?:[eEdD][+-]?\d+)?|[+-]?\d+(?:[eEdD][+-]?\d+)?")  # with a decimal comma
_ERRORS = ("#n/a", "#div/0!", "#value!", "#ref!", "#num!")  # of spreadsheets
#: Without signs, in lower case.
_NO_VALUE = {
    "", "novalue", "no value", "n/a", "na", "nan", "null", "none", "bad", *_ERRORS,
    *(f"1.#{word}{'0' * count}" for word in ("ind", "qnan", "snan", "inf") for count in range(7)),
}  # fmt: skip
_BEGIN = set("+-.0123456789")  # letters with which a number begins
_MARKED = re.compile(r"[+-]?(?:\d{1,3}(?:[.,]\d{3})+(?:[.,]\d+)?|\d*[.,]\d*)(?:[eEdD][+-]?\d+)?")
_GROUPED = re.compile(r"[+-]?[1-9]\d{0,2}(?:[.,]\d{3})+")  # 417,615
_RULE = re.compile(r"[\s\-=_*+|]*")
_SUMMARY = re.compile(
    r"(?:min(?:imum)?|max(?:imum)?|total|summ?e?|mean|avg|average|mittelwert|std\w*|rms|range|r[az]|"
    r"at\s+(?:node|element))\b.*|(?:node|element|value)s?\s+[-+.\d].*",
    re.IGNORECASE,
)
_COMMENTS = ("#", "%", "!", "//")
_BEHIND = re.compile(r"(?<=[\s,;])#(?= |$).*")  # a comment behind a row: no 1.#IND, and no name like Node #
#: Lines between the blocks of a report that tell what a block is of.
_LABELS = {
    "part": re.compile(r"reported at .* for (?:part|region|instance|set)s?:\s*(.+)", re.IGNORECASE),
    "step": re.compile(r"step:\s*(.+)", re.IGNORECASE),
    "frame": re.compile(r"frame:\s*(?:increment\s*)?([^:]+)", re.IGNORECASE),
    "source": re.compile(r"odb:\s*(.+)", re.IGNORECASE),
}
_AT = re.compile(r"\s*@loc\s+\d+", re.IGNORECASE)


class TextTable(NamedTuple):
    """Fields of a table.

    Parameters
    ----------
    names : list of str
        Of the columns; their numbers, from 1, if there is no heading.
    columns : list of list of str, or of (n,) arrays
        Fields by column, with decimal points; empty where there is no value. Or numbers.
    lines : list of int
        Lines of the file in which the rows are, from 1.
    head : int
        Line of the heading; 0 if there is none.
    before : list of str
        Lines from the first to the last of the heading, as they stand.
    notes : tuple of str
        What was left out.
    labels : dict of str to str
        What a report says that all rows are of: part, step, frame.
    """

    names: list[str]
    columns: Sequence[list[str] | Array]
    lines: list[int]
    head: int = 0
    before: list[str] = []  # noqa: RUF012
    notes: tuple[str, ...] = ()
    labels: dict[str, str] = {}  # noqa: RUF012

    def only(self, kept: list[int]) -> "TextTable":
        """The table with the ``kept`` rows alone."""
        columns = [column[kept] if isinstance(column, np.ndarray) else [column[row] for row in kept]
                   for column in self.columns]  # fmt: skip
        return self._replace(columns=columns, lines=[self.lines[row] for row in kept])

    def numbers(self, k: int, origin: str) -> Array:
        """Numbers of column ``k``, (n,); NaN where there is no value.

        Raises
        ------
        InputError
            If a field is no number; ``origin`` is the file's name.
        """
        column = self.columns[k]
        if isinstance(column, np.ndarray):
            return column
        try:
            if not any("_" in field for field in column):
                return np.fromiter(map(float, column), float, len(column))
        except ValueError:
            pass
        for line, field in zip(self.lines, column, strict=True):
            if field and not _NUMBER.fullmatch(field):
                raise InputError(f"{origin}: line {line}: {self.names[k]} = {field[:40]!r}: must be a number")
        fields = (field.lower().replace("d", "e") or "nan" for field in column)
        return np.fromiter(map(float, fields), float, len(column))


class _Form(NamedTuple):
    """Form of the rows: the ``separator``, empty for blanks, and the number of columns, ``width``."""

    separator: str
    width: int

    def fields(self, line: str) -> list[str]:
        """Fields of a ``line``, without blanks and quotes around them."""
        if '"' in line:
            try:
                found = next(csv.reader([line.strip()], delimiter=self.separator or " ", skipinitialspace=True))
            except csv.Error:
                return [line]
        else:
            found = line.split(self.separator or None)
        return [field.strip().strip("'") for field in found]


def decoded(data: bytes, origin: str) -> tuple[str, str]:
    """Text of a file in UTF-8, UTF-16 or Latin-1, with newlines as line ends, and a note if it is in Latin-1.

    Raises
    ------
    InputError
        If it is no text; ``origin`` is the file's name.
    """
    encoding = "utf-8-sig"
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        encoding = "utf-16"
    elif data[1:2] == b"\0" or data[:1] == b"\0":
        encoding = "utf-16-le" if data[1:2] == b"\0" else "utf-16-be"
    try:
        text, note = data.decode(encoding), ""
    except UnicodeDecodeError:
        text, note = data.decode("cp1252", "replace"), "read as Latin-1, as it is not UTF-8"
    if wrong := next((c for c in set(text) if c < " " and c not in "\t\n\r\f\v"), ""):
        place = text.index(wrong)
        raise InputError(f"{origin}: must be text; character {place + 1} is not: export a table as text (.csv)")
    return text.replace("\r\n", "\n").replace("\r", "\n"), note


def read_table(text: str, origin: str, loose: bool = False) -> TextTable:
    """Read the table in ``text``; ``origin`` is the file's name for messages. With ``loose``, words above the rows that
    are no heading, as they are no names of all columns, are read by who asks.

    Separators are commas, semicolons, tabs or blanks; commas that do not separate are decimal commas. ``#`` begins a
    comment, behind a row with blanks around it; a heading may be one. A line of units under the heading joins it.
    Blocks of a report, each with its heading and lines of its least and largest values, are one table, with columns
    that tell them apart.

    Raises
    ------
    InputError
        If a line is neither heading nor row nor what reports have between them.
    """
    lines = text.split("\n")
    bare = [_without_comment(line) for line in lines] if any(mark in text for mark in _COMMENTS) else lines
    form, first = _form(bare, origin)
    try:
        names, head, ruled = _heading(lines, bare, form, first, origin)
    except InputError:
        last = next((line for line in reversed(bare[:first]) if line.strip()), "")
        if not loose or is_value(re.split(r"[\s,;]", last.strip().replace(",", " "))[0]):
            raise
        names, head, ruled = _numbered(form)
    rows, numbers, blocks, left = _rows(bare, form, first, (names, head, ruled), origin)
    if len(rows) > MOST_ROWS:
        raise InputError(f"{origin}: {len(rows)} rows: must be at most {MOST_ROWS}")
    columns = _columns(rows, form, numbers, origin)
    apart = _told_apart(blocks, len(rows))
    for name, values in apart.items():
        names, columns = [*names, name], [*columns, values]
    labels = {name: value for name, value in blocks[0][1].items() if name not in apart}
    if above := sum(bool(line.strip()) for line in bare[: head - 1 if head else first]):
        left["line above the heading", "lines above the heading"] = above
    told = [f"{count} {words[count > 1]}" for words, count in left.items()]
    notes = (f"left out: {', '.join(told)}",) if told else ()
    return TextTable(names, columns, numbers, head, lines[: first or 1] if first else [], notes, labels)


def is_value(field: str) -> bool:
    """Whether a ``field`` is a number."""
    return _NUMBER.fullmatch(field) is not None


def _without_comment(line: str) -> str:
    start = line.lstrip()
    if start.startswith(_COMMENTS) and not start[:7].lower().startswith(_ERRORS):
        return ""
    return _BEHIND.sub("", line) if "#" in line else line


def _form(bare: list[str], origin: str) -> tuple[_Form, int]:
    """Form of most rows, and the index of the first line of this form."""
    counts: Counter[_Form] = Counter()
    places: dict[_Form, int] = {}
    for place, line in enumerate(bare[:_LOOKED_AT]):
        form = _form_of(line)
        if form and _is_row(form.fields(line)):
            counts[form] += 1
            places.setdefault(form, place)
    if not counts:
        filled = next((n for n, line in enumerate(bare, start=1) if line.strip()), 0)
        told = f"line {filled}: no row of numbers follows" if filled else "empty"
        raise InputError(f"{origin}: {told}: must have a header line with x, p and dq, and rows of numbers")
    form = counts.most_common(1)[0][0]
    return form, places[form]


def _form_of(line: str) -> _Form | None:
    """Form of a ``line`` if it were a row; None if it has no digit or one column."""
    if not any(map(str.isdigit, line)) and "nan" not in line.lower():
        return None
    separator = next((mark for mark in ";\t," if mark in line), "")
    if separator == "," and '"' not in line:
        words = line.split()
        separator = "" if len(words) >= _TWO and all(map(_COMMA.fullmatch, words)) else ","
    width = len(_Form(separator, 0).fields(line))
    return _Form(separator, width) if width >= _TWO else None


def _is_row(fields: list[str]) -> bool:
    """Whether at least two of the ``fields`` and half of them are numbers or stand for no value, and not all of them
    for none."""
    values = sum(is_value(field.replace(",", ".")) for field in fields)
    none = sum(map(_is_none, fields))
    return values + none >= max(_TWO, len(fields) / 2) and (values > 0 or any(map(str.strip, fields)))


def _heading(
    lines: list[str], bare: list[str], form: _Form, first: int, origin: str
) -> tuple[list[str], int, list[str]]:
    """Names of the columns, the line of the heading (0: none), and its lines, without blanks, if a rule follows it."""
    above = [k for k in range(first) if bare[k].strip()]
    if above and _RULE.fullmatch(bare[above[-1]]):
        return _ruled(bare, form, first, above[:-1], origin)
    if not above:
        return _commented(lines, form, first)
    last = above[-1]
    names = _names(bare[last], form)
    if len(names) == 1 and not any(map(str.isdigit, names[0])):  # prose, or names with blanks between them
        names = names[0].split()
        if len(names) != form.width:
            return _numbered(form)
    if len(above) > 1 and all(_is_unit(name) for name in names) and any(names):
        upper = _names(bare[above[-2]], form)
        if len(upper) == len(names) and not any(map(is_value, upper)):
            brackets = [name if name[:1] in "[(" else f"[{name}]" for name in names]
            names = [
                f"{name} {unit}" if unit.strip("[]()") else name for name, unit in zip(upper, brackets, strict=True)
            ]
            last = above[-2]
    if len(names) == form.width + 1 and not names[-1]:
        names = names[:-1]
    if len(names) == form.width - 1 and not form.fields(bare[first])[-1]:
        names = [*names, ""]
    if any(map(is_value, names)) and not _is_named(names):
        raise InputError(f"{origin}: line {last + 1}: must have {form.width} numbers, like line {first + 1}, or names")
    if len(names) == 1:
        raise InputError(
            f"{origin}: line {last + 1}: must be a header line of {form.width} names, like line {first + 1}"
        )
    if len(names) != form.width:
        raise InputError(f"{origin}: line {first + 1}: must have {len(names)} fields, like the header line")
    return names, last + 1, []


def _is_named(names: list[str]) -> bool:
    """Whether most ``names`` of a heading are words: others may be numbers, as of load points."""
    return 2 * sum(map(is_value, names)) < len(names)


def _is_unit(name: str) -> bool:
    """Whether a cell under a heading is empty or a unit: in brackets, or of few letters."""
    return not name.strip("-") or is_unit(name)


def _ruled(bare: list[str], form: _Form, first: int, above: list[int], origin: str) -> tuple[list[str], int, list[str]]:
    """Heading above a rule, of up to two lines, in columns that end where those of the first row do."""
    if not above:
        return _numbered(form)
    head = [k for k in above[-_TWO:] if above[-1] - k < _TWO]
    ends = [word.end() for word in re.finditer(r"\S+", bare[first])]
    if form.separator or any(" " not in bare[k].ljust(end + 1)[end - 1 : end + 1] for k in head for end in ends):
        names = _names(bare[above[-1]], form)
    else:
        cells = [[bare[k][start:end].strip() for k in head] for start, end in zip([0, *ends[:-1]], ends, strict=True)]
        names = [_AT.sub("", " ".join(filter(None, cell))).strip() for cell in cells]
    if len(names) != form.width:
        raise InputError(f"{origin}: line {first + 1}: must have {len(names)} fields, like the header line")
    return names, head[0] + 1, [" ".join(bare[k].split()) for k in head]


def _commented(lines: list[str], form: _Form, first: int) -> tuple[list[str], int, list[str]]:
    """Heading in the last comment above the rows, if it has as many names as they have columns."""
    for place in range(first - 1, -1, -1):
        words = lines[place].strip().lstrip("#%!/").strip()
        if words:
            for separator in (form.separator, ","):
                names = _names(words, form._replace(separator=separator))
                if len(names) == form.width and not any(map(is_value, names)):
                    return names, place + 1, []
            break
    return _numbered(form)


def _numbered(form: _Form) -> tuple[list[str], int, list[str]]:
    return [str(k + 1) for k in range(form.width)], 0, []


def _names(line: str, form: _Form) -> list[str]:
    """Names in a ``line`` of a heading. A unit in brackets stays with the name before it; where blanks separate, names
    may contain blanks if two or more separate them."""
    if form.separator or '"' in line:
        return form.fields(line)
    wide, parts = re.split(r"\s{2,}", line.strip()), line.split()
    names: list[str] = []
    for part in wide if len(wide) > _TWO or len(wide) == form.width else parts:
        if names and part[0] in "[(":
            names[-1] += f" {part}"
        else:
            names.append(part)
    return names


_Blocks = list[tuple[int, dict[str, str]]]


def _rows(
    bare: list[str], form: _Form, first: int, heading: tuple[list[str], int, list[str]], origin: str
) -> tuple[list[str], list[int], _Blocks, dict[tuple[str, str], int]]:
    """Rows with their line numbers, the first row of each block with its labels, and counts of lines left out."""
    names, head, ruled = heading
    again, labels = " ".join(bare[head - 1].split()) if head and not ruled else "", _labels(bare[:first])
    rows: list[str] = []
    numbers: list[int] = []
    blocks: _Blocks = [(0, labels)]
    left: Counter[tuple[str, str]] = Counter()
    prose: list[str] = []
    counted, separator = form.width - 1, form.separator
    with_number, with_word = _beginnings(bare[first:_LOOKED_AT], form)
    for number, line in enumerate(bare[first:], start=first + 1):
        if not line.strip(f" \t\f\v{separator}"):
            continue
        start = (line.lstrip(" ") if separator else line.lstrip())[0]
        count = line.count(separator) if separator else len(line.split()) - 1
        plain = start in _BEGIN if with_number else not start.isalpha()
        if count == counted and plain and '"' not in line and not prose:
            rows.append(line)
            numbers.append(number)
            continue
        squeezed, fields = " ".join(line.split()), form.fields(line)
        is_row = len(fields) == form.width and _is_row(fields)
        if _RULE.fullmatch(line) and any(mark in line for mark in "-=_*") and len(set(squeezed)) <= _TWO:
            if prose and prose[-len(ruled) :] == ruled:
                blocks.append((len(rows), blocks[-1][1] | _labels(prose)))
                prose = []
        elif again and squeezed == again:
            blocks.append((len(rows), labels))
            left["repeated heading", "repeated headings"] += 1
        elif _SUMMARY.fullmatch(squeezed.lstrip("\"'")) and not (is_row and with_word):
            if is_row and not with_number:
                raise InputError(
                    f"{origin}: line {number}: {fields[0][:40]!r}: must not be a sum, or have another name"
                )
            left["line of a sum or an extreme", "lines of sums or extremes"] += 1
        elif is_row and not prose:
            if with_number and not _begins(fields):
                told = f"line {number}: {names[0]} = {fields[0][:40]!r}"
                raise InputError(f"{origin}: {told}: must be a number, as in other rows")
            rows.append(line)
            numbers.append(number)
        elif ruled and not _is_row(fields):
            prose.append(squeezed)
        elif prose:
            raise InputError(f"{origin}: line {number}: must be under the heading of line {head}: must be one table")
        else:
            like = "the header line" if head else f"line {first + 1}"
            raise InputError(f"{origin}: line {number}: must have {form.width} fields, like {like}")
    if not rows:
        raise InputError(f"{origin}: line {first + 1}: must be followed by rows of numbers")
    return rows, numbers, [block for block in blocks if block[0] < len(rows)], left


def _beginnings(lines: list[str], form: _Form) -> tuple[bool, bool]:
    """Whether most rows among ``lines`` begin with a number, and whether most begin with a word as of a sum."""
    rows = [(line, fields) for line in lines if len(fields := form.fields(line)) == form.width and _is_row(fields)]
    numbers = sum(_begins(fields) for _, fields in rows)
    words = sum(_SUMMARY.fullmatch(" ".join(line.split()).lstrip("\"'")) is not None for line, _ in rows)
    return 2 * numbers > len(rows), 2 * words > len(rows)


def _begins(fields: list[str]) -> bool:
    """Whether the first of the ``fields`` of a row is a number, or says that there is none."""
    return is_value(fields[0].replace(",", ".")) or (fields[0] != "" and _is_none(fields[0]))


def _is_none(field: str) -> bool:
    """Whether a ``field`` stands for no value, with or without a sign."""
    return field.lower().lstrip("+-") in _NO_VALUE


def _labels(lines: list[str]) -> dict[str, str]:
    """What ``lines`` of a report say that the next block is of."""
    found = {}
    for line in lines:
        for name, pattern in _LABELS.items():
            if match := pattern.search(line):
                found[name] = " ".join(match[1].split())
    return found


def _told_apart(blocks: _Blocks, count: int) -> dict[str, list[str]]:
    """Columns of ``count`` rows that tell ``blocks`` apart: their labels that differ, or else their numbers."""
    if len(blocks) < _TWO:
        return {}
    each = np.diff([start for start, _ in blocks] + [count]).tolist()
    keys = dict.fromkeys(key for _, labels in blocks for key in labels)
    values = {key: [labels.get(key, "") for _, labels in blocks] for key in keys}
    values = {key: of for key, of in values.items() if len(set(of)) > 1}
    values = values or {"block": [str(k + 1) for k in range(len(blocks))]}
    return {key: [one for one, n in zip(of, each, strict=True) for _ in range(n)] for key, of in values.items()}


def _grouped(fields: list[str], width: int) -> int | None:
    """Index of one of the ``fields``, by rows of ``width``, with a mark of thousands: marks are of two kinds, or all of
    them are before three digits and numbers without stand in the same column. None if there is none."""
    places = {mark: _marked(fields, mark) for mark in ",."}
    found = {mark: first for mark, of in places.items() if (first := next(of, None)) is not None}
    if len(found) == len(places):
        return max(found.values(), key=lambda k: bool(_GROUPED.match(fields[k])))
    for mark, first in found.items():
        if _GROUPED.fullmatch(fields[first]) and all(_GROUPED.fullmatch(fields[k]) for k in places[mark]):
            column = fields[first % width :: width]
            return first if any(field.lstrip("+-").isdecimal() for field in column) else None
    return None


def _marked(fields: list[str], mark: str) -> Iterator[int]:
    """Indices of the ``fields`` that are numbers with this ``mark``."""
    return (k for k, field in enumerate(fields) if mark in field and _MARKED.fullmatch(field))


def _columns(rows: list[str], form: _Form, numbers: list[int], origin: str) -> list[list[str]]:
    """Fields of ``rows`` by column, with decimal points, and empty where there is no value."""
    joined = (form.separator or " ").join(rows)
    if '"' in joined:
        every = [field for row in rows for field in form.fields(row)]
    else:
        every = joined.split(form.separator or None)  # a list a row would take far longer
    fields = [field.strip().strip("'") for field in every]
    if (wrong := _grouped(fields, form.width)) is not None:
        told = f"line {numbers[wrong // form.width]}: {fields[wrong][:40]}"
        raise InputError(f"{origin}: {told}: thousands separators? must have one decimal mark, and no other")
    if "," in joined:
        fields = [field.replace(",", ".") for field in fields]
    return [["" if _is_none(field) else field for field in fields[k :: form.width]] for k in range(form.width)]
