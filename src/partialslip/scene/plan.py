"""The plan: effects that a scene calls for and effects that it leaves out, each with a reason in words.

Methods read the plan and build only the effects called for. A scene's ``[effects]`` force effects on or off.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import msgspec
from msgspec.structs import replace

from partialslip.scene import WIDTHS, Bodies, Effects, Fatigue, Friction, Scene
from partialslip.scene.gradual import may_turn_round, small_tension
from partialslip.scene.reading import AnyScene, as_scene
from partialslip.scene.units import Dimension
from partialslip.tools.errors import InputError

Effect = Literal[
    "normal",
    "varying-pressure",
    "moment",
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
_FIELDS = "fields inside the bodies were asked for"
_Decisions = dict[Effect, tuple[bool, str, str]]  # whether needed; reason if needed; reason if not


@dataclass(frozen=True, repr=False)
class Plan:
    """Effects by name: ``called_for`` and ``left_out``, with the reason of each. ``missing`` are effects that the scene
    calls for but ``[effects]`` force off."""

    called_for: dict[Effect, str]
    left_out: dict[Effect, str]
    missing: dict[Effect, str] = field(default_factory=dict)

    def __repr__(self) -> str:
        """The names of the effects; the fields have the reasons."""
        groups = {"called for": self.called_for, "left out": self.left_out, "forced off": self.missing}
        return "Plan: " + "; ".join(f"{name} {', '.join(effects)}" for name, effects in groups.items() if effects)

    def needs(self, effect: Effect) -> bool:
        """Whether the scene calls for ``effect``."""
        return effect in self.called_for

    @property
    def with_stresses(self) -> "Plan":
        """The plan with fields inside the bodies."""
        if self.needs("subsurface"):
            return self
        called_for: dict[Effect, str] = {**self.called_for, "subsurface": _FIELDS}
        return Plan(called_for, {key: why for key, why in self.left_out.items() if key != "subsurface"}, self.missing)

    def accept(self, regime: str) -> None:
        """Raise InputError if the ``regime`` of a result requires an effect that is forced off."""
        if "opposing-slip" in self.missing and regime == "large tension":
            raise InputError(
                "effects.opposing-slip = false: must be true; tension reverses slip at one end (large tension)"
            )


def plan(scene: AnyScene, *, subsurface: bool = False, start: bool = False) -> Plan:
    """Decide which effects ``scene`` calls for.

    Parameters
    ----------
    scene : Scene, str or path
        A scene, the name of a shipped one, or the path of a scene file.
    subsurface : bool
        Whether fields inside the bodies are requested.
    start : bool
        Whether the path of the loads begins in a given state.

    Raises
    ------
    InputError
        If an effect without which there is no solution is forced off, or an effect that cannot be built is forced on.
    """
    scene = as_scene(scene)
    own = _decide(replace(scene, effects=Effects()), subsurface, start)
    forced = _forced(scene)
    _refuse(scene, forced, own, start)
    decided = _decide(reduced(scene), subsurface, start) if forced else own
    called_for: dict[Effect, str] = {}
    left_out: dict[Effect, str] = {}
    for effect, (needed, why, why_not) in decided.items():
        choice = forced.get(effect)
        if needed if choice is None else choice:
            called_for[effect] = why if needed and (not choice or own[effect][0]) else f"forced on, though {why_not}"
        else:
            off = choice is False and own[effect][0]
            left_out[effect] = f"forced off, though {own[effect][1]}" if off else why_not
    missing = {effect: why for effect, (needed, why, _) in own.items() if needed and forced.get(effect) is False}
    return Plan(called_for, left_out, missing)


def asks_for_stresses(scene: Scene) -> bool:
    """Whether sweeps and studies of ``scene`` are to find stresses: it has a constant of fatigue criteria, or forces
    subsurface on. Plans for them then call for subsurface."""
    forced = scene.effects.subsurface
    return scene.fatigue != Fatigue() if forced is None else forced


def reduced(scene: Scene) -> Scene:
    """Scene that methods solve: ``scene`` without friction, loads and sizes that ``[effects]`` force off.

    Without varying pressure P and M are those of the load point with the larger P. Without history the loads become
    fully reversed. Without the far field, blocks are clamped directly.
    """
    effects, load, fem = scene.effects, scene.load, scene.fem
    if effects.shear is False:
        load = replace(load, Q=(0.0,) * len(load.Q), displacement=None, spring=None, Q_found=None)
    if effects.tension is False:
        load = replace(load, sigma=(0.0,) * len(load.sigma), sigma_slope=(0.0,) * len(load.sigma_slope))
    if effects.varying_pressure is False and scene.presses_anew:
        load = replace(load, P=scene.P, a=None, p0=None, M=scene.M, e=None)
    if effects.moment is False:
        load = replace(load, M=None, e=None)
    if effects.history is False:
        changes = {"Q": load.dQ, "sigma": load.dsigma, "sigma_slope": load.dslope}
        ends = {key: (-change / 2, change / 2) for key, change in changes.items()}
        load = replace(load, **ends, cycles=None, steps=1)
    if effects.far_field is not None:
        width = fem.width or WIDTHS["half-plane"]
        fem = replace(fem, far_field="half-plane" if effects.far_field else "box", width=width)
    return replace(
        scene,
        load=load,
        fem=fem,
        friction=Friction(f=0.0) if effects.friction is False else scene.friction,
        bodies=Bodies() if effects.finite_size is False else scene.bodies,
    )


def _forced(scene: Scene) -> dict[Effect, bool]:
    return {effect: on for effect, on in msgspec.to_builtins(scene.effects).items() if on is not None}


def _decide(scene: Scene, subsurface: bool, start: bool) -> _Decisions:
    """Decisions for ``scene``, taking forced loads and forced coupling into account."""
    load, f, forced = scene.load, scene.friction.f, _forced(scene)
    sigma, slope = zip(*load.tension, strict=True)
    driving, moved = load.driving, load.displacement is not None
    drives_by: tuple[str, Dimension] = ("displacement", "m") if moved else ("Q", "N/m")
    tension: dict[str, tuple[Sequence[float], Dimension]] = {"sigma": (sigma, "Pa"), "sigma_slope": (slope, "Pa/m")}
    stretched = [f"{key} goes between {scene.units.span(each, of)}" for key, (each, of) in tension.items() if any(each)]
    coupled = forced.get("coupling", not scene.mirrored)
    tangential = any(driving) or moved or bool(stretched) or forced.get("shear", False) or forced.get("tension", False)
    friction = forced.get("friction", tangential or coupled) and not (scene.slides or scene.free)
    drives = "tangential loads act" if tangential else "pressure moves the surfaces along x"
    why = f"{drives} and f = {scene.friction.shown}"
    if not (tangential or coupled):
        no_friction = "no tangential load acts"
    elif f == 0:
        no_friction = "f = 0: no traction holds the surfaces along x"
    else:
        no_friction = "|Q| >= f P at a load point: the contact slides as a whole"
    one_way, turns = small_tension(scene), may_turn_round(scene)
    small = ""
    if one_way and not moved:
        small = "tension is small: both ends of a Hertz contact slip the same way"
    opposing = "tension may turn the slip at one end of the contact"
    history = _why_history(scene, coupled, start, turns)
    units, anew = scene.units, scene.presses_anew
    forces, moments = [P for P, _ in scene.pressing], [M or 0.0 for _, M in scene.pressing]
    varies = [f"P goes between {units.span(forces, 'N/m')}"] if len(set(forces)) > 1 else []
    varies += [f"M goes between {units.span(moments, 'N')}"] if len(set(moments)) > 1 else []
    turned = f"{scene.M or 0.0:g} N" if len(set(moments)) == 1 else "M"
    pivots = scene.pin is not None
    by_pin = f"a body turns until the moment of pressure and shear about its pin is {turned}"
    return {
        "normal": (True, f"two bodies are pressed together by {'P' if anew else 'a constant P'}", ""),
        "varying-pressure": (anew, ", ".join(varies), "P is constant" + ", and so is M" * any(moments)),
        "moment": (pivots or (not scene.even and scene.M is not None),
                   by_pin if pivots else f"the bodies turn until the moment of the pressure is {turned}",
                   "no moment acts, and the gap is even" if scene.even else "the bodies do not turn"),
        "friction": (friction, why, no_friction),
        "shear": (any(driving) or moved, f"{drives_by[0]} goes between {scene.units.span(driving, drives_by[1])}",
                  "Q = 0 at every load point"),
        "tension": (bool(stretched), ", ".join(stretched),
                    "sigma = 0 at every load point"
                    + ": the problem is symmetric in x up to sign" * (not scene.friction.varies)),
        "opposing-slip": (friction and (coupled or ((load.dsigma != 0 or load.dslope != 0) and not small)),
                          "pressure drags the ends of the contact opposite ways" if coupled else opposing,
                          no_friction if not friction else small or
                          "without a change of tension both ends slip the same way in the steady state"),
        "history": (friction and bool(history), history,
                    "Q1 = -Q2 and sigma1 = -sigma2: half a cycle tells the whole" if friction else no_friction),
        "coupling": (not scene.mirrored,
                     "the bodies are not mirror images: pressure moves them along x, and shear opens the gap",
                     "the bodies are mirror images: what pressure and shear do across cancels"
                     + (", and one is factored for both" if scene.fem.lower_size == 1 else "")),
        "finite-size": (scene.finite, "a body has a size of its own", "the bodies stand for half-planes"),
        "far-field": (scene.fem.far_field == "half-plane" and None in (scene.bodies.upper, scene.bodies.lower),
                      "a block is held by the displacements of the half-plane it stands for (by fem)",
                      "blocks are held as they are: no half-plane around them"),
        "subsurface": (subsurface, _FIELDS,
                       "fields inside the bodies were not asked for"),
    }  # fmt: skip


def _why_history(scene: Scene, coupled: bool, start: bool, turns: bool) -> str:
    """Reason why locked-in tractions depend on the path; empty if they do not.

    If slip does not reverse from load point 1 to 2, the change of shear is twice that of the first loading (Masing's
    rule): the conditions of half a cycle are those of the first loading, doubled.
    """
    load = scene.load
    if start:
        return "the path goes on from a state"
    if coupled:
        return "pressure and shear move the surfaces together: what they lock in depends on the path"
    if load.displacement is not None:
        return "plates are moved: the force follows from the path"
    if not load.in_phase:
        return f"{scene.varying} are out of phase: locked-in tractions depend on the path"
    if scene.presses_anew:
        return "the pressure varies: what it locks in where the contact grows depends on the path"
    if not load.fully_reversed:
        return "mean loads act: the tractions locked in by the first cycles depend on the path"
    if turns:
        return "slip may reverse between load points 1 and 2"
    if load.steps > 1 or len(load.points) > 2:
        return "load.steps > 1, or there are more than two load points"
    return ""


def _refuse(scene: Scene, forced: dict[Effect, bool], own: _Decisions, start: bool) -> None:
    """Raise InputError if a forced effect leaves nothing to solve or cannot be built."""
    off = {effect for effect, on in forced.items() if not on}
    on = {effect for effect, on in forced.items() if on}
    coupled = "coupling" in on or (not scene.mirrored and "coupling" not in off)
    tangential: tuple[Effect, ...] = ("friction", "shear", "tension")
    unheld = scene.slides or scene.free
    moved = scene.load.displacement is not None
    reasons: list[tuple[Effect, bool, str]] = [
        ("normal", "normal" in off, "without pressure there is no contact"),
        ("friction", "friction" in off and moved, "plates are moved, and drag the bodies along by friction"),
        *((each, each in on and unheld and not own[each][0], own["friction"][2]) for each in tangential),
        ("opposing-slip", "opposing-slip" in off and not scene.load.in_phase,
         f"{scene.varying} are out of phase, and slip reverses"),
        ("varying-pressure", "varying-pressure" in on and not scene.presses_anew, own["varying-pressure"][2]),
        ("history", "history" in off and own["history"][0]
         and (coupled or scene.presses_anew or not scene.load.in_phase or moved),
         own["history"][1]),
        ("history", "history" in off and start, own["history"][1]),
        ("coupling", "coupling" in off and scene.pin is not None, "a body pivots: shear changes the pressure"),
        ("finite-size", "finite-size" in on and not scene.finite, "bodies.upper and bodies.lower have no size"),
        ("far-field", "far-field" in on and None not in (scene.bodies.upper, scene.bodies.lower),
         "both bodies are finite: there is no half-plane around them"),
        ("subsurface", "subsurface" in off and own["subsurface"][0], own["subsurface"][1]),
    ]  # fmt: skip
    for effect, refused, why in reasons:
        if refused:
            choice: Any = str(forced[effect]).lower()
            raise InputError(f"effects.{effect} = {choice}: {why}; must be {str(not forced[effect]).lower()}")
