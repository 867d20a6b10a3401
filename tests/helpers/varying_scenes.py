"""Scenes of Hertz contacts under varying P and M, scaled so that p_i = sqrt(a_i^2 - (x - e_i)^2) and f = 1."""

import math

from partialslip import parse_scene


def varying(a, dQ, dsigma, e=(0.0, 0.0), mean=0.0, f=1.0, accuracy=1e-2, **load):
    """Scene with the contacts [e_i - a_i, e_i + a_i] at load points 1 and 2, and shear about ``mean``."""
    loads = {
        "P": [math.pi * each**2 / 2 for each in a],
        "Q": [mean - dQ / 2, mean + dQ / 2],
        "sigma": [-dsigma / 2, dsigma / 2],
    }
    if any(e):
        loads["e"] = list(e)
    return parse_scene({
        "name": "varying", "material": {"E": 4 * (1 - 0.3**2), "nu": 0.3},  # A = 1
        "profile": {"kind": "hertz", "R": 1.0}, "friction": {"f": f}, "load": loads | load,
        "fem": {"accuracy": accuracy},
    })  # fmt: skip
