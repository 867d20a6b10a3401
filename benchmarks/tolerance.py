"""Check the propagation of tolerances.

    python benchmarks/tolerance.py draws     fretting-aluminium against 100,000 draws of closed formulas of its own
    python benchmarks/tolerance.py scenes    30 scenes: linear intervals, those of the tool, and 20,000 draws

Formulas of ``draws``, Hertz contact under small tension (Cattaneo, Mindlin; shift by bulk tension: Hills, Nowell):

    a^2 = 2 A R P/pi,  A = 4 (1 - nu^2)/E,  p0 = 2 P/(pi a)
    c = a sqrt(1 - Q/(f P)),  e = a sigma/(4 f p0),  m = c + e,  n = c - e

for loads +-Q and +-sigma. Draws of ``scenes`` take m and n from one load step (partialslip.halfplane.stick_zone), which
holds where slip does not reverse; otherwise only the regimes are compared.
"""

import sys
import time

import numpy as np

import partialslip
from partialslip.halfplane import contact, stick_zone
from partialslip.scene.gradual import may_turn_round
from partialslip.scene.tolerance import inputs, moved
from partialslip.study.tolerance import propagate

GIVEN = {"friction.f": "5 %", "load.P": "1 %", "profile.R": "0.5 %"}
ENDS = (0.025, 0.975)


def closed(f, P, R, Q=38750.0, sigma=100e6, E=72.1e9, nu=0.33):
    """a (m), m and n (in a) of fretting-aluminium, NaN where it slides, and p0 (Pa): arrays."""
    a = np.sqrt(2 * 4 * (1 - nu**2) / E * R * P / np.pi)
    p0 = 2 * P / (np.pi * a)
    c = np.sqrt(np.where(f * P > Q, 1 - Q / (f * P), np.nan))
    e = sigma / (4 * f * p0)
    return a, c + e, c - e, p0


def drawn(count=100_000, seed=1):
    """Intervals by quantity, probability of sliding, and shares of f by freezing it: plain random numbers."""
    u = np.random.default_rng(seed).uniform(-1, 1, (count, 3))
    values = closed(0.3 * (1 + 0.05 * u[:, 0]), 135750.0 * (1 + 0.01 * u[:, 1]), 0.01 * (1 + 0.005 * u[:, 2]))
    intervals = {key: np.nanquantile(each, ENDS) for key, each in zip(("a", "m", "n", "p0"), values, strict=True)}
    return intervals, float(np.isnan(values[1]).mean())


def compare_draws():
    scene = partialslip.load_scene("fretting-aluminium").replace(
        {f"tolerance.{key}": each for key, each in GIVEN.items()}
    )
    partialslip.run(scene, "exact", stresses=True)
    begun = time.process_time()
    found, _ = propagate(scene)
    spent = time.process_time() - begun
    intervals, slides = drawn()
    print(f"{found.solves} solves, {spent:.2f} CPU s, known to {found.misfit:.1%} of the interval")
    for key, (low, high) in intervals.items():
        own = found.quantities[key]
        off = max(abs(own.low - low), abs(own.high - high)) / (high - low)
        print(
            f"{key:3} {own.low:12.6g} {own.high:12.6g}  draws {low:12.6g} {high:12.6g}  off by {off:.2%} of the width"
        )
    print(f"sliding: {found.regimes['sliding']:.2%}, draws {slides:.2%}")


def scenes():
    """Group and scene, 30 in all: Hertz; Qf = dQ/(2 f P), sf = dsigma/(f p0)."""
    numbers = np.random.default_rng(5)
    base = partialslip.load_scene("fretting-aluminium")
    f, P, p0 = base.friction.f, base.P, contact(base).p0
    groups = {
        "plain": (12, lambda: (Qf := numbers.uniform(0.2, 0.7), numbers.uniform(0, 2.5) * Qf)),
        "near sliding": (8, lambda: (Qf := numbers.uniform(0.9, 0.98), numbers.uniform(0, 1.0) * (1 - Qf))),
        "large tension": (6, lambda: (Qf := numbers.uniform(0.1, 0.35), Qf * numbers.uniform(7, 10))),
        "transition": (2, lambda: (Qf := numbers.uniform(0.2, 0.5), 4 * Qf * numbers.uniform(0.97, 1.03))),
        "reversal": (2, lambda: (Qf := numbers.uniform(0.5, 0.8), 4 * Qf * numbers.uniform(1.1, 1.3))),
    }
    for group, (count, make) in groups.items():
        for _ in range(count):
            Qf, sf = make()
            half = {"load.Q": [-Qf * f * P, Qf * f * P], "load.sigma": [-sf * f * p0 / 2, sf * f * p0 / 2]}
            width = {"tolerance.friction.f": f"{numbers.uniform(1, 6):.2f} %", "tolerance.load.P": "1 %",
                     "tolerance.load.Q": {"std": "0.5 %"}, "tolerance.load.sigma": "2 %"}  # fmt: skip
            yield group, base.replace({**half, **width})


def one_step(scene, count=20_000):
    """m and n (in a), NaN where the contact slides, and whether the tension is small, by 20,000 draws."""
    own, numbers = inputs(scene), np.random.default_rng(2)
    t = np.array([numbers.normal(size=count) / 2 if each.normal else numbers.uniform(-1, 1, count) for each in own])
    at = {each.key: 1 + each.reach / each.size * row for each, row in zip(own, t, strict=True)}
    f, P = scene.friction.f * at["friction.f"], scene.P * at["load.P"]
    pressed = contact(scene)
    Qf = scene.load.dQ * at["load.Q"] / (2 * f * P)
    sf = scene.load.dsigma * at["load.sigma"] / (f * pressed.p0 * np.sqrt(at["load.P"]))
    slides = Qf >= 1
    zone = stick_zone(pressed, 1.0, np.where(slides, 0.5, Qf) * 2 * scene.P, sf * pressed.p0)
    ends = [np.where(slides, np.nan, each / pressed.a) for each in (zone.m, zone.n)]
    return *ends, (zone.s > 0) & ~slides


def linear(known, own, count=20_000):
    """Interval of m from slopes at the star, one-sided where an end slides."""
    numbers, change = np.random.default_rng(3), 0.0
    for each in known.inputs:
        low, high = (own.value if end is None else end for end in own.ends[each.key])
        slope = (high - low) / (2 - own.ends[each.key].count(None))
        change = change + slope * (numbers.normal(size=count) / 2 if each.normal else numbers.uniform(-1, 1, count))
    return np.quantile(own.value + change, ENDS)


def compare_scenes():
    print("group           Qf    sf/Qf   f to  solves  CPU s  linear off  tool off  claimed  regimes off")
    for group, scene in scenes():
        begun = time.process_time()
        found, known = propagate(scene)
        spent = time.process_time() - begun
        m, _, small = one_step(scene)
        low, high = np.nanquantile(m, ENDS)
        own = found.quantities["m"]
        turns = any(may_turn_round(moved(scene, known.inputs, t)) for t in known.t)
        ends = (own.low, own.high) if turns else (low, high)  # of gradual loads there are no formulas
        off = [max(abs(np.subtract(each, ends))) / (high - low) for each in (linear(known, own), (own.low, own.high))]
        Qf = scene.load.dQ / (2 * scene.friction.f * scene.P)
        sf = scene.load.dsigma / (scene.friction.f * contact(scene).p0)
        chance = abs(found.regimes.get("small tension", 0.0) - small.mean())
        tool = "reverses" if turns else f"{off[1]:.1%}"
        row = f"{group:14} {Qf:.3f} {sf / Qf:5.2f} {found.inputs['friction.f']:>7} {found.solves:5} {spent:6.1f}"
        print(f"{row} {off[0]:10.1%} {tool:>10} {found.misfit:8.1%} {chance:10.2%}", flush=True)


if __name__ == "__main__":
    {"draws": compare_draws, "scenes": compare_scenes}[sys.argv[1]]()
