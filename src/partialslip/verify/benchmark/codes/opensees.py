"""OpenSees: models by :mod:`partialslip.export`, run by a Python that has OpenSeesPy."""

from dataclasses import dataclass

from partialslip.codes.export.model import modelled
from partialslip.scene import Scene
from partialslip.tools.errors import InputError
from partialslip.verify.benchmark.codes.process import CodeOutcome
from partialslip.verify.benchmark.codes.scripted import Host, or_twice, patient
from partialslip.verify.benchmark.increments import gradual
from partialslip.verify.benchmark.neutral import GROWTH

HOST = Host(
    "PARTIALSLIP_OPENSEES_PYTHON",
    "import openseespy.opensees; from importlib.metadata import version; print(version('openseespy'))",
    "run_opensees.py",
)
_MATCH = 1e-6  # fixed: distance of nodes that face each other, in a, far below the size of an element


@dataclass(frozen=True)
class OpenSees:
    """OpenSees with elements of ``size`` a, at least so many ``increments`` a step, or, if given, ``just`` so many
    after pressing, and ``sticking``, the stiffness of sticking, in E/a; ``element`` is quad or bbarQuad."""

    size: float
    increments: int
    just: int | None = None
    sticking: float = 1000.0
    element: str = "quad"

    @property
    def version(self) -> str | None:
        """Version of OpenSeesPy; None if no Python has it."""
        return HOST.told

    @property
    def settings(self) -> str:
        """Settings in words."""
        kind = f"{self.element} of {self.size:g} a along the contact, SimpleContact2D with multipliers"
        increments = f"{self.just} increments a step" if self.just else f"at least {or_twice(self.increments)}"
        return f"{kind}, {self.sticking:g} E/a on stick, {increments}"

    def solve(self, scene: Scene) -> CodeOutcome | None:
        """Solve ``scene``; None if there is no model, the upper body would have to turn, or the meshes do not match."""
        scene = gradual(scene, self.just)
        if any(M for _, M in scene.pressing):
            return None
        try:
            made = modelled(scene, self.size, growth=GROWTH)
        except InputError:
            return None
        lines = [sorted(part.mesh.points[part.contact, 0] / made.a) for part in made.parts]
        if len(lines[0]) != len(lines[1]) or max(abs(x - y) for x, y in zip(*lines, strict=True)) > _MATCH:
            return None
        more = {"sticking": self.sticking, "element": self.element}
        return patient(HOST, scene, made, self.increments, self.just, more)
