"""Stick zones that move along the contact while the loads change: steps are refined until they follow."""

import numpy as np
import pytest
from msgspec.structs import replace

from partialslip import run
from partialslip.condensed import steps
from partialslip.condensed.history import march
from partialslip.halfplane import marching
from partialslip.halfplane.hertz import Hertz
from partialslip.verify.hard_cases.scenes import hard_scene

HALF = 1e-5  # of the stick zone that the closed form has, in a; at x = -0.3 a
LOADS = Hertz().conditions(np.array(0.7 - HALF), np.array(HALF), np.array(-1))
SCENE = hard_scene("huge-tension", float(LOADS.Qf), float(LOADS.sf), fem={"accuracy": 1e-2})


def by_march(scene=SCENE):
    return run(scene, ["march"]).results["march"]


@pytest.fixture(scope="module")
def limits():
    """m and n in a in the limit of equal steps, and half of what the last doubling of their number changed."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(marching, "march_refined", lambda C, x, bound, path, *_: (march(C, x, bound, path), {}))
        scenes = [replace(SCENE, load=replace(SCENE.load, steps=count)) for count in (64, 128)]
        few, many = (np.array([found.m, found.n]) / found.a for found in map(by_march, scenes))
    return 2 * many - few, np.abs(many - few) / 2


def test_refined_steps_follow_the_zone(limits):
    """Errors are within their estimates, beside the first-order limit of equal steps."""
    (m, n), unsure = limits
    found = by_march()
    assert abs(found.m / found.a - 0.3) > 0.03  # which is the closed form's, of one step
    assert abs(found.m / found.a - m) <= found.estimate["m"] + unsure[0]
    assert abs(found.n / found.a - n) <= found.estimate["n"] + unsure[1]


@pytest.mark.fault
def test_one_step_taken_for_enough(limits, monkeypatch):
    """Deliberate fault: steps are compared with their halves only, which all end with the same tractions."""
    monkeypatch.setattr(steps, "_PROBED", 1)
    found = by_march()
    assert found.estimate["m"] < 0.03
    assert abs(found.m / found.a - limits[0][0]) > found.estimate["m"] + limits[1][0]
