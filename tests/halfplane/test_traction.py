"""Tractions: resultants, bounds, the adhered limit, and that what sticks does not move."""

import numpy as np
import pytest

from partialslip.halfplane.adhered import adhered
from partialslip.halfplane.hertz import half_width, pressure
from partialslip.halfplane.steady import StickZone, stick_zone
from partialslip.halfplane.traction import half_range, mean_load_bound

LOADS = [(0.19, 0.4), (0.75, 2.4), (0.4, 4.03), (0.3, 8.0), (0.0, 3.0), (0.9, 20.0), (0.4, 87.8), (0.5, 2.3431457535)]
NODES, WEIGHTS = np.polynomial.legendre.leggauss(400)


def integrate(function, zone: StickZone) -> float:
    """Over [-1, 1], exact for square roots at the ends of the zones."""
    ends = np.unique([-1.0, zone.centre - zone.half_width, zone.centre + zone.half_width, 1.0])
    angle = np.pi / 2 * (NODES + 1)
    x = (ends[1:] + ends[:-1])[:, None] / 2 - np.diff(ends)[:, None] / 2 * np.cos(angle)
    values = function(x.ravel()).reshape(x.shape) * np.sin(angle) * WEIGHTS
    return float(np.pi / 2 * np.sum(np.diff(ends)[:, None] / 2 * values))


@pytest.mark.parametrize(("Qf", "sf"), LOADS)
def test_resultant_is_the_shear_force(Qf, sf):
    zone = stick_zone(Qf, sf)
    assert integrate(lambda x: half_range(x, zone), zone) == pytest.approx(Qf * np.pi / 2, abs=2e-13)


@pytest.mark.parametrize(("Qf", "sf"), LOADS)
def test_friction_bound_holds_everywhere(Qf, sf):
    zone = stick_zone(Qf, sf)
    x = np.concatenate([np.linspace(-1, 1, 2001), zone.centre + zone.half_width * np.linspace(-1, 1, 201)])
    assert np.all(np.abs(half_range(x, zone)) <= pressure(x, 1.0, 1.0) + 1e-14)


@pytest.mark.parametrize(("Qf", "sf"), LOADS[:6])
def test_what_sticks_does_not_move(Qf, sf):
    """In the stick zone the strain under dq cancels that of the tension: (1/pi) PV int dq/(x-s) ds + dsigma/4 = 0."""
    zone = stick_zone(Qf, sf)
    for x in zone.centre + zone.half_width * np.array([-0.9, -0.5, 0.1, 0.7, 0.95]):
        here = half_range(np.array([x]), zone)[0]
        smooth = integrate(lambda s, x=x, here=here: (half_range(s, zone) - here) / (x - s), zone)
        principal = smooth + here * np.log((x + 1) / (1 - x))
        assert principal / np.pi + sf / 8 == pytest.approx(0, abs=1e-10)


def test_small_tension_is_the_superposition_of_two_hertz_tractions():
    zone = stick_zone(0.75, 2.4)
    x = np.linspace(-1, 1, 101)
    inner = np.sqrt(np.maximum((0.2 - x) * (x + 0.8), 0))
    assert half_range(x, zone) == pytest.approx(np.sqrt(1 - x**2) - inner, abs=1e-15)


def test_large_friction_tends_to_the_adhered_traction():
    """With f -> infinity at given loads the stick zone grows to the whole contact, and dq to the paper's eq. (1)."""
    a, p0, dQ, dsigma, x = 1.0, 1.0, 0.3, 0.5, np.linspace(-0.9, 0.9, 19)
    errors = []
    for f in (100.0, 1e4):
        zone = stick_zone(dQ / (2 * f * np.pi / 2), dsigma / (f * p0))
        errors.append(np.abs(2 * f * half_range(x, zone) - adhered(x, a, dQ, dsigma)).max())
    assert errors[1] < 2e-4
    assert errors[1] == pytest.approx(errors[0] / 100, rel=0.1)


@pytest.mark.parametrize(
    ("Qf", "sf", "bound"), [(0.25464790894703254, 1.6, 0.55786 / (0.5 * np.pi / 2)), (0.3, 4.0, 0.4725)]
)
def test_mean_load_bound_of_large_tension(Qf, sf, bound):
    assert mean_load_bound(stick_zone(Qf, sf)) == pytest.approx(bound, rel=1e-4)
    assert mean_load_bound(stick_zone(Qf, sf)) < 1 - Qf


def test_mean_load_bound_of_small_tension_is_gross_sliding():
    assert mean_load_bound(stick_zone(0.75, 2.4)) == pytest.approx(0.25, abs=1e-14)


def test_hertz_published_numbers():
    """Yang and Laursen's cylinders: a = 0.680778 mm, p0 = 9.35135 MPa."""
    A, R, P = 4 * (1 - 0.3**2) / 200e6, 4e-3, 10e3
    a = half_width(P, A, R)
    assert a * 1e3 == pytest.approx(0.680778, abs=5e-7)
    assert a / (A * R) / 1e6 == pytest.approx(9.35135, abs=5e-6)
    zone = StickZone(0.0, 1.0, 1)
    assert integrate(lambda x: pressure(x, 1.0, 1.0), zone) == pytest.approx(np.pi / 2, rel=1e-14)
