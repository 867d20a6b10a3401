"""The block recipe, fans at the contact line, and what is written through meshio."""

import gmsh
import meshio
import numpy as np
import pytest

from partialslip.result import DeformedBody
from partialslip_meshes import block, fanned
from partialslip_meshes.write import write_msh, write_vtu

POINTS = {-1.0: 0.01, -0.8: 0.01, 0.2: 0.02, 1.0: 0.01}


@pytest.fixture(scope="module")
def mesh():
    return block(16.0, (-1.1, 1.2), POINTS, 0.5)


def areas(points, triangles):
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    return ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2


def test_fills_the_block_once(mesh):
    signed = areas(mesh.points, mesh.triangles)
    assert (signed > 0).all()
    assert signed.sum() == pytest.approx(32 * 16, rel=1e-12)
    assert set(np.unique(mesh.triangles)) == set(range(len(mesh.points)))


def test_lines(mesh):
    contact, *far = (mesh.points[mesh.lines[name]] for name in ("contact", "back", "left", "right"))
    far = np.vstack(far)
    lengths = {
        name: np.linalg.norm(np.diff(ends, axis=1), axis=-1).sum() for name, ends in (("c", contact), ("f", far))
    }
    assert lengths["c"] == pytest.approx(2.3, rel=1e-12)
    assert lengths["f"] == pytest.approx(32 + 2 * 16, rel=1e-12)
    assert not contact[..., 1].any()
    x = np.unique(contact[..., 0])
    assert set(POINTS) <= set(x.tolist())
    assert (x[0], x[-1]) == (-1.1, 1.2)


def test_sizes_grow_from_the_points(mesh):
    x = np.unique(mesh.points[mesh.lines["contact"]][..., 0])
    for point, size in POINTS.items():
        place = np.searchsorted(x, point)
        assert size / 2 < x[place + 1] - x[place] < 2 * size
    width = np.diff(x)
    distance = np.min(np.abs((x[1:] + x[:-1])[:, None] / 2 - list(POINTS)), axis=1)
    assert np.all(width < 2 * (0.02 + 0.5 * distance))


def test_wide_blocks_cost_the_logarithm_of_their_width(mesh):
    wide = block(4096.0, (-1.1, 1.2), POINTS, 0.5)
    assert len(wide.triangles) < 1.5 * len(mesh.triangles)


@pytest.fixture(scope="module")
def bodies(mesh):
    shift = np.column_stack([mesh.points[:, 0], 0 * mesh.points[:, 0]])
    fields = {"displacement_1": shift, "displacement_2": -2 * shift}
    lower = DeformedBody("lower", mesh.points, mesh.triangles, mesh.lines, fields)
    upper = DeformedBody("upper", mesh.points * [1, -1], mesh.triangles[:, ::-1], mesh.lines, fields)
    return lower, upper


def test_msh_is_read_back_by_meshio_and_gmsh(bodies, tmp_path):
    path = tmp_path / "mesh.msh"
    write_msh(path, bodies[0])
    back = meshio.read(path)
    assert back.points[:, :2] == pytest.approx(bodies[0].points)
    assert back.cells_dict["triangle"].tolist() == bodies[0].triangles.tolist()
    assert set(back.field_data) == {"lower", "contact", "face", "back", "left", "right"}
    gmsh.initialize([], readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(path))
        names = {gmsh.model.getPhysicalName(*group) for group in gmsh.model.getPhysicalGroups()}
        assert names == {"lower", "contact", "face", "back", "left", "right"}
        assert len(gmsh.model.mesh.getNodes()[0]) == len(bodies[0].points)
    finally:
        gmsh.finalize()


def test_vtu_holds_both_bodies(bodies, tmp_path):
    path = tmp_path / "bodies.vtu"
    write_vtu(path, bodies)
    back = meshio.read(path)
    assert len(back.points) == 2 * len(bodies[0].points)
    assert np.bincount(back.cell_data["body"][0]).tolist() == [len(body.triangles) for body in bodies]
    n = len(bodies[0].points)
    assert back.point_data["displacement_2"][:n, :2] == pytest.approx(bodies[0].displacements["displacement_2"])
    assert (areas(back.points[:, :2], back.cells_dict["triangle"]) > 0).all()


@pytest.fixture(scope="module")
def coarse():
    return block(4.0, (-1.0, 1.0), {-0.4: 0.01, 0.7: 0.02}, 0.7)


def at_vertices(mesh):
    """Number of triangles at each vertex inside the contact line."""
    ends, counts = np.unique(mesh.lines["contact"], return_counts=True)
    return np.bincount(mesh.triangles.ravel())[ends[counts == 2]]


def test_at_least_three_triangles_meet_at_the_contact_line_and_nothing_else_is_split(coarse):
    split, few = fanned(coarse), int((at_vertices(coarse) == 2).sum())
    assert (at_vertices(coarse).min(), at_vertices(split).min()) == (2, 3)
    assert 0 < len(split.points) - len(coarse.points) <= few
    assert fanned(split).triangles is split.triangles


def test_the_block_with_fans_is_the_same(coarse):
    split = fanned(coarse)
    before, after = (areas(each.points, each.triangles) for each in (coarse, split))
    assert (after > 0).all()
    assert after.sum() == pytest.approx(before.sum(), rel=1e-12)
    assert (split.points[: len(coarse.points)] == coarse.points).all()
    assert all((split.lines[name] == coarse.lines[name]).all() for name in coarse.lines)
    # a mesh without hanging vertices: Euler's formula for a disc
    assert len(split.points) - len(np.unique(split.edges, axis=0)) + len(split.triangles) == 1
