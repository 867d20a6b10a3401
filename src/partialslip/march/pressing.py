"""The normal loads of a scene on the cells of marching: which part of the surfaces they cover, and forces on cells."""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from partialslip.friction.load_path import unscaled_pressing
from partialslip.friction.normal import Near, Presses
from partialslip.halfplane.contact import Contact, contact
from partialslip.halfplane.mean_pressure import Mean, common
from partialslip.march.cells import forces
from partialslip.scene import Scene
from partialslip.tools.arrays import Array

_STAGES = (0.25, 0.5, 0.75)  # accuracy: of the way between load points, at which the contact is looked up
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(6)


@dataclass(frozen=True)
class NormalLoads:
    """Contacts of ``scene`` under its normal loads.

    Parameters
    ----------
    scene : Scene
    frame : Contact
        All that is ever in contact, from centre - a to centre + a: the unit of lengths on the cells. Under constant
        pressure it is the contact.
    first, second : Contact
        Contacts at load points 1 and 2.
    """

    scene: Scene
    frame: Contact
    first: Contact
    second: Contact

    @classmethod
    def of(cls, scene: Scene) -> "NormalLoads":
        """The normal loads of ``scene``."""
        if not scene.presses_anew:
            pressed = contact(scene)
            return cls(scene, pressed, pressed, pressed)
        points = scene.pressing
        first, second = (contact(scene, pressing) for pressing in scene.end_pressing)
        between = [
            one.towards(other, share)
            for one, other in itertools.pairwise((points[-1], *points))
            for share in (*_STAGES, 1.0)
        ]
        ends = np.array([contact(scene, pressing).ends for pressing in dict.fromkeys(between)])
        left, right = float(ends[:, 0].min()), float(ends[:, 1].max())
        centre = first.centre if scene.even else (left + right) / 2
        return cls(
            scene, Contact((right - left) / 2, scene.P, Mean(first, second), centre, layer=first.layer), first, second
        )

    @property
    def largest(self) -> Contact:
        """Contact of the load point with the larger P, whose a and p0 scale the results."""
        return (self.first, self.second)[self.scene.largest - 1]

    @property
    def last(self) -> Contact:
        """Contact at the last load point, with which the path begins and ends."""
        return contact(self.scene, self.scene.pressing[-1]) if self.scene.presses_anew else self.frame

    @property
    def ends(self) -> list[float]:
        """Ends of the contacts at the load points, scaled, ascending."""
        if not self.scene.presses_anew:
            return [-1.0, 1.0]
        scaled = np.clip(self.frame.scaled([*self.first.ends, *self.second.ends, *self.last.ends]), -1.0, 1.0)
        return np.union1d(scaled, [-1.0, 1.0]).tolist()

    @property
    def common(self) -> tuple[float, float]:
        """Ends, scaled, of what is in contact at both load points."""
        if not self.scene.presses_anew:
            return -1.0, 1.0
        left, right = self.frame.scaled(common(self.first, self.second)).tolist()
        return left, right

    def within(self, points: Sequence[float]) -> list[float]:
        """Those ``points`` (m) that lie in the frame, scaled."""
        scaled = self.frame.scaled(points)
        return scaled[np.abs(scaled) < 1].tolist()

    def forces(self, of: Contact, vertices: Array) -> Array:
        """Normal forces (c,) of the contact ``of`` on the cells between ``vertices`` (c + 1,), in P of the scene."""
        if of is self.frame:
            return forces(of.shape, vertices)
        return of.P / self.scene.P * forces(of.shape, of.scaled(self.frame.places(vertices)))

    def presses(self, vertices: Array, compliance: Array) -> Presses:
        """The contact problem of the cells, with the ``compliance`` (c, c) of half-planes. Pressure and shear must be
        in equilibrium on the same cells, as the displacements with which cells touch are those of the pressure times a
        factor."""
        scene, places = self.scene, self.frame.places(vertices)
        middle, half = (places[1:] + places[:-1]) / 2, np.diff(places)[:, None] / 2
        if self.frame.layer:
            compliance = compliance + self.frame.layer.added(places, "normal")
        gap = scene.profile.gap_at(middle[:, None] + half * _NODES) @ (_WEIGHTS / 2)
        unit = scene.material.A * scene.P  # of displacement
        arms = None if scene.M is None else (middle - scene.origin) / scene.length

        def start(P: float, M: float) -> Near:
            """The cells that half-planes have in contact, and their angle."""
            found = contact(scene, unscaled_pressing(scene, P, M))
            left, right = found.ends
            sides = np.where((middle > left) & (middle < right), 0, -1).astype(np.int8)
            return sides, found.tilt * scene.length / unit

        return Presses(compliance, gap / unit, arms, start)
