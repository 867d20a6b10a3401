"""Follow loads with a mean from zero on, for up to five cycles, and see what the first cycles lock in.

A cycle that changes nothing any more is not repeated.

The exact steady state knows the change of shear over a cycle. Marching follows the path and knows q1 and q2, too.

python examples/mean_loads.py
"""

import partialslip

scene = partialslip.parse_scene(
    {
        "name": "mean-loads",
        "material": {"E": 72.1e9, "nu": 0.33},
        "profile": {"kind": "hertz", "R": 0.010},
        "friction": {"f": 0.3},
        "load": {"P": 135750.0, "Q": [5e3, 30e3], "sigma": [0.0, 100e6], "cycles": 5},
        "fem": {"accuracy": 1e-4},
    }
)
outcome = partialslip.run(scene, ["exact", "march"])
march = outcome["march"]

print(f"stick zone [{-march.m / march.a:.4f}, {march.n / march.a:.4f}] a, {march.counts['cycles']} cycles followed")
print(f"q changed by {march.last_cycle_change:.1e} f p0 in the last cycle")
limit = scene.friction.f * march.p0
for x in (-0.9, -0.5, 0.0, 0.5, 0.9):
    q1, q2 = march.traction.at(march.a * x).levels
    print(f"x = {x:+.1f} a: q1 = {q1 / limit:+.4f} f p0, q2 = {q2 / limit:+.4f} f p0")
print(f"against the exact solution: {outcome.outcome}, m off by {outcome.comparisons['march'].m:.1e} a")
