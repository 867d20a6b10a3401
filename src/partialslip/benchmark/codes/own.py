"""Methods of partialslip, without privileges: they answer as any other code."""

from collections.abc import Mapping
from dataclasses import dataclass

from msgspec.structs import replace

import partialslip
from partialslip.benchmark.measured import answer_of
from partialslip.benchmark.problem import Problem
from partialslip.benchmark.submission import Answer, Rung
from partialslip.errors import PartialslipError
from partialslip.run import run


@dataclass(frozen=True)
class Own:
    """A ``method`` of partialslip with ``fem`` settings; on a ladder of meshes if there are ``sizes`` of elements, from
    coarse to fine, in a."""

    method: str
    fem: Mapping[str, float | int]
    sizes: tuple[float, ...] = ()

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

    def answer(self, problem: Problem) -> Answer | None:
        """Answer to ``problem``; None if the method does not offer it."""
        if problem.scene.finite and self.method in ("exact", "march"):  # half-planes
            return None
        try:
            rungs = [self._solved(problem, {"size": size}) for size in self.sizes]
            answer = rungs[-1] if rungs else self._solved(problem, {})
        except PartialslipError:
            return None
        ladder = (Rung(h, each.values, each.cpu_s, each.unknowns) for h, each in zip(self.sizes, rungs, strict=True))
        return replace(answer, ladder=tuple(ladder))

    def _solved(self, problem: Problem, more: Mapping[str, float]) -> Answer:
        scene = problem.scene.replace(fem={**self.fem, **more})
        result = run(scene, self.method, subsurface=problem.stress)[self.method]
        return answer_of(problem, result, result.counts.get("dofs") or result.counts.get("cells"))
