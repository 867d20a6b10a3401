"""Peak resident memory of this process: from now on, and since the process started.

The system keeps one high-water mark a process, so a method would report what an earlier method needed. On Linux the
mark can be reset (5 to /proc/self/clear_refs, see proc_pid_clear_refs(5)). Elsewhere the peak of a method is known only
if the method raises the mark.
"""

import contextlib
import sys
from pathlib import Path
from typing import NamedTuple

try:
    import resource
except ImportError:  # Windows
    resource = None  # type: ignore[assignment]

_STATUS, _CLEAR = Path("/proc/self/status"), Path("/proc/self/clear_refs")
# accuracy: MB by which the mark may exceed the present memory without a reset: the kernel counts in batches
_SLACK = 1.0
_before_resets = 0.0  # MB, highest mark that a reset has removed


class Peak(NamedTuple):
    """Resident memory over a part of the life of this process.

    Parameters
    ----------
    start_mb : float or None
        Memory at the start, MB; None where the system does not report it.
    peak_mb : float or None
        Largest memory, MB; None if not known.
    unknown : str
        Why the peak is not known; empty if the peak is known.
    """

    start_mb: float | None
    peak_mb: float | None
    unknown: str = ""


class PeakMeter:
    """Measure the peak resident memory of this process from now on.

    The high-water mark is reset only if the process has needed more memory before than it has now: a reset also lowers
    the peak that the system reports to others, for example to ``time -v``.
    """

    def __init__(self) -> None:
        self._start, mark = _memory()
        self._floor = 0.0  # MB, a mark that is not of this part
        if mark is not None and (self._start is None or mark > self._start + _SLACK) and not _reset(mark):
            self._floor = mark

    def peak(self) -> Peak:
        """Return the peak up to now."""
        mark = _memory()[1]
        if mark is None:
            return Peak(self._start, None, "this system does not report it")
        if mark <= self._floor:
            return Peak(self._start, None, f"at most {mark:.0f} MB, which this process had needed before")
        return Peak(self._start, mark)


def process_peak_mb() -> float | None:
    """Return the peak resident memory of this process since its start, MB; None where the system does not report
    it."""
    mark = _memory()[1]
    return None if mark is None else max(mark, _before_resets)


def _memory() -> tuple[float | None, float | None]:
    """Return the present resident memory and the high-water mark, MB; None where the system does not report them."""
    with contextlib.suppress(OSError, ValueError, IndexError, KeyError):
        lines = dict(line.split(":", 1) for line in _STATUS.read_text("ascii", "replace").splitlines())
        now, mark = (float(lines[key].split()[0]) / 1024 for key in ("VmRSS", "VmHWM"))
        return now, max(now, mark)
    if resource is None:
        return None, None
    mark = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss  # bytes on macOS, kilobytes elsewhere
    return None, mark / (1024**2 if sys.platform == "darwin" else 1024)


def _reset(mark: float) -> bool:
    """Reset the high-water mark, which stands at ``mark`` MB. Returns whether the system allowed the reset."""
    global _before_resets  # the mark belongs to the process
    try:
        _CLEAR.write_text("5", "ascii")
    except OSError:
        return False
    _before_resets = max(_before_resets, mark)
    return True
