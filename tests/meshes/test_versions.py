"""Files that gmsh writes, in all its versions, and what a file with two bodies says of them."""

import itertools
import re

import gmsh
import numpy as np
import pytest
from refusing import line_of

from partialslip_meshes import quad_block, read
from partialslip_meshes.write import write_quads

FIELD = "bodies.lower.mesh"
GROUPS = {"back": 0, "right": 1, "contact": 3, "left": 5}
VERSIONS = [
    (version, binary, every, parametric)
    for version, binary, every, parametric in itertools.product((2.2, 4.0, 4.1), (0, 1), (0, 1), (0, 1))
    if not (version == 4.0 and binary) and not (version == 2.2 and every)
]


@pytest.fixture(scope="module")
def square(tmp_path_factory):
    """Write a block, with its boundary in physical groups, with other options of gmsh; returns the path."""
    folder = tmp_path_factory.mktemp("versions")
    gmsh.initialize([], readConfigFiles=False, interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    corners = [(-4, -4, 1.0), (4, -4, 1.0), (4, 0, 1.0), (0.3, 0, 0.1), (-0.3, 0, 0.1), (-4, 0, 1.0)]
    points = [gmsh.model.geo.addPoint(x, y, 0, size) for x, y, size in corners]
    lines = [gmsh.model.geo.addLine(points[i], points[(i + 1) % 6]) for i in range(6)]
    gmsh.model.geo.addPlaneSurface([gmsh.model.geo.addCurveLoop(lines)])
    gmsh.model.geo.synchronize()
    for name, line in GROUPS.items():
        gmsh.model.addPhysicalGroup(1, [lines[line]], name=name)
    gmsh.model.mesh.generate(2)

    def written(name, version=4.1, binary=0, every=1, parametric=0):
        options = {"MshFileVersion": version, "Binary": binary, "SaveAll": every, "SaveParametric": parametric}
        if not gmsh.model.getPhysicalGroups(2):
            gmsh.model.addPhysicalGroup(2, [1], name="specimen")
        for option, value in options.items():
            gmsh.option.setNumber(f"Mesh.{option}", value)
        gmsh.write(str(folder / name))
        return str(folder / name)

    yield written
    gmsh.finalize()


@pytest.fixture(scope="module")
def plain(square):
    return read(FIELD, square("plain.msh", every=0))


def same(one, other):
    """Whether nodes and lines are at the same places; their numbers are the file's."""
    places = [np.round(each.points, 12) + 0.0 for each in (one, other)]
    nodes = [sorted(each.tolist()) for each in places]
    lines = [
        {name: sorted(sorted(pair) for pair in at[edges].tolist()) for name, edges in each.lines.items()}
        for each, at in zip((one, other), places, strict=True)
    ]
    return nodes[0] == nodes[1] and lines[0] == lines[1]


@pytest.mark.parametrize("options", VERSIONS, ids=str)
def test_versions_and_options_of_gmsh_make_no_difference(square, plain, options):
    assert same(read(FIELD, square("body.msh", *options)), plain)


@pytest.mark.parametrize("name", ["body.inp", "body.med"])
def test_other_formats_that_gmsh_writes(square, plain, name):
    pytest.importorskip("h5py")
    assert len(read(FIELD, square(name)).lines["contact"]) == len(plain.lines["contact"])


@pytest.fixture
def both(tmp_path):
    """Two blocks in one file, and the first one."""
    one, other = quad_block(4.0, (-1.0, 1.0), {0.0: 0.4}, 0.4, 2.0), quad_block(3.0, (-1.0, 1.0), {0.0: 0.4}, 0.4, 1.0)
    path = tmp_path / "both.msh"
    write_quads(path, {"flat": one, "pad": other})
    return str(path), one


def test_one_of_two_bodies_of_gmsh_by_name_and_by_number(both):
    path, flat = both
    names = {name: f"flat-{name}" for name in ("contact", "back")}
    found = read(FIELD, path, body="FLAT", groups=names)
    assert len(found.triangles) == 2 * len(flat.quads)
    assert np.ptp(found.points, axis=0) == pytest.approx(np.ptp(flat.points, axis=0))
    with open(path, encoding="ascii") as file:
        numbers = {name: int(number) for number, name in re.findall(r'^\d (\d+) "(.+)"$', file.read(), re.MULTILINE)}
    by_number = {name: numbers[given] for name, given in names.items()}
    assert same(read(FIELD, path, body=numbers["flat"], groups=by_number), found)


def test_what_a_file_has_is_told(both):
    path, _ = both
    assert "if it has more bodies, type body = ..., one of flat, pad" in line_of(read, FIELD, path)
    assert "elements of the body 'base'; the file has flat, pad" in line_of(read, FIELD, path, body="base")
    told = line_of(read, FIELD, path, body="flat")
    assert "must have a group 'contact'" in told
    assert "the file has flat-contact, flat-face, flat-back" in told
    assert 'type groups = { contact = "..." }' in told
