"""How the ends of a contact slip in a cycle under varying pressure."""

import numpy as np

from partialslip.arrays import Array
from partialslip.friction.history import History
from partialslip.friction.zone_ends import StickInterval
from partialslip.result import EndSlip

_MANY = 2  # accuracy: nodes of both contacts beside the stick zone from which on the end slips throughout
_SLIPS = 1e-6  # accuracy: slip in a cycle, in the largest possible slip, above rounding


def end_slips(x: Array, history: History, stick: StickInterval) -> tuple[EndSlip, EndSlip]:
    """How the left and the right end of the contact slip from load point 1 to 2, from a ``history`` at the nodes ``x``
    (n,), ascending, and its ``stick`` zone.

    An end slips forwards or backwards where nodes that are always in contact slip beside the stick zone. Otherwise the
    stick zone reaches as far as both contacts do, and nodes beside it may slip during part of the cycle.
    """
    assert history.slipped is not None
    most = _SLIPS * float(np.maximum(*history.bounds).sum())
    always = (history.bounds[0] > 0) & (history.bounds[1] > 0)
    found: list[EndSlip] = []
    for outside, places in ((x < stick.left, slice(None)), (x > stick.right, slice(None, None, -1))):
        beside = np.flatnonzero(outside & always)[places]
        if len(beside) >= _MANY:
            found.append("forwards" if history.change[beside[0]] > 0 else "backwards")
        elif (history.slipped[:, outside] > most).any():
            found.append("part of the cycle")
        else:
            found.append("never")
    return found[0], found[1]
