"""Problems are data that stand alone, and their targets are frozen."""

import math

import numpy as np
import pytest
from closed import CLOSED, exact
from msgspec.structs import replace

from partialslip import load_scene, run
from partialslip.scene import Effects, Fatigue
from partialslip.scene.reading import shipped_scenes
from partialslip.study.fatigue import hot_spots
from partialslip.tools.errors import InputError
from partialslip.verify.benchmark import read_problems
from partialslip.verify.benchmark.freeze import covering, frozen_parts
from partialslip.verify.benchmark.measured import GROUPS, quantities
from partialslip.verify.benchmark.problem import EDITION, chosen_problems, problem_checksum, read_frozen, texts

PROBLEMS = read_problems()


def test_no_problem_and_no_target_moves_within_an_edition():
    frozen = read_frozen()
    assert frozen.edition == EDITION
    assert list(frozen.targets) == list(texts())
    assert frozen.checksums == {number: problem_checksum(number, frozen.targets[number]) for number in texts()}


@pytest.mark.parametrize("number", CLOSED)
def test_targets_in_closed_form_are_found_again(number):
    problem = PROBLEMS[number]
    found = quantities(problem.scene, exact(number), problem.places)
    assert found.keys() >= problem.targets.keys()
    for key, target in problem.targets.items():
        assert abs(found[key].value - target.value) <= target.uncertainty * target.scale, key


def test_stresses_have_the_errors_that_a_run_tells():
    scene, places = PROBLEMS["PS-03"].scene, PROBLEMS["PS-03"].places
    fem = run(scene.replace({"fem.accuracy": 1e-2}), "fem", subsurface=True)["fem"]
    found, spots = quantities(scene, fem, places), hot_spots(scene, fem)
    for key, spot in {"sigma_xx": "sigma_xx", "swt": "swt", "swt_line": "swt.line"}.items():
        assert found[key].error * found[key].scale == pytest.approx(spots[spot].error * spots[spot].value, rel=1e-12)


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
    assert list(chosen_problems(None)) == list(PROBLEMS)
    assert list(chosen_problems("PS-02")) == ["PS-02"]
    assert list(chosen_problems("PS-0?, PS-02")) == [number for number in PROBLEMS if number < "PS-10"]
    with pytest.raises(InputError, match=r"--problems 'PS-99': must be numbers of PS-0"):
        chosen_problems("PS-99")


@pytest.mark.parametrize(("off", "unsure", "covered"), [(-3e-4, 1e-5, 3.1e-4), (5e-5, 1e-5, 1e-4)])
def test_an_uncertainty_grows_to_cover_another_way(off, unsure, covered):
    target = replace(PROBLEMS["PS-22"].targets["p@0"], uncertainty=1e-4, known="march")
    found = covering(target, "others", off, unsure)
    assert found.uncertainty == pytest.approx(covered)
    assert found.value == target.value
    assert found.known == f"march; others within {abs(off):.0e}"


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
        load = problem.scene.load
        traceless = problem.scene.material.alike or not any(load.Q)  # the first loading of unlike bodies leaves a trace
        if problem.scene.even and traceless and not any(load.sigma) and "m" in problem.targets:
            m, n = problem.targets["m"], problem.targets["n"]
            assert abs(m.value - n.value) <= 1.001 * m.uncertainty * m.scale
    assert "left_1" not in PROBLEMS["PS-23"].targets
    assert "left_1" in PROBLEMS["PS-21"].targets  # the contact moves
    assert "left_1" in PROBLEMS["PS-20"].targets  # the contact grows


def test_a_problem_in_a_shipped_scene_is_kept_once():
    for number, name in (("PS-03", "fretting-aluminium"), ("PS-11", "flat-rounded")):
        ours, theirs = PROBLEMS[number].scene, load_scene(name)
        assert ours.replace(name=name, title=theirs.title, effects=Effects(), fatigue=Fatigue()) == theirs
    shipped = {each.replace(name="x", title="") for each in map(load_scene, shipped_scenes())}
    texts_of = texts()
    for number, problem in PROBLEMS.items():
        own = problem.scene.replace(name="x", title="", effects=Effects(), fatigue=Fatigue())
        assert (own in shipped) == ('scene = "' in texts_of[number]), number


def test_problems_that_ask_for_stress_say_so():
    asked = {number for number, problem in PROBLEMS.items() if problem.scene.effects.subsurface}
    assert {"PS-03", "PS-05"} < asked
    assert asked == {number for number, problem in PROBLEMS.items() if "sigma_xx" in problem.targets}
    assert all("sigma_xx along the surface" in PROBLEMS[number].statement for number in asked)


def test_the_largest_stress_under_a_cylinder_is_known():
    """Cattaneo and Mindlin: at the end of the contact f p gives 2 f p0, and the corrective ellipse of half-width c
    takes 2 f p0 (1 - sqrt(1 - c^2/a^2)) away; c^2/a^2 = 1 - Q/(f P)."""
    problem = PROBLEMS["PS-02"]
    f, p0 = problem.scene.friction.f, problem.targets["p_max"].value
    sheared = problem.scene.load.Q[1] / (f * problem.scene.P)
    assert problem.targets["sigma_xx"].value == pytest.approx(2 * f * p0 * np.sqrt(sheared), rel=1e-12)


def test_a_statement_says_what_the_width_of_strips_does():
    """m of infinitely long strips is 1.4e-4 a larger in PS-29, and a the same."""
    problem = PROBLEMS["PS-29"]
    widths = {f"bodies.{name}.width": "infinite" for name in ("upper", "lower")}
    found = run(problem.scene.replace(widths), "exact")["exact"]
    a, m = (problem.targets[key] for key in "am")
    assert found.a == pytest.approx(a.value, rel=1e-12)
    assert (found.m - m.value) / m.scale == pytest.approx(1.4e-4, rel=0.05)
    assert "1.4e-4 a" in problem.why
