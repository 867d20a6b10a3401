"""Shear tractions at the load points of a steady cycle that gradual loads reach from zero. Scaled as in
:mod:`partialslip.halfplane.shape`, tractions by f p0.

A steady cycle fixes the change of q. What is locked in where no point slips depends on the loads before the cycle: they
are followed here, from a contact without shear to load point 2, and then cycle by cycle, until q repeats.
"""

import numpy as np

from partialslip.halfplane.gradual_path.certificate import certify, stages
from partialslip.halfplane.gradual_path.graded import Smooth
from partialslip.halfplane.gradual_path.half_cycle import HalfCycle
from partialslip.halfplane.gradual_path.stage import Loads, LostError
from partialslip.halfplane.gradual_path.tractions import Piece, Tractions

MOST_LOADS = 30  # limit: loads that tend to the steady state more slowly are not followed
_REPEATS = 1e-10  # accuracy: change of q over a cycle, in f p0, that is none: states are interpolated to this tolerance
_NEARLY = 1e-6  # accuracy: the same that is none where no more cycles follow
_HELD = 1e-6  # limit: violation of a condition, in f p0, above which a way does not hold
_SHARES = (0.05, 0.5, 1.0)  # accuracy: stages in a phase at which the conditions are checked
_PLACES = np.cos(np.linspace(np.pi, 0, 257))[1:-1]


def from_zero(first: Loads, steady: HalfCycle, cycles: int) -> tuple[Tractions, tuple[float, float] | None]:
    """Return the tractions at load point 2 of the cycle whose change from load point 1 to 2 is that of ``steady``, and
    the ends of the interval that has never slipped (None if every point has).

    Parameters
    ----------
    first : Loads
        Loads at load point 2, to which the path goes first; of one sign.
    steady : HalfCycle
        Half cycle to which half cycles tend.
    cycles : int
        Most cycles.

    Raises
    ------
    LostError
        If the loads at load point 2 differ in sign, the way is lost or does not hold, or q does not repeat.
    """
    shape, sign = steady.start.shape, -1 if min(first) < 0 else 1
    first = Loads(*(sign * load for load in first))
    if min(first) < 0:
        raise LostError("the loads at load point 2 and their changes differ in sign")
    nothing = Tractions.of(shape, [Piece(-1.0, 1.0, 0.0, Smooth(-1.0, 1.0, lambda low, high: 0 * (low + high)))])
    way = HalfCycle(first, nothing, steady.middle)
    ways, q, guess, change = [_checked(way)], way.last.q if sign > 0 else -way.last.q, steady, np.inf
    for _ in range(cycles):
        back = HalfCycle(steady.loads, -q, guess)  # to load point 1; the signs of loads and tractions are reversed
        way = guess = HalfCycle(steady.loads, -back.last.q, back)
        ways += [back, way]
        if change > _NEARLY:  # later cycles repeat the one that was checked
            _checked(back), _checked(way)
        before, q = q, way.last.q
        change = np.abs(q(_PLACES) - before(_PLACES)).max()
        if change < _REPEATS:
            break
    if change > _NEARLY:
        raise LostError(f"q does not repeat after {cycles} cycles")
    lows, highs = zip(*(each.stuck for each in ways), strict=True)
    low, high = max(lows), min(highs)
    return q, ((low, high) if low < high else None)


def _checked(way: HalfCycle) -> HalfCycle:
    """The ``way``, if the conditions of stick and slip hold on it."""
    if not max(certify(way.loads, stages(way, _SHARES))[:4]) < _HELD:
        raise LostError("the conditions of stick and slip do not hold")
    return way
