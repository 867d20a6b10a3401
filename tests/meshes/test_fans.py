"""At least three triangles meet at each vertex inside the contact line, on the same line."""

import numpy as np
import pytest

from partialslip_meshes import block, fanned

WIDTH, REACH = 4.0, 1.0


@pytest.fixture(scope="module")
def mesh():
    return block(WIDTH, (-REACH, REACH), {-0.4: 0.01, 0.7: 0.02}, 0.7)


def at_vertices(mesh):
    """Number of triangles at each vertex inside the contact line."""
    ends, counts = np.unique(mesh.lines["contact"], return_counts=True)
    return np.bincount(mesh.triangles.ravel())[ends[counts == 2]]


def areas(mesh):
    first, second, third = mesh.points[mesh.triangles].transpose(1, 2, 0)
    (x, y), (u, v) = second - first, third - first
    return (x * v - y * u) / 2


def test_three_triangles_meet(mesh):
    assert at_vertices(mesh).min() == 2
    assert at_vertices(fanned(mesh)).min() == 3


def test_the_block_is_the_same(mesh):
    split = fanned(mesh)
    assert (areas(split) > 0).all()
    assert areas(split).sum() == pytest.approx(areas(mesh).sum(), rel=1e-12)
    assert (split.points[: len(mesh.points)] == mesh.points).all()
    assert all((split.lines[name] == mesh.lines[name]).all() for name in mesh.lines)
    sides = np.unique(split.edges, axis=0)
    # a mesh without hanging vertices: Euler's formula for a disc
    assert len(split.points) - len(sides) + len(split.triangles) == 1


def test_nothing_else_is_split(mesh):
    split = fanned(mesh)
    few = int((at_vertices(mesh) == 2).sum())
    assert 0 < len(split.points) - len(mesh.points) <= few
    assert fanned(split).triangles is split.triangles
