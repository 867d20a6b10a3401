"""Marching under varying P and M, against the closed form and against itself in finer steps."""

import math

import numpy as np
import pytest
from plain import plain
from varying_scenes import varying

from partialslip import run
from partialslip.friction import coulomb_varying_pressure as stepping
from partialslip.friction.load_path import Path, scaled_pressing, stretched
from partialslip.friction.normal import Presses, press
from partialslip.march.cells import compliance, graded_cells
from partialslip.march.pressing import NormalLoads
from partialslip.run.judge.verdicts import Outcome

A1, A2 = 0.8, 1.0
P1, P2 = (math.pi * a**2 / 2 for a in (A1, A2))
VERTICES = np.unique(
    np.concatenate(
        [graded_cells(np.array([-A2, -A1, A1, A2]), 4e-3, 0.1), *(way * np.linspace(A1, A2, 41) for way in (1, -1))]
    )
)
X, WIDTHS = (VERTICES[1:] + VERTICES[:-1]) / 2, np.diff(VERTICES)
COMPLIANCE = compliance(VERTICES / 2)
PRESSES = Presses(COMPLIANCE, np.diff(VERTICES**3) / 6 / WIDTHS, X)


def history(dQ, dsigma, steps, f=1.0, mean=0.0, cycles=2, moments=(0.0, 0.0)):
    cycle = tuple(
        (mean + way * dQ / 2, way * dsigma / 8, 0.0, P, M) for way, P, M in ((-1, P1, moments[0]), (1, P2, moments[1]))
    )
    begin = (0.0, 0.0, 0.0, *cycle[1][3:])
    return stepping.march(X, COMPLIANCE, stretched(X, 0.0), f, PRESSES, Path(cycle, (0, 1), True, cycles, steps, begin))


def norm(forces):
    return float(np.sqrt((forces**2 / WIDTHS).sum()))


def exact_forces(a):
    z = np.clip(VERTICES / a, -1, 1)
    return np.diff(a**2 / 2 * (z * np.sqrt(1 - z**2) + np.arcsin(z)))


def test_shear_in_proportion_to_pressure_needs_one_step():
    """q = dQ/dP (p2 - p1) where no end slips: in any number of steps, to rounding."""
    ratio = 1 / 3
    pressed = PRESSES(P2, 0.0).x - PRESSES(P1, 0.0).x
    for steps in (1, 3, 8):
        found = history(ratio * (P2 - P1), 0.0, steps, f=0.5)
        assert norm(found.change - ratio * pressed) < 1e-10 * norm(pressed)
        assert found.slipped.max() < 1e-9


@pytest.mark.parametrize("e", [(0.0, 0.0), (0.05, -0.1)])
def test_half_planes_know_which_cells_touch(e):
    """The closed form tells where pressing begins: a solve or two, as the cells' angle differs a little, lead to the
    forces that are found from nothing in more."""
    scene = varying((A1, A2), 0.5, 0.3, e)
    normal = NormalLoads.of(scene)
    vertices = graded_cells(np.array([-1.0, 1.0]), 1e-3, 0.1)
    C, (loads, others) = compliance(vertices / 2), scaled_pressing(scene)
    presses = normal.presses(vertices, C)
    for P, M in (loads, others, np.add(loads, others) / 2):
        if (P, M) == (1.0, 0.0):  # all cells touch
            continue
        found, alone = presses(P, M), press(C, presses._problem[1], P, presses._arms, M)
        assert found.iterations <= 3 < alone.iterations
        assert np.abs(found.x - alone.x).max() < 1e-12


TENSION = 0.15 * (P2 - P1), 0.1


@pytest.fixture(scope="module")
def limit():
    """Change of shear where each cell touches in a step of its own."""
    return history(*TENSION, 128, f=0.5, cycles=1).change


def errors_in_steps(numbers, limit):
    found = [history(*TENSION, steps, f=0.5, cycles=1).change for steps in numbers]
    return [norm(each - limit) / norm(limit) for each in found]


def test_steps_converge_faster_than_first_order(limit):
    """Against the limit on the same cells, which is as near the closed form as the cells are small."""
    one, two, four = errors_in_steps((1, 2, 4), limit)
    assert one < 5e-3
    assert math.log2(one / two) > 1.8
    assert four < two
    dQ, dsigma = TENSION
    true = (dQ + np.pi / 4 * X * dsigma) / (P2 - P1) * (exact_forces(A2) - exact_forces(A1))
    assert norm(limit - true) < 5e-3 * norm(true)


@pytest.mark.fault
def test_slip_that_counts_from_the_start_of_a_step_is_seen(monkeypatch, limit):
    touching = stepping._Step._touching
    monkeypatch.setattr(stepping._Step, "_touching", lambda *args: tuple(each[:0] for each in touching(*args)))
    one, two = errors_in_steps((1, 2), limit)
    assert one > 5e-2
    assert math.log2(one / two) < 1


def test_an_end_that_slips_during_part_of_the_cycle():
    coarse, fine = (history(0.1 * math.pi, 0.35, steps, mean=-0.1, cycles=3) for steps in (2, 16))
    assert norm(coarse.change - fine.change) < 1e-3 * norm(fine.change)
    beyond = (X > A1) & (fine.slipped.max(axis=0) > 1e-6)
    assert beyond.any()
    assert fine.slipped[:, X < 0].max() < 1e-9


def test_dissipated_energy_is_the_work_of_the_loads():
    """In a steady cycle the work of Q and of the tension is dissipated; both integrals are of second order."""
    off = []
    for steps in (8, 16):
        found = []
        solve = stepping._Step.solve

        def spied(self, *args, found=found, solve=solve):
            solution = solve(self, *args)
            found.append(solution)
            return solution

        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(stepping._Step, "solve", spied)
            cycle = history(0.32 * math.pi, 0.4, steps, mean=0.1)
        q = np.array([each.x for each in found[-2 * steps - 1 :]])
        way = np.linspace(0, 1, steps + 1)[1:]
        strain = np.concatenate([[0.05], 0.05 - 0.1 * way, -0.05 + 0.1 * way])
        middle = int(np.argmin(np.abs(X - 0.05)))  # sticks
        shift = q @ COMPLIANCE[middle] - strain * X[middle]
        Q, moment = q.sum(axis=1), q @ X
        work = ((Q[1:] + Q[:-1]) / 2 * np.diff(shift) + (moment[1:] + moment[:-1]) / 2 * np.diff(strain)).sum()
        off.append(abs(cycle.dissipated - work) / work)
    assert off[1] < off[0] < 0.02


@pytest.mark.parametrize(
    ("scene", "slips"),
    [
        (varying((0.8, 1), 0.32 * math.pi, 0.4, mean=-0.1, cycles=3), ("forwards", "forwards")),
        pytest.param(
            varying((math.sqrt(0.6), math.sqrt(0.8)), 0.2 * math.pi, 4, (0.05, -0.075), mean=-0.1, cycles=4),
            ("backwards", "forwards"),
            marks=pytest.mark.slow,
        ),
        (varying((math.sqrt(0.6), math.sqrt(0.9)), 0.1 * math.pi, 0.1, cycles=3), ("never", "never")),
    ],
    ids=["small", "large", "no slip"],
)
def test_march_agrees_with_the_closed_form(scene, slips):
    result = run(scene, ["exact", "march"])
    assert result.passed
    assert result["march"].end_slips == result["exact"].end_slips == slips
    assert np.array(result["march"].ends) == pytest.approx(np.array(result["exact"].ends))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("bound", "inwards", "how"),
    [("Q_mean_most", -0.01, {"cycles": 200}), ("Q_mean_least", 0.008, {"cycles": 400, "steps": 16})],
)
def test_march_ratchets_where_the_bound_says_so(bound, inwards, how):
    """The mean of Q within and beyond the bounds of the closed form, by so many f P, under a varying moment. 0.008 f P
    beyond the lower one both load points alone would allow a steady state: in steps it is the way that tells."""
    a, e, P = (0.9, 0.9), (0.1, -0.1), math.pi * 0.9**2 / 2
    limit = run(varying(a, 0.7, 8.0, e), ["exact"])["exact"].limits[bound]
    scenes = [varying(a, 0.7, 8.0, e, mean=limit + way * inwards * P, **how) for way in (1, -1)]
    assert [run(scene, ["march"])["march"].regime for scene in scenes] == ["large tension", "ratchets"]


@pytest.mark.slow
def test_regimes_at_the_bound_on_the_mean_are_not_judged():
    """The net slip of a cycle vanishes as the mean approaches the bound: 0.004 f P beyond it march with 1e-2 sees
    none, 0.012 f P beyond it does, in the steps that it chooses."""
    varies = varying((0.9, 0.9), 1.2, 8.0, mean=0.19, cycles=20)
    scene = varies.replace(load={"P": varies.P})
    loads = [{"Q": [mean - 0.6, mean + 0.6]} for mean in (0.19, 0.2)]
    near, beyond = (run(scene.replace(load=load), ["exact", "march"]) for load in loads)
    assert (near["exact"].regime, near["march"].regime) == ("ratchets", "large tension")
    assert (near.outcome, near.conclusion.unjudged) == (Outcome.NOT_JUDGED, ("regime", "m", "n", "q"))
    judged = {verdict.quantity: verdict for verdict in near.comparisons["march"].verdicts}
    assert judged["regime"].outcome == Outcome.NOT_JUDGED
    assert "too little to tell ratcheting" in judged["regime"].reason
    assert (beyond["exact"].regime, beyond["march"].regime) == ("ratchets", "ratchets")


def test_counts_of_constant_pressure_do_not_change():
    scene = varying((1, 1), 0.3, 0.2, mean=0.1, cycles=3)
    number = scene.replace(load={"P": scene.P})
    one, other = (run(each, ["march"])["march"] for each in (scene, number))
    assert dict(one.counts) == dict(other.counts)
    assert (one.traction.dq == other.traction.dq).all()


@pytest.mark.slow
def test_slip_that_begins_in_the_wrong_direction_is_known():
    """The adhered traction of the whole contact changes its sign inside the right slip zone: points there first slip on
    in the direction of the way before. exact and march say so; tractions, and m and n with them, end as in one step."""
    load = {"P": [1.0, 0.517], "e": -0.109, "Q": [0.1506, -0.1506], "sigma": [1.9515, -1.9515], "steps": 4}
    flat = {"kind": "flat-rounded", "R": 1.0, "b": 0.6077}
    scene = plain(load | {"cycles": 10}, 1.0, (4.0, 0.0), flat, fem={"accuracy": 5e-4})
    found = run(scene, ["exact", "march"])
    exact, march = found["exact"], found["march"]
    assert exact.path_dependent
    assert any(note.startswith("path-dependent: slip reverses between the load points") for note in march.notes)
    assert exact.m == pytest.approx(march.m, abs=march.estimate["m"] * exact.a)
    assert exact.n == pytest.approx(march.n, abs=march.estimate["n"] * exact.a)
