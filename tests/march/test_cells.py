"""Cells of constant shear: grading, forces and compliance."""

import numpy as np
import pytest

from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.punch import Punch
from partialslip.march.cells import cells_around, compliance, forces, friction_on, graded_cells
from partialslip.scene import Friction

POINTS = np.array([-1.0, -0.8, 0.2, 1.0])


@pytest.mark.parametrize(("size", "growth"), [(1e-2, 0.2), (1e-5, 0.05)])
def test_cells_grow_from_the_points(size, growth):
    vertices = graded_cells(POINTS, size, growth)
    widths = np.diff(vertices)
    assert (widths > 0).all()
    assert np.isin(POINTS, vertices).all()
    middle = (vertices[1:] + vertices[:-1]) / 2
    distance = np.abs(middle[:, None] - POINTS).min(axis=1)
    assert np.all(widths <= 1.5 * (size + growth * distance))
    assert np.all(widths >= 0.4 * (size + growth * distance))


@pytest.mark.parametrize("shape", [HertzShape(), Punch(0.5)])
def test_forces_are_the_integrals_of_the_pressure(shape):
    vertices = graded_cells(np.array([-1.0, -0.5, 0.5, 1.0]), 1e-3, 0.1)
    pressed = forces(shape, vertices)
    assert pressed.sum() == pytest.approx(1, abs=1e-11)
    inner = np.abs(vertices[1:] + vertices[:-1]) < 1.6
    middle = (vertices[1:] + vertices[:-1]) / 2
    midpoint = shape.pressure(middle) * np.diff(vertices) * 2 / np.pi
    assert pressed[inner] == pytest.approx(midpoint[inner], rel=2e-3)


def test_forces_of_cells_with_kinks_inside_add_up():
    """Weak kinks of a table are no ends of cells. Deliberate fault: cells are not cut there."""
    shape = Punch([0.1, 0.4, 0.7], [1.0, 0.04, 0.03], np.arccos([0.1, 0.4, 0.7]))
    vertices = np.linspace(-1, 1, 12)
    fine = np.linspace(-1, 1, 11 * 1000 + 1)
    pressed, cells = forces(shape, vertices), forces(shape, fine).reshape(-1, 1000).sum(axis=1)
    assert pressed.sum() == pytest.approx(1, abs=1e-14)  # room for shear just short of sliding
    assert pressed == pytest.approx(cells, rel=1e-4)
    shape.kinks = ()
    assert np.abs(forces(shape, vertices) / cells - 1).max() > 1e-4


def test_compliance_of_far_cells_is_the_exact_mean():
    """Against the closed form in more digits, which double precision would lose at a distance."""
    vertices = graded_cells(POINTS / 2, 1e-3, 0.1)
    v = vertices.astype(np.longdouble)
    low, high = v[:-1], v[1:]

    def primitive(z):
        return z**2 / 2 * np.log(np.abs(z) + (z == 0)) - 3 * z**2 / 4

    pairs = [(high, low, 1), (low, high, 1), (high, high, -1), (low, low, -1)]
    total = sum(sign * primitive(x[:, None] - s) for x, s, sign in pairs)
    exact = -total / (high - low)[:, None] / (high - low) / np.pi
    assert np.abs(compliance(vertices) - exact).max() < 1e-11


def test_compliance_is_positive_definite_on_strongly_graded_cells():
    C = compliance(graded_cells(POINTS / 2, 1e-6, 0.1))
    assert np.abs(C - C.T).max() == 0
    assert np.linalg.eigvalsh(C)[0] > 0.01


def test_adhered_traction():
    """A contact that sticks everywhere under tension carries q = x sigma/(4 sqrt(a^2 - x^2)) (paper, eq. (1))."""
    vertices = graded_cells(np.array([-0.5, 0.5]), 1e-4, 0.05)
    x, widths = (vertices[1:] + vertices[:-1]) / 2, np.diff(vertices)
    q = np.linalg.solve(compliance(vertices), x / 4) / widths
    inner = np.abs(x) < 0.49
    assert q[inner] == pytest.approx((x / 4 / np.sqrt(0.25 - x**2))[inner], rel=2e-3, abs=2e-4)


def test_no_dip_of_friction_is_left_out():
    """Each kink of f is an end of a cell, with several cells up to the next one, however coarse the mesh."""
    kinks = [-0.3, -0.3 + 5e-5, -0.3 + 1e-4, 0.6]
    vertices = cells_around([-1.0, 1.0], (1e-2, 0.2), bends=kinks, at_bends=32.0)
    at = np.searchsorted(vertices, kinks)
    assert np.array_equal(vertices[at], kinks)
    assert np.diff(at).min() >= 5
    assert len(vertices) < 300


def test_friction_on_cells_keeps_its_integral():
    """Also where a dip lies inside a cell. Deliberate fault: the coefficient in the middle of the cell."""
    friction = Friction(f=(0.5, 0.5, 0.05, 0.5, 0.5), x=(-1.0, 0.2, 0.201, 0.202, 1.0))
    places = np.linspace(-0.9, 0.9, 10)
    mean = friction_on(friction, places)
    assert mean @ np.diff(places) == pytest.approx(0.5 * 1.8 - 0.45 * 0.001, rel=1e-13)
    middle = friction.at((places[1:] + places[:-1]) / 2)
    assert abs(middle @ np.diff(places) - 0.9) < 1e-13
