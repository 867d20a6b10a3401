"""The process that makes meshes: whoever calls, whatever else has gmsh open, and however the process or its parent
ends."""

import multiprocessing
import os
import signal
import subprocess
import sys
import textwrap
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

import partialslip
from partialslip.study.batch.job import Job, solve_job
from partialslip.tools.errors import MissingLibraryError, PartialslipError
from partialslip_meshes import block
from partialslip_meshes import gmsh as mesher
from partialslip_meshes import mesher as process

SIZES = {-1.0: 0.05, 0.2: 0.05}
OUTLINE = (8.0, (-1.2, 1.2), SIZES, 0.5)
CALL = f"block{OUTLINE}"
posix = pytest.mark.skipif(os.name != "posix", reason="signals and forks")


@pytest.fixture(autouse=True)
def anew():
    """Each test begins, and ends, without a process for meshes."""
    mesher._end()
    yield
    mesher._end()


@pytest.fixture(scope="module")
def expected():
    return block(*OUTLINE)


def same(mesh, other):
    """Bit for bit."""
    return (
        np.array_equal(mesh.points, other.points)
        and np.array_equal(mesh.triangles, other.triangles)
        and mesh.lines.keys() == other.lines.keys()
        and all(np.array_equal(mesh.lines[name], other.lines[name]) for name in mesh.lines)
    )


def pid():
    return mesher._mesher._process.pid


def ended(number, within=20.0):
    """Whether the process ``number`` ends before long. It may stay a zombie if nobody waits for it."""
    until = time.monotonic() + within
    while time.monotonic() < until:
        try:
            state = Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[0]
        except (FileNotFoundError, ProcessLookupError):
            return True
        if state == "Z":
            return True
        time.sleep(0.02)
    return False


def script(folder, code, *, prefix="", **settings):
    """Run a script of its own; returns what became of it."""
    path = folder / "script.py"
    path.write_text(prefix + "import partialslip\nfrom partialslip_meshes import block, gmsh\n" + textwrap.dedent(code))
    return subprocess.run([sys.executable, path], capture_output=True, text=True, check=False, timeout=60, **settings)


def test_no_other_mesh_than_in_this_process(monkeypatch):
    """gmsh and the recipe are the same ones, so the meshes are, bit for bit."""
    code = f"""
    import sys, json, gmsh as G
    from partialslip_meshes import blocks, mesher
    blocks.ask = lambda request: (lambda head, arrays: (head | {{"cpu_s": 0.0}}, arrays))(*mesher.mesh(G, **request))
    mesh = block({OUTLINE}[0], *{OUTLINE}[1:], 3.0, 0.1, (9.0, 2.0), lambda x: x**2 / 100, 0.2)
    print(mesh.points.tobytes().hex(), mesh.triangles.tobytes().hex())
    """
    done = subprocess.run(
        [sys.executable, "-c", "import partialslip\nfrom partialslip_meshes import block\n" + textwrap.dedent(code)],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    mesh = block(*OUTLINE, 3.0, 0.1, (9.0, 2.0), lambda x: x**2 / 100, 0.2)
    assert done.stdout.split() == [mesh.points.tobytes().hex(), mesh.triangles.tobytes().hex()]
    monkeypatch.setitem(mesher.OPTIONS, "RandomFactor", 1e-4)
    assert not same(block(*OUTLINE), mesh)


def test_one_process_for_all_meshes(expected):
    first = block(*OUTLINE)
    number = pid()
    again = block(*OUTLINE)
    assert pid() == number
    assert same(first, expected)
    assert same(again, expected)
    assert 0 < again.cpu_s < first.cpu_s  # which counts the start, too


def test_threads_share_it(expected):
    with ThreadPoolExecutor(8) as pool:
        assert all(same(mesh, expected) for mesh in pool.map(lambda _: block(*OUTLINE), range(24)))


def test_an_open_session_is_left_alone(expected):
    """Model, mesh and options of the caller's gmsh; which do not get into the block's mesh either."""
    import gmsh

    gmsh.initialize([], readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.MeshSizeFactor", 0.5)
        gmsh.option.setNumber("Mesh.Algorithm", 8)
        gmsh.model.add("mine")
        gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
        gmsh.model.occ.synchronize()
        gmsh.model.mesh.generate(2)
        nodes = gmsh.model.mesh.getNodes()[1]
        assert same(block(*OUTLINE), expected)
        assert gmsh.isInitialized()
        assert gmsh.model.getCurrent() == "mine"
        assert gmsh.option.getNumber("Mesh.MeshSizeFactor") == 0.5
        assert gmsh.option.getNumber("Mesh.Algorithm") == 8
        assert np.array_equal(gmsh.model.mesh.getNodes()[1], nodes)
    finally:
        gmsh.finalize()


def _points(_):
    return block(*OUTLINE).points


@posix
@pytest.mark.filterwarnings("ignore:This process .* is multi-threaded:DeprecationWarning")
def test_in_daemonic_workers_after_a_fork(expected):
    """Which may have no children of multiprocessing's, and each have a process of their own for meshes."""
    block(*OUTLINE)
    number = pid()
    with multiprocessing.get_context("fork").Pool(2) as pool:
        found = pool.map_async(_points, range(4)).get(60)
    assert all(np.array_equal(points, expected.points) for points in found)
    assert same(block(*OUTLINE), expected)
    assert pid() == number


def test_in_daemonic_workers_that_are_spawned():
    case = Job(partialslip.load_scene("hertz-shear", ["fem.size=0.5"]), ("fem",))
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        (found,) = pool.map_async(solve_job, [case]).get(60)
    assert found.run.methods["fem"].a == solve_job(case).run.methods["fem"].a


@posix
@pytest.mark.filterwarnings("ignore:This process .* is multi-threaded:DeprecationWarning")
def test_a_fork_does_not_keep_it_alive(tmp_path):
    """The child has no end of the parent's pipes."""
    code = f"""
    import os, sys, time
    {CALL}
    print(gmsh._mesher._process.pid, flush=True)
    if os.fork() == 0:
        os.close(1), os.close(2)
        time.sleep(30)
        os._exit(0)
    os._exit(0)
    """
    assert ended(int(script(tmp_path, code).stdout))


def test_a_script_without_a_main_guard(tmp_path, expected):
    done = script(tmp_path, f"print(len({CALL}.points))")
    assert (done.stdout, done.stderr, done.returncode) == (f"{len(expected.points)}\n", "", 0)


def test_modules_beside_a_script_are_not_taken_for_the_standard_library(tmp_path, expected):
    (tmp_path / "select.py").write_text("raise SystemExit('not this one')")
    (tmp_path / "platform.py").write_text("raise SystemExit('nor this one')")
    done = script(tmp_path, f"sys.path.insert(0, {str(tmp_path)!r}); print(len({CALL}.points))", prefix="import sys\n"
                  "here = sys.path.pop(0)\n")  # fmt: skip
    assert (done.stdout, done.stderr) == (f"{len(expected.points)}\n", "")


@posix
def test_in_a_folder_that_is_gone(tmp_path, expected):
    gone = tmp_path / "gone"
    gone.mkdir()
    done = script(tmp_path, f"import os, shutil; shutil.rmtree(os.getcwd()); print(len({CALL}.points))", cwd=gone)
    assert (done.stdout, done.stderr) == (f"{len(expected.points)}\n", "")


@posix
@pytest.mark.parametrize("kind", [signal.SIGKILL, signal.SIGTERM])
@pytest.mark.parametrize("busy", [False, True])
def test_ends_with_its_parent(tmp_path, kind, busy):
    """Waiting for work, or in the middle of a mesh that would take minutes."""
    code = f"""
    import threading, time
    {CALL}
    print(gmsh._mesher._process.pid, flush=True)
    {"block(8.0, (-1.2, 1.2), {}, 0.001, along=0.0005)" if busy else "time.sleep(60)"}
    """
    path = tmp_path / "script.py"
    path.write_text("import partialslip\nfrom partialslip_meshes import block, gmsh\n" + textwrap.dedent(code))
    with subprocess.Popen([sys.executable, path], stdout=subprocess.PIPE, text=True) as parent:
        number = int(parent.stdout.readline())
        time.sleep(0.5)
        assert not ended(number, within=0.0) or not busy
        parent.send_signal(kind)
        parent.wait()
        assert ended(number)


@contextmanager
def killed(times):
    """Kill the process as soon as it is asked, so many times."""
    true, left = mesher._Mesher.ask, [times]

    def ask(self, request):
        if left[0]:
            left[0] -= 1
            self._process.kill()
            os.waitid(os.P_PID, self._process.pid, os.WEXITED | os.WNOWAIT)  # dead, so that its pipe is broken
        return true(self, request)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(mesher._Mesher, "ask", ask)
        yield


@posix
def test_replaced_where_a_broken_pipe_ends_programs(expected):
    """The caller's SIGPIPE may be the system's, which ends the process that writes."""
    before = signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    try:
        for _ in range(5):
            with killed(1):
                assert same(block(*OUTLINE), expected)
    finally:
        signal.signal(signal.SIGPIPE, before)


@posix
def test_replaced_once(expected):
    with killed(1):
        assert same(block(*OUTLINE), expected)
    with killed(2), pytest.raises(PartialslipError, match=r"died twice \(signal 9\)") as error:
        block(*OUTLINE)
    assert "\n" not in str(error.value)
    assert same(block(*OUTLINE), expected)


@posix
def test_interrupted(tmp_path):
    """Ctrl-C, which a terminal sends to the whole group, in the middle of a mesh: no process stays, no traceback."""
    code = """
    import sys, threading, time
    from partialslip.cli import main
    from partialslip_meshes import blocks
    true = blocks.ask
    def slow(request):
        print("asked", flush=True)
        return true(request | {"growth": 0.001, "along": 0.0005})
    block(8.0, (-1.0, 1.0), {0.0: 0.5}, 0.5)
    blocks.ask = slow
    print(gmsh._mesher._process.pid, flush=True)
    sys.exit(main(["run", "hertz-shear", "--with", "fem"]))
    """
    path = tmp_path / "script.py"
    path.write_text("import partialslip\nfrom partialslip_meshes import block, gmsh\n" + textwrap.dedent(code))
    command = [sys.executable, path]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
                          cwd=tmp_path) as parent:  # fmt: skip
        number = int(parent.stdout.readline())
        assert parent.stdout.readline() == "asked\n"
        time.sleep(0.5)
        os.killpg(parent.pid, signal.SIGINT)
        assert parent.wait() == 130
        assert parent.stderr.read().split("\n")[-2:] == ["partialslip: interrupted", ""]
        assert ended(number)


@pytest.mark.parametrize("library", [*mesher.DEBIAN_PACKAGES, "libunheard.so.7"])
def test_missing_system_library_is_named(library):
    text = f"{library}: cannot open shared object file: No such file or directory"
    with pytest.raises(MissingLibraryError) as error:
        mesher._refuse("library", text)
    assert library in str(error.value)
    assert mesher.DEBIAN_PACKAGES.get(library, "system's packages") in str(error.value)
    assert "\n" not in str(error.value)


@pytest.fixture
def instead(tmp_path, monkeypatch):
    """Put another module in the place of gmsh."""

    def put(code):
        (tmp_path / "gmsh.py").write_text(code)
        monkeypatch.syspath_prepend(tmp_path)
        monkeypatch.delitem(sys.modules, "gmsh", raising=False)

    return put


def test_a_gmsh_that_cannot_be_loaded(instead):
    instead("raise OSError('libGLU.so.1: cannot open shared object file: No such file or directory')")
    with pytest.raises(MissingLibraryError, match=r"libGLU.so.1 is missing; .* apt-get install libglu1-mesa"):
        block(*OUTLINE)


def test_a_gmsh_that_prints_or_fails(instead, capfd):
    instead(
        "import os\nos.write(1, b'out')\nos.write(2, b'err')\ndef initialize(*_, **__): raise Exception('no\\nway')"
    )
    with pytest.raises(PartialslipError, match=r"gmsh cannot make the mesh: no"):
        block(*OUTLINE)
    assert capfd.readouterr() == ("", "")


def test_no_gmsh_at_all(monkeypatch):
    monkeypatch.delitem(sys.modules, "gmsh", raising=False)
    monkeypatch.setattr(sys, "path", [])
    monkeypatch.setattr(sys, "path_importer_cache", {})
    with pytest.raises(MissingLibraryError, match="gmsh is missing"):
        block(*OUTLINE)


def test_messages_of_any_size(tmp_path):
    del tmp_path
    read, write = os.pipe()
    arrays = [b"", b"x" * 5_000_000, b"yz"]
    with ThreadPoolExecutor(1) as pool:
        sent = pool.submit(process.send, write, {"n": 0.1}, arrays)
        head, found = process.receive(read)
        sent.result()
    assert head["n"] == 0.1
    assert found == arrays
    os.close(write)
    with pytest.raises(EOFError):
        process.receive(read)
    os.close(read)
