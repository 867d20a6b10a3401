"""Run another code in a process of its own, on one thread, and measure what it costs; what a code hands over."""

import os
import shutil
import subprocess
import threading
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import NamedTuple

from partialslip.result import Result

LONGEST = 1800.0  # limit: s
_ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")


class CodeOutcome(NamedTuple):
    """Outcome of a code.

    Parameters
    ----------
    result : Result or None
        None if the code did not finish.
    why : str
        Why it did not.
    unknowns : int or None
    cpu_s : float or None
        CPU seconds of the processes.
    memory_mb : float or None
        Peak memory.
    inputs : mapping of str to bytes
        Input files of the code by name; none for methods of partialslip.
    """

    result: Result | None
    why: str = ""
    unknowns: int | None = None
    cpu_s: float | None = None
    memory_mb: float | None = None
    inputs: Mapping[str, bytes] = {}


class Ran(NamedTuple):
    """Exit ``code`` (None if the process was stopped after :data:`LONGEST`), what it printed, CPU seconds and peak
    memory, MB."""

    code: int | None
    text: str
    cpu_s: float
    memory_mb: float


def ran(command: list[str], folder: Path) -> Ran:
    """Run ``command`` in ``folder``."""
    with open(folder / "printed.txt", "w+", encoding="utf-8", errors="replace") as printed:
        process = subprocess.Popen(
            command, cwd=folder, env=os.environ | _ONE_THREAD, stdout=printed, stderr=subprocess.STDOUT
        )
        late = threading.Event()

        def stop() -> None:
            late.set()
            process.kill()

        timer = threading.Timer(LONGEST, stop)
        timer.start()
        try:
            _, status, usage = os.wait4(process.pid, 0)
        except BaseException:
            process.kill()
            raise
        finally:
            timer.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        printed.seek(0)
        text = printed.read()
    spent = usage.ru_utime + usage.ru_stime
    return Ran(None if late.is_set() else process.returncode, text, spent, usage.ru_maxrss / 1024)


@cache
def python_with(variable: str, version: str) -> tuple[str, str] | None:
    """A Python that can run ``version``, a program that prints the version of a code, and what it prints.

    The environment variable ``variable`` names this Python; without it, it is the first python3 on the PATH that can.
    None if there is none.
    """
    named = os.environ.get(variable)
    folders = os.environ.get("PATH", "").split(os.pathsep)
    candidates = [named] if named else [found for each in folders if (found := shutil.which("python3", path=each))]
    for python in dict.fromkeys(candidates):
        try:
            told = subprocess.run([python, "-c", version], capture_output=True, text=True, timeout=60, check=False)
        except (OSError, subprocess.TimeoutExpired):
            continue
        if told.returncode == 0:
            return python, told.stdout.strip().splitlines()[-1]
    return None
