"""Problems are data that stand alone, and their targets are frozen."""

import math

import pytest

from partialslip.benchmark import read_problems
from partialslip.benchmark.freeze import frozen_parts, ways
from partialslip.benchmark.measured import GROUPS, quantities
from partialslip.benchmark.problem import EDITION, checksum, chosen, read_frozen, texts
from partialslip.errors import InputError
from partialslip.run import run

PROBLEMS = read_problems()
CLOSED = [number for number, problem in PROBLEMS.items() if ways(problem)[0][0] == "exact"]


def test_no_problem_and_no_target_moves_within_an_edition():
    frozen = read_frozen()
    assert frozen.edition == EDITION
    assert list(frozen.targets) == list(texts())
    assert frozen.checksums == {number: checksum(number, frozen.targets[number]) for number in texts()}


@pytest.mark.parametrize("number", CLOSED)
def test_targets_in_closed_form_are_found_again(number):
    problem = PROBLEMS[number]
    found = quantities(problem.scene, run(problem.scene, "exact")["exact"], problem.places)
    assert found.keys() >= problem.targets.keys()
    for key, target in problem.targets.items():
        assert abs(found[key].value - target.value) <= target.uncertainty * target.scale, key


@pytest.mark.parametrize("number", PROBLEMS)
def test_every_target_has_a_size_and_says_how_it_is_known(number):
    problem = PROBLEMS[number]
    assert "a" in problem.targets
    for target in problem.targets.values():
        assert math.isfinite(target.value)
        assert target.scale > 0
        assert 0 < target.uncertainty < 0.2
        assert target.group in GROUPS
        assert "within" in target.known  # a second way


def test_problems_are_chosen_by_patterns():
    assert list(chosen(None)) == list(PROBLEMS)
    assert list(chosen("PS-02")) == ["PS-02"]
    assert list(chosen("PS-0?, PS-02")) == [number for number in PROBLEMS if number < "PS-10"]
    with pytest.raises(InputError, match=r"--problems 'PS-99': must be numbers of PS-0"):
        chosen("PS-99")


@pytest.mark.slow
def test_a_target_is_frozen_again_by_both_ways():
    problem = PROBLEMS["PS-02"]
    targets, regime = frozen_parts(problem)
    assert regime == problem.regime
    assert targets.keys() == problem.targets.keys()
    for key, target in targets.items():
        assert abs(target.value - problem.targets[key].value) <= target.uncertainty * target.scale, key


def test_symmetric_problems_have_symmetric_stick_zones_and_no_ends_of_their_own():
    for problem in PROBLEMS.values():
        if problem.scene.even and not any(sigma for _, sigma in problem.scene.load.points) and "m" in problem.targets:
            m, n = problem.targets["m"], problem.targets["n"]
            assert abs(m.value - n.value) <= 1.001 * m.uncertainty * m.scale
    assert "left_1" not in PROBLEMS["PS-23"].targets
    assert "left_1" in PROBLEMS["PS-21"].targets
