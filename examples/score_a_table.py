"""Score a table of tractions as another code would write it: 201 points, with a friction penalty that is too soft.

python examples/score_a_table.py
"""

import csv
import tempfile
from pathlib import Path

import numpy as np

import partialslip

scene = partialslip.load_scene("hertz-large-tension")
exact = partialslip.run(scene, "exact")["exact"]
x = np.linspace(-1.1, 1.1, 201) * exact.a
at = exact.traction.at(x)
dq = at.dq * (1 - 1e-3)  # slip never quite reaches 2 f p

with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "tractions.csv"
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["x", "p", "dq"])
        writer.writerows(np.column_stack([x, at.p, dq]).tolist())
    scored = partialslip.score(scene, path, bar=1e-2)

found, errors = scored["tractions.csv"], scored.comparisons["tractions.csv"]
print(f"friction seen in the slip zones: f = {found.settings['f_seen']} (the scene has {scene.friction.f})")
print(
    f"a, m, n read to {errors.a:.1e}, {errors.m:.1e}, {errors.n:.1e} a; spacing {x[1] / exact.a - x[0] / exact.a:.1e} a"
)
print(f"{scored.outcome}; notes: {'; '.join(found.notes) or 'none'}")
