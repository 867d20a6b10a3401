"""Hard cases: near sliding: dQ/(2 f P) = 1 - 1e-3 to 1 - 1e-9."""

from collections.abc import Iterator

from partialslip.verify.case import Case
from partialslip.verify.hard_cases.scenes import hard_scene

TITLE = "Near sliding: dQ/(2 f P) = 1 - 1e-3 to 1 - 1e-9"
HARD = """
The stick zone is sqrt(1 - Q_f) of the contact. Inside it the shear is below the friction bound by a part in 1e9 of
the bound, which is as large as the tolerance of many codes. With a penalty or a regularised law the whole contact
creeps. The code finds no stick zone, or a stick zone as wide as its elastic slip. Newton's iteration on stick and
slip flags switches one last node back and forth. A mesh that does not resolve the zone gives ends that are off by an
element. The error estimate assumes resolved zones and is then a hundred times too small. partialslip therefore
refines a zone of fewer than sixteen elements before it accepts the ends.
"""


def cases() -> Iterator[Case]:
    """Make the cases of the family."""
    for power in (3, 6, 9):
        name = f"near-sliding-1e-{power}"
        yield Case(name, hard_scene(name, 1 - 10.0**-power, 2.0))
