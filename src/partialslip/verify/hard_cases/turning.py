"""Hard cases: slip that turns round on the way, at the borders of what the stick zone does."""

from collections.abc import Iterator, Mapping
from typing import Any

from partialslip.verify.case import Case
from partialslip.verify.hard_cases.scenes import MANY_CYCLES, hard_scene

TITLE = "Slip that turns round on the way: zones that drift, and zones inside that slip"
HARD = """
Between the load points the stick zone drifts: it takes points back on one side that have slipped, and then leaves
them again, or a part of it slips the other way for a while and sticks again. The tractions at the load points do not
show it. One load step ends with another m, off by 3e-4 to 0.11 a in these cases. The ends of the stick zone that have
drifted are flat: |dq| meets its bound with the power 3/2, so that m read from the traction is poor. The cases are
beside the borders: where the drift begins, where it ends before the loads do, and where a zone inside begins to slip.
In one case loads with a mean lock in shear of half of the bound before the cycle is steady; its accuracy is 1e-3, as
cycles are many.
"""

_LOADS = {  # Q_f, s_f
    "begins": (0.55, 2.3),
    "ends": (0.55, 4.4),
    "drifts": (0.55, 7.0),
    "opens": (0.55, 9.5),
    "parts": (0.75, 6.0),
}
_ACCURACY: Mapping[str, Any] = {"accuracy": 1e-4}  # ends that have drifted are flat


def cases() -> Iterator[Case]:
    """Make the cases of the family."""
    for name, (Qf, sf) in _LOADS.items():
        yield Case(f"turning-{name}", hard_scene(f"turning-{name}", Qf, sf, fem=_ACCURACY))
    name = "turning-mean"
    yield Case(name, hard_scene(name, *_LOADS["drifts"], Q_mean=0.05, sigma_mean=0.5, fem=MANY_CYCLES))
