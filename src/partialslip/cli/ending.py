"""End of a command: turn every exception into one line on stderr and an exit code.

Exit codes: 0 success; 1 a bar missed, or a case not solved; 2 bad input, or output that cannot be written; 3 a fault of
partialslip; 4 bars asked for, but headline quantities not judged (:mod:`partialslip.run.judge.verdicts`); 128 + signal
number if ended by a signal: 129 (terminal closed), 130 (Ctrl-C), 141 (reader of the output closed) and 143
(terminated).
"""

import codecs
import contextlib
import errno
import logging
import os
import signal
import sys
import threading
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path
from types import FrameType
from typing import Any, NamedTuple, NoReturn, TextIO

from partialslip.tools.errors import PartialslipError, one_line

REFUSED, FAULT, INTERRUPTED, NO_READER = 2, 3, 130, 141  # fixed: exit codes
TRACEBACK = "PARTIALSLIP_TRACEBACK"  # environment variable: if set, faults are raised

_FALLBACK = "partialslip"
_ASCII = {"µ": "u"}
_WRITING = (errno.ENOSPC, errno.EIO, errno.EBADF, errno.EFBIG, errno.EDQUOT)
_SIGNALS = {"SIGTERM": "terminated", "SIGHUP": "the terminal has gone"}


class _Signal(BaseException):
    """Raised when a signal arrives, so that files, locks and worker processes are cleaned up."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


class _End(NamedTuple):
    """Exit code and message; the message may be empty."""

    code: int
    line: str = ""


def ended(command: Callable[[], int]) -> int:
    """Run ``command`` and return the exit code. Exceptions are printed in one line and set the exit code."""
    with _streams(), _quiet_libraries():
        if sys.stdout is None or sys.stdout.closed:
            end = _End(REFUSED, "standard output: cannot be written: is closed")
        else:
            end = _flushed(_ended(command))
        if end.line:
            _say(end.line)
        return end.code


def _ended(command: Callable[[], int]) -> _End:
    try:
        with _signals():
            return _End(command())
    except PartialslipError as error:
        return _End(REFUSED, str(error))
    except MemoryError:
        return _End(REFUSED, "not enough memory: use a coarser accuracy or larger elements")
    except BrokenPipeError:
        return _End(NO_READER)
    except OSError as error:
        return _End(REFUSED, f"{_place(error)}: {error.strerror or error}")
    except KeyboardInterrupt as error:
        return _End(INTERRUPTED, ": ".join(filter(None, ("interrupted", str(error)))))
    except _Signal as error:
        return _End(128 + error.number, _SIGNALS[signal.Signals(error.number).name])
    except SystemExit as error:  # --help and --version
        return _End(error.code if isinstance(error.code, int) else 0)
    except Exception as error:
        if os.environ.get(TRACEBACK):
            raise
        last = traceback.extract_tb(error.__traceback__)[-1]
        place = f"{Path(last.filename).name}, line {last.lineno}"
        said = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
        return _End(FAULT, f"a fault of partialslip, please report it ({TRACEBACK}=1 shows more): {place}: {said}")


def _place(error: OSError) -> str:
    if error.filename:
        return str(error.filename)
    return "standard output: cannot be written" if error.errno in _WRITING else "system"


def _flushed(end: _End) -> _End:
    """Flush stdout. Returns ``end``, or the end for a failed write; the unwritten output is dropped."""
    try:
        sys.stdout.flush()
    except OSError as error:
        _drop(sys.stdout)
        if isinstance(error, BrokenPipeError):
            return _End(NO_READER)
        return _End(REFUSED, f"standard output: cannot be written: {error.strerror or error}")
    return end


def _say(text: str) -> None:
    try:
        print(f"partialslip: {one_line(text)}", file=sys.stderr, flush=True)
    except (OSError, ValueError):  # stderr cannot be written either
        _drop(sys.stderr)


def _drop(stream: TextIO) -> None:
    """Redirect ``stream`` to the null device. Python would otherwise retry at exit and change the exit code."""
    with contextlib.suppress(OSError, ValueError):
        void = os.open(os.devnull, os.O_WRONLY)
        os.dup2(void, stream.fileno())
        os.close(void)


@contextlib.contextmanager
def _streams() -> Iterator[None]:
    """Make standard streams accept every character, and open missing ones.

    The next file opened would otherwise get the number of the missing stream, and the stream's output.
    """
    while (handle := os.open(os.devnull, os.O_RDWR)) <= 2:
        pass
    os.close(handle)
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w")  # noqa: SIM115
    streams: list[Any] = [each for each in (sys.stdout, sys.stderr) if hasattr(each, "reconfigure") and not each.closed]
    before = [(stream, stream.errors) for stream in streams]
    for stream in streams:
        stream.reconfigure(errors=_FALLBACK)
    try:
        yield
    finally:
        for stream, errors in before:
            with contextlib.suppress(OSError, ValueError):
                stream.reconfigure(errors=errors)


def _fallback(error: UnicodeError) -> tuple[str | bytes, int]:
    """Replace characters that an encoding lacks: ASCII letters for units, else escaped character codes."""
    if isinstance(error, UnicodeEncodeError) and (plain := _ASCII.get(error.object[error.start])):
        return plain, error.start + 1
    return codecs.backslashreplace_errors(error)


@contextlib.contextmanager
def _quiet_libraries() -> Iterator[None]:
    """Silence warnings of libraries: stderr gets one line only."""
    logger = logging.getLogger("matplotlib")
    level = logger.level
    logger.setLevel(logging.ERROR)
    try:
        yield
    finally:
        logger.setLevel(level)


@contextlib.contextmanager
def _signals() -> Iterator[None]:
    """Turn terminating signals into exceptions while the block runs; ignored signals (nohup) stay ignored."""
    numbers = [getattr(signal, name) for name in _SIGNALS if hasattr(signal, name)]
    if threading.current_thread() is not threading.main_thread():
        numbers = []
    taken = [number for number in numbers if signal.getsignal(number) is signal.SIG_DFL]
    for number in taken:
        signal.signal(number, _raise)
    try:
        yield
    finally:
        for number in taken:
            signal.signal(number, signal.SIG_DFL)


def _raise(number: int, _: FrameType | None) -> NoReturn:
    signal.signal(number, signal.SIG_DFL)  # a second signal ends the process at once
    raise _Signal(number)


codecs.register_error(_FALLBACK, _fallback)
