"""Intervals against formulas of their own, and what must hold of them."""

import dataclasses
import itertools
import json
import math

import numpy as np
import pytest

import partialslip
from partialslip import load_scene
from partialslip.cli import main
from partialslip.report import record
from partialslip.report.tolerance import allowed_lines, tolerance_lines, tolerance_rows
from partialslip.run import compared, run
from partialslip.scene.tolerance import inputs
from partialslip.scene.units import SI
from partialslip.study.tolerance import propagate, surface, with_tolerance
from partialslip.study.tolerance import propagation as module
from partialslip.study.tolerance.surface import draws, interpolated, quadratic, shares, star

NAME, ENDS = "fretting-aluminium", (0.025, 0.975)
PAPER = ['tolerance.friction.f="5 %"', 'tolerance.load.P="1 %"', 'tolerance.profile.R="0.5 %"']


def closed(f, P, R, Q=38750.0, sigma=100e6, E=72.1e9, nu=0.33):
    """a, m/a, n/a and p0 by Hertz, Cattaneo and Mindlin, and the shift by bulk tension (Hills, Nowell)."""
    a = np.sqrt(8 * (1 - nu**2) / E * R * P / np.pi)
    p0 = 2 * P / (np.pi * a)
    c = np.sqrt(np.where(f * P > Q, 1 - Q / (f * P), np.nan))
    e = sigma / (4 * f * p0)
    return {"a": a, "m": c + e, "n": c - e, "p0": p0}


def drawn(f, P, R, count=40_000):
    u = np.random.default_rng(7).uniform(-1, 1, (3, count))
    return closed(0.3 * (1 + f * u[0]), 135750.0 * (1 + P * u[1]), 0.01 * (1 + R * u[2]))


def off(found, values):
    """Largest error of the ends of each interval, in its width, by independent draws."""
    errors = {}
    for key, each in values.items():
        low, high = np.nanquantile(each, ENDS)
        own = found.quantities[key]
        errors[key] = max(abs(own.low - low), abs(own.high - high)) / (high - low)
    return errors


@pytest.fixture(scope="module")
def near_sliding():
    return propagate(load_scene(NAME, PAPER))[0]


def test_near_sliding_against_closed_formulas(near_sliding):
    """f to 5 % at Q/(f P) = 0.95: c = a sqrt(1 - Q/(f P)) has no linear interval, and some cases slide."""
    values = drawn(0.05, 0.01, 0.005)
    assert max(off(near_sliding, values).values()) < 0.02
    assert near_sliding.draws > 0
    assert near_sliding.regimes["sliding"] == pytest.approx(np.isnan(values["m"]).mean(), abs=0.004)
    (slides,) = near_sliding.changes
    assert (slides.regime, slides.key) == ("sliding", "friction.f")
    assert slides.value == pytest.approx(38750.0 / 135750.0, rel=1e-12)


def test_shares_against_frozen_inputs(near_sliding):
    """1 - Var(y | f frozen)/Var(y) is the share of f where inputs do not act together, as of a and p0."""
    for key in ("a", "p0"):
        whole = drawn(0.0, 0.01, 0.005)[key].var()
        by_P = 1 - drawn(0.0, 0.0, 0.005)[key].var() / whole
        assert near_sliding.quantities[key].shares["load.P"] == pytest.approx(by_P, abs=0.01)
        assert near_sliding.quantities[key].shares["friction.f"] == pytest.approx(0, abs=1e-6)
    assert near_sliding.quantities["m"].shares["friction.f"] > 0.9


def test_small_tolerances_are_linear_and_few_are_solved():
    found, known = propagate(load_scene(NAME, [*PAPER[1:], 'tolerance.friction.f="0.2 %"', "load.Q=[-30e3,30e3]"]))
    assert (found.draws, found.regimes) == (0, {"small tension": 1.0})
    assert found.solves == len(known.t) <= 15
    P, f = 135750.0, 0.3
    slope = {"load.P": 0.01 * 30e3 / (f * P), "friction.f": 0.002 * 30e3 / (f * P)}  # of 1 - Q/(f P)
    c = math.sqrt(1 - 30e3 / (f * P))
    e = 100e6 / (4 * f * closed(f, P, 0.01)["p0"])
    dm = [slope["load.P"] / (2 * c) - e * 0.005, slope["friction.f"] / (2 * c) - e * 0.002, e * 0.0025]
    variance = sum(each**2 for each in dm) / 3
    m = found.quantities["m"]
    assert m.high - m.low == pytest.approx(2 * 0.95 * abs(dm[0]), rel=0.1)
    assert m.shares["load.P"] == pytest.approx(dm[0] ** 2 / 3 / variance, rel=0.02)


def test_normal_and_uniform_tolerances():
    scene = load_scene(NAME, ['tolerance.load.P={std="1 %"}'])
    a = propagate(scene)[0].quantities["a"]
    assert (a.high - a.low) / a.value == pytest.approx(2 * 1.96 * 0.005, rel=0.01)  # a grows like the root of P


def test_end_of_the_stick_zone_at_the_contact_edge(monkeypatch):
    """m = a where c + e = a: sigma = 4 f p0 (1 - c/a)."""
    monkeypatch.setattr(module, "_SEARCHED", 8.0)
    border = 4 * 0.3 * closed(0.3, 135750.0, 0.01)["p0"] * (1 - math.sqrt(1 - 20e3 / (0.3 * 135750.0)))
    scene = load_scene(NAME, ["load.Q=[-20e3,20e3]", f"load.sigma=[{-0.82 * border},{0.82 * border}]"])
    change = propagate(scene.replace({"tolerance.load.sigma": "3 %"}))[0].changes[-1]
    assert (change.regime, change.key) == ("large tension", "load.sigma")
    assert change.value == pytest.approx(border, rel=1e-6)


@pytest.mark.fault
def test_cases_that_slide_dropped_in_silence(monkeypatch):
    """A deliberate fault: 3.3 % of the draws slide, and nothing says so."""
    monkeypatch.setattr(module, "slide_margin", lambda _: 1.0)
    found = propagate(load_scene(NAME, PAPER))[0]
    slide = np.isnan(drawn(0.05, 0.01, 0.005)["m"]).mean()
    assert found.regimes.get("sliding", 0.0) != pytest.approx(slide, abs=0.004)


@pytest.mark.fault
def test_standard_deviation_taken_for_the_reach(monkeypatch):
    """A deliberate fault: a normal distribution half as wide."""
    monkeypatch.setattr(surface, "REACH", 4.0)
    with pytest.raises(AssertionError):
        test_normal_and_uniform_tolerances()


def test_no_tolerance_is_no_work(monkeypatch):
    outcome = run(NAME, "exact")
    monkeypatch.setattr(module, "run", None)
    assert with_tolerance(outcome) is outcome
    assert "tolerance" not in json.loads(record(outcome).json)
    assert main(["run", NAME, "--with", "exact", "--json"]) == 0


def test_verdicts_do_not_change(near_sliding):
    outcome = run(load_scene(NAME, PAPER), "exact")
    widened = dataclasses.replace(outcome, tolerance=near_sliding)
    assert (widened.conclusion, widened.missed) == (outcome.conclusion, outcome.missed)


def test_record_is_read_back(near_sliding, tmp_path):
    outcome = dataclasses.replace(run(load_scene(NAME, PAPER), "exact"), tolerance=near_sliding)
    path = tmp_path / "results.json"
    path.write_text(record(outcome).json)
    assert partialslip.load_result(path).tolerance == near_sliding


def test_digits_follow_the_larger_of_tolerance_and_error(near_sliding):
    rows = {row[0]: row for row in tolerance_rows(near_sliding, SI)}
    assert rows["m"][1:5] == ("a", "0.42", "0.27 to 0.50", "rounding")
    rough = {"a": near_sliding.quantities["a"].__class__("m", 2.0669766e-4, 2.0669e-4, 2.067e-4, 3e-6, {}, {})}
    found = near_sliding.__class__("march", 1, 0, 0.0, {}, rough, {"stuck": 1.0})
    assert tolerance_rows(found, SI)[0][2:5] == ("0.2067", "0.2067 to 0.2067", "3.0e-03")
    assert tolerance_lines(found, SI) == ["regime: stuck throughout"]


def test_error_of_a_code_beside_what_inputs_allow(near_sliding):
    """The exact solution for 2 % less friction stands for another code."""
    scene = load_scene(NAME, PAPER)
    outcome = run(scene, "exact")
    code = dataclasses.replace(run(scene.replace({"friction.f": 0.294}), "exact")["exact"], method="code")
    outcome = compared(scene, outcome.plan, {**outcome.results, "code": code}, None)
    line = allowed_lines(dataclasses.replace(outcome, tolerance=near_sliding))[0]
    off = closed(0.294, 135750.0, 0.01)["m"] - closed(0.3, 135750.0, 0.01)["m"]
    assert line.startswith(f"code: m off by {off:+.1%} of a, within what the inputs allow, -15.0% to +7.8%")
    assert "friction.f 5 %" in line
    assert allowed_lines(outcome) == []


def test_surfaces():
    """Through the star and any points; shares of an additive function are exact."""
    own = inputs(load_scene(NAME, PAPER))
    t, points = star(3), draws(own, 60)
    assert np.abs(points).max() <= 1
    assert np.abs(points.mean(axis=0)).max() < 0.05
    points = np.vstack([points, t, *itertools.product((-1, 1), repeat=3)])

    def function(t):
        return np.stack([1 + t[:, 0] + 2 * t[:, 1] ** 2, np.exp(t[:, 0] + t[:, 2])], axis=1)

    at = draws(own, 500)
    assert quadratic(t, function(t))(at)[:, 0] == pytest.approx(function(at)[:, 0], abs=1e-12)
    assert interpolated(points, function(points))(points) == pytest.approx(function(points), abs=1e-9)
    apart = interpolated(points, function(points))(at) - function(at)
    assert np.sqrt((apart**2).mean()) < 0.02
    parts = shares(at, function(at)[:, 0])
    assert parts == pytest.approx([(1 / 3) / (1 / 3 + 16 / 45), (16 / 45) / (1 / 3 + 16 / 45), 0], abs=0.02)


def test_strips_whose_heights_have_tolerances_are_equal_no_more():
    """Exact would take half-planes for them."""
    body = {"height": 1e-3, "width": 40e-3, "support": "roller"}
    with_bodies = [f"bodies.{each}.{key}={value!r}" for each in ("upper", "lower") for key, value in body.items()]
    keys = "friction.f", "bodies.upper.height"
    scenes = [load_scene("hertz-shear", [*with_bodies, f'tolerance.{key}="1 %"']) for key in keys]
    assert [module.method_of(scene) for scene in scenes] == ["exact", "equivalent"]
