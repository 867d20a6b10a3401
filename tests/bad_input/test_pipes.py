"""Files of a user are regular files: a pipe would be waited for, and a device be read, without end."""

import ast
import contextlib
import os
import signal
from pathlib import Path

import pytest
from refusing import line_of
from tests.bad_input.conftest import check

from partialslip import InputError, load_result, load_rig, load_scene, load_state, sweep
from partialslip.cli import main
from partialslip.scene.measured import read_points
from partialslip.study.batch.ledger import Ledger
from partialslip.verify.benchmark import read_problems, read_submission
from partialslip.verify.document import read_study
from partialslip_meshes import read as read_mesh
from partialslip_meshes.pointdata import read_point_data

pytestmark = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes in the file system")
SECONDS = 30  # after which a reader that waits is ended
REFUSED = "must be a regular file, not a pipe or a device"
READERS = {
    "scene.toml": load_scene,
    "results.json": load_result,
    "state.npz": load_state,
    "rig.json": load_rig,
    "points.txt": lambda path: read_points(str(path), (1.0, 1.0)),
    "ledger.jsonl": Ledger,
    "swept.jsonl": lambda path: sweep(
        load_scene("hertz-shear"), {"friction.f": [0.3]}, "exact", ledger=path, progress=lambda *_: None
    ),
    "meta.toml": lambda path: read_submission(path.parent, read_problems()),
    "mesh.inp": lambda path: read_mesh("bodies.lower.mesh", str(path)),
    "mesh.msh": lambda path: read_mesh("bodies.lower.mesh", str(path)),
    "mesh.vtu": lambda path: read_mesh("bodies.lower.mesh", str(path)),
    "data.vtu": read_point_data,
    "data.xdmf": read_point_data,
}
SCORE = ["score", "hertz-shear", "PATH"]
COMMANDS = {
    "t.csv": SCORE,
    "t.frd": SCORE,
    "t.dat": SCORE,
    "t.vtk": SCORE,
    "start.npz": ["run", "hertz-shear", "--start", "PATH"],
    "peers.jsonl": ["study", "cost", "hertz-shear", "--peers", "PATH", "--out", "o"],
    "made.inp": ["export", "hertz-shear", "--to", "calculix", "-o", "PATH"],
    "saved.npz": ["run", "hertz-shear", "--with", "march", "--set", "fem.accuracy=1e-2", "--save", "PATH", "--json"],
}


@pytest.fixture(autouse=True)
def ends(monkeypatch, tmp_path):
    """End a reader that waits; work in an empty folder."""

    def late(*_):
        raise AssertionError("waits for a pipe, or reads a device without end")

    monkeypatch.chdir(tmp_path)
    before = signal.signal(signal.SIGALRM, late)
    signal.alarm(SECONDS)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


@pytest.fixture(params=["pipe", "device"])
def odd(request):
    """Make what is no regular file at a path."""

    def make(path):
        if request.param == "pipe":
            os.mkfifo(path)
        else:
            path.symlink_to("/dev/full")
        return path

    return make


@pytest.mark.parametrize("name", READERS)
def test_no_reader_opens_them(tmp_path, odd, name):
    told = line_of(READERS[name], odd(tmp_path / name))
    assert REFUSED in told
    assert name in told


@pytest.mark.parametrize("name", COMMANDS)
def test_no_command_reads_or_replaces_them(tmp_path, capsys, odd, name):
    odd(tmp_path / name)
    code = main([each.replace("PATH", name) for each in COMMANDS[name]])
    message = check(code, capsys.readouterr())
    assert name in message
    assert REFUSED in message or "holds other content" in message
    assert sorted(os.listdir()) == [name]
    assert not Path(name).is_file()


def test_a_mesh_that_is_one_is_named_by_every_method(tmp_path, capsys, odd):
    odd(tmp_path / "block.inp")
    bodies = ("--set", "bodies.lower.mesh=block.inp", "--set", "bodies.lower.kind=block")
    for command in (["run", "--with", "fem"], ["run", "--with", "equivalent"], ["equivalent"]):
        message = check(main([command[0], "hertz-shear", *command[1:], *bodies]), capsys.readouterr())
        assert "block.inp" in message
        assert REFUSED in message


@pytest.mark.parametrize(("name", "text"), [
    ("outer.inp", "*HEADING\n*Include, input=inner.inp\n"),
    ("outer.xdmf", '<Xdmf><DataItem Dimensions="2" Format="Binary">inner.inp</DataItem></Xdmf>'),
    ("outer.xmf", '<Xdmf><DataItem Format="HDF" Dimensions="2">inner.inp:/data0</DataItem></Xdmf>'),
])  # fmt: skip
def test_files_that_a_mesh_refers_to_are_not_opened_either(tmp_path, odd, name, text):
    odd(tmp_path / "inner.inp")
    (tmp_path / name).write_text(text, "utf-8")
    with pytest.raises(InputError, match=REFUSED):
        READERS["mesh.inp" if name.endswith("inp") else "data.xdmf"](tmp_path / name)


def test_a_mesh_that_includes_itself_is_refused(tmp_path):
    (tmp_path / "round.inp").write_text("*INCLUDE, INPUT=round.inp\n", "utf-8")
    with pytest.raises(InputError, match="must not include itself"):
        READERS["mesh.inp"](tmp_path / "round.inp")


def test_a_study_of_pipes_and_a_folder_whose_request_is_one(tmp_path, capsys, odd):
    odd(tmp_path / "figure.svg")
    with pytest.raises(InputError, match="cannot be read as UTF-8 text"):
        read_study(tmp_path)
    (tmp_path / "out").mkdir()
    odd(tmp_path / "out" / ".partialslip")
    (tmp_path / "out" / "notes.txt").write_text("mine", "utf-8")
    message = check(main(["run", "hertz-shear", "--with", "exact", "--out", "out"]), capsys.readouterr())
    assert REFUSED in message


@pytest.mark.skipif(not os.access("/proc/kmsg", os.R_OK), reason="the log of the kernel is not to be read")
def test_a_regular_file_that_would_wait_is_refused():
    """/proc/kmsg calls itself a regular file."""
    for read in (load_scene, load_result, Ledger):
        with contextlib.suppress(InputError):  # or there are lines to read
            read(Path("/proc/kmsg"))


OPENERS = {
    "inputfile",  # files of users
    "ledger", "state",  # to write
    "origin", "cost",  # of the packages and of the operating system
    "mesher",  # meshes that are checked before
    "reading", "book", "problem", "gradual_table", "curves", "statements",  # data of the package
    "ending",  # the null device
    "process", "calculix", "neutral", "moose", "run_getfem", "run_kratos", "run_opensees", "scripted",  # made here
}  # fmt: skip


def test_no_other_module_opens_files_of_users():
    """A module that begins to open files belongs to the list with a reason, or uses partialslip.tools.inputfile."""
    found = set()
    for root in ("src", "fem", "meshes"):
        for path in (Path(__file__).parents[2] / root).rglob("*.py"):
            for node in ast.walk(ast.parse(path.read_text("utf-8"))):
                called = ast.unparse(node.func) if isinstance(node, ast.Call) else ""
                methods = (".open", ".read_text", ".read_bytes")
                if called == "open" or (called.endswith(methods) and called != "os.open"):
                    found.add(path.stem)
    assert found == OPENERS
