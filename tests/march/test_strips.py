"""Marching of two equal strips: against the exact solution, finite elements, and equilibrium."""

import numpy as np
import pytest
from strip_scenes import A, P, strips

from partialslip import run
from partialslip.halfplane.layer import Layer
from partialslip.run.judge import compare
from partialslip.run.judge.reference import error_of, reference

PULLED = {"sigma": (-100e6, 100e6)}


def errors(scene, method, other, keys):
    """Errors of a ``method`` against the ``other``, and what both tell of them."""
    found, true = (run(scene, each)[each] for each in (method, other))
    off = compare(found, true, scene, None).errors
    return [(off[key], error_of(found, key, method) + error_of(true, key, other)) for key in keys]


@pytest.mark.parametrize(("h", "load"), [(2 * A, {}), (5 * A, PULLED)])
def test_steady_states_are_those_of_exact(h, load):
    for off, estimate in errors(strips(h, **load), "march", "exact", ("a", "m", "n", "p", "q")):
        assert off <= estimate + 1e-12


def test_the_kernel_of_pressure_in_place_of_that_of_shear_is_caught(monkeypatch):
    whole = Layer.added
    monkeypatch.setattr(Layer, "added", lambda self, places: whole(self, places, "normal"))
    (off, estimate), *_ = errors(strips(5 * A), "march", "exact", ("m",))
    assert off > 10 * estimate


@pytest.mark.slow
@pytest.mark.parametrize(
    "load",
    [
        {"Q": (4e3, 30e3), "sigma": (-20e6, 70e6)},  # mean loads
        {"Q": (-20e3, 25e3, 5e3), "sigma": (-60e6, 20e6, 80e6)},  # out of phase
        {"Q": (-8e3, 8e3), "sigma": (-250e6, 250e6)},  # slip reverses
        {"Q": (-4e3, 20e3), "P": [0.6 * P, P]},
    ],
)
def test_load_paths_against_finite_elements(load):
    scene = strips(4 * A, width=60 * A, accuracy=2e-4, **load)
    for off, estimate in errors(scene, "fem", "march", ("a", "m", "n", "p", "q", "q1", "q2")):
        assert off <= estimate


def test_stresses_are_those_of_exact_and_leave_the_back_free_of_shear():
    scene = strips(3 * A, **PULLED)
    exact, march = (run(scene, method, subsurface=True)[method] for method in ("exact", "march"))
    x, y = (each.ravel() for each in np.meshgrid(A * np.linspace(-2, 2, 7), A * np.linspace(-2.99, 2.99, 8)))
    true, found = (each.stress_at.function(x, y, np.array([0.0, 0.5])) for each in (exact, march))
    assert np.abs(found - true).max() < 1e-5 * np.abs(true).max()
    back = march.stress_at.function(x, np.full_like(x, -3 * A), np.array([0.0, 0.25, 0.5]))
    assert np.abs(back[:, 2]).max() < 1e-6 * np.abs(true).max()


def test_shear_that_pressing_locks_in_is_not_told():
    uneven = {"right_grip": 0.5}
    found = run(strips(5 * A, width=200 * A, lower=uneven, **PULLED), "march", subsurface=True)["march"]
    assert {"q1", "q2", "stresses"} <= set(found.undetermined)
    assert found.traction.values.levels is None
    # a pressure that varies drags the strips, too: then march solves half-planes
    varying = strips(5 * A, Q=(-9e3, 9e3), width=200 * A, lower={"pulled": True} | uneven, P=[0.5 * P, P])
    assert varying.strips is None
    assert (reference(varying).method, reference(strips(5 * A, P=[0.1 * P, P])).method) == ("fem", "march")
