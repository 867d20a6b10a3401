"""The scoreboard: codes, their grades for each problem, and what they cost."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from partialslip.benchmark.grade import NOT_OFFERED, Graded, graded
from partialslip.benchmark.problem import Problem
from partialslip.benchmark.submission import Submission


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
