"""What is right, and how well it is known: the reference of a scene, and what a result tells of its own errors.

The reference is chosen here and nowhere else, for run, score, verify, fatigue, map and the book. A missing estimate is
not zero: such a value is not known.
"""

import math
from collections.abc import Mapping
from typing import NamedTuple

from partialslip.result import Result
from partialslip.result.record import ResultRecord
from partialslip.scene import Scene
from partialslip.scene.gradual import may_turn_round
from partialslip.scene.plan import reduced
from partialslip.tools.methods import METHODS

ALL_EFFECTS = "all effects"  # name of the result in which no effect is forced off

_REVERSES = "path-dependent: slip reverses between the load points; no solution is known to hold"
_CONTACT, _PRESSURE = ("a", "left", "right"), ("p", "p_max")
_STICK, _SHEAR = ("m", "n"), ("q", "q1", "q2")
#: What half-planes of like materials know to rounding where they give no estimate: of exact all quantities.
_MARCH = frozenset((*_CONTACT, *_PRESSURE))
_OF_LOADS = frozenset(("P", "dQ"))  # the reference's value is the load of the scene
#: The estimate that stands for another: of the same traction, or of the contact as a whole.
_INSTEAD = {"left": "a", "right": "a", "M": "p", "q1": "q", "q2": "q"}
_ALL_STICKS = {"m": "a", "n": "a"}
_NO_STICK = {"q": "p", "q1": "p", "q2": "p"}  # q = f p, or 0


class Reference(NamedTuple):
    """The reference of a scene: the ``method`` with which others are compared, and by quantity why no value of any
    method is known to hold (``unknown``); the errors of these quantities are shown, but not judged."""

    method: str
    unknown: Mapping[str, str] = {}


def reference(scene: Scene) -> Reference:
    """Return the reference of ``scene``: never a solution that is known not to hold.

    Similar half-planes: exact where the steady state is known exactly, march elsewhere. Where slip reverses between the
    load points the closed form, which goes there in one step, does not hold; exact then follows gradual loads. Where it
    cannot, or where the pressure varies, neither exact nor march is a reference for m, n and the shear. Two equal
    strips are like half-planes, but march is their reference where the pressure varies. Other finite bodies and
    dissimilar materials: fem.
    """
    if scene.sized or not scene.material.alike:
        return Reference("fem")
    own = reduced(scene)
    if not own.load.in_phase or (own.strips and own.presses_anew):
        return Reference("march")
    if not may_turn_round(own):
        return Reference("exact")
    from partialslip.halfplane.method import has_closed_form, path_dependent

    if not has_closed_form(own):
        return Reference("march")
    if path_dependent(own):
        return Reference("march", dict.fromkeys(("m", "n", "q", "q1", "q2"), _REVERSES))
    return Reference("exact")


def reference_among(scene: Scene, results: Mapping[str, Result] | Mapping[str, ResultRecord]) -> str | None:
    """Return the name of the reference among the ``results`` of ``scene`` by method; None without results.

    The reference is the result with all effects, else that of :func:`reference`, else the first of exact, march, fem
    and equivalent; of these a result that tells its errors goes before one that does not. For finite and for dissimilar
    bodies, where nothing is judged, it is the first: the errors are what half-planes leave out.
    """
    if ALL_EFFECTS in results:
        return ALL_EFFECTS
    # what is known exactly of the scene, which may take seconds, decides nothing where there is one result
    judged = len(results) > 1 and not scene.sized and scene.material.alike
    first = (reference(scene).method,) if judged else ()
    names = [name for name in (*first, *METHODS) if name in results]
    return next((name for name in names if not judged or estimated(results[name], name)), next(iter(names), None))


def base(quantity: str) -> str:
    """Return the key of the estimate of ``quantity``: without the number of the load point, as in ``left_1``."""
    return quantity.removesuffix("_1").removesuffix("_2")


def error_of(result: Result | ResultRecord, quantity: str, method: str) -> float:
    """Return the estimate that the ``result`` of ``method`` has of its error in ``quantity``; NaN if it has none.

    Ends are in a, tractions in relative L2. Zero is what the method knows to rounding: exact all quantities, march
    (of like half-planes) contact and pressure, every method the sums of the loads and the shear that no load calls
    for.
    """
    key = base(quantity)
    if key in _OF_LOADS:
        return 0.0
    still = {"stuck": _ALL_STICKS, "sliding": _NO_STICK, "frictionless": _NO_STICK}.get(result.regime, {})
    keys = [each for each in (key, (_INSTEAD | still).get(key)) if each]
    own = next((result.estimate[each] for each in keys if result.estimate.get(each) is not None), None)
    if own is not None:
        return float(own)
    unsheared = key in _SHEAR and result.counts.get("tangential_unknowns") == 0
    exact = method == "exact" or (method == "march" and not _MARCH.isdisjoint(keys))
    return 0.0 if exact or unsheared else math.nan


def estimated(result: Result | ResultRecord, method: str) -> bool:
    """Return whether the ``result`` of ``method`` tells the errors of all that it claims: a, p, q and the stick zone,
    if there is one."""
    stick = [key for key in _STICK if result.regime != "ratchets" and getattr(result, key) is not None]
    return all(math.isfinite(error_of(result, key, method)) for key in ("a", "p", "q", *stick))
