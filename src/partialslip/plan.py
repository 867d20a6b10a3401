"""The plan: which effects a scene calls for and which it leaves out, each with its reason in words.

Methods read the plan and build only what it calls for.
"""

from dataclasses import dataclass
from typing import Literal

from partialslip.scene import Scene

Effect = Literal[
    "normal",
    "friction",
    "shear",
    "tension",
    "opposing-slip",
    "history",
    "coupling",
    "finite-size",
    "far-field",
    "subsurface",
]


@dataclass(frozen=True)
class Plan:
    """Effects by name, with the reason why each is called for or left out."""

    called_for: dict[Effect, str]
    left_out: dict[Effect, str]

    def needs(self, effect: Effect) -> bool:
        """Whether the scene calls for ``effect``."""
        return effect in self.called_for


def plan(scene: Scene, *, subsurface: bool = False) -> Plan:
    """Decide which effects ``scene`` calls for; ``subsurface`` asks for fields inside the bodies."""
    load, f = scene.load, scene.friction.f
    Q, sigma = zip(*load.points, strict=True)
    tangential = any(Q) or any(sigma)
    friction = f > 0 and (tangential or not scene.mirrored)
    why = f"tangential loads act and f = {f:g}" if tangential else f"pressure moves the surfaces along x and f = {f:g}"
    no_friction = "f = 0: no traction can hold a tangential load" if tangential else "no tangential load acts"
    decisions: list[tuple[Effect, bool, str, str]] = [
        ("normal", True, "two bodies are pressed together by a constant P", ""),
        ("friction", friction, why, no_friction),
        ("shear", any(Q), f"Q goes between {min(Q):g} and {max(Q):g} N/m", "Q = 0 at every load point"),
        ("tension", any(sigma), f"sigma goes between {min(sigma):g} and {max(sigma):g} Pa",
         "sigma = 0 at every load point"),
        ("opposing-slip", friction and load.dsigma != 0, "tension may turn the slip at one end of the contact",
         "without a change of tension both ends slip the same way in the steady state" if friction else no_friction),
        ("history", friction and (not load.fully_reversed or load.cycles > 1 or not scene.mirrored),
         "mean loads, several cycles, loads out of phase or coupling: what is locked in depends on the path",
         "fully reversed, one cycle: nothing is locked in" if friction else no_friction),
        ("coupling", not scene.mirrored,
         "the bodies are not mirror images: pressure moves them along x, and shear opens the gap",
         "the bodies are mirror images: what pressure and shear do across cancels, and one is factored for both"),
        ("finite-size", scene.finite, "a body has a size of its own", "the bodies stand for half-planes"),
        ("far-field", scene.fem.far_field == "half-plane" and None in (scene.bodies.upper, scene.bodies.lower),
         "a block is held by the displacements of the half-plane it stands for",
         "blocks are held as they are: no half-plane around them"),
        ("subsurface", subsurface, "fields inside the bodies were asked for",
         "fields inside the bodies were not asked for"),
    ]  # fmt: skip
    return Plan(
        called_for={effect: why for effect, needed, why, _ in decisions if needed},
        left_out={effect: why for effect, needed, _, why in decisions if not needed},
    )
