"""Stages of pressing from a flat punch that is known on points of uneven distances, as graded elements have them."""

import numpy as np
import pytest

from partialslip.friction import pressing
from partialslip.friction.even_gap import EvenGap
from partialslip.friction.pressing import FlatPunch

F, STICKS = 0.6, 0.9
X = np.sin(np.linspace(-1, 1, 4001) * np.pi / 2)
MIDDLES = np.concatenate([[X[0]], (X[1:] + X[:-1]) / 2, [X[-1]]])


def sheared(angle):
    """Force along x between the middle of a punch and the ``angle``, at which p is 1/pi: f p where points slip, less in
    proportion to the distance where they stick."""
    end, size = np.arcsin(STICKS), np.abs(angle)
    inner = (1 - np.cos(np.minimum(size, end))) / STICKS
    return F / np.pi * (inner + np.maximum(size - end, 0.0))


def punch(gap):
    """A punch whose points are far apart in the middle and close to each other near the ends."""
    right = 1 - np.geomspace(0.02, 1, 9)[:-1]
    points = np.concatenate([-right, [0.0], right[::-1]])
    left = np.arcsin(points) / np.pi + 0.5, sheared(np.arcsin(points)) - sheared(np.pi / 2)
    at = np.arcsin(MIDDLES)
    forces = np.diff(at) / np.pi, np.diff(sheared(at))
    return FlatPunch((-1.0, 1.0), X, np.diff(MIDDLES), forces, points, left, gap=gap)


def locked_in(gap):
    """Force along x on the right half of the contact pressed under the ``gap``, over that of a punch with all of P."""
    _, q = punch(gap).stage(1.0, 1.0)
    return float(q[X > 0].sum()) / float(sheared(np.pi / 2))


@pytest.mark.parametrize("gap", [EvenGap(np.array([0.5]), np.ones(1)), EvenGap(np.array([0.1, 0.6]), np.ones(2))])
def test_punches_lock_in_the_shear_that_they_have(gap):
    """Punches of all half-widths have the same part of their force on the right."""
    assert locked_in(gap) == pytest.approx(1, abs=2e-4)


@pytest.mark.fault
def test_interpolated_tractions_change_the_shear(monkeypatch):
    """Deliberate fault: tractions between the middles of cells, whose integral is not the force."""

    class Interpolated:
        def __init__(self, angle, left):
            self.known = (angle[1:] + angle[:-1]) / 2, np.diff(left) / np.diff(angle)

        def derivative(self):
            return lambda at: np.interp(at, *self.known)

    monkeypatch.setattr(pressing, "PchipInterpolator", Interpolated)
    assert abs(locked_in(EvenGap(np.array([0.5]), np.ones(1))) - 1) > 2e-3
