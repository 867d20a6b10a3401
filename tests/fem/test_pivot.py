"""Bodies that pivot: the moment about the pin, what its height does, half-planes under a moment, and the angle."""

from functools import partial

import numpy as np
import pytest

from partialslip import InputError, load_state, parse_scene, plan, run
from partialslip.codes.export.model import outlined
from partialslip.friction.coupled_step import Pivot
from partialslip.report.sketch import sketch_svg
from partialslip.run import characterise
from partialslip_fem import solving

HEIGHT = 3e-4
SCENE = {
    "name": "pivot", "material": {"E": 72.1e9, "nu": 0.33}, "profile": {"kind": "hertz", "R": 0.01},
    "friction": {"f": 0.3}, "load": {"P": 135750.0, "Q": [-5e3, 20e3], "cycles": 1},
    "bodies": {
        "upper": {"width": 6e-3, "height": 3e-3, "support": "pivot", "pivot_height": HEIGHT},
        "lower": {"width": 8e-3, "height": 2e-3, "support": "roller"},
    },
    "fem": {"size": 0.2},
}  # fmt: skip
TURNED_OVER = {
    "bodies.upper": {"width": 8e-3, "height": 2e-3, "support": "roller", "pivot_height": None},
    "bodies.lower": {"width": 6e-3, "height": 3e-3, "support": "pivot", "pivot_height": HEIGHT},
}
CLAMPED = {"bodies.upper.support": "clamped", "bodies.upper.pivot_height": None}
PAD = {"bodies.upper.kind": "pad"}
FLAT = {"profile": {"kind": "flat-rounded", "R": 0.01, "b": 1e-4}}
FAR = {"bodies.upper": {"width": 16e-3, "height": 16e-3}, "bodies.lower": None}  # large beside the contact
TWO_PIVOTS = {"bodies.lower.support": "pivot", "bodies.lower.pivot_height": 0.0}
FIXED = {"profile": {"kind": "tabulated", "x": [-1e-3, 0.0, 1e-3], "gap": [1e-5, 0.0, 2e-5], "tilt": "fixed"}}
HIGH, WIDE = {"bodies.upper.pivot_height": 0.5}, {"bodies.upper.width": 0.4, "bodies.lower.width": 0.4}
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(8)


def solved(changes=None, **asked):
    return run(parse_scene(SCENE).replace(changes or {}), "fem", **asked)["fem"]


def resultants(result):
    """int p dx, int q dx and int x p dx at load points 1 and 2, (2, 3)."""
    cells = result.traction.cells
    half = np.diff(cells)[:, None] / 2
    x = (cells[1:] + cells[:-1])[:, None] / 2 + half * _POINTS
    at, weights = result.traction.at(x), half * _WEIGHTS
    both = ((at.p1, at.q1), (at.p, at.q2))
    return np.array([[(each * weights).sum() for each in (p, q, x * p)] for p, q in both])


@pytest.mark.parametrize(
    ("changes", "height", "M"),
    [
        pytest.param({}, HEIGHT, [0.0, 0.0], marks=pytest.mark.slow),
        pytest.param(TURNED_OVER, -HEIGHT, [0.0, 0.0], marks=pytest.mark.slow),
        (PAD | {"load.M": 4.0}, HEIGHT, [4.0, 4.0]),
        ({"load.M": [-3.0, 5.0]}, HEIGHT, [-3.0, 5.0]),
        ({"load.e": 2e-5, "load.P": [1e5, 135750.0]}, HEIGHT, [2.0, 2.715]),
        (FLAT, HEIGHT, [0.0, 0.0]),
    ],
    ids=["upper", "lower", "pad under M", "M varies", "P varies at e", "flat"],
)
def test_forces_about_the_pin_have_the_moment(changes, height, M):
    found = solved(changes)
    _, Q, of_p = resultants(found).T
    assert of_p + height * Q == pytest.approx(M, abs=1e-10 * 135750.0 * found.a)
    assert list(Q) == pytest.approx([-5e3, 20e3], rel=1e-9)
    assert found.certificate["kkt"] < 1e-9
    assert found.certificate["equilibrium"] < 1e-9


@pytest.mark.fault
def test_a_moment_arm_of_the_wrong_sign(monkeypatch):
    """Deliberate fault: the pin of an upper body lies below the contact line."""
    monkeypatch.setattr(solving, "Pivot", lambda arms, height, moment: Pivot(arms, -height, moment))
    found = solved()
    _, Q, of_p = resultants(found).T
    assert np.abs(of_p + HEIGHT * Q).max() > 0.3 * 135750.0 * found.a


def test_without_q_a_symmetric_body_does_not_turn():
    found, clamped = solved({"load.Q": [0.0, 0.0]}), solved(CLAMPED | {"load.Q": [0.0, 0.0]})
    assert np.abs(found.plates.turn).max() < 1e-5  # no mesh is even
    assert found.contact_ends[1] == pytest.approx(clamped.contact_ends[1], abs=1e-4 * clamped.a)
    x = np.linspace(-0.9, 0.9, 19) * clamped.a
    assert found.traction.at(x).p == pytest.approx(clamped.traction.at(x).p, rel=2e-4)


@pytest.mark.slow
def test_a_pin_in_the_contact_keeps_the_pressure_in_the_middle():
    """A clamped body takes a moment, with which Q moves its pressure."""
    low, clamped = solved({"bodies.upper.pivot_height": 0.0}), solved(CLAMPED)
    assert np.abs(resultants(low)[:, 2]).max() < 1e-10 * 135750.0 * low.a
    assert np.abs(resultants(clamped)[:, 2]).max() > 5e-4 * 135750.0 * clamped.a


@pytest.mark.slow
def test_a_high_pin_moves_the_contact():
    """A cylinder rolls to where the line of action of P and Q meets the contact line."""
    high = solved({"bodies.upper.pivot_height": 2e-3})
    middles = np.mean(high.contact_ends, axis=1)
    assert middles == pytest.approx([2e-3 * 5e3 / 135750.0, -2e-3 * 20e3 / 135750.0], rel=2e-2)


@pytest.mark.slow
def test_mirrored_loads_turn_the_body_the_other_way():
    one, other = solved({"load.M": 2.0}), solved({"load.M": -2.0, "load.Q": [5e3, -20e3]})
    assert other.plates.turn == pytest.approx(-one.plates.turn, rel=1e-4)
    assert np.array(other.contact_ends)[:, ::-1] == pytest.approx(-np.array(one.contact_ends), abs=1e-3 * one.a)


@pytest.mark.slow
def test_a_large_body_turns_like_a_half_plane():
    """Half-planes under the moment that P, Q and M have at the contact line, by marching; the effect of the size falls
    with its square."""
    Q, M = np.array([5e3, 30e3]), 5.0
    loads = {"load.Q": Q.tolist(), "load.M": M, "load.steps": 4, "load.cycles": 3, "fem.size": None}
    scene = parse_scene(SCENE).replace(loads | {"fem.accuracy": 1e-3, "bodies.lower": None})
    half_planes = scene.replace({"bodies.upper": None, "load.M": (M - HEIGHT * Q).tolist(), "fem.accuracy": 1e-4})
    known, off = run(half_planes, "march")["march"], []
    for size in (8e-3, 16e-3):
        found = run(scene.replace({"bodies.upper.width": size, "bodies.upper.height": size}), "fem")["fem"]
        off.append(np.abs(np.subtract(found.contact_ends, known.contact_ends)).max() / known.a)
        assert (found.m, found.n) == pytest.approx((known.m, known.n), abs=2e-4 * known.a)
    assert off[1] < 7e-5 < 3 * off[1] < off[0]


@pytest.mark.slow
@pytest.mark.parametrize("changes", [{}, TURNED_OVER], ids=["upper", "lower"])
def test_turned_bodies_touch_all_along_the_contact(changes):
    """Displacements inside the bodies include the turn of their plate: the gap is closed."""
    found = solved(changes, subsurface=True)
    surfaces = []
    for body in found.bodies:  # whose nodes lie opposite each other
        nodes = np.unique(body.lines["contact"])
        nodes = nodes[np.abs(body.points[nodes, 0]) < 0.7 * found.a]
        nodes = nodes[np.argsort(body.points[nodes, 0])]
        surfaces.append(np.array([body.displacements[f"displacement_{point}"][nodes, 1] for point in (1, 2)]))
    x = body.points[nodes, 0]
    opening = surfaces[1] - surfaces[0] + x**2 / (2 * SCENE["profile"]["R"])
    assert np.ptp(opening, axis=1).max() < 1e-3 * np.abs(found.plates.turn[1] * found.a)
    assert opening.mean(axis=1) == pytest.approx(found.plates.approach, rel=1e-3)


@pytest.mark.slow
def test_a_run_goes_on_from_a_state(tmp_path):
    first = solved()
    first.state.save(tmp_path / "state.npz")
    scene, state = parse_scene(SCENE), load_state(tmp_path / "state.npz")
    again = run(scene, "fem", start=state)["fem"]
    assert (again.m, again.n) == pytest.approx((first.m, first.n), abs=1e-3 * first.a)
    with pytest.raises(InputError, match="state: is of M"):
        run(scene.replace({"bodies.upper.pivot_height": 2 * HEIGHT}), "fem", start=state)


def test_the_plan_tells_why_a_body_turns():
    scene = parse_scene(SCENE)
    assert "about its pin is 0 N" in plan(scene).called_for["moment"]
    assert "moment" not in plan(scene.replace(CLAMPED)).called_for
    with pytest.raises(InputError, match=r"effects.coupling = false: a body pivots"):
        plan(scene.replace({"effects": {"coupling": False}}))


@pytest.mark.slow
def test_a_body_whose_turn_is_forced_off_is_clamped():
    held, clamped = solved({"effects": {"moment": False}}), solved(CLAMPED)
    assert held.plates.displacement == pytest.approx(clamped.plates.displacement, rel=1e-12)
    assert (held.m, held.n) == pytest.approx((clamped.m, clamped.n), rel=1e-12)


def test_without_friction_the_moment_moves_the_pressure():
    found = solved({"friction.f": 0.0, "load.Q": [0.0, 0.0], "load.M": 10.0})
    assert np.mean(found.contact_ends[1]) == pytest.approx(10.0 / 135750.0, rel=1e-2)


def test_the_sketch_shows_the_pin():
    drawn = sketch_svg(parse_scene(SCENE).replace({"bodies.lower": None}))
    assert drawn.count("<circle") == 1


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"bodies.upper.pivot_height": None}, "bodies.upper.pivot_height: missing; must be given with support 'pivot'"),
        ({"bodies.upper.support": "clamped"}, r"pivot_height = 0.0003: must be given only with support 'pivot'"),
        ({"bodies.upper.pivot_height": -1e-3}, "bodies.upper.pivot_height = -0.001: must be >= 0"),
        (TWO_PIVOTS, "bodies.lower.support = 'pivot': must be"),
        ({"bodies.lower": {**TURNED_OVER["bodies.lower"], "pulled": True}, **CLAMPED}, "'sides', not 'pivot'"),
        (CLAMPED | {"load.M": 1.0}, "one must have support 'pivot'"),
        ({"load.Q": [0.0, 5e4]}, r"load.Q = \[0.0, 50000.0\]: must keep \|Q\| below f P at each load point on a body"),
        (FIXED, "bodies.upper.support = 'pivot': must not be given with profile.tilt = 'fixed'"),
        (HIGH, "must be wider than the contact|must move the line of action"),
        (HIGH | WIDE, "load.Q, load.M, load.e, bodies.upper.pivot_height: must move the line of action of P by less"),
    ],
)
def test_bad_input_is_one_line(changes, told):
    with pytest.raises(InputError, match=told) as caught:
        solved(changes)
    assert "\n" not in str(caught.value)


def test_what_knows_no_pin_refuses_it():
    scene = parse_scene(SCENE)
    for of in (characterise, partial(run, methods="equivalent"), outlined):
        with pytest.raises(InputError, match=r"bodies.upper.support = 'pivot': must be"):
            of(scene)
    unlike = {"material": {"lower": {"E": 72.1e9, "nu": 0.33}, "upper": {"E": 200e9, "nu": 0.3}}, "load.M": 1.0}
    with pytest.raises(InputError, match=r"load.M: must be left out by march with bodies of different materials"):
        run(scene.replace({"material.E": None, "material.nu": None, **unlike}), "march")


@pytest.mark.slow
def test_a_body_that_rocks_and_sticks_does_not_ratchet():
    """Slip that settles, below 1e-7 of that of nodes that open and close, is no slip that adds up."""
    found = solved({"bodies.upper.pivot_height": 1e-3, "friction.f": 0.5, "load.Q": [-10e3, 10e3], "load.cycles": 5})
    assert found.regime in ("sticking ends", "no slip")
