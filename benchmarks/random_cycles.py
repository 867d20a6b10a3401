"""Random cycles of load by finite elements: how many converge, in how many faces, and how well zones are read.

python benchmarks/random_cycles.py [--count 1000] [--first 0]
"""

import argparse
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

import partialslip

sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "helpers"))
from random_marches import FINEST, complaints, trials


@dataclass
class Row:
    """A scene, and what its finite elements have come to."""

    number: int
    kind: str
    seconds: float
    wrong: list[str]
    kkt: float = 0.0
    equilibrium: float = 0.0
    faces: list[int] = field(default_factory=list)
    regime: str = ""
    smaller: bool = False
    reached: bool = True
    half_width: float = np.nan  # of the exact stick zone, in a
    error: float = np.nan  # of m and n, in a; the larger one, as below
    estimate: float = np.nan


def measured(numbers: range):
    """Rows, one after the other."""
    start = time.process_time()
    for number, kind, scene, result, marches in trials(numbers):
        seconds = time.process_time() - start
        if isinstance(result, str):
            yield Row(number, kind, seconds, [result])
        else:
            row = Row(
                number, kind, seconds, list(complaints(scene, result, marches)),
                result.certificate["kkt"], result.certificate["equilibrium"],
                [step.iterations for march in marches for step in march.history.points], result.regime,
                any("smaller than an element" in note for note in result.notes),
                not any("not reached" in note for note in result.notes),
            )  # fmt: skip
            compared(row, scene, result)
            yield row
        start = time.process_time()


def compared(row: Row, scene, result) -> None:
    """Errors against the exact steady state, where the path is one that reaches it: single steps, and either fully
    reversed or settled."""
    load = scene.load
    settled = load.fully_reversed or (result.last_cycle_change or 0.0) <= 1e-3 * largest_change(scene, result)
    if not (load.in_phase and load.steps == 1 and settled):
        return
    exact = partialslip.run(scene, ["exact"]).results["exact"]
    if exact.regime in ("small tension", "large tension") and result.regime == exact.regime:
        row.half_width = exact.stick_half_width / exact.a
        row.error = max(abs(exact.m - result.m), abs(exact.n - result.n)) / exact.a
        row.estimate = max(result.estimate["m"], result.estimate["n"])


def largest_change(scene, result) -> float:
    """Largest change of q in a cycle, in f p0."""
    return float(np.abs(result.traction.dq).max() / (scene.friction.f * result.p0))


def told(rows: list[Row]) -> None:
    """The table."""
    faces = np.concatenate([row.faces for row in rows])
    print(f"{len(rows)} scenes, {len(faces)} load steps, {sum(row.seconds for row in rows):.0f} CPU s")
    print(f"nothing wrong in {sum(not row.wrong for row in rows)}; stick zone smaller than an element in "
          f"{sum(row.smaller for row in rows)}; accuracy not reached at {FINEST:g} a in "
          f"{sum(not row.reached for row in rows)}")  # fmt: skip
    for row in rows:
        for complaint in row.wrong:
            print(f"  {row.number} ({row.kind}): {complaint}")
    for name in ("kkt", "equilibrium"):
        values = np.array([getattr(row, name) for row in rows])
        print(f"{name}: median {np.median(values):.1e}, largest {values.max():.1e}")
    print(f"faces a load step: median {np.median(faces):g}, mean {faces.mean():.1f}, largest {faces.max()}")
    for kind in dict.fromkeys(row.kind for row in rows):
        some = np.concatenate([row.faces for row in rows if row.kind == kind])
        print(f"  {kind:14} median {np.median(some):g}, largest {some.max()}")
    known = [row for row in rows if row.error > 0]
    if not known:
        return
    error, estimate = (np.array([getattr(row, name) for row in known]) for name in ("error", "estimate"))
    ratio = error / np.maximum(estimate, np.finfo(float).eps)
    print(f"m, n against the exact ones, {len(known)} scenes, in a: {shares(error)}")
    print(f"the same, in their estimate: {shares(ratio)}; beyond it in {(ratio > 1).sum()}")
    for i in np.argsort(-ratio)[:8]:
        row = known[i]
        print(f"  {row.number} ({row.kind}): error {row.error:.1e}, estimate {row.estimate:.1e}, "
              f"half-width {row.half_width:.1e}, {row.regime}")  # fmt: skip


def shares(values) -> str:
    """Half of the values are below the first number, and so on."""
    return ", ".join(f"{q} %: {np.percentile(values, q):.1e}" for q in (50, 90, 99, 100))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0)
    given = parser.parse_args()
    told(list(measured(range(given.first, given.first + given.count))))
