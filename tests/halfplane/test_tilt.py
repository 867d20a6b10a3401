"""Contacts pressed with a given tilt, and flats that are not quite flat."""

import numpy as np
import pytest
from plain import plain

import partialslip
from partialslip import halfplane
from partialslip.scene import Pressing
from partialslip.tools.errors import InputError

P = 2e6
X = np.linspace(-3e-3, 3e-3, 61)
FLAT = {"kind": "flat-rounded", "R": 0.01, "b": 1e-3}
PROFILES = {
    "hertz": {"kind": "hertz", "R": 0.05},
    "flat": FLAT,
    "crowned": {**FLAT, "crown": 0.3},
    "hollow": {**FLAT, "crown": -1.0},
    "even table": {"kind": "tabulated", "x": X[30:], "gap": X[30:] ** 2 / 0.02 + 1e3 * X[30:] ** 4},
    "uneven table": {"kind": "tabulated", "x": X, "gap": np.where(X < 0, X**2 / 0.01, X**2 / 0.03)},
}


def scene_of(profile, **load):
    return plain({"P": P, **load}, material=(72e9, 0.33), profile=profile)


@pytest.mark.parametrize("kind", PROFILES)
@pytest.mark.parametrize("M", [30.0, -120.0])
def test_the_tilt_that_a_moment_makes_makes_the_moment(kind, M):
    scene = scene_of(PROFILES[kind])
    turned = halfplane.contact(scene, Pressing(P, M))
    found = halfplane.tilted_contact(scene, P, turned.tilt)
    assert (found.centre, found.a) == pytest.approx((turned.centre, turned.a), rel=1e-11)
    assert found.moment == pytest.approx(M, rel=1e-9)
    assert turned.moment == pytest.approx(M, rel=1e-9)
    assert found.tilt == turned.tilt
    assert np.sign(turned.tilt) == np.sign(M) or kind == "uneven table"


@pytest.mark.parametrize("kind", PROFILES)
def test_without_tilt_the_bodies_stay_as_they_are(kind):
    scene = scene_of(PROFILES[kind])
    found, other = halfplane.tilted_contact(scene, P, 0.0), halfplane.tilted_contact(scene, P, 1e-12)
    assert found.a == pytest.approx(other.a, rel=1e-6)
    assert found.centre == pytest.approx(other.centre, abs=1e-7 * found.a)
    if kind != "uneven table":
        assert found == halfplane.contact(scene) or found.a == halfplane.contact(scene).a


@pytest.mark.parametrize("kind", ["flat", "crowned", "hollow"])
@pytest.mark.parametrize("M", [0.0, 100.0])
def test_the_pressure_closes_the_gap(kind, M):
    """A/pi PV int p/(x - t) dt = g'(x) - tilt, and the resultants are P and M."""
    scene = scene_of(PROFILES[kind])
    pressed = halfplane.contact(scene, Pressing(P, M))
    angle = (np.arange(100_000) + 0.5) / 100_000 * np.pi
    t = pressed.places(np.cos(angle))
    weights, p = pressed.a * np.sin(angle) * np.pi / 100_000, pressed.pressure(t)
    assert p @ weights == pytest.approx(P, rel=1e-7)
    assert p @ (weights * t) == pytest.approx(M, abs=1e-7 * P * pressed.a)
    for x in (-0.9e-3, -0.2e-3, 0.5e-3, 1.05e-3):
        here, (left, right) = pressed.pressure(x), pressed.ends
        strain = ((p - here) / (x - t)) @ weights + here * np.log((x - left) / (right - x))
        slope = float(scene.profile.curvature.slope_at(np.array(x))) - pressed.tilt
        assert scene.material.A / np.pi * strain == pytest.approx(slope, abs=1e-8)
        step = 1e-7
        gap = scene.profile.gap_at(np.array([x - step, x + step]))
        assert np.diff(gap)[0] / (2 * step) == pytest.approx(slope + pressed.tilt, abs=1e-8)


def test_a_crown_of_large_radius_is_flat_and_a_small_flat_round():
    flat, hardly = (halfplane.contact(scene_of({**FLAT, **more})) for more in ({}, {"crown": 1e9}))
    assert hardly.a == pytest.approx(flat.a, rel=1e-9)
    round_, tiny = (
        halfplane.contact(scene_of(profile))
        for profile in ({"kind": "hertz", "R": 0.05}, {**FLAT, "b": 0.1, "crown": 0.05})
    )
    assert tiny.a == pytest.approx(round_.a, rel=1e-12)
    assert tiny.pressure(0.3e-3) == pytest.approx(round_.pressure(0.3e-3), rel=1e-12)


@pytest.mark.parametrize("crown", [-0.5, 0.2])
def test_finite_elements_agree_on_a_crown(crown):
    loads = {"Q": [-2e5, 2e5], "sigma": [-5e7, 5e7]}
    scene = scene_of({**FLAT, "crown": crown}, **loads).replace(fem={"accuracy": 1e-3})
    found = partialslip.run(scene, ["exact", "march", "fem"])
    assert found.passed, found.missed


def test_a_flat_too_hollow_is_refused():
    with pytest.raises(InputError, match=r"^profile.crown = 0.0: must be > 0, or < -0.01 m"):
        scene_of({**FLAT, "crown": 0})
    with pytest.raises(InputError, match=r"^profile.crown = -0.01: must be > 0, or < -0.01 m"):
        scene_of({**FLAT, "crown": -0.01})
    with pytest.raises(InputError, match=r"^profile.crown = -0.02 m: must be less hollow: the flat is not in contact"):
        halfplane.contact(scene_of({**FLAT, "crown": -0.02}))
    with pytest.raises(InputError, match=r"^profile.crown = 1.0: must be left out with a pad, bodies.upper"):
        scene_of({**FLAT, "crown": 1.0}).replace(bodies={"upper": {"kind": "pad", "width": 0.005, "height": 0.005}})
