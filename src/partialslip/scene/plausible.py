"""Values that look like a slip of unit. They are allowed; one line each says what they look like."""

import math
from typing import TYPE_CHECKING

from partialslip.scene.profiles import Hertz, Tabulated
from partialslip.scene.units import SI, Dimension

if TYPE_CHECKING:
    from partialslip.scene.model import Scene

# limit: what engineering contacts have, with a margin: from gels to above diamond
_E = 1e7, 1e13  # Pa
_SLOPE = 1e-7, 0.3  # limit: a/R: beyond these the surfaces are rough beside it, or not nearly flat
_STRAIN = 0.1  # limit: of bulk tension over E, beyond what stays elastic
_WIDEST = 0.5  # limit: m, half-width of a contact
_TABLE = 1e-2, 1e2  # limit: reach of the places of friction.x, in a
_FAR = 100.0  # limit: of fatigue.distance over a: the stresses are none of the contact there
_HALF_WIDTH = math.sqrt(2 / math.pi)  # of Hertz contact, in the scene's characteristic length


def implausible(scene: "Scene") -> tuple[str, ...]:
    """Lines on values of ``scene`` that look like a slip of unit; none for most scenes."""
    units, a = scene.units, _HALF_WIDTH * scene.length
    hint = f"is units = {units.name!r} right?" if units != SI else "are all values in SI units?"

    def line(name: str, value: float, of: Dimension, size: str) -> str:
        return f"{name} = {units.labelled(value, of, 3)} is {size}: {hint}"

    found = [
        line(f"{name}.E", own.E, "Pa", "softer than rubber" if _E[0] > own.E else "stiffer than any solid")
        for name, own in scene.material
        if not _E[0] <= own.E <= _E[1]
    ]
    if isinstance(scene.profile, (Hertz, Tabulated)) and not _SLOPE[0] <= a / scene.profile.R <= _SLOPE[1]:
        size = "too flat for any surface" if a < _SLOPE[0] * scene.profile.R else "far from nearly flat surfaces"
        of = "heights" if isinstance(scene.profile, Tabulated) else "R"
        found.append(f"a/R is about {a / scene.profile.R:.1g}, {size}: {hint} (R is that of the {of})")
    tension, softest = max(map(abs, scene.load.sigma), default=0.0), min(own.E for _, own in scene.material)
    if tension > _STRAIN * softest:
        found.append(line("load.sigma", tension, "Pa", f"{tension / softest:.2g} of E, more than any elastic strain"))
    if a > _WIDEST:
        found.append(line("a", a, "m", "the half-width of a very large contact"))
    if scene.friction.kinks:
        reach = max(map(abs, scene.friction.kinks)) / a
        if not _TABLE[0] <= reach <= _TABLE[1]:
            found.append(f"friction.x reaches to {reach:.1g} a: {hint}")
    if (distance := scene.fatigue.distance or 0.0) > _FAR * a:
        found.append(line("fatigue.distance", distance, "m", f"{distance / a:.2g} a, far beyond the contact"))
    return tuple(found)
