"""Solve a shipped scene exactly and by finite elements, and print how much the two differ.

python examples/first_run.py
"""

import partialslip

scene = partialslip.load_scene("fretting-aluminium", ["fem.accuracy=1e-4"])
outcome = partialslip.run(scene)
exact, fem = outcome["exact"], outcome["fem"]

print(f"{scene.title}: {exact.regime}")
print(f"stick zone: exact [{-exact.m / exact.a:.6f}, {exact.n / exact.a:.6f}] a")
print(f"            fem   [{-fem.m / exact.a:.6f}, {fem.n / exact.a:.6f}] a")
for verdict in outcome.comparisons["fem"].verdicts:
    if verdict.error is not None and verdict.bar is not None:
        print(f"{verdict.quantity:>5}: error {verdict.error:.1e}, bar {verdict.bar:.1e}: {verdict.outcome}")
print(f"{outcome.outcome}; the finite elements took {fem.cost.cpu_s:.1f} CPU s")
