"""Hard cases: two hundred cycles at 0.995 of the largest mean load."""

from collections.abc import Iterator

from partialslip.halfplane.hertz import Hertz
from partialslip.halfplane.loading import half_cycle
from partialslip.verify.case import Case
from partialslip.verify.hard_cases.scenes import MANY_CYCLES, hard_scene

TITLE = "Two hundred cycles at 0.995 of the largest mean load"
HARD = """
Errors of the steps add up. A loose friction tolerance gives a little slip in every cycle, which looks like
ratcheting. A cycle that repeats to rounding is the steady state, and partialslip skips the remaining cycles. The
accuracy is 1e-3.
"""


def cases() -> Iterator[Case]:
    """Make the cases of the family."""
    bound = half_cycle(0.3, 4.0, Hertz()).mean_load_bound
    scene = hard_scene(
        "cycles-200", 0.3, 4.0, Q_mean=0.995 * bound, sigma_mean=3.0, load={"cycles": 200}, fem=MANY_CYCLES
    )
    yield Case("cycles-200", scene)
