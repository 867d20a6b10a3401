"""One proportional change of the loads: the first loading of a contact without shear, or half a steady cycle, which is
a first loading under twice the bound. Scaled: lengths by a, tractions by f p0, slip by A f p0 a."""

from dataclasses import dataclass, replace

import numpy as np

from partialslip.arrays import Array
from partialslip.gradual import left_end_turns, turns_round
from partialslip.halfplane.contact import Contact
from partialslip.halfplane.shape import Shape
from partialslip.halfplane.slip import slip
from partialslip.halfplane.steady import NARROWEST, stick_zone
from partialslip.halfplane.traction import half_range
from partialslip.result import StickZone

_NOTHING = StickZone(0.0, 1.0, 1)


@dataclass(frozen=True)
class Loading:
    """Change of shear traction and slip due to one proportional change of the loads.

    Parameters
    ----------
    shape : Shape
    Qf, sf : float
        Magnitudes of the changes relative to the ``bound``: \\|dQ\\|/(bound f P) and 2 \\|dsigma\\|/(bound f p0).
    turn : int
        -1 if dQ < 0: q is reversed.
    mirror : int
        -1 if dQ and dsigma have opposite signs: x is mirrored.
    bound : int
        Largest change of traction, in f p: 1 for a first loading, 2 for half a cycle.
    zone : StickZone
        Stick zone for positive changes of both loads, on the mirrored pressure; ``ends`` has the mirrored one.
    """

    shape: Shape
    Qf: float
    sf: float
    turn: int
    mirror: int
    bound: int
    zone: StickZone[float]

    @property
    def seen(self) -> Shape:
        """Pressure over the mirrored x, on which both changes of the loads are positive."""
        return self.shape if self.mirror > 0 else self.shape.mirrored

    @property
    def ends(self) -> tuple[float, float]:
        """Left and right end of the stick zone, for the signs of the loads."""
        zone = self.zone._replace(centre=self.mirror * self.zone.centre)
        return zone.left, zone.right

    @property
    def signs(self) -> tuple[int, int]:
        """Signs of the change of traction in the left and the right slip zone."""
        left, right = (self.turn * int(self.zone.s), self.turn)[:: self.mirror]
        return left, right

    @property
    def nothing(self) -> bool:
        """Whether no load changes."""
        return self.Qf == 0 and self.sf == 0

    def traction(self, x: Array) -> Array:
        """Change of shear traction at ``x``, in f p0."""
        if self.nothing:
            return np.zeros_like(x)
        return self.turn * self.bound * half_range(self.mirror * x, self.zone, self.seen)

    def slip(self, x: Array) -> Array:
        """Slip at ``x``, in A f p0 a."""
        if self.nothing:
            return np.zeros_like(x)
        return self.turn * self.bound / 2 * slip(self.mirror * x, self.zone, self.seen)

    def left_end_turns(self, half_width: float | None = None) -> bool:
        """Whether slip in the left slip zone reverses under gradual loading before the stick zone has ``half_width``
        (default: the final one); see :func:`partialslip.gradual.left_end_turns`."""
        half_width = self.zone.half_width if half_width is None else half_width
        return left_end_turns(self.Qf, self.sf, self.zone.s, half_width)

    @property
    def certificate(self) -> dict[str, float]:
        """Residuals of the loads of the stick zone: ``tension`` in f p0, or relative if sf > 1, and ``shear`` in 2 f P.

        The narrowest stick zone stands for all larger tensions. Near sliding, 1 - Qf is known only to the rounding of
        dQ, which the tension residual therefore leaves out.
        """
        c, sf, Qf = self.zone.half_width, self.sf, self.Qf
        found = self.seen.conditions(*map(np.array, (1 + self.zone.centre - c, c, self.zone.s)))
        tension = 0.0 if c <= NARROWEST and sf > found.sf else abs(float(found.sf) - sf) / max(sf, 1.0)
        rounding = np.finfo(float).eps / max(1 - Qf, np.finfo(float).eps)
        return {"tension": max(tension - float(rounding), 0.0), "shear": abs(float(found.Qf) - Qf)}

    @property
    def turns_round(self) -> bool:
        """Whether slip reverses during half a cycle of gradual loading; see :func:`partialslip.gradual.turns_round`."""
        return turns_round(self.Qf, self.sf, self.zone.s, self.zone.centre, self.zone.half_width)


def loading(pressed: Contact, f: float, dQ: float, dsigma: float, bound: int) -> Loading:
    """Loading by ``dQ`` (N/m) and ``dsigma`` (Pa) of any sign, with |dQ| < ``bound`` f P."""
    Qf, sf = abs(dQ) / (bound * f * pressed.P), 2 * abs(dsigma) / (bound * f * pressed.p0)
    turn = -1 if dQ < 0 else 1
    mirror = turn * (-1 if dsigma < 0 else 1)
    found = Loading(pressed.shape, Qf, sf, turn, mirror, bound, _NOTHING)
    return replace(found, zone=stick_zone(Qf, sf, found.seen)) if Qf or sf else found
