"""One meaning of the stick zone in all problems, and the problem in which slip turns round."""

import json
import runpy
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from closed import CLOSED, exact

from partialslip.codes.export.load_steps import steps_of
from partialslip.halfplane import contact
from partialslip.halfplane.turning import half_cycle
from partialslip.verify.benchmark import read_problems, turning
from partialslip.verify.benchmark.codes.calculix import Calculix
from partialslip.verify.benchmark.codes.getfem import GetFEM
from partialslip.verify.benchmark.codes.opensees import OpenSees
from partialslip.verify.benchmark.increments import gradual, refined
from partialslip.verify.benchmark.neutral import files
from partialslip.verify.benchmark.turning import event_by_event, slip_reverses

PROBLEMS = read_problems()
NUMBER = "PS-27"
PROBLEM = PROBLEMS[NUMBER]
CYCLIC = [number for number, problem in PROBLEMS.items() if {"m", "dq@0.5"} <= problem.targets.keys()]
CLOSED_CYCLIC = [number for number in CYCLIC if number in CLOSED]
READING = runpy.run_path(str(Path(__file__).parents[2] / "benchmarks" / "peers" / "increments.py"))


@pytest.fixture(scope="module")
def followed():
    """PS-27 by boundary elements."""
    return event_by_event(PROBLEM.scene, PROBLEM.places)


def off(found, key):
    """Error of ``found`` in the scale of the target."""
    return abs(found[key] - PROBLEM.targets[key].value) / PROBLEM.targets[key].scale


def test_slip_turns_round_in_one_problem_alone():
    assert [number for number, problem in PROBLEMS.items() if slip_reverses(problem.scene)] == [NUMBER]


def test_the_statements_have_one_meaning_of_the_stick_zone():
    for number, problem in PROBLEMS.items():
        said = " ".join(problem.statement.split())
        assert ("The stick zone [-m, n] is that of the tractions: the points with" in said) == ("m" in problem.targets)
        same = "In this problem these are also the points that" in said
        assert same == (number in CYCLIC and number != NUMBER)
    gradually = " ".join(PROBLEM.statement.split())
    assert "In this problem these are not the points that never slip" in gradually
    assert "They change gradually, slowly and in proportion to each other" in gradually


@pytest.mark.parametrize("number", CLOSED_CYCLIC)
def test_the_stick_zone_is_that_of_the_tractions(number):
    """|dq| < f (p1 + p2) within, and the bound beyond, of points in contact at both load points."""
    found, f = exact(number), PROBLEMS[number].scene.friction.f
    of = found.traction
    x, p1, p2, dq = (of.x, of.p1, of.p, of.dq) if PROBLEMS[number].scene.presses_anew else (of.x, of.p, of.p, of.dq)
    x, room = x[(p1 > 0) & (p2 > 0)], (f * (p1 + p2) - np.abs(dq))[(p1 > 0) & (p2 > 0)] / (2 * f * found.p0)
    near = 1e-9 * found.a
    assert (room[(x > -found.m + near) & (x < found.n - near)] > 0).all()
    assert np.abs(room[(x < -found.m - near) | (x > found.n + near)]).max(initial=0) < 1e-12


def test_points_that_never_slip_are_fewer_in_this_problem_alone():
    for number in CLOSED_CYCLIC:
        found = exact(number)
        if found.permanent:
            same = np.allclose(found.permanent, (-found.m, found.n), rtol=0, atol=1e-9 * found.a)
            assert same == (number != NUMBER)
    left, right = exact(NUMBER).permanent
    assert left == pytest.approx(-0.7033 * PROBLEM.targets["a"].value, rel=1e-4)
    assert right == pytest.approx(PROBLEM.targets["n"].value, rel=1e-9)


def test_boundary_elements_followed_event_by_event_confirm_the_targets(followed):
    """They share the pressure with the exact method, and nothing else."""
    assert max(off(followed, key) for key in ("m", "n")) < 1e-6
    assert max(off(followed, key) for key in followed if key.startswith("dq@")) < 2e-5
    assert off(followed, "dissipated") < 1e-5


def test_the_targets_leave_out_what_is_not_known():
    assert {target.group for target in PROBLEM.targets.values()} == {"contact", "stick", "tractions", "slip"}
    assert max(PROBLEM.targets[key].uncertainty for key in ("m", "n")) <= 1e-6


@pytest.mark.fault
def test_one_step_from_load_point_to_load_point_is_seen(followed):
    """Deliberate fault: the tractions of a single step as targets."""
    scene = PROBLEM.scene
    pressed, f = contact(scene), scene.friction.f
    once = half_cycle(pressed, f, scene.load.dQ, scene.load.dsigma).once
    assert abs(-once.zone.left - followed["m"] / pressed.a) > 0.1
    changes = np.array([followed[f"dq@{place:g}"] for place in PROBLEM.places]) / (f * pressed.p0)
    assert np.abs(once.traction(np.array(PROBLEM.places)) - changes).max() > 0.05


@pytest.mark.fault
def test_cells_that_do_not_divide_the_zone_that_drifts_are_seen(monkeypatch):
    """Deliberate fault: 102.5 and 205 cells across the zone. m is then off by a part of a cell, and extrapolation from
    both does not take it away."""
    monkeypatch.setattr(turning, "_width", lambda *given: 0.8 / given[-1])
    assert off(event_by_event(PROBLEM.scene, PROBLEM.places), "m") > 1e-4


def test_increments_are_those_that_the_problem_needs():
    def steps(number, *given):
        return gradual(PROBLEMS[number].scene, *given).load.steps

    assert [steps(number) for number in ("PS-01", "PS-06", "PS-20", NUMBER)] == [1, 1, 16, 64]
    assert [steps(NUMBER, given) for given in (1, 8, 64)] == [1, 8, 64]
    assert "8 increments a step" in Calculix(0.1, True, 8).settings
    assert "increments" not in GetFEM(0.1).settings


def test_codes_take_just_the_increments_that_are_asked_for():
    """After pressing: without friction yet, more of them change nothing."""
    steps = steps_of(gradual(PROBLEM.scene, 2))
    assert {step.increments for step in refined(steps, 8)} == {8}
    press, *others = refined(steps, 8, 2)
    assert press.increments == 8
    assert {step.increments for step in others} == {2}
    assert "stick, 2 increments a step" in OpenSees(0.1, 8, 2).settings
    assert "at least 8 increments a step" in OpenSees(0.1, 8).settings


def test_decks_take_the_increments():
    written = files(PROBLEM)
    steps = json.loads(written["model.json"])["steps"]
    assert {step["increments"] for step in steps[1:]} == {64}
    assert "0.015625" in written["calculix-mortar.inp"].decode()


def test_an_end_that_has_drifted_is_read_from_exact_tractions():
    """At points 0.05 a apart it is 0.01 too large: the page of the scoreboard says so."""
    found, f = exact(NUMBER), PROBLEM.scene.friction.f
    x = found.a * np.linspace(-0.95, 0.95, 39)
    p, dq, *_ = found.traction.at(x)
    read = SimpleNamespace(traction=SimpleNamespace(x=x, p=p, dq=dq))
    assert READING["drifted"](read, found.a, f) == pytest.approx(found.m / found.a + 0.01, abs=0.004)
