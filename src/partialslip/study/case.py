"""One case of a study: a scene solved by some methods, as figures without curves, here or in a process of its own."""

import json
import subprocess
import sys
import tempfile
import time
import uuid
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from partialslip.errors import InputError, PartialslipError
from partialslip.reading import parse_scene
from partialslip.report import record, write_run
from partialslip.run import Run, run
from partialslip.scene import Scene
from partialslip.study.ledger import key_of, scene_content
from partialslip.study.sweep import Task

if TYPE_CHECKING:
    from partialslip_fem import Kept


@dataclass(frozen=True)
class Case:
    """A scene, the methods to solve it by, and ``labels`` that say which point of the study it is."""

    scene: Scene
    methods: tuple[str, ...]
    labels: Mapping[str, str | float] = field(default_factory=dict)

    @property
    def data(self) -> dict[str, Any]:
        """It as plain data, of which it can be made again."""
        return {"scene": msgspec.to_builtins(self.scene), "methods": list(self.methods), "labels": dict(self.labels)}

    @property
    def key(self) -> str:
        """The same for the same case by the same source files only."""
        return key_of({**self.data, "scene": scene_content(self.scene)})

    @property
    def task(self) -> Task:
        """It as work for a sweep."""
        return Task(self.key, solve, self.data)


def solve(
    data: Mapping[str, Any], also: Callable[[Run], Mapping[str, Any]] = lambda _: {}, keep: "Kept | None" = None
) -> dict[str, Any]:
    """Solve a case given as :attr:`Case.data`; its figures and what ``also`` has to say of the run, or ``error``: what
    cannot be solved, in one line. ``keep`` is as for :func:`partialslip.run`."""
    try:
        outcome = run(parse_scene(data["scene"]), data["methods"], keep=keep)
    except InputError as error:  # what this machine lacks is no finding, and is not to be kept as one
        return {**data, "error": str(error)}
    return {**data, **record(outcome, curves=False), **also(outcome)}


class Sharing:
    """:func:`solve` for a sweep: cases that one process solves share their factored meshes. It can be pickled."""

    def __init__(self) -> None:
        self._sweep = uuid.uuid4().hex

    def __call__(self, data: Mapping[str, Any]) -> dict[str, Any]:
        return solve(data, keep=_kept_in(self._sweep) if "fem" in data["methods"] else None)


@lru_cache(maxsize=1)
def _kept_in(_sweep: str) -> "Kept":
    """What this process keeps in a sweep, until it works for another one."""
    from partialslip_fem import Kept

    return Kept()


def solve_apart(case: Case) -> dict[str, Any]:
    """Solve ``case`` in a new process; also ``process``: the CPU seconds (in all, and of writing the report), wall
    seconds and peak memory (MB) of that process, start and imports included. Raises PartialslipError if it dies."""
    command = [sys.executable, "-m", "partialslip.study.case"]
    began = time.perf_counter()
    done = subprocess.run(command, input=json.dumps(case.data), capture_output=True, text=True, check=False)
    if done.returncode != 0:
        last = (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1]
        raise PartialslipError(f"{case.scene.name} {dict(case.labels)}: the process died: {last}")
    found: dict[str, Any] = json.loads(done.stdout)
    found.setdefault("process", {})["wall_s"] = time.perf_counter() - began
    return found


def _costs(outcome: Run) -> dict[str, Any]:
    """Of this process up to now, and of writing the report."""
    cpu = time.process_time() + sum(each.cost.meshing_cpu_s for each in outcome.results.values())
    began = time.process_time()
    with tempfile.TemporaryDirectory() as folder:
        write_run(outcome, Path(folder))
    costs = {"cpu_s": cpu, "report_cpu_s": time.process_time() - began}
    return {"process": costs | {"peak_rss_mb": max(each.cost.peak_rss_mb or 0.0 for each in outcome.results.values())}}


if __name__ == "__main__":
    print(json.dumps(solve(json.load(sys.stdin), _costs), allow_nan=False))
