"""Errors of stresses along surfaces and inside bodies, on known fields."""

from dataclasses import replace

import known
import numpy as np
import pytest

from partialslip.judge.means import norm_errors
from partialslip.judge.stresses import inside_error, surface_error
from partialslip.result import DeformedBody, StressAt, SurfaceStress

POINTS = np.array([[0, 0], [1, 0], [0, -1], [2, 0], [0, -2.2], [3.2, 0.1], [3.7, 0.1], [3.7, -0.2]]) * known.A
TRIANGLES = np.array([[0, 1, 2], [1, 3, 4], [5, 6, 7]])  # areas 0.5 and 1.1 a^2, and one with its centroid at 3.5 a
AREAS = np.array([0.5, 1.1])


def surface(of=lambda x: 1.0 + 0 * x):
    """Both bodies, both load points: 1 to 4 times a function of x/a."""

    def at(x):
        return np.arange(1.0, 5.0).reshape(2, 2, 1) * of(x / known.A)

    x = np.linspace(-1.5, 1.5, 31) * known.A
    return SurfaceStress(x, at(x), at)


def stresses(x, y, _):
    """Stresses at two load points, three components; the second component is zero."""
    return np.array([[1, 0, 2], [3, 0, 4]])[:, :, None] * (1 + (x + 2 * y) / known.A)


def inside(add=(0.0, 0.0, 0.0)):
    """Return a body with the exact stresses, plus a perturbation of the first component at load point 2."""
    x, y = POINTS[TRIANGLES].mean(axis=1).T
    first, second = np.moveaxis(stresses(x, y, None), 2, 1)
    off = np.array(add)[:, None] * [1, 0, 0]
    return DeformedBody("lower", POINTS, TRIANGLES, {}, {}, {"1": first, "2": second + off})


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


@pytest.mark.parametrize("triangle", [0, 1])
def test_stress_inside_is_compared_by_area(triangle):
    true = replace(known.EXACT, stress_at=StressAt(stresses))
    add = np.zeros(3)
    add[triangle] = 0.3
    found = replace(known.result(), bodies=(inside(add), inside()))
    x, y = POINTS[TRIANGLES[:2]].mean(axis=1).T
    norm = 2 * ((stresses(x, y, None) ** 2).sum(axis=(0, 1)) @ AREAS)
    assert inside_error(found, true) == pytest.approx(0.3 * np.sqrt(AREAS[triangle] / norm), rel=1e-9)


def test_stress_beyond_three_half_widths_is_not_compared():
    true = replace(known.EXACT, stress_at=StressAt(stresses))
    assert inside_error(replace(known.result(), bodies=(inside((0, 0, 1.0)),)), true) == 0


def test_what_one_result_does_not_have_is_not_compared():
    with_bodies = replace(known.result(), bodies=(inside(),), surface=surface())
    assert inside_error(with_bodies, known.EXACT) is surface_error(with_bodies, known.EXACT) is None
    true = replace(known.EXACT, stress_at=StressAt(stresses), surface=surface())
    assert inside_error(known.result(), true) is surface_error(known.result(), true) is None
    without_cells = replace(with_bodies, traction=known.traction(cells=None))
    assert surface_error(without_cells, true) is None


def test_shear_that_all_but_vanishes_is_measured_in_pressure():
    """Errors of q are relative to at least 1e-3 of f p's norm, whatever other quantities are asked for."""
    true, off = known.traction(q=0.0), known.traction(q=1e-5)
    large = known.traction(q=1.0)
    norm = norm_errors(large, true, known.F, ("q",))["q"]
    assert norm_errors(off, true, known.F, ("q",))["q"] == pytest.approx(1e-5 * norm, rel=1e-9)
    p = norm_errors(known.traction(p=2.0), true, known.F, ("p",))["p"]
    assert p == pytest.approx(1.0, rel=1e-12)
    ratio = norm_errors(known.traction(q=2.0), large, known.F, ("q",))["q"]  # here q's norm is the larger
    assert ratio == pytest.approx(1.0, rel=1e-9)
    of_q, of_p = (known.traction(q=1.0, p=p).at(np.linspace(-1, 1, 4001) * known.A)[i] for i, p in ((1, 1.0), (0, 1.0)))
    assert norm == pytest.approx(np.linalg.norm(of_q / 2) / (1e-3 * known.F * np.linalg.norm(of_p)), rel=1e-2)
