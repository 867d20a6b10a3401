"""Grades: how near a code comes to the targets of a problem, from A to D by its worst target, and E beyond."""

import math
from collections.abc import Mapping

import msgspec

from partialslip.verify.benchmark.measured import GROUPS
from partialslip.verify.benchmark.problem import Problem, Target
from partialslip.verify.benchmark.submission import Answer

# fixed: largest error of each grade, over the bar of the quantity
LIMITS = {"A": 1e-4, "B": 1e-3, "C": 1e-2, "D": 5e-2}
BEYOND = "E"
NOT_OFFERED, NOT_GRADED = "not offered", "not graded"
_SURE = 0.2  # limit: largest uncertainty of a target, in the limit of a grade
HEADLINE = (
    "contact",
    "stick",
    "tractions",
)  # groups that a problem must have answered in full, and that make the whole


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
    """

    grade: str
    worst: str = ""
    error: float | None = None


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


def graded(problem: Problem, answer: Answer) -> Graded:
    """Grade ``answer`` to ``problem``. A value that is not finite is none."""
    errors = {
        key: abs(value - problem.targets[key].value) / problem.targets[key].scale
        for key, value in answer.values.items()
        if value is not None and math.isfinite(value)
    }
    marks = {}
    for group in GROUPS:
        some = {key: target for key, target in problem.targets.items() if target.group == group}
        if some:
            marks[group] = _mark(some, errors)
    counted = [marks[group] for group in HEADLINE if group in marks]
    return Graded(max(counted, key=lambda mark: (_rank(mark), mark.error or 0.0)), marks, errors)


def best_grade(problem: Problem) -> str:
    """The highest grade of the whole that the uncertainty of the targets of ``problem`` allows."""
    headline = [target for target in problem.targets.values() if target.group in HEADLINE]
    unsure = max(target.uncertainty for target in headline)
    return next((grade for grade, limit in LIMITS.items() if unsure <= _SURE * limit), NOT_GRADED)


def _mark(targets: Mapping[str, Target], errors: Mapping[str, float]) -> Mark:
    missing = [key for key in targets if key not in errors]
    if missing:
        return Mark(NOT_OFFERED, missing[0])
    worst = max(targets, key=lambda key: errors[key])
    unsure = max(target.uncertainty for target in targets.values())
    if errors[worst] > max(LIMITS.values()):
        return Mark(BEYOND, worst, errors[worst])
    reached = [grade for grade, limit in LIMITS.items() if errors[worst] <= limit and unsure <= _SURE * limit]
    return Mark(reached[0] if reached else NOT_GRADED, worst, errors[worst])


def _rank(mark: Mark) -> int:
    return [*LIMITS, BEYOND, NOT_GRADED, NOT_OFFERED].index(mark.grade)
