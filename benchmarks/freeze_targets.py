"""Find the targets of the benchmark's problems anew, and write them where the package reads them.

python benchmarks/freeze_targets.py [PS-05 ...]: for an edition, never between editions: other codes measure themselves
by the frozen values.
"""

import sys
from collections.abc import Mapping
from pathlib import Path

import partialslip.verify.benchmark
from partialslip.verify.benchmark.freeze import covering, frozen_parts
from partialslip.verify.benchmark.problem import Target, frozen_text, parse_problem, read_frozen, texts

PATH = Path(partialslip.verify.benchmark.__file__).parent / "targets.json"


def main(numbers: list[str]) -> None:
    """Freeze the problems with these ``numbers``, all by default."""
    if unknown := set(numbers) - texts().keys():
        sys.exit(f"{', '.join(sorted(unknown))}: must be numbers of problems")
    known = read_frozen()
    targets, regimes = dict(known.targets), dict(known.regimes)
    for number, text in texts().items():
        if numbers and number not in numbers:
            continue
        found, regimes[number] = frozen_parts(parse_problem(number, text), lambda line: print(line, flush=True))
        targets[number] = settled(found, targets.get(number, {}), f"edition {known.edition}")
        for key, target in targets[number].items():
            print(f"  {key:12} {target.value:.12g} +- {target.uncertainty:.0e}  {target.known}", flush=True)
        kept = {number: targets[number] for number in texts() if number in targets}
        PATH.write_text(frozen_text(kept, {number: regimes[number] for number in kept}), "utf-8")


def settled(found: Mapping[str, Target], before: Mapping[str, Target], edition: str) -> dict[str, Target]:
    """Targets as ``found`` now, no surer than they moved from those ``before``, of an ``edition``."""
    targets = dict(found)
    for key in targets.keys() & before.keys():
        off = (before[key].value - found[key].value) / found[key].scale
        if abs(off) > found[key].uncertainty:
            targets[key] = covering(found[key], edition, off, 0.0)
    return targets


if __name__ == "__main__":
    main(sys.argv[1:])
