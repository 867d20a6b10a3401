"""Hard cases: no tension: dsigma = 0."""

from collections.abc import Iterator

from partialslip.verify.case import Case
from partialslip.verify.hard_cases.scenes import hard_scene

TITLE = "No tension: dsigma = 0"
HARD = """
This is the case of Cattaneo and Mindlin. It is symmetric, so both ends of the stick zone move at the same time, and
pairs of nodes change side in the same iteration. Rules that release one node at a time break the symmetry, and the
solution may stay asymmetric.
"""


def cases() -> Iterator[Case]:
    """Make the cases of the family."""
    yield Case("no-tension", hard_scene("no-tension", 0.6, 0.0))
