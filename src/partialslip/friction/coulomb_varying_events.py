"""Coulomb friction along a path on which the pressure varies, event by event.

Scaled as in :mod:`partialslip.friction.history`.
"""

import itertools
from dataclasses import replace

from partialslip.friction.coulomb_legs import Legs
from partialslip.friction.history import History
from partialslip.friction.load_path import Missed, Path
from partialslip.friction.normal import Presses
from partialslip.tools.arrays import Array

_REPEATS = 1e-12  # accuracy: change of q over a cycle, in f p, that is rounding of the events


def march(tangential: Array, stretch: Array, f: Array, press: Presses, path: Path, few: int = 0) -> History:
    """Follow the path leg by leg; every leg has a certificate.

    Parameters
    ----------
    tangential, stretch, f, press, path
        As for :func:`partialslip.friction.coulomb_varying_pressure.march`.
    few : int
        Nodes that may slip both ways where slip does not reverse, as for
        :func:`partialslip.friction.coulomb_constant_pressure.march`.

    Raises SlidesError if no node sticks.
    """
    loads = [(load[3], load[4]) for load in (path.begin, path.cycle[-1], *path.cycle)]
    pressed = [press.way(begin, end) for begin, end in itertools.pairwise(loads)]
    settling = replace(path, settled=max(path.settled, _REPEATS))
    history = Legs(tangential, stretch, f, pressed, settling, few).followed()
    return replace(history, path=replace(path, turns=history.turns, missed=Missed(0.0, 0.0)))
