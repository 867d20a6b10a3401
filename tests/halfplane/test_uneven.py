"""Contacts that are not even: moments, tilted bodies and profiles with two different sides."""

import numpy as np
import pytest
from plain import plain
from quadrature import rule
from refusing import line_of

from partialslip import run
from partialslip.halfplane import contact, contact_of, stick_zone
from partialslip.halfplane.uneven import _Search, press_uneven

TABLE = np.linspace(-2e-3, 2.5e-3, 91)
SIDES = np.where(TABLE < 0, TABLE**2 / 0.02, TABLE**2 / 0.04 + np.maximum(TABLE, 0) ** 4 * 3e4)
PROFILES = {
    "hertz": {"kind": "hertz", "R": 0.01},
    "flat": {"kind": "flat-rounded", "R": 0.01, "b": 1e-3},
    "narrow corners": {"kind": "flat-rounded", "R": 0.01, "b": 0.1},
    "table": {"kind": "tabulated", "x": TABLE, "gap": SIDES},
    "even table": {"kind": "tabulated", "x": np.linspace(0, 2e-3, 60), "gap": np.linspace(0, 2e-3, 60) ** 4 * 1e5},
}


def made(profile, **load):
    load = {"P": 1e5, "Q": [-1e4, 1e4], "sigma": [-3e7, 3e7], **load}
    return plain(load, profile=PROFILES[profile] if isinstance(profile, str) else profile)


def integrals(pressed):
    """int p dx and int x p dx between the kinks, where p has logarithms."""
    x, weights = rule(np.unique(np.clip([-1.0, *pressed.shape.kinks, 1.0], -1, 1)))
    p = pressed.p0 * pressed.shape.pressure(x) * weights * pressed.a
    return p.sum(), ((pressed.centre + pressed.a * x) * p).sum()


@pytest.mark.parametrize("profile", ["hertz", "flat", "narrow corners", "even table"])
@pytest.mark.parametrize("moment", [0.0, None])
def test_even_contacts_are_a_special_case(profile, moment):
    scene = made(profile)
    even, A = contact(scene), scene.material.A
    found = press_uneven(scene.profile.curvature, A * scene.P, moment, scene.length)
    x = np.linspace(-1, 1, 101)
    assert found.a == pytest.approx(even.a, rel=1e-14)
    assert abs(found.centre) < 1e-14 * even.a
    assert abs(found.tilt) < 1e-14
    # where the corners are narrow, the even form loses digits: its terms cancel
    np.testing.assert_allclose(found.shape.pressure(x), even.shape.pressure(x), atol=2e-10)


@pytest.mark.parametrize(("profile", "e"), [
    ("hertz", 3e-5), ("flat", 1e-6), ("flat", 5e-4), ("flat", 8e-4), ("flat", 1.5e-3), ("narrow corners", 0.02),
    ("table", -4e-5), ("table", 0.0), ("even table", 2e-5),
])  # fmt: skip
def test_pressure_carries_force_and_moment(profile, e):
    pressed = contact(made(profile, e=e))
    force, moment = integrals(pressed)
    assert force == pytest.approx(1e5, rel=1e-8)
    assert moment / force == pytest.approx(e, abs=1e-8 * pressed.a)


@pytest.mark.parametrize(("profile", "moment"), [
    ("flat", 1e-6), ("flat", 5e-4), ("flat", 1.5e-3), ("table", -4e-5), ("table", None), ("even table", 2e-5),
])  # fmt: skip
def test_brackets_where_newton_fails(monkeypatch, profile, moment):
    scene = made(profile)
    force = scene.material.A * scene.P
    given = scene.profile.curvature, force, None if moment is None else force * moment, scene.length
    found = press_uneven(*given)
    monkeypatch.setattr(_Search, "newton", lambda *_: None)
    bracketed = press_uneven(*given)
    assert (bracketed.centre, bracketed.a) == pytest.approx((found.centre, found.a), abs=1e-9 * found.a)


def test_far_from_the_middle():
    """At the largest distance allowed a and the stick zone keep nine digits."""
    e = 999 * made("hertz").length
    near, far = (run(made("hertz", e=each), ["exact"]).results["exact"] for each in (0.0, e))
    assert far.a == pytest.approx(near.a, rel=1e-12)
    assert far.n - e == pytest.approx(near.n, abs=1e-9 * near.a)
    assert far.traction.at(e).p == pytest.approx(near.traction.at(0.0).p, rel=1e-9)


def test_moment_moves_a_parabola():
    scene = made("hertz", M=3.0)
    found = press_uneven(scene.profile.curvature, scene.material.A * scene.P, scene.material.A * 3.0, scene.length)
    pressed = contact(scene)
    assert (pressed.centre, pressed.tilt) == pytest.approx((3e-5, 3e-3), rel=1e-14)
    assert (found.centre, found.a, found.tilt) == pytest.approx((3e-5, pressed.a, 3e-3), rel=1e-13)


@pytest.mark.parametrize("profile", ["flat", "table"])
def test_bodies_conform_to_the_gap(profile):
    """The surfaces' slope under p is that of the gap, less the tilt: by an independent sum over cells."""
    scene = made(profile, e=2e-5)
    pressed, A = contact(scene), scene.material.A
    x = pressed.centre + pressed.a * np.array([-0.7, 0.05, 0.6])
    ends = pressed.centre - pressed.a * np.cos(np.linspace(0, np.pi, 4001))
    middle = (ends[1:] + ends[:-1]) / 2
    kernel = np.log(np.abs((ends[:-1] - x[:, None]) / (ends[1:] - x[:, None])))
    slope = -A / np.pi * kernel @ pressed.pressure(middle)
    np.testing.assert_allclose(slope, pressed.tilt - scene.profile.curvature.slope_at(x), atol=2e-5)


def test_fixed_tilt_is_kept():
    turned = {**PROFILES["table"], "tilt": "fixed"}
    fixed = contact(made(turned))
    assert abs(fixed.tilt) < 1e-14
    free = contact(made("table", M=integrals(fixed)[1]))
    assert (free.centre, free.a) == pytest.approx((fixed.centre, fixed.a), rel=1e-8)
    assert abs(free.tilt) < 1e-8


@pytest.mark.parametrize(("profile", "load"), [
    ("table", {}), ("table", {"sigma": [-1.5e8, 1.5e8]}), ("flat", {"e": 4e-4, "sigma": [4e7, -4e7]}),
])  # fmt: skip
def test_mirrored_scenes_have_mirrored_results(profile, load):
    x, gap = (PROFILES["table"][key] for key in ("x", "gap"))
    mirrored = {"kind": "tabulated", "x": -x[::-1], "gap": gap[::-1]} if profile == "table" else profile
    one = made(profile, **load)
    other = made(mirrored, **load | {"e": -load.get("e", 0.0), "Q": [1e4, -1e4]})
    a, b = (run(each, ["exact"]).results["exact"] for each in (one, other))
    assert a.regime == b.regime
    assert (a.m, a.n) == pytest.approx((b.n, b.m), abs=1e-12 * a.a)
    at = np.linspace(*a.ends[1], 41)[1:-1]
    np.testing.assert_allclose(a.traction.at(at)[:2], [[1], [-1]] * np.array(b.traction.at(-at)[:2]), atol=1e-9 * a.p0)


def test_a_given_pressure_need_not_be_even():
    pressed = contact(made("table"))
    given = contact_of(pressed.pressure, pressed.a, np.array(pressed.shape.kinks) * pressed.a + pressed.centre,
                       pressed.centre)  # fmt: skip
    assert pytest.approx(pressed.P, rel=1e-9) == given.P
    zones = [stick_zone(each, 0.3, 2e4, [-9e7, 0.0, 9e7]) for each in (pressed, given)]
    np.testing.assert_allclose(zones[0].m, zones[1].m, rtol=1e-7)
    np.testing.assert_allclose(zones[0].n, zones[1].n, rtol=1e-7)


@pytest.mark.parametrize("sigma", [2e7, -1.2e8])
def test_marching_agrees(sigma):
    scene = made("table", sigma=[-sigma, sigma], e=1e-5)
    outcome = run(scene.replace(fem={"accuracy": 1e-3}), ["exact", "march"])
    assert outcome.passed
    assert outcome.comparisons["march"].errors["M"] < 1e-9


@pytest.mark.parametrize(("profile", "load", "message"), [
    ({**PROFILES["table"], "tilt": "fixed"}, {"M": 1.0}, "load.M = 1.0: must not be given with profile.tilt = 'fixed'"),
    ("hertz", {"M": 1.0, "e": 1e-5}, "load.e = 1e-05: must not be given together with load.M"),
    ("hertz", {"e": 1e3}, "load.e = 1000.0: must keep the line of action of P within"),
    ("hertz", {"e": [0.0, 1e3]}, "load.e = [0.0, 1000.0]: must keep the line of action of P within"),
    ("hertz", {"M": [0.0, 1.0], "e": [0.0, 1e-5]}, "load.e = [0.0, 1e-05]: must not be given together with load.M"),
    ("hertz", {"M": -1e100}, "load.M = -1e+100: must keep the line of action of P within"),
    ({**PROFILES["table"], "gap": 0 * SIDES + 3.0}, {}, "profile.gap: must increase at the last x, right of"),
    ({**PROFILES["table"], "gap": SIDES[::-1] * 0 + np.linspace(0, 1, 91)}, {}, "profile.gap: must fall at the first"),
    ({**PROFILES["table"], "x": TABLE + 3e-3}, {}, "profile.x[0] = 0.001: must be 0, the middle of the contact, or"),
    ("table", {"e": 2.4e-3}, "must keep the contact within profile.x, between -0.002 and 0.0025 m"),
])  # fmt: skip
def test_bad_input_is_named(profile, load, message):
    assert message in line_of(lambda: contact(made(profile, **load)))
