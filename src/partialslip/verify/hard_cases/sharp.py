"""Hard cases: flat and rounded punches with b/a up to 0.999."""

from collections.abc import Iterator

from partialslip.verify.case import Case
from partialslip.verify.hard_cases.scenes import hard_scene

TITLE = "Flat and rounded punches with b/a up to 0.999"
HARD = """
The pressure has two logarithmic kinks, and a peak in a corner a thousandth of the contact wide. In the corner it
falls to zero like a square root. A uniform mesh along the contact misses the peak, the force in it and the slip zone
in it. Quadrature that does not split at the kinks stalls. The width of the corner is a difference of nearly equal
numbers.
"""


def cases() -> Iterator[Case]:
    """Make the cases of the family."""
    for flat in (0.9, 0.99, 0.999):
        yield Case(f"sharp-{flat:g}", hard_scene(f"sharp-{flat:g}", 0.4, 4.0, flat=flat))
