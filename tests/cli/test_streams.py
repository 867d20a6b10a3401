"""Standard streams that are full, closed or lack characters; signals; two commands in one folder."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from partialslip.cli import main
from partialslip.tools.errors import InputError
from partialslip.tools.output.lock import LOCK_NAME, locked

COMMAND = (sys.executable, "-m", "partialslip")
EXACT = ("run", "hertz-shear", "--with", "exact")
FULL = pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")


def partialslip(folder, *arguments, **settings):
    """Run in a new process. Returns exit code, stdout and stderr."""
    environment = {**os.environ, **settings.pop("env", {})}
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE} | settings
    done = subprocess.run([*COMMAND, *arguments], cwd=folder, check=False, env=environment, **streams)
    return done.returncode, done.stdout, (done.stderr or b"").decode()


@FULL
@pytest.mark.parametrize("arguments", [["scenes"], ["--help"], ["--version"], [*EXACT, "--json"]], ids=" ".join)
@pytest.mark.parametrize("unbuffered", ["", "1"])
def test_a_full_disk(tmp_path, arguments, unbuffered):
    with Path("/dev/full").open("wb") as full:
        code, _, said = partialslip(tmp_path, *arguments, stdout=full, env={"PYTHONUNBUFFERED": unbuffered})
    assert (code, said) == (2, "partialslip: standard output: cannot be written: No space left on device\n")


@pytest.mark.parametrize("arguments", [["scenes"], ["--help"], EXACT], ids=" ".join)
def test_a_reader_that_has_gone(tmp_path, arguments):
    """No message; the exit code is the shell's for SIGPIPE, not 1 for a missed bar; files are written."""
    reader, writer = os.pipe()
    os.close(reader)
    code, _, said = partialslip(tmp_path, *arguments, stdout=writer)
    os.close(writer)
    assert (code, said) == (141, "")
    assert len(list(tmp_path.glob("results/hertz-shear-*/results.json"))) == (arguments == EXACT)


@pytest.mark.parametrize(("closing", "code"), [(">&-", 2), ("2>&-", 2), ("2>/dev/full", 2), ("<&-", 2)])
def test_closed_streams(tmp_path, closing, code):
    """Errors never go to stdout, and no file gets the number of a closed stream."""
    line = f'"$0" -m partialslip run nosuch {closing}'
    done = subprocess.run(["sh", "-c", line, sys.executable], cwd=tmp_path, capture_output=True, check=False)
    assert (done.returncode, done.stdout) == (code, b"")
    assert len(done.stderr.splitlines()) == (0 if closing.startswith("2") else 1)


@pytest.mark.parametrize("encoding", ["ascii", pytest.param("cp932", marks=pytest.mark.slow)])
def test_poor_encodings(tmp_path, encoding):
    """Every character is printed or escaped, and tables have ASCII rules."""
    title = "Größe ΔQ 接触"
    code, out, said = partialslip(tmp_path, *EXACT, "--set", f"title={title}", env={"PYTHONIOENCODING": encoding})
    assert (code, said) == (0, "")
    shown = title.encode(encoding, "backslashreplace").decode(encoding)
    assert out.decode(encoding).splitlines()[0] == f"hertz-shear: {shown}"


def test_units_have_plain_letters():
    assert [f"1 µm, {c}".encode("ascii", "partialslip") for c in "ö接"] == [b"1 um, \\xf6", rb"1 um, \u63a5"]
    assert "1 µm".encode("latin-1", "partialslip").decode("latin-1") == "1 µm"


def test_no_word_of_matplotlib_where_home_cannot_be_written(tmp_path):
    (tmp_path / "file").touch()
    nowhere = {"HOME": str(tmp_path / "file"), "MPLCONFIGDIR": str(tmp_path / "file"), "XDG_CACHE_HOME": ""}
    code, _, said = partialslip(tmp_path, *EXACT, env=nowhere)
    assert (code, said) == (0, "")


def test_a_fault_is_one_line_and_its_own_exit_code(monkeypatch, capsys):
    def fault(*_):
        raise ZeroDivisionError("none\nleft")

    monkeypatch.setattr("partialslip.shipped_scenes", fault)
    assert main(["scenes"]) == 3
    said = capsys.readouterr().err
    assert re.fullmatch(r"partialslip: a fault of partialslip, .*: test_streams.py, line \d+: .*\n", said)
    monkeypatch.setenv("PARTIALSLIP_TRACEBACK", "1")
    with pytest.raises(ZeroDivisionError):
        main(["scenes"])


def test_an_error_without_a_progress_bar_is_one_line(tmp_path, monkeypatch, refused):
    """If stderr is not a terminal. The oversized case is refused after the start of the progress bar."""
    monkeypatch.chdir(tmp_path)
    over = ["--over", "bodies.*.depth=1,2"]
    refused("study", "size", "hertz-shear", *over, "--processes", "1")
    assert list(tmp_path.iterdir()) == []


def test_a_lock_goes_and_takes_empty_folders_with_it(tmp_path):
    folder = tmp_path / "a" / "b"
    with locked(folder):
        assert folder.exists()
        with pytest.raises(InputError, match=rf"process {os.getpid()} on "), locked(folder):
            pass
        assert folder.exists()
    assert list(tmp_path.iterdir()) == []
    folder.mkdir(parents=True)
    (folder / LOCK_NAME).write_text("process 1 on another", "utf-8")  # left by a killed command
    with locked(folder):
        (folder / "results.json").touch()
    assert [path.name for path in folder.iterdir()] == ["results.json"]


def test_without_locks_a_folder_is_written_all_the_same(tmp_path, monkeypatch):
    """Some file systems have no locks."""

    def none(*_):
        raise OSError(95, "Operation not supported")

    fcntl = pytest.importorskip("fcntl")
    monkeypatch.setattr(fcntl, "flock", none)
    with locked(tmp_path / "a"):
        assert (tmp_path / "a").exists()
