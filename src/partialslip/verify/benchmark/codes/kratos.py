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
    after pressing. ``tangent_factor`` scales the stiffness of stick; None: as Kratos chooses, 0.025."""

    size: float
    increments: int
    just: int | None = None
    tangent_factor: float | None = 1.0

    @property
    def version(self) -> str | None:
        """Version of the contact application; None if no Python has it."""
        return HOST.told

    @property
    def settings(self) -> str:
        """Settings in words."""
        kind = f"SmallDisplacementElement2D4N of {self.size:g} a along the contact, mortar, augmented Lagrangian"
        increments = f"{self.just} increments a step" if self.just else or_twice(self.increments)
        factor = (
            "Kratos' own tangent_factor" if self.tangent_factor is None else f"tangent_factor {self.tangent_factor:g}"
        )
        return f"{kind}, {factor}, {increments}, bodies {STIFFER:g} times stiffer"

    def solve(self, scene: Scene) -> CodeOutcome | None:
        """Solve ``scene``; None if there is no model, or the upper body would have to turn."""
        scene = gradual(scene, self.just)
        if any(M for _, M in scene.pressing):
            return None
        try:
            made = modelled(scene, self.size, growth=GROWTH, stiffer=STIFFER)
        except InputError:
            return None
        more = {"tangent_factor": self.tangent_factor}
        return patient(HOST, scene, made, self.increments, self.just, more)
