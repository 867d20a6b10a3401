"""Tables: pressures of many flats at the cost of few, and the error that a coarse table itself makes."""

import numpy as np
import pytest
from plain import plain

import partialslip
from partialslip.halfplane.contact import Contact, contact
from partialslip.halfplane.method import spacing_error
from partialslip.halfplane.proportional import loading
from partialslip.halfplane.punch import Punch, _unit
from partialslip.halfplane.shape import Given
from partialslip.halfplane.tables import table_error
from partialslip.report.answer import answers
from partialslip.report.record import record

A, F = 4 * (1 - 0.3**2) / 70e9, 0.4
P = 3 * np.pi * 1e-6 / (2 * A)  # with the gap 1e-6 (x/a)^4, a = 1 mm


def table(x, gap=lambda x: x**4, Qf=0.4, sf=3.0):
    """At x in mm; gap in um; loads of the quartic."""
    load = {"P": P, "Q": [-Qf * F * P, Qf * F * P], "sigma": [-sf * F * P / np.pi * 1e3, sf * F * P / np.pi * 1e3]}
    return plain(load, F, (70e9, 0.3), {"kind": "tabulated", "x": 1e-3 * x, "gap": 1e-6 * gap(x)})


def quartic():
    """p = (2/3) sqrt(1 - x^2) (1 + 2 x^2) p0."""
    return Contact(1e-3, P, Given(lambda x: np.sqrt((1 - x) * (1 + x)) * (1 + 2 * x**2)))


def errors(its, true):
    """Of a, m, n (in a), and p and q (relative L2)."""
    load = table(np.linspace(0, 1.5, 9)).load
    mine, exact = (loading(each, F, load.dQ, load.dsigma, bound=2) for each in (its, true))
    angle = (np.arange(400) + 0.5) / 400 * np.pi
    x, weights = -true.a * np.cos(angle), np.sin(angle)

    def apart(values, others):
        return np.sqrt((values - others) ** 2 @ weights / (others**2 @ weights))

    m, n = np.abs(np.array(mine.ends) * its.a - np.array(exact.ends) * true.a) / true.a
    q = (each.p0 * change.traction(x / each.a) for each, change in ((its, mine), (true, exact)))
    return {
        "a": abs(its.a - true.a) / true.a,
        "m": m,
        "n": n,
        "p": apart(its.pressure(x), true.pressure(x)),
        "q": apart(*q),
    }


@pytest.mark.parametrize("count", [9, 30, 100, 300])
def test_the_tables_own_error_is_known_within_a_factor_of_three(count):
    scene = table(np.linspace(0, 1.5, count))
    pressed = contact(scene)
    estimate = table_error(scene, pressed, loading(pressed, F, scene.load.dQ, scene.load.dsigma, bound=2))
    for key, true in errors(pressed, quartic()).items():
        assert true / 3 < estimate[key] < 3 * true, key


@pytest.mark.parametrize("method", ["exact", "march"])
def test_runs_state_it_apart_from_estimates(method):
    """It is an error of the input, the same for all methods: nobody's estimate has it."""
    run = partialslip.run(table(np.linspace(0, 1.5, 9)), [method])
    assert set(run.spacing) == {"a", "m", "n", "p", "q"}
    assert run.spacing["a"] > 1e-3 > 10 * max(run[method].estimate.get(key, 0.0) for key in "amn")
    assert ("spacing of the table", "off by about ") in [(name, told[:13]) for name, told in answers(run)]
    assert record(run).spacing == run.spacing


def test_other_profiles_and_bodies_have_none():
    for scene in ("hertz-shear", "flat-rounded"):
        assert not partialslip.run(scene, ["exact"]).spacing


def test_a_parabola_has_no_error():
    """Tables of parabolas are exact, and so are tables of every second point."""
    scene = table(np.linspace(0, 1.5, 12), lambda x: x**2)
    pressed = contact(scene)
    found = table_error(scene, pressed, loading(pressed, F, scene.load.dQ, scene.load.dsigma, bound=2))
    assert max(found.values()) < 1e-12


@pytest.mark.parametrize("kind", ["even", "random", "graded"])
def test_pressures_of_many_flats_are_the_sum_of_all(kind):
    """Panels against the sum over all flats, at kinks, beside them and at the end of the contact."""
    random = np.random.default_rng(1)
    flats = {
        "even": np.arange(200) / 200,
        "random": np.sort(random.random(200)),
        "graded": 1 - np.geomspace(1, 1e-4, 200),
    }
    shape = Punch(flats[kind], random.random(200) * (1 + flats[kind]))
    x = np.concatenate([np.cos(np.linspace(0, np.pi / 2, 301)), flats[kind], 1 - np.geomspace(1e-13, 1e-2, 30)])
    total = _unit(x[:, None], flats[kind], np.pi - 2 * np.arcsin(flats[kind])) @ shape._weights
    np.testing.assert_allclose(shape.pressure(x), total, atol=3e-12)


@pytest.mark.parametrize("flat", [0.0, 0.3, 0.9])
def test_both_forms_of_the_pressure_of_a_flat(flat):
    x = np.linspace(0, 1, 200)[:-1]
    shape = Punch(flat)
    unit = _unit(x, np.array(flat), np.array(np.pi - 2 * np.arcsin(flat))) * shape._weights
    np.testing.assert_allclose(shape.pressure(x), unit, atol=1e-13)


def test_work_does_not_grow_with_the_square_of_the_points():
    """The number of kinks that a pressure takes one by one, and of points of a rule."""
    few, many = (contact(table(np.linspace(0, 1.5, count))).shape for count in (100, 1000))
    assert few._panels._which.shape[1] == many._panels._which.shape[1] <= 6
    assert len(many.rule(0.3, 0.2, 1).t) < 4 * len(few.rule(0.3, 0.2, 1).t)


def test_a_zone_that_slips_inside_costs_the_error_of_a_table_nothing(monkeypatch):
    """It takes seconds to follow, and hardly changes by what the table leaves out."""

    def followed(*_):
        raise AssertionError

    monkeypatch.setattr("partialslip.halfplane.gradual_path.inner.Way", followed)
    found = spacing_error(table(np.linspace(0, 1.5, 30), Qf=0.85, sf=9.0))
    assert 1e-5 < found["m"] < 1e-2


@pytest.mark.fault
def test_a_difference_that_is_not_divided_would_be_seen(monkeypatch):
    """The whole change from every second point to all of them is three times the error."""
    monkeypatch.setattr("partialslip.halfplane.tables._LESS", 1.0)
    scene = table(np.linspace(0, 1.5, 100))
    pressed = contact(scene)
    estimate = table_error(scene, pressed, None)
    assert estimate["p"] > 2.2 * errors(pressed, quartic())["p"]
