"""CalculiX: deck by ``partialslip export``, run by ``ccx``, results read by ``partialslip score``."""

import os
import re
import resource
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import msgspec

from partialslip.benchmark.measured import answer_of
from partialslip.benchmark.problem import Problem
from partialslip.benchmark.submission import Answer
from partialslip.errors import InputError
from partialslip.export import export
from partialslip.score.method import scored
from partialslip.score.read import read

_STIFFER = 100.0  # half-planes neglect the slopes of the surfaces: these are a hundredth
_LONGEST = 3600.0  # s
_DOFS = re.compile(r"number of equations\s+(\d+)")


@dataclass(frozen=True)
class Calculix:
    """CalculiX with elements of ``size`` a, and penalty or mortar contact."""

    size: float
    penalty: bool

    @property
    def version(self) -> str | None:
        """Version of ccx; None if it is not installed."""
        if not shutil.which("ccx"):
            return None
        told = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False).stdout
        found = re.search(r"Version\s+(\S+)", told)
        return found[1] if found else ""

    @property
    def settings(self) -> str:
        """Settings in words."""
        kind = "penalty" if self.penalty else "mortar"
        return f"{kind} contact, elements of {self.size:g} a along the contact, bodies {_STIFFER:g} times stiffer"

    def answer(self, problem: Problem) -> Answer | None:
        """Answer to ``problem``; None if there is no deck for it. Without values if CalculiX does not finish."""
        try:
            write = export(problem.scene, "calculix", size=self.size, stiffer=_STIFFER, penalty=self.penalty)
        except InputError:
            return None
        with tempfile.TemporaryDirectory() as folder:
            deck = Path(folder) / "job.inp"
            write(deck)
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            try:
                alone = os.environ | {"OMP_NUM_THREADS": "1"}
                done = subprocess.run(["ccx", "job"], cwd=folder, env=alone, capture_output=True, text=True,
                                      timeout=_LONGEST, check=False)  # fmt: skip
            except subprocess.TimeoutExpired:
                return Answer({}, note=f"not finished within {_LONGEST:g} s")
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            counted = _DOFS.search(done.stdout)
            try:
                samples = read(deck.with_suffix(".frd"), problem.scene, (1.0, 1.0, 1.0), 1, None, None)
                result = scored(problem.scene, samples, "calculix", "job.frd")
            except InputError as error:
                return Answer({}, cpu_s=spent, note=f"no results: {error}")
        answer = answer_of(problem, result, int(counted[1]) if counted else None)
        return msgspec.structs.replace(answer, cpu_s=spent, memory_mb=None)
