"""Hot spots: the largest stresses of a result, and whether their estimates hold."""

import msgspec
import numpy as np
import pytest

import partialslip
from partialslip.scene.plan import asks_for_stresses
from partialslip.study.fatigue import HotSpot, assess, assessment, hot_spots
from partialslip.study.fatigue.spots import off_by

SCENE = partialslip.load_scene("fretting-aluminium").replace({"fatigue.distance": 50e-6, "fem.accuracy": 1e-4})
AVERAGES = {f"{name}.{over}" for name in ("principal", "swt") for over in ("point", "line", "area")}


@pytest.fixture(scope="module")
def exact():
    return partialslip.run(SCENE, "exact", subsurface=True)["exact"]


def test_hot_spots_are_those_of_run_and_of_the_assessment(exact):
    found = hot_spots(SCENE, exact)
    assert set(found) == {"sigma_xx", "principal", "swt"} | AVERAGES
    assert (found["sigma_xx"].x, found["sigma_xx"].value) == exact.surface.largest
    ratings = assess(SCENE, exact, ["principal", "swt"]).ratings
    for name, rating in ratings.items():
        assert (found[name].value, found[name].x) == (rating.surface.value, rating.surface.x)
        for over, spot in rating.averages.items():
            assert found[f"{name}.{over}"].value == spot.value
    assert found["sigma_xx"].error == 0
    assert msgspec.json.decode(msgspec.json.encode(found), type=dict[str, HotSpot]) == found


def test_a_scene_gets_the_stresses_that_it_asks_for(exact):
    plain = SCENE.replace({"fatigue.distance": None})
    assert set(hot_spots(plain, exact)) == {"sigma_xx"}
    assert not asks_for_stresses(plain)
    assert asks_for_stresses(SCENE)
    assert asks_for_stresses(plain.replace({"effects.subsurface": True}))
    assert not asks_for_stresses(SCENE.replace({"effects.subsurface": False}))


@pytest.mark.parametrize("subsurface", [None, False, True])
def test_stresses_that_a_run_finds_on_its_way_are_left_out_if_forced_off(subsurface):
    found = partialslip.run(SCENE.replace({"effects.subsurface": subsurface}), "exact", stresses=True)["exact"]
    assert (found.surface is None) == (subsurface is False)
    assert hot_spots(SCENE, partialslip.run(SCENE, "exact")["exact"]) == {}


def test_without_tension_nothing_is_largest():
    """P alone leaves the surface beside a Hertz contact free of stress."""
    pressed = SCENE.replace({"load.Q": [0.0, 0.0], "load.sigma": [0.0, 0.0]})
    assert hot_spots(pressed, partialslip.run(pressed, "exact", subsurface=True)["exact"]) == {}


@pytest.mark.slow
def test_stresses_are_mirrored_with_the_loads_and_scale_with_them(exact):
    found = hot_spots(SCENE, exact)
    turned = SCENE.replace({"load.Q": [-Q for Q in SCENE.load.Q]})
    mirrored = hot_spots(turned, partialslip.run(turned, "exact", subsurface=True)["exact"])
    harder = SCENE.replace({"material.E": 3 * SCENE.material.E, "load.P": 3 * SCENE.P,
                            "load.Q": [3 * Q for Q in SCENE.load.Q],
                            "load.sigma": [3 * sigma for sigma in SCENE.load.sigma]})  # fmt: skip
    scaled = hot_spots(harder, partialslip.run(harder, "exact", subsurface=True)["exact"])
    for key, spot in found.items():
        assert mirrored[key].value == pytest.approx(spot.value, rel=1e-6)
        assert abs(mirrored[key].x) == pytest.approx(abs(spot.x), rel=1e-6)
        assert scaled[key].value == pytest.approx(3 * spot.value, rel=1e-6)  # swt is a stress times a strain
        assert scaled[key].x == pytest.approx(spot.x, rel=1e-6)


@pytest.mark.parametrize("method", ["fem", "march"])
def test_estimates_hold(exact, method):
    true = hot_spots(SCENE, exact)
    found = hot_spots(SCENE, partialslip.run(SCENE, method, subsurface=True)[method])
    assert set(found) == set(true)
    for key, spot in found.items():
        assert off_by(spot, true[key]) <= spot.error < 0.1


@pytest.mark.fault
def test_the_estimate_needs_the_error_at_the_ends_of_the_contact(exact, monkeypatch):
    """Deliberate fault: without the error of the Cauchy integrals at the ends, the estimate of swt is too small (but on
    the mesh for 1e-4, which happens to leave a tenth of the error of finer and coarser ones)."""
    monkeypatch.setattr(assessment, "_edge_error", lambda *_: 0.0)
    fem = partialslip.run(SCENE.replace({"fem.accuracy": 5e-5}), "fem", subsurface=True)["fem"]
    found = hot_spots(SCENE, fem)
    assert off_by(found["swt"], hot_spots(SCENE, exact)["swt"]) > found["swt"].error


@pytest.mark.slow
def test_a_distance_that_leaves_the_body_leaves_the_averages_out():
    block = {"width": 4e-3, "height": 4e-3}
    scene = SCENE.replace(bodies={"upper": block, "lower": block}, fatigue={"distance": 5e-3}, fem={"accuracy": 1e-2})
    found = hot_spots(scene, partialslip.run(scene, "fem", subsurface=True)["fem"])
    assert set(found) == {"sigma_xx", "principal", "swt"}
    assert np.isfinite([spot.value for spot in found.values()]).all()
