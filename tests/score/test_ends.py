"""Ends of zones are read from many windows at once, as from each window by itself."""

import numpy as np
import pytest

from partialslip.score import ends

WINDOWS = [np.arange(40 - count - skipped, 40 - skipped) for skipped in (0, 3, 9) for count in (3, 4, 5, 8, 24)]


def roots(x, values, windows, spacing=0.2):
    return ends._roots(x, values, np.full(len(x), 1e-3), windows, 1.5, spacing)


@pytest.fixture
def table():
    """Points, uneven, and the noisy square root that ends at x = 1."""
    random = np.random.default_rng(8)
    x = np.sort(random.uniform(0, 0.98, 40))
    return x, np.sqrt((1 - x) * (1 + 0.3 * x)) * (1 + 0.01 * random.normal(size=40))


def test_windows_together_are_as_one_by_one(table):
    """By NumPy's fit of one polynomial and its roots."""
    x, values = table
    for window, found in zip(WINDOWS, roots(x, values, WINDOWS), strict=True):
        last, y = x[window[-1]], values[window]
        assert len(found) == min(3, len(window) - 2)
        for degree, root in enumerate(found, 1):
            fit = np.polyfit(x[window] - last, y**2, degree, w=1 / np.maximum(y, 0.03 * y.max()))
            real = np.array([each.real for each in np.roots(fit) if each.imag == 0])
            real = real[(real > -0.2) & (real < 1.5 - last)]
            if root is None:
                assert len(real) == 0
                continue
            nearest = real[np.abs(real).argmin()]
            assert root.points == len(window)
            assert root.x == pytest.approx(last + nearest, abs=1e-9)
            assert root.slope == pytest.approx(np.polyval(np.polyder(fit), nearest), rel=1e-7)


def test_other_windows_do_not_matter(table):
    for window, found in zip(WINDOWS, roots(*table, WINDOWS), strict=True):
        for one, other in zip(*roots(*table, [window]), found, strict=True):
            assert one == other if None in (one, other) else one == pytest.approx(other, rel=1e-9, abs=1e-12)


def test_a_square_root_ends_where_it_does():
    """Polynomials of the second and third degree have no more than rounding to say."""
    x = np.linspace(0, 0.95, 40)
    for found in roots(x, np.sqrt(1 - x), WINDOWS):
        for root in found:
            assert root.x == pytest.approx(1, abs=1e-9)
            assert root.slope == pytest.approx(-1, abs=1e-6)


def test_too_few_points_tell_nothing():
    x = np.linspace(0, 0.95, 40)
    assert roots(x, np.sqrt(1 - x), []) == []
    assert roots(x, np.sqrt(1 - x), [np.array([38, 39])]) == [[]]
