"""Cauchy integrals of piecewise polynomials."""

import numpy as np
import pytest

from partialslip.result import below
from partialslip.result.below import PiecewiseCauchy

DEPTHS = 10.0 ** np.arange(-12, 1)


def graded():
    """Cells on [-1, 1], as small as 1e-5 at both ends and in the middle."""
    steps = 1e-5 * 1.35 ** np.arange(35)
    half = np.append(0, np.cumsum(steps)) / steps.sum() / 2
    half = np.append(half, 1 - half[-2::-1])
    return np.append(half - 1, half[1:])


def points(vertices, seed=0):
    random = np.random.default_rng(seed)
    x = np.concatenate([random.uniform(-1.5, 1.5, 40), random.choice(vertices, 20)])
    return x - 1j * random.choice(DEPTHS, len(x))


def power(k, z):
    """(1/pi) int t^k/(t - z) dt over [-1, 1] and the derivative, in closed form (near the interval)."""
    logarithm = np.log((z - 1) / (z + 1))
    rest = sum(2 / (j + 1) * z ** (k - 1 - j) for j in range(0, k, 2))
    value = z**k * logarithm + rest
    slope = k * z ** max(k - 1, 0) * logarithm + z**k * 2 / (z**2 - 1)
    slope = slope + sum(2 / (j + 1) * (k - 1 - j) * z ** max(k - 2 - j, 0) for j in range(0, k, 2))
    return np.array([value, slope]) / np.pi


@pytest.mark.parametrize("degree", range(6))
def test_one_polynomial_on_many_cells(degree):
    vertices = graded()
    about_left = [np.polynomial.polynomial.polypow([left, 1.0], degree)[::-1] for left in vertices[:-1]]
    one = [[0.0] * degree + [1.0]] * (len(vertices) - 1)
    rows = np.array([about_left, one]).transpose(0, 2, 1)
    z = points(vertices)
    found = PiecewiseCauchy(vertices, rows)(z)
    for row, k in enumerate((degree, 0)):
        value, slope = power(k, z)
        assert found[0, row] == pytest.approx(value, rel=0, abs=1e-11)
        assert found[1, row] * z.imag == pytest.approx(slope * z.imag, rel=0, abs=1e-10)


def test_far_away_the_moments_count():
    vertices = graded()
    rows = np.stack([np.ones((1, len(vertices) - 1)), np.zeros((1, len(vertices) - 1))])
    z = np.array([1e3 - 1e3j, 1e6j, -1e9])
    found = PiecewiseCauchy(vertices, rows)(z)
    assert found[0, 0] == pytest.approx(-2 / np.pi / z, rel=1e-6)
    assert found[1, 0] == pytest.approx(2 / np.pi / z**2, rel=1e-6)
    assert not found[:, 1].any()


def test_cells_on_a_slope_are_turned_cells():
    """On the line t + i m t: dt is along/(1 + i m) of the complex step, and the integral that of turned points."""
    vertices, m = graded(), 0.3
    rows = np.ones((1, 1, len(vertices) - 1))
    z = points(vertices)
    turned = PiecewiseCauchy(vertices * (1 + 1j * m), rows)(z * (1 + 1j * m))
    flat = PiecewiseCauchy(vertices, rows)(z)
    assert turned[0] * (1 + 1j * m) == pytest.approx(flat[0], rel=1e-9)
    assert turned[1] * (1 + 1j * m) ** 2 * z.imag == pytest.approx(flat[1] * z.imag, rel=1e-7, abs=1e-9)


def test_no_points_and_one_cell():
    cauchy = PiecewiseCauchy(np.array([-1.0, 1.0]), np.ones((1, 1, 1)))
    assert cauchy(np.array([], complex)).shape == (2, 1, 0)
    assert cauchy(np.array([0.2 - 0.1j]))[:, 0, 0] == pytest.approx(power(0, np.array([0.2 - 0.1j]))[:, 0], rel=1e-14)


def test_work_is_that_of_the_functions_asked_for(monkeypatch):
    """Stresses at two of 2,000 load steps cost as much as those of two."""
    vertices, random, asked = graded(), np.random.default_rng(3), [5, 1]
    rows = random.standard_normal((7, 3, len(vertices) - 1))
    cauchy, z = PiecewiseCauchy(vertices, rows), points(vertices)
    every, closed, counts = cauchy(z), cauchy._closed, set()

    def counted(local, *others):
        counts.add(len(local))
        return closed(local, *others)

    monkeypatch.setattr(cauchy, "_closed", counted)
    assert cauchy(z, asked) == pytest.approx(every[:, asked], rel=1e-12, abs=1e-12)
    assert counts == {2}


@pytest.mark.fault
def test_near_cells_left_to_the_moments_are_caught(monkeypatch):
    """Deliberate fault: cells near a point taken by the forces at the nodes of their group."""
    monkeypatch.setattr(below, "_NEAR", 2.5)
    with pytest.raises(AssertionError):
        test_one_polynomial_on_many_cells(0)
