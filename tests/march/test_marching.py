"""Marching against the closed forms, and the first cycles, which only marching resolves."""

import itertools

import numpy as np
import pytest
import reversed_loads
from flats import beside_the_flat
from plain import plain
from varying_scenes import varying

import partialslip
from partialslip.halfplane import contact, one_step_zone
from partialslip.march import changes, driver
from partialslip.tools.allowance import Allowance
from partialslip.tools.bars import BARS
from partialslip.verify.benchmark import read_problems
from partialslip.verify.hard_cases import hard_scene

MEAN = ["load.Q=[31415.926535897932, 219911.48575128554]", "load.sigma=[2e8, 1e9]"]  # 0.1 .. 0.7 fP, 1 .. 5 f p0
ROUGH = "fem.accuracy=1e-3"


def marched(name, *overrides):
    return partialslip.run(partialslip.load_scene(name, overrides), ["march"]).results["march"]


@pytest.mark.parametrize("name", partialslip.shipped_scenes())
def test_shipped_scenes(name):
    outcome = partialslip.run(partialslip.load_scene(name), ["exact", "march"])
    comparison = outcome.comparisons["march"]
    assert outcome.passed
    assert comparison.a == 0
    assert max(comparison.m, comparison.n) <= 2e-5
    assert comparison.q <= 3e-4
    assert max(outcome.results["march"].certificate.values()) < 1e-9


def test_order_of_convergence(monkeypatch):
    """m and n are of first order and better in the cells' size at the ends, q of nearly first."""
    scene, errors = partialslip.load_scene("hertz-large-tension"), []
    for mesh in ((1e-2, 0.2), (2.5e-3, 0.1), (6.25e-4, 0.05)):
        monkeypatch.setattr(driver, "MESHES", (mesh, mesh))
        comparison = partialslip.run(scene, ["exact", "march"]).comparisons["march"]
        errors.append([max(comparison.m, comparison.n), comparison.q])
    orders = -np.polyfit([0, 1, 2], np.log2(errors), 1)[0]
    assert orders[0] > 1.3
    assert orders[1] > 1.0
    assert errors[-1][0] < 1e-4


@pytest.mark.slow
def test_transients_die_out_and_leave_the_steady_range():
    """The change per cycle decreases with the number of cycles, and does not end: what slips last slips ever less."""
    results = {k: marched("hertz-large-tension", ROUGH, *MEAN, f"load.cycles={k}") for k in (1, 3, 6, 12)}
    changes = [result.last_cycle_change for result in results.values()]
    assert changes[0] > 0.2  # on the gradual way
    assert all(after < before / 3 for before, after in itertools.pairwise(changes))
    assert all(("not steady" in " ".join(r.notes)) == (r.last_cycle_change > 1e-3) for r in results.values())
    result = marched("hertz-large-tension", *MEAN)
    assert 12 < result.counts["cycles"] < 100
    assert (result.m / result.a, result.n / result.a) == pytest.approx((0.749058362969, 0.370590356334), abs=2e-5)


@pytest.mark.parametrize(
    ("level", "steady"),
    [(0.5, True), *(pytest.param(*each, marks=pytest.mark.slow) for each in ((0.9, True), (1.1, False)))],
)
def test_steady_below_the_mean_load_bound_ratchets_above(level, steady):
    """The bound is 0.4711 f P for dQ/(2 f P) = 0.3, dsigma/(f p0) = 4."""
    fP = 314159.26535897935
    Q = [(level * 0.471092 + turn * 0.3) * fP for turn in (-1, 1)]
    loads = ROUGH, f"load.Q={Q}", "load.sigma=[-4e8, 4e8]", "load.cycles=30"
    exact, result = partialslip.run(
        partialslip.load_scene("hertz-large-tension", loads), ["exact", "march"]
    ).results.values()
    exact_m, exact_n = 0.749058362969, 0.370590356334
    off = max(abs(result.m / result.a - exact_m), abs(result.n / result.a - exact_n))
    assert (off < 2e-3) == steady
    assert result.last_cycle_change < 1e-4  # ratcheting tractions repeat themselves, too: slip does not
    assert (exact.regime != "ratchets") == steady


@pytest.mark.slow
def test_marching_and_finite_elements_lock_in_the_same():
    """Two discretisations of one history: q at both load points after three cycles of a mean load."""
    overrides = [*MEAN, "load.cycles=3", "fem.accuracy=1e-4"]
    results = partialslip.run(partialslip.load_scene("hertz-large-tension", overrides), ["march", "fem"]).results
    fem, march = results["fem"].traction, results["march"].traction
    scale = 0.5 * results["march"].p0
    inner = np.abs(fem.x) < 0.99 * results["march"].a
    for key in ("q1", "q2"):
        other = np.interp(fem.x[inner], march.x, getattr(march, key))
        off = np.abs(getattr(fem, key)[inner] - other) / scale
        assert np.quantile(off, 0.9) < 0.01  # but for the square roots at the ends of the zones
        assert np.median(off) < 1e-3


def test_scenes_without_friction_to_solve():
    assert marched("hertz-shear", "load.Q=[0, 0]").regime == "stuck"
    assert marched("hertz-shear", "load.Q=[-4e5, 4e5]").regime == "sliding"
    sliding = marched("flat-rounded", "friction.f=0")
    assert sliding.m is None
    assert sliding.counts["load_steps"] == 0


TURNS = [
    (0.3, 1.0, False),
    (0.4, 4.03, False),
    (0.5, 2.8, True),
    pytest.param(0.75, 4.5, True, marks=pytest.mark.slow),
]


@pytest.mark.parametrize(("Qf", "sf", "turns"), TURNS)
def test_slip_that_turns_round_on_a_gradual_way(Qf, sf, turns):
    """Marching and the exact method agree, whether slip turns round or not: then m is another one than that of a single
    step."""
    scenes = [reversed_loads.scene(Qf, sf, "fem.accuracy=1e-4", f"load.steps={k}") for k in (1, 12)]
    one, gradual = (partialslip.run(each, ["exact", "march"]) for each in scenes)
    exact, scene = one.results["exact"], one.scene
    (compared,) = gradual.comparisons.values()
    assert gradual.reference == "exact"
    assert compared.q < 5e-3
    once = one_step_zone(contact(scene), scene.friction.f, scene.load.dQ, scene.load.dsigma)
    assert (abs(once.m - exact.m) > 1e-3 * exact.a) == turns
    if not turns:
        assert gradual.comparisons["march"].passed
        assert gradual.comparisons["march"].q == pytest.approx(one.comparisons["march"].q, rel=1e-5)


@pytest.mark.slow
def test_slip_that_turns_round_as_the_loads_do():
    """Points that finally slip to the right are first pushed to the left: a flat remembers."""
    scenes = [reversed_loads.scene(0.375, 8.25, ROUGH, f"load.steps={k}", name="flat-rounded") for k in (1, 4)]
    found, scene = [partialslip.run(each, "march")["march"] for each in scenes], scenes[0]
    assert all(each.counts["events"] for each in found)
    once = one_step_zone(contact(scene), scene.friction.f, scene.load.dQ, scene.load.dsigma).n
    assert min(abs(each.n - once) / each.a for each in found) > 0.01
    assert found[0].n == pytest.approx(found[1].n, abs=1e-6 * found[0].a)


def test_cells_follow_every_kink_of_q1_and_q2():
    """Mean loads without tension: q2 is the first loading's, whose stick zone ends where dq has no kink."""
    load = {"a": 1e-3, "Q": [181245.73001, 483321.94669], "cycles": 2}
    scene = plain(load, 0.4, (70e9, 0.3), {"kind": "hertz", "R": 0.02}, fem={"accuracy": 1e-4})
    result = partialslip.run(scene, ["march"]).results["march"]
    cells, kink = result.traction.cells / result.a, np.sqrt(0.2)

    def force(x, c):
        t = np.clip(x / c, -1, 1)
        return c**2 / 2 * (t * np.sqrt(1 - t**2) + np.arcsin(t))

    widths = np.diff(cells)
    true = np.diff(force(cells, 1.0) - force(cells, kink)) / widths
    off = result.traction.q2 / (0.4 * result.p0) - true
    error = np.sqrt(off**2 @ widths / (true**2 @ widths))
    assert error < 5e-4
    assert error <= result.estimate["q2"]
    assert np.abs(cells - kink).min() < 1e-3
    assert result.state is not None
    again = partialslip.run(scene, ["march"], start=result.state).results["march"]
    assert np.abs(again.traction.cells / again.a - kink).min() < 1e-3


@pytest.mark.parametrize(("Qf", "sf"), [(0.5, 2.8), pytest.param(0.75, 4.5, marks=pytest.mark.slow)])
def test_legs_are_followed_where_slip_turns_round(Qf, sf):
    """Event by event; one step remains if slip does not turn round. Load steps are stages, and change nothing."""
    scenes = [reversed_loads.scene(Qf, sf, ROUGH, f"load.steps={k}") for k in (1, 16)]
    found, many = (partialslip.run(each, "march")["march"] for each in scenes)
    assert found.counts["events"] > 0
    assert abs(found.m - many.m) < 1e-9 * many.a
    assert abs(found.n - many.n) < 1e-9 * many.a
    assert np.abs(found.traction.dq - many.traction.dq).max() < 1e-9 * found.p0
    assert marched("hertz-large-tension", "fem.accuracy=1e-3").counts["events"] == 0


def ellipse(name, points, *overrides):
    """Shear and tension a quarter of a cycle apart, at this number of load points."""
    scene, t = partialslip.load_scene(name), 2 * np.pi * np.arange(points) / points
    loads = {"Q": scene.load.Q[1] * np.sin(t), "sigma": scene.load.sigma[1] * np.cos(t)}
    return partialslip.load_scene(
        name, [*(f"load.{key}={values.tolist()}" for key, values in loads.items()), *overrides]
    )


@pytest.mark.parametrize("method", ["march", "fem"])
def test_kinks_that_pass_by_cost_little(method):
    """Out of phase slip leaves kinks at all load points. Beside the stick zone neither q1 nor q2 has them: meshes
    hardly follow them, and the ends of the stick zone are right (a march on 2,700 cells knows them to 2e-6 a)."""
    scene = ellipse("fretting-aluminium", 16, "load.cycles=2", "fem.accuracy=1e-4")
    result = partialslip.run(scene, [method]).results[method]
    unknowns, meshes = {"march": (850, 5), "fem": (450, 3)}[method]
    assert result.counts["tangential_unknowns"] <= unknowns
    assert result.counts["meshes"] <= meshes
    known = 2e-6  # of 0.196440 and 0.220387
    assert result.m / result.a == pytest.approx(0.196440, abs=min(result.estimate["m"] + known, 1e-4))
    assert result.n / result.a == pytest.approx(0.220387, abs=min(result.estimate["n"] + known, 1e-4))
    assert max(result.estimate["m"], result.estimate["n"]) <= 1e-4
    assert result.certificate["kkt"] <= 1e-10


NARROW = ((5.5, 2.2), (7.0, 0.7), (4.2, 3.0))  # dQ = (1 - 10^-k) 2 f P, and dsigma in f p0


def largest_ratio(k, tension):
    """Largest error of m and n over its estimate."""
    scene = hard_scene("narrow", 1 - 10.0**-k, tension)
    outcome = partialslip.run(scene, ["exact", "march"])
    estimate, comparison = outcome.results["march"].estimate, outcome.comparisons["march"]
    return max(comparison.m / estimate["m"], comparison.n / estimate["n"])


@pytest.mark.parametrize(
    ("k", "tension"), [NARROW[0], *(pytest.param(*each, marks=pytest.mark.slow) for each in NARROW[1:])]
)
def test_the_place_of_a_narrow_stick_zone_is_known(k, tension):
    """The whole contact carries a narrow zone along: cells near the zone tell nothing of how far."""
    assert largest_ratio(k, tension) <= 1.5


def test_the_estimates_of_small_shear_are_relative_to_one_norm():
    """q is half of q2 - q1, which are opposite without mean loads: their estimates are equal, however small q is."""
    small = partialslip.run(hard_scene("small", 1e-6, 1e-6), ["march"]).results["march"].estimate
    assert small["q"] == pytest.approx(small["q1"], rel=1e-9) == small["q2"]


@pytest.mark.parametrize(("share", "end", "other"), [(0.6, 0.54, 0.669), (0.6, 0.6, 0.711), (0.3, 0.3, 0.7)])
def test_ends_on_the_flat_and_at_its_corner_are_known(monkeypatch, share, end, other):
    """Little room is left beside the end of the stick zone there, so that small errors of the loads move it far."""
    monkeypatch.setattr(driver, "MESHES", driver.MESHES[:7])
    scene = beside_the_flat(share, end, other)
    result = partialslip.run(scene, "march")["march"]
    assert result.m / result.a == pytest.approx(other, abs=result.estimate["m"])
    assert result.n / result.a == pytest.approx(end, abs=result.estimate["n"])


ACCURATE = {
    "constant P": partialslip.load_scene("flat-rounded"),
    "varying P": varying((0.8, 1.0), 1.2, 0.3, accuracy=5e-4),
}


@pytest.mark.parametrize("name", list(ACCURATE))
def test_errors_are_within_estimates_that_are_as_small_as_asked_for(name):
    scene = ACCURATE[name]
    outcome = partialslip.run(scene, ["exact", "march"])
    comparison, result = outcome.comparisons["march"], outcome.results["march"]
    for key in ("m", "n", "q"):
        assert getattr(comparison, key) <= result.estimate[key] <= BARS[key] * scene.fem.accuracy


def test_the_first_estimate_is_made_however_few_seconds_there_are():
    """Under a budget the stick zone out of phase was once that of two coarse meshes, without an estimate."""
    scene = partialslip.load_scene("fretting-aluminium", ["load.Q=[0, 3e4, 0, -3e4]", "load.sigma=[1e8, 0, -1e8, 0]"])
    hurried = partialslip.run(scene, "march", allowance=Allowance(0.0))["march"]
    assert hurried.counts["meshes"] == 4
    true = partialslip.run(scene.replace(fem={"accuracy": 1e-4}), "march")["march"]
    for key in ("m", "n"):
        off = abs(getattr(hurried, key) - getattr(true, key)) / true.a
        assert 0 < hurried.estimate[key] < 1e-2
        assert off < 2 * (hurried.estimate[key] + true.estimate[key])


def test_load_points_that_repeat_change_nothing():
    """A leg on which nothing moves has rates without a tolerance: 0/0 once ended the search for slipping nodes."""
    angles = np.arange(8) * np.pi / 4
    P, Q = 135750.0 * (1 + 0.2 * np.sin(angles)), 3e4 * np.sin(angles)
    sigma = 1e8 * np.cos(angles)
    found = []
    for times in (1, 2):
        load = {"P": P.repeat(times).tolist(), "Q": Q.repeat(times).tolist(), "sigma": sigma.repeat(times).tolist()}
        scene = partialslip.load_scene("fretting-aluminium").replace(load=load | {"cycles": 2}, fem={"accuracy": 2e-2})
        found.append(partialslip.run(scene, "march")["march"])
    once, twice = found
    assert (twice.m, twice.n) == pytest.approx((once.m, once.n), abs=1e-5 * once.a)


@pytest.mark.fault
def test_meshes_that_miss_a_narrow_zone_do_not_agree(monkeypatch):
    """PS-07, a stick zone of 1e-4 a. Without what its cells cannot see, meshes agree on a zone that is none."""
    scene = read_problems()["PS-07"].scene.replace({"fem.accuracy": 1e-3})
    exact = partialslip.run(scene, ["exact"])["exact"]

    def beyond():
        found = partialslip.run(scene, ["march"])["march"]
        return max(abs(found.m - exact.m), abs(found.n - exact.n)) / found.a / max(found.estimate["m"], 1e-9)

    assert beyond() < 1
    monkeypatch.setattr(changes, "unseen", lambda *_: 0.0)
    assert beyond() > 100
