"""Order, extrapolation and grid convergence index of power laws, whose limit is known."""

import math

import numpy as np
import pytest

from partialslip.tools.convergence import extrapolated, fitted_order, grid_convergence_index, power


def values(order, ratio, count=3):
    """Of 2 + 3 h^order on meshes of this ratio; sizes, and values."""
    sizes = ratio ** -np.arange(count, dtype=float)
    return sizes, 2 + 3 * sizes**order


@pytest.mark.parametrize("ratio", [1.1, 2.0, 1e3])
@pytest.mark.parametrize("order", [0.5, 1.0, 3.0])
def test_a_trusted_order_bounds_the_error_by_a_quarter_more(order, ratio):
    sizes, found = values(order, ratio)
    changes = np.abs(np.diff(found))
    seen = fitted_order(sizes[1:], changes)
    assert seen == pytest.approx(order, rel=1e-5)
    assert extrapolated(*found) == pytest.approx(2, abs=1e-6)
    error = 3 * sizes[-1] ** order
    assert grid_convergence_index(changes[-1], ratio, order) == pytest.approx(1.25 * error, rel=1e-5)
    assert grid_convergence_index(changes[-1], ratio, order, order) == pytest.approx(1.25 * error, rel=1e-5)


def test_an_order_that_is_not_trusted_has_the_larger_factor():
    """Below 0.5, more than 0.5 above the formal order, or not observed at all; used is 0.5 to the formal order."""
    half = math.sqrt(2) - 1
    assert grid_convergence_index(1.0, 2, 0.3) == pytest.approx(3 / half)
    assert grid_convergence_index(1.0, 2, None) == pytest.approx(3 / half)
    assert grid_convergence_index(1.0, 2, 1.6, 1.0) == pytest.approx(3)
    assert grid_convergence_index(1.0, 2, 1.5, 1.0) == pytest.approx(1.25)
    assert grid_convergence_index(1.0, 2, 8.0) == pytest.approx(1.25 / 255)


def test_changes_that_vanish_are_left_out():
    assert fitted_order([1.0, 0.5, 0.25], [0.4, 0.0, 0.1]) == pytest.approx(1)
    assert fitted_order([1.0, 0.5], [0.0, 0.1]) is None
    assert math.isnan(power([1.0], [1.0]))
    assert math.isnan(power([2.0, 2.0], [1.0, 3.0]))


def test_ratios_beyond_any_number_end():
    assert grid_convergence_index(1.0, 1e308, 8.0) == 0
    assert grid_convergence_index(1.0, 1 + 3e-16, 0.5) > 1e15
