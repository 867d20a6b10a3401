"""The lock of a folder when the disk is full, and locks that are empty or garbled; a terminal that closes."""

import os
import signal
import subprocess
import sys
import time

import pytest

from partialslip.tools.output import lock
from partialslip.tools.output.lock import LOCK_NAME, FolderInUseError, locked

resource = pytest.importorskip("resource")

# Locks the folder with files of no size at all, as on a full disk.
FULL = """
import resource, sys
from pathlib import Path
from partialslip.tools.errors import InputError
from partialslip.tools.output.lock import locked
resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))
try:
    with locked(Path(sys.argv[1])):
        print("locked")
except InputError as error:
    print(error)
"""
HANG_UP = """
import os, signal, sys
from partialslip.study.batch.sweep import workers
from partialslip.cli.ending import ended
def command():
    with workers(processes=2) as pool:
        found = [pool.submit(os.getpid) for _ in range(4)]
        print(sorted({each.result() for each in found})[0] > 0, flush=True)
        pool.submit(signal.pause).result()
    return 0
sys.exit(ended(command))
"""


@pytest.mark.parametrize("before", [None, "", "process 1 on nowhere"])
def test_a_full_disk_leaves_no_lock(tmp_path, before):
    folder = tmp_path / "out"
    if before is not None:
        folder.mkdir()
        (folder / LOCK_NAME).write_text(before)
    said = subprocess.run([sys.executable, "-c", FULL, str(folder)], capture_output=True, text=True, check=True)
    assert said.stderr == ""
    assert said.stdout.startswith(f"--out {folder}: cannot be written: ")
    assert not (folder / LOCK_NAME).exists()
    assert folder.exists() == (before is not None)


def test_half_a_signature_is_a_full_disk(tmp_path, monkeypatch):
    monkeypatch.setattr(lock.os, "write", lambda *_: 3)
    with pytest.raises(ValueError, match="No space left"), locked(tmp_path / "out"):
        pass
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("left", [b"", b"\x00\xff garbled \n\x1b[31m", b"process 1 on nowhere"])
def test_a_lock_that_nobody_holds_is_taken_over(tmp_path, left):
    (tmp_path / LOCK_NAME).write_bytes(left)
    with locked(tmp_path):
        assert (tmp_path / LOCK_NAME).read_text().startswith(f"process {os.getpid()} on ")
    assert not (tmp_path / LOCK_NAME).exists()


@pytest.mark.parametrize(("left", "who"), [(b"", "another process"), (b"\xff\x1b[31m", "another process"),
                                           (b"process 9 on far", "process 9 on far")])  # fmt: skip
def test_a_lock_that_is_held_says_by_whom_if_it_can(tmp_path, left, who):
    with locked(tmp_path):
        (tmp_path / LOCK_NAME).write_bytes(left)
        with pytest.raises(FolderInUseError, match=f": {who} is writing there: wait"), locked(tmp_path):
            pass


@pytest.mark.parametrize(("number", "line"), [(signal.SIGHUP, "the terminal has gone"), (signal.SIGTERM, "terminated"),
                                               (signal.SIGINT, "interrupted")])  # fmt: skip
def test_a_signal_to_all_processes_ends_workers_with_one_line(tmp_path, number, line):
    """A terminal that closes, a batch system and Ctrl-C signal all processes, also Python's process that tracks
    what they leave."""
    (tmp_path / "hang_up.py").write_text(HANG_UP)
    with subprocess.Popen(
        [sys.executable, "hang_up.py"], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        start_new_session=True, preexec_fn=lambda: signal.signal(number, signal.SIG_DFL),  # ignored under nohup
    ) as process:  # fmt: skip
        assert process.stdout.readline() == "True\n"
        time.sleep(0.2)
        os.killpg(process.pid, number)
        _, said = process.communicate(timeout=60)
    assert said == f"partialslip: {line}\n"
    assert process.returncode == 128 + number
