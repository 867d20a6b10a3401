"""Verdicts on random scenes: what is said against what was judged.

    python benchmarks/verdicts.py [--count 400] [--seed 0]

Half of the scenes are random ones of every kind (partialslip.verify.random_scenes), half are Hertz contacts under loads
under which slip mostly reverses, so that nothing is known to hold. Each is solved by its reference and by march, or by
fem where march is the reference, at an accuracy of 1e-2. The stick zone of every fourth result is then spoiled by up to
ten bars. The table counts outcomes by regime and by what was not judged. What each regime asks for is written here once
more, apart from the rule.
"""

import argparse
import dataclasses
from collections import Counter

import numpy as np

from partialslip import load_scene, run
from partialslip.result import Result
from partialslip.run import Run, compared
from partialslip.run.judge import Outcome
from partialslip.run.judge.reference import reference
from partialslip.scene import Scene
from partialslip.scene.plan import plan
from partialslip.tools.errors import InputError
from partialslip.verify.random_scenes import draw

_ACCURACY = 1e-2
_ASKED = {
    "sliding": {"regime", "a", "p", "q"},
    "frictionless": {"regime", "a", "p", "q"},
    "ratchets": {"regime", "a", "p"},
}
_STICK = {"a", "m", "n", "p", "q"}


def scene_of(seed: int, number: int) -> Scene:
    """Return a random scene: of any kind if ``number`` is even, else one under which slip may reverse."""
    random = np.random.default_rng([seed, number, 1])
    if number % 2 == 0:
        return draw(seed, number // 2).scene.replace(fem={"accuracy": _ACCURACY}, load={"cycles": 2, "steps": 1})
    hertz = load_scene("hertz-shear")
    Q, sigma = random.uniform(0.5, 1) * 0.5 * hertz.P, random.uniform(5, 15) * 0.5 * 4e8 / 2
    return hertz.replace(load={"Q": [-Q, Q], "sigma": [-sigma, sigma]}, fem={"accuracy": _ACCURACY})


def solved(scene: Scene, spoil: float) -> Run:
    """Solve ``scene`` by its reference and another method, whose stick zone is spoiled by ``spoil`` a."""
    best = reference(scene).method
    other = "fem" if best == "march" and not reference(scene).unknown else "march"
    names = [best, other] if best != other else ["exact", other]
    found = run(scene, names)
    results: dict[str, Result] = dict(found.results)
    name = next(name for name in names if name != found.reference)
    if spoil and results[name].stick_half_width is not None:
        wider = results[name].stick_half_width + spoil * results[name].a
        results[name] = dataclasses.replace(results[name], stick_half_width=wider)
    return compared(scene, plan(scene), results, _ACCURACY)


def wrong(found: Run) -> str:
    """Return what contradicts the verdicts in the outcome of ``found``; empty if nothing does."""
    ((name, comparison),) = found.comparisons.items()
    verdicts = {verdict.quantity: verdict for verdict in comparison.verdicts}
    asked = _ASKED.get(str(verdicts["regime"].reference), _STICK)
    judged = {key for key, verdict in verdicts.items() if verdict.outcome is not Outcome.NOT_JUDGED}
    within = (
        all(
            verdict.error <= verdict.bar
            for verdict in (*comparison.verdicts, *(each for some in found.conditions.values() for each in some))
            if verdict.error is not None and verdict.bar is not None and verdict.quantity != "regime"
        )
        and verdicts["regime"].outcome is not Outcome.MISSED
    )
    lost = any(v.bar is not None and v.error is None and v.reference is not None for v in comparison.verdicts)
    if found.outcome is Outcome.PASSED and asked - judged and not found.results[name].path_dependent:
        return f"passed, though not judged: {asked - judged}"
    if found.outcome is Outcome.MISSED and within and not lost:
        return f"missed, though all were within bars: {found.missed}"
    if found.outcome is Outcome.PASSED and not within:
        return "passed, though not within bars"
    return ""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=400)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    counts: Counter[tuple[str, str, str]] = Counter()
    contradictions, refused = [], 0
    for number in range(given.count):
        random = np.random.default_rng([given.seed, number, 2])
        spoil = _ACCURACY * random.uniform(0.1, 10) if number // 2 % 4 == 0 else 0.0
        try:
            found = solved(scene_of(given.seed, number), spoil)
        except InputError:
            refused += 1
            continue
        if why := wrong(found):
            contradictions.append(f"{number}: {why}")
        regime = str(found.results[found.reference or ""].regime)
        counts[regime, found.outcome.value, ", ".join(found.conclusion.unjudged)] += 1
    print(f"{'regime':14} {'outcome':11} {'scenes':>6}  headline quantities not judged")
    for (regime, outcome, unjudged), count in sorted(counts.items()):
        print(f"{regime:14} {outcome:11} {count:6}  {unjudged}")
    print(f"{sum(counts.values())} scenes, {refused} refused, {len(contradictions)} contradictions")
    print("\n".join(contradictions))


if __name__ == "__main__":
    main()
