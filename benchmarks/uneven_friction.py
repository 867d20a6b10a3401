"""Random coefficients of friction f(x) with dips, bumps, jumps and steps: exact, march and fem agree or refuse.

python benchmarks/uneven_friction.py --seeds 1 200 [--fine 10] [--fault]

Each seed draws f(x) of up to four features, from 1e-4 a to 0.3 a wide, a profile, and loads: shear alone, with small or
with large tension, with or without a mean. Accuracy is 1e-2, at every ``--fine``-th seed 1e-3. Three questions:

- exact, where it does not refuse: how far is |dq| beyond 2 f p and, at the load points, |q| beyond f p, at places that
  the solver does not choose (f p0)?
- march and fem: how far is |dq| beyond 2 f p, as means over cells (relative L2) and over features of f (f p0)?
- m, n and q against exact or, where it refuses, march: the error over the estimate, and the verdict of run.

``--fault``: exact looks at fixed places alone, as it did once.
"""

import argparse
import time
from collections import Counter
from unittest.mock import patch

import numpy as np

import partialslip
from partialslip import Allowance
from partialslip.halfplane import contact
from partialslip.tools.errors import InputError

NARROW, WIDE = -4.0, -0.5  # powers of 10 of the widths of features, in a
OFF = 1e-6  # |q| beyond the bound that is none, f p0
BUDGET = 6.0  # CPU seconds of a run
BEYOND = 2.0  # error over its estimate that is a failure
BASES = "hertz-shear", "hertz-shear", "flat-rounded"


def friction(rng, a):
    """x (m) and f of a table: dips, bumps, jumps up or down, and pairs of jumps."""
    x, f = [-1.2], [1.0]
    for place in np.sort(rng.uniform(-0.95, 0.95, rng.integers(1, 5))):
        width, factor = 10 ** rng.uniform(NARROW, WIDE), rng.choice([0.02, 0.1, 0.5, 0.8, 1.25, 2.0, 4.0])
        kind, level = rng.choice(["dip", "jump", "step"]), f[-1]
        factor = max(factor, 0.5) if kind == "jump" else factor
        width *= 10 if kind == "step" and width < 0.03 else 1
        points = {
            "dip": ([0, 0.5, 1], [1, factor, 1]),
            "jump": ([0, 1], [1, factor]),
            "step": ([0, 0.1, 0.9, 1], [1, factor, factor, 1]),
        }[kind]
        more = place + width * np.array(points[0])
        if more[0] <= x[-1] or more[-1] >= 1.1:
            continue
        x += more.tolist()
        f += (level * np.array(points[1])).tolist()
    return np.array([*x, 1.2]) * a, 0.5 * np.array([*f, f[-1]])


def drawn(seed, accuracy):
    """A random scene."""
    rng = np.random.default_rng(seed)
    base = partialslip.load_scene(BASES[rng.integers(len(BASES))])
    a = contact(base).a
    x, f = friction(rng, a)
    scene = base.replace(friction={"f": f, "x": x}, fem={"accuracy": accuracy})
    pressed = contact(scene)
    Q = rng.uniform(0.05, 0.85) * pressed.f * scene.P
    ratio = rng.choice([0.0, 0.0, 0.3, 0.9, 2.0])  # dsigma a over 4 dQ/pi
    sigma = rng.choice([-1, 1]) * ratio * rng.uniform(0.7, 1.1) * 4 * Q / (np.pi * pressed.a)
    mean = rng.choice([0.0, 0.0, 0.0, 0.03]) * (pressed.f * scene.P - Q)
    return scene.replace(load={"Q": [mean - Q, mean + Q], "sigma": [-sigma, sigma]})


def places(scene, pressed):
    """Places between each two kinks of f, closer towards the kinks and the ends of the contact."""
    left, right = pressed.ends
    kinks = np.array(scene.friction.kinks)
    ends = np.union1d([left, right], kinks[(kinks > left) & (kinks < right)])
    share = (1 - np.cos(np.pi * (np.arange(200) + 0.37) / 200)) / 2
    return np.sort((ends[:-1, None] + np.diff(ends)[:, None] * share).ravel())


def beyond(scene, pressed, result):
    """Largest |dq| beyond 2 f p and |q| beyond f p (f p0) at places."""
    x, unit = places(scene, pressed), pressed.f * pressed.p0
    found, f = result.traction.at(x), scene.friction.at(x)
    off = [np.abs(found.dq) / 2, *(np.abs(q) for q in (found.q1, found.q2) if q is not None)]
    return max(float((each - f * found.p).max()) for each in off) / unit


def beyond_on_average(scene, pressed, result):
    """Means of |dq|/2 - f p where this is positive: over cells, as their relative L2 norm, and over features of f, the
    largest (f p0)."""
    kinks = np.clip(scene.friction.kinks, *pressed.ends)
    excess, sizes = [], []
    for ends in (result.traction.cells, np.unique(kinks)):
        share = (np.arange(24) + 0.5) / 24
        x = ends[:-1, None] + np.diff(ends)[:, None] * share
        dq = np.abs(result.traction.at(x.ravel()).dq).reshape(x.shape).mean(axis=1) / 2
        fine = ends[:-1, None] + np.diff(ends)[:, None] * (np.arange(4000) + 0.5) / 4000
        excess.append(np.maximum(dq - (scene.friction.at(fine) * pressed.pressure(fine)).mean(axis=1), 0.0))
        sizes.append(np.diff(ends) @ dq**2)
    in_norm = np.sqrt(np.diff(result.traction.cells) @ excess[0] ** 2 / sizes[0])
    return float(in_norm), float(excess[1].max()) / (pressed.f * pressed.p0)


def difference(one, other):
    """Relative L2 difference of dq of ``one`` and the ``other`` result, as means over the cells of ``one``."""
    cells = one.traction.cells
    share = (1 - np.cos(np.pi * (np.arange(16) + 0.5) / 16)) / 2
    weights = np.sin(np.pi * (np.arange(16) + 0.5) / 16)
    x = cells[:-1, None] + np.diff(cells)[:, None] * share
    dq, reference = (each.traction.at(x.ravel()).dq.reshape(x.shape) @ weights / weights.sum() for each in (one, other))
    w = np.diff(cells)
    return float(np.sqrt(w @ (dq - reference) ** 2 / (w @ reference**2)))


def solved(scene, method):
    """Result of a method, None if it refuses."""
    try:
        found = partialslip.run(scene, [method], allowance=Allowance(BUDGET)).results[method]
    except InputError as error:
        return str(error)
    return found


def told(seed, accuracy, counts):
    """Solve one scene, count and print."""
    scene = drawn(seed, accuracy)
    start = time.process_time()
    pressed = contact(scene)
    try:
        outcome = partialslip.run(scene, allowance=Allowance(BUDGET))
    except InputError as error:
        counts["refused by all"] += 1
        return f"{seed}: refused: {error}"
    results = dict(outcome.results)
    for method in ("exact", "march"):
        if method not in results and not isinstance(found := solved(scene, method), str):
            results[method] = found
    reference = next(iter(outcome.results))
    counts[f"reference {reference}"] += 1
    missed = [what for each in outcome.comparisons.values() for what in each.missed]
    counts["missed" if missed else "passed" if outcome.passed else "not judged"] += 1
    lines, bad = [], []
    exact = results.get("exact")
    if exact and not exact.path_dependent:
        counts["exact holds"] += 1
        off = beyond(scene, pressed, exact)
        lines.append(f"exact off {off:.1e}")
        if off > OFF:
            bad.append("exact")
    truth = results[reference]
    counts["more than one zone sticks"] += "m" in truth.undetermined
    for method in ("march", "fem"):
        if method not in results:
            continue
        found = results[method]
        off = beyond_on_average(scene, pressed, found)
        ratios = {}
        if method != reference and found.regime != "ratchets":
            for key in "mn":
                if getattr(found, key) is not None and getattr(truth, key) is not None:
                    error = abs(getattr(found, key) - getattr(truth, key)) / truth.a
                    error -= truth.estimate.get(key, 0.0)
                    ratios[key] = error / found.estimate[key] if key in found.estimate else np.nan
            ratios["q"] = (difference(found, truth) - truth.estimate.get("q", 0.0)) / found.estimate.get("q", np.nan)
        lines.append(f"{method} off {off[0]:.1e} {off[1]:.1e} " + " ".join(f"{k} {v:.2f}" for k, v in ratios.items()))
        if any(value > BEYOND for key, value in ratios.items() if key not in truth.undetermined):
            bad.append(f"{method} beyond its estimate")
        if max(off) > 15 * accuracy:
            bad.append(f"{method} beyond the bound")
    for each in bad:
        counts[each] += 1
        if outcome.passed and "bound" in each:
            counts["passed beyond the bound"] += 1
    seconds = time.process_time() - start
    return f"{seed} {accuracy:g} {reference} {truth.regime}: " + "; ".join(
        [*lines, *bad, *missed[:2], f"{seconds:.1f} s"]
    )


def main():
    """Read the arguments and print a line a scene and the counts."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", nargs=2, type=int, default=(1, 200))
    parser.add_argument("--fine", type=int, default=10)
    parser.add_argument("--fault", action="store_true")
    given = parser.parse_args()
    counts, faults = Counter(), []
    if given.fault:
        faults = [
            patch("partialslip.halfplane.traction._room_at_kinks", lambda *_: np.inf),
            patch("partialslip.halfplane.steady.slips_on", lambda *_: True),
        ]
    for fault in faults:
        fault.start()
    for seed in range(given.seeds[0], given.seeds[1] + 1):
        print(told(seed, 1e-3 if seed % given.fine == 0 else 1e-2, counts), flush=True)
    print(dict(sorted(counts.items())))


if __name__ == "__main__":
    main()
