"""Kratos and its contact application: models by :mod:`partialslip.export`, run by a Python that has them."""

import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from partialslip.benchmark.codes.gradual import gradual
from partialslip.benchmark.codes.scripted import Host, of_scene, solved
from partialslip.benchmark.codes.solved import Solved
from partialslip.benchmark.neutral import GROWTH, STIFFER
from partialslip.errors import InputError
from partialslip.export.model import Model, modelled
from partialslip.scene import Scene

HOST = Host(
    "PARTIALSLIP_KRATOS_PYTHON",
    "from importlib.metadata import version as v; v('KratosLinearSolversApplication'); "
    "print(v('KratosContactStructuralMechanicsApplication'))",
    "run_kratos.py",
)


@dataclass(frozen=True)
class Kratos:
    """Kratos with elements of ``size`` a and at least so many ``increments`` a step."""

    size: float
    increments: int

    @property
    def version(self) -> str | None:
        """Version of the contact application; None if no Python has it."""
        return HOST.told

    @property
    def settings(self) -> str:
        """Settings in words."""
        kind = f"linear quadrilaterals of {self.size:g} a along the contact, mortar contact, augmented Lagrangian"
        return f"{kind}, tangent_factor 1, {self.increments} increments a step, bodies {STIFFER:g} times stiffer"

    def solve(self, scene: Scene) -> Solved | None:
        """Solve ``scene``; None if there is no model, or the upper body would have to turn."""
        scene = gradual(scene)
        if any(M for _, M in scene.pressing):
            return None
        try:
            made = modelled(scene, self.size, growth=GROWTH, stiffer=STIFFER)
        except InputError:
            return None
        steps = [step._replace(increments=max(step.increments, self.increments)) for step in made.steps]
        with tempfile.TemporaryDirectory() as folder:
            return solved(HOST, scene, of_scene(scene, steps) | _told(made), Path(folder))


def _told(made: Model) -> dict[str, Any]:
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
