"""Estimates of errors against true errors, on random scenes whose answers are known.

python benchmarks/estimates.py run FILE [--method fem march] [--group steady] [--seed 1] [--count 100]
                                        [--finest 1e-7] [--coarsest 1e-3] [--limit 60] [--truth 180]
python benchmarks/estimates.py show FILE...

Groups of scenes: steady (loads of all kinds), turning (large tension under which slip turns round on the way, a third
with mean loads), plain (Hertz and flat-rounded), table (x^4, x^6 and curvatures with noise), varying (P, M or e),
unlike (materials; loads: of changing P, tension or out of phase), finite (bodies); and the random scenes of verify:
random, random-varying (P, M or e), phase (out of phase). Truth is the exact steady state, and for q1 and q2 the exact
first loading where the steady state keeps that. Elsewhere it is the march at the finest accuracy that it reaches, or at
a hundredth of the scene's; for finite bodies finite elements of another order on finer meshes. FILE (JSON lines) keeps
what is done: a run that was stopped goes on. A scene that takes a method more CPU seconds than the limit is counted and
left; so is a truth that takes too long.
"""

import argparse
import dataclasses
import json
import math
import signal
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from msgspec.structs import replace

import partialslip
from partialslip import Result, Scene
from partialslip.halfplane import contact
from partialslip.halfplane.gradual_path.gradual_mean_bound import gradual_mean_load_bound
from partialslip.halfplane.gradual_path.half_cycle import steady
from partialslip.halfplane.gradual_path.stage import Loads, LostError
from partialslip.halfplane.steady import steady_stick_zone, transition
from partialslip.run.judge import compare
from partialslip.run.judge.measures import norm_errors
from partialslip.scene.gradual import turns_round
from partialslip.scene.reading import parse_scene
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError
from partialslip.tools.threads import one_thread
from partialslip.verify import random_scenes

KEYS = ("a", "left", "right", "m", "n", "p", "q", "q1", "q2")
KINDS = (
    "reversed", "mean", "marched", "mean", "narrow strip", "reversed", "mean", "tiny zone", "marched", "mean",
    "reversed", "off centre",
)  # fmt: skip
TURNING = ("turning", "turning", "turning mean")
PROFILES = ("hertz", "flat-rounded", "hertz", "tabulated", "hertz")
_TURNLESS = ("reversed", "mean", "off centre", "reversed", "mean")  # redrawn where slip turns round
# Kinds of loads and profiles of each group; their counts have no common divisor.
GROUPS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "steady": (KINDS, PROFILES),
    "turning": (TURNING, PROFILES),
    "plain": (_TURNLESS, ("hertz", "flat-rounded")),
    "table": (_TURNLESS, ("x^4", "x^6", "noisy")),
    "varying": (("P varies", "M varies", "e and P vary"), ("hertz", "flat-rounded")),
    "unlike": (("pressed", "cycle"), ("hertz", "hertz", "flat-rounded")),
    "unlike-loads": (("P varies", "tension", "phase", "P varies"), ("hertz", "hertz", "flat-rounded")),
    "finite": (("pad", "block"), ("hertz", "hertz", "flat-rounded")),
}
RANDOM = ("random", "random-varying", "phase")  # scenes of verify
OF_VERIFY = 8  # most cycles of them
NUS = (0.0, 0.2, 0.3, 0.4, 0.45, 0.49, 0.499, 0.4999)
TRUTH_OF_UNLIKE = 2e-5  # the same, where stages of pressing are many
FINER_MARCH = 100.0  # accuracy of scenes of verify over that of the march that is their truth
FINER = 20.0  # accuracy of finite bodies over that of their truth
TRUTH = 1e-5  # asked of the march where it is the truth: its finest mesh, in not too many steps
KNOWN = 0.5  # of an estimate: where the march is not known to that, it is no truth
SETTLED = 1e-3  # of the accuracy: a change of q in the last cycle that is none
WEIGHT = 2.5  # of cheap accuracies


class OverTime(BaseException):
    """The limit of CPU seconds is over. No handler of errors takes it for one."""


@contextmanager
def limited(seconds: float) -> Iterator[None]:
    """Raise :class:`OverTime` after that many CPU seconds of this process."""

    def over(*_: object) -> None:
        raise OverTime

    before = signal.signal(signal.SIGPROF, over)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def drawn(seed: int, number: int, finest: float, coarsest: float, group: str = "steady") -> tuple[str, Scene]:
    """Kind and scene of the ``group`` of that ``seed`` and ``number``."""
    random = np.random.default_rng([seed, number])
    if group in RANDOM:
        return of_verify(seed, number, group, coarsest * (finest / coarsest) ** random.random())
    kinds, profiles = GROUPS[group]
    kind, profile = kinds[number % len(kinds)], profiles[number % len(profiles)]
    R, a = 0.02, 1e-3
    plane, nu = ("stress", 0.3) if random.random() < 0.2 else ("strain", float(random.choice(NUS)))
    data: dict[str, Any] = {
        "name": f"estimates-{group}-{seed}-{number}",
        "material": {"E": 70e9, "nu": nu, "plane": plane},
        "friction": {"f": float(random.uniform(0.1, 0.9))},
        "profile": {"kind": "hertz", "R": R},
        "load": {"a": a},
        "fem": {"accuracy": float(coarsest * (finest / coarsest) ** (random.random() ** WEIGHT))},
    }
    if profile != "hertz":
        data["profile"], P = shaped(random, profile, R, a, parse_scene(data).material.A)
        data["load"] = {"P": P}
    scene = parse_scene(data)
    pressed, f = contact(scene), scene.friction.f
    if group in LOADS:
        data["load"] = {"P": pressed.P, **LOADS[group](random, kind, pressed.P, pressed.a, f)}
    if group in UNLIKE:  # of about the same half-width
        stiffer = float(random.uniform(1.0, 5.0))
        upper, lower = ({"E": 70e9 * by, "nu": float(random.uniform(0.0, 0.45))} for by in (stiffer, 1.0))
        data["material"] = {"upper": upper, "lower": lower, "plane": plane}
    if group == "finite":
        data["bodies"] = bodies(random, kind, pressed.a)
    if group in LOADS:
        scene = parse_scene(data)
        while group == "varying" and not known(scene):
            scene = scene.replace(load={"M": None, "e": None} | varying(random, kind, pressed.P, pressed.a, f))
        return kind, scene
    Q, sigma = loads(random, kind, pressed.shape)
    while group in ("plain", "table") and _turns(abs(Q[1] - Q[0]) / 2, abs(sigma[1] - sigma[0]), pressed.shape):
        Q, sigma = loads(random, kind, pressed.shape)
    turned = random.choice([-1.0, 1.0], 2)
    Q, sigma = turned[0] * f * pressed.P * Q, turned[1] * f * pressed.p0 * sigma
    data["load"] |= {"Q": Q.tolist(), "sigma": sigma.tolist()}
    if kind in ("marched", "mean"):
        data["load"]["cycles"] = {"marched": 8, "mean": 6}[kind]
    return kind, parse_scene(data)


def of_verify(seed: int, number: int, group: str, accuracy: float) -> tuple[str, Scene]:
    """Kind and scene of verify's random ones."""
    phase = len(random_scenes.KINDS) - 1
    number = number * len(random_scenes.KINDS) + phase if group == "phase" else number
    drawn = random_scenes.draw_varying if group == "random-varying" else random_scenes.draw
    kind, scene = drawn(seed, number)
    cycles = {"cycles": min(scene.load.cycles or OF_VERIFY, OF_VERIFY)}
    return kind, scene.replace(fem={"accuracy": accuracy}, load=cycles)


def shaped(random: np.random.Generator, profile: str, R: float, a: float, A: float) -> tuple[dict[str, Any], float]:
    """Return a profile that is not Hertz's, and the P of a contact of about the half-width ``a``."""
    P = math.pi * a**2 / (2 * A * R)
    if profile in ("flat-rounded", "tabulated"):  # one random number, whatever is drawn: scenes of earlier runs stay
        flat = float(random.uniform(0.1, 0.8))
        psi = math.acos(flat)
        if profile == "flat-rounded":
            return {"kind": profile, "R": R, "b": flat * a}, a**2 / (A * R) * (psi - math.sin(psi) * flat)
        x = np.linspace(0, 1.6, 5) * a
        gap = x**2 / (2 * R) * (1 + random.uniform(0, 1) * (x / a) ** 2)
        return {"kind": "tabulated", "x": x.tolist(), "gap": gap.tolist()}, P
    most = 40 if profile == "noisy" else 140  # with noise each point of the contact is a kink for the mesh
    x = np.linspace(0, random.uniform(1.25, 1.8), int(random.integers(25, most + 1)))
    power = {"x^4": 4, "x^6": 6, "noisy": 2}[profile]
    if profile == "noisy":  # of the curvature, which stays positive
        slopes = np.cumsum(random.uniform(0.2, 1.8, len(x) - 1) * np.diff(x))
        gap = np.concatenate([[0.0], np.cumsum(slopes * np.diff(x))])
    else:
        gap = x**power / power
    # P of a power of x; about the same with noise
    share = {2: 1 / 2, 4: 3 / 8, 6: 5 / 16}[power] * math.pi / A
    return {"kind": "tabulated", "x": (x * a).tolist(), "gap": (gap * a**2 / R).tolist()}, share * a**2 / R


def _turns(Qf: float, sf: float, shape: Any) -> bool:
    """Whether slip turns round in a single step's zone."""
    zone = steady_stick_zone(Qf, sf, shape)
    return bool(turns_round(Qf, sf, zone.s, zone.centre, zone.half_width))


def varying(random: np.random.Generator, kind: str, P: float, a: float, f: float) -> dict[str, Any]:
    """P, M or e, Q and sigma at two load points. Q does not follow P."""
    forces = P * (np.array([random.uniform(0.5, 0.95), 1.0]) if "P" in kind else np.ones(2))
    load: dict[str, Any] = {"P": forces.tolist(), "cycles": 6}
    if kind == "M varies":
        load["M"] = (random.uniform(-0.1, 0.1, 2) * P * a).tolist()
    elif kind == "e and P vary":
        load["e"] = (random.uniform(-0.1, 0.1, 2) * a).tolist()
    Q = f * forces * np.array([-1.0, 1.0]) * random.uniform(0.2, 0.85, 2)
    sigma = f * P / a * random.uniform(0.0, 0.2) * np.array([-1.0, 1.0])
    return load | {"Q": Q.tolist(), "sigma": (sigma * random.choice([-1.0, 1.0])).tolist()}


def known(scene: Scene) -> bool:
    """Whether the steady state is known in closed form, as slip does not turn round."""
    try:
        return not partialslip.run(scene, ["exact"]).results["exact"].path_dependent
    except InputError:
        return False


def unlike(random: np.random.Generator, kind: str, P: float, a: float, f: float) -> dict[str, Any]:
    """No Q, or Q of both signs."""
    del a
    return {"Q": (f * P * random.uniform(0.1, 0.7, 2) * [-1, 1]).tolist()} if kind == "cycle" else {}


def unlike_loads(random: np.random.Generator, kind: str, P: float, a: float, f: float) -> dict[str, Any]:
    """Q of both signs with P that varies, with tension, or a quarter of a cycle before it."""
    forces = P * np.array([random.uniform(0.5, 0.95) if kind == "P varies" else 1.0, 1.0])
    ways = np.array([-1.0, 1.0])
    shear, tension = f * random.uniform(0.1, 0.7), f * P / a * random.uniform(0.0, 0.15)
    if kind == "P varies":
        return {"P": forces.tolist(), "Q": (shear * forces * ways).tolist(), "cycles": 2}
    if kind == "tension":
        return {"Q": (shear * P * ways).tolist(), "sigma": (tension * ways).tolist()}
    angles = np.arange(4) * np.pi / 2
    return {"Q": (shear * P * np.sin(angles)).tolist(), "sigma": (tension * np.cos(angles)).tolist(), "cycles": 2}


def finite(random: np.random.Generator, kind: str, P: float, a: float, f: float) -> dict[str, Any]:
    """Q of both signs and tension that is not large."""
    del kind
    ways = np.array([-1.0, 1.0])
    sigma = f * P / a * random.uniform(0.0, 0.3) * random.choice(ways)
    return {"Q": (f * P * random.uniform(0.2, 0.8) * ways).tolist(), "sigma": (sigma * ways).tolist()}


LOADS = {"varying": varying, "unlike": unlike, "unlike-loads": unlike_loads, "finite": finite}
UNLIKE = ("unlike", "unlike-loads")


def bodies(random: np.random.Generator, kind: str, a: float) -> dict[str, Any]:
    """A pad or a block, held by its back or by its sides, on a specimen that may be pulled."""
    lower: dict[str, Any] = {"width": 40 * a, "height": float(random.uniform(4, 12)) * a, "support": "roller"}
    upper = {"kind": kind, "width": 2 * float(random.uniform(3, 8)) * a, "height": float(random.uniform(4, 10)) * a}
    upper["support"] = str(random.choice(["clamped", "sides"]))
    return {"upper": upper, "lower": lower | {"pulled": bool(random.random() < 0.5)}}


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
            if not _turns(Qf, sf, shape):
                continue
            if kind == "turning":
                return Qf * ways, sf / 2 * ways
            with suppress(LostError):
                Q = random.uniform(-0.9, 0.9) * gradual_mean_load_bound(steady(Loads(sf, math.pi * Qf), shape))
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


def true_errors(scene: Scene, kind: str, group: str, found: Result) -> dict[str, float]:
    """Errors by key, without those that nothing is known of."""
    if group in (*UNLIKE, "finite", "phase"):
        return against(scene, found, finest(scene, group))
    exact = partialslip.run(scene, ["exact"]).results["exact"]
    compared = compare(found, exact, scene, None)
    errors = {"a": compared.a, "p": compared.p}
    # cycles run until nothing changes, or as many as asked for
    if scene.load.cycles is None or (found.last_cycle_change or 0.0) <= SETTLED * scene.fem.accuracy:
        errors |= {key: getattr(compared, key) for key in ("m", "n", "q") if key not in exact.undetermined}
    errors |= off_ends(found, exact)
    truth = exact if not {"q1", "q2"} & {*exact.undetermined} else None
    if kind == "marched" and found.method != "march":
        truth = finest(scene, group)
    if truth and truth.traction.values.levels and found.traction.values.levels:
        levels = norm_errors(found.traction, truth.traction, scene.friction.f, ("q1", "q2"))
        errors |= {
            key: off
            for key, off in levels.items()
            if truth.estimate.get(key, 0.0) <= KNOWN * found.estimate.get(key, 0.0)
        }
    errors = {key: error for key, error in errors.items() if error is not None}
    if group in RANDOM and not {"m", "q", "q1"} <= errors.keys():
        errors = against(scene, found, finest(scene, group)) | errors
    return errors


@cache
def finest(scene: Scene, group: str) -> Result:
    """The march at the finest accuracy that it reaches; of finite bodies, finer elements of another order."""
    if group == "finite":
        fem = replace(scene.fem, accuracy=scene.fem.accuracy / FINER, order=3)
        truth = partialslip.run(replace(scene, fem=fem), ["fem"]).results["fem"]
        # within a cell elements resolve more than its mean: means are taken over the cells of the result
        return dataclasses.replace(truth, traction=dataclasses.replace(truth.traction, cells=None))
    asked = scene.fem.accuracy / FINER_MARCH if group in RANDOM else TRUTH_OF_UNLIKE if group in UNLIKE else TRUTH
    finer = replace(scene, fem=replace(scene.fem, accuracy=asked))
    return partialslip.run(finer, ["march"]).results["march"]


def against(scene: Scene, found: Result, truth: Result) -> dict[str, float]:
    """Errors by key where ``truth`` is known well enough."""
    compared = compare(found, truth, scene, None)
    errors = {key: getattr(compared, key) for key in ("a", "m", "n", "p", "q")} | off_ends(found, truth)
    if found.traction.values.levels and truth.traction.values.levels:
        errors |= norm_errors(found.traction, truth.traction, scene.friction.f, ("q1", "q2"))
    return {
        key: error for key, error in errors.items()
        if error is not None and truth.estimate.get(key, 0.0) <= KNOWN * found.estimate.get(key, 0.0)
    }  # fmt: skip


def off_ends(found: Result, truth: Result) -> dict[str, float]:
    """Errors of the ends of the contact, the larger of both load points."""
    off = np.abs(np.subtract(found.ends, truth.ends)).max(axis=0) / truth.a
    return {"left": float(off[0]), "right": float(off[1])}


def rows(
    methods: Sequence[str],
    seed: int,
    numbers: Iterable[int],
    accuracies: tuple[float, float],
    group: str,
    limits: tuple[float, float],
) -> Iterator[dict[str, Any]]:
    """One row a scene and method; ``limits`` of a method and of the truth in CPU seconds."""
    for number in numbers:
        kind, scene = drawn(seed, number, *accuracies, group)
        for method in methods:
            row = {
                "method": method, "seed": seed, "number": number, "group": group, "kind": kind,
                "profile": type(scene.profile).__name__, "nu": scene.material.nu, "accuracy": scene.fem.accuracy,
            }  # fmt: skip
            try:
                with limited(limits[0]):
                    result = partialslip.run(scene, [method]).results[method]
            except InputError:  # P that falls to nothing, or a table that ends
                continue
            except OverTime:
                yield row | {"over": True, "true": {}, "estimate": {}, "cpu_s": limits[0]}
                continue
            true: dict[str, float] = {}
            with suppress(OverTime), limited(limits[1]):
                true = true_errors(scene, kind, group, result)
            yield row | {
                "regime": result.regime, "true": true,
                "estimate": {k: float(v) for k, v in result.estimate.items()},
                "shares": {source: dict(share) for source, share in result.shares.items()},
                "certificate": dict(result.certificate), "counts": dict(result.counts), "cpu_s": result.cost.cpu_s,
            }  # fmt: skip


def show(found: list[dict[str, Any]]) -> None:
    """Print a table for each group and method."""
    for group, method in sorted({(row.get("group", "steady"), row["method"]) for row in found}):
        some = [row for row in found if (row.get("group", "steady"), row["method"]) == (group, method)]
        over, unknown = sum("over" in row for row in some), sum(not row["true"] for row in some)
        print(f"{group}, {method}: {len(some)} scenes, {sum(row['cpu_s'] for row in some):.0f} CPU s")
        print(f"  over the limit: {over}; else without a truth: {unknown - over}")
        table(some)


def table(found: list[dict[str, Any]]) -> None:
    """By accuracy and quantity: how often the estimate is below the true error, the worst ratio, the median."""
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
    parser.add_argument("--method", choices=["fem", "march"], default=["fem"], nargs="+")
    parser.add_argument("--group", choices=(*GROUPS, *RANDOM), default="steady")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--finest", type=float, default=1e-7)
    parser.add_argument("--coarsest", type=float, default=1e-3)
    parser.add_argument("--limit", type=float, default=60.0, metavar="CPU_SECONDS")
    parser.add_argument("--truth", type=float, default=180.0, metavar="CPU_SECONDS")
    given = parser.parse_args()
    if given.what == "run":
        path = given.files[0]
        done = {(row["method"], row["seed"], row["number"], row.get("group", "steady")) for row in read(path)}
        todo = [n for n in range(given.count) if any((m, given.seed, n, given.group) not in done for m in given.method)]
        with path.open("a", encoding="utf-8") as file:
            accuracies, limits = (given.finest, given.coarsest), (given.limit, given.truth)
            for row in rows(given.method, given.seed, todo, accuracies, given.group, limits):
                print(json.dumps(row), file=file, flush=True)
    show([row for path in given.files for row in read(path)])


if __name__ == "__main__":
    main()
