"""The stick zone: the modulus of its elliptic integrals, and its limits."""

import math

import mpmath as mp
import numpy as np
import pytest

from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.punch import Punch
from partialslip.halfplane.steady import steady_stick_zone, transition
from partialslip.result import StickZone

HERTZ = HertzShape()
SHAPES = [HERTZ, Punch(0.05), Punch(0.5), Punch(0.95)]


def ends(zone: StickZone) -> tuple[float, float]:
    return zone.half_width - zone.centre, zone.half_width + zone.centre


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
    below, above = (steady_stick_zone(Qf, transition(Qf, shape) + way * step, shape) for way in (-1, 1))
    assert (below.s, above.s) == (1, -1)
    assert ends(below) == pytest.approx(ends(above), abs=1e-9)
    assert ends(above)[0] == pytest.approx(1, abs=1e-9)  # the left slip zone vanishes there


def test_transition_is_the_papers_equation_23():
    Qf = np.array([1e-9, 0.2, 0.8])
    assert [transition(q, HERTZ) for q in Qf] == pytest.approx(8 * (1 - np.sqrt(1 - Qf)), rel=1e-6)
    assert transition(1e-9, HERTZ) == pytest.approx(4e-9, rel=1e-9)


def test_stick_zone_never_vanishes():
    """Its half-width falls like exp(-pi dsigma/(16 f p(e))); 1.849e-8 a at dsigma = 87.8 f p0."""
    zone, more = steady_stick_zone(0.4, 87.8, HERTZ), steady_stick_zone(0.4, 97.8, HERTZ)
    assert zone.half_width == pytest.approx(1.849e-8, rel=1e-3)
    rate = math.pi * 10 / (16 * math.sqrt(1 - zone.centre**2))
    assert math.log(zone.half_width / more.half_width) == pytest.approx(rate, rel=1e-6)
    assert zone.centre + zone.half_width < 0  # it lies beside the middle


@pytest.mark.parametrize("flat", [0.1, 0.9, 0.999])
def test_flat_under_small_shear_sticks_beyond_the_flat(flat):
    """Without tension the zone is the contact of a smaller load (Ciavarella and Jaeger): never within the flat."""
    assert steady_stick_zone(1 - 1e-9, 0.0, Punch(flat)).half_width >= flat * (1 - 1e-9)


@pytest.mark.parametrize(("Qf", "sf"), [(1.0, 0.0), (1.5, 1.0), (-0.1, 1.0), (0.5, -1.0), (math.nan, 1.0)])
def test_refuses_what_it_cannot_solve(Qf, sf):
    with pytest.raises(ValueError, match="must be"):
        steady_stick_zone(Qf, sf, HERTZ)
