"""Random scenes with varying pressure; nothing is solved but contacts."""

import functools
import itertools

import numpy as np
import pytest

from partialslip.halfplane.contact import contact
from partialslip.run.judge import Outcome
from partialslip.verify import suites
from partialslip.verify.case import run_case
from partialslip.verify.random_scenes import SHARE, WAYS, draw, draw_varying, varies
from partialslip.verify.suites import stress_case

SEED = 4
NUMBERS = [number for number in range(150) if varies(SEED, number)]


def test_a_share_of_the_scenes_varies_and_all_others_stay():
    share = np.mean([varies(0, number) for number in range(3000)])
    assert share == pytest.approx(SHARE, abs=0.03)
    constant = [number for number in range(12) if number not in NUMBERS]
    for number in constant:
        assert stress_case("march", SEED, number).scene == draw(SEED, number).scene
    assert draw_varying(SEED, NUMBERS[0]) == draw_varying(SEED, NUMBERS[0])


def test_varying_scenes_are_of_every_kind():
    found = [draw_varying(SEED, number) for number in NUMBERS]
    assert {kind.split(", ")[-1] for kind, _ in found} == {f"{way} varies" for way in WAYS}
    scenes = [scene for _, scene in found]
    assert {type(scene.profile).__name__ for scene in scenes} == {"Hertz", "FlatRounded", "Tabulated"}
    assert min(len(scene.load.points) for scene in scenes) == 2
    assert max(len(scene.load.points) for scene in scenes) > 4
    largest = [max(P for P, _ in scene.pressing) / min(P for P, _ in scene.pressing) for scene in scenes]
    assert min(largest) == 1
    assert max(largest) > 100
    for kind, scene in found:
        assert all(contact(scene, pressing).a > 0 for pressing in scene.pressing)
        assert scene.load.in_phase or kind.startswith("out of phase")


@pytest.mark.slow
def test_the_reference_is_exact_where_it_has_a_closed_form(monkeypatch):
    for name in ("draw_varying", "reference"):  # the same for all methods
        monkeypatch.setattr(suites, name, functools.cache(getattr(suites, name)))
    cases = {
        method: [stress_case(method, SEED, number) for number in NUMBERS[:12]] for method in ("exact", "march", "fem")
    }
    assert {case.reference for case in cases["exact"]} == {""}
    assert {case.methods for case in cases["exact"]} == {("exact",), ("march",)}
    assert {case.reference for case in cases["march"]} == {"exact", ""}
    assert {case.reference for case in cases["fem"]} == {"exact", "march"}
    for one, other in zip(cases["march"], cases["fem"], strict=True):
        assert one.scene == other.scene
        assert (one.reference == "exact") == (other.reference == "exact")


@pytest.mark.parametrize("method", ["march", pytest.param("fem", marks=pytest.mark.slow)])
def test_a_varying_scene_is_judged(method):
    """The first scene of which exact is the reference passes, ends of the contact at both load points included."""
    cases = (stress_case(method, SEED, number) for number in NUMBERS)
    case = next(itertools.filterfalse(lambda case: case.reference != "exact" or case.scene.slides, cases))
    verdicts = run_case(case)
    assert {v.outcome for v in verdicts} <= {Outcome.PASSED, Outcome.NOT_JUDGED}
    assert {"certificate", "regime", "left_1", "right_2", "p_1", "m", "q"} <= {v.quantity for v in verdicts}
