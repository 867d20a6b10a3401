"""Meshes of bodies, in every format, spoiled at random (seeded): they are either still meshes of a body, or refused in
one line, in little time and memory."""

import os
import time
from contextlib import contextmanager

import meshio
import numpy as np
import pytest

from partialslip import load_scene
from partialslip_meshes import block

COUNT = int(os.environ.get("PARTIALSLIP_SPOILED_MESHES", "84"))  # of each of six kinds, if asked for: 504
WORDS = (b"nan", b"inf", b"-1", b"1e999", b"", b"1e-320", b"0", b"x", b"-", b"99999999999999999999", b"2147483648",
         b"4294967295", b"1e99", b"1e-99", b"\xff", b"\x00", b"[", b'"', b"\n", b",", b"*", b"$", b">")  # fmt: skip
HUGE = (0, 1, 2**31 - 1, 2**31, 2**32 - 1, 2**40, 2**63 - 1, 2**64 - 1)
SECONDS, MEGABYTES = 60, 2000


def msh(path, points, cells, member, binary):
    tag = sum(number * here for number, here in enumerate(member.values(), start=1))
    tags = [np.zeros(len(cells[0][1]), dtype=int) + 9, tag]
    names = {name: np.array([number, 1]) for number, name in enumerate(member, start=1)}
    data = {"gmsh:physical": tags, "gmsh:geometrical": tags}
    meshio.write(
        path, meshio.Mesh(points, cells, cell_data=data, field_data=names), file_format="gmsh22", binary=binary
    )


def inp(path, points, cells, member):
    sets = {name: [[], np.flatnonzero(here)] for name, here in member.items()}
    meshio.write(path, meshio.Mesh(points, cells, cell_sets=sets))


def med(path, points, cells, member):
    tag = sum(number * here for number, here in enumerate(member.values(), start=1))
    mesh = meshio.Mesh(points[:, :2], cells, cell_data={"cell_tags": [np.full(len(cells[0][1]), -9), -tag]})
    mesh.cell_tags = {-number: [name] for number, name in enumerate(member, start=1)}
    meshio.write(path, mesh)


def vtu(path, points, cells, member, binary):
    data = {name: [np.zeros(len(cells[0][1])), 1.0 * here] for name, here in member.items()}
    meshio.write(path, meshio.Mesh(points, cells, cell_data=data), binary=binary)


KINDS = {
    "msh": (".msh", lambda *mesh: msh(*mesh, True)),
    "msh as text": (".msh", lambda *mesh: msh(*mesh, False)),
    "inp": (".inp", inp),
    "med": (".med", med),
    "vtu": (".vtu", lambda *mesh: vtu(*mesh, True)),
    "vtu as text": (".vtu", lambda *mesh: vtu(*mesh, False)),
}


@pytest.fixture(scope="module")
def good(tmp_path_factory):
    """By kind: the content of a file, and the settings of a scene that uses it."""
    pytest.importorskip("h5py")
    folder = tmp_path_factory.mktemp("good")
    mesh = block(4.0, (-1.5, 1.5), {}, 0.5, 2.0, along=0.25)
    points = np.column_stack([mesh.points, 0 * mesh.points[:, 0]])
    place = np.repeat(np.arange(len(mesh.lines)), [len(edges) for edges in mesh.lines.values()])
    member = {name: place == number for number, name in enumerate(mesh.lines)}
    cells = [("triangle", mesh.triangles), ("line", np.concatenate([*mesh.lines.values()]))]
    unit, found = load_scene("hertz-shear").length, {}
    for kind, (suffix, write) in KINDS.items():
        path = folder / f"b{suffix}"
        write(path, points, cells, member)
        found[kind] = path.read_bytes(), f"bodies.lower={{mesh='b{suffix}', unit={unit}}}"
    return found


def spoiled(content, random):
    """Cut off or doubled; bytes, whole integers, or runs of bytes changed; words or lines changed, left out or
    doubled, or one number replaced everywhere."""
    way = int(random.integers(9))
    at = int(random.integers(len(content)))
    changed = bytearray(content)
    if way == 0:
        return content[:at]
    if way == 1:
        for place in random.integers(len(content), size=random.integers(1, 9)):
            changed[place] = random.integers(256)
        return bytes(changed)
    if way == 2:
        return content[:at] + content[at + int(random.integers(1, 200)) :]
    if way == 3:
        size = int(random.choice([4, 8]))
        changed[at : at + size] = (HUGE[random.integers(len(HUGE))] % 256**size).to_bytes(size, "little")
        return bytes(changed)
    if way == 4:
        end = at + int(random.integers(1, 64))
        changed[at:end] = random.integers(256, size=len(changed[at:end]), dtype=np.uint8).tobytes()
        return bytes(changed)
    if way == 5:
        return content[:at] + content[int(random.integers(len(content))) :]
    separator = (b"\n", b" ", b",")[way - 6]
    words = content.split(separator)
    place = int(random.integers(len(words)))
    word = WORDS[random.integers(len(WORDS))]
    if random.integers(4) == 0:
        return separator.join(word if each == words[place] else each for each in words)
    words[place : place + 1] = [[word], [], [words[place]] * 2][random.integers(3)]
    return separator.join(words)


@contextmanager
def limited():
    """No more than so much memory and CPU time."""
    resource = pytest.importorskip("resource")
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    began = time.process_time()
    with open("/proc/self/statm") as file:
        now = int(file.read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (now + MEGABYTES * 2**20, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))
    assert time.process_time() - began < SECONDS


def spoil(judged, folder, good, kind, count, seed):
    content, setting = good[kind]
    random = np.random.default_rng([seed, [*KINDS].index(kind)])
    path = folder / f"b{KINDS[kind][0]}"
    arguments = ["run", "hertz-shear", "--with", "fem", "--set", setting, "--set", "fem.order=2", "--json"]
    path.write_bytes(content)
    assert not judged(arguments)
    refused = 0
    for _ in range(count):
        path.write_bytes(spoiled(content, random))
        (folder / "last").write_bytes(path.read_bytes())  # to look at, where it falls over
        with limited():
            refused += judged(arguments)
    return refused


@pytest.mark.parametrize("kind", KINDS)
def test_spoiled_meshes(judged, tmp_path, good, kind):
    assert spoil(judged, tmp_path, good, kind, 6, seed=0) > 0


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_many_spoiled_meshes(judged, tmp_path, good, kind):
    """So many of each kind as PARTIALSLIP_SPOILED_MESHES says."""
    assert spoil(judged, tmp_path, good, kind, COUNT, seed=1) > COUNT / 10
