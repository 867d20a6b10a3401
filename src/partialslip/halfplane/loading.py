"""One straight change of the loads: the first loading of a contact without shear, or the way between the load points
of a steady cycle, which is the same under twice the bound. Scaled: lengths by a, tractions by f p0, slip by
A f p0 a."""

from dataclasses import dataclass

import numpy as np

from partialslip.arrays import Array
from partialslip.gradual import left_end_turns, turns_round
from partialslip.halfplane.contact import Contact
from partialslip.halfplane.shape import Shape
from partialslip.halfplane.slip import slip
from partialslip.halfplane.steady import stick_zone
from partialslip.halfplane.traction import half_range
from partialslip.result import StickZone

_NOTHING = StickZone(0.0, 1.0, 1)


@dataclass(frozen=True)
class Loading:
    """The change of shear traction that one change of the loads makes, with its stick zone.

    Parameters
    ----------
    shape : Shape
    Qf, sf : float
        Sizes of the changes, as shares of the ``bound``: \\|dQ\\|/(bound f P) and 2 \\|dsigma\\|/(bound f p0).
    turn : int
        -1 where dQ < 0: q is turned round.
    mirror : int
        -1 where dQ and dsigma pull opposite ways: x is mirrored.
    bound : int
        The largest change of traction, in f p: 1 in a first loading, 2 between the load points of a cycle.
    zone : StickZone
        For positive changes of both loads; ``left`` and ``right`` are its ends as they are.
    """

    shape: Shape
    Qf: float
    sf: float
    turn: int
    mirror: int
    bound: int
    zone: StickZone[float]

    @property
    def ends(self) -> tuple[float, float]:
        """Left and right end of the stick zone."""
        zone = self.zone._replace(centre=self.mirror * self.zone.centre)
        return zone.left, zone.right

    @property
    def signs(self) -> tuple[int, int]:
        """Signs of the change on the left and on the right of the stick zone."""
        left, right = (self.turn * int(self.zone.s), self.turn)[:: self.mirror]
        return left, right

    @property
    def nothing(self) -> bool:
        """Whether no load changes."""
        return self.Qf == 0 and self.sf == 0

    def traction(self, x: Array) -> Array:
        """The change of shear traction at ``x``, in f p0."""
        if self.nothing:
            return np.zeros_like(x)
        return self.turn * self.bound * half_range(self.mirror * x, self.zone, self.shape)

    def slip(self, x: Array) -> Array:
        """Slip at ``x``, in A f p0 a."""
        if self.nothing:
            return np.zeros_like(x)
        return self.turn * self.bound / 2 * slip(self.mirror * x, self.zone, self.shape)

    def left_end_turns(self, half_width: float | None = None) -> bool:
        """Whether the slip zone on the left turns round on a gradual way, down to ``half_width``, as a rule that of the
        stick zone (:func:`partialslip.gradual.left_end_turns`)."""
        half_width = self.zone.half_width if half_width is None else half_width
        return left_end_turns(self.Qf, self.sf, self.zone.s, half_width)

    @property
    def turns_round(self) -> bool:
        """Whether slip turns round on a gradual way, if what slips at its end does so in a cycle
        (:func:`partialslip.gradual.turns_round`)."""
        return turns_round(self.Qf, self.sf, self.zone.s, self.zone.centre, self.zone.half_width)


def loading(pressed: Contact, f: float, dQ: float, dsigma: float, bound: int) -> Loading:
    """The change by ``dQ`` (N/m) and ``dsigma`` (Pa), of any signs, with |dQ| < ``bound`` f P."""
    Qf, sf = abs(dQ) / (bound * f * pressed.P), 2 * abs(dsigma) / (bound * f * pressed.p0)
    turn = -1 if dQ < 0 else 1
    mirror = turn * (-1 if dsigma < 0 else 1)
    zone = stick_zone(Qf, sf, pressed.shape) if Qf or sf else _NOTHING
    return Loading(pressed.shape, Qf, sf, turn, mirror, bound, zone)
