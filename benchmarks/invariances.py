"""The worst disagreement under each invariance: those of `tests/invariances`, all of them.

python benchmarks/invariances.py
"""

import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "helpers"))
from pairs import trials


def main() -> None:
    start, worst = time.process_time(), {}
    for trial in trials():
        found, bars = trial.run(), trial.bars
        if found.traction > bars.traction or found.ends > bars.ends:
            print(f"missed: {trial.invariance}, {trial.method}, {trial.kind}: {found}")
        row = worst.setdefault(trial.invariance, {})
        row[trial.method] = tuple(map(max, row.get(trial.method, (0.0, 0.0)), found))
    print(f"{'in f p0 (p0 for pressure) / in a':34}" + "".join(f"{method:>18}" for method in ("exact", "march", "fem")))
    for invariance, row in worst.items():
        cells = (row.get(method) for method in ("exact", "march", "fem"))
        print(f"{invariance:34}" + "".join(f"{_text(cell):>18}" for cell in cells))
    print(f"{time.process_time() - start:.0f} CPU s")


def _text(cell: tuple[float, float] | None) -> str:
    return " / ".join(f"{value:.0e}" if value else "0" for value in cell) if cell else "-"


if __name__ == "__main__":
    main()
