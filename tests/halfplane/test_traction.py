"""Tractions: the pressure, the adhered limit, room for a mean of Q, and no relative strain in the stick zone."""

import numpy as np
import pytest
from quadrature import integrate

from partialslip.halfplane import traction
from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.loading import one_step
from partialslip.halfplane.punch import Punch
from partialslip.halfplane.steady import steady_stick_zone
from partialslip.halfplane.traction import adhered, half_range
from partialslip.result import StickZone

LOADS = [(0.19, 0.4), (0.75, 2.4), (0.4, 4.03), (0.3, 8.0), (0.0, 3.0), (0.9, 20.0), (0.4, 87.8), (0.5, 2.3431457535)]


HERTZ = HertzShape()
SHAPES = [HERTZ, Punch(0.1), Punch(0.6), Punch(0.95)]
every_shape = pytest.mark.parametrize("shape", SHAPES)


@every_shape
def test_resultant_of_the_pressure(shape):
    assert integrate(shape.pressure, [-1.0, *shape.kinks, 1.0]) == pytest.approx(np.pi / 2, abs=1e-12)


@every_shape
@pytest.mark.parametrize(("Qf", "sf"), LOADS[:6])
def test_what_sticks_does_not_move(Qf, sf, shape):
    """Strains due to dq and tension cancel in the stick zone: (1/pi) PV int dq/(x-s) ds + dsigma/4 = 0."""
    zone = steady_stick_zone(Qf, sf, shape)
    for x in zone.centre + zone.half_width * np.array([-0.9, -0.5, 0.1, 0.7, 0.95]):
        here = half_range(np.array([x]), zone, shape)[0]
        ends = np.unique(np.clip([-1.0, *shape.kinks, zone.left, x, zone.right, 1.0], -1, 1))
        smooth = integrate(lambda s, x=x, here=here: (half_range(s, zone, shape) - here) / (x - s + (s == x)), ends)
        principal = smooth + here * np.log((x + 1) / (1 - x))
        assert principal / np.pi + sf / 8 == pytest.approx(0, abs=1e-6)  # kinks at both sides of the pole cost digits


def test_small_tension_is_the_superposition_of_two_hertz_tractions():
    zone = steady_stick_zone(0.75, 2.4, HERTZ)
    x = np.linspace(-1, 1, 100)  # at no end of a zone, which rounding moves
    inner = np.sqrt(np.maximum((0.2 - x) * (x + 0.8), 0))
    assert half_range(x, zone, HERTZ) == pytest.approx(np.sqrt(1 - x**2) - inner, abs=1e-15)


def test_large_friction_tends_to_the_adhered_traction():
    """With f -> infinity at given loads the stick zone grows to the whole contact, and dq to the paper's eq. (1)."""
    a, p0, dQ, dsigma, x = 1.0, 1.0, 0.3, 0.5, np.linspace(-0.9, 0.9, 19)
    errors = []
    for f in (100.0, 1e4):
        zone = steady_stick_zone(dQ / (2 * f * np.pi / 2), dsigma / (f * p0), HERTZ)
        errors.append(np.abs(2 * f * half_range(x, zone, HERTZ) - adhered(x, a, dQ, dsigma)).max())
    assert errors[1] < 2e-4
    assert errors[1] == pytest.approx(errors[0] / 100, rel=0.1)


BOUNDS = [(0.3, 4.0), (0.4, 4.03), (0.3, 8.0), (0.471569, 8.888889)]


@pytest.mark.parametrize("shape", [HERTZ, Punch(0.6)])
@pytest.mark.parametrize(("Qf", "sf"), BOUNDS)
def test_mean_load_bound_of_large_tension_holds_all_along_the_way(Qf, sf, shape):
    """Some mean traction q must satisfy |q + dq_t - dq/2| <= f p at all stages t of the way, not only at its ends,
    unless slip reverses: the stages are then others."""
    cycle = one_step(Qf, sf, shape)
    angle = (np.arange(500) + 0.5) / 500 * np.pi
    x, weights = cycle.zone.centre + cycle.zone.half_width * np.cos(angle), np.sin(angle) * np.pi / 500
    dq = half_range(x, cycle.zone, shape)

    def room(stages):
        least = np.abs(dq)
        for t in np.arange(1, stages) / stages:
            least = np.maximum(least, np.abs(2 * half_range(x, steady_stick_zone(t * Qf, t * sf, shape), shape) - dq))
        return 2 / np.pi * cycle.zone.half_width * float((shape.pressure(x) - least) @ weights)

    # the stages miss the largest by the square of their distance
    assert cycle.mean_load_bound == pytest.approx(room(1 if cycle.turns_round else 80), abs=2e-5)
    assert cycle.mean_load_bound < room(1) - 1e-4 or cycle.turns_round


def test_the_mean_load_bound_of_an_example():
    """With half-width 0.9, dQ = 1.2 and dsigma = 8: both load points alone have room for 0.2087."""
    P = np.pi * 0.9**2 / 2
    assert one_step(0.6 / P, 8 / 0.9, HERTZ).mean_load_bound * P == pytest.approx(0.184963, abs=1e-6)


@every_shape
def test_traction_is_continuous_at_the_ends_of_the_zones(shape):
    for Qf, sf in LOADS[:6]:
        zone = steady_stick_zone(Qf, sf, shape)
        for end in (zone.centre - zone.half_width, zone.centre + zone.half_width):
            if abs(end) < 1:
                steps = [np.ptp(half_range(end + np.array([-h, h]), zone, shape)) for h in (1e-6, 1e-8)]
                assert steps[1] < 0.2 * steps[0]


def test_many_points_are_interpolated(monkeypatch):
    """dq in the stick zone, interpolated between panels that shrink towards its ends, is that at each point."""
    shape, zone = Punch([0.1, 0.4, 0.7], [1.0, 0.3, 0.2], np.arccos([0.1, 0.4, 0.7])), StickZone(-0.05, 0.45, -1)
    x = zone.centre + zone.half_width * np.concatenate([np.linspace(-1, 1, 301), 1 - np.geomspace(1e-13, 1, 60)])
    direct = traction.half_range(x, zone, shape)
    monkeypatch.setattr(traction, "_PLENTY", 0)
    found, beyond = traction.half_range(x, zone, shape), 1e-16 + np.minimum(x - zone.left, zone.right - x)
    # of a square root that begins at the end the rounding of x alone leaves so much
    assert (np.abs(found - direct) <= 1e-14 + 1e-15 / np.sqrt(np.abs(beyond))).all()
