"""Slip that is locked in where nodes stuck again on the way: what the ends of the stick zone are off by."""

import numpy as np
import pytest

import partialslip
from partialslip_fem import estimate, locked
from partialslip_fem.locked import locked_in


def drifting():
    """Hertz contact under Q_f = 0.75 and s_f = 13.8: the zone drifts by more than its width. It takes back the fine
    elements at its right end in one jump."""
    scene = partialslip.load_scene("hertz-large-tension", ["fem.accuracy=1e-3"])
    Q, sigma = 0.75 * scene.friction.f * scene.P, 13.8 / 2 * scene.friction.f * scene.load.p0
    return scene.replace(load={"Q": [-Q, Q], "sigma": [-sigma, sigma]})


def ratios(scene, exact):
    """Estimates of m and n by fem over their true errors, and the estimates; (2,) each."""
    fem = partialslip.run(scene, ["fem"]).results["fem"]
    true = partialslip.compare(fem, exact, scene, None)
    known = np.array([fem.estimate[key] for key in "mn"])
    return known / [true.m, true.n], known


@pytest.mark.slow
@pytest.mark.fault
def test_jumps_of_an_end_that_are_left_out_are_seen(monkeypatch):
    """Deliberate fault: both orders agree at the ends, as the end that takes points back jumps in both."""
    scene = drifting()
    exact = partialslip.run(scene, ["exact"]).results["exact"]
    found, known = ratios(scene, exact)
    assert found.min() > 1
    assert known.max() <= scene.fem.accuracy
    monkeypatch.setattr(locked, "_DIFFERENT", 0.0)
    monkeypatch.setattr(locked, "_JUMPED", 0.0)
    found, _ = ratios(scene, exact)
    assert found.min() < 0.6


def test_where_no_node_of_the_stick_zone_slipped_nothing_is_locked_in(monkeypatch):
    pairs, true = [], estimate.smooth_errors
    monkeypatch.setattr(estimate, "smooth_errors", lambda *given: pairs.append(given[:2]) or true(*given))
    partialslip.run(partialslip.load_scene("hertz-large-tension", ["fem.accuracy=1e-3"]), ["fem"])
    assert (locked_in(*pairs[-1], np.ones(2)) == 0).all()
