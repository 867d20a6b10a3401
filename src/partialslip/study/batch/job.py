"""One job of a study: solve a scene by some methods, in this process or in a new one; keep values without curves."""

import subprocess
import sys
import tempfile
import time
import uuid
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec

from partialslip.report import Record, record, write_run
from partialslip.result.cost import process_peak_mb
from partialslip.run import Run, run
from partialslip.scene import Scene
from partialslip.study.batch.ledger import case_key, scene_content
from partialslip.study.batch.sweep import Task
from partialslip.study.fatigue import HotSpot, hot_spots
from partialslip.tools.errors import InputError, PartialslipError

if TYPE_CHECKING:
    from partialslip_fem import Kept

Labels = Mapping[str, str | float]


_AGREE = 0.1  # cost: relative difference of CPU seconds that are known well enough
_LONG = 5.0  # cost: CPU seconds of a method, of which imports (0.3 s) are less than that


@dataclass(frozen=True)
class Job:
    """One job of a study.

    Parameters
    ----------
    scene : Scene
    methods : tuple of str
    labels : mapping of str to str or float
        Point of the study.
    stresses : bool
        Whether to find hot spots (:func:`partialslip.study.fatigue.hot_spots`).
    """

    scene: Scene
    methods: tuple[str, ...]
    labels: Labels = field(default_factory=dict)
    stresses: bool = False

    @property
    def key(self) -> str:
        """Key that identifies the job and the source files."""
        return case_key({**msgspec.to_builtins(self), "scene": scene_content(self.scene)})

    @property
    def task(self) -> Task:
        """The job as a task of a sweep."""
        return Task(self.key, solve_job, self)


class ProcessCost(msgspec.Struct, frozen=True):
    """Cost of a process, start and imports included.

    Parameters
    ----------
    cpu_s, report_cpu_s : float
        CPU seconds without the report, and of writing the report.
    peak_rss_mb : float
        Peak resident memory since the start of the process, MB, without the report; 0 where the system does not
        report it.
    wall_s : float
        Wall seconds.
    again_cpu_s : float
        CPU seconds of solving again.
    """

    cpu_s: float
    report_cpu_s: float
    peak_rss_mb: float
    wall_s: float = 0.0
    again_cpu_s: float = 0.0


class Solved(msgspec.Struct, frozen=True, kw_only=True):
    """Outcome of a job, as a ledger stores it.

    Parameters
    ----------
    labels : mapping of str to str or float
        Point of the study.
    run : Record or None
        The run without curves; None if the job failed.
    error : str
        Message in one line; empty if the job succeeded.
    process : ProcessCost or None
        Cost of the process, if the job had a process to itself.
    stresses : mapping of str to mapping of str to HotSpot
        Hot spots by method and quantity; empty if the job asks for no stresses.
    """

    labels: Labels
    run: Record | None = None
    error: str = ""
    process: ProcessCost | None = None
    stresses: Mapping[str, Mapping[str, HotSpot]] = {}


def solve_job(job: Job, keep: "Kept | None" = None) -> Solved:
    """Solve ``job``; ``keep`` as in :func:`partialslip.run`."""
    return _job_outcome(job, keep)[0]


def _job_outcome(job: Job, keep: "Kept | None" = None) -> tuple[Solved, Run | None]:
    try:
        outcome = run(job.scene, job.methods, subsurface=job.stresses, keep=keep)
        found = outcome.results.items() if job.stresses else ()
        spots = {name: hot_spots(job.scene, result) for name, result in found}
    except InputError as error:  # a library missing on this machine must not enter the ledger, and is raised
        return Solved(labels=job.labels, error=str(error)), None
    return Solved(labels=job.labels, run=record(outcome, curves=False), stresses=spots), outcome


class Sharing:
    """``do``, by default :func:`solve`, for a sweep, picklable: jobs in one process share factored meshes."""

    def __init__(self, do: "Callable[[Job, Kept | None], Solved] | None" = None) -> None:
        self._do, self._sweep = do or solve_job, uuid.uuid4().hex

    def __call__(self, job: Job) -> Solved:
        return self._do(job, _kept_in(self._sweep) if "fem" in job.methods else None)


@lru_cache(maxsize=1)
def _kept_in(_sweep: str) -> "Kept":
    """Return the factored meshes that this process keeps for one sweep."""
    from partialslip_fem import Kept

    return Kept()


def solve_apart(job: Job, repeats: int = 1) -> Solved:
    """Solve ``job`` in a new process and measure the cost of the process, up to the first solution.

    The process solves at most ``repeats`` times, until the two smallest CPU seconds of the method agree, and returns
    the cheapest solution: the first one also imports libraries. Raises PartialslipError if the process dies.
    """
    command = [sys.executable, "-m", "partialslip.study.batch.job", str(repeats)]
    began = time.perf_counter()
    done = subprocess.run(command, input=msgspec.json.encode(job), capture_output=True, check=False)
    if done.returncode != 0:
        last = (done.stderr.decode(errors="replace").strip().splitlines() or [f"exit code {done.returncode}"])[-1]
        raise PartialslipError(f"{job.scene.name} {dict(job.labels)}: the process died: {last}")
    found = msgspec.json.decode(done.stdout, type=Solved)
    if found.process is None:
        return found
    wall_s = time.perf_counter() - began
    return msgspec.structs.replace(found, process=msgspec.structs.replace(found.process, wall_s=wall_s))


def _costs(outcome: Run) -> ProcessCost:
    """Return the cost of this process up to now, and of writing the report."""
    cpu = time.process_time() + sum(each.cost.meshing_cpu_s for each in outcome.results.values())
    peak = process_peak_mb() or 0.0
    began = time.process_time()
    with tempfile.TemporaryDirectory() as folder:
        write_run(outcome, Path(folder))
    report = time.process_time() - began
    return ProcessCost(cpu, report, peak)


def _timing_settled(seconds: Sequence[float]) -> bool:
    """Whether the two smallest CPU ``seconds`` agree, or the first ones are so many that imports do not count."""
    least, *others = sorted(seconds)
    return least > _LONG or bool(others and others[0] <= (1 + _AGREE) * least)


def _solve_from_stdin(repeats: int) -> None:
    """Read a job as JSON from stdin, solve it, and write the outcome as JSON to stdout."""
    job = msgspec.json.decode(sys.stdin.buffer.read(), type=Job)
    found, outcome = _job_outcome(job)
    if outcome:
        costs, method = _costs(outcome), job.methods[-1]
        outcomes, began = [outcome], time.process_time()
        while len(outcomes) < repeats and not _timing_settled([each[method].cost.cpu_s for each in outcomes]):
            outcomes.append(run(job.scene, job.methods, subsurface=job.stresses))
        again = time.process_time() - began + sum(each[method].cost.meshing_cpu_s for each in outcomes[1:])
        cheapest = min(outcomes, key=lambda each: each[method].cost.cpu_s)
        costs = msgspec.structs.replace(costs, again_cpu_s=again)
        found = msgspec.structs.replace(found, run=record(cheapest, curves=False), process=costs)
    sys.stdout.buffer.write(msgspec.json.encode(found))


if __name__ == "__main__":
    _solve_from_stdin(int(sys.argv[1]))
