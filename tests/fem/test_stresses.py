"""Stresses of the finite elements against those of the half-planes, and against what must hold in any body."""

import numpy as np
import pytest

import partialslip
from partialslip import load_scene
from partialslip_fem import fields


def compared(name, *overrides):
    return partialslip.run(load_scene(name, overrides), subsurface=True)


@pytest.fixture(scope="module")
def run():
    return compared("hertz-large-tension", "fem.accuracy=1e-4")


def test_surface_inside_and_trailing_edge(run):
    """Cell averages of sigma_xx converge like those of q; the largest value, at the end of the contact where its slope
    is infinite, through the fit beyond it; the middle of triangles like h^4 where they are small. So they are bound to
    the accuracy asked as p and q are, ten and fifteen times as far off."""
    errors, accuracy = run.comparisons["fem"], run.scene.fem.accuracy
    assert errors.errors["surface"] < 10 * accuracy
    assert errors.errors["largest"] < 10 * accuracy
    assert errors.errors["inside"] < 10 * accuracy
    x, _ = run.results["fem"].surface.largest
    assert x == pytest.approx(run.results["exact"].a, rel=1e-4)


@pytest.fixture(scope="module")
def fine():
    return compared("hertz-large-tension", "fem.accuracy=1e-6").comparisons["fem"]


def test_errors_fall_with_the_accuracy_asked(fine):
    """The largest value falls like the root of the element size at the end of the contact, as its slope is infinite:
    from one mesh to the next it varies by several times, so that the meshes compared are far apart."""
    coarse = compared("hertz-large-tension", "fem.accuracy=1e-3").comparisons["fem"]
    assert fine.errors["surface"] < coarse.errors["surface"] / 5
    assert fine.errors["largest"] < coarse.errors["largest"] / 5


@pytest.mark.fault
def test_trailing_edge_without_the_fit_is_far_off(fine, monkeypatch):
    """Deliberate fault: the largest value taken from the elements' own polynomials."""
    monkeypatch.setattr(fields, "_strain_beyond", lambda u, end, side: float(u(end + side * 1e-12, 1)))
    raw = compared("hertz-large-tension", "fem.accuracy=1e-6").comparisons["fem"]
    assert raw.errors["largest"] > 20 * fine.errors["largest"]


@pytest.fixture(scope="module")
def free():
    """Without friction, under bulk tension that varies along x at load point 2."""
    loads = "friction.f=0", "load.Q=[0, 0]", "load.sigma=[-2e7, 8e7]", "load.sigma_slope=[0, 1e10]"
    return compared("hertz-large-tension", *loads, "fem.accuracy=1e-3")


def test_without_friction_the_surface_carries_tension_and_pressure(free):
    """sigma_xx = sigma + slope x - p on the lower surface, -p on the upper one; Hertz: p = p0 sqrt(1 - (x/a)^2)."""
    fem, exact, bar = free["fem"], free["exact"], free.scene.fem.accuracy * free["exact"].p0
    x = np.array([-3, -1.2, -0.6, 0, 0.3, 2.5]) * exact.a
    p = exact.p0 * np.sqrt(np.clip(1 - (x / exact.a) ** 2, 0, None))
    found, inside = fem.surface.at(x), fem.stress_at(x, 0 * x)
    for point, (_, sigma, slope) in enumerate(free.scene.load.along):
        assert found[0, point] == pytest.approx(sigma + slope * x - p, abs=bar)
        assert found[1, point] == pytest.approx(-p, abs=bar)
        assert inside[point, 0] == pytest.approx(found[0, point], abs=bar)
    assert free.comparisons["fem"].errors["surface"] < 10 * free.scene.fem.accuracy


def test_without_friction_the_lower_body_is_stretched_and_bent(free):
    """The pressure is constant: from load point 1 to 2 sigma_xx of the lower body changes by sigma + slope x, and
    sigma_xy by -slope y, which elements of order 2 represent."""
    lower, upper = free["fem"].bodies
    first, second = lower.stresses.values()
    x, y = lower.points[lower.triangles].mean(axis=1).T
    slope = free.scene.load.dslope
    tension = np.stack([free.scene.load.dsigma + slope * x, 0 * x, -slope * y])
    assert np.abs((second - first).T - tension).max() < 1e-6 * np.abs(tension).max()
    assert np.ptp(list(upper.stresses.values()), axis=0).max() == 0


@pytest.mark.slow
def test_different_materials_carry_different_stresses():
    """Along the surface both bodies strain alike where they stick; the stiffer one carries more stress for it."""
    scene = load_scene(
        "hertz-small-tension",
        ["fem.accuracy=1e-3", "material.upper.E=200e9", "material.upper.nu=0.3", "load.cycles=4", "friction.f=1.5"],
    )
    result = partialslip.run(scene, subsurface=True).results["fem"]
    x = np.linspace(-0.3, 0.3, 7) * result.a
    change = np.diff(result.surface.at(x), axis=1)[:, 0]
    strains = []
    for sigma, (mu, kappa) in zip(change, scene.material.bodies, strict=True):
        strains.append(sigma * (kappa + 1) / (8 * mu))  # p changes little in the middle
    assert strains[0] == pytest.approx(strains[1], rel=0.05, abs=0.02 * np.abs(strains).max())
