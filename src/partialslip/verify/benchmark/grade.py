"""Grades: how near a code comes to a problem, from A to D by its worst error, and E beyond.

Lengths are off by errors in a; tractions by relative L2 norms, of which p may have 10 and q 15 times as much, and no
more than 0.1 (:mod:`partialslip.tools.bars`). A headline grade is the smallest of the :data:`LIMITS` at which
``partialslip score`` would pass. Values at points are detail.
"""

import math
from collections.abc import Mapping

import msgspec

from partialslip.tools.bars import asked
from partialslip.verify.benchmark.measured import GROUPS, HEADLINE
from partialslip.verify.benchmark.problem import Posed, Target
from partialslip.verify.benchmark.submission import Answer

# fixed: largest error of each grade; of p and q the bar of an accuracy
LIMITS = {"A": 1e-4, "B": 1e-3, "C": 1e-2, "D": 5e-2}
BEYOND = "E"
NOT_OFFERED, NOT_GRADED = "not offered", "not graded"
NORMS = ("p", "q")  # fixed: keys of norms
_SURE = 0.2  # limit: largest uncertainty of a target, in the limit of a grade


class Mark(msgspec.Struct, frozen=True):
    """Grade of a group of targets, or of a problem.

    Parameters
    ----------
    grade : str
        A to E; "not offered" if a value is missing; "not graded" if the targets are not sure enough.
    worst : str
        Key of the target that decides; empty without one.
    error : float or None
        Its error, in the scale of the target.
    estimate : float or None
        The answer's own estimate of this error, or the uncertainty of reading the value, where it is known. The grade
        knows nothing of it.
    """

    grade: str
    worst: str = ""
    error: float | None = None
    estimate: float | None = None


class Graded(msgspec.Struct, frozen=True):
    """Marks of an answer: ``overall``, the worst of contact, stick and tractions, and by ``groups``; and its ``errors``
    by key of the target, in the target's scale."""

    overall: Mark
    groups: dict[str, Mark]
    errors: dict[str, float]

    @property
    def answered(self) -> bool:
        """Whether there is a value for any target."""
        return bool(self.errors)

    @property
    def counts(self) -> bool:
        """Whether there is a value for every headline target: those of contact, stick and tractions."""
        return self.overall.grade != NOT_OFFERED

    @property
    def lacks(self) -> tuple[str, ...]:
        """For each headline group that is not answered in full, the first target without a value."""
        return tuple(
            mark.worst for group, mark in self.groups.items() if group in HEADLINE and mark.grade == NOT_OFFERED
        )


def graded(problem: Posed, answer: Answer) -> Graded:
    """Grade ``answer`` to ``problem``. A value that is not finite is none."""
    measured = problem.measured
    errors = {
        key: abs(value - measured[key].value) / measured[key].scale
        for key, value in answer.values.items()
        if value is not None and math.isfinite(value)
    }
    marks = {}
    for group in GROUPS:
        some = {key: target for key, target in measured.items() if target.group == group}
        if some:
            marks[group] = _mark(some, errors, answer.estimate)
    counted = [marks[group] for group in HEADLINE if group in marks]
    return Graded(max(counted, key=lambda mark: (_rank(mark), mark.error or 0.0)), marks, errors)


def best_grade(problem: Posed) -> str:
    """The highest grade of the whole that the uncertainty of the targets of ``problem`` allows."""
    headline = {key: target for key, target in problem.measured.items() if target.group in HEADLINE}
    return next((grade for grade in LIMITS if _sure(headline, grade)), NOT_GRADED)


def limit(key: str, grade: str) -> float:
    """Largest error of a ``grade``: of the norms p and q the bar of the judge."""
    wanted = asked(LIMITS[grade])
    return wanted.bars[key] if wanted and key in NORMS else LIMITS[grade]


def _sure(targets: Mapping[str, Target], grade: str) -> bool:
    return all(target.uncertainty <= _SURE * limit(key, grade) for key, target in targets.items())


def _mark(targets: Mapping[str, Target], errors: Mapping[str, float], estimate: Mapping[str, float]) -> Mark:
    missing = [key for key in targets if key not in errors]
    if missing:
        return Mark(NOT_OFFERED, missing[0])
    coarsest = list(LIMITS)[-1]
    worst = max(targets, key=lambda key: errors[key] / limit(key, coarsest))
    found = worst, errors[worst], estimate.get(worst)
    if errors[worst] > limit(worst, coarsest):
        return Mark(BEYOND, *found)
    reached = [
        grade for grade in LIMITS if all(errors[key] <= limit(key, grade) for key in targets) and _sure(targets, grade)
    ]
    return Mark(reached[0] if reached else NOT_GRADED, *found)


def _rank(mark: Mark) -> int:
    return [*LIMITS, BEYOND, NOT_GRADED, NOT_OFFERED].index(mark.grade)
