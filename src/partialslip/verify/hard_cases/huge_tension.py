"""Hard cases: huge tension: stick zones of 1e-3 to 1e-8 of a, off the middle."""

from collections.abc import Iterator

import numpy as np

from partialslip.halfplane.hertz import Hertz
from partialslip.verify.case import Case
from partialslip.verify.hard_cases.scenes import MANY_STEPS, hard_scene

TITLE = "Huge tension: stick zones of 1e-3 to 1e-8 of a, off the middle"
HARD = """
The stick zone never vanishes. It shrinks exponentially, but not to the middle of the contact. The sum m + n cancels.
Elliptic integrals whose modulus tends to one lose all digits if they take the modulus instead of the complementary
modulus. On a mesh the zone is smaller than the distance of two nodes. Solvers that need one sticking node to fix the
rigid motion get a singular matrix, others cycle, and some report m = n = 0 at the middle. Under gradual loads the
tiny zone moves along the contact, and slip reverses behind it. One step, and even four, end with the tractions of the
closed form. Only some twenty and more steps follow the zone, and then m differs by 0.02 to 0.06 a. March with refined
steps is the reference, and the accuracy is 1e-2.
"""


def cases() -> Iterator[Case]:
    """Make the cases of the family."""
    for power in (3, 5, 8):
        name, c = f"huge-tension-1e-{power}", 10.0**-power
        loads = Hertz().conditions(np.array(0.7 - c), np.array(c), np.array(-1))  # centre -0.3 a
        yield Case(name, hard_scene(name, float(loads.Qf), float(loads.sf), fem=MANY_STEPS))
