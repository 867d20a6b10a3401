"""One case of a study: a scene solved by some methods, as figures without curves, here or in a process of its own."""

import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import msgspec

from partialslip.errors import InputError, PartialslipError
from partialslip.reading import parse_scene
from partialslip.report import record, write_run
from partialslip.run import Run, run
from partialslip.scene import Scene
from partialslip.study.ledger import key_of, scene_content
from partialslip.study.sweep import Task


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


def solve(data: Mapping[str, Any], also: Callable[[Run], Mapping[str, Any]] = lambda _: {}) -> dict[str, Any]:
    """Solve a case given as :attr:`Case.data`; its figures and what ``also`` has to say of the run, or ``error``: what
    cannot be solved, in one line."""
    try:
        outcome = run(parse_scene(data["scene"]), data["methods"])
    except InputError as error:  # what this machine lacks is no finding, and is not to be kept as one
        return {**data, "error": str(error)}
    return {**data, **record(outcome, curves=False), **also(outcome)}


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
    cpu = time.process_time()
    with tempfile.TemporaryDirectory() as folder:
        write_run(outcome, Path(folder))
    costs = {"cpu_s": cpu, "report_cpu_s": time.process_time() - cpu}
    return {"process": costs | {"peak_rss_mb": max(each.cost.peak_rss_mb or 0.0 for each in outcome.results.values())}}


if __name__ == "__main__":
    print(json.dumps(solve(json.load(sys.stdin), _costs), allow_nan=False))
