"""Bodies of a size: their shapes, what holds them, a tension that is a load; what is known of them in closed form."""

from types import SimpleNamespace

import numpy as np
import pytest

import partialslip
from partialslip import load_scene, plan
from partialslip.result import Clock
from partialslip.scene import Scene
from partialslip_fem import goals, solve
from partialslip_fem.adapt import adapt
from partialslip_fem.condensation import Condensation
from partialslip_fem.contact import CondensedBody
from partialslip_fem.displacements import displace_bodies
from partialslip_fem.elasticity import body
from partialslip_fem.problem import scaled
from partialslip_meshes import block

SCENE, COARSE = "hertz-small-tension", "fem.accuracy=1e-3"  # a = 1 mm, R = 50 mm
PAD = "bodies.upper={kind='pad', width=30e-3, height=8e-3, holder={width=40e-3, height=10e-3}, support='sides'}"
PULLED = "bodies.lower={width=60e-3, height=5e-3, support='roller', pulled=true}"
RIG = (PAD, PULLED, "load.cycles=3")


def both(width, height, support="clamped"):
    return [f"bodies.{name}={{width={width}, height={height}, support='{support}'}}" for name in ("upper", "lower")]


def fem(*overrides, name=SCENE, subsurface=False):
    scene = load_scene(name, [COARSE, *overrides])
    return solve(scene, plan(scene, subsurface=subsurface))


def exact(*overrides, name=SCENE):
    return partialslip.run(load_scene(name, list(overrides)), ["exact"]).results["exact"]


def ends(result):
    return np.array([result.a, result.m, result.n])


# what a tension does


@pytest.fixture(scope="module", params=[1, 4])
def bar(request):
    """A long bar, gripped at its left end and pulled at its right one, that slides along its middle plane."""
    mesh = block(8.0, (-1.0, 1.0), {0.0: 0.5}, 0.4, 1.5)
    half = body(mesh, 2.1, request.param, 1.3, (("left",), ("back",)), pulled=True)
    return CondensedBody(mesh, half, Condensation(half))


def test_a_pulled_bar_is_stretched_uniformly(bar):
    """sigma/E' along x, with 4/E' the compliance, and Poisson's contraction towards the middle plane: exactly."""
    x, y = bar.body.points
    expected = np.array([x + 8, -(3 - 2.1) / (1 + 2.1) * (y + 1.5)])
    assert bar.stretched == pytest.approx(expected, abs=1e-9)
    assert bar.stretch == pytest.approx(bar.stretched[:, bar.body.contact[0]], abs=0)


def test_the_grip_holds_what_pulls(bar):
    u = bar.condensation.pulled
    reactions = (bar.body.stiffness @ u)[bar.body.held]
    along_x = bar.body.held < bar.body.points.shape[1]
    assert bar.body.pull.sum() == pytest.approx(1.5)
    assert reactions[along_x].sum() == pytest.approx(-1.5)
    assert np.abs(reactions[~along_x]).max() < 1e-10


def test_far_from_a_clamped_grip_the_bar_is_stretched_uniformly():
    """Saint-Venant: what the grip keeps from contracting dies out within about a height, like exp(-2.1 x/height) and
    faster."""
    mesh = block(8.0, (-1.0, 1.0), {0.0: 0.3}, 0.2, 1.0)
    half = body(mesh, 1.8, 4, 1.0, (("left",), ("left",)), pulled=True)
    bar = CondensedBody(mesh, half, Condensation(half))
    inner = half.x[np.abs(half.x) < 0.9]
    strain = np.diff(bar.stretch[0])[np.abs(half.x[1:]) < 0.9] / np.diff(half.x)[np.abs(half.x[1:]) < 0.9]
    assert len(inner) > 8
    assert strain == pytest.approx(1.0, abs=1e-6)


@pytest.mark.slow
def test_a_long_pulled_specimen_is_strained_as_if_that_were_imposed():
    """Without Q a long sliding specimen that is pulled is one whose surface is given the strain sigma/E'."""
    free = ("load.Q=[0, 0]", "load.sigma=[-100e6, 100e6]", "bodies.upper={width=30e-3, height=10e-3}", "load.cycles=3")
    pulled = fem(*free, "bodies.lower={width=160e-3, height=10e-3, support='roller', pulled=true}")
    imposed = fem(*free, "bodies.lower={width=160e-3, height=10e-3, support='roller'}")
    assert ends(pulled) == pytest.approx(ends(imposed), abs=1e-4 * pulled.a)


# half-planes


@pytest.mark.parametrize(
    "support", [*(pytest.param(each, marks=pytest.mark.slow) for each in ("clamped", "roller")), "sides"]
)
def test_boxes_are_off_by_the_square_of_a_over_their_size(support):
    true = ends(exact())
    off = [ends(fem(*both(width, width / 2, support))) - true for width in (20e-3, 40e-3, 80e-3)]
    errors = np.abs(off).max(axis=1)
    assert errors[0] > 1e-3 * true[0]
    assert np.log2(errors[:-1] / errors[1:]) == pytest.approx(2, abs=0.2)


@pytest.mark.slow
def test_large_pads_are_half_planes():
    """A pad of R = 50 a, three quarters of R to each side: the arc and the size are felt as (a/R)^2."""
    overrides = ["profile.R=0.4", "bodies.upper={kind='pad', width=0.6, height=0.3}"]
    result, true = fem(*overrides, "load.cycles=3"), exact("profile.R=0.4")
    assert np.abs(ends(result) - ends(true)).max() < 1e-3 * true.a


def test_a_thin_layer_on_a_roller_is_a_bed_of_springs():
    """Johnson, Contact Mechanics, section 5.8: pressed by a rigid cylinder, and free to slide, a layer of thickness t
    much less than a has p = E'/t times its compression, so that a^3 = 3 P R t/(2 E') and p is a parabola of height
    3 P/(4 a). The ends are of the size of t: a is off by a fixed fraction of t, and that is all."""
    a, scene = 2e-4, load_scene("fretting-aluminium")
    modulus = scene.material.E / (1 - scene.material.nu**2)
    off = []
    for t in (0.1 * a, 0.05 * a):
        P = 2 * modulus * a**3 / (3 * scene.profile.R * t)
        layer = f"bodies.lower={{width={12 * a}, height={t}, support='roller', pulled=true}}"
        rigid = "material.upper={E=1e17, nu=0.3}"
        result = fem(layer, rigid, f"load.P={P}", "friction.f=0", name="fretting-aluminium")
        assert result.traction.p.max() == pytest.approx(3 * P / (4 * a), rel=1e-4)
        off.append(result.a / a - 1)
    assert off[0] == pytest.approx(2 * off[1], rel=1e-2)
    assert abs(off[1]) < 0.05


# equilibrium


@pytest.fixture(scope="module")
def right():
    return fem(*RIG)


@pytest.fixture(scope="module")
def rig():
    scene = load_scene(SCENE, [COARSE, *RIG])
    problem = scaled(scene, plan(scene, subsurface=True))
    return scene, problem, adapt(problem, 5e-2, 16.0, Clock(), lambda _: None).solution


@pytest.mark.slow
def test_supports_hold_what_acts(rig):
    """Forces and moments of what holds the bodies against p, q and the tension, at load point 2."""
    scene, problem, found = rig
    sigma = scene.load.sigma[1] * scene.length / scene.P
    Q, height = scene.load.Q[1] / scene.P, problem.parts[0].extent[1]
    for moved in displace_bodies(found, problem):
        half, pulled = moved.condensed.body, sigma * (moved.way > 0)
        forces = half.stiffness @ moved.u[1].ravel()
        x, y = half.points
        along_x, along_y = forces.reshape(2, -1)
        held = np.zeros(len(forces), dtype=bool)
        held[half.held] = True
        holds_x, holds_y = (forces * held).reshape(2, -1)
        assert holds_x.sum() == pytest.approx(moved.way * Q - pulled * height, abs=1e-9)
        assert holds_y.sum() == pytest.approx(1, abs=1e-9)
        assert (x @ along_y - y @ along_x) == pytest.approx(0, abs=1e-8)
        free = np.setdiff1d(np.flatnonzero(~held), half.contact.ravel())
        loads = forces - (0 if half.pull is None else pulled * half.pull)
        assert np.abs(loads[free]).max() < 1e-9


def test_a_roller_lets_slide_and_the_sides_hold(rig):
    _, _, found = rig
    lower, upper = (each.body for each in found.bodies)
    N = lower.points.shape[1]
    along_x, along_y = lower.held[lower.held < N], lower.held[lower.held >= N] - N
    assert set(lower.points[0, along_x]) == {lower.points[0].min()}  # gripped at the left, pulled at the right
    assert set(lower.points[1, along_y]) == {lower.points[1].min()}
    half_width = found.bodies[1].mesh.points[:, 0].max()
    assert set(np.abs(upper.held_points[0])) == {half_width}


@pytest.mark.slow
def test_every_step_is_certified(right):
    assert right.certificate["kkt"] < 1e-8
    assert right.certificate["equilibrium"] < 1e-10
    assert right.regime == "small tension"


@pytest.mark.slow
def test_stresses_are_those_of_the_bodies_as_they_are():
    """Far from the contact the pulled specimen bears sigma, and beyond the narrower pad there is none of it."""
    result = fem(*RIG, "load.Q=[0, 0]", subsurface=True)
    at = np.array([-20e-3, 20e-3])
    lower, upper = result.surface.at(at)
    assert lower[0] == pytest.approx(load_scene(SCENE).load.sigma[0], rel=2e-2)
    assert lower[1] == pytest.approx(load_scene(SCENE).load.sigma[1], rel=2e-2)
    assert not upper.any()
    specimen, pad = result.bodies
    assert specimen.points[:, 1].max() == 0
    assert -1e-15 <= pad.points[:, 1].min() < 1e-6  # no node need be at x = 0
    assert set(pad.lines) - set(specimen.lines) == {"flanks"}


# shapes


def test_pads_have_the_true_face(rig):
    scene, problem, found = rig
    mesh, R = found.bodies[1].mesh, scene.profile.R / scene.length
    for name in ("contact", "face"):
        x, y = mesh.points[np.unique(mesh.lines[name])].T
        assert x**2 + (y + R) ** 2 == pytest.approx(R**2, rel=1e-12)
    x = found.lower.x
    assert problem.gap(x) * scene.material.A * scene.P / scene.length == pytest.approx(
        R - np.sqrt(R**2 - x**2), abs=1e-12
    )


def area(mesh):
    a, b, c = (mesh.points[mesh.triangles[:, corner]] for corner in range(3))
    signed = np.linalg.det(np.stack([b - a, c - a], axis=1)) / 2
    assert (signed > 0).all()
    return signed.sum()


@pytest.mark.parametrize("holder", [None, (3.0, 2.0), (2.0, 2.0), (1.2, 2.0)])
def test_outlines_are_filled_once(holder):
    """Area of the block, less what is cut off by the face, and with the holder; all of the boundary is named."""
    mesh = block(2.0, (-0.5, 0.5), {0.0: 0.1}, 0.05, 1.5, holder=holder, face=lambda x: 0.3 * x**2)
    assert area(mesh) == pytest.approx(4 * 1.5 - 0.2 * 2**3 + (4 * holder[0] if holder else 0), rel=1e-3)
    edges = np.sort(np.concatenate([np.roll(mesh.triangles, k, axis=1)[:, :2] for k in range(3)]), axis=1)
    unique, count = np.unique(edges, axis=0, return_counts=True)
    named = np.sort(np.concatenate([*mesh.lines.values()]), axis=1)
    assert sorted(map(tuple, named)) == sorted(map(tuple, unique[count == 1]))
    bottom = mesh.points[mesh.lines["back"]][..., 1]
    assert (bottom == bottom.min()).all()
    assert (np.abs(mesh.points[mesh.lines["left"]][..., 0]) == (holder or (2.0,))[0]).all()


def test_steep_pads_are_meshed():
    """To nine tenths of the radius, and to nine tenths of the height."""
    R = 1.0
    mesh = block(0.9, (-0.02, 0.02), {0.0: 0.002}, 0.7, 0.63, face=lambda x: R - np.sqrt(R**2 - x**2), facets=0.2)
    assert area(mesh) > 0


@pytest.mark.parametrize("accuracy", [1e-4, 1e-6])
def test_a_mesh_on_the_way_is_as_good_at_round_faces_as_away_from_the_ends(accuracy):
    """Its errors count. The last mesh, and one that comes near it, are what the accuracy asks for."""
    problem = SimpleNamespace(parts=[SimpleNamespace(extent=(1.0, 1.0), face=np.square)])
    goal = goals.OutlineErrors.at(accuracy, problem)
    away, last = (goals.next_mesh(size, 10.0, 1e-6, 0.05, 4) for size in (0.1, 1e-5))
    way = goals.OutlineErrors.at(accuracy, problem, away)
    assert way.facet_error > 3 * goal.facet_error
    assert way.corner_error == goal.corner_error
    assert way.errors["m"] == pytest.approx(way.facet_error)
    assert way.errors["right"] > goals._OF_FACETS["right"] * way.facet_error  # corners, too
    assert goals.OutlineErrors.at(1.0, problem, last) == goals.OutlineErrors.at(1.0, problem)


@pytest.mark.slow
def test_straight_sides_of_a_round_face_do_not_matter(monkeypatch, right):
    """Within what the estimate says, and for the contact within the part of it that counts them."""
    result = right
    of_chords = goals._OF_FACETS["a"] * goals._FACET_SHARE * 1e-3
    monkeypatch.setattr(goals, "_FACET_SHARE", 0.02)
    finer = fem(*RIG)
    assert finer.counts["dofs"] > 1.1 * result.counts["dofs"]
    off = np.abs(ends(finer) - ends(result)) / result.a
    assert (off < [result.estimate[key] for key in "amn"]).all()
    assert np.abs(np.subtract(finer.ends, result.ends)).max() / result.a < of_chords


@pytest.mark.slow
def test_a_rig_turned_round_has_m_and_n_exchanged():
    """A sliding specimen held at both ends under a symmetric pad: turned round, with Q, it is the same."""
    sides = (PAD, "bodies.lower={width=60e-3, height=5e-3, support='roller'}", "load.cycles=3", "load.sigma=[0, 0]")
    one, other = fem(*sides, "load.Q=[0, 2e5]"), fem(*sides, "load.Q=[0, -2e5]")
    assert ends(one) == pytest.approx(ends(other)[[0, 2, 1]], abs=1e-4 * one.a)


@pytest.mark.slow
def test_the_pad_may_be_the_lower_body():
    """Q on the one is -Q on the other: with the bodies swapped m and n change places."""
    pad, flat = "{kind='pad', width=20e-3, height=8e-3}", "{width=30e-3, height=10e-3, support='sides'}"
    loads = ("load.Q=[0, 2e5]", "load.sigma=[0, 0]", "load.cycles=2")
    one = fem(f"bodies.upper={pad}", f"bodies.lower={flat}", *loads)
    other = fem(f"bodies.lower={pad}", f"bodies.upper={flat}", *loads)
    assert ends(one) == pytest.approx(ends(other)[[0, 2, 1]], abs=1e-4 * one.a)
    assert abs(one.m - one.n) > 1e-3 * one.a


def test_one_body_stands_for_both_only_if_they_are_mirror_images():
    scene = load_scene(SCENE, both(20e-3, 10e-3, "sides"))
    assert scene.mirrored
    for change in ("pulled=true", "height=11e-3", "support='roller'", "holder={width=1e-2, height=1e-2}", "kind='pad'"):
        key, _, value = change.partition("=")
        other = load_scene(SCENE, [*both(20e-3, 10e-3, "sides"), f"bodies.lower.{key}={value}"])
        assert not other.mirrored, key


ECCENTRIC = (
    "bodies.lower={width=16e-3, height=5e-3, holder={width=40e-3, height=5e-3}, support='sides', pulled=true}",
    "bodies.upper={kind='pad', width=30e-3, height=10e-3}",
    "load.Q=[0, 0]", "load.sigma=[0, 5e7]", "load.cycles=2",
)  # fmt: skip


def bent():
    """How far the ends of the contact move, in half-widths, when a specimen thicker in its middle is pulled."""
    scene = load_scene(SCENE, [COARSE, *ECCENTRIC])
    problem = scaled(scene, plan(scene))
    found = adapt(problem, 1e-2, 16.0, Clock(), lambda _: None).solution
    (left, right), (left_2, right_2) = found.contact_ends
    return np.array([left_2 - left, right_2 - right]) / found.half_width


@pytest.mark.slow
def test_a_pulled_specimen_that_can_bend_moves_the_contact(monkeypatch):
    """What pulls acts below its middle, bends it, and so changes the gap; fault: a tension felt along x only."""
    moved = bent()
    monkeypatch.setattr(
        CondensedBody, "stretch", property(lambda half, of=CondensedBody.stretch.fget: of(half) * [[1.0], [0.0]])
    )
    assert np.abs(moved).max() > 10 * np.abs(bent()).max()


def test_a_plate_that_bends_off_is_told():
    """Held at its sides, a thin plate lifts off the middle of a flat with round corners."""
    plate = "bodies.upper={width=8e-3, height=1e-3, support='sides'}"
    result = fem(plate, "load.P=60e3", "friction.f=0", name="flat-rounded")
    assert "the contact is in 2 pieces: a, m and n are of the outermost ends" in result.notes
    assert result.traction.p[np.abs(result.traction.x) < 0.3 * result.a].max(initial=0) == 0


def test_a_plate_that_lies_down_is_refused():
    """At once: a contact that fills the line is not refined."""
    plate = "bodies.upper={kind='pad', width=20.8e-3, height=1.46e-3, support='sides'}"
    with pytest.raises(partialslip.InputError, match=r"bodies.upper.width: must be wider than the contact"):
        fem(plate)


# deliberate faults


@pytest.mark.slow
def test_tension_of_the_wrong_sign_is_seen(monkeypatch, right):
    true = CondensedBody.stretch.fget
    monkeypatch.setattr(CondensedBody, "stretch", property(lambda half: -true(half)))
    assert np.abs(ends(fem(*RIG)) - ends(right)).max() > 1e-2 * right.a


@pytest.mark.slow
def test_one_body_taken_for_both_is_seen(monkeypatch, right):
    monkeypatch.setattr(Scene, "mirrored", property(lambda _: True))
    assert np.abs(ends(fem(*RIG)) - ends(right)).max() > 1e-3 * right.a
