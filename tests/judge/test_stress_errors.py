"""Errors of stresses along surfaces and inside bodies, on known fields."""

from dataclasses import replace

import known
import numpy as np
import pytest

from partialslip.result import StressAt, SurfaceStress
from partialslip.run.judge.measures import inside_error, surface_error


def surface(of=lambda x: 1.0 + 0 * x):
    """Both bodies, both load points: 1 to 4 times a function of x/a."""

    def at(x):
        return np.arange(1.0, 5.0).reshape(2, 2, 1) * of(x / known.A)

    x = np.linspace(-1.5, 1.5, 31) * known.A
    return SurfaceStress(x, at(x), at)


def stresses(x, y, _):
    """Stresses at two load points, three components; the second component is zero."""
    return np.array([[1, 0, 2], [3, 0, 4]])[:, :, None] * (1 + (x + 2 * y) / known.A)


def inside(off=0.0, within=np.inf):
    """Stresses, off by ``off`` in sigma_xx at load point 2 at points ``within`` this height."""

    def found(x, y, phases):
        result = stresses(x, y, phases)
        result[1, 0] += off * (np.abs(y) < within * known.A)
        return result

    return StressAt(found)


def test_stress_along_the_surface_is_compared_by_cell_means():
    true = replace(known.EXACT, surface=surface())
    assert surface_error(replace(known.result(), surface=surface()), true) == 0
    found = replace(known.result(), surface=surface(lambda x: 1 + 0.2 * (np.abs(x) < 1)))  # on 2 of 2.2 a
    assert surface_error(found, true) == pytest.approx(0.2 * np.sqrt(2 / 2.2), rel=0.03)
    there_and_back = replace(known.result(), surface=surface(lambda x: 1 + 0.5 * np.sin(40 * np.pi / 2.2 * 2 * x)))
    assert surface_error(there_and_back, true) < 0.05  # whole waves in each cell


def test_uneven_cells_count_by_their_widths():
    cells = np.array([-1.1, 0.0, 0.1, 1.1]) * known.A
    wide, narrow = (surface(lambda x, b=bounds: 1 + 0.1 * ((x > b[0]) & (x < b[1]))) for bounds in ((-2, 0), (0, 0.1)))
    of = replace(known.traction(), cells=cells, breaks=cells)
    true = replace(known.EXACT, surface=surface(), traction=replace(known.traction(), breaks=cells))
    errors = [surface_error(replace(known.result(of=of), surface=each), true) for each in (wide, narrow)]
    assert errors == pytest.approx([0.1 * np.sqrt(1.1 / 2.2), 0.1 * np.sqrt(0.1 / 2.2)], rel=1e-9)


@pytest.mark.parametrize("within", [3.0, 1.0])
def test_stress_inside_is_compared_by_area(within):
    """The mean square of 1 + (x + 2 y)/a over |x|, |y| < 3 a is 1 + 5 . 3; the four components are 1, 2, 3 and 4 times
    that."""
    true = replace(known.EXACT, stress_at=inside())
    found = replace(known.result(), stress_at=inside(0.3, within))
    expected = 0.3 * np.sqrt(within / 3) / np.sqrt(30 * (1 + 5 * 3))
    assert inside_error(found, true) == pytest.approx(expected, rel=1e-3)
    assert inside_error(true, true) == 0


def test_points_outside_a_body_do_not_count():
    def finite(x, y, phases):
        return np.where(y < 0, stresses(x, y, phases), np.nan)

    true = replace(known.EXACT, stress_at=inside())
    assert inside_error(replace(known.result(), stress_at=StressAt(finite)), true) == 0
