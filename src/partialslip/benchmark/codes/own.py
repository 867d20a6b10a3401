"""Methods of partialslip, without privileges: they answer as any other code."""

from collections.abc import Mapping
from dataclasses import dataclass

import partialslip
from partialslip.benchmark.measured import answer_of
from partialslip.benchmark.problem import Problem
from partialslip.benchmark.submission import Answer
from partialslip.errors import PartialslipError
from partialslip.run import run


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

    def answer(self, problem: Problem) -> Answer | None:
        """Answer to ``problem``; None if the method does not offer it."""
        if problem.scene.finite and self.method in ("exact", "march"):  # half-planes
            return None
        try:
            result = run(problem.scene.replace(fem=dict(self.fem)), self.method)[self.method]
        except PartialslipError:
            return None
        return answer_of(problem, result, result.counts.get("dofs") or result.counts.get("cells"))
