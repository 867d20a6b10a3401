"""The price list of --accuracy, fitted to random runs and checked on others, and budgets beside default runs.

python benchmarks/prices.py fit LEDGER [COUNT] | check LEDGER [COUNT]

Scenes are drawn by seeds: Hertz and flat-rounded contacts, fully reversed loads, mean loads, varying P, finite bodies,
unlike materials and bodies on a pin, CHOLMOD and SuperLU. ``fit`` writes the shipped price list anew; it goes on until
14 scenes have fully reversed loads along one way, whose prices are told. ``check`` runs
each scene with ``--accuracy``, and then with the CPU seconds that this took as ``--budget``. All runs are whole
processes, from exec to exit, with their children. A stopped run goes on.
"""

import argparse
import itertools
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
from partialslip.batch.ledger import Ledger, case_key, scene_content
from partialslip.scene.writing import scene_toml
from partialslip.study.cost import prices

CLASSES = {"reversed": 7.5, "mean loads": 4.5, "varying P": 4.5, "finite": 3.5, "unlike": 3.5, "pivot": 3.0}  # digits
PROFILES = ("hertz", "flat-rounded")
FITTED, CHECKED = 0, 1000  # first seeds
SHIPPED = Path(partialslip.__file__).parent / "study" / "cost" / "prices.json"
RUN = [sys.executable, "-m", "partialslip", "run", "--force"]
REFERENCE = ("hertz-shear", "--budget", "1e-3s")  # refused once it is priced: the start of a run, and an exit ...
START = 0.88  # ... and the part of the start, measured
TOLD, FEWEST = "reversed", 14


def drawn(seed: int) -> partialslip.Scene:
    """A random scene, class and profile in turn."""
    random, kinds = np.random.default_rng([7, seed]), [*CLASSES]
    kind, profile = kinds[seed % len(kinds)], PROFILES[seed // len(kinds) % 2]
    asked = float(10 ** -random.uniform(2, CLASSES[kind]))
    factor = "superlu" if random.random() < 0.25 else "cholmod"
    candidates = (msgspec.to_builtins(random_scene(number, asked)) for number in range(1000 * (seed + 1), 1 << 40))
    data: dict[str, Any] = next(each for each in candidates if each["profile"]["kind"] == profile)
    load, a, f = data["load"], 1e-3, data["friction"]["f"]
    P, Q, sigma = load["P"], load["Q"][1], load["sigma"][1]
    if kind == "mean loads":
        Q_mean, sigma_mean = random.uniform(-1, 1) * (0.95 * f * P - abs(Q)), random.uniform(-1, 1) * abs(sigma)
        load |= {"Q": [Q_mean - Q, Q_mean + Q], "sigma": [sigma_mean - sigma, sigma_mean + sigma]}
    elif kind == "varying P":
        rises, least = random.random() < 0.5, min(max(0.5, abs(Q) / (0.9 * f * P)), 0.95)
        load["P"] = [P * random.uniform(least, 0.98), P][:: 1 if rises else -1]
    elif kind in ("finite", "pivot"):
        upper = {"width": a * random.uniform(6, 16), "height": a * random.uniform(3, 8)}
        upper["kind"] = str(random.choice(["pad", "block"]))
        if kind == "pivot":
            upper |= {"support": "pivot", "pivot_height": a * random.uniform(0, 0.3)}
        data["bodies"] = {"upper": upper}
        if random.random() < 0.5:
            lower = {"width": a * random.uniform(12, 40), "height": a * random.uniform(4, 10), "support": "roller"}
            data["bodies"]["lower"] = lower
    elif kind == "unlike":
        data["material"]["upper"] = {"E": data["material"]["E"] * random.uniform(1.5, 10), "nu": 0.3}
    data["load"] = {key: value for key, value in load.items() if value is not None}
    data |= {"name": f"prices-{seed}", "friction": {"f": f}, "fem": {"accuracy": asked, "factor": factor}}
    return partialslip.parse_scene({key: value for key, value in data.items() if value is not None})


def process(*options: str) -> tuple[float, int, str]:
    """CPU seconds of ``partialslip run`` with these ``options``, exit code, and its last words."""
    with tempfile.TemporaryFile("w+") as text:
        child = subprocess.Popen([*RUN, *options], stdout=text, stderr=text)
        _, status, used = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        text.seek(0)
        words = " ".join(line for line in text.read().splitlines() if "CPU s" in line or child.returncode == 2)
    return used.ru_utime + used.ru_stime, child.returncode, words


def key_of(scene: partialslip.Scene, what: str) -> str:
    """Key of a run in the ledger."""
    return case_key({"scene": scene_content(scene), "what": what})


def taken(ledger: Ledger, scene: partialslip.Scene, what: str, seconds: float = 0.0) -> dict[str, Any]:
    """CPU seconds of a run of ``scene`` with --accuracy or --budget of so many ``seconds`` (``what``), in the ledger or
    measured: of the process, of the reference just before, and of the methods; exit code, words, estimates."""
    key = key_of(scene, what)
    if key not in ledger:
        start = 0.0 if seconds else START * process(*REFERENCE)[0]
        value = f"{seconds:.3f}s" if seconds else f"{scene.fem.accuracy!r}"
        with tempfile.TemporaryDirectory() as folder:
            file, record = Path(folder) / "scene.toml", Path(folder) / "out" / "results.json"
            file.write_text(scene_toml(scene), "utf-8")
            cpu, code, words = process(str(file), f"--{what}", value, "--out", str(record.parent))
            methods = json.loads(record.read_text("utf-8"))["methods"] if record.exists() else {}
        found = {"value": value, "start_s": start, "cpu_s": cpu, "code": code, "words": words}
        found["costs"] = {name: method["cost"]["cpu_s"] for name, method in methods.items()}
        found["estimate"] = methods["fem"]["estimate"] if methods else {}
        ledger.add(key, found)
    return ledger[key]


def fit(ledger: Ledger, count: int) -> None:
    """Measure ``count`` scenes and write the price list."""
    runs, seeds = [], [*range(FITTED, FITTED + count)]
    missing = FEWEST - sum(prices.price_family(drawn(seed)) == TOLD for seed in seeds)
    further = (seed for seed in itertools.count(FITTED + count) if prices.price_family(drawn(seed)) == TOLD)
    for seed in [*seeds, *itertools.islice(further, max(missing, 0))]:
        scene = drawn(seed)
        found = taken(ledger, scene, "accuracy")
        print(f"{seed:3} {prices.price_family(scene):40} {found['cpu_s']:6.2f} s", flush=True)
        if found["costs"]:
            closing = found["cpu_s"] - found["start_s"] - sum(found["costs"].values())
            runs.append(prices.MeasuredRun(scene, found["costs"], found["start_s"], closing))
    machine = ledger[key_of(drawn(FITTED), "accuracy")]["made"]["machine"]
    fitted = prices.fit(runs, f"{machine['processor']}, {machine['cores']} cores, {machine['system']}")
    SHIPPED.write_text(prices.to_json(fitted), "utf-8")
    print(prices.to_json(fitted))


def check(ledger: Ledger, count: int) -> None:
    """Two runs of each of ``count`` scenes: predicted and actual CPU seconds, and estimates with a budget over those
    of the default run that took as many CPU seconds."""
    ratios, shares, worse, known = [], [], [], prices.load_prices()
    print("seed family                           factor   asked   predicted    took ratio |  budget    took share |"
          " estimates a, m, n   all")  # fmt: skip
    for seed in range(CHECKED, CHECKED + count):
        scene = drawn(seed)
        first = taken(ledger, scene, "accuracy")
        second = taken(ledger, scene, "budget", first["cpu_s"])
        budget, predicted = first["cpu_s"], known.price(scene, start=first["start_s"]).cpu_s
        shares.append(second["cpu_s"] / budget)
        if predicted:
            ratios.append(first["cpu_s"] / predicted)
        keys = sorted({*first["estimate"]} & {*second["estimate"]})
        of_all = [second["estimate"][key] / first["estimate"][key] for key in keys if first["estimate"][key]]
        ends = [max(each["estimate"].get(key, 0.0) for key in "amn") for each in (first, second)]
        worse.append(max(of_all, default=1.0))
        told = f"{predicted:8.2f}s {first['cpu_s']:6.2f}s {ratios[-1]:5.2f}" if predicted else (
            f"not known {first['cpu_s']:6.2f}s     -")  # fmt: skip
        print(f"{seed} {prices.price_family(scene):32} {scene.fem.factor:8} {scene.fem.accuracy:.1e} {told} | "
              f"{budget:6.2f}s {second['cpu_s']:6.2f}s {shares[-1]:5.2f} | {ends[0]:.1e} {ends[1]:.1e} "
              f"{worse[-1]:5.2f}", flush=True)  # fmt: skip
    if ratios:
        within = sum(1 / prices.TRUSTED <= ratio <= prices.TRUSTED for ratio in ratios)
        print(f"prices: {len(ratios)} of {count} known, {within} within {prices.TRUSTED:g} times, "
              f"ratios {min(ratios):.2f} to {max(ratios):.2f}")  # fmt: skip
    print(f"budgets: estimates larger than those of the default run in {sum(ratio > 1.001 for ratio in worse)} of "
          f"{count}, worst {max(worse):.2f}; took at most 1.25 times the budget in "
          f"{sum(share <= 1.25 for share in shares)}, worst {max(shares):.2f}")  # fmt: skip


if __name__ == "__main__":
    tables = {"fit": fit, "check": check}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=[*tables])
    parser.add_argument("ledger", type=Path)
    parser.add_argument("count", nargs="?", type=int, default=60, help="of scenes; of check each runs twice")
    given = parser.parse_args()
    tables[given.what](Ledger(given.ledger), given.count)
