"""Stick zones under 26 tensions at once, and a figure of their ends.

python examples/stick_zones.py [FIGURE.svg]
"""

import sys

import numpy as np
from matplotlib.figure import Figure

import partialslip
from partialslip import halfplane

scene = partialslip.load_scene("fretting-aluminium")
pressed = halfplane.contact(scene)
f, dQ = scene.friction.f, 40e3  # N/m
dsigma = np.linspace(0, 500e6, 26)  # Pa
zones = halfplane.stick_zone(pressed, f, dQ, dsigma)

large = dsigma[np.argmax(zones.s < 0)]
print(f"a = {pressed.a * 1e3:.4f} mm, p0 = {pressed.p0 / 1e6:.1f} MPa; {len(dsigma):,} stick zones")
print(f"tension turns large at dsigma = {large / 1e6:.1f} MPa")

figure = Figure(figsize=(5, 3.2), layout="constrained")
axes = figure.subplots()
axes.plot(dsigma / (f * pressed.p0), -zones.m / pressed.a, "k-", label="left end, -m/a")
axes.plot(dsigma / (f * pressed.p0), zones.n / pressed.a, "k--", label="right end, n/a")
axes.axvline(large / (f * pressed.p0), color="0.6", lw=0.8, ls=":", label="tension turns large")
axes.set(xlabel="Δσ/(f p0)", ylabel="x/a", ylim=(-1.05, 1.05))
axes.legend(frameon=False)
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "stick_zones.svg")
