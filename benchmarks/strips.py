"""Random equal strips: errors of fem against exact, and of march under load paths, beside the methods' estimates.

python benchmarks/strips.py [--seeds 0 30] [--accuracy 1e-4] [--paths [--steps 50]]

Heights are 1.2 to 20 a, widths 6 to 40 heights. Every third scene has a tension; every sixth a coefficient of friction
that varies along x. Profiles take turns: Hertz's, flat and rounded, tables of even gaps and of uneven ones.

With ``--paths`` every scene has a load path that no closed form gives, in turn mean loads, slip that reverses, and
loads out of phase. march follows it event by event; beside it are many small load steps (backward Euler), which know no
events. On the same cells what is left is due to the steps and to rounding. Where the two choose other cells, which is
told, it is due to these, and to be judged by march's estimates.
"""

import argparse
import time
from unittest import mock

import numpy as np

import partialslip
from partialslip.friction import coulomb_constant_pressure
from partialslip.friction.active_set import solve_bounded
from partialslip.friction.history import follow, resting
from partialslip.halfplane import contact
from partialslip.run.judge.reference import error_of
from partialslip.tools.errors import InputError

KEYS = "a", "m", "n", "p", "q"
PROFILES = "hertz", "flat-rounded", "even table", "uneven table"


def profile(rng, kind, R):
    """A profile of the curvature 1/R or so, and its unit of length (m)."""
    length = 0.02 * R
    if kind == "hertz":
        return {"kind": "hertz", "R": R}
    if kind == "flat-rounded":
        return {"kind": "flat-rounded", "R": R, "b": rng.uniform(0.1, 0.9) * length}
    x = np.linspace(-4.0 if kind == "uneven table" else 0.0, 4.0, 17)
    skew = rng.uniform(-0.1, 0.1) if kind == "uneven table" else 0.0
    gap = length**2 / (2 * R) * (x**2 + skew * x**3 + rng.uniform(0.0, 0.05) * x**4)
    fixed = {"tilt": "fixed"} if kind == "uneven table" else {}
    return {"kind": "tabulated", "x": (length * x).tolist(), "gap": gap.tolist(), **fixed}


def drawn(seed, accuracy):
    """A random scene."""
    rng = np.random.default_rng(seed)
    kind, R = PROFILES[seed % 4], 10 ** rng.uniform(-3, 0)
    material = {"E": 10 ** rng.uniform(9, 11.5), "nu": rng.uniform(0.1, 0.45)}
    tables = {"material": material, "profile": profile(rng, kind, R), "friction": {"f": rng.uniform(0.1, 0.9)}}
    P = material["E"] * R * 10 ** rng.uniform(-3.6, -3.0)
    half_planes = partialslip.parse_scene({"name": f"strips-{seed}", "load": {"P": P}} | tables)
    a = contact(half_planes).a
    height = a * 10 ** rng.uniform(0.08, 1.3)
    upper = {"height": height, "width": height * rng.uniform(6, 40), "support": "roller"}
    Q, p0 = 10 ** rng.uniform(-1, -0.02), 2 * P / (np.pi * a)
    lower, f, sigma = dict(upper), tables["friction"]["f"], 0.0
    if seed % 3 == 0:
        lower |= {"pulled": True, "right_grip": ["stiffness", 0.5, 0.2][seed // 3 % 3]}
        sigma = f * p0 * Q * rng.choice([-1, 1]) * rng.uniform(0.2, 1.5)
    if seed % 6 == 2:
        x = np.sort(rng.uniform(-1.2, 1.2, 4))
        tables["friction"] = {"f": (f * rng.uniform(0.8, 1.0, 4)).tolist(), "x": (a * x).tolist()}
    load = {"P": P, "Q": [-0.8 * Q * f * P, 0.8 * Q * f * P], "sigma": [-sigma, sigma]}
    bodies = {"upper": upper, "lower": lower}
    return half_planes.replace(load=load, friction=tables["friction"], bodies=bodies, fem={"accuracy": accuracy})


def on_a_path(scene, seed):
    """The ``scene`` under a load path of its own: mean loads, reversal, or loads out of phase."""
    rng = np.random.default_rng([seed, 1])
    (_, Q), (_, sigma), f, a = scene.load.Q, scene.load.sigma, scene.friction.f, contact(scene).a
    if not sigma:
        sigma = f * 2 * scene.P / (np.pi * a) * rng.uniform(0.1, 0.5)
    mean = rng.uniform(-0.2, 0.2, 2)
    load = (
        {"Q": [Q * (mean[0] - 0.8), Q * (mean[0] + 0.8)], "sigma": [sigma * (mean[1] - 1), sigma * (mean[1] + 1)]},
        {"Q": [-0.5 * Q, 0.5 * Q], "sigma": [-5 * abs(sigma), 5 * abs(sigma)]},
        {"Q": [-0.8 * Q, 0.7 * Q, 0.1 * Q], "sigma": [-0.6 * sigma, 0.2 * sigma, 0.8 * sigma]},
    )[seed % 3]
    lower = {"height": scene.bodies.lower.height, "width": "infinite", "support": "roller"}
    return scene.replace(load={"P": scene.P} | load, bodies={"upper": lower, "lower": lower})


def small_steps(scene, steps):
    """The result of march in ``steps`` load steps a leg (backward Euler), without events."""

    def stepped(C, stretch, normal, f, path, *_):
        bound = f * normal

        def advance(before, load, change):
            free = C @ before.x + change[1:3] @ stretch
            return solve_bounded(C, free, -bound, bound, float(load[0])), normal

        return follow(path.with_steps(steps), advance, resting(0 * normal), f)

    with mock.patch.object(coulomb_constant_pressure, "march", stepped):
        return partialslip.run(scene, "march")["march"]


def on_paths(seeds, accuracy, steps):
    """Print march's errors of m, n (a), q1 and q2 (relative L2) under load paths, with its estimates."""
    for seed in seeds:
        scene = on_a_path(drawn(seed, accuracy), seed)
        start = time.process_time()
        found = partialslip.run(scene, "march")["march"]
        seconds, shown = time.process_time() - start, []
        others = [small_steps(scene, each) for each in (steps, 2 * steps)]
        off = [partialslip.compare(found, each, scene, None).errors for each in others]
        cells, *more = (each.traction.cells / found.a for each in (found, *others))
        same = all(len(each) == len(cells) and np.abs(each - cells).max() < 1e-9 for each in more)
        for key in ("m", "n", "q1", "q2"):
            once, twice = (each.get(key) or 0.0 for each in off)
            shown.append(f"{key} {twice:.1e}, half as many steps {once:.1e} ({found.estimate.get(key, np.nan):.1e})")
        on = "the same cells" if same else "other cells"
        print(f"{seed}: {PROFILES[seed % 4]}, {found.regime}, {on}: {'; '.join(shown)}; {seconds:.1f} s", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--seeds", nargs=2, type=int, default=(0, 30))
    parser.add_argument("--accuracy", type=float, default=1e-4)
    parser.add_argument("--paths", action="store_true", help="march under load paths against small steps")
    parser.add_argument("--steps", type=int, default=50, help="the fewer of both numbers of load steps a leg")
    given = parser.parse_args()
    if given.paths:
        on_paths(range(*given.seeds), given.accuracy, given.steps)
        return
    for seed in range(*given.seeds):
        scene, start = drawn(seed, given.accuracy), time.process_time()
        try:
            exact = partialslip.run(scene, "exact")["exact"]
            middle = time.process_time()
            fem = partialslip.run(scene, "fem")["fem"]
        except InputError as error:
            print(f"{seed}: refused: {error}", flush=True)
            continue
        found = partialslip.compare(fem, exact, scene, None)
        body = scene.bodies.upper
        told = {key: f"({error_of(fem, key, 'fem'):.1e} + {error_of(exact, key, 'exact'):.1e})" for key in KEYS}
        errors = (f"{key} {found.errors[key] or 0:.1e} {told[key]}" for key in KEYS)
        size = f"h/a {body.height / exact.a:.2f} W/h {body.width / body.height:.1f}"
        seconds = f"{middle - start:.1f} + {time.process_time() - middle:.1f} s"
        print(f"{seed}: {PROFILES[seed % 4]}, {exact.regime}, {size}: {', '.join(errors)}; {seconds}", flush=True)


if __name__ == "__main__":
    main()
