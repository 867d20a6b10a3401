"""Loops with known f: is it in its interval? ``python benchmarks/identify.py [COUNT] [SEED]``.

The loops are Mindlin's closed form (1949) in a rig's compliance, written here and nowhere else: for s = y/(2 f P),

    G(y) = (A f P/pi) ((1 - s) ln(1 - s) + s) + A^2 R tau^2 y^2/(64 f),    A = 4 (1 - nu^2)/E,

the second term under a tension that changes by tau y (small tension, where slip zones shift by A R dsigma/(8 f)).
"""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np

SCENE: dict[str, Any] = {
    "name": "loop",
    "material": {"E": 72.1e9, "nu": 0.33},
    "profile": {"kind": "hertz", "R": 0.010},
    "friction": {"f": 0.5},  # plays no part
    "load": {"P": 135750.0, "Q": [-1e4, 1e4]},
}
A, R, P = 4 * (1 - 0.33**2) / 72.1e9, 0.010, 135750.0
A_HALF_WIDTH = np.sqrt(2 * A * R * P / np.pi)


class Made(NamedTuple):
    """A loop: its truth and its columns ``time`` (s), ``displacement`` (m) and ``Q`` (N/m)."""

    f: float
    used: float
    noise: float
    tension: float
    compliance: float
    time: np.ndarray
    displacement: np.ndarray
    Q: np.ndarray


def slipped(y: np.ndarray, f: float, tension: float) -> np.ndarray:
    """G(y)."""
    s = y / (2 * f * P)
    log = np.log1p(-np.minimum(s, 1 - 1e-15))
    return A * f * P / np.pi * ((1 - s) * log + s) + A**2 * R * (tension * y) ** 2 / (64 * f)


def loop(random: np.random.Generator, used: float | None = None, noise: float | None = None, **fixed: Any) -> Made:
    """A random loop up to ``used`` = Q/(f P), with ``noise`` in both columns, of their amplitudes; ``fixed``: cycles,
    count (rows a cycle), sharp (triangles of Q), begin (in cycles), drift (of the range in all), missing ("", "middle"
    or "turn"), compliance (in A/pi), tension (tau pi a)."""
    f = random.uniform(0.15, 0.8)
    used = random.uniform(0.3, 0.97) if used is None else used
    noise = 10 ** random.uniform(np.log10(0.005), np.log10(0.05)) if noise is None else noise
    usual = {
        "cycles": random.choice([1.5, 2.0, 3.0, 5.0]),
        "count": random.integers(100, 400),
        "sharp": random.random() < 0.4,
        "begin": random.uniform(0, 1),
        "drift": random.uniform(-0.1, 0.1),
        "missing": random.choice(["", "middle", "turn"]),
        "compliance": random.uniform(0.5, 4),
        "tension": random.choice([0.0, 0.0, 0.0, 2.0]),
    }
    cycles, count, sharp, begin, drift, missing, compliance, tension = (usual | fixed).values()
    C, tau, half = compliance * A / np.pi, tension / (np.pi * A_HALF_WIDTH), used * f * P
    time = np.arange(round(cycles * count)) / count
    phase = (time + begin) % 1.0
    rises = phase < 0.5
    way = np.where(rises, 2 * phase, 2 - 2 * phase)  # from the lower turning point, 0 to 1
    Q = half * (2 * way - 1 if sharp else -np.cos(np.pi * way))
    closed = slipped(np.array(2 * half), f, tau)
    moved = C * Q + np.where(rises, slipped(Q + half, f, tau), closed - slipped(half - Q, f, tau))
    span = np.ptp(moved)
    moved = moved + span * (random.uniform(-2, 2) + drift * time / cycles)
    Q = Q + random.uniform(-1, 1) * half + noise * half * random.standard_normal(len(Q))
    moved += noise * span / 2 * random.standard_normal(len(Q))
    kept = np.ones(len(Q), bool)
    if missing:  # of one cycle: 15 % between turning points, or the 8 % around one
        place, width = (0.25, 0.15) if missing == "middle" else (0.5, 0.08)
        kept = (np.abs(phase - place) > width / 2) | (time > cycles / 2)
    return Made(f, used, noise, tau, C, time[kept], moved[kept], Q[kept])


def write(made: Made, file: Path) -> None:
    """Write the columns to a file."""
    table = np.stack([made.time, made.displacement * 1e6, made.Q * 1e-3], axis=1)
    np.savetxt(file, table, "%.7g", ",", header="time [s],displacement [um],Q [N/mm]", comments="")


def main(count: int = 40, seed: int = 1) -> None:
    """Print a table of ``count`` loops, and how many intervals have the true f in them."""
    import partialslip
    from partialslip.study.identify import from_loop, read_loop
    from partialslip.tools.errors import InputError

    random, inside, told, refused = np.random.default_rng(seed), 0, 0, 0
    print(" Q/(f P)  noise %       f  found    low   high  in  said")
    with TemporaryDirectory() as folder:
        for number in range(count):
            made = loop(random, used=0.03 if number % 8 == 7 else None)  # every eighth: no slip to speak of
            write(made, file := Path(folder) / "loop.csv")
            scene = {**SCENE, "load": {**SCENE["load"], "sigma": [-1e4 * made.tension, 1e4 * made.tension]}}
            try:
                found = from_loop(partialslip.parse_scene(scene), read_loop(file))
            except InputError as error:
                refused += 1
                told_so = str(error).partition(": ")[2]
                print(f"{made.used:8.2f} {100 * made.noise:8.1f}  {made.f:6.3f} refused: {told_so:.70}")
                continue
            low, high = found.f.low, found.f.high
            good = low <= made.f <= high
            inside, told = inside + good, told + (not found.f.one_sided)
            said = "at least" if found.f.one_sided else "hardly" if any("hardly" in s for s in found.remarks) else ""
            print(f"{made.used:8.2f} {100 * made.noise:8.1f}  {made.f:6.3f} {found.f.value:6.3f} {low:6.3f} {high:6.3f}"
                  f"  {'ok' if good else 'NO'}  {said}")  # fmt: skip
    print(f"f in its interval: {inside} of {count - refused}; two-sided: {told}; refused: {refused}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
