"""Slip over half a cycle, its slope, and the energy that a cycle dissipates."""

import itertools

import numpy as np
import pytest
from quadrature import integrate
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

import partialslip
from partialslip.halfplane import Contact, hysteresis
from partialslip.halfplane import slip as slip_module
from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.punch import Punch
from partialslip.halfplane.slip import density, dissipation, slip
from partialslip.halfplane.steady import steady_stick_zone, stick_zones

HERTZ = HertzShape()
SHAPES = [HERTZ, Punch(0.1), Punch(0.5), Punch(0.9)]
# (Qf, sf): small tension with sf <= 4 Qf, large tension with c >= 4 Qf/sf, so that slip does not reverse
SMALL = [(0.19, 0.4), (0.5, 0.0), (0.75, 2.4), (0.3, 1.1)]
LARGE = [(0.3, 4.0), (0.4, 4.03), (0.0, 3.0), (0.1, 10.0)]

every_shape = pytest.mark.parametrize("shape", SHAPES, ids=["hertz", "0.1", "0.5", "0.9"])
every_load = pytest.mark.parametrize(("Qf", "sf"), SMALL + LARGE)
LOOPS = [  # wide flats take seconds each
    pytest.param(*load, shape, marks=[pytest.mark.slow] * (shape is SHAPES[-1] and load not in (SMALL[1], LARGE[0])))
    for load in SMALL + LARGE
    for shape in SHAPES
]


def between(low, high, *inner):
    return [low, *sorted({place for place in inner if low < place < high}), high]


def slip_zones(zone):
    """(side, stick zone's end, contact's end) of the slip zones."""
    for side in (-1, 1):
        end = zone.centre + side * zone.half_width
        if abs(end) < 1:
            yield side, end, float(side)


# --- the slip and its slope


@every_shape
@every_load
def test_density_is_the_slope_of_the_slip(Qf, sf, shape):
    zone = steady_stick_zone(Qf, sf, shape)
    for side, end, last in slip_zones(zone):
        x = end + np.array([0.05, 0.35, 0.6, 0.95]) * (last - end)
        h = 1e-3 * np.min([np.abs(x - place) for place in (end, last, *shape.kinks)], axis=0)
        slope = sum(k * (slip(x + i * h, zone, shape) - slip(x - i * h, zone, shape)) for i, k in ((1, 8), (2, -1)))
        slope /= 12 * h
        scale = np.abs(slip(np.array([last]), zone, shape)[0]) + 1e-3
        assert np.abs(slope - density(x, zone, shape)).max() < 1e-7 * scale + 1e-13 / h.min()
        for place in x:
            low, high = min(end, place), max(end, place)
            total = side * integrate(lambda y: density(y, zone, shape), between(low, high, *shape.kinks))
            assert total == pytest.approx(slip(np.array([place]), zone, shape)[0], rel=0, abs=1e-13)


@every_shape
@every_load
def test_slip_and_slope_vanish_with_the_stick_zone(Qf, sf, shape):
    zone = steady_stick_zone(Qf, sf, shape)
    inside = zone.centre + zone.half_width * np.linspace(-1, 1, 21) * (1 - 1e-15)
    assert (slip(inside, zone, shape) == 0).all()
    assert (density(inside, zone, shape) == 0).all()
    assert (slip(np.array([-1.1, 1.1]), zone, shape) == 0).all()
    for side, end, last in slip_zones(zone):
        x = end + 1e-6 * (last - end) * np.array([1, 4])
        assert np.divide(*density(x, zone, shape)) == pytest.approx(0.5, rel=1e-3)  # like a square root
        assert np.divide(*slip(x, zone, shape)) == pytest.approx(1 / 8, rel=1e-3)
        slips = slip(end + np.linspace(0.01, 1, 50) * (last - end), zone, shape)
        assert (np.sign(slips) == (1 if side > 0 else zone.s)).all()  # with the traction, everywhere
        assert (np.diff(np.abs(slips)) > 0).all()  # and growing outwards


@pytest.mark.parametrize(("Qf", "sf"), SMALL)
def test_closed_form_of_small_tension(Qf, sf):
    """Hertz: the slope is 2 w, the slip c^2 (sinh(2 eta)/2 - eta) at y = e +- c cosh(eta)."""
    zone = steady_stick_zone(Qf, sf, HERTZ)
    for side, end, last in slip_zones(zone):
        y = end + np.array([1e-9, 1e-3, 0.1, 0.5, 0.9, 0.999]) * (last - end)
        beyond = side * (y - zone.centre) - zone.half_width
        w = np.sqrt(beyond * (beyond + 2 * zone.half_width))
        assert density(y, zone, HERTZ) == pytest.approx(side * 2 * w, rel=1e-12)
        eta = 2 * np.arcsinh(np.sqrt(beyond / (2 * zone.half_width)))
        closed = zone.half_width**2 * (np.sinh(2 * eta) / 2 - eta)
        assert slip(y, zone, HERTZ) == pytest.approx(closed, rel=1e-11, abs=1e-15)


@pytest.mark.parametrize("shape", SHAPES[:3], ids=["hertz", "0.1", "0.5"])
def test_slope_at_the_ends_of_the_contact(shape):
    """It is finite there and where the slip zone leads."""
    zone = steady_stick_zone(0.75, 2.4, shape)
    x = np.array([-1.0, -1 + 1e-9, 1 - 1e-9, 1.0])
    slopes = density(x, zone, shape)
    assert slopes[[0, 3]] == pytest.approx(slopes[[1, 2]], rel=1e-6)


# --- what a cycle dissipates


def area_of_the_loops(Qf, sf, shape):
    """Area of the loops of Q over displacement and of moment over sigma, in A (f p0 a)^2, from the rates on a straight
    path (docstring of hysteresis). If unloading is loading rotated by half a turn, the area is
    int (2 r - 1) dQ d(displacement) over loading, and correspondingly with sigma."""

    def ends_of_zone(r):
        centre, c, _ = stick_zones(r * Qf, r * sf, shape)
        return centre, c

    def power(r):
        centre, c = ends_of_zone(r)
        dQ = np.pi * Qf
        return (2 * r - 1) * (
            dQ * (-dQ / np.pi * np.log(c) - sf / 4 * centre) - sf / 4 * (dQ * centre + np.pi / 8 * sf * c**2)
        )

    breaks = []  # where an end of the stick zone passes a corner of the flat
    for kink, side in itertools.product(shape.kinks, (-1, 1)):

        def beyond(r, kink=kink, side=side):
            centre, c = ends_of_zone(r)
            return float(centre + side * c - kink)

        if beyond(1e-9) * beyond(1.0) < 0:
            breaks.append(brentq(beyond, 1e-9, 1.0, xtol=1e-15))
    return integrate(power, between(0.0, 1.0, *breaks))


def fine_dissipation(zone, shape):
    """2 int f p |slip| dx, pieces between the kinks."""
    return 2 * sum(
        integrate(
            lambda x: shape.pressure(x) * np.abs(slip(x, zone, shape)),
            between(min(end, last), max(end, last), *shape.kinks),
        )
        for _, end, last in slip_zones(zone)
    )


@pytest.mark.parametrize(("Qf", "sf", "shape"), LOOPS)
def test_friction_dissipates_the_area_of_the_loops(Qf, sf, shape):
    zone = steady_stick_zone(Qf, sf, shape)
    area = area_of_the_loops(Qf, sf, shape)
    assert area > 0
    assert fine_dissipation(zone, shape) == pytest.approx(area, rel=1e-11)
    cornered = any(abs(kink - zone.centre) > zone.half_width for kink in shape.kinks)
    # the Gauss rule of the reported energy meets a logarithm where a slip zone reaches over a corner
    assert dissipation(zone, shape)[2] == pytest.approx(area, rel=1e-7 if cornered else 1e-12)


@pytest.mark.parametrize("shape", SHAPES[:3], ids=["hertz", "0.1", "0.5"])
@pytest.mark.parametrize(("Qf", "sf"), [(0.19, 0.4), (0.3, 4.0)])
def test_loop_of_the_public_api(Qf, sf, shape):
    """In SI units: the loops that hysteresis hands over, by splines through their points."""
    a, P, A, f, count = 1e-3, 4e5, 5e-11, 0.4, 401
    pressed = Contact(a, P, shape)
    dQ, dsigma = 2 * f * P * Qf, f * pressed.p0 * sf
    loop = hysteresis(pressed, A, f, dQ, dsigma, count)
    parameter = np.arange(count) / (count - 1)
    assert loop.Q[:count] == pytest.approx(dQ * (1 - (1 - parameter) ** 2), rel=1e-13)
    area = 0.0
    for branch in (slice(0, count), slice(count - 1, None)):
        Q, sigma, displacement, moment = (CubicSpline(parameter, values[branch]) for values in loop)
        nodes, weights = np.polynomial.legendre.leggauss(5)
        x = (parameter[:-1, None] + (1 + nodes) / (2 * (count - 1))).ravel()
        w = np.tile(weights / (2 * (count - 1)), count - 1)
        area += w @ (Q(x) * displacement(x, 1) + A / 4 * moment(x) * sigma(x, 1))
    assert (loop.displacement[-1], loop.moment[-1]) == pytest.approx((0, 0), abs=1e-12 * loop.moment.max())
    energy = dissipation(steady_stick_zone(Qf, sf, shape), shape)[2] * A * (f * pressed.p0 * a) ** 2
    assert area == pytest.approx(energy, rel=2e-9)


@pytest.mark.fault
def test_an_end_that_answers_the_wrong_way_is_caught(monkeypatch):
    """Deliberate fault: the slip zone across pushes with the other sign. The loops then have another area."""
    right = slip_module._kernels

    def wrong(eta):
        same, across = right(eta)
        return same, lambda rule: -across(rule)

    areas = {load: area_of_the_loops(*load, HERTZ) for load in ((0.75, 2.4), (0.3, 4.0))}
    monkeypatch.setattr(slip_module, "_kernels", wrong)
    for load, area in areas.items():
        assert abs(dissipation(steady_stick_zone(*load, HERTZ), HERTZ)[2] / area - 1) > 0.01


@every_shape
def test_energy_of_small_loads_goes_with_their_cube(shape):
    """Pressure, slip and the slip zones' width all grow from the ends of the contact."""
    Qf = np.array([1e-7, 1e-5, 1e-4])
    for sf in (0.0, 2.0, 10.0):  # shear alone, small and large tension
        factors = np.array([dissipation(steady_stick_zone(q, sf * q, shape), shape)[2] for q in Qf]) / Qf**3
        assert (factors > 0).all()
        off = np.abs(factors / factors[0] - 1)[1:]
        assert off[0] < 1e-2
        assert off[1] == pytest.approx(10 * off[0], rel=0.1)  # the next term goes with the fourth power


@pytest.mark.parametrize("Qf", [1e-6, 1e-3, 0.3, 0.99])
def test_energy_of_shear_on_hertz(Qf):
    """-A dQ^2/(2 pi) int (2 r - 1) ln(1 - Qf r) dr = A dQ^2/(2 pi) sum Qf^k/((k + 1)(k + 2)): A dQ^3/(24 pi f P) at
    first."""
    k = np.arange(1, 4000)
    closed = (np.pi * Qf) ** 2 / (2 * np.pi) * (Qf**k / ((k + 1) * (k + 2))).sum()
    assert dissipation(steady_stick_zone(Qf, 0.0, HERTZ), HERTZ)[2] == pytest.approx(closed, rel=1e-12)


# --- as results


def reported(name, *overrides, method="exact"):
    return partialslip.run(partialslip.load_scene(name, overrides), [method]).results[method].slip


@pytest.mark.parametrize("name", ["hertz-small-tension", "hertz-large-tension", "flat-rounded"])
def test_signs_of_the_loads(name):
    """Turning both loads round turns the slip round; turning one round mirrors it, too."""
    load, base = partialslip.load_scene(name).load, reported(name)
    assert base.dissipated > 0
    assert (np.diff(base.x) >= 0).all()
    for sign_Q, sign_sigma in ((-1, 1), (1, -1), (-1, -1)):
        turned = reported(
            name,
            f"load.Q={[sign_Q * Q for Q in load.Q]}",
            f"load.sigma={[sign_sigma * sigma for sigma in load.sigma]}",
        )
        side = sign_Q * sign_sigma
        assert turned.x == pytest.approx(side * base.x[::side], rel=1e-13)
        assert turned.slip == pytest.approx(sign_Q * base.slip[::side], rel=1e-12, abs=1e-14 * np.abs(base.slip).max())
        assert turned.dissipated == pytest.approx(base.dissipated, rel=1e-12)


def test_reported_in_si_units():
    scene = partialslip.load_scene("hertz-large-tension")
    exact = partialslip.run(scene, ["exact"]).results["exact"]
    zone = steady_stick_zone(0.4, 4.03, HERTZ)
    length = scene.material.A * scene.friction.f * exact.p0 * exact.a
    assert exact.slip.slip == pytest.approx(length * slip(exact.slip.x / exact.a, zone, HERTZ), rel=1e-9, abs=1e-15)
    energy = dissipation(zone, HERTZ)[2] * scene.material.A * (scene.friction.f * exact.p0 * exact.a) ** 2
    assert exact.slip.dissipated == pytest.approx(energy, rel=1e-9)
    assert (exact.slip.x[0], exact.slip.x[-1]) == pytest.approx((-exact.a, exact.a), rel=1e-14)


def test_no_slip_to_report():
    stuck = ("load.Q=[0, 0]", "load.sigma=[0, 0]")
    for overrides in (stuck, ("load.Q=[-4e5, 4e5]",), ("load.Q=[62831.85, 251327.4]", "load.sigma=[2e8, 1e9]")):
        assert reported("hertz-large-tension", *overrides) is None


@pytest.mark.parametrize("name", partialslip.shipped_scenes())
def test_marching_slips_and_dissipates_the_same(name):
    scene = partialslip.load_scene(name, ["fem.accuracy=1e-3"])
    results = partialslip.run(scene, ["exact", "march"]).results
    exact, march = (results[method].slip for method in ("exact", "march"))
    assert march.dissipated == pytest.approx(exact.dissipated, rel=1e-3)
    x = np.concatenate([exact.x, [-results["exact"].m, results["exact"].n]])
    order = np.argsort(x)
    expected = np.interp(march.x, x[order], np.concatenate([exact.slip, [0.0, 0.0]])[order])
    assert np.abs(march.slip - expected).max() < 5e-3 * np.abs(exact.slip).max()
