"""The scoreboard: codes, their grades for each problem, what they cost, and the standing of each.

The standing says how many problems of the whole edition count, and gives a grade for each group of targets.
A problem counts if every headline target has a value: those of contact, stick and tractions. A group has the worst
grade of all problems with any value, also of those that do not count, and says how many of them lack a value of the
group: nothing gets better by leaving values out, by empty answers or by a choice of problems.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from partialslip.verify.benchmark.grade import BEYOND, LIMITS, NOT_GRADED, NOT_OFFERED, Graded, graded
from partialslip.verify.benchmark.measured import GROUPS
from partialslip.verify.benchmark.problem import Problem, read_problems
from partialslip.verify.benchmark.submission import Submission

_ORDER = (*LIMITS, BEYOND)


class Board(NamedTuple):
    """Table of grades: ``headings``, ``rows`` and the columns of ``words``."""

    headings: tuple[str, ...]
    rows: list[tuple[str, ...]]
    words: tuple[int, ...]


def grades(problems: Mapping[str, Problem], submission: Submission) -> dict[str, Graded]:
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
