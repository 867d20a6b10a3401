"""Good files of every kind, cut off anywhere, and with bytes, lines and numbers changed at random (seeded): either they
still mean something, or they are refused in one line."""

from pathlib import Path

import meshio
import numpy as np
import pytest

from partialslip import load_scene, run

HERE = Path(__file__).parent
COARSE = ("--set", "fem.accuracy=0.1")
WORDS = (b"nan", b"inf", b"-1", b"1e999", b"", b"1e-320", b"0", b"x", b"-", b"99999999999999999999", b"\xff", b"\x00",
         b"[", b'"', b"\n", b",", b"1e99", b"1e-99")  # fmt: skip


@pytest.fixture(scope="module")
def good(tmp_path_factory):
    """By kind: names of files, the first of which is spoiled, and the command that reads it."""
    folder = tmp_path_factory.mktemp("good")
    scene = load_scene("hertz-shear", ["fem.accuracy=0.1"])
    results = run(scene, ["exact", "march"]).results
    results["march"].state.save(folder / "t.npz")
    x = np.linspace(-1.1, 1.1, 41) * results["exact"].a
    p, dq, *_ = results["exact"].traction.at(x)
    table = np.column_stack([x, p, dq])
    np.savetxt(folder / "t.csv", table, delimiter=",", header="x,p,dq", comments="", fmt="%.6g")
    points, lines = np.column_stack([x, 0 * x, 0 * x]), np.column_stack([np.arange(40), np.arange(1, 41)])
    mesh = meshio.Mesh(points, [("line", lines)], point_data={"p": p, "dq": dq})
    meshio.write(folder / "t.vtu", mesh)
    meshio.write(folder / "b.vtu", mesh, binary=False)
    meshio.write(folder / "t.vtk", mesh, binary=True)
    meshio.write(folder / "t.msh", mesh, file_format="gmsh22", binary=True)
    for name in ("calculix.frd", "calculix.dat"):
        (folder / name).write_bytes((HERE.parent / "score" / name).read_bytes())
    (folder / "t.toml").write_bytes((HERE / "bench.toml").read_bytes())
    return folder


KINDS = {
    "toml": (["t.toml"], ["run", "t.toml", "--with", "exact"]),
    "csv": (["t.csv"], ["score", "hertz-shear", "t.csv"]),
    "frd": (["calculix.frd"], ["score", "hertz-shear", "calculix.frd"]),
    "dat": (["calculix.dat", "calculix.frd"], ["score", "hertz-shear", "calculix.dat"]),
    "mesh of dat": (["calculix.frd", "calculix.dat"], ["score", "hertz-shear", "calculix.dat"]),
    "vtu": (["t.vtu"], ["score", "hertz-shear", "t.vtu"]),
    "vtu as text": (["b.vtu"], ["score", "hertz-shear", "b.vtu"]),
    "vtk": (["t.vtk"], ["score", "hertz-shear", "t.vtk"]),
    "msh": (["t.msh"], ["score", "hertz-shear", "t.msh"]),
    "npz": (["t.npz"], ["run", "hertz-shear", "--with", "march", "--start", "t.npz", *COARSE]),
}


def spoiled(content, random):
    """Cut off, or with a few bytes changed, or a word or a line replaced, left out or doubled."""
    way = random.integers(6)
    at = int(random.integers(len(content)))
    if way == 0:
        return content[:at]
    if way == 1:
        changed = bytearray(content)
        for place in random.integers(len(content), size=random.integers(1, 9)):
            changed[place] = random.integers(256)
        return bytes(changed)
    if way == 2:
        return content[:at] + content[at + int(random.integers(1, 200)) :]
    separator = b"\n" if way == 3 else b" " if way == 4 else b","
    words = content.split(separator)
    place = int(random.integers(len(words)))
    words[place : place + 1] = [[WORDS[random.integers(len(WORDS))]], [], [words[place]] * 2][random.integers(3)]
    return separator.join(words)


def spoil(judged, tmp_path, good, kind, count, seed):
    names, arguments = KINDS[kind]
    random = np.random.default_rng([seed, len(kind), sorted(KINDS).index(kind)])
    for name in names:
        (tmp_path / name).write_bytes((good / name).read_bytes())
    assert not judged([*arguments, "--json"])
    content = (good / names[0]).read_bytes()
    refused = 0
    for _ in range(count):
        (tmp_path / names[0]).write_bytes(spoiled(content, random))
        refused += judged([*arguments, "--json"])
    return refused


@pytest.mark.parametrize("kind", KINDS)
def test_spoiled_files(judged, tmp_path, good, kind):
    assert spoil(judged, tmp_path, good, kind, 25, seed=0) > 5


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", [1, 2])
def test_many_spoiled_files(judged, tmp_path, good, kind, seed):
    assert spoil(judged, tmp_path, good, kind, 150, seed) > 30
