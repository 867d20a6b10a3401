"""Methods of partialslip, without privileges: they answer as any other code."""

from collections.abc import Mapping
from dataclasses import dataclass

import partialslip
from partialslip.run import run
from partialslip.scene import Scene
from partialslip.tools.errors import PartialslipError
from partialslip.verify.benchmark.codes.process import CodeOutcome


@dataclass(frozen=True)
class Own:
    """A ``method`` of partialslip with ``fem`` settings. With a ladder of ``sizes`` of elements, from coarse to fine,
    in a, each of the ``rungs`` solves on one mesh, and the code itself on the finest."""

    method: str
    fem: Mapping[str, float | int]
    sizes: tuple[float, ...] = ()

    @property
    def rungs(self) -> tuple["Own", ...]:
        """Codes of one size each, as many as ``sizes``."""
        return tuple(Own(self.method, {**self.fem, "size": size}) for size in self.sizes)

    @property
    def version(self) -> str | None:
        """Version of partialslip."""
        return partialslip.__version__

    @property
    def settings(self) -> str:
        """Settings in words."""
        told = [f"{key} {value:g}" for key, value in self.fem.items()]
        told += ["sizes " + ", ".join(f"{size:g} a" for size in self.sizes)] if self.sizes else []
        return ", ".join(told)

    def solve(self, scene: Scene) -> CodeOutcome | None:
        """Solve ``scene``; None if the method does not offer it."""
        if self.sizes:
            return self.rungs[-1].solve(scene)
        if scene.sized and self.method in ("exact", "march"):  # half-planes
            return None
        try:
            result = run(scene.replace(fem=dict(self.fem)), self.method)[self.method]
        except PartialslipError:
            return None
        unknowns = result.counts.get("dofs") or result.counts.get("cells")
        return CodeOutcome(result, "", unknowns, result.cost.cpu_s, result.cost.peak_rss_mb)
