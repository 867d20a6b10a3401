"""Only effects that a scene calls for are built, as counted work shows; effects left out would not change the result;
and missing effects are reported."""

import functools
import json
from dataclasses import replace

import numpy as np
import pytest

import partialslip
from partialslip import InputError, load_scene, plan
from partialslip.cli import main
from partialslip.friction.coulomb_constant_pressure import march as follow_path
from partialslip.friction.load_path import Path, stretched
from partialslip.march import method as marching
from partialslip.scene.plan import reduced
from partialslip_fem import bodies, condensation, solving
from partialslip_fem import method as fem_method

SIZE = "fem.size=0.1"
BLOCKS = ("bodies.lower.width=30e-3", "bodies.lower.height=10e-3", "bodies.upper.width=20e-3",
          "bodies.upper.height=20e-3")  # fmt: skip
STIFF = ("material.upper.E=400e9", "material.upper.nu=0.25")
MEAN = ("load.Q=[-5e4, 1.5e5]", "load.cycles=3")
SMALLER = "load.Q=[-1e5, 1e5]"  # of the stiffer pair, which p0 = 400 MPa presses with less
LARGE = "load.sigma=[-1e9, 1e9]"
EQUAL = ("bodies.lower.width=30e-3", "bodies.lower.height=10e-3", "bodies.upper.width=30e-3",
         "bodies.upper.height=10e-3")  # fmt: skip

# From frictionless Hertz to two different finite bodies with mean loads and stresses inside.
SIX = {
    "frictionless": (("friction.f=0", "load.Q=[0, 0]"), False), "shear": ((), False),
    "large tension": ((LARGE,), False), "mean loads, small tension": ((*MEAN, "load.sigma=[0, 1e8]"), False),
    "unlike half-planes": ((*STIFF, SMALLER), False), "everything": ((*STIFF, *BLOCKS, *MEAN, LARGE), True),
}  # fmt: skip

# Counted work of an effect: zero if the effect is left out.
WORK = {
    "friction": lambda counts: counts["tangential_unknowns"] + counts["load_steps"] + counts["friction_iterations"],
    "opposing-slip": lambda counts: counts["opposing_nodes"], "history": lambda counts: counts["cycles"],
    "coupling": lambda counts: counts["bodies"] - 1 + counts["normal_solves"] - 1,
    "far-field": lambda counts: counts["far_field_columns"], "subsurface": lambda counts: counts["back_solves"],
}  # fmt: skip


def solved_fem(*overrides, subsurface=False):
    """Result of finite elements, with the forced effects of the scene."""
    scene = load_scene("hertz-shear", [SIZE, *overrides])
    return fem_method.solve(reduced(scene), plan(scene, subsurface=subsurface))


fem = functools.cache(solved_fem)


def march(*overrides, name="hertz-shear"):
    scene = load_scene(name, ["fem.accuracy=1e-2", *overrides])
    return marching.solve(reduced(scene), plan(scene))


def assert_same(result, other, off=1e-10):
    """a, m and n in a, p in p0 and q in the larger bound."""
    assert (other.a, other.m, other.n) == pytest.approx((result.a, result.m, result.n), abs=off * result.a)
    for key in ("p", "q1", "q2"):
        mine, its = getattr(result.traction, key), getattr(other.traction, key)
        assert its == pytest.approx(mine, abs=10 * off * result.p0), key


@pytest.fixture
def spied(monkeypatch):
    """Count the calls of costly functions."""
    calls = dict.fromkeys(("factor", "half_plane", "press", "march", "coupled", "displace"), 0)

    def spy(owner, name, key):
        true = getattr(owner, name)

        def counted(*args, **kwargs):
            calls[key] += 1
            return true(*args, **kwargs)

        monkeypatch.setattr(owner, name, counted)

    spy(condensation, "factor", "factor")
    for name in ("half_plane", "press"):
        spy(bodies, name, name)
    for owner, key in ((solving.coulomb_constant_pressure, "march"), (solving.coulomb_coupled, "coupled")):
        spy(owner, "march", key)
    spy(condensation.Condensation, "displace", "displace")
    return calls


@pytest.mark.parametrize("name", SIX)
def test_left_out_effects_count_zero(name, spied):
    overrides, subsurface = SIX[name]
    scene = load_scene("hertz-shear", [SIZE, *overrides])
    effects, counts = plan(scene, subsurface=subsurface), solved_fem(*overrides, subsurface=subsurface).counts
    for effect, work in WORK.items():
        if not effects.needs(effect):
            assert work(counts) == 0, effect
        elif effect != "opposing-slip":  # it may come to nothing
            assert work(counts) > 0, effect
    bodies, meshes, friction = counts["bodies"], counts["meshes"], effects.needs("friction")
    assert counts["columns"] % (bodies * (2 if friction else 1)) == 0
    if bodies == 1:
        assert counts["columns"] == counts["normal_unknowns"] * (2 if friction else 1)
    assert spied == {
        "factor": bodies * meshes,
        "half_plane": bodies * meshes if effects.needs("far-field") else 0,
        "press": 0 if effects.needs("coupling") else meshes,
        "march": 1 if friction and not effects.needs("coupling") else 0,  # the first mesh only finds the contact
        "coupled": meshes + 1 if effects.needs("coupling") else 0,  # the load steps are compared with others once
        "displace": 2 if subsurface else 0,
    }


def test_work_of_the_cheapest_and_the_fullest():
    cheap, full = (fem(*overrides, subsurface=inside).counts for overrides, inside in (SIX["shear"], SIX["everything"]))
    assert (cheap["cycles"], cheap["load_steps"], cheap["normal_solves"]) == (0, 1, 1)
    assert full["load_steps"] >= 1 + 2 * full["cycles"] >= 3  # more if slip reverses
    assert full["normal_solves"] == full["load_steps"] + full["pressing_steps"]
    assert fem(LARGE).counts["opposing_nodes"] > 0
    assert full["factorizations"] - 2 * full["meshes"] in (0, 2)  # CHOLMOD's are taken apart, and made again
    assert cheap["factorizations"] == cheap["meshes"]


def test_shear_columns_that_nobody_needs_are_noticed(monkeypatch):
    """Deliberate fault."""
    true = bodies.Condensation
    monkeypatch.setattr(bodies, "Condensation", lambda *args: true(*args[:3]))
    counts = solved_fem(*SIX["frictionless"][0]).counts
    assert counts["columns"] == 2 * counts["normal_unknowns"]


LESS = "load.sigma=[-6e8, 6e8]"  # dsigma = 6 f p0, at which slip does not reverse
HALF = {"shear": (), "large tension": ("load.Q=[-5e4, 5e4]", LESS), "cycles": ("load.cycles=7",), "equal blocks": EQUAL,
        "tension alone": ("load.Q=[0, 0]", LESS)}  # fmt: skip


@pytest.mark.parametrize(
    ("method", "which"),
    [(fem, which) for which in HALF] + [(march, which) for which in HALF if which != "equal blocks"],
)
def test_half_a_cycle_tells_the_whole(method, which):
    half, whole = method(*HALF[which]), method(*HALF[which], "effects.history=true")
    assert (half.counts["load_steps"], whole.counts["load_steps"]) == (1, 3)
    assert_same(half, whole)
    assert half.slip.slip == pytest.approx(whole.slip.slip, abs=1e-9 * np.abs(whole.slip.slip).max())
    assert half.slip.dissipated == pytest.approx(whole.slip.dissipated, rel=1e-9)


@pytest.mark.slow
def test_half_a_cycle_tells_the_whole_of_any_body():
    """Masing's rule of one step needs nothing of the bodies but a symmetric positive definite compliance, and slip that
    does not turn round."""
    rng, compared = np.random.default_rng(6), 0
    for _ in range(100):
        n = int(rng.integers(3, 25))
        root, x = rng.normal(size=(n, n)), np.sort(rng.uniform(-1, 1, n))
        C, bound = root @ root.T + 0.1 * np.eye(n), rng.uniform(0.01, 1, n)
        Q, strain = rng.uniform(-1, 1) * bound.sum(), 10.0 ** rng.uniform(-2, 2) * rng.normal()
        whole = Path(((-Q, -strain, 0.0), (Q, strain, 0.0)), (0, 1), True, 1, 1)
        paths = replace(whole, half=True), whole
        one, other = (follow_path(C, stretched(x, 0.0), bound, 1.0, path) for path in paths)
        if other.turns:
            continue
        compared += 1
        assert one.q1 == pytest.approx(other.q1, abs=1e-9)
        assert one.q2 == pytest.approx(other.q2, abs=1e-9)
        assert one.slip == pytest.approx(other.slip, abs=1e-9 * max(np.abs(other.slip).max(), 1))
        assert one.dissipated == pytest.approx(other.dissipated, rel=1e-8, abs=1e-9)
    assert compared > 20


def test_half_a_cycle_of_mean_loads_is_another_answer():
    """Deliberate fault, but for the change of q, which is that of the steady state."""
    half, whole = fem(*MEAN, "effects.history=false"), fem(*MEAN)
    assert half.traction.dq == pytest.approx(whole.traction.dq, abs=1e-6 * whole.p0)
    assert np.abs(half.traction.q2 - whole.traction.q2).max() > 0.05 * whole.p0


def test_a_gradual_way_is_followed():
    """Slip reverses on the path: Masing's rule would be wrong."""
    assert march("load.Q=[-172787.6, 172787.6]", "load.sigma=[-7e8, 7e8]").counts["events"] > 0


@pytest.mark.parametrize("load", [(), ("load.Q=[-5e4, 5e4]", LESS)])
def test_mirror_images_as_two_coupled_bodies(load):
    """Without reversal of slip: the steps of coupled bodies are not refined, and a note says so."""
    one, two = fem(*load), fem(*load, "effects.coupling=true")
    assert (one.counts["bodies"], two.counts["bodies"]) == (1, 2)
    assert two.counts["normal_solves"] == two.counts["pressing_steps"] + two.counts["load_steps"]
    assert_same(one, two)


def test_mirror_images_meshed_differently_are_alike_to_their_errors():
    """Nodes of two meshes do not match: the result differs from that of one body by the discretisation error, 2e-3 a at
    this size (orders of convergence are in tests/fem)."""
    one, two = fem(), fem("fem.lower_size=0.8", "effects.coupling=true")
    assert (two.a, two.m, two.n) == pytest.approx((one.a, one.m, one.n), abs=4e-3 * one.a)


def test_no_friction_without_a_load_along_x():
    none, solved = fem("load.Q=[0, 0]"), fem("load.Q=[0, 0]", "effects.friction=true")
    assert (none.counts["tangential_unknowns"], solved.counts["load_steps"]) == (0, 1)
    assert solved.traction.q2 is not None
    assert not solved.traction.q2.any()
    assert_same(none, solved)


def test_what_slides_is_not_iterated():
    for result in (fem("friction.f=0.01"), march("friction.f=0.01")):
        assert result.regime == "sliding"
        assert result.counts["friction_iterations"] == result.counts["load_steps"] == 0
    assert fem("friction.f=0.01").counts["columns"] == fem("friction.f=0").counts["columns"]


def test_what_sticks_as_a_whole_is_one_linear_solve():
    """The slip zones are far smaller than an element: no node slips."""
    stuck = fem("friction.f=1000", "load.Q=[-1, 1]")
    assert stuck.counts["friction_iterations"] == 0
    assert stuck.counts["load_steps"] == 1


def test_stresses_inside_change_nothing_on_the_surface():
    without, with_them = fem(), fem(subsurface=True)
    assert_same(without, with_them, 1e-14)
    assert with_them.counts["back_solves"] == 2
    assert not without.bodies


def test_frictionless_bodies_have_stresses_inside():
    """Without shear columns: the same result as with friction but without tangential loads."""
    without, with_it = fem("load.Q=[0, 0]", subsurface=True), fem("load.Q=[0, 0]", "effects.friction=true",
                                                                 subsurface=True)  # fmt: skip
    for body, other in zip(without.bodies, with_it.bodies, strict=True):
        assert other.stresses["stress_2"] == pytest.approx(body.stresses["stress_2"], abs=1e-9 * without.p0)


def test_finite_bodies_have_no_far_field_and_large_ones_need_none():
    """For a block of 200 contact half-widths the size changes the result by (1/200)^2, and so does the far field, on
    one mesh. Blocks and half-planes have different meshes and differ by the discretisation error, 1e-3 a."""
    size = ("bodies.lower.width=0.4", "bodies.lower.height=0.2", "bodies.upper.width=0.4", "bodies.upper.height=0.2")
    block, plane = fem(*size), fem(*size, "effects.finite-size=false")
    assert (block.counts["far_field_columns"], plane.counts["far_field_columns"] > 0) == (0, True)
    assert (block.a, block.m, block.n) == pytest.approx((plane.a, plane.m, plane.n), abs=1e-3 * plane.a)
    far, box = fem("fem.width=200"), fem("fem.width=200", "effects.far-field=false")
    assert (box.a, box.m, box.n) == pytest.approx((far.a, far.m, far.n), abs=1e-4 * far.a)
    near = fem("effects.far-field=false")
    assert abs(near.a - far.a) > 1e-3 * far.a


@pytest.mark.parametrize("Qf", [0.1, 0.5, 0.9])
def test_opposing_slip_is_left_out_where_tension_is_small(Qf):
    """Gradual loading up to the beginning of the reversal of slip, with any steps."""
    scene = load_scene("hertz-shear")
    f, P, Q = scene.friction.f, scene.P, Qf * scene.friction.f * scene.P
    p0 = partialslip.run(scene, ["exact"]).results["exact"].p0
    for count in (1, 2):
        for share, needed in ((0.999, False), (1.001, True)):
            sigma = share * 4 * Qf * f * p0 / 2
            settings = [f"load.Q=[{-Q}, {Q}]", f"load.sigma=[{-sigma}, {sigma}]", f"load.steps={count}"]
            assert plan(load_scene("hertz-shear", settings)).needs("opposing-slip") == needed
    assert P > 0


def test_what_is_called_for_may_be_forced_on():
    """Shear that makes the contact slide is called for, though friction is not."""
    scene = load_scene("hertz-shear", ["friction.f=0.01", "effects.shear=true", "effects.normal=true"])
    assert partialslip.run(scene, ["exact"]).results["exact"].regime == "sliding"


def test_fields_that_are_asked_for_are_not_left_out():
    with pytest.raises(InputError, match=r"effects\.subsurface = false: .* were asked for"):
        partialslip.run(load_scene("hertz-shear", ["effects.subsurface=false"]), subsurface=True)


def test_an_effect_that_matters_is_measured(tmp_path, capsys):
    """Left out by force: the error is that against the whole scene, and no bar says it is fine."""
    arguments = ["fretting-aluminium", "--set", SIZE, "--set", "effects.tension=false", "--out", str(tmp_path)]
    assert main(["run", *arguments]) == 0
    printed = capsys.readouterr().out
    assert "forced off, though sigma goes between" in " ".join(printed.split())
    assert "no bars: forced off: tension" in printed
    assert "all bars met" not in printed
    data = json.loads((tmp_path / "results.json").read_text("utf-8"))
    whole, without = (partialslip.run(load_scene("fretting-aluminium", change), ["exact"]).results["exact"]
                      for change in ([], ["load.sigma=[0, 0]"]))  # fmt: skip
    assert data["plan"]["missing"] == ["tension"]
    assert data["comparison"]["exact"]["errors"]["m"] == pytest.approx(abs(whole.m - without.m) / whole.a, rel=1e-12)
    assert data["comparison"]["fem"]["errors"]["m"] == pytest.approx(abs(whole.m - without.m) / whole.a, rel=0.05)
    assert data["methods"]["all effects"]["m"] == whole.m


def test_finite_size_is_measured_by_finite_bodies():
    scene = load_scene("hertz-shear", [SIZE, *EQUAL, "effects.finite-size=false"])
    outcome = partialslip.run(scene, ["fem"])
    assert outcome.reference == "all effects"
    assert outcome.results["all effects"].a == fem(*EQUAL).a
    assert outcome.comparisons["fem"].a > 1e-3


def test_coupling_left_out_is_the_uncoupled_solution():
    """Goodman's approximation: its error, and the normal contact is solved once."""
    unlike, without = fem(*STIFF, SMALLER), fem(*STIFF, SMALLER, "effects.coupling=false")
    assert without.counts["normal_solves"] == 1
    assert without.counts["bodies"] == 2
    assert 1e-4 < abs(without.a - unlike.a) / unlike.a < 0.1
    assert without.traction.q1 == pytest.approx(-without.traction.q2, abs=1e-12 * unlike.p0)


@pytest.mark.slow
def test_ledger_of_effects(tmp_path, capsys):
    assert main(["study", "effects", "fretting-aluminium", "--set", "fem.size=0.2", "--out", str(tmp_path)]) == 0
    printed = capsys.readouterr().out
    assert "<h2>Changes by each effect</h2>" in (tmp_path / "report.html").read_text("utf-8")
    data = json.loads((tmp_path / "effects.json").read_text("utf-8"))
    entries = {entry["effect"]: entry for entry in data["effects"]}
    exact = partialslip.run(load_scene("fretting-aluminium"), ["exact"]).results["exact"]
    without = partialslip.run(load_scene("fretting-aluminium", ["load.sigma=[0, 0]"]), ["exact"]).results["exact"]
    assert entries["tension"]["changes"]["m"] == pytest.approx(abs(exact.m - without.m) / exact.a, rel=0.1)
    assert entries["friction"]["changes"]["q"] == pytest.approx(1, rel=1e-12)  # relative to q, not to p
    for effect in ("history", "coupling", "subsurface"):
        assert max(entries[effect]["changes"].values()) < 1e-10
    assert entries["normal"]["refused"]
    assert entries["coupling"]["costs"]["factorizations"] == [4, 2]
    assert entries["history"]["costs"]["load_steps"] == [3, 1]
    assert "with coupling" in printed
    assert (tmp_path / "effects.csv").read_text("utf-8").count("\n") == len(entries) + 1
    assert "fretting-aluminium" in (tmp_path / "effects.svg").read_text("utf-8")
