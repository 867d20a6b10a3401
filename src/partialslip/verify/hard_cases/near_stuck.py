"""Hard cases: near stuck: dQ/(2 f P) = 1e-3 to 1e-9."""

from collections.abc import Iterator

from partialslip.verify.case import Case
from partialslip.verify.hard_cases.scenes import PEAKS, hard_scene

TITLE = "Near stuck: dQ/(2 f P) = 1e-3 to 1e-9"
HARD = """
Slip is confined to strips at the ends that are narrower than any element. The traction beside the strips is the
adhered one, which is infinite at the ends. Codes with an elastic slip tolerance report that the contact is stuck, or
that it slips a little everywhere. Two meshes that both miss the strips agree with each other, which is no sign of
convergence. The ends of the stick zone are accurate, because they lie next to the ends of the contact. But q in the
last elements is a mean over a peak that the mesh does not resolve. The reference of the relative norm is as small as
the load, so this mean alone causes an error of several percent.
"""


def cases() -> Iterator[Case]:
    """Make the cases of the family."""
    for power in (3, 6, 9):
        name = f"near-stuck-1e-{power}"
        yield Case(name, hard_scene(name, 10.0**-power, 2 * 10.0**-power), bars=PEAKS)
