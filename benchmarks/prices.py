"""The price list of finite elements: fitted to random scenes, and checked on others.

python benchmarks/prices.py fit LEDGER | check LEDGER

Both measure what the ledger does not have yet; a stopped run goes on. ``fit`` writes the shipped price list anew.
"""

import argparse
import json
import sys
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from accuracy import random_scene

import partialslip
from partialslip.study import prices
from partialslip.study.case import Case, solve_apart
from partialslip.study.ledger import Ledger

LADDER = {4: (1e-2, 1e-3, 1e-4, 1e-5, 1e-6), 3: (1e-2, 1e-3, 1e-4), 2: (1e-2, 1e-3)}
FITTED, CHECKED = range(400, 412), range(500, 520)
SHIPPED = Path(partialslip.__file__).parent / "study" / "prices.json"


def case(seed: int, accuracy: float, order: int) -> Case:
    data: dict[str, Any] = msgspec.to_builtins(random_scene(seed, accuracy))
    data["fem"]["order"] = order
    return Case(partialslip.parse_scene(data), ("exact", "fem"), {"seed": seed})


def measured(ledger: Ledger, cases: list[Case]) -> list[dict[str, Any]]:
    for number, each in enumerate(cases):
        print(f"{number} of {len(cases)}", end="\r", file=sys.stderr, flush=True)
        if each.key not in ledger:
            ledger.add(each.key, solve_apart(each))
    return [ledger[each.key] for each in cases]


def fit(ledger: Ledger) -> None:
    cases = [case(seed, asked, order) for seed in FITTED for order, ladder in LADDER.items() for asked in ladder]
    entries = measured(ledger, cases)
    machine = entries[0]["made"]["machine"]
    found = prices.fit(entries, f"{machine['processor']}, {machine['cores']} cores, {machine['system']}")
    SHIPPED.write_text(prices.to_json(found), "utf-8")
    print(json.dumps(msgspec.to_builtins(found), indent=1))


def check(ledger: Ledger) -> None:
    """Scenes that the fit has not seen, each at its own accuracy, in the order that the list calls cheapest."""
    known, ratios, reached = prices.load_prices(), [], []
    accuracies = np.geomspace(1e-2, 1e-6, len(CHECKED)).tolist()
    chosen = [
        known.cheapest(case(seed, asked, 4).scene, asked) for seed, asked in zip(CHECKED, accuracies, strict=True)
    ]
    entries = measured(ledger, [case(s, price.accuracy, price.order) for s, price in zip(CHECKED, chosen, strict=True)])
    for price, entry in zip(chosen, entries, strict=True):
        found, cost = entry["comparison"]["fem"], entry["methods"]["fem"]["cost"]["cpu_s"]
        worst = max(found[key] for key in ("a", "m", "n"))
        ratios.append(cost / price.cpu_s)
        reached.append(worst <= price.accuracy)
        print(
            f"{entry['scene']['name']:10} {entry['scene']['profile']['kind']:12} P{price.order} {price.accuracy:.1e} "
            f"found {worst:.1e}  predicted {price.cpu_s:5.2f} s, took {cost:5.2f} s, ratio {ratios[-1]:.2f}"
        )
    within = sum(0.5 <= ratio <= 2 for ratio in ratios)
    print(
        f"reached {sum(reached)} of {len(reached)}; CPU within a factor of 2 in {within}, ratio {np.median(ratios):.2f}"
    )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["fit", "check"])
    parser.add_argument("ledger", type=Path)
    given = parser.parse_args()
    {"fit": fit, "check": check}[given.what](Ledger(given.ledger))
