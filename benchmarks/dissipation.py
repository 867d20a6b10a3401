"""Energy that a cycle dissipates: errors against estimates, on random scenes in which the pressure varies.

python benchmarks/dissipation.py [--seed 1] [--varying 30] [--coupled 10] [--accuracy 1e-2]

Under varying P the truth is the exact solution; where that is path-dependent or there is none, march in 64 plain load
steps from load point to load point, of which nothing is known but their own work. That of coupled bodies (march of
unlike half-planes, finite elements of a pad) is in 32 plain steps. Prints one line a scene and method: the error
of the steps alone, the error and the estimate of the result, their ratio, and CPU seconds; then the largest ratio.
"""

import argparse
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

import partialslip
from partialslip import Scene
from partialslip.friction import steps
from partialslip.friction.history import History
from partialslip.march import driver, unlike
from partialslip.scene.reading import parse_scene
from partialslip.tools.errors import InputError
from partialslip_fem import result, solving

MANY, OF_COUPLED = 64, 32


def varying(seed: int, number: int, accuracy: float) -> Scene:
    """Two half-planes under a P that varies; sigma varies or is constant, in phase or not."""
    random = np.random.default_rng([seed, number])
    f, P = float(random.uniform(0.2, 0.8)), 5e5
    forces = P * np.array([random.uniform(0.4, 0.95), 1.0])
    load: dict[str, Any] = {"P": forces.tolist()}
    load["Q"] = (f * forces * np.array([-1, 1]) * random.uniform(0.1, 0.85, 2)).tolist()
    sigma = float(random.uniform(0, 5e8)) * np.array([-1, 1]) * random.choice([-1, 1])
    if number % 5 == 4:  # constant tension: a step is known to suffice for the shear
        sigma = np.array([1e8, 1e8])
    load["sigma"] = sigma.tolist()
    if number % 6 == 5:  # out of phase
        load = {key: [each[0], each[1], each[1], each[0]] for key, each in load.items()}
        load["sigma"] = [sigma[0], sigma[0], sigma[1], sigma[1]]
    return parse_scene({
        "name": f"work-varying-{seed}-{number}",
        "material": {"E": 72.1e9, "nu": 0.33},
        "profile": [{"kind": "hertz", "R": 0.05}, {"kind": "flat-rounded", "R": 0.05, "b": 3e-4}][number % 3 == 2],
        "friction": {"f": f},
        "load": load,
        "fem": {"accuracy": accuracy},
    })  # fmt: skip


def coupled(seed: int, number: int, accuracy: float) -> Scene:
    """Unlike half-planes, or a pad on a specimen, under constant P, every third time under a P that varies."""
    random = np.random.default_rng([seed, 1000 + number])
    f, P = float(random.uniform(0.2, 0.8)), 1.2e5
    forces = P * np.array([random.uniform(0.5, 0.9), 1.0]) if number % 3 == 2 else np.array([P, P])
    ways = np.array([-1, 1])
    load = {"P": forces.tolist(), "Q": (f * forces * ways * random.uniform(0.1, 0.8, 2)).tolist()}
    load["sigma"] = (float(random.uniform(0, 1e8)) * ways * random.choice(ways)).tolist()
    data: dict[str, Any] = {
        "name": f"work-coupled-{seed}-{number}",
        "material": {"E": 72.1e9, "nu": 0.33},
        "profile": {"kind": "hertz", "R": 0.01},
        "friction": {"f": f},
        "load": load,
        "fem": {"accuracy": accuracy},
    }
    if number % 2:
        stiff = {"E": 72.1e9 * float(random.uniform(1.5, 5)), "nu": 0.2}
        data["material"] = {"upper": stiff, "lower": {"E": 72.1e9, "nu": 0.33}}
    else:
        width, height = (float(each) for each in random.uniform((6e-3, 3e-3), (15e-3, 12e-3)))
        data["bodies"] = {
            "upper": {"kind": "pad", "width": width, "height": height},
            "lower": {"width": 40e-3, "height": float(random.uniform(3e-3, 6e-3)), "support": "roller", "pulled": True},
        }
    return parse_scene(data)


@contextmanager
def plain() -> Iterator[None]:
    """Load steps of which nothing is known but their own work."""
    changed = [(steps, "told_missed"), (unlike, "told_by_finer"), (solving, "told_by_finer")]
    kept = [getattr(*each) for each in changed]
    for module, name in changed:
        setattr(module, name, lambda history, *_: history)
    try:
        yield
    finally:
        for (module, name), before in zip(changed, kept, strict=True):
            setattr(module, name, before)


def many_steps(scene: Scene, method: str, count: int, accuracy: float) -> float:
    """Work in that many plain steps, J/m."""
    with plain():
        finer = scene.replace({"load.steps": count, "fem.accuracy": accuracy})
        slip = partialslip.run(finer, [method])[method].slip
    assert slip
    return slip.dissipated


def truth(scene: Scene) -> tuple[str, float]:
    """How the work is known, and the work of a scene of two half-planes, J/m."""
    try:
        exact = partialslip.run(scene, ["exact"])["exact"]
    except InputError:
        exact = None
    if exact and exact.slip and exact.slip.dissipated_error is not None:
        return "exact", exact.slip.dissipated
    return f"{MANY} steps", many_steps(scene, "march", MANY, scene.fem.accuracy / 3)


def main() -> None:
    """Solve and print."""
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, default in (("seed", 1), ("varying", 30), ("coupled", 10)):
        asked.add_argument(f"--{name}", type=int, default=default)
    asked.add_argument("--accuracy", type=float, default=1e-2)
    given = asked.parse_args()
    in_steps: list[float] = []

    def noted(history: History) -> float:
        in_steps.append(history.dissipated)
        return told(history)

    told, driver.work, result.work = driver.work, noted, noted  # type: ignore[attr-defined]
    scenes = [(varying(given.seed, number, given.accuracy), ["march", "fem"]) for number in range(given.varying)]
    scenes += [
        (coupled(given.seed, number, given.accuracy), ["march" if number % 2 else "fem"])
        for number in range(given.coupled)
    ]
    print(f"{'scene':24} {'method':6} {'truth':9} {'steps':>6} {'before':>8} {'error':>8} {'estimate':>8} ratio  CPU s")
    worst, unknown = 0.0, 0
    for scene, methods in scenes:
        known, true = (
            truth(scene)
            if len(methods) > 1
            else (f"{OF_COUPLED} steps", many_steps(scene, methods[0], OF_COUPLED, scene.fem.accuracy))
        )
        for method in methods:
            began = time.process_time()
            found = partialslip.run(scene, [method])[method]
            spent, unit = time.process_time() - began, scene.material.A * scene.P**2
            raw = in_steps[-1] * unit
            if not found.slip or not true:
                continue
            off, error = abs(found.slip.dissipated - true), found.slip.dissipated_error
            told_error = "none" if error is None else f"{error / true:8.1e}"
            ratio = 0.0 if error is None else off / error
            worst, unknown = max(worst, ratio), unknown + (error is None)
            print(
                f"{scene.name:24} {method:6} {known:9} {found.counts['steps']:6} {abs(raw / true - 1):8.1e} "
                f"{off / true:8.1e} {told_error:>8} {ratio:5.2f} {spent:6.2f}",
                flush=True,
            )
    print(f"largest error over estimate: {worst:.2f}; without an estimate: {unknown}")


if __name__ == "__main__":
    main()
