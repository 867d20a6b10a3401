"""CalculiX: deck by ``partialslip export``, run by ``ccx``, results read by ``partialslip score``."""

import re
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from partialslip.codes.export import export
from partialslip.codes.score.method import scored
from partialslip.codes.score.read import read_tractions
from partialslip.scene import Scene
from partialslip.tools.errors import InputError
from partialslip.verify.benchmark.codes.process import LONGEST, CodeOutcome, ran
from partialslip.verify.benchmark.increments import gradual, told
from partialslip.verify.benchmark.neutral import GROWTH, STIFFER

_DOFS = re.compile(r"number of equations\s+(\d+)")


@dataclass(frozen=True)
class Calculix:
    """CalculiX with elements of ``size`` a, penalty or mortar contact, and so many ``increments`` a step (None: as
    :func:`partialslip.verify.benchmark.increments.gradual` says)."""

    size: float
    penalty: bool
    increments: int | None = None

    @property
    def version(self) -> str | None:
        """Version of ccx; None if it is not installed."""
        return _version(shutil.which("ccx"))

    @property
    def settings(self) -> str:
        """Settings in words."""
        kind = "penalty" if self.penalty else "mortar"
        elements = f"elements of {self.size:g} a along the contact, growing by {GROWTH:g}"
        return f"{kind} contact, {elements}, bodies {STIFFER:g} times stiffer{told(self.increments)}"

    def solve(self, scene: Scene) -> CodeOutcome | None:
        """Solve ``scene``; None if there is no deck for it."""
        scene = gradual(scene, self.increments)
        try:
            write = export(scene, "calculix", size=self.size, growth=GROWTH, stiffer=STIFFER, penalty=self.penalty)
        except InputError:
            return None
        with tempfile.TemporaryDirectory() as folder:
            deck = Path(folder) / "job.inp"
            write(deck)
            done = ran(["ccx", "job"], deck.parent)
            counted = _DOFS.search(done.text)
            cost = int(counted[1]) if counted else None, done.cpu_s, done.memory_mb
            if why := _unfinished(done.code, done.text, deck.with_suffix(".sta")):
                return CodeOutcome(None, why, *cost)
            try:
                result = scored(scene, read_tractions(deck.with_suffix(".frd"), scene), "calculix", "job.frd")
            except InputError as error:
                return CodeOutcome(None, f"no results: {error}", *cost)
        return CodeOutcome(result, "", *cost)


@cache
def _version(ccx: str | None) -> str | None:
    if ccx is None:
        return None
    told = subprocess.run([ccx, "-v"], capture_output=True, text=True, check=False).stdout
    found = re.search(r"Version\s+(\S+)", told)
    return found[1] if found else ""


def _unfinished(code: int | None, printed: str, status: Path) -> str:
    """Why the job did not finish; empty if it did."""
    if code is None:
        return f"not finished within {LONGEST:g} s"
    if code == 0 and "Job finished" in printed:
        return ""
    rows = [line.split() for line in status.read_text("utf-8", "replace").splitlines()[2:]] if status.exists() else []
    where = f" in step {rows[-1][0]}" if rows and rows[-1] else ""
    errors = [line.strip() for line in printed.splitlines() if "*ERROR" in line]
    return f"gave up{where}" + (f": {errors[-1]}" if errors else f" with exit code {code}")
