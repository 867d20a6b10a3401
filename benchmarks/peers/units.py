"""CalculiX's mortar contact in other units of length: units.py [FACTOR ...]. The deck of PS-01 (Hertz, no friction),
with a of 207 units, is written with lengths that are so many times smaller (0.01: a = 2 units). Prints the error of a.
"""

import sys
import tempfile
from pathlib import Path

from partialslip.codes.export import export
from partialslip.codes.score.method import scored
from partialslip.codes.score.read import read_tractions
from partialslip.verify.benchmark import read_problems
from partialslip.verify.benchmark.codes.process import ran
from partialslip.verify.benchmark.neutral import GROWTH, STIFFER


def main() -> None:
    problem = read_problems()["PS-01"]
    for factor in map(float, sys.argv[1:] or ("1", "0.1", "0.01", "0.001", "0.0001")):
        with tempfile.TemporaryDirectory() as folder:
            deck = Path(folder) / "job.inp"
            export(problem.scene, "calculix", size=0.05, growth=GROWTH, stiffer=STIFFER)(deck)
            deck.write_text(scaled(deck.read_text("ascii"), factor), "ascii")
            ran(["ccx", "job"], Path(folder))
            frd = deck.with_suffix(".frd")
            a = problem.targets["a"].value
            tractions = read_tractions(frd, problem.scene, (1 / factor, factor**2, factor**2))
            found = scored(problem.scene, tractions, "", "job.frd").a
            print(f"a = {a * 1e6 * factor:.3g} units: a is off by {found / a - 1:.1e}")


def scaled(deck: str, factor: float) -> str:
    """``deck`` with lengths times ``factor`` and stresses divided by its square: forces are the same."""
    lines, kind = [], ""
    for line in deck.splitlines():
        kind = line if line.startswith("*") else kind
        fields = line.split(",")
        if not line.startswith("*") and kind.startswith("*NODE,"):
            line = ",".join([fields[0], *(f" {float(each) * factor:.12e}" for each in fields[1:])])
        elif not line.startswith("*") and kind.startswith("*ELASTIC"):
            line = f"{float(fields[0]) / factor**2:.12e},{fields[1]}"
        lines.append(line)
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
