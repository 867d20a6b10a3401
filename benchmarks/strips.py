"""Random equal strips: errors of fem against exact, beside fem's estimates and the bars.

python benchmarks/strips.py [--seeds 0 30] [--accuracy 1e-4]

Heights are 1.2 to 20 a, widths 6 to 40 heights. Every third scene has a tension; every sixth a coefficient of friction
that varies along x. Profiles take turns: Hertz's, flat and rounded, tables of even gaps and of uneven ones.
"""

import argparse
import time

import numpy as np

import partialslip
from partialslip.halfplane import contact
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


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--seeds", nargs=2, type=int, default=(0, 30))
    parser.add_argument("--accuracy", type=float, default=1e-4)
    given = parser.parse_args()
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
        body, told = scene.bodies.upper, fem.estimate
        errors = (f"{key} {found.errors[key] or 0:.1e} ({told.get(key, np.nan):.1e})" for key in KEYS)
        size = f"h/a {body.height / exact.a:.2f} W/h {body.width / body.height:.1f}"
        seconds = f"{middle - start:.1f} + {time.process_time() - middle:.1f} s"
        print(f"{seed}: {PROFILES[seed % 4]}, {exact.regime}, {size}: {', '.join(errors)}; {seconds}", flush=True)


if __name__ == "__main__":
    main()
