"""Ends of zones below mesh size, and tractions from nodal forces, on functions known in closed form."""

import numpy as np
import pytest

from partialslip.friction.zone_ends import left_end, right_end
from partialslip_fem.elasticity import body
from partialslip_fem.recovery import traction
from partialslip_meshes import block


def forces_of_root(vertices, left, right):
    """Integrals over cells of (1 + x/3) sqrt((right-x)(x-left)), by fine quadrature."""
    nodes, weights = np.polynomial.legendre.leggauss(60)
    a, b = np.clip(vertices[:-1], left, right), np.clip(vertices[1:], left, right)
    angle = np.pi / 2 * (nodes + 1)
    x = (a + b)[:, None] / 2 - (b - a)[:, None] / 2 * np.cos(angle)
    values = (1 + x / 3) * np.sqrt(np.maximum((right - x) * (x - left), 0))
    return np.pi / 4 * (b - a) * (values * np.sin(angle) @ weights)


@pytest.mark.parametrize(("left", "right"), [(-0.8, 0.2), (-0.803, 0.197), (-0.31, 0.77)])
def test_ends_are_found_far_below_mesh_size(left, right):
    errors = []
    for h in (0.05, 0.025):
        vertices = np.arange(-1, 1 + h / 2, h)
        nodes = np.arange(-1, 1, h / 4)
        inside = nodes[(nodes > left) & (nodes < right)]
        forces = forces_of_root(vertices, left, right)
        found = left_end(vertices, forces, inside), right_end(vertices, forces, inside)
        errors.append(max(abs(found[0] - left), abs(found[1] - right)))
    assert errors[0] < 0.05 / 50
    assert errors[1] < errors[0] / 4  # quadratic fit: third order


@pytest.mark.parametrize("count", [1, 2, 3, 6])
def test_zone_of_few_nodes_is_placed_within_an_element(count):
    vertices = np.linspace(-1, 1, 21)
    nodes = np.linspace(-1, 1, 81)
    inside = nodes[30 : 30 + count]
    left, right = inside[0] - 0.01, inside[-1] + 0.01
    forces = forces_of_root(vertices, left, right)
    assert left_end(vertices, forces, inside) == pytest.approx(left, abs=0.1)
    assert right_end(vertices, forces, inside) == pytest.approx(right, abs=0.1)


def test_mirror_image():
    vertices = np.sort(np.random.default_rng(2).uniform(-1, 1, 41))
    inside = np.linspace(-0.6, 0.3, 50)
    forces = forces_of_root(vertices, -0.61, 0.31)
    mirrored = right_end(-vertices[::-1], forces[::-1], -inside[::-1])
    assert left_end(vertices, forces, inside) == pytest.approx(-mirrored, rel=1e-12)


@pytest.fixture(scope="module", params=[1, 2, 3, 4, 6])
def half(request):
    points = dict.fromkeys(np.linspace(-1, 1, 11).tolist(), 0.15)
    return body(block(5.0, (-1.2, 1.2), points, 0.6), kappa=1.8, order=request.param)


def test_traction_of_the_elements_order_is_recovered_exactly(half):
    shape = np.polynomial.Polynomial([1.0, -0.3, 0.7, 0.2, -0.5][: half.order + 1])
    found = traction(half, half.mass @ shape(half.x))
    x = np.linspace(-1.2, 1.2, 101)
    assert found(x) == pytest.approx(shape(x), abs=1e-11)


def test_resultant_is_kept(half):
    forces = np.where(np.abs(half.x) < 0.7, np.random.default_rng(0).random(len(half.x)), 0)
    assert traction(half, forces).integrate(-1.2, 1.2) == pytest.approx(forces.sum(), rel=1e-12)


@pytest.mark.fault
def test_dividing_by_weights_would_waver(half):
    """Deliberate fault: nodal forces over the integrals of their shape functions, off by h^2 p''."""
    smooth = np.cos(2 * half.x)
    load = half.mass @ smooth  # the load of the interpolant: its own recovery is exact
    if half.order > 4:
        pytest.skip("Lobatto's weights integrate products of the elements nearly exactly")
    divided = load / half.weights
    inner = np.abs(half.x) < 1
    assert np.abs(traction(half, load)(half.x) - smooth)[inner].max() < 1e-10
    assert np.abs(divided - smooth)[inner].max() > 1e-4
