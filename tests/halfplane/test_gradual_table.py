"""The table of Hertz's gradual stick zones: against the solver, near its borders, and as `stick_zone` uses it."""

import functools
import itertools
import math

import numpy as np
import pytest

from partialslip.halfplane import contact, gradual_table, stick_zone
from partialslip.halfplane.gradual_path.half_cycle import steady
from partialslip.halfplane.gradual_path.stage import Loads
from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.steady import stick_zones
from partialslip.scene.gradual import turns_round
from partialslip.scene.reading import load_scene

SEED = 20261  # played no part in making the table
PRESSED = contact(load_scene("hertz-shear"))
F = 0.3


def turned(count, seed=SEED, inner=False):
    """Random Qf and sf whose slip turns round, which the table has, with or without an ``inner`` slip zone."""
    random = np.random.default_rng(seed)
    tried = (400 if inner else 40) * count
    Qf, sf = random.random(tried), 10.4 * random.random(tried)
    zone = stick_zones(Qf, sf, HertzShape())
    there = turns_round(Qf, sf, zone.s, zone.centre, zone.half_width)
    there &= gradual_table.parted(Qf, sf) == inner
    there[there] = ~np.isnan(gradual_table.tabled(Qf[there], sf[there]).centre)
    return Qf[there][:count], sf[there][:count]


def solved(Qf, sf):
    """Ends by the solver."""
    return np.array([steady(Loads(s, math.pi * Q), HertzShape()).last.zone for Q, s in zip(Qf, sf, strict=True)]).T


def off(Qf, sf, true=None):
    """Largest error of the table; ``true`` ends, (2, n): by default by the solver."""
    zone = gradual_table.tabled(Qf, sf)
    return np.abs(np.array([zone.left, zone.right]) - (solved(Qf, sf) if true is None else true)).max()


def beside_borders(every=1, beside=1e-3):
    """Loads on both sides of borders between two patches, and inside of the first and the last border, where no inner
    zone slips, in ``every`` so many panels."""
    at = []
    for panel in gradual_table.table()["panels"][::every]:
        if panel.get("inner"):
            continue
        sf = panel["low"] + 0.37 * (panel["high"] - panel["low"])
        w = [np.polynomial.chebyshev.chebval(-0.26, border) for border in panel["borders"]]
        for upper, lower in itertools.pairwise(w):
            width = upper - lower
            at += [(1 - each**2, sf) for each in (upper - beside * width, lower + beside * width)]
    return np.array(at).T


@functools.cache
def known_beside_borders():
    """Some loads, and ends by the solver."""
    loads = beside_borders(3)
    return *loads, solved(*loads)


@pytest.mark.slow
def test_random_loads():
    assert off(*turned(50, SEED + 1)) < 1e-6


@pytest.mark.slow
def test_loads_beside_all_borders():
    assert off(*beside_borders()) < 1e-6


@pytest.mark.fault
def test_series_cut_short_show(monkeypatch):
    """Fault: three terms along s_f."""
    real = gradual_table.table()
    panels = [{**each, "patches": [[end[:3] for end in patch] for patch in each["patches"]]} for each in real["panels"]]
    monkeypatch.setattr(gradual_table, "table", lambda: {"panels": panels})
    assert off(*known_beside_borders()) > 1e-5


def test_zones_meet_at_borders():
    """m and n are continuous across each border."""
    for panel in gradual_table.table()["panels"]:
        for first, second in zip(panel["patches"], panel["patches"][1:], strict=False):
            along = np.linspace(-1, 1, 9)
            for one, other in zip(first, second, strict=True):
                ends = [np.polynomial.chebyshev.chebval2d(along, 0 * along + way, np.array(end))
                        for end, way in ((one, 1), (other, -1))]  # fmt: skip
                np.testing.assert_allclose(*ends, rtol=0, atol=1e-6)


def test_one_step_holds_again_where_all_slips_again():
    """Just above the least tension under which slip turns round, small tension in closed form holds."""
    Qf = np.array([0.2, 0.6, 0.9])
    sf = 4 * Qf * (1 + 1e-3)
    once = stick_zones(Qf, sf, HertzShape())
    assert gradual_table.again(Qf, sf, once).all()
    np.testing.assert_allclose(solved(Qf, sf), [once.left, once.right], rtol=0, atol=1e-9)


def test_arrays_take_the_table_and_numbers_the_solver():
    """The same zones within 1e-6, for all signs; a million of loads would take no solver."""
    Qf, sf = turned(2, SEED + 2)
    dQ, dsigma = 2 * F * PRESSED.P * Qf, F * PRESSED.p0 * sf
    for signs in ((1, 1), (-1, 1), (1, -1)):
        many = stick_zone(PRESSED, F, signs[0] * dQ, signs[1] * dsigma)
        for i in range(len(Qf)):
            one = stick_zone(PRESSED, F, signs[0] * dQ[i], signs[1] * dsigma[i])
            assert (many.m[i], many.n[i]) == pytest.approx((one.m, one.n), abs=1e-6 * PRESSED.a)
            assert many.s[i] == one.s


def test_the_table_is_small():
    assert gradual_table.PLACE.stat().st_size < 200_000


def test_beyond_the_table_there_is_nothing():
    """Larger tension, and Qf next to 1."""
    zone = gradual_table.tabled(np.array([0.6, 0.999]), np.array([14.0, 9.0]))
    assert np.isnan(zone.centre).all()


@pytest.mark.parametrize("count", [1, pytest.param(15, marks=pytest.mark.slow)])
def test_loads_with_an_inner_zone(count):
    """The solver follows the inner zone; the table does not, where all points that slipped inside slip again."""
    Qf, sf = turned(count, SEED + 6, inner=True)
    assert len(Qf) == count
    assert off(Qf, sf) < 1e-6


def test_an_inner_zone_that_matters_is_left_out():
    """(0.85, 9): without the inner zone n is wrong by 1e-3; (0.95, 8), (0.9975, 7.2): all points slip again."""
    zone = gradual_table.tabled(np.array([0.85, 0.95, 0.9975]), np.array([9.0, 8.0, 7.2]))
    assert np.isnan(zone.centre).tolist() == [True, False, False]


def along_lines(count=10, points=400, seed=SEED + 5):
    """m and n (2, lines, points) along random straight lines from border to border of the map; NaN where the table has
    none."""
    random = np.random.default_rng(seed)
    share = np.linspace(0, 1, points)
    ends = random.random((count, 2, 2)) * (0.98, 10)
    ends[: count // 2, :, 0] = (0.3, 0.98)  # across the region in which slip turns round
    ends[count // 2 :, :, 1] = (0.05, 10)
    Qf, sf = np.moveaxis(ends[:, :1] + share[:, None] * (ends[:, 1:] - ends[:, :1]), 2, 0)
    zone = stick_zones(Qf.ravel(), sf.ravel(), HertzShape())
    there = turns_round(Qf.ravel(), sf.ravel(), zone.s, zone.centre, zone.half_width)
    gradual = gradual_table.tabled(Qf.ravel()[there], sf.ravel()[there])
    for values, found in zip(zone, gradual, strict=True):
        values[there] = found
    return np.array([zone.m, zone.n]).reshape(2, *Qf.shape)


def sharpest(values):
    """Largest step of m or n over the larger one of its neighbours; steps below 1e-4 count as 1e-4."""
    steps = np.maximum(np.abs(np.diff(values, axis=-1)), 1e-4)
    return np.nanmax(steps[..., 1:-1] / np.maximum(steps[..., 2:], steps[..., :-2]))


def test_no_jumps_along_lines():
    """m and n are continuous in the loads, with kinks and square roots: a jump would be many steps high."""
    values = along_lines()
    assert np.isnan(values).mean() < 0.2
    assert sharpest(values) < 3


@pytest.mark.fault
def test_zones_of_one_step_show_as_jumps(monkeypatch):
    """Fault: one step where an inner zone slips."""
    real = gradual_table.tabled

    def one_step(Qf, sf):
        zone, once = real(Qf, sf), stick_zones(Qf, sf, HertzShape())
        inner = gradual_table.parted(Qf, sf)
        return type(zone)(*(np.where(inner, *pair) for pair in zip(once, zone, strict=True)))

    monkeypatch.setattr(gradual_table, "tabled", one_step)
    assert sharpest(along_lines()) > 10


def test_a_figure_up_to_large_tension_takes_no_time(monkeypatch):
    """Q_f = 0.5 and dsigma a up to 12 dQ: no pair of loads asks the solver, and zones that the table lacks are NaN."""
    monkeypatch.setattr("partialslip.halfplane.zones.half_cycle", None)
    dQ, share = F * PRESSED.P, np.linspace(0, 12, 200)
    zones = stick_zone(PRESSED, F, dQ, share * dQ / PRESSED.a)
    known = ~np.isnan(zones.m)
    assert known[share < 6.2].all()
    assert not known[share > 6.3].any()
    assert (zones.s[~known] != 0).all()
