"""Hard cases: at the transition from small to large tension, and 1e-9 beside it."""

from collections.abc import Iterator

from partialslip.halfplane.hertz import Hertz
from partialslip.halfplane.steady import transition
from partialslip.verify.case import Case
from partialslip.verify.hard_cases.scenes import hard_scene

TITLE = "At the transition from small to large tension, and 1e-9 beside it"
HARD = """
The left slip zone has just disappeared, or is a billionth of the contact wide. Its sign changes from one side of the
transition to the other. The formulas of one regime fail under the loads of the other regime: the root of a negative
number, or a modulus above one. A search with one branch for each regime jumps between the branches. A code that
compares floating-point loads to name the regime flips between the names. partialslip solves for an unknown that
passes smoothly through zero.
"""


def cases() -> Iterator[Case]:
    """Make the cases of the family."""
    at = float(transition(0.5, Hertz()))
    for name, sf in (("below", at * (1 - 1e-9)), ("at", at), ("above", at * (1 + 1e-9))):
        yield Case(f"transition-{name}", hard_scene(f"transition-{name}", 0.5, sf))
