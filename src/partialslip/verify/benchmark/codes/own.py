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
    """A ``method`` of partialslip with ``fem`` settings."""

    method: str
    fem: Mapping[str, float | int]

    @property
    def version(self) -> str | None:
        """Version of partialslip."""
        return partialslip.__version__

    @property
    def settings(self) -> str:
        """Settings in words."""
        return ", ".join(f"{key} {value:g}" for key, value in self.fem.items())

    def solve(self, scene: Scene) -> CodeOutcome | None:
        """Solve ``scene``; None if the method does not offer it."""
        if scene.sized and self.method in ("exact", "march"):  # half-planes
            return None
        try:
            result = run(scene.replace(fem=dict(self.fem)), self.method)[self.method]
        except PartialslipError:
            return None
        unknowns = result.counts.get("dofs") or result.counts.get("cells")
        return CodeOutcome(result, "", unknowns, result.cost.cpu_s, result.cost.peak_rss_mb)
