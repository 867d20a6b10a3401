"""Find the targets of the benchmark's problems anew, and write them where the package reads them.

python benchmarks/freeze_targets.py [PS-05 ...] | --doubted: for an edition, never between editions: other codes measure
themselves by the frozen values. ``--doubted`` finds no target anew. The uncertainties of targets in doubt then cover
boundary elements, as peers/boundary.py has found them against these targets.
"""

import json
import sys
from collections.abc import Mapping
from pathlib import Path

import partialslip.benchmark
from partialslip.benchmark.freeze import covering, frozen_parts
from partialslip.benchmark.problem import Target, frozen_text, parse_problem, read_frozen, texts

PATH = Path(partialslip.benchmark.__file__).parent / "targets.json"
BOUNDARY = Path(__file__).parent / "peers" / "boundary.jsonl"
WORDS = "boundary elements"
DOUBTED = {  # targets from which boundary elements differ by more than the ways of partialslip do
    "PS-24": tuple(f"{level}@{place:g}" for level in ("q1", "q2") for place in (-0.9, -0.5, 0, 0.5, 0.9)),
}
OWN = {  # accuracy: of the boundary elements, besides their cells
    "PS-22": 1.1e-5,  # p(0) of pressing alone, compared with the self-similar solution
    "PS-23": 1.2e-4,  # p_max: elements around the blocks
    "PS-24": 5e-4,  # p at the ends: the arc of the pad is taken as flat
    "PS-25": 7.5e-5,  # as in PS-22
}


def main(numbers: list[str]) -> None:
    """Freeze the problems with these ``numbers``, all by default."""
    if unknown := set(numbers) - texts().keys():
        sys.exit(f"{', '.join(sorted(unknown))}: must be numbers of problems, or --doubted alone")
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


def doubted() -> None:
    """Freeze all problems with the known values. Raises LookupError without boundary elements on two meshes."""
    known = read_frozen()
    runs = [json.loads(line) for line in BOUNDARY.read_text("utf-8").splitlines()]
    targets = {number: covered(number, some, runs) for number, some in known.targets.items()}
    PATH.write_text(frozen_text(targets, known.regimes), "utf-8")


def covered(number: str, targets: Mapping[str, Target], runs: list[dict]) -> dict[str, Target]:
    """``targets`` of a problem; uncertainties of those in doubt cover the ``runs`` of boundary elements, which are
    unsure by the change from the last but one mesh to the last, and by :data:`OWN`."""
    errors = [run["errors"] for run in sorted(runs, key=lambda run: run["cells"]) if run["problem"] == number]
    found = dict(targets)
    for key in DOUBTED.get(number, ()):
        if WORDS not in found[key].known:  # done once
            before, last = (each[key] for each in errors[-2:])
            found[key] = covering(found[key], WORDS, last, abs(last - before) + OWN[number])
    return found


if __name__ == "__main__":
    doubted() if sys.argv[1:] == ["--doubted"] else main(sys.argv[1:])
