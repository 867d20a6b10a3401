"""The cost of a method: CPU seconds, wall seconds and memory."""

import math
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field

from partialslip.result.memory import PeakMeter
from partialslip.tools.allowance import Allowance


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
