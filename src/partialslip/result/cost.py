"""The cost of a method: CPU seconds, wall seconds and memory."""

import contextlib
import math
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from partialslip.tools.allowance import Allowance

try:
    import resource
except ImportError:  # Windows
    resource = None  # type: ignore[assignment]

_STATUS, _CLEAR = Path("/proc/self/status"), Path("/proc/self/clear_refs")
# limit: MB by which the mark may exceed the present memory without a reset: the kernel counts in batches
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


@dataclass(frozen=True)
class Cost:
    """CPU seconds, wall seconds and memory.

    Parameters
    ----------
    cpu_s, wall_s : float
        CPU seconds, meshing process included, and wall seconds.
    peak_rss_mb : float or None
        Peak resident memory of this process while the method ran, MB, without the meshing process; None if not known.
    phases : mapping of str to float
        CPU seconds by phase.
    meshing_cpu_s : float
        CPU seconds of the meshing process; ``cpu_s`` includes them.
    start_rss_mb : float or None
        Resident memory when the method started, MB: interpreter, libraries and earlier results. The method itself
        needed the difference to the peak. None where the system does not report it.
    peak_rss_unknown : str
        Why ``peak_rss_mb`` is None; empty if it is known.
    """

    cpu_s: float
    wall_s: float
    peak_rss_mb: float | None
    phases: Mapping[str, float] = field(default_factory=dict)
    meshing_cpu_s: float = 0.0
    start_rss_mb: float | None = None
    peak_rss_unknown: str = ""


class Clock:
    """Measure the cost of a method by phase.

    Parameters
    ----------
    allowance : Allowance, optional
        CPU seconds that the method may take.
    """

    def __init__(self, allowance: Allowance | None = None) -> None:
        self._allowance, self._memory = allowance, PeakMeter()
        self._cpu, self._wall = time.process_time(), time.perf_counter()
        self._meshing = 0.0
        self.phases: dict[str, float] = {}

    @contextmanager
    def phase(self, name: str) -> Iterator[None]:
        """Add the CPU seconds of the block to phase ``name``."""
        start = time.process_time()
        try:
            yield
        finally:
            self.phases[name] = self.phases.get(name, 0.0) + time.process_time() - start

    def add_earlier(self, cpu: float, wall: float) -> None:
        """Add ``cpu`` and ``wall`` seconds of work that was done for this method before it began."""
        self._cpu -= cpu
        self._wall -= wall

    def add_meshing(self, seconds: float) -> None:
        """Add CPU ``seconds`` of the meshing process to phase "mesh"."""
        self.phases["mesh"] = self.phases.get("mesh", 0.0) + seconds
        self._meshing += seconds
        if self._allowance:
            self._allowance.spend(seconds)

    @property
    def limited(self) -> bool:
        """Whether there is an allowance, and a finite one."""
        return self.remaining() < math.inf

    def remaining(self) -> float:
        """Return the CPU seconds left; infinite without an allowance."""
        return self._allowance.remaining() if self._allowance else math.inf

    def cost(self) -> Cost:
        """Return the cost up to now."""
        own, wall = time.process_time() - self._cpu, time.perf_counter() - self._wall
        memory = self._memory.peak()
        return Cost(
            cpu_s=own + self._meshing,
            wall_s=wall,
            peak_rss_mb=memory.peak_mb,
            phases=self.phases,
            meshing_cpu_s=self._meshing,
            start_rss_mb=memory.start_mb,
            peak_rss_unknown=memory.unknown,
        )
