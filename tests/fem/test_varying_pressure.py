"""Finite elements under varying P and M: against the closed form, and what bodies of other kinds do."""

import math

import numpy as np
import pytest
from plain import plain
from varying_scenes import varying

from partialslip import load_scene, run
from partialslip.march import driver
from partialslip.tools.errors import InputError


@pytest.mark.parametrize(
    ("scene", "slips"),
    [
        (varying((1, 0.8), -0.32 * math.pi, -0.4, (0.05, 0), cycles=2, accuracy=1e-3), ("backwards", "backwards")),
        pytest.param(
            varying((math.sqrt(0.6), math.sqrt(0.9)), 0.1 * math.pi, 0.1, cycles=2, accuracy=1e-3),
            ("never", "never"),
            marks=pytest.mark.slow,
        ),
    ],
    ids=["both ends slip", "no slip"],
)
def test_finite_elements_agree_with_the_closed_form(scene, slips):
    result = run(scene, ["exact", "fem"])
    assert result.passed
    assert result["fem"].end_slips == slips
    errors = result.comparisons["fem"].errors
    assert max(errors[key] for key in ("left_1", "right_1", "left_2", "right_2")) < 1e-4
    assert max(errors["p"], errors["p_1"]) < 1e-3
    assert result["fem"].p0 == pytest.approx(result["exact"].p0, rel=1e-4)
    assert result["fem"].certificate["equilibrium"] < 1e-9


@pytest.mark.parametrize(
    "change",
    [
        {"material": {"upper": {"E": 3.64, "nu": 0.3}, "lower": {"E": 10.92, "nu": 0.3}, "E": None, "nu": None}},
        {"bodies": {"upper": {"kind": "block", "width": 20.0, "height": 20.0}}},
    ],
    ids=["unlike", "finite"],
)
def test_bodies_of_other_kinds(change):
    """P at both load points is held, and the larger P has the larger contact."""
    scene = varying((1, 0.9), 0.4, 0.0, f=0.5, cycles=1, accuracy=1e-2).replace(change).replace(fem={"size": 0.1})
    result = run(scene, ["fem"])["fem"]
    (left1, right1), (left2, right2) = result.ends
    assert right1 - left1 > right2 - left2
    assert result.a == pytest.approx((right1 - left1) / 2)
    assert result.traction.p1 is not None
    assert result.certificate["equilibrium"] < 1e-9


def test_without_tangential_loads_both_contacts_are_found():
    result = run(varying((0.8, 1), 0.0, 0.0, accuracy=1e-3), ["exact", "fem"])
    assert result.passed
    assert result["fem"].regime == result["exact"].regime == "stuck"


@pytest.mark.slow
def test_contacts_that_have_nothing_in_common():
    """A moment moves the contact by more than its width: a contact line around one has not the moment of the other."""
    scene = varying((1, 0.9), 0.02, 0.0, (-2, 2), cycles=1)
    result = run(scene, ["fem"])["fem"]
    assert np.array(result.ends) == pytest.approx(np.array([(-3, -1), (1.1, 2.9)]), abs=1e-4)
    far = varying((1, 0.9), 0.02, 0.0, (-20, 20), cycles=1)
    with pytest.raises(InputError, match=r"^load\.M, load\.e: must move the line of action .*; use march$"):
        run(far, ["fem"])


@pytest.mark.parametrize("method", ["march", pytest.param("fem", marks=pytest.mark.slow)])
def test_no_stick_zone_without_a_point_in_contact_at_both_load_points(method, monkeypatch):
    """A punch that rolls from one edge to the other, in which no point sticks all the time. The moment of a single node
    does not depend on the angle; taken for a slope, its rounding error once turned the punch off the other body."""
    monkeypatch.setattr(driver, "MESHES", driver.MESHES[:4])
    scene = load_scene(
        "flat-rounded", ["load.M=[2e3, -2e3]", "fem.accuracy=1e-1", "load.sigma=[0, 0]", "load.cycles=1"]
    )
    result = run(scene, [method])[method]
    assert result.contact_ends[0][0] > result.contact_ends[1][1]
    assert result.m is result.n is None
    assert "m" not in result.estimate
    assert "no point is in contact at both load points: there is no stick zone" in result.notes


@pytest.mark.parametrize("method", ["march", "fem"])
def test_what_does_not_slip_does_not_ratchet(method):
    """No end slips; relative to the largest slip, which is rounding, so is the slip of a whole cycle: 1."""
    load = {"P": [12996.94968303615, 8319.07592189774], "Q": [1394.5783132456947, 155.94873652021462]}
    f, material, profile = 0.30086574442786695, (32397301897.722683, 0.3), {"kind": "hertz", "R": 0.03}
    scene = plain(load, f, material, profile, fem={"accuracy": 1e-3})
    results = run(scene, ["exact", method])
    assert results["exact"].regime == "no slip"
    assert results[method].regime == "no slip"
    assert results[method].m == pytest.approx(results["exact"].m, rel=1e-3)
