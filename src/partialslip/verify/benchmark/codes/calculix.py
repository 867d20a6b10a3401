"""CalculiX: deck by ``partialslip export``, run by ``ccx``, results read by ``partialslip score``."""

import re
import shutil
import subprocess
import tempfile
from collections.abc import Callable
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

_NORMAL, _STICK = 1e3, {True: 1e2, False: 1e5}  # fixed: of the export, E/a; on stick with penalties and without
_FRICTION = re.compile(r"(\*FRICTION\n\S+, )(\S+)")
_OVERLAP = re.compile(r"(OVERCLOSURE=LINEAR\n)(\S+)")
_DOFS = re.compile(r"number of equations\s+(\d+)")


@dataclass(frozen=True)
class Calculix:
    """CalculiX with elements of ``size`` a, penalty or mortar contact, and so many ``increments`` a step (None: as
    :func:`partialslip.verify.benchmark.increments.gradual` says); other types of ``element`` than the export's, and
    penalties in E/a, of pressure over overlap (``normal``) and of shear over slip in stick (``stick``)."""

    size: float
    penalty: bool
    increments: int | None = None
    element: str = "C3D8"
    normal: float = 1e3
    stick: float | None = None

    @property
    def version(self) -> str | None:
        """Version of ccx; None if it is not installed."""
        return _version(shutil.which("ccx"))

    @property
    def settings(self) -> str:
        """Settings in words."""
        kind = f"penalty contact, {self.normal:g} E/a on overlap" if self.penalty else "mortar contact"
        elements = f"{self.element} of {self.size:g} a along the contact, growing by {GROWTH:g}"
        stick = f"{self.stick or _STICK[self.penalty]:g} E/a on stick"
        return f"{elements}; {kind}, {stick}; bodies {STIFFER:g} times stiffer{told(self.increments)}"

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
            deck.write_text(self._changed(deck.read_text("ascii")), "ascii")
            inputs = {deck.name: deck.read_bytes()}
            done = ran(["ccx", "job"], deck.parent)
            counted = _DOFS.search(done.text)
            cost = int(counted[1]) if counted else None, done.cpu_s, done.memory_mb
            if why := _unfinished(done.code, done.text, deck.with_suffix(".sta")):
                return CodeOutcome(None, why, *cost, inputs)
            try:
                result = scored(scene, read_tractions(deck.with_suffix(".frd"), scene), "calculix", "job.frd")
            except InputError as error:
                return CodeOutcome(None, f"no results: {error}", *cost, inputs)
        return CodeOutcome(result, "", *cost, inputs)

    def _changed(self, deck: str) -> str:
        """The ``deck`` of the export with the element and the penalties of these settings."""

        def scaled(by: float) -> Callable[[re.Match[str]], str]:
            return lambda found: f"{found[1]}{float(found[2]) * by:.6e}"

        deck = deck.replace("TYPE=C3D8,", f"TYPE={self.element},")
        if self.stick:
            deck = _FRICTION.sub(scaled(self.stick / _STICK[self.penalty]), deck)
        return _OVERLAP.sub(scaled(self.normal / _NORMAL), deck) if self.normal != _NORMAL else deck


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
