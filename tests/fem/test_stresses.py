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


def test_errors_fall_with_the_accuracy_asked(run, fine):
    coarse = run.comparisons["fem"]
    assert fine.errors["surface"] < coarse.errors["surface"] / 5
    assert fine.errors["largest"] < coarse.errors["largest"] / 5


@pytest.mark.fault
def test_trailing_edge_without_the_fit_is_far_off(fine, monkeypatch):
    """Deliberate fault: the largest value taken from the elements' own polynomials."""
    monkeypatch.setattr(fields, "_strain_beyond", lambda u, end, side: float(u(end + side * 1e-12, 1)))
    raw = compared("hertz-large-tension", "fem.accuracy=1e-6").comparisons["fem"]
    assert raw.errors["largest"] > 20 * fine.errors["largest"]


def test_stresses_of_the_upper_body_pull_the_other_way(run):
    """Mirror images under q of opposite signs: sigma_xx differs by the bulk tension and the sign of what q does."""
    for result in run.results.values():
        x = np.array([-1.5, -0.9, 0.2, 0.9, 2.0]) * result.a
        lower, upper = result.surface.at(x)[:, 1]
        p, _ = result.traction.at(x)
        sigma = run.scene.load.sigma[1]
        assert lower + upper == pytest.approx(sigma - 2 * p, abs=2e-3 * result.p0)


def test_only_where_they_were_asked_for():
    result = partialslip.run(load_scene("hertz-shear", ["fem.accuracy=1e-2"])).results["fem"]
    assert result.surface is None
    assert result.bodies == ()


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
