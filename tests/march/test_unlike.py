"""March of unlike half-planes: Spence's solutions, invariances, and finite elements."""

from types import SimpleNamespace

import numpy as np
import pytest
from plain import plain
from scipy.special import xlogy

import partialslip
from partialslip import load_scene, parse_scene
from partialslip.friction import coulomb_coupled
from partialslip.friction.even_gap import PARABOLA, EvenGap
from partialslip.march import driver, punch_growth, unlike
from partialslip.march.punch_growth import PunchGrowth, goodman_stick_zone, relative
from partialslip.march.unlike import dundurs
from partialslip.result import Clock
from partialslip.run.judge.measures import norm_errors
from partialslip.scene.plan import plan

STEEL = ("material.upper.E=210e9", "material.upper.nu=0.3", "load.cycles=2")
SHEARED = ("fem.accuracy=1e-2", *STEEL)


def solved(*overrides, name="hertz-shear", method="march"):
    return partialslip.run(load_scene(name, [*SHEARED, *overrides]), method)[method]


def stick_zone(beta, f, opening):
    punch = PunchGrowth.of(beta, f, opening)
    slips = np.abs(punch.tangential) >= (1 - 1e-9) * f * punch.normal
    return punch.vertices[:-1][slips].min()  # a cell's end: cells there are 2 % of the zones


@pytest.mark.parametrize("f", [0.05, 0.1, 0.2, 0.3])
def test_punch_with_goodmans_coupling_sticks_as_spence_says(f):
    """K(c)/K'(c) = f/beta, beta = 1/7 (Spence 1975)."""
    c = goodman_stick_zone(7 * f)
    assert stick_zone(1 / 7, f, False) == pytest.approx(c, abs=0.02 * min(c, 1 - c))


@pytest.mark.parametrize(("f", "c"), [(0.1, 0.3945), (0.3, 0.9862)])
def test_punch_with_all_of_the_coupling(f, c):
    """The same stick zones as of finite elements (tests/fem/test_pressing.py)."""
    assert stick_zone(1 / 7, f, True) == pytest.approx(c, abs=0.02 * min(c, 1 - c))


def test_stages_of_pressing_bear_their_load():
    """The resultants of the stage are those of its tractions, and the sums are P and zero."""
    punch = PunchGrowth.of(-0.1, 0.2)
    x = np.linspace(-1.1, 1.1, 45)
    for normal, tangential in (punch.stage(x), punch.resultants(x)):
        assert (normal[0], normal[-1]) == pytest.approx((1, 0), abs=1e-12)
        assert (tangential[0], tangential[-1]) == pytest.approx((0, 0), abs=1e-12)
        assert normal + normal[::-1] == pytest.approx(1, abs=1e-12)
        assert tangential == pytest.approx(tangential[::-1], abs=1e-12)
    first, h = int(np.searchsorted(punch.vertices, 0.5)), 1e-5
    at, inverse = punch.vertices[first], 1 / punch.vertices[first:]
    normal, _ = punch.stage(np.array([at - h, at + h]))
    traction = 2 * at * (punch.normal[first:] @ -np.diff(inverse))  # 2 x times the integral of p_flat(s)/s^2
    assert (normal[0] - normal[1]) / (2 * h) == pytest.approx(traction, rel=1e-3)


def test_stages_under_any_gap_are_those_under_a_parabola():
    punch, x, reach = PunchGrowth.of(-0.1, 0.2), np.linspace(-1.1, 1.1, 45), 0.8
    found = punch.stage_under(x, reach, PARABOLA.force(reach), PARABOLA.weighed(2.0))
    for one, other in zip(found, punch.stage(x / reach), strict=True):
        assert one == pytest.approx(other, abs=1e-9)


def moved_on(pressed_by=0.6):
    """By how much places that have stuck all along move along x while P grows from a part of it, relative to how far
    they are moved: not at all, if stages of pressing are those of one history."""
    data = {
        "name": "pressed",
        "material": {"upper": {"E": 2e11, "nu": 0.26}, "lower": {"E": 7e10, "nu": 0.04}},
        "friction": {"f": 0.67},
        "profile": {"kind": "flat-rounded", "R": 0.02, "b": 3.4e-4},
        "load": {"P": 1e6},
    }
    last, first = (parse_scene(data | {"load": {"P": P}}) for P in (1e6, pressed_by * 1e6))
    of_last, of_first = (unlike.UnlikeBodies(each, plan(each), None, Clock()) for each in (last, first))
    coarse = of_last.solve(None, (1e-2, 0.2))
    after = of_last.solve(coarse, (1e-3, 0.05))
    cells = after.vertices * last.length
    before = unlike._solve_on(of_first, of_first.path, cells / first.length, None)
    moved = []
    for scene, level in ((first, before), (last, after)):
        forces = (level.pressed.normal.x, level.pressed.tangential.x)
        moved.append(relative(level.vertices, of_last.beta).moved(*forces)[0] * scene.P * scene.material.A)
    stuck = np.abs(cells[1:] + cells[:-1]) / 2 < 0.9 * before.stick.right * first.length
    return np.linalg.norm((moved[1] - moved[0])[stuck]) / np.linalg.norm(moved[1][stuck])


def test_places_that_stick_under_a_flat_with_rounded_corners_move_no_more():
    assert moved_on() < 2.5e-3  # of first order in the cells


@pytest.mark.fault
def test_a_contact_that_grows_as_without_coupling_is_seen(monkeypatch):
    """Deliberate fault: punches get the forces that close the gap of bodies that are not coupled. Both methods had
    it."""
    monkeypatch.setattr(EvenGap, "under", lambda gap, *_: gap)
    assert moved_on() > 5e-3


@pytest.mark.parametrize("f", [1e-6, 0.01])
def test_a_contact_that_hardly_sticks_is_pressed(f):
    """The punch's stick zone is narrower than a cell, and with it that of the contact."""
    found = solved(f"friction.f={f}", "load.Q=[0, 0]")
    assert 0 <= found.m < 1e-2 * found.a
    assert found.m == pytest.approx(found.n, abs=1e-3 * found.a)


def test_where_hardly_anything_slips_growth_is_less_well_known():
    """Ends that slip have a power of their own; where they are narrow, the gap is closed as they let it, and q is known
    to that part of it."""
    known = {f: EvenGap(np.ones(1), np.ones(1)) for f in (0.67, 2.0)}
    for f, gap in known.items():
        punch = PunchGrowth.of(-0.28, f)
        known[f] = gap.under(punch.vertices, punch.normal * np.diff(punch.vertices), 0.28 * f).off
    assert known[0.67] < 2e-4
    assert known[2.0] > 1e-2
    scene = load_scene("hertz-shear", [*SHEARED, "load.Q=[0, 0]", "friction.f=2", "material.nu=0.0"])
    flat = scene.replace(profile={"kind": "flat-rounded", "R": 0.05, "b": 3e-4}, load={"p0": None, "P": scene.P})
    assert partialslip.run(flat, "march")["march"].estimate["q1"] > 1e-2


def middle(f):
    """Pressure of a stage of pressing at x = 0, where the bodies touched first."""
    normal, _ = PunchGrowth.of(-0.114, f).stage(np.array([-1e-3, 1e-3]))
    return (normal[0] - normal[1]) / 2e-3


@pytest.mark.parametrize("f", [0.08, 0.3])
def test_pressure_where_bodies_touched_first_needs_no_finer_punch(f, monkeypatch):
    found = middle(f)
    monkeypatch.setattr(punch_growth, "_MIDDLE", punch_growth._MIDDLE / 10)
    assert found == pytest.approx(middle(f), rel=1e-5)


@pytest.mark.fault
def test_a_punch_that_is_coarse_in_the_middle_is_seen(monkeypatch):
    """With cells that only grow p is off by 2e-4."""
    found = middle(0.3)
    monkeypatch.setattr(punch_growth, "_MIDDLE", 1.0)
    assert abs(middle(0.3) / found - 1) > 1e-4


def test_compliance_of_unlike_half_planes_is_reciprocal():
    C = relative(np.array([-1.0, -0.4, 0.1, 0.2, 1.0]), 0.2)
    assert C.opening == pytest.approx(C.xy.T)
    assert C.xy[0] == pytest.approx([0, 0.1, 0.1, 0.1])  # right of the first cell: pressure there drags it to the right


@pytest.fixture(autouse=True, scope="module")
def coarse():
    """Few meshes: what is tested does not need more."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(driver, "MESHES", driver.MESHES[:5])
        yield


@pytest.fixture(scope="module")
def sheared():
    return solved()


@pytest.mark.slow
def test_finite_elements_agree(sheared):
    scene = load_scene("hertz-shear", [*SHEARED, "fem.accuracy=1e-3"])
    run = partialslip.run(scene, ["march", "fem"])
    assert (run.conclusion.text, run.conclusion.code) == ("no bars", 0)
    errors = {verdict.quantity: verdict.error for verdict in run.comparisons["fem"].verdicts}
    for key, known in {"a": "a", "m": "m", "n": "n", "left_1": "left", "right_2": "right"}.items():
        assert errors[key] < run["fem"].estimate[known] + run["march"].estimate[known], (key, errors)
    assert max(errors[key] for key in ("p", "q")) < 1e-3
    for key in ("a", "m", "n"):
        assert getattr(sheared, key) == pytest.approx(getattr(run["march"], key), abs=1e-2 * sheared.a)


def test_every_step_is_certified(sheared):
    assert max(sheared.certificate.values()) < 1e-10
    x = np.array(sheared.traction.cells)
    p, q = (np.diff(x) @ values for values in (sheared.traction.p, sheared.traction.q2))
    scene = load_scene("hertz-shear", SHEARED)
    assert (p, q) == pytest.approx((scene.P, scene.load.Q[1]), rel=1e-9)


def test_mirror_image(sheared):
    """Q turned round: all is the mirror image, load points as they are."""
    scene = load_scene("hertz-shear", SHEARED)
    turned = solved(f"load.Q={[-Q for Q in scene.load.Q]}")
    assert (turned.a, turned.m, turned.n) == pytest.approx((sheared.a, sheared.n, sheared.m), abs=1e-9 * sheared.a)
    assert turned.traction.q2[::-1] == pytest.approx(-sheared.traction.q2, abs=1e-8 * sheared.p0)
    assert turned.traction.p[::-1] == pytest.approx(sheared.traction.p, abs=1e-8 * sheared.p0)


def test_swap_of_bodies(sheared):
    """Upside down: the bodies are swapped, and what one did to the other along x changes sign."""
    scene = load_scene("hertz-shear", SHEARED)
    E, nu = scene.material.E, scene.material.nu
    swapped = solved(
        "material.E=210e9", "material.nu=0.3", f"material.upper.E={E}", f"material.upper.nu={nu}",
        f"load.Q={[-Q for Q in scene.load.Q]}",
    )  # fmt: skip
    assert (swapped.a, swapped.m, swapped.n) == pytest.approx((sheared.a, sheared.m, sheared.n), abs=1e-9 * sheared.a)
    assert swapped.traction.q2 == pytest.approx(-sheared.traction.q2, abs=1e-8 * sheared.p0)


def test_where_beta_vanishes_the_closed_form_holds():
    nu, other = 0.3, 0.2
    E = 200e9 * (1 + other) / (1 + nu) * (1 - 2 * other) / (1 - 2 * nu)
    materials = ("material.E=200e9", f"material.nu={nu}", f"material.upper.E={E}", f"material.upper.nu={other}")
    scene = load_scene("hertz-shear", [*SHEARED, *materials, "load.Q=[-5e4, 5e4]"])
    assert dundurs(scene) == pytest.approx(0, abs=1e-15)
    found = partialslip.run(scene, "march")["march"]
    a = np.sqrt(2 * scene.material.A * scene.profile.R * scene.P / np.pi)
    stick = a * np.sqrt(1 - scene.load.Q[1] / (scene.friction.f * scene.P))
    assert (found.a, found.m, found.n) == pytest.approx((a, stick, stick), abs=1e-3 * a)


def test_stages_of_pressing_agree_with_pressing_step_by_step(monkeypatch):
    """Self-similar pressing against steps of all of P, which are of first order."""
    scene = load_scene("hertz-shear", [*SHEARED, "load.Q=[0, 0]", "friction.f=0.1", "fem.accuracy=1e-5"])
    at_once = partialslip.run(scene, "march")["march"]
    monkeypatch.setattr(unlike, "PunchGrowth", SimpleNamespace(of=lambda *_: None))
    x, off = np.array([0.3, 0.6, 0.8]) * at_once.a, []
    for most in (8, 32):
        monkeypatch.setattr(coulomb_coupled, "_MOST", most)
        stepped = partialslip.run(scene, "march")["march"]
        off.append(np.abs(stepped.traction.at(x).levels[1] - at_once.traction.at(x).levels[1]).max())
    assert off[1] < 0.02 * np.abs(at_once.traction.q2).max()
    assert off[1] < off[0] / 2


@pytest.mark.fault
def test_coupling_of_the_wrong_sign_is_seen(monkeypatch, sheared):
    """Deliberate fault: pressure drags the surfaces the other way."""
    right = unlike.dundurs
    monkeypatch.setattr(unlike, "dundurs", lambda scene: -right(scene))
    wrong = solved()
    assert np.abs(wrong.traction.q2 - sheared.traction.q2).max() > 1e-2 * sheared.p0


@pytest.mark.slow
def test_ends_of_a_pressed_stick_zone_are_known_no_better_than_those_of_the_contact():
    """The stick zone is the same part of the contact while P increases: its ends share the contact's errors. With this
    friction it is all of the contact."""
    found = solved("friction.f=0.7", "load.Q=[0,0]")
    assert found.m == found.n == pytest.approx(found.a, rel=2 * found.estimate["m"])
    assert found.estimate["a"] > 0
    assert min(found.estimate["m"], found.estimate["n"]) > 0.99 * found.estimate["a"]


def test_a_path_may_be_continued(sheared):
    """Under Q the pressure of unlike bodies is not even, though neither P nor M moves it: the state was refused as that
    of another moment."""
    scene = load_scene("hertz-shear", [*SHEARED])
    again = partialslip.run(scene, "march", start=sheared.state)["march"]
    assert (again.m, again.n) == pytest.approx((sheared.m, sheared.n), abs=2e-3 * sheared.a)
    other = scene.replace(load={"P": scene.P * 1.1, "p0": None})
    with pytest.raises(partialslip.InputError, match="state: is of P"):
        partialslip.run(other, "march", start=sheared.state)


@pytest.mark.slow
def test_nodes_that_open_on_the_way_do_not_ratchet():
    """If tractions repeat, every node that stays in contact slips by the same over a cycle, so that a place which never
    slips forbids it. What a node moves while it is open is no slip: here the contact wanders in the middle of a leg."""
    gripped = {"P": 200e3, "Q": (10e3, 70e3), "sigma": (50e6, 350e6), "steps": 8}
    steel_on_titanium = {"upper": {"E": 205e9, "nu": 0.3}, "lower": {"E": 116e9, "nu": 0.32}}
    scene = plain(gripped, 0.6, steel_on_titanium, {"kind": "hertz", "R": 0.025}, fem={"accuracy": 1e-2})
    assert partialslip.run(scene, "march")["march"].regime == "large tension"


STIFF_ON_ALUMINIUM = {"E": 70e9, "nu": 0.3, "upper": {"E": 2e12, "nu": 0.3}}
STIFF = plain({"P": 1e6}, 0.87, STIFF_ON_ALUMINIUM, {"kind": "hertz", "R": 0.05}, fem={"accuracy": 1e-4})


def closed():
    """Half-width of the contact without any step of pressing: flat punches of all half-widths s below |x|, each under
    the growth of P = K s^2, close the parabolic gap at x by 2 K s g(x/s). So 1/K is proportional to the integral of
    g(v)/v^3 over v > 1, with g = arccosh without friction."""
    punch = PunchGrowth.of(dundurs(STIFF), STIFF.friction.f)
    edges = np.concatenate([-punch.vertices[:0:-1], punch.vertices])
    density = np.concatenate([punch.normal[::-1], punch.normal])

    def potential(at):
        apart = np.abs(at[:, None] - edges)
        sums = np.sign(at[:, None] - edges) * (xlogy(apart, apart) - apart)
        return -np.diff(sums) @ density

    nodes, weights = np.polynomial.legendre.leggauss(200)
    root, weights = (nodes + 1) / 2, weights / 2
    inverse = 1 - root**2
    opened, alone = potential(1 / inverse) - potential(np.ones(1)), np.arccosh(1 / inverse)
    found, hertz = ((opening * inverse * 2 * root) @ weights for opening in (opened, alone))
    return np.sqrt(2 / np.pi * found / hertz) * STIFF.length


@pytest.mark.slow
@pytest.mark.parametrize("method", ["march", "fem"])
def test_half_width_of_pressed_bodies_is_the_one_at_which_the_gap_closes(method):
    """What one step of pressing assumes of the half-width must be what it finds."""
    result = partialslip.run(STIFF, method)[method]
    assert result.a == pytest.approx(closed(), rel=result.estimate["a"] + 3e-5)  # cells of the punch grow by 5 %


@pytest.mark.slow
def test_finite_elements_find_the_stick_zone_of_the_punch_beside_the_end():
    """A slip zone of 2e-3 a: with a half-width that is 2e-3 a off, as it was, both of its ends are wrong."""
    punch = PunchGrowth.of(dundurs(STIFF), STIFF.friction.f)
    result = partialslip.run(STIFF, "fem")["fem"]
    assert 1e-3 < 1 - punch.stick < 3e-3
    assert result.m / result.a == pytest.approx(punch.stick, abs=result.estimate["m"])
    assert result.estimate["m"] < 3e-4


@pytest.mark.slow
@pytest.mark.fault
def test_a_half_width_that_was_only_assumed_is_found_out(monkeypatch):
    """Deliberate fault: the half-width is assumed 2e-3 off. Both methods share that step, and agree."""
    scene = STIFF.replace(fem={"accuracy": 1e-3})
    monkeypatch.setattr(
        coulomb_coupled, "_settled", lambda _, reach, __, press: (press(wide := 1.002 * reach), wide, 0.0, 1)
    )
    wrong = [partialslip.run(scene, method)[method].a for method in ("march", "fem")]
    assert np.abs(np.array(wrong) / closed() - 1).min() > 1e-4


def test_cells_are_small_where_pressed_bodies_touch_first():
    """Beside the vertex q/p is x ln|x|. Cells there were as large as elsewhere if two ends were near to each other, and
    the change from mesh to mesh told a fifth of the error of q1."""
    result = partialslip.run(STIFF.replace(fem={"accuracy": 1e-3}), "march")["march"]
    cells = result.traction.cells
    middle = np.diff(cells)[np.abs(cells[1:] + cells[:-1]) < 2e-2 * result.a]
    assert middle.max() < 0.02 * result.a
    assert np.abs(cells).min() < 1e-12


@pytest.mark.slow
def test_shear_of_pressed_bodies_is_known_as_well_as_is_said():
    loose, fine = (partialslip.run(STIFF.replace(fem={"accuracy": at}), "march")["march"] for at in (2e-4, 2e-5))
    off = norm_errors(loose.traction, fine.traction, STIFF.friction.f, ("q1",))["q1"]
    assert off < loose.estimate["q1"]
