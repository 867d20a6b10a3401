"""Good files of every kind, spoiled at random (seeded): either they still mean something, or they are refused in one
line, in little time and memory.

PARTIALSLIP_FUZZ=N draws N times as many as are run always, and PARTIALSLIP_SEED=S others.
"""

import os
import signal
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import NamedTuple

import meshio
import numpy as np
import pytest
from tests.bad_input.conftest import fair
from tests.meshes.test_read import WAYS, in_space

from partialslip import load_scene, run
from partialslip.scene.reading import shipped_scenes
from partialslip_meshes import block

HERE = Path(__file__).parent
SCENES = HERE.parents[1] / "src" / "partialslip" / "scene" / "shipped"
TIMES, SEED = (int(os.environ.get(f"PARTIALSLIP_{name}", usual)) for name, usual in (("FUZZ", 1), ("SEED", 0)))
SECONDS, MEGABYTES = 60, 2000
COARSE = ("--set", "fem.accuracy=0.1")
HUGE = (0, 1, 2**31 - 1, 2**31, 2**32 - 1, 2**40, 2**63 - 1, 2**64 - 1)
NUMBERS = (
    "nan inf -inf -1 0 -0.0 1e400 1e999 1e-320 1e99 1e-99 1e-30 0x10 1_000 99999999999999999999 2147483648 1,5 1;2"
)
VALUES = """true '' 'x' "µ ΔQ" [] [1] {} [[1,2],[3]] [1e5,-1e5] [0,0] "half-plane" "hertz" {E=1e9,nu=0.3} 1979-05-27"""
KEYS = (
    "name title plane nu R b x gap P p0 a Q sigma cycles steps accuracy order size width mesh coupling material.upper"
)
HEADS = """mm,um x/mm x(mm),z(µm) x[],gap[] # ** *NODE *NODE,SYSTEM=C *NSET *NSET,NSET=contact *ELSET,ELSET=contact
*NGEN *NSET,NSET=contact,GENERATE *ELEMENT,TYPE=T2D2 *ELEMENT,TYPE=CPE4 *INSTANCE,NAME=a *INCLUDE,INPUT=body.inp"""
WORDS = [
    *(word.encode() for word in f"{NUMBERS} {VALUES} {KEYS} {HEADS}".split()),
    *(b"", b"\xff", b"\x00", b"\n", b"\xef\xbb\xbf", b'"\\u202e"', b"9" * 5000, b"[" * 200, b"x" * 5000),
]
TABLE = 'kind = "tabulated"\nfile = "trace.csv"\nsmooth = 250e-6\nunit = 1e-3'


class Kind(NamedTuple):
    """Files, the first of which is spoiled; the command that reads them; and how often it refuses how many at least."""

    names: tuple[str, ...]
    command: tuple[str, ...]
    least: int = 3
    count: int = 16


def scored(*names):
    return Kind(names, ("score", "hertz-shear", names[0]))


def meshed(suffix):
    settings = f"bodies.lower={{mesh='b{suffix}', unit={load_scene('hertz-shear').length}}}", "fem.order=2"
    return (*("run", "hertz-shear", "--with", "fem"), *(word for each in settings for word in ("--set", each)))


KINDS = {
    "toml": Kind(("t.toml",), ("run", "t.toml", "--with", "exact")),
    "toml, fem": Kind(("t.toml",), ("run", "t.toml", "--with", "fem", "--set", "fem.accuracy=0.03"), 0, 2),
    "csv": scored("t.csv"),
    "frd": scored("calculix.frd"),
    "dat": scored("calculix.dat", "calculix.frd"),
    "mesh of dat": Kind(("calculix.frd", "calculix.dat"), ("score", "hertz-shear", "calculix.dat")),
    "vtu": scored("t.vtu"),
    "vtu as text": scored("text.vtu"),
    "vtk": scored("t.vtk"),
    "table in msh": scored("t.msh"),
    "npz": Kind(("t.npz",), ("run", "hertz-shear", "--with", "march", "--start", "t.npz", *COARSE)),
    "profile": Kind(("trace.csv", "job.toml"), ("run", "job.toml", "--with", "exact"), 0),
    **{way.__name__: Kind((f"{way.__name__}/b{suffix}",), meshed(suffix), 0, 6) for way, suffix in WAYS},
}


@pytest.fixture(scope="module")
def good(tmp_path_factory):
    """Folder of good files."""
    pytest.importorskip("h5py")
    folder = tmp_path_factory.mktemp("good")
    results = run(load_scene("hertz-shear", ["fem.accuracy=0.1"]), ["exact", "march"]).results
    results["march"].state.save(folder / "t.npz")
    x = np.linspace(-1.1, 1.1, 41) * results["exact"].a
    p, dq, *_ = results["exact"].traction.at(x)
    np.savetxt(folder / "t.csv", np.column_stack([x, p, dq]), delimiter=",", header="x,p,dq", comments="", fmt="%.6g")
    line = [("line", np.column_stack([np.arange(40), np.arange(1, 41)]))]
    table = meshio.Mesh(np.column_stack([x, 0 * x, 0 * x]), line, point_data={"p": p, "dq": dq})
    for name, how in {
        "t.vtu": {},
        "text.vtu": {"binary": False},
        "t.vtk": {},
        "t.msh": {"file_format": "gmsh22"},
    }.items():
        meshio.write(folder / name, table, **how)
    for name in ("calculix.frd", "calculix.dat"):
        (folder / name).write_bytes((HERE.parent / "score" / name).read_bytes())
    (folder / "t.toml").write_bytes(bench := (HERE / "bench.toml").read_bytes())
    measured = bench.decode().replace('kind = "hertz"\nR = 0.05', TABLE).replace("p0 = 400e6", "P = 135750.0")
    (folder / "job.toml").write_text(measured.replace("[-1e5, 1e5]", "[-3e4, 3e4]"), "utf-8")
    x = np.linspace(-2.0, 2.0, 200)
    np.savetxt(folder / "trace.csv", np.column_stack([x, x**2 / 20]), delimiter=",", header="x,gap", fmt="%.6g")
    mesh = block(4.0, (-1.5, 1.5), {}, 0.5, 2.0, along=0.25)
    for way, suffix in WAYS:
        (folder / way.__name__).mkdir()
        way(mesh, folder / way.__name__ / f"b{suffix}", in_space(mesh.points), mesh.triangles)
    return folder


def spoiled(content, random):
    """Cut off, with a piece left out or doubled; with bytes, whole integers or runs of bytes changed; in another
    encoding or with other separators; or words or lines changed, left out, doubled, exchanged or put elsewhere."""
    way, (at, to) = int(random.integers(13)), random.integers(len(content), size=2).tolist()
    changed = bytearray(content)
    if way < 3:
        return content[:at] + (b"", content[to:], content[at + int(random.integers(1, 200)) :])[way]
    if way == 3:
        changed[at : at + 8] = random.integers(256, size=8, dtype=np.uint8).tobytes()
        return bytes(changed)
    if way == 4:
        size = int(random.choice([4, 8]))
        changed[at : at + size] = (HUGE[random.integers(len(HUGE))] % 256**size).to_bytes(size, "little")
        return bytes(changed)
    if way == 5:
        return content.decode("latin-1").encode(("utf-16", "utf-8")[random.integers(2)])
    if way == 6:
        return content.replace(b",", (b";", b"\t", b" ", b", ,", b"\r\n")[random.integers(5)])
    separator = (b"\n", b" ", b",", b"= ", b"\n", b"\n")[way - 7]
    words = content.split(separator)
    place, other = random.integers(len(words), size=2).tolist()
    word = WORDS[random.integers(len(WORDS))]
    new = [[word], [], [words[place]] * 2, [words[other]], [words[place], word], [*words[place:], *words[:place]]]
    words[place : place + 1] = new[random.integers(len(new))]
    return separator.join(words)


@contextmanager
def limited():
    """No more than so much memory and CPU time."""
    resource = pytest.importorskip("resource")
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    now = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    before = signal.signal(signal.SIGPROF, lambda *_: pytest.fail(f"takes more than {SECONDS} CPU s"))
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    resource.setrlimit(resource.RLIMIT_AS, (now + MEGABYTES * 2**20, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def other_numbers(random):
    """Settings of a sound scene, of other numbers."""
    key, number = (
        ("material.E", "profile.R", "friction.f", "load.Q")[random.integers(4)],
        10.0 ** random.uniform(-12, 12),
    )
    return ("--set", f"{key}={[-number, number] if key == 'load.Q' else number}")


def spoil(judged, folder, good, kind, seed, times=1):
    names, command, least, count = KINDS[kind]
    random = np.random.default_rng([SEED, seed, [*KINDS].index(kind)])
    for name in names:
        (folder / Path(name).name).write_bytes((good / name).read_bytes())
    assert not judged([*command, "--json"])
    refused = 0
    for _ in range(count * times):
        name = sorted(shipped_scenes())[random.integers(len(shipped_scenes()))]
        content = (SCENES / f"{name}.toml" if "toml" in kind else good / names[0]).read_bytes()
        for _ in range(int(random.integers(1, 3))):
            content = spoiled(content or b"\n", random)
        (folder / Path(names[0]).name).write_bytes(content)
        more = other_numbers(random) if "toml" in kind and random.integers(4) == 0 else ()
        with limited():
            refused += judged([*command, *more, "--json"])
    assert refused >= least * times


@pytest.mark.parametrize("kind", KINDS)
def test_spoiled_files(judged, tmp_path, good, kind):
    spoil(judged, tmp_path, good, kind, 0, TIMES)


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_many_spoiled_files(judged, tmp_path, good, kind):
    spoil(judged, tmp_path, good, kind, 1, 16 * TIMES)


@pytest.mark.parametrize(
    ("code", "out", "err"),
    [(3, "", "partialslip: a fault\n"), (2, "", "Traceback\n"), (2, "{}", "partialslip: x\n"), (0, "", ""),
     (0, '{"a": NaN}', ""), (0, "{}", "warning\n"), (2, "", "partialslip: x\n\n"), (1, "half {", "")],
)  # fmt: skip
def test_what_is_wrong_is_seen(code, out, err):
    """Deliberate faults: a traceback, a wrong exit code, two lines, no JSON."""
    with pytest.raises((AssertionError, ValueError, pytest.fail.Exception)):
        fair(code, SimpleNamespace(out=out, err=err))
    assert fair(2, SimpleNamespace(out="", err="partialslip: E = -1: must be > 0\n"))
    assert not fair(0, SimpleNamespace(out="{}", err=""))
