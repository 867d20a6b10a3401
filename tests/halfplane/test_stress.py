"""Stresses on the surfaces of the half-planes and inside them."""

import functools
import math

import mpmath as mp
import numpy as np
import pytest
from digits import pressure

import partialslip
from partialslip.halfplane import Contact, Stress, cauchy, contact_of
from partialslip.halfplane import stress as stress_module
from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.punch import Punch
from partialslip.halfplane.slip import density
from partialslip.halfplane.steady import steady_stick_zone
from partialslip.halfplane.traction import half_range
from partialslip.halfplane.turning import half_cycle
from partialslip.scene.gradual import turns_round
from partialslip.tools.errors import InputError

F = 0.4
SHAPES = {"hertz": HertzShape(), "0.5": Punch(0.5), "0.95": Punch(0.95), "table": Punch(np.linspace(0, 0.8, 5))}
LOADS = [(0.5, 0.0), (0.75, 2.4), (0.3, 4.0), (0.1, 10.0)]  # (Qf, sf): shear alone, small and large tension
DEPTHS = [1e-8, 1e-5, 1e-3, 0.03, 0.5, 4.0]

SLOW = ("0.95", (0.1, 10.0))  # the half cycle takes seconds

every_case = pytest.mark.parametrize(("Qf", "sf", "shape"), [
    pytest.param(*loads, shape, id=f"{loads[0]}-{loads[1]}-{name}", marks=[pytest.mark.slow] * ((name, loads) == SLOW))
    for loads in LOADS for name, shape in SHAPES.items()
])  # fmt: skip


@functools.cache
def scaled(shape, Qf, sf):
    """With a = p0 = 1; load point 2 is half of the changes."""
    return Stress(Contact(1.0, math.pi / 2, shape), F, math.pi * F * Qf, F * sf)


def outside_root(x, centre, c):
    """sqrt((x - n)(x + m)) with the sign of x - e; zero in the zone."""
    r = x - centre
    return np.sign(r) * np.sqrt(np.maximum((np.abs(r) - c) * (np.abs(r) + c), 0))


def places(stress, count=40, seed=1):
    """Points along x: anywhere, and at and next to the ends of the contact and of its zones."""
    zone = stress._zone
    ends = np.array([-1.0, 1.0, *stress.contact.shape.kinks, float(-zone.m), float(zone.n)])
    random = np.random.default_rng(seed)
    return np.concatenate([random.uniform(-1.6, 1.6, count), ends, ends - 1e-8, ends + 3e-5])


def mcewen(x, depth):
    """sigma_xx, sigma_yy, sigma_xy below a Hertz pressure with a = p0 = 1 (Johnson, Contact Mechanics, section 4.2)."""
    z = x - 1j * depth
    root = np.sqrt(z - 1) * np.sqrt(z + 1)  # m and n are its parts, without the cancellation of their squares
    m, n = np.abs(root.imag), np.sign(x) * np.abs(root.real)
    share = (depth**2 + n**2) / (m**2 + n**2)
    return np.stack([-m * (1 + share) + 2 * depth, -m * (1 - share), n * (m**2 - depth**2) / (m**2 + n**2)])


@functools.cache
def turned(Qf, sf, shape):
    """Half a cycle in which slip turns round; load point 2 is half of the changes."""
    return half_cycle(Contact(1.0, math.pi / 2, shape), F, math.pi * F * Qf, F * sf)


def shear(Qf, sf, shape):
    """Places where q is not smooth, and q at load point 2: in closed form, and of gradual loads where slip turns
    round."""
    zone = steady_stick_zone(Qf, sf, shape)
    if turns_round(Qf, sf, zone.s, zone.centre, zone.half_width):
        change = turned(Qf, sf, shape).whole
        return change.breaks, lambda x: F * change.traction(x) / 2
    ends = [zone.centre - zone.half_width, zone.centre + zone.half_width]
    return ends, lambda x: F * half_range(x, zone, shape)


# --- inside


@pytest.mark.parametrize("depth", DEPTHS)
def test_hertz_without_friction(depth):
    stress = scaled(HertzShape(), 0.0, 0.0)
    x = places(stress)
    expected = mcewen(x, depth)
    for y, sign in ((-depth, 1), (depth, -1)):
        for found in stress.inside(x, y + 0 * x):
            assert found == pytest.approx(expected * np.array([[1], [1], [sign]]), rel=0, abs=1e-12)


# --- on the surfaces


@pytest.mark.parametrize(("Qf", "sf"), [(0.5, 0.0), (0.19, 0.4), (0.75, 2.4)])
def test_surface_of_small_tension(Qf, sf):
    """Hertz: -p +- 2 f (w - sqrt(x^2 - 1)) + dsigma/4, w and the root counting outside the stick zone and the contact;
    at the trailing edge 2 f sqrt((1 - n)(1 + m)) + dsigma/4."""
    stress, zone = scaled(HertzShape(), Qf, sf), steady_stick_zone(Qf, sf, HertzShape())
    x = np.linspace(-3, 3, 601)
    strain = 2 * (outside_root(x, zone.centre, zone.half_width) - outside_root(x, 0.0, 1.0))
    p = HertzShape().pressure(x)
    for body, side in zip(stress.surface(x), (1, -1), strict=True):
        for found, way in zip(body, (-1, 1), strict=True):
            assert found == pytest.approx(-p + way * F * (side * strain + sf / 4), rel=0, abs=1e-12)
    edge = stress.surface(np.array([1.0]))[0, 1, 0]
    assert edge == pytest.approx(F * (2 * math.sqrt((1 + sf / 8) ** 2 - 1 + Qf) + sf / 4), rel=1e-12)


@every_case
def test_surface_is_strained_by_the_slope_of_the_slip(Qf, sf, shape):
    """The bodies' difference is four times the relative strain, by quadrature of p over the slip zones; their sum is
    -2 p and the tension. In the stick zone they are alike."""
    stress, zone = scaled(shape, Qf, sf), steady_stick_zone(Qf, sf, shape)
    x = np.linspace(-1, 1, 401)[1:-1]
    (_, lower), (_, upper) = stress.surface(x)
    assert lower + upper == pytest.approx(-2 * shape.pressure(x) + F * sf / 2, rel=0, abs=1e-11)
    if turns_round(Qf, sf, zone.s, zone.centre, zone.half_width):  # test_stress_at.py sums up forces there
        left, right = turned(Qf, sf, shape).permanent
        sticks = (x > left) & (x < right)
    else:
        assert lower - upper == pytest.approx(2 * F * density(x, zone, shape), rel=0, abs=1e-10)
        sticks = np.abs(x - zone.centre) < zone.half_width
    assert sticks.any()
    assert (lower - upper)[sticks] == pytest.approx(0, abs=1e-15)
    assert stress.inside(x, -1e-20 + 0 * x)[1, 0] == pytest.approx(lower, rel=0, abs=1e-9)


@every_case
def test_surface_is_the_limit_of_the_inside(Qf, sf, shape):
    stress = scaled(shape, Qf, sf)
    x = places(stress)
    surface, p, q = stress.surface(x), shape.pressure(x), shear(Qf, sf, shape)[1](x)
    for body, side in enumerate((-1, 1)):
        one, two = stress.inside(x, side * 1e-25 + 0 * x)
        assert np.stack([one[0], two[0]]) == pytest.approx(surface[body], rel=0, abs=1e-10)
        assert np.stack([one[1], two[1]]) == pytest.approx(np.stack([-p, -p]), rel=0, abs=1e-11)
        assert np.stack([one[2], two[2]]) == pytest.approx(np.stack([q, -q]), rel=0, abs=1e-11)
    assert (stress.inside(x, 0 * x)[:, 0] == surface[0]).all()


@pytest.mark.parametrize("flat", [0.0, 0.5])
@pytest.mark.parametrize(("Qf", "sf"), [(0.75, 2.4), (0.3, 4.0)])
def test_trailing_edge_with_thirty_digits(Qf, sf, flat):
    """Strain at x = 1 by the bounded inversion, 2 w(1)/pi [ int_n^1 p/(w(1-t)) dt - s int_{-1}^{-m} p/(w(1-t)) dt ]."""
    shape = Punch(flat) if flat else HertzShape()
    zone = steady_stick_zone(Qf, sf, shape)
    with mp.workdps(30):
        e, c, b, p = mp.mpf(zone.centre), mp.mpf(zone.half_width), mp.mpf(flat), pressure(flat)

        def integrand(r, side):
            """t = +-(1 - d r^2 (2 - r^2)), d being the slip zone's width, takes both square roots away."""
            with mp.workdps(150):
                width = 1 - side * e - c
                gap = width * r**2 * (2 - r**2)
                return p(side * (1 - gap)) * 4 * r * mp.sqrt(width / (width - gap + 2 * c)) / (1 - side * (1 - gap))

        strain = mp.mpf(0)
        for side, sign in ((1, 1), (-1, -zone.s)):
            stick = side * e + c
            inner = [mp.sqrt(1 - mp.sqrt((k - stick) / (1 - stick))) for k in (b, -b) if flat and stick < k]
            strain += sign * mp.quad(lambda r, side=side: integrand(r, side), [0, *sorted(inner), 1])
        strain *= 2 / mp.pi * mp.sqrt((1 - e - c) * (1 - e + c))
        expected = float(F * (strain + mp.mpf(sf) / 4))
    assert scaled(shape, Qf, sf).surface(np.array([1.0]))[0, 1, 0] == pytest.approx(expected, rel=1e-11)


# --- symmetries, and many loads


@pytest.mark.parametrize(("Qf", "sf"), LOADS)
def test_signs_of_the_loads(Qf, sf):
    shape, signs = SHAPES["0.5"], np.array([[1], [1], [-1]])
    x, y = places(scaled(shape, Qf, sf)), np.resize([-0.3, 1e-3, -1e-6, 0.7], 40 + 18)
    base = scaled(shape, Qf, sf).inside(x, y)
    assert scaled(shape, -Qf, -sf).inside(x, y) == pytest.approx(base[::-1], rel=0, abs=1e-12)
    assert scaled(shape, -Qf, sf).inside(-x, y) * signs == pytest.approx(base, rel=0, abs=1e-12)
    if not sf:  # without tension the bodies are alike: half a turn brings one to the other
        assert scaled(shape, Qf, sf).inside(-x, -y) == pytest.approx(base, rel=0, abs=1e-12)


def test_a_stick_zone_too_narrow_to_be_told_from_a_jump():
    for sf in (60.0, 100.0, 130.0, 400.0):  # down to a half-width of 1e-34 a
        stress, zone = scaled(HertzShape(), 0.1, sf), steady_stick_zone(0.1, sf, HertzShape())
        x = np.array([-0.9, -0.3, 0.1, 0.3, 0.99])
        lower, upper = stress.surface(x)[:, 1]
        assert lower - upper == pytest.approx(2 * F * density(x, zone, HertzShape()), rel=0, abs=1e-12)
        lower, upper = stress.surface(np.array([zone.centre]))[:, 1]
        assert lower == pytest.approx(upper, rel=1e-14)


def test_a_pressure_of_ones_own():
    own = Stress(contact_of(lambda x: 3e8 * np.sqrt(np.maximum(1 - (x / 2e-3) ** 2, 0)), 2e-3), F, 2e5, 1e8)
    hertz = Stress(Contact(2e-3, 3e8 * math.pi * 1e-3, HertzShape()), F, 2e5, 1e8)
    x, y = np.linspace(-5e-3, 5e-3, 101), np.linspace(-3e-3, 3e-3, 101)
    assert own.inside(x, y) == pytest.approx(hertz.inside(x, y), rel=0, abs=3e8 * 1e-11)


# --- as results


def result(name, *overrides):
    return partialslip.run(partialslip.load_scene(name, overrides), ["exact"], subsurface=True).results["exact"]


@pytest.mark.parametrize("name", partialslip.shipped_scenes())
def test_reported_for_every_scene(name):
    exact = result(name)
    surface = exact.surface
    assert {-exact.a, exact.a} <= set(surface.x)
    assert (surface.at(surface.x) == surface.sigma).all()
    assert np.abs(surface.x[0]) == np.abs(surface.x[-1]) > 2 * exact.a
    place, largest = surface.largest
    assert abs(place) == exact.a
    assert largest == surface.sigma[0].max()
    assert exact.stress_at(exact.traction.x, 0 * exact.traction.x)[:, 1] == pytest.approx(
        np.stack([-exact.traction.p] * 2), rel=0, abs=1e-10 * exact.p0
    )
    # infinitely steep at the ends of the stick zone, which are known to rounding only
    shear = exact.stress_at(exact.traction.x, 0 * exact.traction.x)[:, 2]
    assert shear == pytest.approx(-np.stack([exact.traction.q1, exact.traction.q2]), rel=0, abs=1e-7 * exact.p0)


@pytest.mark.parametrize("method", ["exact", "march", "fem"])
def test_only_where_asked_for_and_known(method):
    """Where the contact slides q is not known, and stresses without it would be wrong."""
    scene = partialslip.load_scene("hertz-shear", ["fem.accuracy=1e-2"])
    plain = partialslip.run(scene, method)[method]
    sliding = partialslip.run(scene.replace(load={"Q": [-4e5, 4e5]}), method, subsurface=True)[method]
    for found in (plain, sliding):
        assert (found.surface, found.stress_at, found.bodies) == (None, None, ())
    assert "slides" in sliding.undetermined["stresses"]


def test_stresses_of_a_contact_that_is_pressed_alone():
    pressed = result("hertz-large-tension", "load.Q=[0, 0]", "load.sigma=[0, 0]")
    assert pressed.surface.at(np.array([0.0])) == pytest.approx(-pressed.p0, rel=1e-12)
    with pytest.raises(InputError, match="slides"):
        scaled(HertzShape(), 1.0, 0.0)


# --- deliberate faults


@pytest.mark.fault
def test_poles_near_a_panel_left_to_its_rule_are_caught(monkeypatch):
    monkeypatch.setattr(cauchy, "_NEAR", 0.0)
    x = np.linspace(-0.9, 0.9, 19)
    found = scaled(HertzShape(), 0.0, 0.0).inside(x, -1e-3 + 0 * x)[0]
    assert np.abs(found - mcewen(x, 1e-3)).max() > 1e-2


@pytest.mark.fault
def test_the_change_taken_for_the_load_point_is_caught(monkeypatch):
    monkeypatch.setattr(stress_module, "half_range", lambda *args: 2 * half_range(*args))
    edge = scaled(HertzShape(), 0.5, 0.0).surface(np.array([1.0]))[0, 1, 0]
    assert abs(edge / (2 * F * math.sqrt(0.5)) - 1) > 0.5


def test_integrals_on_the_axis_are_those_beside_it():
    """What is so close to the axis that far panels see points on it has the same values by real numbers alone."""
    made = cauchy.Cauchy(
        lambda t: np.stack([np.sqrt(1 - t**2), np.where(t < 0.3, 1 + t, 1.6 - t)]), np.array([-1, 0.3, 1])
    )
    z = np.append(np.linspace(-2, 2, 41), [-1.0, 0.3, 1.0]) - 1e-30j
    with np.errstate(all="ignore"):
        np.testing.assert_allclose(made.along(z), made(z)[0], rtol=0, atol=1e-13)
