"""Changes of shear between two loads: what is common to a single step and to the way of gradual loads. Scaled: lengths
by a, tractions by f p0, slip by A f p0 a."""

from abc import ABC, abstractmethod
from dataclasses import dataclass

from partialslip.halfplane.contact import Contact
from partialslip.halfplane.shape import Shape
from partialslip.halfplane.slip import Worn
from partialslip.result import StickZone
from partialslip.tools.arrays import Array


@dataclass(frozen=True)
class Change(ABC):
    """Change of shear traction and slip between two loads.

    Parameters
    ----------
    shape : Shape
    Qf, sf : float
        Changes relative to the ``bound``: turn dQ/(bound f P) and 2 \\|dsigma\\|/(bound f p0), in the contact's middle.
    turn : int
        -1 if dQ < 0 (with a slope, if :func:`partialslip.halfplane.steady.drive` < 0): q is reversed.
    mirror : int
        -1 if the sign of dsigma is not ``turn``: x is mirrored.
    bound : int
        Largest change of traction, in f p: 1 for a first loading, 2 for half a cycle.
    zone : StickZone
        Stick zone of the tractions for positive changes of both loads, on the mirrored pressure; ``ends`` has the
        mirrored one.
    gf : float
        Change of the tension along x, turn 2 a dslope/(bound f p0).
    """

    shape: Shape
    Qf: float
    sf: float
    turn: int
    mirror: int
    bound: int
    zone: StickZone[float]
    gf: float

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
    def nothing(self) -> bool:
        """Whether no load changes."""
        return self.Qf == 0 and self.sf == 0 and self.gf == 0

    @property
    def holds(self) -> bool:
        """Whether this is what gradual loads give."""
        return True

    @property
    def one_way(self) -> bool:
        """Whether dq has one sign, so that gross sliding is all that bounds the mean of Q."""
        return False

    @property
    def permanent(self) -> tuple[float, float] | None:
        """Ends of the zone of points that never slip, for the signs of the loads; None if there are none."""
        return self.ends

    @property
    def breaks(self) -> list[float]:
        """Places at which the change of traction is not smooth, ascending."""
        return list(self.ends)

    @abstractmethod
    def traction(self, x: Array) -> Array:
        """Change of shear traction at ``x``, in f p0."""

    def within(self, contact: Contact, f: float, x: Array) -> Array:
        """Change of shear traction at ``x`` (m) in a ``contact``, Pa."""
        return f * contact.p0 * self.traction(contact.scaled(x))

    @property
    @abstractmethod
    def certificate(self) -> dict[str, float]:
        """Residuals of the loads."""

    @property
    @abstractmethod
    def mean_load_bound(self) -> float:
        """Largest \\|Q_mean\\|/(f P) of a steady state whose half cycle this is."""

    @property
    @abstractmethod
    def worn(self) -> Worn:
        """Slip over half a cycle, and the energy that a cycle dissipates."""
