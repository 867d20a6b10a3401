"""Curves of the problems, by which norms of errors are measured, are those of the targets."""

import numpy as np
import pytest
from closed import CLOSED, exact
from msgspec.structs import replace

from partialslip.verify.benchmark import graded, read_problems
from partialslip.verify.benchmark.curves import curve_of, curves_text, read_curves
from partialslip.verify.benchmark.grade import LIMITS, limit
from partialslip.verify.benchmark.measured import answer_of, norms

PROBLEMS = read_problems()
NEAR = {True: 2e-7, False: 3e-4}  # of the scale: exact solutions, and finite elements


@pytest.mark.parametrize("number", PROBLEMS)
def test_curves_go_through_the_targets(number):
    problem, curve = PROBLEMS[number], read_curves()[number]
    off = {}
    for key, target in problem.targets.items():
        name, _, place = key.partition("@")
        if place and name in ("p", "dq"):
            x = np.array([float(place) * problem.targets["a"].value])
            off[key] = abs(float(getattr(curve.at(x), name)[0]) - target.value) / target.scale
    assert off
    smooth = len(problem.scene.profile.curvature.breaks) < 1 and number in CLOSED
    assert max(off.values()) < (NEAR[True] if smooth else NEAR[False]), max(off, key=off.get)


@pytest.mark.parametrize("number", ["PS-02", "PS-05", "PS-11", "PS-12"])
def test_the_exact_answer_has_no_error(number):
    found = norms(PROBLEMS[number], exact(number))
    assert found.keys() == {"p", "q"}
    assert all(each.value < 1e-6 for each in found.values())


def test_norms_are_those_of_score():
    """A pressure 1 % too large has a norm of 1e-2; q is half of dq's."""
    result = exact("PS-02")
    of = result.traction

    def more(x):
        found = of.at(x)
        return found._replace(p=1.01 * found.p, dq=0.98 * found.dq)

    larger = type(of)(of.x, more(of.x), more, of.breaks)
    found = norms(PROBLEMS["PS-02"], replace_traction(result, larger))
    assert found["p"].value == pytest.approx(0.01, rel=1e-6)
    assert found["q"].value == pytest.approx(0.02, rel=1e-6)


def replace_traction(result, traction):
    from dataclasses import replace as changed

    return changed(result, traction=traction)


@pytest.mark.parametrize(("p", "grade"), [(9e-4, "A"), (2e-3, "B"), (0.09, "C"), (0.11, "E")])
def test_tractions_are_graded_by_the_bars_of_score(p, grade):
    answer = answer_of(PROBLEMS["PS-02"], exact("PS-02"))
    found = graded(PROBLEMS["PS-02"], replace(answer, values=answer.values | {"p": p}))
    assert (found.overall.grade, found.overall.worst) == (grade, "p")
    assert limit("q", "B") == 15e-3
    assert limit("q", "D") == 0.1
    assert LIMITS["D"] == limit("m", "D") == 5e-2


@pytest.mark.fault
def test_a_single_point_decides_no_headline_grade():
    """Of old the worst point decided: dq at 0.5 a in PS-02 lies 0.013 a inside the end of the stick zone."""
    answer = answer_of(PROBLEMS["PS-02"], exact("PS-02"))
    spoiled = replace(answer, values=answer.values | {"dq@0.5": 1.3 * answer.values["dq@0.5"]})
    found = graded(PROBLEMS["PS-02"], spoiled)
    assert found.overall.grade == "A"
    assert found.groups["points"].grade == "E"


def test_estimates_stand_beside_grades_and_are_in_none():
    answer = answer_of(PROBLEMS["PS-02"], exact("PS-02"))
    spoiled = replace(answer, values=answer.values | {"m": 1.01 * answer.values["m"]}, estimate={"m": 0.02})
    plain = graded(PROBLEMS["PS-02"], replace(spoiled, estimate={}))
    found = graded(PROBLEMS["PS-02"], spoiled)
    assert found.overall.grade == plain.overall.grade == "C"
    assert (found.overall.estimate, plain.overall.estimate) == (0.02, None)


def test_curves_are_written_as_they_are_read():
    some = {"PS-01": read_curves()["PS-01"]}
    assert "PS-01" in curves_text(some)
    again = curve_of(exact("PS-01"), np.zeros(0))
    assert again.breaks == pytest.approx(some["PS-01"].breaks, rel=1e-12)
