"""Stresses at any points by finite elements: against the exact ones, on finer meshes, and by what must hold."""

import numpy as np
import pytest
from near import places

import partialslip
from partialslip import load_scene
from partialslip_fem import remainder
from partialslip_fem.locate import Locator

WIDE = 0.02  # m; a is 1 mm in the scenes used
BLOCKS = [f"bodies.{name}={{kind='block', width={WIDE}, height=0.01}}" for name in ("lower", "upper")]
UNLIKE = ["material.upper.E=200e9", "material.upper.nu=0.2", "friction.f=0.8", "load.cycles=3", "load.steps=4"]
PAD = "bodies.upper={kind='pad', width=10e-3, height=8e-3}"
BAR = "bodies.lower={width=60e-3, height=5e-3, support='roller', pulled=true}"


def solved(name, *overrides, methods="fem"):
    run = partialslip.run(load_scene(name, list(overrides)), methods, subsurface=True)
    return run.scene, run.results


def apart(found, true, result):
    """Relative L2 error, and largest error in p0."""
    return np.linalg.norm(found - true) / np.linalg.norm(true), np.abs(found - true).max() / result.p0


def across(stress_at, depth, low, high, count=60):
    """Integrals of sigma_yy and sigma_xy at load point 2 along a cut at y = ``depth``."""
    nodes, weights = np.polynomial.legendre.leggauss(8)
    ends = np.linspace(low, high, count + 1)
    half = np.diff(ends)[:, None] / 2
    x, weights = (ends[:-1, None] + half * (1 + nodes)).ravel(), (half * weights).ravel()
    return stress_at(x, 0 * x + depth)[1, 1:] @ weights


# half-planes


@pytest.mark.parametrize("name", ["hertz-shear", "hertz-large-tension"])
def test_as_exact_as_asked_for(name):
    """The accuracy by default, 2e-5 of a, holds stresses to 1e-4 of p0 everywhere, and far better on the whole."""
    _, results = solved(name, methods=["exact", "fem"])
    exact, fem = results["exact"], results["fem"]
    x, y = places(exact)
    whole, largest = apart(fem.stress_at(x, y), exact.stress_at(x, y), exact)
    assert whole < 5e-6
    assert largest < 1e-4


@pytest.mark.slow
def test_load_steps_are_phases():
    overrides = "load.Q=[-1e4, 3e4]", "load.sigma=[0, 2e7]", "load.steps=4", "load.cycles=3", "fem.accuracy=1e-3"
    _, results = solved("fretting-aluminium", *overrides, methods=["exact", "fem"])
    exact, fem = results["exact"], results["fem"]
    x, y = places(exact, 300)
    for phase in ([0.125], [0.25], [0.5], [0.875]):
        whole, largest = apart(fem.stress_at(x, y, phase), exact.stress_at(x, y, phase), exact)
        assert whole < 5e-4
        assert largest < 5e-3


def off_the_elements(fem):
    """Relative L2 difference, by area within 3 a, from the elements' own stresses in the middle of triangles."""
    off, whole = 0.0, 0.0
    for body in fem.bodies:
        corners = body.points[body.triangles]
        x, y = corners.mean(axis=1).T
        near = (np.abs(x) < 3 * fem.a) & (np.abs(y) < 3 * fem.a)
        along, across = np.moveaxis(corners[near, 1:] - corners[near, :1], 0, -1)
        areas = np.abs(along[0] * across[1] - along[1] * across[0])
        found = fem.stress_at(x[near], y[near])
        own = np.stack([each[near].T for each in body.stresses.values()])
        off, whole = off + ((found - own) ** 2 @ areas).sum(), whole + (own**2 @ areas).sum()
    return np.sqrt(off / whole)


def test_a_clamped_block_that_stands_for_a_half_plane():
    """Clamping changes stresses near the contact by P over its width: the remainder follows it."""
    _, results = solved(
        "hertz-shear", "fem.far_field='box'", "fem.width=100", "fem.accuracy=1e-5", methods=["exact", "fem"]
    )
    exact, fem = results["exact"], results["fem"]
    x, y = places(exact, 300)
    assert apart(fem.stress_at(x, y), exact.stress_at(x, y), exact)[0] > 1e-3
    assert off_the_elements(fem) < 1e-3
    width = fem.settings["block_half_width_over_a"] * fem.a
    assert np.isnan(fem.stress_at([0.0, 1.01 * width], [-1.01 * width, -0.1 * width])).all()


@pytest.fixture(scope="module")
def unlike():
    return solved("hertz-small-tension", *UNLIKE, "fem.accuracy=1e-3")


def test_unlike_bodies_carry_the_loads(unlike):
    scene, results = unlike
    fem = results["fem"]
    angle = (np.arange(400) + 0.5) / 400 * np.pi - np.pi / 2
    for y in (-3 * fem.a, 3 * fem.a):
        x, weights = abs(y) * np.tan(angle), abs(y) / np.cos(angle) ** 2 * np.pi / 400
        for found, (Q, _) in zip(fem.stress_at(x, 0 * x + y), scene.load.points, strict=True):
            assert found[1] @ weights == pytest.approx(-scene.P, rel=1e-8)
            assert found[2] @ weights == pytest.approx(-Q, abs=1e-8 * scene.P)


def test_tractions_of_unlike_bodies_on_their_surfaces(unlike):
    _, results = unlike
    fem = results["fem"]
    x = np.linspace(-1.3, 1.3, 101) * fem.a
    at = fem.traction.at(x)
    for y in (0.0, 1e-15 * fem.a):
        for found, p, q in zip(fem.stress_at(x, y), at.pressures, at.levels, strict=True):
            assert found[1] == pytest.approx(-p, abs=1e-9 * fem.p0)
            assert found[2] == pytest.approx(-q, abs=1e-9 * fem.p0)


@pytest.mark.slow
def test_half_a_turn_swaps_the_bodies():
    """Without bulk tension, which acts in the lower body alone."""
    _, one = solved("hertz-shear", *UNLIKE, "fem.accuracy=1e-3")
    swapped = ["material.lower.E=200e9", "material.lower.nu=0.2", *UNLIKE[2:]]
    _, other = solved("hertz-shear", *swapped, "fem.accuracy=1e-3")
    one, other = one["fem"], other["fem"]
    x, y = places(one, 200)
    whole, _ = apart(other.stress_at(-x, -y), one.stress_at(x, y), one)
    assert whole < 2e-3


@pytest.mark.slow
def test_units():
    """Lengths and loads per length times 3: the same stresses."""
    scene = load_scene("hertz-small-tension", ["fem.accuracy=1e-2", *BLOCKS])
    size = {name: {"kind": "block", "width": 3 * WIDE, "height": 0.03} for name in ("lower", "upper")}
    load = {"P": 3 * scene.P, "p0": None, "Q": [3 * Q for Q in scene.load.Q]}
    other = scene.replace(profile={"R": 3 * scene.profile.R}, load=load, bodies=size)
    one, other = (partialslip.run(each, "fem", subsurface=True)["fem"] for each in (scene, other))
    x, y = places(one, 200)
    assert other.stress_at(3 * x, 3 * y) == pytest.approx(one.stress_at(x, y), rel=0, abs=1e-9 * one.p0)


# bodies of a size


@pytest.fixture(scope="module")
def blocks():
    return [solved("hertz-large-tension", *BLOCKS, f"fem.accuracy={each}")[1]["fem"] for each in (2e-5, 2e-6)]


def test_blocks_against_a_finer_mesh(blocks):
    coarse, fine = blocks
    x, y = places(fine)
    whole, largest = apart(coarse.stress_at(x, y), fine.stress_at(x, y), fine)
    assert whole < 1e-5
    assert largest < 1e-4


def test_free_sides_bear_no_tractions_and_cuts_bear_the_loads(blocks):
    scene = load_scene("hertz-large-tension", BLOCKS)
    for way in (-1, 1):
        sigma_yy, sigma_xy = across(blocks[0].stress_at, way * 0.004, -WIDE / 2, WIDE / 2)
        assert sigma_yy == pytest.approx(-scene.P, rel=1e-5)
        assert sigma_xy == pytest.approx(-scene.load.Q[1], abs=1e-5 * scene.P)
    y = np.linspace(2e-3, 8e-3, 20)
    xx, _, xy = blocks[0].stress_at(np.array([[-1], [1]]) * WIDE / 2 * (1 - 1e-9), y)[1]  # the upper body's sides
    assert np.abs([xx, xy]).max() < 3e-4 * blocks[0].p0


def test_bodies_of_a_size_follow_their_elements(blocks, rig):
    """The stresses of large elements far from the contact are worth a few parts in a thousand."""
    assert off_the_elements(blocks[0]) < 2e-3
    assert off_the_elements(rig[1]["fem"]) < 1e-2


def test_points_outside_are_nan(blocks):
    fem = blocks[0]
    x = np.array([0, 0, 0, 0.5, -0.5, 0.4999, 0.5001]) * WIDE
    y = np.array([-0.5, 0.501, -0.499, -0.1, 0.2, 0, 0]) * WIDE
    found = np.isfinite(fem.stress_at(x, y)).all(axis=(0, 1))
    assert found.tolist() == [True, False, True, True, True, True, False]
    assert fem.stress_at([], [], [0.3]).shape == (1, 3, 0)


@pytest.fixture(scope="module")
def rig():
    return solved("hertz-small-tension", PAD, BAR, "load.cycles=3", "load.steps=2", "fem.accuracy=1e-3")


def test_a_pulled_bar_bears_the_tension_far_away(rig):
    scene, results = rig
    y = -np.linspace(0.5e-3, 4.5e-3, 9)
    right = results["fem"].stress_at(25e-3, y)
    Q = np.array(scene.load.Q) / 5e-3  # what the grip at the left end bears of it does not come here
    assert right[:, 0].mean(axis=1) == pytest.approx(scene.load.sigma, abs=np.abs(Q).max())
    assert np.abs(right[:, 1:]).max() < 2e-2 * results["fem"].p0


def test_a_pad_ends_at_its_face(rig):
    """Between the round face and y = 0 there is nothing, but where bodies touch, the face is drawn flat."""
    scene, results = rig
    fem = results["fem"]
    x = np.array([-4, -2, 2, 4]) * 1e-3
    face = scene.profile.R - np.sqrt(scene.profile.R**2 - x**2)
    assert np.isnan(fem.stress_at(x, 0.99 * face)).all()
    found = fem.stress_at(x, face + 1e-9)
    assert np.isfinite(found).all()
    normal = np.array([x / scene.profile.R, -np.sqrt(1 - (x / scene.profile.R) ** 2)])  # out of the pad
    xx, yy, xy = np.moveaxis(found, 1, 0)
    pulls = np.stack([xx * normal[0] + xy * normal[1], xy * normal[0] + yy * normal[1]])
    assert np.abs(pulls).max() < 1e-3 * fem.p0
    inner = np.linspace(-0.9, 0.9, 7) * fem.a
    p, *_ = fem.traction.at(inner)
    assert fem.stress_at(inner, 1e-12)[1, 1] == pytest.approx(-p, abs=0.02 * fem.p0)  # slopes of the face
    assert fem.stress_at(inner, 1e-12)[1, 1] == pytest.approx(fem.stress_at(inner, 1e-9)[1, 1], abs=1e-3 * fem.p0)


@pytest.mark.fault
def test_a_remainder_left_out_is_seen(monkeypatch, blocks):
    """Deliberate fault: blocks taken for half-planes under their tractions."""
    fem = blocks[0]
    sides = np.array([[-1], [1]]) * WIDE / 2 * (1 - 1e-9), -np.linspace(2e-3, 8e-3, 20)
    back = fem.stress_at(np.linspace(-5e-3, 5e-3, 9), -0.01 + 1e-9)
    monkeypatch.setattr(remainder.Remainder, "stresses", lambda _, x, *more: np.zeros((len(more[1]), 3, len(x))))
    off = np.abs(fem.stress_at(np.linspace(-5e-3, 5e-3, 9), -0.01 + 1e-9) - back).max()
    assert off > 1e-2 * fem.p0
    assert np.abs(fem.stress_at(*sides)[:, 0]).max() > 1e-2 * fem.p0


# places


def test_triangles_are_found_in_a_mesh_with_a_notch():
    """A T of two rectangles: the way from the nearest triangle may leave the mesh."""
    random = np.random.default_rng(0)
    line = np.linspace(0, 1, 9)
    x, y = np.meshgrid(8 * line - 4, 4 * line - 4)
    x, y = x.ravel(), y.ravel()
    k = np.add.outer(9 * np.arange(8), np.arange(8)).ravel()
    triangles = np.concatenate([np.stack([k, k + 1, k + 9], 1), np.stack([k + 1, k + 10, k + 9], 1)])
    middle = np.stack([x, y], 1)[triangles].mean(axis=1)
    triangles = triangles[(np.abs(middle[:, 0]) < 1) | (middle[:, 1] < -2)]
    points = np.column_stack([random.uniform(-5, 5, 5000), random.uniform(-5, 1, 5000)])
    cells, local = Locator(np.stack([x, y], 1), triangles)(points)
    inside = (points[:, 1] <= 0) & (points[:, 1] >= -4) & (np.abs(points[:, 0]) <= 4)
    inside &= (np.abs(points[:, 0]) <= 1) | (points[:, 1] <= -2)
    assert ((cells >= 0) == inside).all()
    corners = np.stack([x, y], 1)[triangles[cells[inside]]]
    share = np.stack([1 - local[0] - local[1], *local])[:, inside]
    assert np.einsum("kci,ck->ki", corners, share) == pytest.approx(points[inside], abs=1e-12)
    assert share.min() > -1e-8
