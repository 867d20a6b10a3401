"""Grades follow from the worst target, and from how well the targets are known."""

import msgspec
import pytest

from partialslip.verify.benchmark import Answer, graded, read_problems

PROBLEM = read_problems()["PS-02"]


def answer(**off):
    """The targets, some of them off by this many scales."""
    shift = {key.replace("_at_", "@"): value for key, value in off.items()}
    return Answer({key: target.value + shift.get(key, 0.0) * target.scale for key, target in PROBLEM.targets.items()})


@pytest.mark.parametrize(
    ("off", "grade"), [(0.0, "A"), (9e-5, "A"), (2e-4, "B"), (-2e-3, "C"), (4e-2, "D"), (-0.06, "E")]
)
def test_the_worst_target_decides(off, grade):
    found = graded(PROBLEM, answer(m=off))
    assert found.overall.grade == found.groups["stick"].grade == grade
    assert found.groups["contact"].grade == found.groups["tractions"].grade == "A"
    assert off == 0 or found.overall.worst == "m"
    assert off == 0 or found.overall.error == pytest.approx(abs(off))


def test_a_missing_value_is_not_offered():
    known = answer()
    less = msgspec.structs.replace(known, values={key: each for key, each in known.values.items() if key != "n"})
    none = msgspec.structs.replace(known, values=known.values | {"n": None})
    for given in (less, none):
        assert graded(PROBLEM, given).groups["stick"].grade == "not offered"
        assert graded(PROBLEM, given).overall.grade == "not offered"


def test_no_grade_is_better_than_the_targets_are_known():
    unsure = {
        key: msgspec.structs.replace(target, uncertainty=1e-3) if key == "m" else target
        for key, target in PROBLEM.targets.items()
    }
    problem = msgspec.structs.replace(PROBLEM, targets=unsure)
    assert graded(problem, answer()).groups["stick"].grade == "C"
    assert graded(problem, answer(m=0.02)).groups["stick"].grade == "D"
    worse = {key: msgspec.structs.replace(target, uncertainty=0.1) for key, target in unsure.items()}
    assert graded(msgspec.structs.replace(PROBLEM, targets=worse), answer()).overall.grade == "not graded"
