"""Codes that are Python packages: a script in ``codes/scripts`` run by a Python that has the code."""

import json
import sys
import tempfile
from collections.abc import Mapping, Sequence
from importlib.resources import as_file, files
from pathlib import Path
from typing import Any, NamedTuple

import msgspec

from partialslip.codes.export.load_steps import Step
from partialslip.codes.export.model import Model
from partialslip.codes.score.method import scored
from partialslip.codes.score.read import read_tractions
from partialslip.scene import Scene
from partialslip.tools.errors import InputError
from partialslip.tools.strictjson import decoded
from partialslip.verify.benchmark.codes.process import LONGEST, CodeOutcome, python_with, ran
from partialslip.verify.benchmark.increments import refined

TABLE = "table.csv"
_GAVE_UP = "did not converge"


class _Told(msgspec.Struct):
    """Last line that a script prints: the step in which the code gave up, if it did, and the number of unknowns."""

    gave_up: str | None
    unknowns: int | None


class Host(NamedTuple):
    """Where a code runs: environment ``variable`` that names a Python, program that prints the ``version``, and the
    name of the ``script``."""

    variable: str
    version: str
    script: str

    @property
    def told(self) -> str | None:
        """Version of the code; None if no Python has it."""
        found = python_with(self.variable, self.version)
        return found[1] if found else None


def of_scene(scene: Scene, steps: Sequence[Step]) -> dict[str, Any]:
    """Parameters of all scripts: friction, steps, numbers of the steps of load points 1 and 2 and, out of phase, of all
    load points of the last cycle, of whose shear q1 is the least and q2 the largest; and the table's name."""
    first = len(steps) - len(scene.load.points)
    return {
        "f": scene.friction.f,
        "steps": [step._asdict() for step in steps],
        "points": [-1, -1] if scene.only_pressed else [first + end for end in scene.load.ends],
        "cycle": [] if scene.load.in_phase else [*range(first, len(steps))],
        "table": TABLE,
    }


def of_model(made: Model) -> dict[str, Any]:
    """Parameters of scripts that build a meshed model: bodies, supports, and the bulk tension."""
    lower = made.parts[0]
    return {
        "a": made.a,
        "bodies": {
            part.name: {
                "points": part.mesh.points.tolist(),
                "quads": part.mesh.quads.tolist(),
                "contact": part.mesh.lines["contact"].tolist(),
                "E": part.E,
                "nu": part.nu,
            }
            for part in made.parts
        },
        "held": {part.name: [nodes.tolist() for nodes in part.held_nodes] for part in made.parts},
        "pull": lower.pull.tolist(),
        "strained": lower.strained.tolist(),
    }


def solved(host: Host, scene: Scene, parameters: Mapping[str, Any], folder: Path) -> CodeOutcome:
    """Run the script of ``host`` with ``parameters`` in ``folder``, and read the tractions of ``scene``."""
    (folder / "parameters.json").write_text(json.dumps(parameters), "utf-8")
    inputs = {each.name: each.read_bytes() for each in sorted(folder.iterdir())}
    python, _ = python_with(host.variable, host.version) or (sys.executable, "")
    with as_file(files("partialslip.verify.benchmark.codes") / "scripts" / host.script) as script:
        done = ran([python, str(script), "parameters.json"], folder)

    def failed(why: str, unknowns: int | None = None) -> CodeOutcome:
        return CodeOutcome(None, why, unknowns, done.cpu_s, done.memory_mb, inputs)

    if done.code is None:
        return failed(f"not finished within {LONGEST:g} s")
    last = (done.text.strip().splitlines() or [""])[-1]
    if done.code or not last.startswith("{"):
        return failed(f"failed: {last[:200]}")
    unknowns = None
    try:
        told = decoded(last, _Told, "last line")
        unknowns = told.unknowns
        if told.gave_up:
            return failed(f"{_GAVE_UP} in step {told.gave_up!r}", unknowns)
        result = scored(scene, read_tractions(folder / TABLE, scene), "", TABLE)
    except InputError as error:
        return failed(f"no results: {error}", unknowns)
    return CodeOutcome(result, "", unknowns, done.cpu_s, done.memory_mb, inputs)


def patient(
    host: Host, scene: Scene, model: Model, increments: int, just: int | None, more: Mapping[str, Any] | None = None
) -> CodeOutcome:
    """Outcome of a ``model`` of ``scene`` with at least so many ``increments`` a step or, if the code does not
    converge, with twice as many: convergence may hang on details of the mesh. The cost is that of both. There is no
    second try if ``just`` so many increments are asked for. ``more`` are parameters of the script."""

    def outcome(least: int) -> CodeOutcome:
        told = of_scene(scene, refined(model.steps, least, just)) | of_model(model) | dict(more or {})
        with tempfile.TemporaryDirectory() as folder:
            return solved(host, scene, told, Path(folder))

    first = outcome(increments)
    if just or not first.why.startswith(_GAVE_UP):
        return first
    second = outcome(2 * increments)
    return second._replace(cpu_s=(first.cpu_s or 0.0) + (second.cpu_s or 0.0))


def or_twice(increments: int) -> str:
    """Words for ``increments`` of :func:`patient`, to end settings with."""
    return f"{increments} increments a step, {2 * increments} where it does not converge"
