"""Ends of the contact of unlike bodies: beside them p is a power of the distance that depends on the shear."""

import numpy as np
import pytest

from partialslip.friction.load_path import Path
from partialslip.friction.step_errors import other_steps, summed
from partialslip.friction.zone_ends import CORNER, ROUNDED, contact_ends

BETA, F, END = 0.27, 0.7, 1.0
MORE = np.arctan(BETA * F) / np.pi


def read(rise, beta=BETA, left=1, right=1):
    """Ends read from exact forces of a contact between -1 and 1, whose last cells reach beyond it, slipping to the
    ``left`` and ``right`` (signs of q/p)."""
    off = np.cumsum(0.002 * 1.3 ** np.arange(12)) - 0.001
    vertices = np.concatenate([-1.0005 + np.append(0.0, off)[:10], 1.0005 - np.append(0.0, off)[:10][::-1]])
    powers = rise - left * MORE, rise + right * MORE

    def beyond(distance, power):
        return np.maximum(distance, 0.0) ** power

    from_left, from_right = beyond(vertices + END, powers[0]), beyond(END - vertices, powers[1])
    total = 1.0
    resultant = np.where(np.arange(len(vertices)) < 10, from_left, total - from_right)
    normal = np.diff(resultant)
    sign = np.where(np.arange(len(normal)) < 10, left, right)
    inside = np.linspace(-0.9999, 0.9999, 2001)
    return contact_ends(vertices, normal, inside, F * sign * normal, beta, rise)


@pytest.mark.parametrize("rise", [ROUNDED, CORNER])
@pytest.mark.parametrize("slip", [(-1, 1), (1, 1), (1, -1)])
def test_ends_are_read_from_the_power_that_slip_leaves(rise, slip):
    assert read(rise, BETA, *slip) == pytest.approx((-END, END), abs=1e-9)


@pytest.mark.fault
@pytest.mark.parametrize("rise", [ROUNDED, CORNER])
def test_powers_of_like_bodies_are_seen(rise):
    """Deliberate fault: shear left out of the power."""
    left, right = read(rise, 0.0, -1, 1)
    assert min(abs(left + END), abs(right - END)) > 1e-4


def test_other_steps_are_no_halves_alone():
    path = Path(((0.0, 0.0), (1.0, 0.0)), (0, 1), True, 1, 4)
    (way, *_) = other_steps(path).fractions
    assert way == pytest.approx(sorted({k / 8 for k in range(1, 9)} | {k / 9 for k in range(1, 9)}))


def test_errors_are_summed_by_key():
    assert summed({"a": 1.0, "m": 2.0}, {"m": 3.0}) == {"a": 1.0, "m": 5.0}
