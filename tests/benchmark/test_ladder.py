"""Ladders of meshes: order, extrapolation and index of values whose error is known; badges."""

import itertools
import re

import msgspec
import pytest
from outline import texts

from partialslip.verify import benchmark
from partialslip.verify.benchmark import Answer, Meta, Rung, Submission
from partialslip.verify.benchmark.codes import code_answers

PROBLEM = benchmark.read_problems()["PS-02"]
SIZES = (0.04, 0.02, 0.01)


def ladder(sizes=SIZES, **errors):
    """Answer whose values are off by these functions of h, in the scale of the target."""
    rungs = tuple(
        Rung(h, {key: PROBLEM.targets[key].value + of(h) * PROBLEM.targets[key].scale for key, of in errors.items()})
        for h in sizes
    )
    return Answer(rungs[-1].values, ladder=rungs)


def climb(key, answer):
    return next(each for each in benchmark.climbs(PROBLEM, answer) if each.key == key)


@pytest.mark.parametrize("order", [0.5, 1.0, 1.5, 2.0, 4.0])
def test_a_power_law_is_found_and_extrapolated(order):
    found = climb("m", ladder(m=lambda h: 3 * h**order))
    assert found.order == pytest.approx(order, rel=1e-6)
    assert found.error == pytest.approx(3 * 0.01**order, rel=1e-9)
    assert found.left < 1e-6 * found.error + 1e-12
    assert found.gci == pytest.approx(1.25 * found.error, rel=1e-6)
    assert found.extrapolated == pytest.approx(PROBLEM.targets["m"].value, rel=1e-12)


def test_the_index_covers_the_error_of_two_terms():
    found = climb("a", ladder(a=lambda h: h + 4 * h**2))
    assert 1 < found.order < 1.2
    assert found.error < found.gci < 1.4 * found.error
    assert found.left == pytest.approx(0.0104 - 0.0112**2 / (0.0248 - 0.0112))  # Aitken's formula for these errors


def test_what_has_no_order_says_why():
    assert climb("m", ladder(m=lambda h: {0.04: 1e-2, 0.02: -1e-3, 0.01: 1e-3}[h])).why == "not monotone"
    assert climb("m", ladder(m=lambda h: {0.04: 0.0, 0.02: 1e-3, 0.01: 5e-3}[h])).why == "not monotone"  # diverges
    assert climb("m", ladder(m=lambda _: 1e-3)).why == "not monotone"
    assert climb("m", ladder(sizes=(0.04, 0.03, 0.01), m=lambda h: h)).why == "no constant ratio"
    assert climb("n", ladder(m=lambda h: h)).why == "not given"
    assert benchmark.climbs(PROBLEM, Answer({})) == []


def test_ladders_of_extreme_numbers_end():
    """Ratios and differences that overflow, or differ by a rounding only."""
    numbers = (5e-324, 1e-308, 1.0, 1 + 2e-16, 3 - 4e-16, 1e200, 1e308, -1e308)
    sizes = [(1e308, 1e-200, 1e-308), (4.0, 2.0, 1.0), (1e300, 1e299, 1e298), (1 + 4e-16, 1 + 2e-16, 1.0)]
    for h in sizes:
        for values in itertools.product(numbers, repeat=3):
            rungs = tuple(Rung(size, {"a": value}) for size, value in zip(h, values, strict=True))
            benchmark.climbs(PROBLEM, Answer(rungs[-1].values, ladder=rungs))


def test_the_last_three_of_more_meshes_count():
    assert climb("m", ladder(sizes=(0.5, 0.04, 0.02, 0.01), m=lambda h: h**2)).order == pytest.approx(2)


@pytest.mark.slow
def test_linear_elements_answer_on_a_ladder(tmp_path):
    found = code_answers("fem-P1", {"PS-02": PROBLEM})
    answer = found.answers["PS-02"]
    assert [rung.h for rung in answer.ladder] == [0.1, 0.05, 0.025, 0.0125]
    assert [rung.unknowns for rung in answer.ladder] == sorted(rung.unknowns for rung in answer.ladder)
    benchmark.write_submission(found, tmp_path)
    assert benchmark.read_submission(tmp_path, benchmark.read_problems()) == found


def test_a_badge_tells_the_worst_grades():
    good = {key: target.value for key, target in PROBLEM.measured.items()}
    off = good | {"m": good["m"] + 2e-3 * PROBLEM.targets["m"].scale}
    submission = Submission(Meta("My code, v2", "1"), {"PS-02": Answer(off)})
    assert benchmark.badge_names([submission]) == ["badge-my-code-v2.svg"]
    shown = texts(benchmark.badge(submission, {"PS-02": PROBLEM}))[1:]
    groups = ["contact A", "stick C", "tractions A", "points A", "levels A", "slip A", "stress A"]
    assert shown == ["My code, v2: 1 of 1", *groups]
    strange = msgspec.structs.replace(submission, meta=Meta("<&>", "1"))
    assert benchmark.badge_names([strange]) == ["badge-code.svg"]
    assert not re.search(r"<&>", benchmark.badge(strange))
