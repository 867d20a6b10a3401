"""Load steps of coupled bodies that do not converge at once: high pins, and friction so large that none converges."""

import time

import numpy as np
import pytest
from plain import plain

from partialslip import load_scene, run
from partialslip.friction.coupled_step import LoadStep, Pivot, solve
from partialslip.friction.history import resting
from partialslip.march.unlike import relative
from partialslip.tools.errors import PartialslipError

STEEL_ON_ALUMINIUM = ["material={upper={E=200e9, nu=0.3}, lower={E=70e9, nu=0.3}}", "fem.accuracy=1e-2"]
HIGH, F = 19.3, 0.3  # height of the pin, in the scale of the contact, whose half-width is 1.1


def driven(kept, begun):
    """Step of a body on a high pin that an actuator drives, and the pair that it begins from, which slides by ``begun``
    of what friction bears."""
    vertices = np.linspace(-1.1, 1.1, 61)
    x, zero = (vertices[1:] + vertices[:-1]) / 2, np.zeros(60)
    C = relative(vertices, 0.0)
    pivot = Pivot(x, HIGH, 0.0)
    step = LoadStep(C.xx, C.yy, 0 * C.xx, 0 * C.xx, zero + F, 1.0, x**2 / 2, kept, zero, None, 0.5, pivot)
    p = np.sqrt(np.maximum(1 - x**2, 0.0))
    p /= p.sum()
    return step, (resting(p), resting(begun * F * p))


@pytest.mark.parametrize("begun", [0.0, 1.0, -1.0])
@pytest.mark.parametrize("driven_by", [0.0, 0.05, -0.2])
def test_a_sweep_of_a_body_on_a_high_pin_keeps_it_in_contact(begun, driven_by):
    """The shear force that friction bears at most has a moment about the pin that no pressure has: 5.8 half-widths."""
    step, start = driven(driven_by, begun)
    p, q = step.sweep(*start)
    assert (p.x > 0).sum() > 1
    assert p.x.sum() == pytest.approx(1.0)
    assert abs(step.pivot.of(p.x, q.x)) < 1e-2
    p, q = solve(step, [start])
    assert p.residual.max() < 1e-12
    assert step.pivot.of(p.x, q.x) == pytest.approx(0.0, abs=1e-10)


@pytest.mark.slow
def test_a_pad_on_a_high_pin_under_displacement():
    load = {"P": 135750.0, "displacement": [-1.9e-6, 2e-6], "sigma": [-100e6, 100e6], "cycles": 1}
    bodies = {
        "upper": {"kind": "pad", "width": 10e-3, "height": 5e-3, "support": "pivot", "pivot_height": 5e-3},
        "lower": {"width": 40e-3, "height": 4e-3, "support": "roller", "pulled": True},
    }
    found = run(plain(load, bodies=bodies, fem={"accuracy": 1e-2}), "fem")["fem"]
    assert max(found.certificate.values()) < 1e-7
    assert np.abs(found.plates.at_points).max() < 0.3 * 135750.0


@pytest.mark.parametrize("f", [57, 300])
@pytest.mark.parametrize("method", ["march", "fem"])
def test_friction_too_large_to_converge_ends_soon(method, f):
    """Without a bound the load steps were halved again and again, on ever finer meshes, for minutes."""
    scene, began = load_scene("hertz-shear", [f"friction.f={f}", *STEEL_ON_ALUMINIUM]), time.process_time()
    with pytest.raises(PartialslipError, match=rf"^friction.f = {f}: load steps do not converge .*take a smaller f"):
        run(scene, method)
    assert time.process_time() - began < 30


@pytest.mark.slow
def test_large_friction_that_converges_is_solved():
    scene = load_scene("hertz-shear", ["friction.f=5", "fem.accuracy=1e-3", *STEEL_ON_ALUMINIUM])
    found = run(scene, "march")["march"]
    assert max(found.certificate.values()) < 1e-7
    assert 0.9 < found.m / found.a < 1
