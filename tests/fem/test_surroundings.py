"""What a body's size adds to the displacements of its surface: reciprocity, beams in closed form, and the difference of
fem's own compliances with and without the half-plane around."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from partialslip import load_scene
from partialslip_fem import characterise as characterising
from partialslip_fem.bodies import Grading, block_of
from partialslip_fem.characterise import characterise_bodies
from partialslip_fem.condensation import Condensation
from partialslip_fem.elasticity import ALL_AROUND, body
from partialslip_fem.factor import default_backend
from partialslip_fem.farfield import half_plane
from partialslip_fem.problem import Part, parts_of
from partialslip_fem.surroundings import surroundings

SCENE = "hertz-small-tension"
FINE = (0.05, 1e-7, 1e-6)
POINTS, PLACES = np.array([-0.41, -0.2, 0.0, 0.13, 0.37]), np.array([-0.5, -0.31, -0.1, 0.05, 0.22, 0.5])
PLAIN = Part("lower", kappa=1.8, compliance=1.3)
PAD = "bodies.upper={kind='pad', width=30e-3, height=8e-3, holder={width=40e-3, height=10e-3}, support='sides'}"
BODIES = {
    "clamped": replace(PLAIN, extent=(1.0, 1.0)),
    "wide, on a roller": replace(PLAIN, extent=(3.0, 1.0), support="roller"),
    "narrow, held at its sides": replace(PLAIN, extent=(1.0, 2.0), support="sides"),
    "pulled": replace(PLAIN, extent=(4.0, 1.0), support="roller", pulled=True),
    "cantilever": replace(PLAIN, extent=(2.0, 1.0), support="sides", pulled=True),
    "with a holder": replace(PLAIN, extent=(1.0, 1.0), holder=(1.7, 0.6)),
    "pad": replace(parts_of(load_scene(SCENE, [PAD]), 8e-3)[1], compliance=1.3),
}


def around(part, points=POINTS, places=PLACES):
    return surroundings(part, points, places, 4, FINE, default_backend())


# reciprocity


@pytest.mark.parametrize("name", [pytest.param(each, marks=[pytest.mark.slow] * (each == "pad")) for each in BODIES])
def test_what_one_force_does_to_another_it_does_back(name):
    """Betti: the displacement at x along i of a force at t along j is that at t along j of a force at x along i."""
    part = BODIES[name]
    there, back = around(part).forced, around(part, PLACES, POINTS).forced
    assert there == pytest.approx(back.transpose(1, 0, 3, 2), abs=4e-6 * np.abs(there).max())


# closed forms


def polynomials(part):
    """Coefficients of x^i t^j in the four displacements, (2, 2, k, k)."""
    points, places = (np.cos(np.pi * (np.arange(n) + 0.5) / n) / 2 for n in (11, 12))
    forced = around(part, points, places).forced
    along, across = (np.linalg.inv(np.vander(each, increasing=True)) for each in (points, places))
    return along @ forced @ across.T


@pytest.mark.parametrize("height", [1.0, 0.6])
def test_a_shear_force_pulls_a_held_specimen(height):
    """A long specimen on a roller, held at its left end: behind a force Q along x the section bears Q/height, before it
    nothing. Where the force acts it is the mean of both, Q/(2 height), and no more by symmetry."""
    part = replace(PLAIN, extent=(12.0, height), support="roller", pulled=True)
    strain = polynomials(part)[0, 0, 1, 0]
    assert strain == pytest.approx(part.compliance / 4 / (2 * height), rel=3e-6)


def test_specimens_held_at_both_ends_are_not_pulled():
    part = replace(PLAIN, extent=(12.0, 1.0), support="roller")
    assert polynomials(part)[0, 0, 1, 0] == pytest.approx(0, abs=1e-7)


def test_a_force_bends_a_cantilever():
    """A force F along y at x = 0 on a cantilever of height h that is held at its left: the section left of it bears
    the moment F x, and its face is strained by 6 F x/(E' h^2); beam theory is exact here. To the right
    there is none: the odd part is half of it."""
    part = replace(PLAIN, extent=(12.0, 1.0), support="sides", pulled=True)
    half = polynomials(part)[0, 1, :, 0] @ np.array([0, 0, 2, *[0] * 8])  # of the slope of the strain
    assert half == pytest.approx(3 * part.compliance / 4, rel=1e-5)


def test_pulling_a_long_specimen_on_a_roller_strains_it_uniformly():
    found = around(replace(PLAIN, extent=(6.0, 1.0), support="roller", pulled=True)).stretched
    assert found - found.mean(axis=1, keepdims=True) == pytest.approx(0, abs=1e-9)


def test_bodies_that_are_not_pulled_are_not_stretched():
    assert not around(BODIES["clamped"]).stretched.any()


def test_a_body_in_its_mirror_is_the_mirror_image():
    """Supports to both sides: what is odd in x and t together belongs to the coupling alone."""
    forced = around(BODIES["clamped"], PLACES[::-1] * 0.9, PLACES).forced
    back = around(BODIES["clamped"], -PLACES[::-1] * 0.9, -PLACES).forced
    signs = np.array([[1, -1], [-1, 1]])[..., None, None]
    assert forced == pytest.approx(signs * back, abs=3e-6 * np.abs(forced).max())


# finite elements


@pytest.mark.parametrize("held", [ALL_AROUND, ("back",)])
def test_surroundings_are_what_the_far_field_changes(held, monkeypatch):
    """On one mesh: fem's own compliance with these supports, less that with the half-plane around it. The difference is
    smooth, so that the mesh hardly matters."""
    monkeypatch.setattr(Part, "held", (held, held))
    at = np.linspace(-0.6, 0.6, 13)
    part = replace(PLAIN, extent=(2.0, 2.0))
    mesh = block_of(part, 0.0, Grading((-0.7, 0.7), dict.fromkeys(at.tolist(), 0.1), 0.25, None, None, 1e-6))
    halves = [body(mesh, part.kappa, 4, part.compliance, (lines, lines)) for lines in (held, ALL_AROUND)]
    far = half_plane(halves[1].held_points, halves[1].x, 2.0, part.kappa, part.compliance)
    finite, infinite = Condensation(halves[0]).compliance, Condensation(halves[1], far).compliance
    n = len(halves[0].x)
    nodes = np.searchsorted(halves[0].x, at - 1e-9)
    points, places = nodes[::2], nodes[1::2]
    difference = (finite - infinite).reshape(2, n, 2, n)[:, points][:, :, :, places].transpose(0, 2, 1, 3)
    found = around(part, at[::2], at[1::2]).forced
    apart = np.ptp(difference - found, axis=(2, 3))  # the logarithms of both have other zeros
    assert apart == pytest.approx(0, abs=3e-6 * np.ptp(found, axis=(2, 3)).max())


# the terms of both bodies


def rig_of(*overrides):
    return characterise_bodies(load_scene(SCENE, list(overrides)))


def test_rigs_of_larger_bodies_are_larger():
    """Two blocks 100 times as large reach 100 times as far; their terms have no dimension."""
    bodies = "bodies.upper={{width={}e-3, height={}e-3}}", "bodies.lower={{width={2}, height={2}}}"
    small, large = (rig_of(*(body.format(8 * times, 5 * times, times) for body in bodies)) for times in (1, 100))
    assert large.reach == pytest.approx(100 * small.reach)
    for one, other in zip(small.terms, large.terms, strict=True):
        assert one == pytest.approx(other, abs=1e-9)


@pytest.mark.fault
def test_coupling_of_the_upper_body_without_its_sign_is_seen(monkeypatch):
    """Deliberate fault: the upper body taken for a lower one. Mirror images couple then."""
    both = [f"bodies.{name}={{width=8e-3, height=4e-3}}" for name in ("upper", "lower")]
    assert not rig_of(*both).terms.xy.any()
    monkeypatch.setattr(characterising, "parts_of", lambda *of: [replace(part, name="lower") for part in parts_of(*of)])
    assert np.abs(rig_of(*both).terms.xy).max() > 1e-2


@pytest.mark.slow
def test_bodies_that_are_their_own_mirror_images_turn_nothing():
    """Nothing tells left from right, though the elements do; a specimen that is held at its left end does."""
    terms = rig_of("bodies.lower={width=16e-3, height=9e-3}", PAD).terms
    even = np.add.outer(range(11), range(11)) % 2 == 0
    assert not terms.xy[even].any()
    assert not terms.xx[~even].any()
    assert not terms.yy[~even].any()
    pulled = rig_of("bodies.lower={width=16e-3, height=9e-3, support='roller', pulled=true}")
    assert np.abs(pulled.terms.xx[1, 0]) > 0.01


def test_the_lower_and_the_upper_body_couple_the_other_way():
    block = "{width=8e-3, height=4e-3}"
    lower, upper = (rig_of(f"bodies.{name}={block}").terms for name in ("lower", "upper"))
    assert np.abs(lower.xy).max() > 1e-2
    assert lower.xy == pytest.approx(-upper.xy)
    assert lower.xx == pytest.approx(upper.xx)
    assert lower.yy == pytest.approx(upper.yy)


@pytest.mark.parametrize("E", [70e9, 7e3])
def test_terms_depend_on_poissons_ratio_alone(E):
    """Not on E: displacements are relative to those of half-planes of the same material."""
    bodies = "bodies.lower={width=8e-3, height=4e-3}"
    assert np.allclose(
        rig_of(bodies, f"material.E={E}", f"load.p0={E / 200}").terms.yy, rig_of(bodies).terms.yy, 1e-9, 1e-12
    )


def test_the_difference_of_the_meshes_is_the_error():
    """What the coarser mesh differs by is more than the error of the finer one, seen on a mesh that is finer still."""
    scene = load_scene(SCENE, ["bodies.lower={width=40e-3, height=5e-3, support='roller', pulled=true}"])
    found = characterise_bodies(scene)
    length = characterising._smallest(parts_of(scene, 1.0))
    parts = [part for part in parts_of(scene, length) if part.finite]
    finest = characterising._terms(parts, (0.05, 1e-8, 1e-6), 4, default_backend())
    for key in ("xx", "yy", "xy"):
        own, rough, true = (getattr(terms, key)[:3, :3] for terms in (found.terms, found.rough, finest))
        assert np.abs(own - true).max() < np.abs(own - rough).max()


SPECIMEN = Path(__file__).parents[1] / "meshes" / "specimen.inp"  # 40 mm x 5 mm, with a contact line of 0.8 mm


def test_given_meshes_reach_as_far_as_their_contact_line():
    """Which is a part of the flat face, not the size of the body; and they are the specimen that they are."""
    settings = "support='roller', pulled=true"
    of_mesh, of_sizes = (
        characterise_bodies(load_scene("fretting-aluminium", [f"bodies.lower={{{body}, {settings}}}"]))
        for body in (f"mesh='{SPECIMEN}', unit=1e-3", "width=40e-3, height=5e-3")
    )
    assert of_mesh.reach == pytest.approx(4e-4, rel=1e-6)
    shared = np.arange(3)
    way = (of_mesh.reach / of_sizes.reach) ** np.add.outer(shared, shared)  # the terms are in units of reach
    for key in ("xx", "yy"):
        found, expected = (getattr(terms, key)[:3, :3] for terms in (of_mesh.terms, of_sizes.terms))
        odd = np.add.outer(shared, shared) > 0  # but for displacements as a whole
        assert found[odd] == pytest.approx((expected * way)[odd], abs=1e-4 * np.abs(expected * way)[odd].max())


def test_given_meshes_know_their_error():
    """There is no coarser mesh, but elements of lower order."""
    scene = load_scene("fretting-aluminium", [f"bodies.lower={{mesh='{SPECIMEN}', unit=1e-3, support='roller'}}"])
    found = characterise_bodies(scene)
    apart = np.abs(found.terms.yy - found.rough.yy)[:3, :3].max()
    assert 1e-9 < apart < 1e-3
