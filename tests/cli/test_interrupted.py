"""Runs stopped at any moment by Ctrl-C or kill -9: no partial files, and a rerun works."""

import json
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pytest

from partialslip.cli import main
from partialslip.tools.output import files, place
from partialslip.tools.output.files import write_files
from partialslip.tools.output.lock import LOCK_NAME  # this file may stay; the lock does not
from partialslip.verify.document import read_study

RUN = (
    "run",
    "hertz-shear",
    "--with",
    "exact,march",
    "--set",
    "fem.accuracy=0.1",
    "--save",
    "out/state.npz",
    "--out",
    "out",
)
VERIFY = ("verify", "--suite", "stress", "--only", "1", "--only", "2", "--processes", "1", "--pdf", "--out", "out")
FILES = ["report.html", "results.json", "state.npz", "tractions.csv"]

# Runs the command line as often as asked, with a stop at the n-th of the system calls that change files in the folder
# out; n = 0 counts them. Each run is a fork of one process, which has imported everything, solved the scene and drawn
# its figures: all this takes much longer than what is stopped, to write the files.
STOPPER = """
import json, os, signal, sys
import partialslip
from partialslip.cli import main
from partialslip.report import page
def once(function):
    known = {}
    def found(first, *rest, **named):
        key = first if isinstance(first, partialslip.Scene) else id(first)
        if key not in known:
            known[key] = function(first, *rest, **named)
        return known[key]
    return found
partialslip.run = once(partialslip.run)
page.traction_svg, page.levels_svg, page.mesh_svg = map(once, (page.traction_svg, page.levels_svg, page.mesh_svg))
requests, answers = os.fdopen(os.dup(0)), os.fdopen(os.dup(1), "w")
for own in (0, 1):
    os.dup2(os.open(os.devnull, os.O_RDWR), own)
assert main(json.loads(sys.argv[1])) == 0
def run(stop, kind, arguments):
    count, out = 0, os.path.join(os.path.realpath("out"), "")
    def hooked(event, given):
        nonlocal count
        writes = event == "open" and isinstance(given[2], int) and given[2] & (os.O_WRONLY | os.O_RDWR | os.O_CREAT)
        paths = (os.path.join(os.path.abspath(os.fsdecode(a)), "") for a in given if isinstance(a, (str, bytes)))
        here = any(path.startswith(out) for path in paths)
        if here and (writes or event in ("os.rename", "os.remove", "os.mkdir", "os.chmod", "tempfile.mkstemp")):
            count += 1
            if count == stop:
                os.kill(os.getpid(), kind)
    sys.addaudithook(hooked)
    code = main(arguments)
    print("moments", count, file=sys.stderr)
    sys.exit(code)
for line in requests:
    folder, *asked = json.loads(line)
    ours, its = os.pipe()
    child = os.fork()
    if not child:
        os.dup2(its, 2)
        os.close(its)
        sys.stderr = open(2, "w", closefd=False)
        os.chdir(folder)
        run(*asked)
    os.close(its)
    with os.fdopen(ours) as said:
        told = said.read()
    print(json.dumps([os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), told]), file=answers, flush=True)
"""


@pytest.fixture(scope="module")
def stopped(tmp_path_factory):
    """Runs the command line in a folder up to a moment; returns exit code and stderr."""
    command = [sys.executable, "-c", STOPPER, json.dumps(RUN)]
    folder = tmp_path_factory.mktemp("first")
    with subprocess.Popen(command, cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:

        def call(folder, at, kind=signal.SIGKILL, arguments=RUN):
            print(json.dumps([str(folder), at, int(kind), arguments]), file=process.stdin, flush=True)
            return json.loads(process.stdout.readline())

        yield call


def whole(folder):
    """Check every file with a final name. Returns the names, and the names of all other files."""
    names = (
        sorted(path.name for path in folder.iterdir() if path.name not in (LOCK_NAME, place.REQUEST_NAME))
        if folder.exists()
        else []
    )
    for name in names:
        path = folder / name
        if name == "results.json":
            assert json.loads(path.read_text("utf-8"))["schema"] == "partialslip/result/3"
        elif name == "report.html":
            assert path.read_text("utf-8").rstrip().endswith("</html>")
        elif name == "tractions.csv":
            assert {line.count(",") for line in path.read_text("utf-8").splitlines()} == {6}
        elif name == "state.npz":
            with np.load(path) as file:
                assert {"loads", "cells", "p", "q", "q_error"} == set(file)
    return [name for name in names if name in FILES], [name for name in names if name not in FILES]


def moments(stopped, folder):
    """Return the number of moments at which to stop."""
    code, said = stopped(folder, 0)
    assert code == 0
    return int(said.split("moments")[1])


def stop_and_rerun(stopped, folder, at, kind):
    code, said = stopped(folder, at, kind)
    assert code == (-signal.SIGKILL if kind == signal.SIGKILL else 130), said
    _, left = whole(folder / "out")
    if kind == signal.SIGINT:
        assert said.splitlines()[0] == "partialslip: interrupted"
        assert left == []  # no partial file is left
    assert all(name.startswith(".") for name in left)  # hidden files of a killed run
    assert stopped(folder, 0)[0] == 0
    assert whole(folder / "out") == (FILES, [])


@pytest.mark.slow
@pytest.mark.parametrize(("at", "cases", "kind"), [(25, 1, signal.SIGKILL), (35, 2, signal.SIGINT)])
def test_a_verification_stopped_at_a_write_goes_on(stopped, tmp_path, at, cases, kind):
    """Before the second case is in the ledger, and while the PDF is written."""
    assert stopped(tmp_path, at, kind, VERIFY)[0] == (-signal.SIGKILL if kind == signal.SIGKILL else 130)
    ledger = tmp_path / "out" / "ledger.jsonl"
    kept = ledger.read_bytes() if ledger.exists() else b""
    assert len(kept.splitlines()) == cases
    assert main([*VERIFY[:-1], str(tmp_path / "out")]) == 0
    assert ledger.read_bytes().startswith(kept)
    assert json.loads((tmp_path / "out" / "results.json").read_text("utf-8"))["finished"]
    names = {path.name for path in (tmp_path / "out").iterdir() if path.name != place.REQUEST_NAME}
    assert names == {"ledger.jsonl", "report.html", "report.pdf", "results.csv", "results.json"}


@pytest.mark.slow
@pytest.mark.parametrize("kind", [signal.SIGKILL, signal.SIGINT])
@pytest.mark.parametrize("earlier", [False, True], ids=["first run", "over earlier files"])
def test_stopped_at_every_write(stopped, tmp_path, kind, earlier):
    """A first run also writes what is asked of the folder, and then the same as a run over earlier files, which stay
    complete. One signal comes at every second write, the other one at the writes between."""
    first, again = (moments(stopped, tmp_path) for _ in range(2))
    assert first > again >= 4 * len(FILES)
    for at in range(1 + (kind == signal.SIGINT), (again if earlier else first - again + 3) + 1, 2):
        folder = tmp_path if earlier else tmp_path / str(at)
        folder.mkdir(exist_ok=True)
        stop_and_rerun(stopped, folder, at, kind)


def test_half_a_file_never_takes_a_name(tmp_path):
    """Deliberate fault for comparison: a stopped write in place leaves a partial file under the final name."""

    def half(path):
        path.write_text("half", "utf-8")
        raise KeyboardInterrupt

    write_files(tmp_path, {"a.txt": lambda path: path.write_text("whole", "utf-8")})
    with pytest.raises(KeyboardInterrupt):
        write_files(tmp_path, {"a.txt": half})
    assert [path.read_text("utf-8") for path in tmp_path.iterdir()] == ["whole"]
    with pytest.raises(KeyboardInterrupt):
        half(tmp_path / "a.txt")
    assert (tmp_path / "a.txt").read_text("utf-8") == "half"


def test_a_file_that_is_removed_before_it_is_locked_is_made_again(tmp_path, monkeypatch):
    """Another process tidies up between the making of a temporary file and its lock."""
    true, made = tempfile.mkstemp, []

    def taken(**where):
        handle, name = true(**where)
        if not made:
            files._unlink_if_free(Path(name))
        made.append(name)
        return handle, name

    def write(path):
        path.write_text("whole", "utf-8")
        files._unlink_if_free(path)
        assert path.exists()  # as it is locked

    monkeypatch.setattr(tempfile, "mkstemp", taken)
    write_files(tmp_path, {"a.txt": write})
    assert len(made) == 2
    assert [path.read_text("utf-8") for path in tmp_path.iterdir()] == ["whole"]


def test_only_what_nobody_writes_is_tidied_up(tmp_path):
    """Temporary files of killed writes are removed; files that another process is writing, and other files, stay."""
    code = (
        "import sys, time; from pathlib import Path; from partialslip.tools.output.files import write_files\n"
        "def write(path):\n path.write_text('half', 'utf-8'); print('busy', flush=True); time.sleep(60)\n"
        "write_files(Path('.'), {'a.txt': write})"
    )
    busy = [subprocess.Popen([sys.executable, "-c", code], cwd=tmp_path, stdout=subprocess.PIPE) for _ in range(2)]
    (tmp_path / ".a-mine.txt").write_text("mine", "utf-8")
    try:
        for process in busy:
            assert process.stdout.readline() == b"busy\n"
        busy[0].kill()
        busy[0].wait()
        assert len(list(tmp_path.iterdir())) == 3
        write_files(tmp_path, {"a.txt": lambda path: path.write_text("whole", "utf-8")})
        names = sorted(path.name for path in tmp_path.iterdir())
        assert len(names) == 3
        assert {".a-mine.txt", "a.txt"} < set(names)
    finally:
        for process in busy:
            process.kill()
            process.communicate()


def test_a_temporary_figure_of_a_killed_study_is_not_included(tmp_path):
    (tmp_path / "size.svg").write_text("<svg/>", "utf-8")
    (tmp_path / ".size-abcd1234.partial.svg").write_text("<sv", "utf-8")
    (tmp_path / ".cases-abcd1234.partial.csv").write_text("width", "utf-8")
    study = read_study(tmp_path)
    assert ([*study.figures], [*study.tables]) == (["size.svg"], [])
