"""Meshes of other tools: what is read is what was written, in every format; what cannot be meant is one line."""

import itertools
import re

import meshio
import numpy as np
import pytest
from refusing import line_of

from partialslip.tools.errors import InputError, MissingLibraryError
from partialslip_meshes import block, read

FIELD = "bodies.lower.mesh"


@pytest.fixture(scope="module")
def mesh():
    return block(4.0, (-2.0, 2.0), {0.0: 0.4}, 0.4, 2.0)


def in_space(points):
    return np.column_stack([points, 0 * points[:, 0]])


def physical_groups(mesh, path, points, triangles):
    lines = np.concatenate([*mesh.lines.values()])
    tags = np.repeat(np.arange(1, len(mesh.lines) + 1), [len(edges) for edges in mesh.lines.values()])
    data = [np.full(len(triangles), 9), tags]
    names = {name: np.array([tag, 1]) for tag, name in enumerate(mesh.lines, start=1)}
    data = {"gmsh:physical": data, "gmsh:geometrical": data}
    cells = [("triangle", triangles), ("line", lines)]
    meshio.write(path, meshio.Mesh(points, cells, cell_data=data, field_data=names), file_format="gmsh22", binary=True)


def element_sets(mesh, path, points, triangles):
    ends = np.cumsum([0, *(len(edges) for edges in mesh.lines.values())])
    pairs = itertools.pairwise(ends)
    sets = {name.upper(): [[], np.arange(*pair)] for name, pair in zip(mesh.lines, pairs, strict=True)}
    cells = [("triangle", triangles), ("line", np.concatenate([*mesh.lines.values()]))]
    meshio.write(path, meshio.Mesh(points, cells, cell_sets=sets))


def node_sets(mesh, path, points, triangles):
    sets = {name: np.unique(edges) for name, edges in mesh.lines.items()}
    meshio.write(path, meshio.Mesh(points, [("triangle", triangles)], point_sets=sets))


def families(mesh, path, points, triangles):
    tags = -np.repeat(np.arange(1, len(mesh.lines) + 1), [len(edges) for edges in mesh.lines.values()])
    cells = [("triangle", triangles), ("line", np.concatenate([*mesh.lines.values()]))]
    salome = meshio.Mesh(points[:, :2], cells, cell_data={"cell_tags": [np.full(len(triangles), -9), tags]})
    salome.cell_tags = {-tag: [name] for tag, name in enumerate(mesh.lines, start=1)}
    meshio.write(path, salome)


def cell_data(mesh, path, points, triangles):
    lines = np.concatenate([*mesh.lines.values()])
    where = np.repeat(np.arange(len(mesh.lines)), [len(edges) for edges in mesh.lines.values()])
    data = {name: [np.zeros(len(triangles)), 1.0 * (where == place)] for place, name in enumerate(mesh.lines)}
    meshio.write(path, meshio.Mesh(points, [("triangle", triangles), ("line", lines)], cell_data=data))


def point_data(mesh, path, points, triangles):
    data = {name: 1.0 * np.isin(np.arange(len(points)), edges) for name, edges in mesh.lines.items()}
    meshio.write(path, meshio.Mesh(points, [("triangle", triangles)], point_data=data))


WAYS = [
    (physical_groups, ".msh"), (element_sets, ".inp"), (node_sets, ".inp"), (families, ".med"), (cell_data, ".vtu"),
    (point_data, ".vtu"),
]  # fmt: skip


@pytest.fixture(scope="module")
def write(mesh, tmp_path_factory):
    """Write the mesh, some of it otherwise; returns the path."""

    def written(way=node_sets, suffix=".inp", points=None, triangles=None):
        path = tmp_path_factory.mktemp("meshes") / f"body{suffix}"
        points = in_space(mesh.points) if points is None else points
        way(mesh, path, points, mesh.triangles if triangles is None else triangles)
        return str(path)

    return written


def edges(lines):
    return {name: sorted(map(tuple, np.sort(pairs, axis=1).tolist())) for name, pairs in lines.items()}


@pytest.mark.parametrize(("way", "suffix"), WAYS)
def test_what_is_read_is_what_was_written(mesh, write, way, suffix):
    back = read(FIELD, write(way, suffix))
    assert np.array_equal(back.points, mesh.points)
    assert np.array_equal(back.triangles, mesh.triangles)
    assert edges(back.lines) == edges(mesh.lines)


def test_unit_side_order_and_spare_nodes_do_not_matter(mesh, write):
    """In mm, above its contact line, some elements clockwise, and two nodes of no element."""
    points = np.vstack([in_space(mesh.points * [1e3, -1e3] + [0, 40]), [[9e3, 9e3, 0], [0, 0, 0]]])
    triangles = mesh.triangles.copy()
    triangles[::3] = triangles[::3, ::-1]
    back = read(FIELD, write(points=points, triangles=triangles), 1e-3)
    assert back.points == pytest.approx(mesh.points, abs=1e-14)
    assert edges(back.lines) == edges(mesh.lines)
    a, b, c = (back.points[back.triangles[:, corner]] for corner in range(3))
    assert (np.linalg.det(np.stack([b - a, c - a], axis=1)) > 0).all()


def test_quadratic_elements_are_read_by_their_corners(mesh, write):
    sides = np.concatenate([np.sort(mesh.triangles[:, pair], axis=1) for pair in ([0, 1], [1, 2], [2, 0])])
    unique, number = np.unique(sides, axis=0, return_inverse=True)
    middles = len(mesh.points) + number.reshape(3, -1).T
    points = in_space(np.vstack([mesh.points, mesh.points[unique].mean(axis=1)]))

    def quadratic(_, path, points, triangles):
        sets = {name: np.unique(pairs) for name, pairs in mesh.lines.items()}
        meshio.write(path, meshio.Mesh(points, [("triangle6", triangles)], point_sets=sets))

    back = read(FIELD, write(quadratic, points=points, triangles=np.hstack([mesh.triangles, middles])))
    assert np.array_equal(back.points, mesh.points)
    with pytest.raises(InputError, match="must be in order: corners, then middles"):
        read(FIELD, write(quadratic, points=points, triangles=np.hstack([middles, mesh.triangles])))


def test_what_is_held_bears_no_contact(write):
    """A contact line that goes on to the corners of a body whose sides are held ends an element before."""

    def whole(mesh, path, points, triangles):
        sets = {name: np.unique(edges) for name, edges in mesh.lines.items() if name != "face"}
        sets["contact"] = np.flatnonzero(points[:, 1] == 0)
        meshio.write(path, meshio.Mesh(points, [("triangle", triangles)], point_sets=sets))

    path, full = write(whole), {}
    for needed in (("back",), ("back", "left", "right")):
        back = read(FIELD, path, needed=needed)
        full[len(needed)] = back.points[np.unique(back.lines["contact"]), 0]
    assert (full[1].min(), full[1].max()) == (-4, 4)
    assert sorted(full[3]) == sorted(full[1])[1:-1]


def strip(path, order=(0, 1, 2, 3), columns=12, bend=0.0):
    """A strip of quadrilaterals."""
    x, y = np.meshgrid(np.linspace(-3, 3, columns + 1), [-1.0, 0.0])
    points = np.column_stack([x.ravel(), y.ravel() - bend * x.ravel() ** 2, 0 * x.ravel()])
    start = np.arange(columns)
    ring = np.column_stack([start, start + 1, start + columns + 2, start + columns + 1])
    sets = {"contact": np.arange(columns + 1, 2 * columns + 2), "Back": np.arange(columns + 1)}
    meshio.write(path, meshio.Mesh(points, [("quad", ring[:, list(order)])], point_sets=sets))
    return str(path)


def test_quadrilaterals_are_split(tmp_path):
    back = read(FIELD, strip(tmp_path / "strip.inp"))
    assert len(back.triangles) == 24
    assert [len(back.lines[name]) for name in ("contact", "back")] == [12, 12]
    with pytest.raises(InputError, match="must be in order around convex ones"):
        read(FIELD, strip(tmp_path / "bow-tie.inp", order=(0, 1, 3, 2)))


def test_face_has_the_shape_it_is_said_to_have(tmp_path):
    bent = strip(tmp_path / "bent.inp", bend=0.02)
    back = read(FIELD, bent, face=lambda x: 0.02 * x**2)
    assert back.points[back.lines["contact"], 1].max() == 0
    with pytest.raises(InputError, match=r"must be flat \(or kind 'pad'\); it is off by 0.03 of its length"):
        read(FIELD, bent)
    with pytest.raises(InputError, match="must be of the profile's shape"):
        read(FIELD, bent, face=lambda x: 0.03 * x**2)


def without(sets, name):
    return lambda mesh, path, points, triangles: meshio.write(
        path,
        meshio.Mesh(points, [("triangle", triangles)],
         point_sets={key: np.unique(pairs) for key, pairs in mesh.lines.items() if key != name} | sets),
    )  # fmt: skip


def displaced(points, node, where):
    moved = points.copy()
    moved[node] = where
    return moved


def spoilt(mesh):
    """What is said of it, and what is written."""
    points, triangles, contact = in_space(mesh.points), mesh.triangles, np.unique(mesh.lines["contact"])
    on_boundary = np.unique(np.concatenate([*mesh.lines.values()]))
    inner = int(np.setdiff1d(np.arange(len(points)), on_boundary)[0])
    beside = triangles[(triangles == inner).any(axis=1)]
    across = points[np.setdiff1d(beside, [inner])].max(axis=0) + np.array([1.0, 0.1, 0])
    yield r"8 nodes have others", {"points": displaced(points, slice(3, 11), np.nan)}
    yield "must lie in a plane z = const", {"points": points + np.array([0, 0, 1]) * (points[:, [0]] > 0)}
    yield "must have triangles or quadrilaterals", {"triangles": triangles[:0]}
    yield "at .* edges two are on the same side", {"points": displaced(points, inner, across)}
    yield "at .* edges two are on the same side", {"triangles": np.vstack([triangles, triangles[:1]])}
    flat = np.vstack([triangles, triangles[:1, [0, 1, 1]]])
    yield "must have elements with an area; 1 have none", {"triangles": flat}
    away = points + np.array([20.0, 0, 0])
    two = {"points": np.vstack([points, away]), "triangles": np.vstack([triangles, triangles + len(points)])}
    yield "must be one piece, connected by common nodes, not 2", two
    yield "must have a group 'contact' of edges or nodes", {"way": without({}, "contact")}
    yield "must have a group 'back'", {"way": without({}, "back")}
    yield "an edge is in two of the groups", {"way": without({"BACK": contact}, "back")}
    yield "'contact' must be one line from left", {"way": without({"contact": np.delete(contact, 4)}, "contact")}
    yield "'contact' must have at least 4 edges, not 1", {"way": without({"contact": contact[[0, 2, -1]]}, "contact")}

    right = mesh.lines["right"]
    corner = without({"face": np.unique(np.vstack([mesh.lines["face"], right]))}, "right")
    yield "'face' must go on from both ends of group 'contact'", {"way": corner}
    a, b, c = triangles[inside(mesh)]
    halves = np.vstack([np.delete(triangles, inside(mesh), axis=0), [[a, len(points), c], [len(points), b, c]]])
    hanging = {"points": np.vstack([points, points[[a, b]].mean(axis=0)]), "triangles": halves}
    yield "must have elements that share whole sides; cracks between elements: 1", hanging
    unmerged = {"points": np.vstack([points, points[[inner]]]), "triangles": split(triangles, inner, len(points))}
    yield "must have no two nodes at one place; .* of others: 1", unmerged


def inside(mesh):
    """Number of a triangle that has no node on the boundary."""
    nodes = np.unique(np.concatenate([*mesh.lines.values()]))
    return int(np.flatnonzero(~np.isin(mesh.triangles, nodes).any(axis=1))[0])


def split(triangles, node, twin):
    """Triangles of which two neighbours at ``node`` have the ``twin`` in place of it."""
    changed, around = triangles.copy(), np.flatnonzero((triangles == node).any(axis=1))
    first = around[0]
    ends = np.setdiff1d(triangles[first], [node])
    second = next(each for each in around[1:] if np.isin(ends, triangles[each]).any())
    for number in (first, second):
        changed[number][triangles[number] == node] = twin
    return changed


def test_spoilt_meshes_are_refused_in_one_line(mesh, write):
    for why, what in spoilt(mesh):
        told = line_of(read, FIELD, write(**what))
        assert re.search(why, told)
        assert told.startswith(f"{FIELD} = '")


@pytest.mark.parametrize(("path", "why"), [
    ("no-such.msh", "cannot be read: No such file or directory"),
    ("body.stl", "must be a file .msh, .inp, .med or .vtu"), (".", "must be a file .msh"),
    ("nul\0.msh", "cannot be read"),
])  # fmt: skip
def test_files_that_are_not_there(path, why):
    with pytest.raises(InputError, match=why):
        read(FIELD, path)


def test_library_for_med_is_named(write, monkeypatch):
    path = write(families, ".med")
    monkeypatch.setitem(__import__("sys").modules, "h5py", None)
    with pytest.raises(MissingLibraryError, match=r"h5py is missing; pip install partialslip\[med\]"):
        read(FIELD, path)
