"""Shipped scenes under loads that are fully reversed about a mean."""

import partialslip
from partialslip.halfplane import contact


def scene(Qf, sf, *overrides, name="hertz-large-tension", mean=(0.0, 0.0)):
    """The scene ``name`` under dQ/(2 f P) and dsigma/(f p0), about a ``mean`` of Q, in f P, and of sigma, in f p0."""
    base = partialslip.load_scene(name)
    units = {"Q": base.friction.f * base.P, "sigma": base.friction.f * contact(base).p0}
    loads = zip(units.items(), mean, (Qf, sf / 2), strict=True)
    settings = [f"load.{key}={[unit * (middle - half), unit * (middle + half)]}" for (key, unit), middle, half in loads]
    return partialslip.load_scene(name, [*settings, *overrides])
