"""Stick zones of many loads at once, in SI units: broadcasting, signs, given profiles and pressures, and the
solver's path."""

import math
import re

import numpy as np
import pytest
from plain import plain
from refusing import line_of

import partialslip
from partialslip.halfplane import Contact, contact, contact_of, hysteresis, steady
from partialslip.halfplane import one_step_zone as stick_zone
from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.punch import Punch
from partialslip.tools.errors import InputError

MATERIAL = {"E": 115e9, "nu": 0.32}
F = 0.5
HERTZ = {"kind": "hertz", "R": 0.05}
FLAT = {"kind": "flat-rounded", "R": 0.003, "b": 0.001}


def scene(profile, P=600e3):
    return plain({"P": P}, F, MATERIAL, profile)


def tabulated(gap, spacing, count):
    x = spacing * np.arange(count)
    return {"kind": "tabulated", "x": x.tolist(), "gap": gap(x).tolist()}


def parabola(x):
    return x**2 / (2 * HERTZ["R"])


def flat_rounded(x):
    return np.maximum(x - FLAT["b"], 0.0) ** 2 / (2 * FLAT["R"])


def loads(pressed, Qf, sf):
    """dQ and dsigma, in SI units, for the scaled loads."""
    return 2 * F * pressed.P * np.asarray(Qf), F * pressed.p0 * np.asarray(sf)


def scaled(pressed, Qf, sf):
    """(m, n) as fractions of a."""
    zones = stick_zone(pressed, F, *loads(pressed, Qf, sf))
    return np.array([zones.m, zones.n]) / pressed.a


PRESSED = contact(scene(HERTZ))
QF, SF = (values.ravel() for values in np.meshgrid([0.0, 1e-6, 0.1, 0.3, 0.7, 0.95], [0.0, 1e-6, 0.5, 2.0, 4.0, 9.0]))


# --- many loads at once


@pytest.mark.parametrize("profile", [HERTZ, FLAT])
def test_many_loads_are_as_one_by_one(profile):
    pressed = contact(scene(profile))
    f, Qf, sf = np.array([[[0.2]], [[0.9]]]), np.array([[0.1], [0.4], [0.8]]), np.array([0.0, 0.3, 2.0, 5.0])
    zones = stick_zone(pressed, f, 2 * f * pressed.P * Qf, f * pressed.p0 * sf)
    rounding = float(np.finfo(float).eps) * pressed.a  # the centre is a difference of lengths of size a
    for i, j, k in np.ndindex(2, 3, 4):
        one = steady.steady_stick_zone(Qf[j, 0], sf[k], pressed.shape)
        assert zones.centre[i, j, k] == pytest.approx(one.centre * pressed.a, rel=1e-13, abs=rounding)
        assert zones.half_width[i, j, k] == pytest.approx(one.half_width * pressed.a, rel=1e-13)
        assert zones.s[i, j, k] == one.s
    assert zones.m.shape == zones.n.shape == zones.half_width.shape == zones.s.shape == (2, 3, 4)
    assert zones.m == pytest.approx(zones.half_width - zones.centre, abs=0)
    assert zones.n == pytest.approx(zones.half_width + zones.centre, abs=0)


def test_broadcasting():
    dQ, dsigma = loads(PRESSED, [[0.2], [0.6]], [1.0, 3.0, 5.0])
    assert stick_zone(PRESSED, F, dQ, dsigma).m.shape == (2, 3)
    assert stick_zone(PRESSED, [0.5, 0.6, 0.7], dQ, 0.0).m.shape == (2, 3)
    one = stick_zone(PRESSED, F, dQ[0, 0], dsigma[0])
    assert one.m.shape == ()
    assert one.m == pytest.approx(stick_zone(PRESSED, F, dQ, dsigma).m[0, 0], rel=1e-14)
    assert stick_zone(PRESSED, F, [], 0.0).m.shape == (0,)
    with pytest.raises(ValueError, match="broadcast"):
        stick_zone(PRESSED, F, [1.0, 2.0], [1.0, 2.0, 3.0])


def test_more_loads_than_go_at_a_time():
    """The order of the zones is that of the loads, also beyond one chunk."""
    Qf, sf = np.full((3, 7000), 0.3), np.linspace(0, 10, 21000).reshape(3, 7000)
    m, n = scaled(PRESSED, Qf, sf)
    assert (np.diff(n.ravel()) < 0).all()  # tension moves the right end to the left
    at = scaled(PRESSED, 0.3, sf[2, 6000])
    assert (m[2, 6000], n[2, 6000]) == pytest.approx(tuple(at), rel=1e-14)


# --- signs and ends


def test_shear_alone_sticks_over_the_contact_of_the_smaller_load():
    """Ciavarella and Jaeger: P(c)/P(a) = 1 - dQ/(2 f P), for Hertz (c/a)^2."""
    Qf = np.array([0.1, 0.5, 0.99])
    for profile in (HERTZ, FLAT):
        pressed = contact(scene(profile))
        zones = stick_zone(pressed, F, *loads(pressed, Qf, 0.0))
        smaller = [contact(scene(profile, P)).a for P in pressed.P * (1 - Qf)]
        assert zones.half_width == pytest.approx(smaller, rel=1e-12)


def test_loads_of_an_array_that_slide_have_no_stick_zone():
    """They are NaN under a mask; the others are as alone."""
    limit = 2 * F * PRESSED.P
    dQ, dsigma = np.array([0.5, -0.9, 1.0, -1.0, 7.0]) * limit, np.array([[0.0], [1e8]])
    zones = stick_zone(PRESSED, F, dQ, dsigma)
    assert zones.slides.tolist() == [[False, False, True, True, True]] * 2
    for values in (zones.m, zones.n, zones.left, zones.right, zones.centre, zones.half_width):
        assert (np.isnan(values) == zones.slides).all()
    assert ((zones.s == 0) == zones.slides).all()
    for column in (0, 1):
        alone = stick_zone(PRESSED, F, dQ[column], 1e8)
        assert isinstance(alone.m, float)
        assert not alone.slides
        assert (alone.m, alone.n, alone.s) == (zones.m[1, column], zones.n[1, column], zones.s[1, column])
    assert stick_zone(PRESSED, F, dQ[2:3], 0.0).slides.all()


@pytest.mark.parametrize("dQ", [1.0, -1.5])
def test_a_loop_of_a_contact_that_slides_is_refused(dQ):
    with pytest.raises(InputError, match=r"or the contact slides$"):
        hysteresis(PRESSED, 1e-11, F, dQ * 2 * F * PRESSED.P, 0.0)


# --- given profiles and pressures


UNEVEN = PRESSED.a * np.array([0.0, 0.01, 0.3, 0.35, 0.9, 1.4, 2.0])
ALIKE = {
    "own": lambda: contact_of(lambda x: PRESSED.p0 * np.sqrt((PRESSED.a - x) * (PRESSED.a + x)) / PRESSED.a, PRESSED.a),
    "no flat": lambda: Contact(PRESSED.a, PRESSED.P, Punch(0.0)),
    "table": lambda: contact(scene(tabulated(parabola, PRESSED.a / 7.3, 20))),
    "uneven table": lambda: contact(scene({"kind": "tabulated", "x": UNEVEN, "gap": parabola(UNEVEN)})),
}


@pytest.mark.parametrize("make", ALIKE.values(), ids=ALIKE)
def test_hertz_by_other_ways(make):
    """A callable, a flat of no width, and tables of a parabola (which are exact) give Hertz to 12 digits."""
    pressed = make()
    assert (pressed.a, pressed.P, pressed.p0) == pytest.approx((PRESSED.a, PRESSED.P, PRESSED.p0), rel=1e-12)
    x = np.linspace(-1.1, 1.1, 101) * PRESSED.a
    assert pressed.pressure(x[5:-5]) == pytest.approx(PRESSED.pressure(x[5:-5]), rel=1e-12, abs=1e-7 * PRESSED.p0)
    assert (pressed.pressure(x[:3]) == 0).all()
    found, expected = (stick_zone(each, F, *loads(PRESSED, QF, SF)) for each in (pressed, PRESSED))
    for name in ("m", "n", "centre", "half_width"):
        assert np.abs(getattr(found, name) - getattr(expected, name)).max() <= 1e-12 * PRESSED.a, name


@pytest.mark.parametrize("shift", [0.0, 0.25, 0.5])
def test_a_fine_table_tends_to_the_flat_and_rounded_contact(shift):
    """Second order in the spacing, wherever the flat ends between the table's points."""
    exact = contact(scene(FLAT))
    off = []
    for number in (64, 128, 256):
        spacing = FLAT["b"] / (number + shift)
        pressed = contact(scene(tabulated(flat_rounded, spacing, math.ceil(1.5e-3 / spacing))))
        zones, expected = (stick_zone(c, F, *loads(exact, 0.3, [0.0, 0.5, 4.0])) for c in (pressed, exact))
        off.append([pressed.a / exact.a - 1, *(zones.m - expected.m) / exact.a, *(zones.n - expected.n) / exact.a])
    off = np.abs(off)
    assert off[-1].max() < 5e-5
    assert off[:-1] / off[1:] == pytest.approx(4, rel=0.05)


def test_a_table_of_pieces_is_the_sum_of_its_punches():
    """Curvature 1/R up to b, midway between two points, and 3/R beyond: Hertz plus twice the flat and rounded
    pressure, by load. The chords have the slopes of the middles."""
    x, b = np.array([0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.4]) * 1e-3, 0.5e-3
    middles = (x[1:] + x[:-1]) / 2
    gap = np.concatenate([[0.0], np.cumsum(np.diff(x) * (middles + 2 * np.maximum(middles - b, 0.0)) / 0.05)])
    pressed = contact(scene({"kind": "tabulated", "x": x.tolist(), "gap": gap.tolist()}, P=1e6))
    parts = [math.pi / 2, 2 * (math.acos(b / pressed.a) - b / pressed.a * math.sqrt(1 - (b / pressed.a) ** 2))]
    A = partialslip.scene.Material(**MATERIAL).A
    assert pressed.a**2 / (A * 0.05) * sum(parts) == pytest.approx(1e6, rel=1e-12)
    at = np.linspace(-0.99, 0.99, 31)
    mixed = (parts[0] * HertzShape().pressure(at) + parts[1] * Punch(b / pressed.a).pressure(at)) / sum(parts)
    assert pressed.shape.pressure(at) == pytest.approx(mixed, rel=1e-12)


A_QUARTIC = 2e-3


def quartic():
    """p ~ (1 + 2 (x/a)^2) sqrt(1 - (x/a)^2), the pressure under a gap ~ x^4: P = 3/4 pi a, scaled."""
    return contact_of(lambda x: 3e8 * (1 + 2 * (x / A_QUARTIC) ** 2) * np.sqrt(1 - (x / A_QUARTIC) ** 2), a=A_QUARTIC)


def test_quartic_profile():
    """P ~ a^4; without tension the zone is the contact of the smaller load."""
    pressed = quartic()
    assert pytest.approx(3e8 * 0.75 * math.pi * A_QUARTIC, rel=1e-13) == pressed.P
    Qf = np.array([1e-3, 0.3, 0.9, 0.999])
    assert stick_zone(pressed, F, *loads(pressed, Qf, 0.0)).half_width == pytest.approx(
        A_QUARTIC * (1 - Qf) ** 0.25, rel=1e-12
    )


def under(function, a=1.0):
    return lambda: contact_of(function, a)


def table(x, gap):
    return lambda: scene({"kind": "tabulated", "x": x, "gap": gap})


def loaded(f, dQ, dsigma):
    return lambda: stick_zone(PRESSED, f, dQ, dsigma)


REFUSED = [
    (loaded(F, 2 * F * PRESSED.P, 0.0), "dQ = 600000"),
    (loaded(F, -1e6, 1e8), r"dQ = -1000000\.0: must be less than 2 f P in size, or the contact slides"),
    (loaded(F, math.nan, 0.0), "dQ = nan: must be finite"),
    (loaded(F, 0.0, [1.0, -math.inf]), "dsigma = -inf: must be finite"),
    (loaded(math.inf, 0.0, 0.0), "f = inf: must be finite"),
    (loaded([0.5, 0.0], 0.0, 0.0), r"f = 0\.0: must be > 0"),
    (loaded(-0.3, 1e3, 0.0), r"f = -0\.3: must be > 0"),
    (under(lambda x: np.sqrt(1 - x**2) * (x > -0.5)), "pressure.*> 0 inside the contact"),
    (under(lambda x: np.sqrt(1 - x**2) * (x**2 - 0.25)), "pressure.*must be > 0 inside the contact"),
    (under(lambda x: 0 * x), "pressure.*must be > 0 inside the contact"),
    (under(lambda x: np.where(x > 0.3, np.nan, np.sqrt(1 - x**2))), "pressure.*must be finite"),
    (under(lambda x: np.full_like(x, np.inf)), "pressure.*must be finite"),
    (under(lambda x: np.sqrt(1 - x[:-1] ** 2)), "pressure.*must return one value for each point"),
    (under(lambda _: 1.0), "pressure.*must return one value for each point"),
    *((under(lambda x: 1 + 0 * x, a), f"a = {a}: must be finite and > 0") for a in (0.0, -1.0, math.nan, math.inf)),
    (table([0, 1, 2, 3], [0, 1, 4]), r".*profile\.gap: must have as many numbers as profile\.x, 4, not 3"),
    (table([1, 2, 3], [0, 1, 4]), r".*profile\.x\[0\] = 1\.0: must be 0, the middle of the contact"),
    (table([0, 1, 2], [1, 2, 5]), r".*profile\.gap\[0\] = 1\.0: must be 0, the middle of the contact"),
    (table([0, 2, 1], [0, 1, 4]), r".*profile\.x\[2\] = 1\.0: must be > profile\.x\[1\] = 2\.0"),
    (table([0, 1, 1], [0, 1, 4]), r".*profile\.x\[2\] = 1\.0: must be > profile\.x\[1\] = 1\.0"),
    (table([0, 1, 2, 3], [0, 1, 4, 5]), r".*profile\.gap: must be convex; its slope decreases at x = 2\.0 m"),
    (table([0, 1, 2], [0, -1, 4]), r".*profile\.gap: must be convex; its slope decreases at x = 0\.0 m"),
    (table([0, 1, 2], [0, 0, 0]), r".*profile\.gap: must increase with x; the gap is constant"),
    (table([0, 1], [0, 1]), r".*profile\.x"),
]


@pytest.mark.parametrize(("call", "line"), REFUSED)
def test_what_no_contact_has_is_refused(call, line):
    assert re.search(f"^{line}", line_of(call))


def test_a_contact_beyond_its_table_is_refused():
    table = tabulated(parabola, PRESSED.a / 10, 10)  # ends at 0.9 a
    with pytest.raises(InputError, match=r"^load\.P = 600000: must keep the contact within profile\.x, which ends at "):
        contact(scene(table))
    assert contact(scene(table, P=0.8 * PRESSED.P)).a == pytest.approx(math.sqrt(0.8) * PRESSED.a, rel=1e-12)


# --- how the two unknowns are found


def test_newton_always_ends_for_hertz(monkeypatch):
    """20,000 loads, to within 1e-6 of sliding, down to 1e-12 of it, to tensions of 300, and around the transition."""

    def fail(Qf, sf, shape):
        assert not len(Qf), (Qf, sf, shape)
        return Qf, sf

    random, count = np.random.default_rng(6), 5000
    Qf = np.concatenate(
        [
            random.random(2 * count),
            1 - 10 ** random.uniform(-6, 0, count),
            np.minimum(10 ** random.uniform(-12, 0, count), 1 - 1e-6),
        ]
    )
    wide = random.random(4 * count) < 0.5
    sf = np.where(wide, 300 * random.random(4 * count), 10 ** random.uniform(-9, math.log10(300), 4 * count))
    transitions = 8 * Qf / (1 + np.sqrt(1 - Qf))
    sf[::4] = transitions[::4] * (1 + 1e-9 * random.choice([-1, 1], count))
    monkeypatch.setattr(steady, "_bracketed", fail)
    centre, c, s = steady.stick_zones(Qf, sf, HertzShape())
    assert ((c > 0) & (c <= 1) & (centre <= 0) & (centre - c >= -1)).all()
    apart = np.abs(sf - transitions) > 1e-14  # by more than rounding of the zone's end
    assert apart.mean() > 0.95
    assert (s == np.where(sf > transitions, -1, 1))[apart].all()
