"""The scoreboard: codes, their grades for each problem, what they cost, and the standing of each.

The standing says how many problems of the whole edition count, and gives a grade for each group of targets.
A problem counts if every headline target has a value: those of contact, stick and tractions. A group has the worst
grade of all problems with any value, also of those that do not count, and says how many of them lack a value of the
group: nothing gets better by leaving values out, by empty answers or by a choice of problems.
"""

import hashlib
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import msgspec

from partialslip.tools.output.page import template
from partialslip.verify.benchmark.grade import BEYOND, LIMITS, NOT_GRADED, NOT_OFFERED, Graded, graded
from partialslip.verify.benchmark.measured import GROUPS
from partialslip.verify.benchmark.problem import EDITION, Posed, Problem, read_problems
from partialslip.verify.benchmark.submission import Submission, check_apart

_ORDER = (*LIMITS, BEYOND)
_LETTER, _MARGIN = 6.6, 12.0  # display: width of a letter and of both margins of a cell; the text is fitted to its cell
_INK, _PAPER, _NONE = "#ffffff", "#333333", "#6b6b6b"
_FILLS = {"A": "#1a7f37", "B": "#4c7a1a", "C": "#8a6d00", "D": "#a34a00", "E": "#b3261e"}  # 4.5 : 1 to white, or more
_HASHED = re.compile(r"-[0-9a-f]{8}$")


class Board(NamedTuple):
    """Table of grades: ``headings``, ``rows`` and the columns of ``words``."""

    headings: tuple[str, ...]
    rows: list[tuple[str, ...]]
    words: tuple[int, ...]


def grades(problems: Mapping[str, Posed], submission: Submission) -> dict[str, Graded]:
    """Grades of a submission, by number of the problem."""
    return {
        number: graded(problems[number], answer) for number, answer in submission.answers.items() if number in problems
    }


def scoreboard(problems: Mapping[str, Problem], submissions: Sequence[Submission]) -> Board:
    """Table with the ``problems`` in rows and the codes of the ``submissions`` in columns: grade and CPU seconds."""
    found = [grades(problems, submission) for submission in submissions]
    table = []
    for number in problems:
        cells = [_cell(own.get(number), each, number) for own, each in zip(found, submissions, strict=True)]
        table.append((number, *cells))
    heads = tuple(f"{each.meta.code} {each.meta.version}".strip() for each in submissions)
    return Board(("", *heads), table, tuple(range(1, 1 + len(heads))))


def _cell(graded: Graded | None, submission: Submission, number: str) -> str:
    if number in submission.answers and not submission.answers[number].values:
        return "none"  # the code tried, and its note says why there are no values
    if graded is None or graded.overall.grade == NOT_OFFERED:
        return "–"
    spent = submission.answers[number].cpu_s
    if spent is None:
        return graded.overall.grade
    return f"{graded.overall.grade} ({spent:{'.2g' if spent < 100 else '.0f'}} s)"


class Group(NamedTuple):
    """Standing in one group of targets.

    Parameters
    ----------
    name : str
    grade : str
        The worst of all answers; "not offered" if none has all values of the group; "not graded" if the targets are
        not sure enough.
    lacking : int
        Number of answered problems that lack a value of this group.
    """

    name: str
    grade: str
    lacking: int

    @property
    def text(self) -> str:
        """Name and grade, and the number of answered problems that lack a value."""
        more = f", {self.lacking} not offered" if self.lacking and self.grade != NOT_OFFERED else ""
        return f"{self.name} {self.grade}{more}"


class Standing(NamedTuple):
    """Number of problems that ``counted`` ``of`` those of the edition, and the ``groups``."""

    counted: int
    of: int
    groups: tuple[Group, ...]


def standing(submission: Submission, problems: Mapping[str, Problem] | None = None) -> Standing:
    """Standing of a ``submission`` in the ``problems``, by default the whole edition."""
    every = read_problems() if problems is None else problems
    found = [each for each in grades(every, submission).values() if each.answered]
    groups = []
    for name in GROUPS:
        marks = [each.groups[name].grade for each in found if name in each.groups]
        known = [mark for mark in marks if mark in _ORDER]
        rest = NOT_GRADED if NOT_GRADED in marks else NOT_OFFERED
        worst = max(known, key=_ORDER.index) if known else rest
        groups.append(Group(name, worst, marks.count(NOT_OFFERED)))
    return Standing(sum(each.counts for each in found), len(every), tuple(groups))


class _Cell(NamedTuple):
    x: float
    width: float
    fill: str
    ink: str
    text: str


def badge_names(submissions: Sequence[Submission]) -> list[str]:
    """Return the names of the badges' files of ``submissions``, all different.

    A name is made of ASCII letters, digits, dots and hyphens of the code's name. Where several would be alike, each has
    a checksum of code, version, settings and machine.

    Raises
    ------
    InputError
        As :func:`partialslip.verify.benchmark.submission.check_apart`.
    """
    check_apart(submissions)
    plain = [_ascii(each.meta.code) for each in submissions]
    count = Counter(plain)
    return [
        f"badge-{name}-{_checksum(each)}.svg" if count[name] > 1 or _HASHED.search(name) else f"badge-{name}.svg"
        for name, each in zip(plain, submissions, strict=True)
    ]


def badge(submission: Submission, problems: Mapping[str, Problem] | None = None) -> str:
    """Return the badge of a ``submission``: edition, code, how many problems count, and the grade of each group
    (:func:`partialslip.verify.benchmark.scoreboard.standing`), over the ``problems`` or the whole edition."""
    found = standing(submission, problems)
    texts = [
        (f"contact benchmark {EDITION}", _PAPER),
        (f"{submission.meta.code}: {found.counted} of {found.of}", _PAPER),
        *((group.text, _FILLS.get(group.grade, _NONE)) for group in found.groups),
    ]
    cells: list[_Cell] = []
    for text, fill in texts:
        x = cells[-1].x + cells[-1].width if cells else 0.0
        cells.append(_Cell(x, round(_LETTER * len(text) + _MARGIN, 1), fill, _INK, text))
    width, title = cells[-1].x + cells[-1].width, ", ".join(text for text, _ in texts)
    return template("partialslip.verify.benchmark", "badge.svg").render(cells=cells, width=width, title=title)


def _ascii(code: str) -> str:
    return re.sub(r"[^a-z0-9.-]+", "-", code.lower()).strip("-.") or "code"


def _checksum(submission: Submission) -> str:
    return hashlib.sha256(msgspec.json.encode(submission.meta)).hexdigest()[:8]
