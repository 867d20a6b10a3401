"""Hard cases: no shear: dQ = 0."""

from collections.abc import Iterator

from partialslip.verify.case import Case
from partialslip.verify.hard_cases.scenes import PEAKS, hard_scene

TITLE = "No shear: dQ = 0"
HARD = """
Without a change of Q any tension is large tension: the transition is at zero. The solution is antisymmetric.
Quantities that are divided by dQ, or scaled with dQ, are lost. An increment with zero resultant must still be a load
step. A code that measures convergence by Q stops before the first iteration.
"""


def cases() -> Iterator[Case]:
    """Make the cases of the family."""
    yield Case("no-shear", hard_scene("no-shear", 0.0, 4.0))
    yield Case("no-shear-slight", hard_scene("no-shear-slight", 0.0, 1e-6), bars=PEAKS)
