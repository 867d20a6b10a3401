"""What a result tells of its own errors. A missing estimate is not zero: such a value is not known."""

import math

from partialslip.result import Result
from partialslip.result.record import ResultRecord

_CONTACT, _PRESSURE = ("a", "left", "right"), ("p", "p_max")
_STICK, _SHEAR = ("m", "n"), ("q", "q1", "q2")
#: What half-planes of like materials know to rounding where they give no estimate: of exact all quantities.
_MARCH = frozenset((*_CONTACT, *_PRESSURE))
_OF_LOADS = frozenset(("P", "dQ"))  # the reference's value is the load of the scene
#: The estimate that stands for another: of the same traction, or of the contact as a whole.
_INSTEAD = {"left": "a", "right": "a", "M": "p", "q1": "q", "q2": "q"}
_ALL_STICKS = {"m": "a", "n": "a"}
_NO_STICK = {"q": "p", "q1": "p", "q2": "p"}  # q = f p, or 0


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
