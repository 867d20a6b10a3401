"""Find the targets of the benchmark's problems anew, and write them where the package reads them.

python benchmarks/freeze_targets.py [PS-05 ...]: for an edition, never between editions: other codes measure themselves
by the frozen values.
"""

import sys
from pathlib import Path

import partialslip.benchmark
from partialslip.benchmark.freeze import frozen_parts
from partialslip.benchmark.problem import frozen_text, parse_problem, read_frozen, texts

PATH = Path(partialslip.benchmark.__file__).parent / "targets.json"


def main(numbers: list[str]) -> None:
    """Freeze the problems with these ``numbers``, all by default."""
    known = read_frozen()
    targets, regimes = dict(known.targets), dict(known.regimes)
    for number, text in texts().items():
        if numbers and number not in numbers:
            continue
        targets[number], regimes[number] = frozen_parts(
            parse_problem(number, text), lambda line: print(line, flush=True)
        )
        for key, target in targets[number].items():
            print(f"  {key:12} {target.value:.12g} +- {target.uncertainty:.0e}  {target.known}", flush=True)
        kept = {number: targets[number] for number in texts() if number in targets}
        PATH.write_text(frozen_text(kept, {number: regimes[number] for number in kept}), "utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
