"""Hertz with P, Q and sigma that vary in phase, small tension, slip at both ends: the closed form.

In the slip zones dq = 2 f pbar, pbar = (p_1 + p_2)/2; 2 f pbar - dq is the pressure of a Hertz contact over the stick
zone, times 2 f.
"""

import numpy as np

from partialslip import load_scene
from partialslip.result import Cost, Result, Traction, TractionAt

# a of 0.8 and 1 mm at load points 1 and 2, stick zone (m, n) = (0.757106781187, 0.657106781187) mm
SCENE = load_scene("hertz-small-tension").replace(load={
    "p0": None, "P": (402123.8596594935, 628318.5307179586), "Q": (-100530.96491487338, 100530.96491487338),
    "sigma": (-40e6, 40e6),
})  # fmt: skip
TURNED = SCENE.replace(load={key: getattr(SCENE.load, key)[::-1] for key in ("P", "Q", "sigma")})


def solved(scene):
    """Return the steady state of ``scene``."""
    AR, f, load = scene.material.A * scene.profile.R, scene.friction.f, scene.load
    first, second = (float(np.sqrt(2 * AR * scene.pressing[end].P / np.pi)) for end in load.ends)
    a, least, turn = max(first, second), min(first, second), np.sign(load.dQ)
    half_width = float(np.sqrt((first**2 + second**2) / 2 - AR * abs(load.dQ) / (np.pi * f)))
    centre = -turn * AR * load.dsigma / (8 * f)
    assert half_width + abs(centre) < least  # slip at both ends

    def hertz(x, a, centre=0.0):
        return np.sqrt(np.maximum(a**2 - (x - centre) ** 2, 0.0)) / AR

    def pressures_at(x):
        return hertz(x, first), hertz(x, second)

    def at(x):
        p1, p2 = pressures_at(x)
        return TractionAt(p2, 2 * f * turn * ((p1 + p2) / 2 - hertz(x, half_width, centre)), p1=p1)

    breaks = np.unique([-a, -least, centre - half_width, centre + half_width, least, a])
    x = np.linspace(-a, a, 401)
    traction = Traction(x, at(x), at, breaks)
    ends = ((-first, first), (-second, second))
    return Result(
        "exact", a, a / AR, "small tension", centre, half_width, traction, Cost(0, 0, None), contact_ends=ends
    )
