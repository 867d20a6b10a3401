"""The kernel of glide dislocations, equation (4) of the paper, forwards: from the slip to the shear, and back."""

import itertools

import numpy as np
import pytest

from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.punch import Punch
from partialslip.halfplane.slip import density
from partialslip.halfplane.steady import steady_stick_zone
from partialslip.halfplane.traction import half_range

LOADS = {"small tension": (0.75, 2.4), "large tension": (0.3, 4.0), "beside the middle": (0.2, 8.0)}
SHAPES = {"hertz": HertzShape(), "flat with round corners": Punch(0.5)}
PLACES = np.array([-0.97, -0.81, -0.4, 0.03, 0.35, 0.62, 0.98])
STEPS = 3000  # of a piece


def principal_value(function, breaks, x):
    """PV int function(t)/(t - x) dt over all pieces between ``breaks``, at each ``x``: midpoint rule in the angle of
    each piece, with the pole taken out."""
    angle = (np.arange(STEPS) + 0.5) / STEPS * np.pi
    total = np.zeros_like(x)
    for left, right in itertools.pairwise(breaks):
        half = (right - left) / 2
        t = (left + right) / 2 - half * np.cos(angle)
        inside = (x > left) & (x < right)
        at_pole = np.where(inside, function(x), 0.0)
        quotient = (function(t) - at_pole[:, None]) / (t - x[:, None])
        total += (quotient * half * np.sin(angle)).sum(axis=1) * np.pi / STEPS
        total += at_pole * np.log(np.where(inside, (right - x) / np.where(inside, x - left, 1.0), 1.0))
    return total


@pytest.fixture(params=[(name, load) for name in SHAPES for load in LOADS], ids=" ".join)
def solution(request):
    """Shape, Qf, sf, stick zone, and breaks of the tractions."""
    name, load = request.param
    shape, (Qf, sf) = SHAPES[name], LOADS[load]
    zone = steady_stick_zone(Qf, sf, shape)
    kinks = [-0.5, 0.5] if name != "hertz" else []
    return shape, Qf, sf, zone, np.unique([-1.0, zone.left, zone.right, 1.0, *kinks])


def shear_of(slope, breaks, x, sign=1.0):
    """Shear by dislocations of the density ``slope``, in A f p0: equation (4), in f p0."""
    return sign * principal_value(lambda t: np.sqrt(1 - t**2) * slope(t), breaks, x) / (np.pi * np.sqrt(1 - x**2))


def change(solution, x, sign=1.0):
    """Change of shear: adhered contact, and dislocations in the slip zones."""
    shape, Qf, sf, zone, breaks = solution
    adhered = (Qf + x * sf / 4) / np.sqrt(1 - x**2)
    return adhered + shear_of(lambda t: density(t, zone, shape), breaks, x, sign)


def test_slip_gives_the_shear(solution):
    """Adhered shear and that of the dislocations add up to dq, in slip zones (2 f p) and in the stick zone."""
    shape, *_, zone, _ = solution
    assert np.allclose(change(solution, PLACES), 2 * half_range(PLACES, zone, shape), atol=5e-6)


def test_shear_gives_the_strain(solution):
    """The kernel of traction on dq, and the tension, strain the slip zones by the density and the stick zone not."""
    shape, _, sf, zone, breaks = solution
    strain = -principal_value(lambda t: 2 * half_range(t, zone, shape), breaks, PLACES) / np.pi + sf / 4
    assert np.allclose(strain, density(PLACES, zone, shape), atol=5e-6)
    sticks = (zone.left < PLACES) & (zone.right > PLACES)
    assert np.allclose(strain[sticks], 0.0, atol=5e-6)


@pytest.mark.fault
def test_a_kernel_of_the_other_sign_is_seen(solution):
    """The other sign of the kernel misses dq by more than a tenth of f p0."""
    shape, *_, zone, _ = solution
    assert np.abs(change(solution, PLACES, -1.0) - 2 * half_range(PLACES, zone, shape)).max() > 0.1
