"""Errors and estimates under mean loads, which let the tractions creep to their steady state.

python benchmarks/creep.py [--seed 1] [--count 40] [--group exact | others] [--method march fem]
                           [--accuracy 1e-2 1e-3 1e-4] [--limit 60] [--truth] [--old]

Groups of scenes: exact (Hertz, flat-rounded, tabulated profiles, f(x)), whose exact steady state is the truth for m, n
and q; others (finite, dissimilar, out of phase), whose truth is the same method after many cycles asked for. With
--truth, q1 and q2 of the first group are compared with the march after many cycles, too. The mean of Q is 0.3 to 0.99
of the largest one of a steady state. Errors are given over the estimate, to which the estimate of the truth is added.
With --old, cycles end as soon as q hardly changes, whatever room it has left: what that costs, and what it gets wrong.
"""

import argparse
import time
from collections import defaultdict
from collections.abc import Iterator
from typing import Any

import numpy as np
from estimates import OverTime, limited, shaped

import partialslip
from partialslip import Result, Scene
from partialslip.friction import history, limit
from partialslip.halfplane import contact
from partialslip.halfplane.steady import transition
from partialslip.halfplane.turning import half_cycle
from partialslip.run.judge import compare
from partialslip.run.judge.measures import norm_errors
from partialslip.scene.reading import parse_scene
from partialslip.tools.errors import InputError
from partialslip.tools.threads import one_thread

MANY = 200  # cycles asked for: they end where nothing but rounding changes
KINDS = ("hertz", "flat-rounded", "x^4", "f(x)", "hertz", "tabulated", "f(x)")
OTHERS = ("finite", "dissimilar", "out of phase")
KEYS = ("m", "n", "q", "q1", "q2")


def drawn(seed: int, number: int, group: str) -> tuple[str, Scene]:
    """Kind and scene of the ``group`` of that ``seed`` and ``number``."""
    random = np.random.default_rng([seed, number, group == "others"])
    kinds = OTHERS if group == "others" else KINDS
    kind, R, a = kinds[number % len(kinds)], 0.02, 1e-3
    while True:
        f = float(random.uniform(0.2, 0.8))
        data: dict[str, Any] = {
            "name": f"creep-{group}-{seed}-{number}",
            "material": {"E": 70e9, "nu": 0.3},
            "friction": {"f": f},
            "profile": {"kind": "hertz", "R": R},
            "load": {"a": a},
        }
        profile = kind if kind in ("flat-rounded", "x^4", "tabulated") else "hertz"
        if group == "others" and random.random() < 0.3:
            profile = "flat-rounded"
        if profile != "hertz":
            data["profile"], P = shaped(random, profile, R, a, parse_scene(data).material.A)
            data["load"] = {"P": P}
        if kind == "f(x)":
            x = np.linspace(-1.2, 1.2, 9) * a
            data["friction"] = {"f": (f * (1 + 0.2 * random.uniform(-1, 1, 9))).tolist(), "x": x.tolist()}
        pressed = contact(parse_scene(data))
        fP, fp0 = f * pressed.P, f * pressed.p0
        Qf = random.uniform(0.05, 0.8)
        sf = float(transition(Qf, pressed.shape)) * 10 ** random.uniform(-0.4, 0.6)
        try:
            bound = half_cycle(pressed, f, 2 * fP * Qf, fp0 * sf).mean_load_bound
        except InputError:
            continue
        share = random.uniform(0.3, 0.99)
        if not 1e-3 < bound < 1:
            continue
        ways, turned = np.array([-1.0, 1.0]), random.choice([-1.0, 1.0], 4)
        if kind == "out of phase":
            once = 2 * np.pi * np.arange(random.integers(3, 6))
            once = once / (len(once))
            ways = np.cos(once), np.cos(once + random.uniform(0.3, 2.8))
            share *= 0.8
        else:
            ways = ways, ways
        Q = turned[0] * Qf * ways[0] + turned[1] * share * bound
        sigma = turned[2] * sf / 2 * ways[1] + turned[3] * float(random.choice([0.0, 1.0, 1.0])) * random.uniform(0, 4)
        if abs(Q).max() > 0.99:
            continue
        data["load"] |= {"Q": (fP * Q).tolist(), "sigma": (fp0 * sigma).tolist()}
        if kind == "dissimilar":
            data["material"] = {"upper": {"E": 200e9, "nu": 0.3}, "lower": {"E": 70e9, "nu": 0.3}}
        if kind == "finite":
            lower = {"width": 40 * a, "height": float(random.uniform(6, 12)) * a, "support": "roller", "pulled": True}
            upper = {
                "kind": "pad",
                "width": float(random.uniform(6, 16)) * a,
                "height": float(random.uniform(5, 10)) * a,
            }
            data["bodies"] = {"upper": upper | {"support": "clamped"}, "lower": lower}
        try:
            return kind, parse_scene(data)
        except InputError:
            continue


def errors(scene: Scene, found: Result, truth: Result, keys: tuple[str, ...]) -> dict[str, tuple[float, float]]:
    """Error and estimate of ``found`` by key, with the estimate of the ``truth`` added to it."""
    compared = compare(found, truth, scene, None)
    known = {key: getattr(compared, key) for key in ("m", "n", "q")}
    if {"q1", "q2"} & {*keys} and found.traction.values.levels and truth.traction.values.levels:
        known |= norm_errors(found.traction, truth.traction, scene.friction.f, ("q1", "q2"))
    return {
        key: (known[key], found.estimate[key] + truth.estimate.get(key, 0.0))
        for key in keys
        if known.get(key) is not None and key in found.estimate
    }


def solved(scene: Scene, method: str, seconds: float) -> tuple[Result | str, float]:
    """Result, or why there is none, and CPU seconds."""
    began = time.process_time()
    try:
        with limited(seconds):
            found: Result | str = partialslip.run(scene, [method]).results[method]
    except OverTime:
        found = "over time"
    except InputError as error:
        found = f"refused: {str(error)[:100]}"
    return found, time.process_time() - began


def rows(
    given: argparse.Namespace,
) -> Iterator[tuple[int, str, str, float, float, dict[str, tuple[float, float]], str]]:
    """Number, kind, method, accuracy, CPU seconds, errors and estimates, and the regime, of one after the other."""
    for number in range(given.first, given.first + given.count):
        kind, scene = drawn(given.seed, number, given.group)
        exact = solved(scene, "exact", given.limit)[0] if given.group == "exact" else None
        longer = scene.replace(load={"cycles": MANY})
        levels = None
        if exact is not None and given.truth:
            levels = solved(longer.replace(fem={"accuracy": min(given.accuracy)}), "march", given.limit)[0]
        for method in given.method:
            if method == "march" and kind == "finite":
                continue
            for accuracy in given.accuracy:
                found, seconds = solved(scene.replace(fem={"accuracy": accuracy}), method, given.limit)
                if isinstance(found, str):
                    yield number, kind, method, accuracy, seconds, {}, found
                    continue
                known: dict[str, tuple[float, float]] = {}
                if isinstance(exact, Result) and exact.regime == found.regime:
                    known = errors(scene, found, exact, ("m", "n", "q"))
                if exact is None:
                    truth = solved(longer.replace(fem={"accuracy": accuracy}), method, given.limit)[0]
                    if isinstance(truth, Result) and truth.regime == found.regime:
                        known = errors(scene, found, truth, KEYS)
                elif isinstance(levels, Result):
                    known |= errors(scene, found, levels, ("q1", "q2"))
                yield number, kind, method, accuracy, seconds, known, found.regime


@one_thread
def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--group", choices=["exact", "others"], default="exact")
    parser.add_argument("--method", choices=["march", "fem"], nargs="+", default=["march", "fem"])
    parser.add_argument("--accuracy", type=float, nargs="+", default=[1e-2, 1e-3, 1e-4])
    parser.add_argument("--limit", type=float, default=60.0, metavar="CPU_SECONDS")
    parser.add_argument("--truth", action="store_true")
    parser.add_argument("--old", action="store_true")
    given = parser.parse_args()
    if given.old:
        limit.undecided = history.lost = lambda rooms, *_: np.zeros(len(rooms[-1]), bool)
    ratios, seconds = (
        defaultdict[tuple[str, float, str], list[float]](list),
        defaultdict[tuple[str, float], float](float),
    )
    for number, kind, method, accuracy, spent, known, regime in rows(given):
        over = {key: error / max(estimate, 1e-15) for key, (error, estimate) in known.items()}
        seconds[method, accuracy] += spent
        for key, ratio in over.items():
            ratios[method, accuracy, key].append(ratio)
        worst = max(over, key=over.__getitem__, default=None)
        told = f"{worst} {known[worst][0]:.1e} of {known[worst][1]:.1e}: {over[worst]:.2f}" if worst else "not compared"
        mark = " !" if worst and over[worst] > 1 else ""
        print(f"{number:4} {kind:13} {method:5} {accuracy:.0e} {spent:6.2f} s  {regime:14.40} {told}{mark}", flush=True)
    for (method, accuracy), spent in seconds.items():
        print(f"{method} at {accuracy:g}: {spent:.1f} CPU s")
        for key in KEYS:
            if len(some := np.array(ratios[method, accuracy, key])):
                print(f"  {key:2} {len(some):4} beyond 1: {np.mean(some > 1):5.1%}, beyond 2: {np.sum(some > 2)}, "
                      f"worst {some.max():.2f}")  # fmt: skip


if __name__ == "__main__":
    main()
