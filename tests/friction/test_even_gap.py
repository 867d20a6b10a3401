"""The contact of bodies pressed together grows as the gap closes beside flat punches."""

from functools import cache

import numpy as np
import pytest
from scipy.integrate import quad

from partialslip.friction.even_gap import PARABOLA, EvenGap
from partialslip.march.punch_growth import PunchGrowth

BETA, F = -0.28, 0.67
CORNER = EvenGap(np.ones(1), np.ones(1))


@cache
def punch():
    return PunchGrowth.of(BETA, F)


def forces():
    return punch().normal * np.diff(punch().vertices)


def coupled(gap):
    return gap.under(punch().vertices, forces(), F * -BETA)


def opened(x):
    """What the force 1 on the flat punch opens at x > 1, from the logarithm of the distance."""
    middles = (punch().vertices[1:] + punch().vertices[:-1]) / 2
    return float(forces() @ np.log((x**2 - middles**2) / (1 - middles**2)))


def closed(gap, x):
    """What punches of all half-widths up to ``x`` close there, in (x - 1)^2/2."""

    def part(angle):  # both ends are roots
        s = 1 + (x - 1) * (1 - np.cos(angle)) / 2
        return opened(x / s) * float(gap.rate(np.array([s]))[0]) * (x - 1) / 2 * np.sin(angle)

    return quad(part, 0, np.pi, epsrel=1e-5, limit=200)[0] / ((x - 1) ** 2 / 2)


def test_forces_without_coupling_are_those_of_the_closed_form():
    gap = EvenGap(np.array([0.2, 0.5]), np.array([1.0, 0.4]))
    for s in (0.3, 0.7, 1.5):
        psi = np.arccos(np.minimum(gap.places / s, 1.0))
        assert gap.force(s) == pytest.approx(s**2 * (gap.steps @ (2 * psi - np.sin(2 * psi))) / 4, rel=1e-12)
    assert gap.force(0.2) == 0
    assert PARABOLA.force(2.0) == pytest.approx(np.pi, rel=1e-12)


@pytest.mark.parametrize("gap", [PARABOLA, CORNER, EvenGap(np.array([0.0, 1.2]), np.array([1.0, 2.0]))])
def test_weighed_forces_are_integrals(gap):
    weighed, s = gap.weighed(4.0), np.array([0.5, 1.3, 2.0, 4.0])
    assert weighed(s, 1) == pytest.approx([gap.force(each) / each**2 for each in s.tolist()], abs=1e-6)
    for low, high in ((0.5, 1.3), (1.3, 4.0)):
        whole = quad(lambda s: gap.force(s) / s**2, low, high, points=[1.2] if low < 1.2 < high else None)[0]
        assert weighed(high) - weighed(low) == pytest.approx(whole, abs=1e-8)


def test_without_coupling_the_punch_changes_nothing():
    """p is 1/sqrt(1 - t^2)/pi."""
    angles = np.pi / 2 * (1 - np.linspace(1, 0, 801) ** 2)
    gap, s = CORNER.under(np.sin(angles), np.diff(angles) / np.pi, 0.0), np.array([1.1, 2.0, 10.0])
    assert gap.power == 1
    assert gap.rate(s) / gap.rate(np.array([1e3])) == pytest.approx(CORNER.rate(s) / CORNER.rate(np.array([1e3])), 1e-3)


@pytest.mark.parametrize("x", [1.05, 1.5, 4.0, 30.0])
def test_punches_close_the_gap(x):
    closes = closed(coupled(CORNER), x) / closed(coupled(CORNER), 8.0)
    assert closes == pytest.approx(1, abs=1e-3)


@pytest.mark.fault
def test_punches_without_coupling_leave_a_gap():
    """Deliberate fault: punches get the forces that close the gap of bodies that are not coupled."""
    closes = [closed(CORNER, x) / closed(CORNER, 8.0) for x in (1.05, 1.5)]
    assert np.abs(np.array(closes) - 1).max() > 0.03
