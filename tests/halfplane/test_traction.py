"""Tractions: closed forms, the adhered limit, and many points at once."""

import numpy as np
import pytest

from partialslip.halfplane import traction
from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.loading import one_step
from partialslip.halfplane.punch import Punch
from partialslip.halfplane.steady import steady_stick_zone
from partialslip.halfplane.traction import adhered, half_range
from partialslip.result import StickZone

HERTZ = HertzShape()


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


def test_the_mean_load_bound_of_an_example():
    """With half-width 0.9, dQ = 1.2 and dsigma = 8: both load points alone have room for 0.2087."""
    P = np.pi * 0.9**2 / 2
    assert one_step(0.6 / P, 8 / 0.9, HERTZ).mean_load_bound * P == pytest.approx(0.184963, abs=1e-6)


def test_many_points_are_interpolated(monkeypatch):
    """dq in the stick zone, interpolated between panels that shrink towards its ends, is that at each point."""
    shape, zone = Punch([0.1, 0.4, 0.7], [1.0, 0.3, 0.2], np.arccos([0.1, 0.4, 0.7])), StickZone(-0.05, 0.45, -1)
    x = zone.centre + zone.half_width * np.concatenate([np.linspace(-1, 1, 301), 1 - np.geomspace(1e-13, 1, 60)])
    direct = traction.half_range(x, zone, shape)
    monkeypatch.setattr(traction, "_PLENTY", 0)
    found, beyond = traction.half_range(x, zone, shape), 1e-16 + np.minimum(x - zone.left, zone.right - x)
    # of a square root that begins at the end the rounding of x alone leaves so much
    assert (np.abs(found - direct) <= 1e-14 + 1e-15 / np.sqrt(np.abs(beyond))).all()
