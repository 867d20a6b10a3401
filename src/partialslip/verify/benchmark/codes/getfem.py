"""GetFEM: meshes by :mod:`partialslip.export`, run by a Python that has getfem."""

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from partialslip.codes.export.load_steps import steps_of
from partialslip.codes.export.model import outlined
from partialslip.codes.export.parts import flat_parts
from partialslip.result import Result
from partialslip.scene import Scene
from partialslip.tools.errors import InputError
from partialslip.verify.benchmark.codes.process import CodeOutcome
from partialslip.verify.benchmark.codes.scripted import Host, of_scene, solved
from partialslip.verify.benchmark.increments import gradual, told
from partialslip.verify.benchmark.neutral import GROWTH

HOST = Host("PARTIALSLIP_GETFEM_PYTHON", "import getfem; print(getfem.getfem_env('version'))", "run_getfem.py")
_POINTS = 4001  # accuracy: of the table of the gap


@dataclass(frozen=True)
class GetFEM:
    """GetFEM with elements of ``size`` a and of ``order``; with ``fine``, a second run has elements of ``fine`` a at
    the ends that the first found. It takes so many ``increments`` a step (None: as
    :func:`partialslip.verify.benchmark.increments.gradual` says). ``augmentation`` is the constant of the augmented
    conditions, in E/a."""

    size: float
    fine: float | None = None
    order: int = 2
    increments: int | None = None
    augmentation: float = 1.0

    @property
    def version(self) -> str | None:
        """Version of GetFEM; None if no Python has it."""
        return HOST.told

    @property
    def settings(self) -> str:
        """Settings in words."""
        where = f", {self.fine:g} a at the ends that a first run found" if self.fine else ""
        kind = f"Q{self.order} elements of {self.size:g} a along the contact{where}"
        constant = "" if self.augmentation == 1 else f", constant {self.augmentation:g} E/a"
        return f"{kind}; linear multipliers, augmented conditions (Alart and Curnier){constant}{told(self.increments)}"

    def solve(self, scene: Scene) -> CodeOutcome | None:
        """Solve ``scene``; None if its meshes cannot be made."""
        scene = gradual(scene, self.increments)
        ends: tuple[float, ...] = ()
        cpu_s = memory_mb = 0.0
        for fine in (None, self.fine) if self.fine else (None,):
            with tempfile.TemporaryDirectory() as folder:
                try:
                    parameters = _written(scene, Path(folder), self.size, ends, fine)
                except InputError:
                    return None
                parameters |= {"order": self.order, "augmentation": self.augmentation}
                found = solved(HOST, scene, parameters, Path(folder))
            cpu_s, memory_mb = cpu_s + (found.cpu_s or 0.0), max(memory_mb, found.memory_mb or 0.0)
            if not found.result:
                break
            ends = _zone_ends(found.result)
        return found._replace(cpu_s=cpu_s, memory_mb=memory_mb)


def _zone_ends(result: Result) -> tuple[float, ...]:
    """Ends of contact and stick zone, in a."""
    places = [end for ends in result.contact_ends or () for end in ends]
    if result.m is not None and result.n is not None:
        places += [-result.m, result.n]
    return tuple(dict.fromkeys((np.array(places) / result.a).round(6).tolist()))


def _written(scene: Scene, folder: Path, size: float, ends: Sequence[float], fine: float | None) -> dict[str, Any]:
    """Write the meshes into ``folder``; return parameters of the script."""
    from partialslip_meshes.write import write_body

    line, steps, bodies = outlined(scene, size, None, ends, fine), steps_of(scene), {}
    parts = flat_parts(scene, line.a, line.reach, line.width, line.sizes, GROWTH, line.along)
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
    touching = line.a * (steps[0].P / scene.P) ** 0.5
    return of_scene(scene, steps) | {
        "a": line.a,
        "p0": 2 * scene.P / (np.pi * line.a),
        "gap": {"x": x.tolist(), "values": scene.gap_at(x).tolist()},
        "start": float(scene.gap_at(np.array(touching))),
        "bodies": bodies,
        "strain": float(parts[0].strained[0]),
        "turns": any(M for _, M in scene.pressing),
    }
