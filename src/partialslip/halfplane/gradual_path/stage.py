"""Loads of half a cycle, and states along its way; scaled as in :mod:`partialslip.halfplane.shape`."""

import math
from collections.abc import Iterable
from typing import NamedTuple

from partialslip.halfplane.gradual_path.retreat import Zone
from partialslip.halfplane.gradual_path.tractions import Tractions


class LostError(ValueError):
    """The phases of the half cycle cannot be followed."""


class Loads(NamedTuple):
    """Changes of the tension and of the shear force in half a cycle, in f p0 and f p0 a; neither is negative."""

    tension: float
    shear: float

    @property
    def least(self) -> float:
        """Half-width c* of a stick zone at whose left end the rate of q is not singular."""
        return 4 * self.shear / (math.pi * self.tension) if self.tension else math.inf


class Stage(NamedTuple):
    """State at a stage of the half cycle: share ``progress`` of the loads, stick ``zone`` and tractions ``q``. Within
    the stick zone, an ``inner`` zone may slip."""

    progress: float
    zone: Zone
    q: Tractions
    inner: Zone | None = None

    @property
    def sticks(self) -> tuple[Zone, ...]:
        """Intervals that stick, from left to right."""
        if not self.inner:
            return (self.zone,)
        return Zone(self.zone.left, self.inner.left), Zone(self.inner.right, self.zone.right)


def lasting(before: Stage, after: Stage) -> list[Zone]:
    """Intervals that stick from one stage to a later one; between both, no other phase begins. Points that change from
    the left interval to the right one, where a zone between them slips, do not stick. That zone has closed if its width
    is 0 at the last stage of the phase, and if there is none any more, the left interval has vanished."""
    early, late = before.sticks, after.sticks
    if before.inner and before.inner.right > before.inner.left and not after.inner:
        pairs = [(early[1], after.zone)]
    elif len(early) == len(late):
        pairs = list(zip(early, late, strict=True))
    else:
        pairs = [(one, other) for one in early for other in late]
    return common_zones(pairs)


def common_zones(pairs: Iterable[tuple[Zone, Zone]]) -> list[Zone]:
    """Intervals that both zones of a pair have in common."""
    found = (Zone(max(one.left, other.left), min(one.right, other.right)) for one, other in pairs)
    return [zone for zone in found if zone.right > zone.left]
