"""The stick zone against 40-digit values, 30-digit quadrature and its own limits."""

import math

import mpmath as mp
import numpy as np
import pytest

from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.punch import Punch
from partialslip.halfplane.shape import Shape
from partialslip.halfplane.steady import stick_zone, transition
from partialslip.result import StickZone

HERTZ = HertzShape()
SHAPES = [HERTZ, Punch(0.05), Punch(0.5), Punch(0.95)]


def ends(zone: StickZone) -> tuple[float, float]:
    return zone.half_width - zone.centre, zone.half_width + zone.centre


@pytest.mark.parametrize(
    ("Qf", "sf", "m", "n", "s"),
    [
        (0.19, 0.4, "0.95", "0.85", 1),
        (0.75, 2.4, "0.80", "0.20", 1),
        (0.3, 4, "0.749058362969", "0.370590356334", -1),
        (0.4, 4.03, "0.803853299461", "0.294928723406", -1),
        (0.3, 8, "0.496860949803", "0.060012779922", -1),
    ],
)
def test_spot_values_to_every_printed_digit(Qf, sf, m, n, s):
    zone = stick_zone(Qf, sf, HERTZ)
    assert zone.s == s
    for end, printed in zip(ends(zone), (m, n), strict=True):
        assert f"{end:.{len(printed) - 2}f}" == printed


def loads_by_quadrature(centre: float, c: float) -> tuple[float, float]:
    """The consistency conditions (17) and (18) with opposite signs of slip, as integrals, in 30 digits."""
    mp.mp.dps = 30
    e, c = mp.mpf(centre), mp.mpf(c)

    def both(power: int):
        total = mp.mpf(0)
        for side in (1, -1):
            end = mp.acosh((1 - side * e) / c)

            def integrand(t, side=side):
                x = e + side * c * mp.cosh(t)
                return x**power * mp.sqrt(max(1 - x**2, 0))

            total += mp.quad(integrand, [end * k / 8 for k in range(9)])
        return total

    first, second = both(0), both(1)
    return float(8 / mp.pi * first), float(2 / mp.pi * (second - e * first))


@pytest.mark.parametrize(
    ("centre", "c"), [(-0.2, 0.5), (-0.01, 0.3), (-0.4, 1e-2), (-0.4, 1e-8), (-0.9, 1e-3), (-0.499999, 0.5), (0.0, 0.2)]
)
def test_elliptic_forms_are_the_integrals(centre, c):
    sf, Qf = HERTZ.conditions(1 + centre - c, c, -1)[:2]
    expected_sf, expected_Qf = loads_by_quadrature(centre, c)
    assert sf == pytest.approx(expected_sf, rel=1e-13)
    assert Qf == pytest.approx(expected_Qf, abs=1e-14)


@pytest.mark.fault
def test_chi_is_the_modulus():
    """Deliberate fault: chi taken for the parameter k^2, as libraries take it, misses the integrals by percents."""
    c, edge = 0.5, 0.3
    m, n = 1 - edge, edge + 2 * c - 1
    chi = math.sqrt((1 - m**2) * (1 - n**2)) / ((1 + m) * (1 + n))
    sf = HERTZ.conditions(edge, c, -1).sf

    def first(parameter):
        root = math.sqrt((1 + m) * (1 + n))
        E, K = mp.ellipe(parameter), mp.ellipk(parameter)
        Pi = [mp.ellippi((m - 1) / (m + 1), parameter), mp.ellippi((1 - n) / (1 + m), parameter)]
        terms = -2 * root * E + (n - m + 4) * (1 + m) / root * K + 2 * (n - m) / root * Pi[0]
        return float(8 / mp.pi * (terms + (m**2 - n**2) / root * Pi[1]))

    assert first(chi**2) == pytest.approx(sf, rel=1e-12)
    assert abs(first(chi) / sf - 1) > 0.01


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("Qf", [1e-6, 0.1, 0.5, 0.9, 0.999])
def test_continuous_at_the_transition(Qf, shape):
    step = max(1e-10 * transition(Qf, shape), 1e-12)  # what moves an end by more than rounding
    below, above = (stick_zone(Qf, transition(Qf, shape) + way * step, shape) for way in (-1, 1))
    assert (below.s, above.s) == (1, -1)
    assert ends(below) == pytest.approx(ends(above), abs=1e-9)
    assert ends(above)[0] == pytest.approx(1, abs=1e-9)  # the left slip zone vanishes there


def test_transition_is_the_papers_equation_23():
    Qf = np.array([1e-9, 0.2, 0.8])
    assert [transition(q, HERTZ) for q in Qf] == pytest.approx(8 * (1 - np.sqrt(1 - Qf)), rel=1e-6)
    assert transition(1e-9, HERTZ) == pytest.approx(4e-9, rel=1e-9)


def test_stick_zone_never_vanishes():
    """Its half-width falls like exp(-pi dsigma/(16 f p(e))); 1.849e-8 a at dsigma = 87.8 f p0."""
    zone, more = stick_zone(0.4, 87.8, HERTZ), stick_zone(0.4, 97.8, HERTZ)
    assert zone.half_width == pytest.approx(1.849e-8, rel=1e-3)
    rate = math.pi * 10 / (16 * math.sqrt(1 - zone.centre**2))
    assert math.log(zone.half_width / more.half_width) == pytest.approx(rate, rel=1e-6)
    assert zone.centre + zone.half_width < 0  # it lies beside the middle


@pytest.mark.parametrize(("shape", "count"), [(HERTZ, 300), *((shape, 10) for shape in SHAPES[1:])])
def test_random_loads(shape, count):
    """Admissible zones that satisfy their own equations, up to the ends of every regime."""
    random = np.random.default_rng(1)
    for number in range(count):
        Qf = (random.random(), 1 - 10 ** random.uniform(-6, 0), 10 ** random.uniform(-9, 0))[number % 3]
        sf = (10 * random.random(), 10 ** random.uniform(-9, 2), transition(Qf, shape) * (1 + 1e-9))[number // 3 % 3]
        zone = stick_zone(Qf, sf, shape)
        m, n = ends(zone)
        assert 0 < zone.half_width < 1
        assert -n <= m <= 1 + 1e-15
        assert n <= m + 1e-15
        if zone.half_width > 1e-12 and Qf < 1 - 1e-3:
            found = shape.conditions(1 + zone.centre - zone.half_width, zone.half_width, zone.s)[:2]
            assert found == pytest.approx((sf, Qf), rel=4e-12, abs=1e-12)


@pytest.mark.parametrize("s", [1, -1])
@pytest.mark.parametrize(("centre", "c"), [(-0.2, 0.5), (-0.01, 0.3), (-0.4, 1e-2), (-0.4, 1e-9), (-0.499999, 0.5)])
def test_quadrature_is_as_good_as_the_closed_forms(centre, c, s):
    edge = 1 + centre - c
    assert Shape.conditions(HERTZ, edge, c, s)[:2] == pytest.approx(
        HERTZ.conditions(edge, c, s)[:2], rel=1e-13, abs=2e-14
    )


@pytest.mark.parametrize("flat", [0.05, 0.5, 0.95])
def test_flat_and_rounded_against_30_digits(flat):
    """Both integrals with the pressure as it is published, for zones that lie across, beside and within the flat."""
    mp.mp.dps = 30
    end = mp.asin(flat)
    scale = mp.pi - 2 * end - mp.sin(2 * end)

    def p(x):
        angle = mp.asin(x)
        if abs(abs(x) - flat) < mp.mpf(10) ** -28 or abs(x) >= 1:
            return mp.mpf(Punch(flat).pressure(np.array([float(x)]))[0])
        logs = mp.sin(angle) * mp.log(abs(mp.sin(angle + end) / mp.sin(angle - end)))
        logs += flat * mp.log(abs(mp.tan((angle + end) / 2) * mp.tan((angle - end) / 2)))
        return ((mp.pi - 2 * end) * mp.cos(angle) + logs) / scale

    for centre, c in ((-0.1, 0.7), (-0.3, 0.1), (-0.02, 0.96)):
        totals = []
        for side in (1, -1):
            e, w = mp.mpf(centre), mp.mpf(c)
            stop = mp.acosh((1 - side * e) / w)
            kinks = [mp.acosh(side * (k - e) / w) for k in (-flat, flat) if side * (k - e) > w]
            steps = sorted([mp.mpf(0), *kinks, stop])
            x = lambda t, side=side, e=e, w=w: e + side * w * mp.cosh(t)  # noqa: E731
            first = mp.quad(lambda t, x=x: p(x(t)), steps)
            second = mp.quad(lambda t, x=x, e=e: p(x(t)) * (x(t) - e), steps)
            totals.append((first, second))
        for s in (1, -1):
            expected = [float(k / mp.pi * (totals[0][i] - s * totals[1][i])) for i, k in ((0, 8), (1, 2))]
            assert Punch(flat).conditions(1 + centre - c, c, s)[:2] == pytest.approx(expected, rel=1e-12, abs=1e-13)


def test_flat_and_rounded_tends_to_hertz():
    loads = [(0.3, 1.0), (0.3, 4.0)]
    for Qf, sf in loads:
        zones = [stick_zone(Qf, sf, shape) for shape in (HERTZ, Punch(1e-3), Punch(1e-5))]
        off = [abs(zone.centre - zones[0].centre) + abs(zone.half_width - zones[0].half_width) for zone in zones]
        assert off[2] < 3e-5
        assert off[2] == pytest.approx(off[1] / 100, rel=0.3)


@pytest.mark.parametrize("flat", [0.1, 0.9, 0.999])
def test_flat_under_small_shear_sticks_beyond_the_flat(flat):
    """Without tension the zone is the contact of a smaller load (Ciavarella and Jaeger): never within the flat."""
    assert stick_zone(1 - 1e-9, 0.0, Punch(flat)).half_width >= flat * (1 - 1e-9)


@pytest.mark.parametrize(("Qf", "sf"), [(1.0, 0.0), (1.5, 1.0), (-0.1, 1.0), (0.5, -1.0), (math.nan, 1.0)])
def test_refuses_what_it_cannot_solve(Qf, sf):
    with pytest.raises(ValueError, match="must be"):
        stick_zone(Qf, sf, HERTZ)
