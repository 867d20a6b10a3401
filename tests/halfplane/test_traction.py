"""Tractions: resultants, bounds, the adhered limit, and no relative strain in the stick zone."""

import numpy as np
import pytest

from partialslip.halfplane.adhered import adhered
from partialslip.halfplane.hertz import Hertz
from partialslip.halfplane.punch import Punch
from partialslip.halfplane.shape import Shape
from partialslip.halfplane.steady import stick_zone
from partialslip.halfplane.traction import half_range, mean_load_bound
from partialslip.result import StickZone

LOADS = [(0.19, 0.4), (0.75, 2.4), (0.4, 4.03), (0.3, 8.0), (0.0, 3.0), (0.9, 20.0), (0.4, 87.8), (0.5, 2.3431457535)]
NODES, WEIGHTS = np.polynomial.legendre.leggauss(400)


HERTZ = Hertz()
SHAPES = [HERTZ, Punch(0.1), Punch(0.6), Punch(0.95)]
every_shape = pytest.mark.parametrize("shape", SHAPES)


def integrate(function, zone: StickZone, shape: Shape = HERTZ) -> float:
    """Over [-1, 1], for square roots at the ends of the zones and logarithmic kinks at the flat's."""
    ends = np.unique(
        np.clip([-1.0, *shape.kinks, zone.centre - zone.half_width, zone.centre + zone.half_width, 1.0], -1, 1)
    )
    u = np.linspace(-3.5, 3.5, 241)
    x = np.tanh(np.pi / 2 * np.sinh(u))
    weights = (u[1] - u[0]) * np.pi / 2 * np.cosh(u) / np.cosh(np.pi / 2 * np.sinh(u)) ** 2
    points = (ends[1:] + ends[:-1])[:, None] / 2 + np.diff(ends)[:, None] / 2 * x
    return float(np.sum(np.diff(ends)[:, None] / 2 * weights * function(points.ravel()).reshape(points.shape)))


@every_shape
@pytest.mark.parametrize(("Qf", "sf"), LOADS)
def test_resultant_is_the_shear_force(Qf, sf, shape):
    zone = stick_zone(Qf, sf, shape)
    assert integrate(lambda x: half_range(x, zone, shape), zone, shape) == pytest.approx(Qf * np.pi / 2, abs=1e-12)


@every_shape
def test_resultant_of_the_pressure(shape):
    zone = StickZone(0.0, 1.0, 1)
    assert integrate(shape.pressure, zone, shape) == pytest.approx(np.pi / 2, abs=1e-12)


@every_shape
@pytest.mark.parametrize(("Qf", "sf"), LOADS)
def test_friction_bound_holds_everywhere(Qf, sf, shape):
    zone = stick_zone(Qf, sf, shape)
    x = np.concatenate([np.linspace(-1, 1, 2001), zone.centre + zone.half_width * np.linspace(-1, 1, 201)])
    assert np.all(np.abs(half_range(x, zone, shape)) <= shape.pressure(x) + 1e-13)


@every_shape
@pytest.mark.parametrize(("Qf", "sf"), LOADS[:6])
def test_what_sticks_does_not_move(Qf, sf, shape):
    """Strains due to dq and tension cancel in the stick zone: (1/pi) PV int dq/(x-s) ds + dsigma/4 = 0."""
    zone = stick_zone(Qf, sf, shape)
    for x in zone.centre + zone.half_width * np.array([-0.9, -0.5, 0.1, 0.7, 0.95]):
        here = half_range(np.array([x]), zone, shape)[0]
        split = type("Split", (Shape,), {"kinks": (*shape.kinks, x)})()
        smooth = integrate(
            lambda s, x=x, here=here: (half_range(s, zone, shape) - here) / (x - s + (s == x)), zone, split
        )
        principal = smooth + here * np.log((x + 1) / (1 - x))
        assert principal / np.pi + sf / 8 == pytest.approx(0, abs=1e-6)  # kinks at both sides of the pole cost digits


def test_small_tension_is_the_superposition_of_two_hertz_tractions():
    zone = stick_zone(0.75, 2.4, HERTZ)
    x = np.linspace(-1, 1, 100)  # at no end of a zone, which rounding moves
    inner = np.sqrt(np.maximum((0.2 - x) * (x + 0.8), 0))
    assert half_range(x, zone, HERTZ) == pytest.approx(np.sqrt(1 - x**2) - inner, abs=1e-15)


def test_large_friction_tends_to_the_adhered_traction():
    """With f -> infinity at given loads the stick zone grows to the whole contact, and dq to the paper's eq. (1)."""
    a, p0, dQ, dsigma, x = 1.0, 1.0, 0.3, 0.5, np.linspace(-0.9, 0.9, 19)
    errors = []
    for f in (100.0, 1e4):
        zone = stick_zone(dQ / (2 * f * np.pi / 2), dsigma / (f * p0), HERTZ)
        errors.append(np.abs(2 * f * half_range(x, zone, HERTZ) - adhered(x, a, dQ, dsigma)).max())
    assert errors[1] < 2e-4
    assert errors[1] == pytest.approx(errors[0] / 100, rel=0.1)


BOUNDS = [(0.3, 4.0, 0.472488366807), (0.4, 4.03, 0.441532843718), (0.3, 8.0, 0.224240294932)]


@pytest.mark.parametrize(("Qf", "sf", "bound"), BOUNDS)
def test_mean_load_bound_of_large_tension(Qf, sf, bound):
    assert mean_load_bound(stick_zone(Qf, sf, HERTZ), HERTZ) == pytest.approx(bound, abs=1e-11)
    assert mean_load_bound(stick_zone(Qf, sf, HERTZ), HERTZ) < 1 - Qf


@every_shape
def test_mean_load_bound_of_small_tension_is_gross_sliding(shape):
    assert mean_load_bound(stick_zone(0.19, 0.4, shape), shape) == pytest.approx(0.81, abs=1e-11)
    assert mean_load_bound(stick_zone(0.19, 0.4, HERTZ), HERTZ) == pytest.approx(0.81, abs=1e-14)


@every_shape
def test_traction_is_continuous_at_the_ends_of_the_zones(shape):
    for Qf, sf in LOADS[:6]:
        zone = stick_zone(Qf, sf, shape)
        for end in (zone.centre - zone.half_width, zone.centre + zone.half_width):
            if abs(end) < 1:
                steps = [np.ptp(half_range(end + np.array([-h, h]), zone, shape)) for h in (1e-6, 1e-8)]
                assert steps[1] < 0.2 * steps[0]
