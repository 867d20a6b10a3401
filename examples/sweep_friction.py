"""Sweep the coefficient of friction over 50 values, and draw the ends of the stick zone.

python examples/sweep_friction.py [FIGURE.svg]
"""

import sys

import numpy as np

import partialslip

scene = partialslip.load_scene("fretting-aluminium")
table = partialslip.sweep(scene, {"friction.f": np.linspace(0.2, 0.9, 50)}, "exact")
sticks = table.dropna(subset=["m"])
print(f"{len(table) - len(sticks)} of {len(table)} values slide; sticks from f = {sticks['friction.f'].iloc[0]:.3f} on")

axes = (table[["m", "n"]] * 1e3).set_index(table["friction.f"]).plot(style=["k-", "k--"], ylabel="mm")
axes.figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "sweep_friction.svg")
