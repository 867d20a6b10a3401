"""Estimates of errors against true errors, on random scenes whose answers are known.

python benchmarks/estimates.py run FILE [--method fem] [--seed 1] [--count 100] [--finest 1e-7] [--coarsest 1e-3]
                                        [--turning]
python benchmarks/estimates.py show FILE...

Truth is the exact steady state, and for q1 and q2 the exact first loading where the steady state keeps that; elsewhere
the march at the finest accuracy that it reaches. --turning: large tension under which slip turns round on the way, a
third of the scenes with mean loads. Equal --finest and --coarsest ask for one accuracy. FILE (JSON lines) keeps what is
done: a run that was stopped goes on.
"""

import argparse
import json
import math
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
from msgspec.structs import replace

import partialslip
from partialslip import Result, Scene
from partialslip.arrays import Array
from partialslip.condensed.threads import one_thread
from partialslip.gradual import turns_round
from partialslip.halfplane import contact
from partialslip.halfplane.gradual_path.half_cycle import steady
from partialslip.halfplane.gradual_path.room import room
from partialslip.halfplane.gradual_path.stage import Loads, LostError
from partialslip.halfplane.steady import stick_zone, transition
from partialslip.judge import compare
from partialslip.judge.means import norm_errors
from partialslip.scene.reading import parse_scene

KEYS = ("a", "left", "right", "m", "n", "p", "q", "q1", "q2")
KINDS = (
    "reversed", "mean", "marched", "mean", "narrow strip", "reversed", "mean", "tiny zone", "marched", "mean",
    "reversed", "off centre",
)  # fmt: skip
TURNING = ("turning", "turning", "turning mean")
PROFILES = ("hertz", "flat-rounded", "hertz", "tabulated", "hertz")
NUS = (0.0, 0.2, 0.3, 0.4, 0.45, 0.49, 0.499, 0.4999)
TRUTH = 1e-5  # asked of the march where it is the truth: its finest mesh, in not too many steps
KNOWN = 0.5  # of an estimate: where the march is not known to that, it is no truth
SETTLED = 1e-3  # of the accuracy: a change of q in the last cycle that is none
WEIGHT = 2.5  # of cheap accuracies


def drawn(seed: int, number: int, finest: float, coarsest: float, kinds: Sequence[str] = KINDS) -> tuple[str, Scene]:
    """Kind, of ``kinds``, and scene of that ``seed`` and ``number``."""
    random = np.random.default_rng([seed, number])
    kind, profile = kinds[number % len(kinds)], PROFILES[number % len(PROFILES)]
    E, R, a = 70e9, 0.02, 1e-3
    plane, nu = ("stress", 0.3) if random.random() < 0.2 else ("strain", float(random.choice(NUS)))
    data: dict[str, Any] = {
        "name": f"estimates-{seed}-{number}",
        "material": {"E": E, "nu": nu, "plane": plane},
        "friction": {"f": float(random.uniform(0.1, 0.9))},
        "profile": {"kind": "hertz", "R": R},
        "load": {"a": a},
        "fem": {"accuracy": float(coarsest * (finest / coarsest) ** (random.random() ** WEIGHT))},
    }
    if profile != "hertz":
        A = parse_scene(data).material.A
        flat = float(random.uniform(0.1, 0.8))
        psi = math.acos(flat)
        x = np.linspace(0, 1.6, 5) * a
        gap = x**2 / (2 * R) * (1 + random.uniform(0, 1) * (x / a) ** 2)
        data["profile"] = {"kind": "tabulated", "x": x.tolist(), "gap": gap.tolist()}
        P = math.pi * a**2 / (2 * A * R)
        if profile == "flat-rounded":
            data["profile"], P = {"kind": profile, "R": R, "b": flat * a}, a**2 / (A * R) * (psi - math.sin(psi) * flat)
        data["load"] = {"P": P}
    scene = parse_scene(data)
    pressed, f = contact(scene), scene.friction.f
    Q, sigma = loads(random, kind, pressed.shape)
    turned = random.choice([-1.0, 1.0], 2)
    Q, sigma = turned[0] * f * pressed.P * Q, turned[1] * f * pressed.p0 * sigma
    data["load"] |= {"Q": Q.tolist(), "sigma": sigma.tolist()}
    if kind in ("marched", "mean"):
        data["load"]["cycles"] = {"marched": 8, "mean": 6}[kind]
    return kind, parse_scene(data)


def loads(random: np.random.Generator, kind: str, shape: Any) -> tuple[Array, Array]:
    """Q in f P and sigma in f p0 at load points 1 and 2."""
    ways = np.array([-1.0, 1.0])
    if kind in ("tiny zone", "off centre"):
        c = 10 ** random.uniform(-4, -2) if kind == "tiny zone" else random.uniform(0.05, 0.4)
        zone = np.array((1 - c) * random.uniform(0.2, 0.95)), np.array(c), np.array(-1)
        found = shape.conditions(*zone)
        return float(found.Qf) * ways, float(found.sf) / 2 * ways
    if kind in TURNING:
        while True:  # until slip turns round in a single step's zone
            Qf, sf = random.uniform(0.1, 0.98), random.uniform(1, 14)
            zone = stick_zone(Qf, sf, shape)
            if not turns_round(Qf, sf, zone.s, zone.centre, zone.half_width):
                continue
            if kind == "turning":
                return Qf * ways, sf / 2 * ways
            with suppress(LostError):
                Q = random.uniform(-0.9, 0.9) * room(steady(Loads(sf, math.pi * Qf), shape))
                return Q + Qf * ways, sf * (random.uniform(-0.5, 0.5) + ways / 2)
    Qf = 10 ** random.uniform(-5, -2.5) if kind == "narrow strip" else random.uniform(0.1, 0.85)
    at = float(transition(Qf, shape))
    if kind == "reversed":
        return Qf * ways, random.uniform(0, 2) * at / 2 * ways
    if kind == "narrow strip":
        return Qf * ways, random.uniform(0, 0.9) * at / 2 * ways
    most = random.uniform(0.2, 0.9)  # the larger |Q|: the other is within it
    Q = np.array([most * random.uniform(-0.8, 0.9), most])
    at = float(transition((Q[1] - Q[0]) / 2, shape))  # of the cycle; small tension stays below it
    change, mean = random.uniform(0, 0.4) * at, random.uniform(-0.2, 0.2) * at
    if kind == "marched":  # the mean of the tension moves the first loading's stick zone out of the cycle's
        change, mean = random.uniform(0, 0.9) * at, random.choice([-1, 1]) * random.uniform(0.4, 1.0) * at
    sigma = mean + change / 2 * ways
    if random.random() < 0.5:
        Q, sigma = Q[::-1], sigma[::-1]
    return Q, sigma


def true_errors(scene: Scene, kind: str, found: Result) -> dict[str, float]:
    """Errors by key, without those that nothing is known of."""
    exact = partialslip.run(scene, ["exact"]).results["exact"]
    compared = compare(found, exact, scene, None)
    errors = {"a": compared.a, "p": compared.p}
    if (found.last_cycle_change or 0.0) <= SETTLED * scene.fem.accuracy:
        errors |= {key: getattr(compared, key) for key in ("m", "n", "q") if key not in exact.undetermined}
    left, right = found.ends[1]
    errors |= {"left": abs(left + exact.a) / exact.a, "right": abs(right - exact.a) / exact.a}
    truth = exact if not {"q1", "q2"} & {*exact.undetermined} else None
    if kind == "marched" and found.method != "march":
        finer = replace(scene, fem=replace(scene.fem, accuracy=TRUTH))
        truth = partialslip.run(finer, ["march"]).results["march"]
    if truth and truth.traction.levels_at and found.traction.levels_at:
        levels = norm_errors(found.traction, truth.traction, scene.friction.f, ("q1", "q2"))
        errors |= {
            key: off for key, off in levels.items() if truth.estimate.get(key, 0.0) <= KNOWN * found.estimate[key]
        }
    return {key: error for key, error in errors.items() if error is not None}


def rows(
    method: str, seed: int, numbers: Iterable[int], finest: float, coarsest: float, kinds: Sequence[str]
) -> Iterator[dict[str, Any]]:
    """One row a scene."""
    for number in numbers:
        kind, scene = drawn(seed, number, finest, coarsest, kinds)
        result = partialslip.run(scene, [method]).results[method]
        yield {
            "method": method, "seed": seed, "number": number, "kind": kind, "profile": type(scene.profile).__name__,
            "nu": scene.material.nu, "accuracy": scene.fem.accuracy, "regime": result.regime,
            "true": true_errors(scene, kind, result), "estimate": {k: float(v) for k, v in result.estimate.items()},
            "shares": {source: dict(share) for source, share in result.shares.items()},
            "certificate": dict(result.certificate), "counts": dict(result.counts), "cpu_s": result.cost.cpu_s,
        }  # fmt: skip


def show(found: list[dict[str, Any]]) -> None:
    """By accuracy and quantity: how often the estimate is below the true error, the worst ratio, the median."""
    print(f"{len(found)} scenes, {sum(row['cpu_s'] for row in found):.0f} CPU s")
    print("        accuracy   key count  below worst true/est median est/true missed")
    decades = sorted({math.floor(math.log10(row["accuracy"]) + 1e-9) for row in found}, reverse=True)
    for decade in (None, *decades):
        some = [row for row in found if decade in (None, math.floor(math.log10(row["accuracy"]) + 1e-9))]
        for key in KEYS:
            known = [row for row in some if key in row["estimate"] and key in row["true"]]
            if not known:
                continue
            bar = {"p": 10.0}.get(key, 15.0 if key[0] == "q" else 1.0)
            true, estimate = (np.array([row[what][key] for row in known]) for what in ("true", "estimate"))
            asked = np.array([row["accuracy"] for row in known])
            true, estimate = np.maximum(true, 1e-16), np.maximum(estimate, 1e-16)
            name = "all" if decade is None else f"1e{decade}..1e{decade + 1}"
            print(
                f"{name:>16} {key:>5} {len(known):5} {np.mean(estimate < true):6.1%} {np.max(true / estimate):14.2f} "
                f"{np.median(estimate / true):15.2f} {np.sum(true > bar * asked):6}"
            )


def read(path: Path) -> list[dict[str, Any]]:
    """Rows of a file, none if it is not there."""
    return [json.loads(line) for line in path.read_text("utf-8").splitlines()] if path.exists() else []


@one_thread
def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["run", "show"])
    parser.add_argument("files", nargs="+", type=Path, metavar="FILE")
    parser.add_argument("--method", choices=["fem", "march"], default="fem")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--finest", type=float, default=1e-7)
    parser.add_argument("--coarsest", type=float, default=1e-3)
    parser.add_argument("--turning", action="store_true")
    given = parser.parse_args()
    kinds = TURNING if given.turning else KINDS
    if given.what == "run":
        path = given.files[0]
        done = {(row["method"], row["seed"], row["number"]) for row in read(path)}
        todo = [n for n in range(given.count) if (given.method, given.seed, n) not in done]
        with path.open("a", encoding="utf-8") as file:
            for row in rows(given.method, given.seed, todo, given.finest, given.coarsest, kinds):
                print(json.dumps(row), file=file, flush=True)
    show([row for path in given.files for row in read(path)])


if __name__ == "__main__":
    main()
