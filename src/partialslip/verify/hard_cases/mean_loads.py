"""Hard cases: mean loads at 0.5, 0.9, 0.98 and 1.02 of the largest in a steady state."""

from collections.abc import Iterator

from partialslip.halfplane.hertz import Hertz
from partialslip.halfplane.loading import half_cycle
from partialslip.verify.case import Case
from partialslip.verify.hard_cases.scenes import MANY_CYCLES, hard_scene

TITLE = "Mean loads at 0.5, 0.9, 0.98 and 1.02 of the largest in a steady state"
HARD = """
The shear that the first cycles lock in determines q at either load point. The range of q tends to the steady range,
more slowly the nearer the mean load is to the bound. Beyond the bound every cycle adds slip. Codes that stop after
the usual two or three cycles report a transient as steady. Codes that read the stick zone from the flags of one
instant find it far too small. If the history is not committed at the end of an increment, the contact ratchets below
the bound, too. The accuracy is 1e-3: the first cycles take many steps.
"""


def cases() -> Iterator[Case]:
    """Make the cases of the family."""
    bound = half_cycle(0.3, 4.0, Hertz()).mean_load_bound
    for share in (0.5, 0.9, 0.98, 1.02):
        name = f"mean-load-{share:g}"
        yield Case(
            name, hard_scene(name, 0.3, 4.0, Q_mean=share * bound, sigma_mean=3.0, load={"cycles": 60}, fem=MANY_CYCLES)
        )
