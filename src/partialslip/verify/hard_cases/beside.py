"""Hard cases: the stick zone beside the centre."""

from collections.abc import Iterator

from partialslip.verify.case import Case
from partialslip.verify.hard_cases.scenes import hard_scene

TITLE = "The stick zone beside the centre"
HARD = """
x = 0 slips. Formulas that take the sign of the traction from the sign of x, as printed, are wrong here. A mesh that
is fine only in the middle and at the ends is wrong, too, and so is a search that starts with a centred zone.
"""


def cases() -> Iterator[Case]:
    """Make the cases of the family."""
    yield Case("beside-small", hard_scene("beside-small", 0.91, 4.8))
    yield Case("beside-large", hard_scene("beside-large", 0.6, 10.0))
