"""Find the targets of the benchmark's problems anew, and the curves of their tractions, and write both where the
package reads them.

python benchmarks/freeze_targets.py [--curves] [PS-05 ...]: with --curves the curves alone; else for an edition, never
between editions: other codes measure themselves by the frozen values.
"""

import sys
from collections.abc import Mapping
from pathlib import Path

import partialslip.verify.benchmark
from partialslip.verify.benchmark.curves import curves_text, read_curves
from partialslip.verify.benchmark.freeze import covering, frozen_curve, frozen_parts
from partialslip.verify.benchmark.problem import Target, frozen_text, parse_problem, read_frozen, texts

FOLDER = Path(partialslip.verify.benchmark.__file__).parent
PATH = FOLDER / "targets.json"


def main(words: list[str]) -> None:
    """Freeze the problems with the numbers in ``words``, all by default; with ``--curves`` the curves alone."""
    numbers = [word for word in words if word != "--curves"]
    if unknown := set(numbers) - texts().keys():
        sys.exit(f"{', '.join(sorted(unknown))}: must be numbers of problems")
    if "--curves" not in words:
        freeze_targets(numbers)
    curves, frozen = dict(read_curves()), read_frozen()
    for number, text in texts().items():
        if not numbers or number in numbers:
            curves[number] = frozen_curve(parse_problem(number, text, frozen))
            (FOLDER / "curves.json").write_text(curves_text(curves), "utf-8")
            print(f"{number}: curve", flush=True)


def freeze_targets(numbers: list[str]) -> None:
    """Freeze the targets of the problems with these ``numbers``, all by default."""
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
