"""A coefficient of friction that varies along the contact: the exact solution."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import partialslip
from partialslip.halfplane import contact, hysteresis, one_step_zone, stick_zone
from partialslip.halfplane.contact import contact_of
from partialslip.run import run
from partialslip.run.judge.reference import reference
from partialslip.tools.errors import InputError

HERTZ, FLAT = (partialslip.load_scene(name) for name in ("hertz-shear", "flat-rounded"))
A = contact(HERTZ).a


def varying(values, scene=HERTZ, reach=1.0, **tables):
    """The scene with the coefficients ``values`` at equal distances over ``reach`` times the contact."""
    a = contact(scene).a
    x = np.linspace(-reach * a, reach * a, len(values))
    return scene.replace(friction={"f": values, "x": x}, **tables)


def linear(tilt, Qf, sf):
    """-m and n, in a, of a Hertz contact with f = f0 (1 + tilt x/a) whose ends slip the same way.

    Traction sqrt(1 - y^2) (1 + tilt y) strains a surface by s + tilt (s^2 - 1/2), whatever the width; the correction in
    the stick zone e + c y, c sqrt(1 - y^2) (alpha + beta y)/c, therefore has beta = tilt c^2, alpha = c (1 + 2 tilt e),
    and the strain that is left is that of the tension.
    """

    def half_width(e):
        return math.sqrt((1 - Qf) / (1 + 2 * tilt * e))

    def left(e):
        return e + tilt * (e**2 + (half_width(e) ** 2 - 1) / 2) + sf / 8

    e = brentq(left, -0.5, 0.5, xtol=1e-15)
    return e - half_width(e), e + half_width(e)


@pytest.mark.parametrize(("tilt", "Qf", "sf"), [(-0.2, 0.6, 0.0), (0.5, 0.3, 0.0), (-0.3, 0.5, 0.6), (0.4, 0.7, 0.9)])
def test_a_linear_coefficient_has_a_closed_form(tilt, Qf, sf):
    scene = varying([0.5 * (1 - tilt), 0.5 * (1 + tilt)])
    f_P, f_p0 = 0.5 * scene.P, 0.5 * contact(scene).p0
    changed = scene.replace(load={"Q": [-Qf * f_P, Qf * f_P], "sigma": [-sf * f_p0 / 2, sf * f_p0 / 2]})
    result = run(changed, ["exact"]).results["exact"]
    assert result.regime == "small tension"
    assert (-result.m / A, result.n / A) == pytest.approx(linear(tilt, Qf, sf), abs=2e-12)
    assert max(result.certificate.values()) < 1e-12


@pytest.mark.parametrize("name", ["hertz-shear", "hertz-large-tension"])
def test_one_coefficient_as_a_table_changes_nothing(name):
    """To the last bit."""
    scene = partialslip.load_scene(name)
    f = scene.friction.f
    one, other = (
        run(each, ["exact", "march"]).results for each in (scene, scene.replace(friction={"f": [f, f], "x": [0, 1]}))
    )
    for method, result in one.items():
        assert (result.m, result.n) == (other[method].m, other[method].n)
        assert np.array_equal(result.traction.dq, other[method].traction.dq)


def test_the_bound_is_that_of_another_pressure():
    """At constant pressure q depends on f(x) p(x) alone: here f p of a Hertz contact is the pressure under a flat."""
    pressed, a = contact(FLAT), contact(FLAT).a
    x = np.linspace(-a, a, 1000)
    hertz = HERTZ.replace(load={"p0": None, "a": a})
    under = contact(hertz)
    inner = under.places(-np.cos(np.linspace(0.02, np.pi - 0.02, 100)))
    f = pressed.pressure(inner) / under.pressure(inner)
    scene = hertz.replace(friction={"f": f, "x": inner})
    dQ, dsigma = 0.8 * pressed.P, 0.0
    expected = one_step_zone(contact_of(pressed.pressure, a, FLAT.profile.kinks), 1.0, dQ, dsigma)
    changed = scene.replace(load={"Q": [-dQ / 2, dQ / 2], "sigma": [-dsigma / 2, dsigma / 2]})
    result = run(changed, ["exact"]).results["exact"]
    assert contact(scene).f * under.P == pytest.approx(pressed.P, rel=1e-3)
    assert (result.m, result.n) == pytest.approx((expected.m, expected.n), abs=1e-3 * a)  # f is linear between points
    assert result.traction.at(x).p == pytest.approx(under.pressure(x))


@pytest.mark.parametrize("sigma", [0.0, 2e8, 7e8])
def test_a_mirror_exchanges_m_and_n(sigma):
    Q = 172787.6
    scene = varying([0.6, 0.55, 0.4], load={"Q": [-Q, Q], "sigma": [-sigma, sigma]})
    image = varying([0.4, 0.55, 0.6], load={"Q": [-Q, Q], "sigma": [sigma, -sigma]})
    one, other = (run(each, ["exact"]).results["exact"] for each in (scene, image))
    assert (one.m, one.n) == pytest.approx((other.n, other.m), abs=1e-9 * A)
    assert one.slip.dissipated == pytest.approx(other.slip.dissipated, rel=1e-8)
    x = np.linspace(-0.99, 0.99, 51) * A
    f_p = np.array([scene.friction.at(x) * one.traction.at(x).p])
    assert (np.abs(one.traction.at(x).dq) <= 2 * f_p * (1 + 1e-9)).all()
    assert one.traction.at(x).dq == pytest.approx(other.traction.at(-x).dq, abs=1e-7 * one.p0)


def test_friction_and_loads_scale_together():
    scene = varying([0.6, 0.4], load={"sigma": [-2e8, 2e8]})
    Q, sigma = scene.load.Q[1], scene.load.sigma[1]
    halved = varying([0.3, 0.2], load={"Q": [-Q / 2, Q / 2], "sigma": [-sigma / 2, sigma / 2]})
    one, other = (run(each, ["exact"]).results["exact"] for each in (scene, halved))
    assert (one.m, one.n) == pytest.approx((other.m, other.n), rel=1e-13)


def test_the_loops_enclose_what_friction_dissipates():
    scene = varying([0.6, 0.4], load={"sigma": [-2e8, 2e8]})
    pressed, load = contact(scene), scene.load
    loop = hysteresis(pressed, scene.material.A, pressed.f, load.dQ, load.dsigma, 201)
    area = np.trapezoid(loop.Q, loop.displacement) + scene.material.A / 4 * np.trapezoid(loop.moment, loop.sigma)
    assert abs(area) == pytest.approx(run(scene, ["exact"]).results["exact"].slip.dissipated, rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(12))
def test_methods_agree_on_random_coefficients(seed):
    """march within twice its estimate, fem within its bar: with tension of any size, Hertz and flat and rounded."""
    random = np.random.default_rng(20261125 + seed)
    scene = FLAT if seed % 3 == 2 else HERTZ
    a, count = contact(scene).a, random.integers(2, 6)
    f, x = 0.5 * np.exp(random.uniform(-0.35, 0.35, count)), np.sort(random.uniform(-1.1, 1.1, count)) * a
    Q = random.uniform(0.1, 0.75) * f.min() * scene.P
    sigma = random.uniform(-2, 2) * f.mean() * contact(scene).p0
    changed = scene.replace(
        friction={"f": f, "x": x}, load={"Q": [-Q, Q], "sigma": [-sigma, sigma]}, fem={"accuracy": 1e-4}
    )
    try:
        exact, march, fem = run(changed, ["exact", "march", "fem"]).results.values()
    except InputError:  # exact holds for one stick zone between zones that slip: march is the reference elsewhere
        march, fem = run(changed, ["march", "fem"]).results.values()
        known = {key: march.estimate[key] + fem.estimate[key] for key in "mn"}
        assert all(abs(getattr(march, key) - getattr(fem, key)) < known[key] * a for key in "mn")
        return
    for key in "mn":
        for result in (march, fem):
            error = abs(getattr(result, key) - getattr(exact, key)) / a
            assert error < 2 * result.estimate[key]
        assert abs(getattr(fem, key) - getattr(exact, key)) < 1e-4 * a


@pytest.mark.slow
def test_points_inside_that_slip_first_are_refused():
    with pytest.raises(InputError, match="more than one zone sticks; use march"):
        run(varying([0.9, 0.1, 0.9]), ["exact"])
    assert run(varying([0.9, 0.1, 0.9], fem={"accuracy": 1e-3}), ["march"]).results["march"].regime == "small tension"


@pytest.mark.fault
def test_points_inside_that_slip_first_left_unseen(monkeypatch):
    """Deliberate fault: nothing looks for them. The traction of the stick zone then exceeds the bound."""
    monkeypatch.setattr("partialslip.halfplane.steady._holds", lambda edge, *_: np.ones(len(edge), bool))
    scene = varying([0.9, 0.1, 0.9])
    result = run(scene, ["exact"]).results["exact"]
    p, dq, *_ = result.traction.at(0.0)
    assert abs(dq) > 2.2 * 0.1 * p


def test_friction_that_does_not_carry_Q_is_told():
    """The largest f would carry it, the mean over the pressure does not."""
    scene = varying([0.2, 0.6, 0.2], load={"Q": [-3e5, 3e5]})
    assert contact(scene).f * scene.P < 3e5 < 0.6 * scene.P
    for method in ("exact", "march", "fem"):
        with pytest.raises(
            InputError, match=r"friction\.f: must carry load\.Q: it carries 0\.\d+ of its largest value"
        ):
            run(scene, [method])
    sliding = run(scene.replace(load={"Q": [-5e5, 5e5]}), ["exact"]).results["exact"]
    assert sliding.regime == "sliding"


def test_zones_of_many_loads():
    pressed = contact(varying([0.6, 0.4]))
    dQ, dsigma = np.array([1e5, 3e5]), np.array([1e8, 4e8])
    many = stick_zone(pressed, pressed.f, dQ, dsigma)
    for number in range(2):
        one = stick_zone(pressed, pressed.f, dQ[number], dsigma[number])
        assert (many.m[number], many.n[number]) == pytest.approx((one.m, one.n), abs=1e-12 * A)
    with pytest.raises(InputError, match=r"f = 0\.6: must be contact\.f"):
        stick_zone(pressed, 0.6, dQ, dsigma)


def test_varying_pressure_has_no_closed_form():
    scene = varying([0.6, 0.4], load={"p0": None, "P": [HERTZ.P, 1.2 * HERTZ.P]})
    with pytest.raises(InputError, match="varies along x, and the pressure in time"):
        run(scene, ["exact"])


def with_a_feature(factor, middle, width, **tables):
    """f = 0.5, and ``factor`` times that at ``middle``, falling to 0.5 within ``width``/2, both in a."""
    x = np.array([-1, middle - width / 2, middle, middle + width / 2, 1]) * A
    return HERTZ.replace(friction={"f": [0.5, 0.5, 0.5 * factor, 0.5, 0.5], "x": x}, **tables)


# a dip slips inside the stick zone; a bump sticks in the slip zone
FEATURES = [(0.1, 0.2, 2e-2), (0.1, 0.2, 1e-4), (3.0, 0.7, 2e-2)]


@pytest.mark.parametrize(("factor", "middle", "width"), FEATURES)
def test_dips_and_bumps_are_refused_and_march_is_the_reference(factor, middle, width):
    scene = with_a_feature(factor, middle, width, fem={"accuracy": 1e-2})
    assert reference(scene).method == "march"
    outcome = run(scene, ["march", "fem"])
    assert not outcome.comparisons["fem"].missed
    march = outcome.results["march"]
    assert "m" in march.undetermined
    # a friction law on cells that each see all of the dip
    cells = march.traction.cells
    fine = cells[:-1, None] + np.diff(cells)[:, None] * (np.arange(200) + 0.5) / 200
    bound = (scene.friction.at(fine) * contact(scene).pressure(fine)).mean(axis=1)
    assert (np.abs(march.traction.dq) / 2 <= bound + 1e-4 * march.p0).all()


def test_many_loads_over_a_dip_have_no_zone():
    pressed = contact(with_a_feature(0.1, 0.2, 1e-4))
    zones = stick_zone(pressed, pressed.f, [2e5, 3e5, 6.1e5], 0.0)
    assert np.isnan(zones.m).tolist() == [True, True, False]  # all of the last zone is left of the dip


@pytest.mark.fault
@pytest.mark.parametrize(("factor", "middle", "width"), FEATURES)
def test_fixed_places_alone_do_not_see_them(monkeypatch, factor, middle, width):
    """Deliberate fault: exact looks at fixed places. Then \\|dq\\| is beyond the bound beside the kinks of f."""
    scene = with_a_feature(factor, middle, width)
    with pytest.raises(InputError, match="more than one zone"):
        run(scene, ["exact"])
    monkeypatch.setattr("partialslip.halfplane.traction._room_at_kinks", lambda *_: np.inf)
    monkeypatch.setattr("partialslip.halfplane.steady.slips_on", lambda *_: True)
    found = run(scene, ["exact"]).results["exact"]
    x = (middle + width * np.linspace(-1, 1, 801)) * A
    p, dq, *_ = found.traction.at(x)
    assert ((np.abs(dq) / 2 - scene.friction.at(x) * p) / (0.5 * found.p0)).max() > 0.05


def test_slip_of_one_direction_needs_no_stages():
    """f falls by a fifth within 1e-4 a: while the zone's end passes the jump two zones stick, yet slip only grows."""
    x, a = np.array([-1, 0.5399, 0.54, 1]) * A, A
    scene = HERTZ.replace(
        friction={"f": [0.5, 0.5, 0.6, 0.6], "x": x}, load={"sigma": [-1e8, 1e8]}, fem={"accuracy": 1e-3}
    )
    outcome = run(scene, ["exact", "march"])
    exact, march = outcome.results.values()
    assert not exact.path_dependent
    for key in "mn":
        assert abs(getattr(exact, key) - getattr(march, key)) < 2 * march.estimate[key] * a
    assert not outcome.comparisons["march"].missed
