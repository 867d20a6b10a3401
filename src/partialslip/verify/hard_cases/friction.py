"""Hard cases: coefficients of friction of 1e-3 and 10."""

from collections.abc import Iterator

from partialslip.verify.case import Case
from partialslip.verify.hard_cases.scenes import hard_scene

TITLE = "Coefficients of friction of 1e-3 and 10"
HARD = """
Between similar bodies, results scaled by f do not depend on f. A difference between the two cases therefore shows a
bound or a tolerance in the wrong units. At 1e-3, shear tractions are not solved at all if their tolerance has the
scale of the pressure. A large f makes fixed-point iterations between pressure and shear diverge, although similar
bodies need no such iteration.
"""


def cases() -> Iterator[Case]:
    """Make the cases of the family."""
    for f in (1e-3, 10.0):
        yield Case(f"friction-{f:g}", hard_scene(f"friction-{f:g}", f=f))
