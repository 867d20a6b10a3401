"""Regime in which a history ends, and notes on the result."""

import math
from collections.abc import Mapping

import numpy as np

from partialslip.friction.history import STEADY, History
from partialslip.friction.zone_ends import StickInterval
from partialslip.result import FRICTIONLESS, PATH_DEPENDENT, EndSlip, Regime, SteadyState
from partialslip.scene import Scene
from partialslip.tools.arrays import Array
from partialslip.tools.bars import BARS, LARGEST, Asked

# accuracy: from load point to load point: with fewer, p while a node slips is known roughly where it varies
_FEW_STEPS = 8
_MANY = 2  # accuracy: nodes of both contacts beside the stick zone from which on the end slips throughout
_SLIPS = 1e-6  # accuracy: slip in a cycle, in the largest possible slip, above rounding
_WORK = 1e-9  # accuracy: dissipated energy, in f P times a displacement of A P, above rounding
# limit: net slip of a cycle, in the slip of half a cycle, above which a steady q ratchets: what creeps to its place has
# less
_RATCHETS = 1e-3

_REVERSES = f"{PATH_DEPENDENT}between the load points; m, n, q are those of"


def steady_state(
    scene: Scene,
    history: History | None,
    stick: StickInterval | None,
    half_width: float,
    pressed: bool = False,
    x: Array | None = None,
    common: tuple[float, float] | None = None,
) -> SteadyState:
    """Regime and stick zone of ``scene``, from the computed stick zone ``stick`` (None if no friction was solved) in a
    contact of ``half_width``; lengths in any one unit.

    ``pressed``: whether coupled bodies slipped while they were pressed and no other load acts. The stick zone is then
    where the surfaces have stuck since they touched. ``x`` are the nodes of the history, ``common`` the ends
    of what is in contact at both load points; needed where the pressure varies.
    """
    load, anew = scene.load, history is not None and history.path.presses_anew
    if scene.free:
        return SteadyState("frictionless", notes=(FRICTIONLESS,))
    if scene.slides:
        note = "the contact slides: |Q| >= f P at a load point; there is no steady partial slip"
        return SteadyState("sliding", notes=(note,))
    if pressed and stick:
        note = "no load but P acts: the stick zone is where the surfaces have stuck since they touched"
        return SteadyState("pressing", (stick.right + stick.left) / 2, (stick.right - stick.left) / 2, (note,))
    if (
        history is None or stick is None or (not (load.dQ or load.dsigma or load.dslope) and not anew)
    ):  # all of the contact sticks
        left, right = common or (-half_width, half_width)
        return SteadyState("stuck", (right + left) / 2, (right - left) / 2)
    notes: tuple[str, ...] = ()
    apart = common is not None and common[0] >= common[1]
    if apart:
        notes = ("no point is in contact at both load points: there is no stick zone",)
    elif stick.left == stick.right:
        notes = ("not resolved: the stick zone is smaller than an element; m and n are where slip changes sign",)
    regime: Regime = "small tension" if stick.signs[0] == stick.signs[1] else "large tension"
    slips = _end_slips(x, history, stick) if anew and x is not None and load.in_phase else None
    if slips and {"never", "part of the cycle"}.intersection(slips):
        regime = "no slip" if set(slips) == {"never"} else "sticking ends"
    if not load.in_phase:
        regime = "out of phase"
    if regime != "no slip" and history.repeats and history.ratchets > _RATCHETS:  # else the slip is that of rounding
        regime = "ratchets"
        notes += (
            "tractions repeat, slip does not: every cycle adds up to "
            f"{history.ratchets:.1g} times the slip of half a cycle",
        )
    # how far coupled bodies depend on their steps is told by :func:`steps_of_coupled`
    if (history.path.turns or history.turns) and regime in ("small tension", "large tension"):
        notes += (f"{_REVERSES} loads that change gradually",)
    few = not history.path.followed and history.path.most_steps < _FEW_STEPS
    if anew and few and history.dissipated > _WORK * history.bound.sum():
        steps = "a step" if history.path.most_steps == 1 else f"{history.path.most_steps} steps"
        notes += (f"slip near the ends of the contact is rough: {steps} from load point to load point (load.steps)",)
    unsure = _unsure(history, regime)
    if apart:
        return SteadyState(regime, notes=notes, slips=slips, undetermined=unsure)
    permanent = permanent_zone(x, history, stick) if x is not None and history.turns and regime != "ratchets" else None
    centre, half = (stick.right + stick.left) / 2, (stick.right - stick.left) / 2
    return SteadyState(regime, centre, half, notes, slips, permanent, unsure)


def _unsure(history: History, regime: Regime) -> dict[str, str]:
    """Quantities that the cycles of a ``history`` leave undetermined, with the reasons, as
    :attr:`Result.undetermined`."""
    unsure = {}
    if regime != "ratchets" and STEADY < history.ratchets <= _RATCHETS:
        unsure["regime"] = (
            f"a cycle adds up to {history.ratchets:.1e} times the slip of half a cycle: too little to tell ratcheting "
            "from creep that ends"
        )
    if not history.steady:
        count = "1 cycle" if history.cycles == 1 else f"{history.cycles} cycles"
        unsure["steady"] = f"{count} (load.cycles) do not reach the steady state"
    return unsure


def _end_slips(x: Array, history: History, stick: StickInterval) -> tuple[EndSlip, EndSlip]:
    """How the left and the right end of the contact slip from load point 1 to 2, from a ``history`` at the nodes ``x``
    (n,), ascending, and its ``stick`` zone.

    An end slips forwards or backwards where nodes that are always in contact slip beside the stick zone. Otherwise the
    stick zone reaches as far as both contacts do, and nodes beside it may slip during part of the cycle.
    """
    assert history.slipped is not None
    most = _SLIPS * float(np.maximum(*history.bounds).sum())
    always = (history.bounds[0] > 0) & (history.bounds[1] > 0)
    found: list[EndSlip] = []
    for outside, places in ((x < stick.left, slice(None)), (x > stick.right, slice(None, None, -1))):
        beside = np.flatnonzero(outside & always)[places]
        if len(beside) >= _MANY:
            found.append("forwards" if history.change[beside[0]] > 0 else "backwards")
        elif (history.slipped[:, outside] > most).any():
            found.append("part of the cycle")
        else:
            found.append("never")
    return found[0], found[1]


def permanent_zone(x: Array, history: History, stick: StickInterval) -> tuple[float, float] | None:
    """Left and right end of the zone that never slips in a steady cycle in which slip reverses: the widest group of
    nodes ``x`` (n,), ascending, in the ``stick`` zone that are still in the ``history``. An end is half way between
    nodes, or that of the stick zone where no node slips beside it. (nan, nan) if all nodes slip, None if the slip on
    the way is not known."""
    if history.still is None:
        return None
    inside = np.flatnonzero((x > stick.left) & (x < stick.right))
    if not len(inside):
        return None
    still = np.pad(history.still[inside], 1).astype(np.int8)
    starts, stops = np.flatnonzero(np.diff(still) == 1), np.flatnonzero(np.diff(still) == -1)
    if not len(starts):
        return math.nan, math.nan
    places = x[inside]
    borders = np.array([stick.left, *(places[1:] + places[:-1]) / 2, stick.right])
    left, right = borders[starts], borders[stops]
    widest = int(np.argmax(right - left))
    return float(left[widest]), float(right[widest])


def steps_of_coupled(history: History | None, errors: Mapping[str, float], accuracy: float) -> tuple[str, ...]:
    """A note on load steps of coupled bodies, where slip reverses from step to step, or their ``errors`` are beyond the
    ``accuracy`` or, if empty, not known."""
    if not history or not history.path.moves:
        return ()
    bars = Asked(accuracy, accuracy).bars
    known = "too few for the accuracy; increase load.steps" if errors else "whose error is not estimated"
    doubted = f", {known}" * (not errors or any(error > bars[key] for key, error in errors.items()))
    steps = "1 step" if history.path.substeps == 1 else f"{history.path.substeps} steps"
    if history.reverses:
        return (f"{_REVERSES} {steps} from load point to load point (load.steps){doubted}",)
    return (f"coupled bodies go from load point to load point in {steps} (load.steps){doubted}",) if doubted else ()


def doubts(change: float | None, errors: Mapping[str, float], accuracy: float) -> tuple[str, ...]:
    """Notes on estimated ``errors`` above ``accuracy``, and on a ``change`` of q (in f p0) in the last cycle."""
    notes: tuple[str, ...] = ()
    bars = Asked(accuracy, accuracy).bars
    if beyond := {key: error for key, error in errors.items() if error > bars[key]}:
        known = ", ".join(f"{key} {error:.1e}" for key, error in beyond.items())
        reached = max(error / BARS[key] for key, error in beyond.items())
        instead = "" if max(beyond.values()) > LARGEST else f", but about {reached:.1e}"
        notes += (
            f"accuracy {accuracy:g} not reached{instead}: estimated errors are {known} (ends in a, tractions relative)",
        )
    if change is not None and change > max(accuracy, STEADY):
        notes += (f"not steady: q changed by {change:.1e} f p0 in the last cycle; increase load.cycles",)
    return notes
