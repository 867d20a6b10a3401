"""Coupled bodies that are pressed together with friction: Spence's self-similar solution, and one step of all of P.

Steel on aluminium. Goodman's approximation keeps what pressure does to the displacements along x and drops what shear
does to the gap; with it the part of the contact that sticks is c with K(c)/K'(c) = f/beta, beta = 1/7 (Spence 1975).
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from plain import plain
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import ellipk, ellipkm1

import partialslip
from partialslip import plan
from partialslip.friction import coulomb_coupled
from partialslip.friction.coupled_step import LoadStep
from partialslip.friction.coupled_step import solve as solve_step
from partialslip.friction.even_gap import EvenGap
from partialslip.friction.pressing import FlatPunch, Punches
from partialslip.halfplane.punch import Punch as Flats
from partialslip.run.judge.measures import norm_errors
from partialslip_fem import solve, solving
from partialslip_fem.problem import ScaledProblem

BETA = 1 / 7


def scene(f, **more):
    steel = {"E": 70e9, "nu": 0.3, "upper": {"E": 210e9, "nu": 0.3}}
    return plain({"P": 1e6, **more}, f, steel, {"kind": "hertz", "R": 0.05}, fem={"accuracy": 1e-3})


def spence(f):
    return brentq(lambda c: ellipk(c**2) / ellipkm1(c**2) - f / BETA, 1e-6, 1 - 1e-12)


@pytest.fixture(scope="module")
def pressed():
    """Solutions by f, each made when it is asked for first."""
    return cache(lambda f: solve(scene(f), plan(scene(f))))


@pytest.mark.parametrize(("f", "c"), [pytest.param(0.1, 0.4058, marks=pytest.mark.slow), (0.3, 0.9891)])
def test_goodmans_coupling_gives_spences_stick_zone(f, c, monkeypatch):
    assert spence(f) == pytest.approx(c, abs=1e-4)
    true = solving.relative_compliances
    monkeypatch.setattr(
        solving,
        "relative_compliances",
        lambda *args: replace(whole := true(*args), yx=None if whole.xy is None else 0 * whole.xy),
    )
    result = solve(scene(f), plan(scene(f)))
    assert (result.m / result.a, result.n / result.a) == pytest.approx((c, c), abs=2e-3)
    hertz = np.sqrt(2 / np.pi) * scene(f).length
    assert result.a == pytest.approx(hertz, rel=1e-3)  # p does not know of q


@pytest.mark.parametrize(("f", "c"), [pytest.param(0.1, 0.3945, marks=pytest.mark.slow), (0.3, 0.9862)])
def test_slip_while_pressed_is_told(f, c, pressed):
    """The regime does not say that nothing slipped; the stick zone is where the surfaces stuck since they touched."""
    result = pressed(f)
    assert result.regime == "pressing"
    assert any("stuck since they touched" in note for note in result.notes)
    assert (result.m / result.a, result.n / result.a) == pytest.approx((c, c), abs=1e-3)
    x, p, q = result.traction.x / result.a, result.traction.p, result.traction.q2
    slips = (np.abs(x) > c + 0.003) & (np.abs(x) < 0.999)  # nodes of the element at the zone's end may stick
    assert np.abs(q[slips]) == pytest.approx(f * p[slips], rel=0.02)
    assert np.array_equal(np.sign(q[slips]), -np.sign(x[slips])) or np.array_equal(np.sign(q[slips]), np.sign(x[slips]))
    assert max(result.estimate[key] for key in ("a", "m", "n")) <= 1e-3
    assert result.estimate["q"] < 1e-2
    assert result.shares["steps"]["q2"] <= 15e-3
    assert result.certificate["kkt"] < 1e-9


@pytest.mark.fault
def test_one_step_of_pressing_forgets_what_stuck_early(monkeypatch, pressed):
    """Deliberate fault: all of P in one step."""
    assert pressed(0.3).m / pressed(0.3).a == pytest.approx(0.986, abs=2e-3)

    def at_once(C, gap, f, *_):
        zero = coulomb_coupled.resting(0 * gap)
        kept = 0 * gap
        p, q = solve_step(LoadStep(C.xx, C.yy, C.xy, C.opening, f, 1.0, gap, 0.0, kept), [(zero, zero)])
        return coulomb_coupled.Pressed(p, q, 1, {"q": 0.0, "a": 0.0}, (p.x, q.x), f)

    monkeypatch.setattr(coulomb_coupled, "press_coupled", at_once)
    wrong = solve(scene(0.3), plan(scene(0.3)))
    assert wrong.m / wrong.a < 0.8
    assert abs(wrong.a - pressed(0.3).a) > 2e-3 * wrong.a


X = np.sin(np.linspace(-np.pi / 2, np.pi / 2, 201))
_EDGES = np.concatenate([[-1.0], np.sin(np.linspace(-np.pi / 2, np.pi / 2, 402)[1:-1:2]), [1.0]])
WEIGHTS = np.diff(_EDGES)[: len(X)]


def punch(sheared, **more):
    """A flat punch on nodes ``X``: p = 1/(pi sqrt(1 - t^2)), and, if it is ``sheared``, q = t/sqrt(1 - t^2)."""
    forces = np.diff(np.arcsin(_EDGES)) / np.pi, -sheared * np.diff(np.sqrt(1 - _EDGES**2))
    left = 0.5 + np.arcsin(X[3:-3]) / np.pi, -sheared * np.sqrt(1 - X[3:-3] ** 2)
    return FlatPunch((-1.0, 1.0), X, WEIGHTS, forces, X[3:-3], left, **more)


def test_punches_add_up_to_a_parabola():
    """The closed form: flat punches of all half-widths, 1/(pi sqrt(1 - x^2)), make 2/pi sqrt(1 - x^2)."""
    x, weights, stages = X, WEIGHTS, punch(sheared=0)
    for share, nodes, error in ((1.0, 0.99, 2e-4), (0.9, 0.88, 1e-3)):
        p, q = stages.stage(1.0, share)
        expected = share * 2 / np.pi * np.sqrt(np.maximum(1 - (x / share) ** 2, 0.0))
        expected *= share**2 / (weights @ expected)  # at nodes, too, the sum is the load
        inside = np.abs(x) < nodes
        assert p[inside] / weights[inside] == pytest.approx(expected[inside], abs=error)
        assert not q.any()


def test_punches_of_like_bodies_of_a_size_add_up():
    """The closed form: shear t/sqrt(1 - t^2) under flat punches, which grows like their half-width, makes
    2 x sqrt(1 - x^2); after a part of the half-width, the square of that part times this."""
    x, weights, stages = X, WEIGHTS, punch(sheared=1, sized=True)
    for share, nodes, error in ((1.0, 0.99, 1e-2), (0.9, 0.88, 1e-2)):  # of 201 nodes
        _, q = stages.stage(1.0, share)
        root = np.sqrt(np.maximum(1 - (x / share) ** 2, 0.0))
        expected = share * 2 * x * root / (weights @ root * 2 / np.pi / share)  # at nodes, too, the sum is the load
        inside = np.abs(x) < nodes
        assert q[inside] / weights[inside] == pytest.approx(expected[inside], abs=error)


@pytest.mark.parametrize("flat", [0.3, 0.9])
def test_punches_add_up_to_a_flat_rounded_contact(flat):
    """The pressure is that of the exact method, also after a part of the half-width; shear t/sqrt(1 - t^2) under flat
    punches, which grows like their half-width, is integrated numerically."""
    gap = EvenGap(np.array([flat]), np.ones(1))
    x, weights, stages = X, WEIGHTS, punch(sheared=1, sized=True, gap=gap)
    for share in (1.0, 0.95):
        p, q = (each / weights for each in stages.stage(1.0, share))
        inside = np.abs(x) < 0.98 * share
        exact = Flats(flat / share).pressure(x / share)
        assert p[inside] == pytest.approx(exact[inside] * p[100] / exact[100], rel=1e-3)
        assert weights @ p == pytest.approx(gap.force(share) / gap.force(1.0))
        at = np.array([32, 60, 90, 130])
        expected = [
            t * quad(lambda s, t=t: np.arccos(flat / s) / np.sqrt(1 - (t / s) ** 2), max(abs(t), flat), share)[0]
            for t in x[at].tolist()
        ]
        assert q[at] == pytest.approx(np.array(expected) / gap.force(1.0), rel=5e-3, abs=1e-2)  # of 201 nodes
    assert not np.any(stages.stage(1.0, flat / 2))  # before the corners bear


def test_a_stage_bears_its_load_and_no_shear():
    """Whatever the nodes are: a sum of q left over would have to slip in the last step, on one side only."""
    random = np.random.default_rng(1)
    x = np.sort(random.uniform(-1, 1, 301))
    weights = np.gradient(x)
    normal = weights / np.sqrt(1 - x**2)
    forces = normal, 0.3 * np.sign(x) * normal
    p, q = FlatPunch((-1.0, 1.0), x, weights, forces, x, tuple(map(np.cumsum, forces))).stage(1.0, 0.95)
    assert p.sum() == pytest.approx(0.95**2)
    assert abs(q.sum()) < 1e-12


def test_pressing_begins_on_a_mesh_with_hardly_a_node_in_the_contact():
    """The first mesh of linear elements may have two nodes on either side of the middle."""
    found = partialslip.run(scene(0.2).replace(fem={"order": 1, "size": 0.1}), "fem")["fem"]
    assert found.regime == "pressing"
    assert found.m == pytest.approx(found.n, abs=0.05 * found.a)


@pytest.mark.parametrize("stick", [1.0, 0.8])
def test_displacements_under_punches_add_up_to_those_under_a_parabola(stick):
    """What a punch closes beside it on half-planes, arccosh(x/s), integrated with 2 s ds, is x^2, the gap; so integrate
    displacements 1 - (c s/x)^2 beyond a stick zone of c s."""
    half_widths, x = np.array([1.0, 0.5, 0.25]), np.linspace(-1.25, 1.25, 1001)
    under = []
    for half_width in half_widths:
        t = np.abs(x) / half_width
        moved = np.sign(x) * np.maximum(1 - (stick / np.maximum(t, 1e-9)) ** 2, 0.0)
        under.append((t <= 1 + 1e-9, t <= stick + 1e-9, moved, -np.arccosh(np.maximum(t, 1.0))))
    punches = Punches.of(half_widths, x, under)
    assert punches.stick == pytest.approx(stick, abs=0.01)
    share = 0.9
    top = np.minimum(share, np.abs(x) / stick)  # of the half-widths at which x still slips
    with np.errstate(divide="ignore", invalid="ignore"):
        expected = np.sign(x) * (top**2 - (stick * top**2 / x) ** 2 / 2)
    inside = (np.abs(x) < 1) & (x != 0)
    for count in (1, 2, 3):
        kept = punches.kept(x**2, 1.0, share, count)
        assert kept[inside] == pytest.approx(expected[inside], abs=(0.3, 5e-3, 5e-4)[count - 1])


def blocks(size):
    return {"bodies": {side: {"kind": "block", "width": size, "height": size} for side in ("upper", "lower")}}


@pytest.mark.parametrize(("f", "error", "steps"), [(0.1, 0.01, 7), (0.3, 0.03, 8)])
def test_large_blocks_are_pressed_like_half_planes(f, error, steps):
    """Blocks of 200 contact widths on elements of one size, against half-planes on cells of their own (march). With the
    larger f the slip zone is narrower than an element."""
    of = scene(f).replace(fem={"size": 0.04, "accuracy": 1e-3})
    found = partialslip.run(of.replace(**blocks(2.0)), "fem")["fem"]
    march = partialslip.run(of.replace(fem={"accuracy": 1e-2}), "march")["march"]
    assert found.counts["pressing_steps"] == steps
    assert found.a == pytest.approx(march.a, rel=1e-3)
    assert found.m / found.a == pytest.approx(march.m / march.a, abs=0.02)  # half an element
    x = np.linspace(-0.95, 0.95, 191)
    q, expected = (each.traction.at(x * each.a).levels[1] for each in (found, march))
    assert np.linalg.norm(q - expected) < error * np.linalg.norm(expected)


def test_blocks_are_pressed_as_step_by_step(monkeypatch):
    """The small last step after what flat punches tell, against steps of all of P, which converge towards it."""
    of = scene(0.2).replace(fem={"size": 0.04}, **blocks(20e-3))
    found = partialslip.run(of, "fem")["fem"]
    assert found.certificate["kkt"] < 1e-10
    monkeypatch.setattr(coulomb_coupled, "_nearly_similar", lambda *_: None)
    off = []
    for most in (8, 32):
        monkeypatch.setattr(coulomb_coupled, "_MOST", most)
        stepped = partialslip.run(of, "fem")["fem"]
        change = found.traction.q2 - np.interp(found.traction.x, stepped.traction.x, stepped.traction.q2)
        off.append(np.linalg.norm(change) / np.linalg.norm(found.traction.q2))
    assert stepped.shares["steps"]["q2"] > 3 * found.shares["steps"]["q2"]
    assert not found.estimate  # elements as given: what is known of the steps alone is no estimate
    assert off[1] < 0.1
    assert off[1] < off[0] / 1.5
    assert stepped.counts["normal_solves"] > 2 * found.counts["normal_solves"]


@pytest.mark.fault
def test_one_punch_for_all_sizes_is_seen(monkeypatch):
    """Deliberate fault: what smaller punches do is taken from the largest, beyond whose ends are few nodes."""
    of = scene(0.2).replace(fem={"size": 0.04}, **blocks(2.0))
    right = partialslip.run(of, "fem")["fem"]
    true = Punches.kept
    monkeypatch.setattr(Punches, "kept", lambda self, gap, reach, share, _: true(self, gap, reach, share, 1))
    wrong = partialslip.run(of, "fem")["fem"]
    x = np.linspace(-0.95, 0.95, 191)
    q, other = (each.traction.at(x * each.a).levels[1] for each in (right, wrong))
    assert np.linalg.norm(other - q) > 0.05 * np.linalg.norm(q)


def unlike(accuracy=1e-3):
    steel = {"E": 70e9, "nu": 0.1, "upper": {"E": 200e9, "nu": 0.3}}
    return scene(0.25).replace(material=steel, profile={"R": 0.01}, load={"P": 2e4}, fem={"accuracy": accuracy})


INDEPENDENT = 0.607382  # m/a from a fully coupled flat punch of second order, on cells of its own


@pytest.fixture(scope="module")
def march():
    return partialslip.run(unlike(1e-4), "march")["march"]


@pytest.fixture(scope="module")
def fem():
    """Finite elements of unlike half-planes by accuracy, each made when it is asked for first."""
    return cache(lambda accuracy: solve(unlike(accuracy), plan(unlike(accuracy))))


@pytest.mark.parametrize("accuracy", [1e-3, pytest.param(1e-4, marks=pytest.mark.slow)])
def test_estimates_of_unlike_half_planes_hold(accuracy, march, fem):
    result = fem(accuracy)
    assert march.m / march.a == pytest.approx(INDEPENDENT, abs=1e-5)
    assert abs(result.m / result.a - INDEPENDENT) < result.estimate["m"]
    assert abs(result.n / result.a - INDEPENDENT) < result.estimate["n"]
    assert abs(result.a / march.a - 1) < result.estimate["a"] + march.estimate["a"]
    assert result.estimate["m"] < accuracy


def test_pressure_where_unlike_half_planes_touch_first(march, fem, monkeypatch):
    """It has a kink there, as shear is locked in like x log|x|."""
    x = np.linspace(-0.05, 0.05, 401) * march.a

    def off(result):
        p, other = (each.traction.at(x).p for each in (result, march))
        return np.sqrt(np.mean((p - other) ** 2)) / march.p0

    assert off(fem(1e-3)) < 5e-5
    # deliberate fault: elements are as wide there as they grow
    monkeypatch.setattr(ScaledProblem, "touches_first", None)
    assert off(solve(unlike(), plan(unlike()))) > 2e-4


@pytest.mark.slow
def test_unlike_half_planes_are_pressed_under_a_flat_with_rounded_corners():
    """The contact grows like a flat punch, whose stick zone does not depend on the profile: fem's punch on nodes and
    march's on cells of its own agree. Steps of finite size, from which march read it before, were off by 5e-3."""
    of = scene(0.2).replace(profile={"kind": "flat-rounded", "R": 0.05, "b": 1e-3}, load={"P": 3e5})
    fem, march = (partialslip.run(of, method)[method] for method in ("fem", "march"))
    parabola = partialslip.run(scene(0.2), "march")["march"]
    assert march.m / march.a == pytest.approx(parabola.m / parabola.a, abs=1e-6)
    assert abs(fem.m / fem.a - march.m / march.a) < fem.estimate["m"] + march.estimate["m"]
    assert abs(fem.n / fem.a - march.n / march.a) < fem.estimate["n"] + march.estimate["n"]
    off = norm_errors(fem.traction, march.traction, 0.2, ("q1",))["q1"]
    assert off < fem.estimate["q1"] + march.estimate["q1"] < 0.02


PAD = plain(
    {"P": 135750.0}, fem={"accuracy": 1e-3}, bodies={
        "upper": {"kind": "pad", "width": 10e-3, "height": 5e-3, "support": "sides"},
        "lower": {"kind": "block", "width": 40e-3, "height": 4e-3, "support": "roller"},
    },
)  # fmt: skip
PARTS = np.array([0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9])


def locked_in(scene):
    """Shear at ``PARTS`` of the half-width, odd in x, and what is said of its error."""
    result = partialslip.run(scene, "fem")["fem"]
    right, left = (result.traction.at(side * PARTS * result.a).q1 for side in (1, -1))
    return (right - left) / 2, result


def shape(q):
    """Amplitude of x sqrt(1 - x^2) in the shear, and what is left of it, relative."""
    form = PARTS * np.sqrt(1 - PARTS**2)
    amplitude = float(q @ form / (form @ form))
    return amplitude, float(np.linalg.norm(q - amplitude * form) / np.linalg.norm(q))


@pytest.mark.slow
def test_a_pad_is_pressed_with_the_shear_of_the_closed_form(monkeypatch):
    """Surfaces of like bodies of a size move along x with the same strain wherever they are pressed: the shear that is
    locked in is x sqrt(1 - x^2). Its size is that of step-by-step solutions, which only scatter about that form: by 6 %
    from mesh to mesh, so that a single one tells little."""
    amplitude, off = shape(locked_in(PAD)[0])
    assert off < 0.02
    finer, q1 = locked_in(PAD.replace(fem={"accuracy": 1e-4}))
    assert shape(finer)[0] == pytest.approx(amplitude, rel=0.01)
    assert q1.estimate["q1"] < 0.03
    monkeypatch.setattr(coulomb_coupled, "_similar", lambda *_: None)
    monkeypatch.setattr(coulomb_coupled, "_nearly_similar", lambda *_: None)
    sizes = np.linspace(0.017, 0.023, 7)
    steps, told = zip(*(locked_in(PAD.replace(fem={"size": size}, load={"steps": 64})) for size in sizes), strict=True)
    assert shape(np.mean(steps, axis=0))[0] == pytest.approx(amplitude, rel=0.05)
    assert np.ptp([shape(each)[0] for each in steps]) > 0.1 * amplitude
    assert np.mean([each.shares["steps"]["q1"] for each in told]) > 0.07


FLAT_PAD = PAD.replace(profile={"kind": "flat-rounded", "R": 0.01, "b": 0.3e-3}, load={"P": 8e4}, fem={"size": 0.04})


def test_a_flat_rounded_pad_is_pressed_as_step_by_step(monkeypatch):
    """Flat punches from the flat to the contact's ends, against 64 steps of all of P, which take longer."""
    inside = PARTS < 0.7  # beside the flat's ends, at 0.74, 64 steps are not enough
    found, result = locked_in(FLAT_PAD)
    monkeypatch.setattr(coulomb_coupled, "_similar", lambda *_: None)
    stepped, by_steps = locked_in(FLAT_PAD)
    assert result.counts["pressing_steps"] < by_steps.counts["pressing_steps"] / 4
    off = np.linalg.norm((stepped - found)[inside]) / np.linalg.norm(found[inside])
    assert off < result.shares["steps"]["q1"] < 0.05


@pytest.mark.fault
def test_a_flat_pressed_like_a_parabola_is_seen(monkeypatch):
    """Deliberate fault: the force of the punches grows as under a parabola, from the middle."""
    found, _ = locked_in(FLAT_PAD)
    monkeypatch.setattr(EvenGap, "rate", lambda _, half_widths: half_widths)
    wrong, told = locked_in(FLAT_PAD)
    assert np.linalg.norm(wrong - found) > 2 * told.shares["steps"]["q1"] * np.linalg.norm(found)


@pytest.mark.slow
@pytest.mark.fault
def test_shear_of_a_pad_that_does_not_grow_is_seen(monkeypatch):
    """Deliberate fault: stages of like bodies of a size as of unlike half-planes, whose shear under one force does not
    grow with the half-width. The second punch does not enter the stages, and tells how similar bodies are."""
    monkeypatch.setattr(coulomb_coupled, "FlatPunch", lambda *args: FlatPunch(*args[:6], False, *args[7:]))
    assert shape(locked_in(PAD)[0])[1] > 0.1


@pytest.mark.slow
def test_a_pad_that_slips_while_it_is_pressed_goes_step_by_step():
    """A contact of a quarter of the height: a second punch finds other forces than similarity would have them, as much
    of the first one slips. Slip that only goes on needs few steps."""
    scene = PAD.replace(load={"P": 15 * PAD.P}, bodies={"lower": {"height": 3e-3}, "upper": {"height": 3e-3}})
    q, result = locked_in(scene)
    assert result.counts["pressing_steps"] == 2
    assert result.m < 0.4 * result.a
    assert np.abs(q[PARTS > 0.4]) == pytest.approx(0.3 * result.traction.at(PARTS[PARTS > 0.4] * result.a).p, rel=0.01)
    assert result.estimate["q1"] < 0.05


@pytest.mark.slow
def test_a_cycle_after_a_flat_was_pressed_agrees_with_the_march():
    """Q moves the stick zone into the shear that pressing locked in, whose small errors it enlarges tenfold."""
    unlike = {"upper": {"E": 210e9, "nu": 0.3}, "lower": {"E": 48e9, "nu": 0.1}}
    flat = {"kind": "flat-rounded", "R": 0.05, "b": 5e-4}
    of = plain({"P": 2.45e5, "Q": [-6.6e4, 6.6e4]}, 0.67, unlike, flat, fem={"accuracy": 1e-3})
    found = partialslip.run(of, ["march", "fem"]).results
    off = norm_errors(found["fem"].traction, found["march"].traction, 0.67, ("q1", "q2"))
    for key, error in off.items():
        assert error < found["fem"].estimate[key] + found["march"].estimate[key] < 6e-3
