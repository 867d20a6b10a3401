"""Kratos and its contact application: models by :mod:`partialslip.export`, run by a Python that has them."""

from dataclasses import dataclass

from partialslip.codes.export.model import modelled
from partialslip.scene import Scene
from partialslip.tools.errors import InputError
from partialslip.verify.benchmark.codes.process import CodeOutcome
from partialslip.verify.benchmark.codes.scripted import Host, or_twice, patient
from partialslip.verify.benchmark.increments import gradual
from partialslip.verify.benchmark.neutral import GROWTH, STIFFER

HOST = Host(
    "PARTIALSLIP_KRATOS_PYTHON",
    "from importlib.metadata import version as v; v('KratosLinearSolversApplication'); "
    "print(v('KratosContactStructuralMechanicsApplication'))",
    "run_kratos.py",
)


@dataclass(frozen=True)
class Kratos:
    """Kratos with elements of ``size`` a and at least so many ``increments`` a step, or, if given, ``just`` so many
    after pressing."""

    size: float
    increments: int
    just: int | None = None

    @property
    def version(self) -> str | None:
        """Version of the contact application; None if no Python has it."""
        return HOST.told

    @property
    def settings(self) -> str:
        """Settings in words."""
        kind = f"linear quadrilaterals of {self.size:g} a along the contact, mortar contact, augmented Lagrangian"
        increments = f"{self.just} increments a step" if self.just else or_twice(self.increments)
        return f"{kind}, tangent_factor 1, {increments}, bodies {STIFFER:g} times stiffer"

    def solve(self, scene: Scene) -> CodeOutcome | None:
        """Solve ``scene``; None if there is no model, or the upper body would have to turn."""
        scene = gradual(scene, self.just)
        if any(M for _, M in scene.pressing):
            return None
        try:
            made = modelled(scene, self.size, growth=GROWTH, stiffer=STIFFER)
        except InputError:
            return None
        return patient(HOST, scene, made, self.increments, self.just)
