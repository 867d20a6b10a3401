"""GetFEM: meshes by :mod:`partialslip.export`, run by a Python that has getfem, tractions read by ``partialslip
score``."""

import json
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.resources import as_file, files
from pathlib import Path
from typing import Any

import numpy as np

from partialslip.benchmark.codes.gradual import gradual
from partialslip.benchmark.codes.process import LONGEST, python_with, ran
from partialslip.benchmark.measured import answer_of
from partialslip.benchmark.problem import Problem
from partialslip.benchmark.submission import Answer
from partialslip.errors import InputError
from partialslip.export.model import outlined
from partialslip.export.parts import flat_parts
from partialslip.export.path import steps_of
from partialslip.result import Result
from partialslip.scene import Scene
from partialslip.score.method import scored
from partialslip.score.read import read

PYTHON = "PARTIALSLIP_GETFEM_PYTHON"
_VERSION = "import getfem; print(getfem.getfem_env('version'))"
_GROWTH = 0.2
_POINTS = 4001  # of the table of the gap


@dataclass(frozen=True)
class GetFEM:
    """GetFEM with elements of ``size`` a; with ``fine``, elements of ``fine`` a at the ends that its own run on the
    former mesh found."""

    size: float
    fine: float | None = None
    order: int = 2

    @property
    def version(self) -> str | None:
        """Version of GetFEM; None if no Python has it."""
        found = python_with(PYTHON, _VERSION)
        return found[1] if found else None

    @property
    def settings(self) -> str:
        """Settings in words."""
        where = f", of {self.fine:g} a at the ends that the run before found" if self.fine else ""
        kind = f"Q{self.order} elements of {self.size:g} a along the contact{where}"
        return f"{kind}; linear multipliers p and q, augmented (Alart and Curnier)"

    def answer(self, problem: Problem) -> Answer | None:
        """Answer to ``problem``; None if its meshes cannot be made. Without values if GetFEM does not converge."""
        scene = gradual(problem.scene)
        try:
            outlined(scene)
        except InputError:
            return None
        ends: tuple[float, ...] = ()
        cpu, memory = 0.0, 0.0
        for fine in (None, self.fine) if self.fine else (None,):
            with tempfile.TemporaryDirectory() as folder:
                found = self._solved(scene, Path(folder), ends, fine)
            told, result, spent, peak = found
            cpu, memory = cpu + spent, max(memory, peak)
            if isinstance(told, str) or result is None:
                return Answer({}, cpu_s=cpu, memory_mb=memory, note=str(told))
            ends = _ends(result)
        answer = answer_of(problem, result, told["unknowns"])
        return Answer(answer.values, cpu, told["unknowns"], memory)

    def _solved(self, scene: Scene, folder: Path, ends: Sequence[float], fine: float | None) -> Any:
        """What the script printed, or why it did not finish; the result; CPU seconds and memory."""
        steps = steps_of(scene)
        _write(scene, folder, self.size, ends, fine, self.order, steps)
        python, _ = python_with(PYTHON, _VERSION) or (sys.executable, "")
        with as_file(files("partialslip.benchmark.codes") / "scripts" / "run_getfem.py") as script:
            done = ran([python, str(script), "parameters.json"], folder)
        cost = done.cpu_s, done.memory_mb
        if done.code is None:
            return f"not finished within {LONGEST:g} s", None, *cost
        if done.code:
            return f"failed: {done.text.strip()[-200:]}", None, *cost
        told = json.loads(done.text.strip().splitlines()[-1])
        if told["gave_up"]:
            return f"Newton's method does not converge in step {told['gave_up']!r}", None, *cost
        try:
            samples = read(folder / "table.csv", scene)
            return told, scored(scene, samples, "getfem", "table.csv"), *cost
        except InputError as error:
            return f"no results: {error}", None, *cost


def _ends(result: Result) -> tuple[float, ...]:
    """Ends of contact and stick zone, in a."""
    places = [end for ends in result.contact_ends for end in ends]
    if result.m is not None and result.n is not None:
        places += [-result.m, result.n]
    return tuple(dict.fromkeys((np.array(places) / result.a).round(6).tolist()))


def _write(scene: Scene, folder: Path, size: float, ends: Sequence[float], fine: float | None, order: int,
           steps: Sequence[Any]) -> None:  # fmt: skip
    """Write meshes and parameters for the script into ``folder``."""
    from partialslip_meshes.write import write_body

    line = outlined(scene, size, None, ends, fine)
    parts = flat_parts(scene, line.a, line.reach, line.width, line.sizes, _GROWTH, line.along)
    bodies = {}
    for part in parts:
        write_body(folder / f"{part.name}.msh", part.mesh)
        bodies[part.name] = {
            "mesh": f"{part.name}.msh",
            "E": part.E,
            "nu": part.nu,
            "lines": {name: number for number, name in enumerate(part.mesh.lines, start=1)},
            "held": part.held,
            "pulled": part.pulled,
        }
    x = np.linspace(-line.reach, line.reach, _POINTS) * line.a
    load, first = scene.load, len(steps) - len(scene.load.points)
    touching = line.a * (steps[0].P / scene.P) ** 0.5
    parameters = {
        "a": line.a,
        "p0": 2 * scene.P / (np.pi * line.a),
        "f": scene.friction.f,
        "order": order,
        "gap": {"x": x.tolist(), "values": scene.gap_at(x).tolist()},
        "start": float(scene.gap_at(np.array(touching))),
        "bodies": bodies,
        "strain": float(parts[0].strained[0]),
        "steps": [step._asdict() for step in steps],
        "turns": any(M for _, M in scene.pressing),
        "points": [-1, -1] if scene.only_pressed else [first + end for end in load.ends],
        "table": "table.csv",
    }
    (folder / "parameters.json").write_text(json.dumps(parameters), "utf-8")
