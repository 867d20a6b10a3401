"""Finite elements against the exact solution: orders, jumps of the gap's curvature, incompressibility, the error
estimate, and error against cost.

python benchmarks/accuracy.py orders | bends | incompressible | estimate | cost | floor
"""

import argparse
import math
import resource
import subprocess
import sys
from collections.abc import Mapping
from typing import Any

import numpy as np

import partialslip
from partialslip.result import Clock, Result
from partialslip.run.judge import Comparison
from partialslip.tools.threads import one_thread
from partialslip_fem.bodies import Grading
from partialslip_fem.estimate import _BENT as BENT
from partialslip_fem.estimate import bend_errors
from partialslip_fem.mesh_solution import Adapted, MeshSolution
from partialslip_fem.problem import scaled
from partialslip_fem.result import to_result
from partialslip_fem.solving import mesh_and_solve

KEYS = ("a", "m", "n", "p", "q")
BEND_SIZES, BEND_GROWTHS = (1e-3, 3e-3, 1e-2, 3e-2), {1: 0.35, 2: 0.35, 3: 0.45, 4: 0.54, 6: 0.57}  # those of runs
HERTZ = ("hertz-small-tension", "hertz-large-tension")


def figures(found: Comparison) -> str:
    return " ".join(f"{getattr(found, key) or 0.0:9.1e}" for key in KEYS)


def solved(
    scene: partialslip.Scene, exact: Result, sizes: Mapping[float, float], growth: float
) -> tuple[MeshSolution, Comparison]:
    """Solution on one mesh with ``sizes`` at points, both in the exact a, and its errors."""
    plan = partialslip.plan(scene)
    a, problem = exact.a / scene.length, scaled(scene, plan)
    graded = Grading((-1.2 * a, 1.2 * a), {float(x * a): size * a for x, size in sizes.items()}, growth)
    solution = mesh_and_solve(problem, 16 * a, graded, Clock())
    adapted = Adapted(solution, {}, 1, 1, solution.iterations, 16.0)
    result = to_result(scene, plan, problem, adapted, Clock())
    return solution, partialslip.compare(result, exact, scene, 0.1)


def on_mesh(name: str, order: int, sizes: Mapping[float, float], growth: float, nu: float = 0.3) -> tuple[int, Any]:
    """Unknowns and errors of one mesh, ``sizes`` at points in the exact a; the scaled loads are the same for all nu."""
    E = partialslip.load_scene(name).material.E * (1 - nu**2) / (1 - 0.3**2)
    scene = partialslip.load_scene(name, [f"fem.order={order}", f"material.nu={nu}", f"material.E={E}"])
    solution, errors = solved(scene, partialslip.run(scene, ["exact"]).results["exact"], sizes, growth)
    return solution.dofs, errors


def ends(name: str) -> np.ndarray[Any, Any]:
    return ends_of(partialslip.run(partialslip.load_scene(name), ["exact"]).results["exact"])


def ends_of(exact: Result) -> np.ndarray[Any, Any]:
    return np.array([-exact.a, -(exact.m or 0.0), exact.n or 0.0, exact.a]) / exact.a


def orders() -> None:
    """Slopes in one over the root of the unknowns, from mesh to mesh."""
    uniform = {1: (0.1, 0.05, 0.025, 0.0125), 2: (0.1, 0.05, 0.025), 3: (0.1, 0.05, 0.025), 4: (0.1, 0.05, 0.025)}
    graded = {1: (0.4, 0.2, 0.1), 2: (0.8, 0.4, 0.2), 3: (0.8, 0.6, 0.4), 4: (0.8, 0.6, 0.5, 0.4)}
    line = np.linspace(-1.1, 1.0, 11) + 0.02
    for kind, steps in (("uniform, h/a", uniform), ("graded, growth", graded)):
        print(f"{kind:15} order  unknowns " + " ".join(f"{key:>9}" for key in KEYS) + "   slopes")
        for order, values in steps.items():
            before = None
            for value in values:
                if steps is uniform:
                    count, found = on_mesh(HERTZ[0], order, dict.fromkeys(line, value), 8 * value)
                else:
                    count, found = on_mesh(HERTZ[0], order, dict.fromkeys(ends(HERTZ[0]) + 3e-7, 1e-6), value)
                errors = np.array([getattr(found, key) for key in KEYS])
                slopes = 2 * np.log(before[1] / errors) / np.log(count / before[0]) if before else []
                print(f"{value:15} {order:5} {count:9} {figures(found)}   " + " ".join(f"{s:5.1f}" for s in slopes))
                before = count, errors


def bends() -> None:
    """Error of p due to elements at the ends of a flat, where the gap's curvature jumps, over the factor of x log|x| in
    p times size^1.5; the error without them, with small elements there, is subtracted."""
    print("b, mm   order  " + " ".join(f"{f'size {size:g} a':>13}" for size in BEND_SIZES))
    for b in (1e-3, 5e-4, 2e-4):
        for order in (1, 2, 3, 4, 6):
            scene = partialslip.load_scene("flat-rounded", [f"fem.order={order}", f"profile.b={b}"])
            exact = partialslip.run(scene, ["exact"]).results["exact"]
            problem, found = scaled(scene, partialslip.plan(scene)), []
            kinks, bends = np.array(problem.kinks), np.array(problem.bends)
            for size in (1e-6, *BEND_SIZES):
                at = dict.fromkeys(ends_of(exact).tolist(), 1e-6)
                at |= dict.fromkeys((kinks * scene.length / exact.a).tolist(), size)
                solution, errors = solved(scene, exact, at, BEND_GROWTHS[order])
                sizes = solution.element_sizes(kinks) / solution.half_width
                one = bend_errors(solution, bends, sizes)["p"] / BENT[order]
                found.append((errors.p or 0.0, one))
            least = found[0][0]
            factors = [math.sqrt(max(error**2 - least**2, 0.0)) / one for error, one in found[1:]]
            print(f"{1e3 * b:<7} P{order}     " + " ".join(f"{factor:13.1e}" for factor in factors), flush=True)


def incompressible() -> None:
    """The same mesh for all nu, graded to the exact ends."""
    for name in HERTZ:
        for order, growth in ((4, 0.5), (1, 0.2)):
            for nu in (0.0, 0.3, 0.45, 0.49, 0.499, 0.4999):
                _, found = on_mesh(name, order, dict.fromkeys(ends(name) + 3e-6, 1e-5), growth, nu)
                print(f"{name:20} P{order} nu {nu:<7} {figures(found)}")


def random_scene(seed: int, accuracy: float) -> partialslip.Scene:
    """Hertz, flat and rounded, or a table; both regimes; nu up to 0.49."""
    random = np.random.default_rng(seed)
    E, R, a, nu = 70e9, 0.02, 1e-3, float(random.choice([0.0, 0.2, 0.3, 0.4, 0.45, 0.49]))
    A = 4 * (1 - nu**2) / E
    P = math.pi * a**2 / (2 * A * R)
    profile: dict[str, Any] = {"kind": str(random.choice(["hertz", "hertz", "flat-rounded", "tabulated"])), "R": R}
    if profile["kind"] == "flat-rounded":
        flat = float(random.uniform(0.1, 0.8))
        psi = math.acos(flat)
        profile["b"], P = flat * a, a**2 / (A * R) * (psi - math.sin(psi) * flat)
    elif profile["kind"] == "tabulated":
        x = np.linspace(0, 1.6, 5) * a
        gap = x**2 / (2 * R) * (1 + random.uniform(0, 1) * (x / a) ** 2)
        profile = {"kind": "tabulated", "x": x, "gap": gap}
    f, Qf = random.uniform(0.1, 0.9), random.uniform(0.1, 0.85)
    sf = random.uniform(0, 2) * 8 * (1 - math.sqrt(1 - Qf)) * random.choice([1, 1, -1])
    Q, sigma = Qf * f * P, sf * f * P / (math.pi * a)
    return partialslip.parse_scene(
        {
            "name": f"random-{seed}", "material": {"E": E, "nu": nu}, "profile": profile, "friction": {"f": f},
            "load": {"P": P, "Q": [-Q, Q], "sigma": [-sigma, sigma]}, "fem": {"accuracy": accuracy},
        }
    )  # fmt: skip


def estimate() -> None:
    """Estimate over true error, of the largest of a, m and n and of each, on the final meshes."""
    for accuracy in (1e-3, 2e-5, 1e-6, 1e-7):
        ratios = []
        for seed in range(300, 320):
            outcome = partialslip.run(random_scene(seed, accuracy))
            known, found = outcome.results["fem"].estimate, outcome.comparisons["fem"]
            true = {key: getattr(found, key) for key in KEYS}
            largest = max(known[key] for key in "amn") / max(true[key] for key in "amn")
            ratios.append([largest, *(known[key] / true[key] for key in KEYS)])
        within = np.sum((np.array(ratios) < 3) & (np.array(ratios) > 1 / 3), axis=0)
        low, high = np.min(ratios, axis=0)[0], np.max(ratios, axis=0)[0]
        print(
            f"{accuracy:g}: largest of a, m, n within a factor of 3 in {within[0]} of {len(ratios)}, ratios {low:.2f} "
            f"to {high:.2f}; " + ", ".join(f"{key} {count}" for key, count in zip(KEYS, within[1:], strict=True))
        )


def one(name: str, order: str, accuracy: str) -> None:
    """In a process of its own: errors and estimate."""
    outcome = partialslip.run(partialslip.load_scene(name, [f"fem.order={order}", f"fem.accuracy={accuracy}"]))
    fem: Result = outcome.results["fem"]
    known = max(fem.estimate[key] for key in "amn")
    print(f"{fem.counts['dofs']:8} {fem.counts['meshes']:2} {figures(outcome.comparisons['fem'])} {known:9.1e}")


def cost(accuracies: tuple[float, ...] = (1e-3, 2e-5, 1e-6, 1e-7, 3e-8)) -> None:
    """Whole processes, adaptive passes included: the least CPU seconds of three. Orders 4 and 6 meet on either side of
    the accuracy below which 6 is the default."""
    print(f"{'':24} {'asked':7} unknowns meshes " + " ".join(f"{key:>9}" for key in KEYS) + "  estimate  CPU s")
    for name in HERTZ:
        for order, asked in (*((4, accuracy) for accuracy in accuracies), (2, 2e-5), (3, 1e-6), (6, 1e-7), (6, 3e-8)):
            seconds = []
            for _ in range(3):
                before = resource.getrusage(resource.RUSAGE_CHILDREN)
                command = [sys.executable, __file__, "one", name, str(order), str(asked)]
                text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
                after = resource.getrusage(resource.RUSAGE_CHILDREN)
                seconds.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
            print(f"{name:20} P{order}  {asked:<7g} {text.rstrip()} {min(seconds):6.1f}", flush=True)


def floor() -> None:
    """What more unknowns and finer ends still bring, on meshes graded to the exact ends."""
    for name in HERTZ:
        for growth, size in ((0.35, 1e-7), (0.25, 1e-7), (0.2, 1e-7)):
            count, found = on_mesh(name, 4, dict.fromkeys(ends(name) + 0.4 * size, size), growth)
            print(f"{name:20} growth {growth:<5} size {size:g} a: {count:8} unknowns {figures(found)}", flush=True)


if __name__ == "__main__":
    tables = {
        "orders": orders,
        "bends": bends,
        "incompressible": incompressible,
        "estimate": estimate,
        "cost": cost,
        "floor": floor,
    }
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", choices=[*tables, "one"])
    parser.add_argument("of", nargs="*", help="of one: scene, order, accuracy")
    given = parser.parse_args()
    one_thread(one)(*given.of) if given.what == "one" else one_thread(tables[given.what])()
