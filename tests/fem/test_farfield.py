"""The half-plane's displacements: surface slopes, resultants, and what a block held by them is worth."""

import numpy as np
import pytest

from partialslip_fem.condensation import Condensation
from partialslip_fem.contact import CondensedBody, relative_compliances
from partialslip_fem.elasticity import body
from partialslip_fem.farfield import FarField, half_plane
from partialslip_meshes import block

KAPPA, WIDTH = 1.8, 6.0


@pytest.fixture(scope="module")
def points():
    angle = np.linspace(-np.pi / 2, np.pi / 2, 41)
    return WIDTH * np.vstack([np.sin(angle), -np.cos(angle)])


@pytest.mark.parametrize("s", [0.0, 0.9, -1.3])
def test_expansion_of_a_moved_force(points, s):
    """A force off the middle does what a force in the middle does, moved."""
    here = half_plane(points, np.array([s, 1.3]), WIDTH, KAPPA)
    moved = half_plane(points - np.array([[s], [0.0]]), np.array([0.0, 1.3]), WIDTH - abs(s), KAPPA)
    for column in (0, 2):  # a force along x, and along y, at s
        a = (here.fields @ here.moments[:, column]).reshape(2, -1)
        b = (moved.fields @ moved.moments[:, column]).reshape(2, -1)
        difference = a - b  # the logarithms are taken of lengths over different widths: a rigid translation
        assert difference - difference.mean(axis=1, keepdims=True) == pytest.approx(0, abs=1e-12)


def test_surface_slope_is_that_of_the_integral_equation():
    """Along the surface du/dx = -(A/2)/(pi x) under a unit force on one body, A = 1, on either side of it."""
    x = np.array([3.0, 3.0 + 1e-6, 5.0, 5.0 + 1e-6])
    for sign in (1, -1):
        far = half_plane(np.vstack([sign * x, 0 * x]), np.array([0.0, 0.5]), 3.0, KAPPA)
        for axis, column in ((0, 0), (1, 2)):
            u = (far.fields @ far.moments[:, column]).reshape(2, -1)[axis]
            slopes = (u[1::2] - u[::2]) / 1e-6
            assert slopes == pytest.approx(-0.5 / (np.pi * x[::2]), rel=1e-5)


def stress_resultant(s):
    """Force through a deep semicircle, by finite differences of the displacements, for a unit force along x, y."""
    mu, lam = (KAPPA + 1) / 2, (KAPPA + 1) / 2 * (3 - KAPPA) / (KAPPA - 1)
    angle = np.linspace(-np.pi / 2, np.pi / 2, 2001)
    normal = np.vstack([np.sin(angle), -np.cos(angle)])
    ring, h = 5 * normal, 1e-5

    def u(points):
        far = half_plane(points, np.array([s, 0.5]), 5.0, KAPPA)
        return [(far.fields @ far.moments[:, column]).reshape(2, -1) for column in (0, 2)]

    steps = [np.array([[h], [0.0]]), np.array([[0.0], [h]])]
    forces = []
    for case in range(2):
        gradient = np.stack([(u(ring + step)[case] - u(ring - step)[case]) / (2 * h) for step in steps])
        strain = (gradient + gradient.transpose(1, 0, 2)) / 2
        stress = 2 * mu * strain + lam * np.trace(strain) * np.eye(2)[:, :, None]
        traction = np.einsum("ijk,jk->ik", stress, normal)
        forces.append(np.trapezoid(traction, 5 * angle, axis=1))
    return np.array(forces)


def test_force_passes_through_every_ring():
    assert stress_resultant(0.4) == pytest.approx(-np.eye(2), abs=2e-6)


@pytest.fixture(scope="module")
def responses():
    """Relative displacements (but for rigid shifts) of points of the contact under one smooth traction, along x and y:
    the block held by the half-plane, by the first term of its expansion only, and clamped."""
    result, points = {}, np.linspace(-1, 1, 9)
    for width in (5.0, 10.0, 20.0, 40.0):
        mesh = block(width, (-1.0, 1.0), dict.fromkeys(points.tolist(), 0.1), 0.25)
        half = body(mesh, KAPPA, 4)
        far = half_plane(half.held_points, half.x, width, KAPPA)
        first = [0, far.fields.shape[1] // 2]
        monopole = FarField(far.fields[:, first], far.moments[first])
        forces = half.mass @ ((1 + half.x) * (1 - half.x**2) ** 2)
        nodes = np.searchsorted(half.x, points - 1e-9)
        for name, field in (("half-plane", far), ("monopole", monopole), ("box", None)):
            C = relative_compliances([CondensedBody(mesh, half, Condensation(half, field))])
            moved = [(c @ forces)[nodes] for c in (C.xx, C.yy)]
            result[name, width] = [u - u.mean() for u in moved]
    return result


def off(responses, name, width, axis):
    exact = responses["half-plane", 40.0][axis]
    return np.abs(responses[name, width][axis] - exact).max() / np.abs(exact).max()


@pytest.mark.parametrize("axis", [0, 1])
def test_half_plane_boundary_makes_the_width_irrelevant(responses, axis):
    for width in (5.0, 10.0, 20.0):
        assert off(responses, "half-plane", width, axis) < 2e-5  # the meshes differ by that much


@pytest.mark.parametrize("axis", [0, 1])
def test_clamped_box_is_of_second_order(responses, axis):
    ratios = [off(responses, "box", w, axis) / off(responses, "box", 2 * w, axis) for w in (5.0, 10.0)]
    assert ratios == pytest.approx([4, 4], rel=0.3)


@pytest.mark.fault
@pytest.mark.parametrize("axis", [0, 1])
def test_without_the_dipole_the_boundary_is_far_worse(responses, axis):
    """Deliberate fault: only the resultant force in the far field."""
    assert off(responses, "monopole", 5.0, axis) > 100 * off(responses, "half-plane", 5.0, axis)
