"""The price list of finite elements: fitted to random scenes, checked on others, and budgets that are kept.

python benchmarks/prices.py fit LEDGER | check LEDGER | budgets LEDGER [SECONDS ...]

All measure what the ledger does not have yet; a stopped run goes on. ``fit`` writes the shipped price list anew.
``check`` asks for accuracies, ``budgets`` for 2, 5 and 20 s: whole processes, from exec to exit, with their children.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from accuracy import random_scene

import partialslip
from partialslip.batch.job import Job, Solved, solve_apart
from partialslip.batch.ledger import Ledger, case_key
from partialslip.study.cost import prices

# accuracies by order and factorisation
LADDER = {
    (6, "cholmod"): (1e-5, 1e-6, 1e-7, 1e-8, 1e-9),
    (4, "cholmod"): (1e-2, 1e-4, 1e-5, 1e-6, 1e-7),
    (4, "superlu"): (1e-3, 1e-5, 1e-7),
    (3, "cholmod"): (1e-2, 1e-3, 1e-4),
}
KINDS = ("hertz", "flat-rounded", "tabulated")
EACH = {"cholmod": 2, "superlu": 1}  # scenes of each kind
FINE = 1e-6  # beyond that one scene of each kind
BUDGETS = (2.0, 5.0, 20.0)
CHECKED = range(500, 520)
SHIPPED = Path(partialslip.__file__).parent / "study" / "cost" / "prices.json"
RUN = [sys.executable, "-m", "partialslip", "run", "--force"]


def fitted() -> list[Job]:
    """The cheapest first, so that a list can be fitted before all are measured."""
    seeds: dict[str, list[int]] = {kind: [] for kind in KINDS}
    for seed in range(400, 500):
        seeds[msgspec.to_builtins(random_scene(seed, 1e-3))["profile"]["kind"]].append(seed)
    found = []
    for (order, factor), ladder in LADDER.items():
        for asked in ladder:
            for kind in KINDS:
                for seed in seeds[kind][: EACH[factor] if asked >= FINE else 1]:
                    data: dict[str, Any] = msgspec.to_builtins(random_scene(seed, asked))
                    data["fem"] |= {"order": order, "factor": factor}
                    found.append(Job(partialslip.parse_scene(data), ("exact", "fem"), {"seed": seed}))
    return sorted(found, key=lambda case: -case.scene.fem.accuracy)


def measured(ledger: Ledger, cases: list[Job]) -> list[Solved]:
    for number, each in enumerate(cases):
        print(f"{number} of {len(cases)}", end="\r", file=sys.stderr, flush=True)
        if each.key not in ledger:
            ledger.add(each.key, solve_apart(each))
    return [ledger.read(each.key, Solved) for each in cases]


def process(*options: str) -> tuple[float, int, str]:
    """CPU seconds of ``partialslip run`` with these ``options``, exit code, and what it says of the price."""
    with tempfile.TemporaryFile("w+") as text:
        child = subprocess.Popen([*RUN, *options], stdout=text, stderr=text)
        _, status, used = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        text.seek(0)
        lines = text.read().splitlines() or [""]
    return used.ru_utime + used.ru_stime, child.returncode, lines[-1] if child.returncode == 2 else lines[-2]


def overheads(ledger: Ledger) -> dict[str, float]:
    """Start and closing of a run, and the march: medians of three, as multiples of the start of a case's process."""
    key = case_key({"overheads": 1})
    if key not in ledger:
        found = []
        with tempfile.TemporaryDirectory() as folder:
            for _ in range(3):
                refused, _, _ = process("hertz-shear", "--budget", "1e-3s")
                whole, _, _ = process("hertz-shear", "--accuracy", "1e-2", "--out", folder)
                methods = partialslip.load_result(Path(folder) / "results.json").methods
                work = sum(method.cost.cpu_s for method in methods.values())
                process("hertz-shear", "--with", "march", "--out", folder)
                march = partialslip.load_result(Path(folder) / "results.json").methods["march"].cost.cpu_s
                apart = solve_apart(Job(partialslip.load_scene("hertz-shear"), ("exact",), {}))
                start = apart.process.cpu_s - apart.run.methods["exact"].cost.cpu_s
                found.append([refused / start, (whole - work - refused) / start, march / start])
        medians = np.median(found, axis=0).tolist()
        ledger.add(key, {"overheads": dict(zip(("start", "closing", "march"), medians, strict=True))})
    result: dict[str, float] = ledger[key]["overheads"]
    return result


def fit(ledger: Ledger, _: list[float]) -> None:
    extra = overheads(ledger)
    entries = measured(ledger, fitted())
    costs = [sum(method.cost.cpu_s for method in entry.run.methods.values()) for entry in entries]
    start = float(np.median([entry.process.cpu_s - cost for entry, cost in zip(entries, costs, strict=True)]))
    machine = ledger[fitted()[0].key]["made"]["machine"]
    found = prices.fit(
        entries,
        {key: value * start for key, value in extra.items()},
        f"{machine['processor']}, {machine['cores']} cores, {machine['system']}",
    )
    SHIPPED.write_text(prices.to_json(found), "utf-8")
    print(json.dumps(msgspec.to_builtins(found), indent=1))


def scenes(folder: Path) -> dict[str, str]:
    """Shipped ones and random ones that the fit has not seen, by name."""
    found = {name: name for name in partialslip.shipped_scenes()}
    for seed in CHECKED:
        scene = random_scene(seed, 2e-5)
        found[scene.name] = str(folder / f"{scene.name}.toml")
        Path(found[scene.name]).write_text(_toml(msgspec.to_builtins(scene)), "utf-8")
    return found


def _toml(data: dict[str, Any]) -> str:
    """A scene's file; settings that are not given are left out."""
    lines = [f"name = {json.dumps(data['name'])}"]
    for table, values in data.items():
        if isinstance(values, dict) and table in ("material", "profile", "friction", "load"):
            given = {key: value for key, value in values.items() if value is not None and not isinstance(value, dict)}
            lines += [f"[{table}]", *(f"{key} = {json.dumps(value)}" for key, value in given.items())]
    return "\n".join(lines) + "\n"


def taken(ledger: Ledger, name: str, file: str, *options: str) -> dict[str, Any]:
    """CPU seconds, exit code and last words of a run, and what its results.json says."""
    key = case_key({"scene": name, "options": options})
    if key not in ledger:
        with tempfile.TemporaryDirectory() as folder:
            cpu, code, words = process(file, *options, "--out", folder)
            record = Path(folder) / "results.json"
            fem = json.loads(record.read_text("utf-8"))["methods"]["fem"] if record.exists() else {}
        accuracy = fem.get("settings", {}).get("accuracy")
        found = {"name": name, "options": options, "cpu_s": cpu, "code": code, "words": words, "accuracy": accuracy}
        ledger.add(key, found)
    return ledger[key]


def check(ledger: Ledger, _: list[float]) -> None:
    """Whole processes at accuracies from 1e-2 to 1e-8, beside what was predicted."""
    ratios = []
    with tempfile.TemporaryDirectory() as folder:
        known = scenes(Path(folder))
        for (name, file), asked in zip(known.items(), np.geomspace(1e-2, 1e-8, len(known)).tolist(), strict=True):
            found = taken(ledger, name, file, "--accuracy", f"{asked:.1e}")
            predicted = _predicted(found["words"])
            ratios.append(found["cpu_s"] / predicted)
            print(f"{name:22} {asked:.1e} predicted {predicted:6.2f} s, took {found['cpu_s']:6.2f} s, exit "
                  f"{found['code']}, ratio {ratios[-1]:.2f}", flush=True)  # fmt: skip
    within = sum(0.5 <= ratio <= 2 for ratio in ratios)
    print(f"within a factor of 2 in {within} of {len(ratios)}, median ratio {np.median(ratios):.2f}")


def budgets(ledger: Ledger, seconds: list[float]) -> None:
    """Whole processes with budgets: within 1.25 times the budget in 90 %, never beyond 1.6 times."""
    shares, refused = [], []
    print(f"{'scene':22} {'asked':>6} predicted   took  share  accuracy  exit")
    with tempfile.TemporaryDirectory() as folder:
        for budget in seconds or BUDGETS:
            for name, file in scenes(Path(folder)).items():
                found = taken(ledger, name, file, "--budget", f"{budget:g}s")
                if found["code"] == 2:
                    refused.append(f"{name:22} {found['words']}")
                    continue
                shares.append(found["cpu_s"] / budget)
                asked, paid = _predicted(found["words"]), found["cpu_s"]
                print(f"{name:22} {budget:5g}s {asked:8.2f}s {paid:5.2f}s {shares[-1]:6.2f}   {found['accuracy']:.1e}"
                      f"  {found['code']:4}", flush=True)  # fmt: skip
    print("below the least price:", *refused, sep="\n")
    if shares:
        within, median = np.mean(np.array(shares) <= 1.25), np.median(shares)
        print(f"{len(shares)} runs: within 1.25 times in {within:.0%}, worst {max(shares):.2f}, median {median:.2f}")


def _predicted(words: str) -> float:
    return float(words.split("a: ")[1].split(" CPU s, predicted")[0])


if __name__ == "__main__":
    tables = {"fit": fit, "check": check, "budgets": budgets}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=[*tables])
    parser.add_argument("ledger", type=Path)
    parser.add_argument("seconds", nargs="*", type=float, help="of budgets: which")
    given = parser.parse_args()
    tables[given.what](Ledger(given.ledger), given.seconds)
