"""Shipped scenes under fully reversed loads."""

import partialslip
from partialslip.halfplane import contact


def scene(Qf, sf, *overrides, name="hertz-large-tension"):
    """The scene ``name`` under dQ/(2 f P) and dsigma/(f p0)."""
    base = partialslip.load_scene(name)
    limit, stress = base.friction.f * base.P, base.friction.f * contact(base).p0 / 2
    loads = f"load.Q=[{-Qf * limit}, {Qf * limit}]", f"load.sigma=[{-sf * stress}, {sf * stress}]"
    return partialslip.load_scene(name, [*loads, *overrides])
