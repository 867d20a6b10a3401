"""Stresses of marching against those of the exact method, and against what must hold for any loads."""

import numpy as np
import pytest
from near import places
from varying_scenes import varying

import partialslip
from partialslip import InputError, load_scene
from partialslip.march import cell_stress
from partialslip.march.cells import graded_cells

OUT_OF_PHASE = {
    "load.Q": "[-1e5, 0, 1e5, 0]",
    "load.sigma": "[0, 1e8, 0, -1e8]",
    "load.cycles": "3",
    "load.steps": "4",
    "fem.accuracy": "1e-3",
}


def solved(scene, *methods):
    results = partialslip.run(scene, methods, subsurface=True).results
    return [results[method] for method in methods]


def apart(found, exact, phases=None):
    """Relative L2 error, and largest error in p0."""
    x, y = places(exact)
    off, true = found.stress_at(x, y, phases), exact.stress_at(x, y, phases)
    off = off - true
    return np.linalg.norm(off) / np.linalg.norm(true), np.abs(off).max() / exact.p0


@pytest.mark.parametrize(
    "name",
    ["hertz-large-tension", *(pytest.param(name, marks=pytest.mark.slow) for name in ("hertz-shear", "flat-rounded"))],
)
def test_as_exact_as_asked_for(name):
    """The accuracy by default, 2e-5 of a, holds stresses to 1e-4 of p0 everywhere, and far better on the whole."""
    exact, march = solved(load_scene(name), "exact", "march")
    whole, largest = apart(march, exact)
    assert whole < 2e-5
    assert largest < 1e-4
    assert march.surface.largest[1] == pytest.approx(exact.surface.largest[1], rel=1e-5)


PHASES = [0.0, 0.125, 0.25, 0.375, 0.5, 0.75, 0.875]
MEANS = {
    "mean loads": load_scene("fretting-aluminium", ["load.Q=[-1e4, 3e4]", "load.sigma=[0, 2e7]"]),
    "a slope": load_scene("hertz-shear", ["load.sigma_slope=[-1e10, 1e10]"]),
    "varying P": varying((0.98, 1.0), 1.08, 0.36, mean=0.85),
    "varying P and M": varying((1.036, 1.0), 0.723, -0.568, e=(0, -0.046), mean=0.1),
}


@pytest.mark.parametrize(
    "scene",
    [pytest.param(scene, id=name, marks=[pytest.mark.slow] * (name != "a slope")) for name, scene in MEANS.items()],
)
def test_load_steps_are_phases(scene):
    """At its load steps march is on the exact way from load point to load point."""
    scene = scene.replace(load={"steps": 4, "cycles": 3}, fem={"accuracy": 1e-3})
    exact, march = solved(scene, "exact", "march")
    for phase in PHASES:
        whole, largest = apart(march, exact, [phase])
        assert whole < 5e-4
        assert largest < 5e-3


def test_between_load_steps_stresses_are_linear():
    (march,) = solved(MEANS["a slope"].replace(load={"steps": 4}, fem={"accuracy": 1e-2}), "march")
    x, y = places(march, 50)
    before, between, after = march.stress_at(x, y, [0.125, 0.125 + 0.03, 0.25])
    assert between == pytest.approx(before + 0.03 / 0.125 * (after - before), rel=0, abs=1e-12 * march.p0)


def test_out_of_phase():
    """Four load points: a cut carries the loads of each phase, and friction holds."""
    scene = load_scene("hertz-large-tension", [f"{key}={value}" for key, value in OUT_OF_PHASE.items()])
    (march,) = solved(scene, "march")
    angle = (np.arange(400) + 0.5) / 400 * np.pi - np.pi / 2
    depth = 4 * march.a
    x, weights = depth * np.tan(angle), depth / np.cos(angle) ** 2 * np.pi / 400
    phases = [0, 0.25, 0.3, 0.5, 0.75, 0.9]
    loads = [(-1e5, 0), (0, 1e8), (0.2e5, 0.8e8), (1e5, 0), (0, -1e8), (-0.6e5, -0.4e8)]
    for found, (Q, _) in zip(march.stress_at(x, 0 * x - depth, phases), loads, strict=True):
        assert found[1] @ weights == pytest.approx(-scene.P, rel=1e-9)
        assert found[2] @ weights == pytest.approx(-Q, abs=1e-8 * scene.P)
    far = march.stress_at(0, -1e4 * march.a, phases)[:, 0]
    assert far == pytest.approx([sigma for _, sigma in loads], abs=1e-3 * march.p0)
    x = np.linspace(-1, 1, 203) * march.a
    for found in march.stress_at(x, 0 * x, phases):
        assert (np.abs(found[2]) <= -scene.friction.f * found[1] + 2e-3 * march.p0).all()


def test_mirrored():
    scene = load_scene("hertz-large-tension", ["load.sigma=[-1e8, 2e8]", "load.cycles=3", "fem.accuracy=1e-2"])
    (one,), (other,) = solved(scene, "march"), solved(scene.replace(load={"Q": [-Q for Q in scene.load.Q]}), "march")
    x, y = places(one, 200)
    mirrored = other.stress_at(-x, y) * np.array([[1], [1], [-1]])
    assert mirrored == pytest.approx(one.stress_at(x, y), rel=0, abs=1e-9 * one.p0)


def test_bad_points_and_none():
    (march,) = solved(load_scene("hertz-shear", ["fem.accuracy=1e-2"]), "march")
    assert march.stress_at([], [], [0.1]).shape == (1, 3, 0)
    with pytest.raises(InputError, match=r"^points: must be numbers"):
        march.stress_at("x", 0)


# --- smoothing


def sample():
    """Cattaneo and Mindlin's shear on cells: q = w(1) - w(0.6) with w(c) = sqrt(c^2 - x^2), f p0 = 1."""
    vertices = graded_cells(np.array([-1.0, -0.6, 0.6, 1.0]), 1e-4, 0.05)

    def on_cells(c):
        x = np.clip(vertices, -c, c)
        return np.diff(x * np.sqrt(c**2 - x**2) + c**2 * np.arcsin(x / c)) / 2

    return vertices, on_cells(1.0) - on_cells(0.6), on_cells(1.0)


def test_smoothed_shear_keeps_the_forces_and_is_continuous():
    vertices, shear, bounds = sample()
    c2, c1, c0 = cell_stress.smoothed(vertices, shear, bounds, np.sqrt(np.maximum(1 - vertices**2, 0)))
    widths = np.diff(vertices)
    sticks = (vertices[1:] > -0.6) & (vertices[:-1] < 0.6)
    assert (c0 * widths + c1 * widths**2 / 2 + c2 * widths**3 / 3)[sticks] == pytest.approx(shear[sticks], abs=1e-15)
    assert not np.any([c2[~sticks], c1[~sticks], c0[~sticks]])
    ends = (c0 + c1 * widths + c2 * widths**2)[sticks]
    assert ends[:-1] == pytest.approx(c0[sticks][1:], abs=1e-12)
    middle = (vertices[1:] + vertices[:-1])[sticks] / 2
    q = np.sqrt(1 - middle**2) - np.sqrt(0.36 - middle**2)
    half = widths[sticks] / 2
    off = (c0[sticks] + c1[sticks] * half + c2[sticks] * half**2) - q
    assert np.abs(off[np.abs(np.abs(middle) - 0.6) > 0.01]).max() < 1e-5


@pytest.mark.slow
@pytest.mark.fault
def test_shear_left_constant_on_cells_is_seen(monkeypatch):
    """Deliberate fault: stresses of the cells as they are, with jumps of q between them."""

    def constant(vertices, shear, *_):
        return np.stack([0 * shear, 0 * shear, shear / np.diff(vertices)])

    exact, march = solved(load_scene("hertz-shear"), "exact", "march")
    x = np.linspace(-0.5, 0.5, 200) * march.a
    near = x, 0 * x - 0.002 * march.a
    sound = np.abs(march.stress_at(*near) - exact.stress_at(*near)).max()
    monkeypatch.setattr(cell_stress, "smoothed", constant)
    monkeypatch.setattr(cell_stress, "_end_runs", lambda forces, _: (0, len(forces)))
    exact, march = solved(load_scene("hertz-shear"), "exact", "march")
    assert np.abs(march.stress_at(*near) - exact.stress_at(*near)).max() > 10 * sound
