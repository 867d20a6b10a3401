"""The permanent stick zone of the steady state (paper, sections 3 and 4), scaled as in
:mod:`partialslip.halfplane.shape`."""

import math

from partialslip.halfplane.shape import LOG_TINY, Shape, StickZone, root


def stick_zone(Qf: float, sf: float, shape: Shape) -> StickZone:
    """Stick zone for 0 <= ``Qf`` < 1 and ``sf`` >= 0.

    Other signs follow: mirroring x turns dQ round and keeps dsigma, turning q round turns both round.

    Raises
    ------
    ValueError
        For other loads.
    """
    if not (0 <= Qf < 1 and sf >= 0):
        raise ValueError(f"Qf = {Qf}, sf = {sf}: must be 0 <= Qf < 1 (from 1 on the contact slides) and sf >= 0")
    return shape.small(Qf, sf) if sf <= transition(Qf, shape) else _large_tension(Qf, sf, shape)


def transition(Qf: float, shape: Shape) -> float:
    """dsigma/(f p0) at which small tension ends: the left slip zone has gone (for Hertz the paper's eq. (23))."""
    return shape.loads(0.0, shape.touching(Qf), 1)[0]


def _large_tension(Qf: float, sf: float, shape: Shape) -> StickZone:
    """Solve the consistency conditions with opposite signs of slip.

    At a given half-width c the condition on dQ fixes how far the zone lies from the contact's end (0 .. 1 of the
    way to the middle), and along that line the tension falls as c grows, up to the transition, where the zone
    touches the end: two nested bracketed roots. The outer unknown is log c, because as tension grows the stick
    zone never vanishes: its half-width falls like exp(-pi dsigma/(16 f p(centre))).
    """

    def edge(c: float) -> float:
        def excess(way: float) -> float:
            return (shape.loads((1 - c) * way, c, -1)[1] if way < 1 else 0.0) - Qf  # in the middle dQ = 0

        return (1 - c) * root(excess, 0.0, 1.0) if Qf > 0 else 1 - c

    def excess(log_c: float) -> float:
        c = math.exp(log_c)
        return shape.loads(edge(c), c, -1)[0] - sf

    top = bottom = math.log(shape.touching(Qf))
    while bottom > LOG_TINY and excess(bottom) < 0:
        top, bottom = bottom, max(2 * bottom - 1, LOG_TINY)
    c = math.exp(root(excess, bottom, top))
    return StickZone(edge(c) + c - 1, c, -1)
