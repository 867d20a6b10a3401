"""Stresses in the half-planes, on their surfaces and inside, at the load points of fully reversed loads; SI units."""

from functools import cached_property

import numpy as np
import numpy.typing as npt

from partialslip.arrays import Array
from partialslip.halfplane.cauchy import Cauchy
from partialslip.halfplane.contact import Contact, stick_zone
from partialslip.halfplane.loading import loading
from partialslip.halfplane.traction import half_range
from partialslip.result import StickZone
from partialslip.result.points import AtPoints

_SURFACE = 1e-30  # depth of points on the surface, as a fraction of a
_APART = 1e-12  # distance below which breaks are merged, as a fraction of a


class Stress:
    """Stresses of the steady state between -(dQ, dsigma)/2 at load point 1 and (dQ, dsigma)/2 at load point 2.

    The lower body, y <= 0, exerts q on the upper body and carries all of the bulk tension. The loads must be fully
    reversed: under mean loads the first cycles lock in a traction that the steady state does not determine.

    Parameters
    ----------
    contact : Contact
    f : float
        Coefficient of friction.
    dQ, dsigma, dslope : float
        Changes of the shear force (N/m), of the differential bulk tension (Pa) and of its slope (Pa/m) over half a
        cycle, of any sign.

    Raises
    ------
    InputError
        As :func:`partialslip.halfplane.stick_zone`.
    """

    def __init__(self, contact: Contact, f: float, dQ: float, dsigma: float, dslope: float = 0.0) -> None:
        self.contact, self.f, self.dQ, self.dsigma, self.dslope = contact, f, dQ, dsigma, dslope
        self._zone = stick_zone(contact, f, dQ, dsigma, dslope)

    def surface(self, x: npt.ArrayLike) -> Array:
        """sigma_xx (Pa) along the surfaces at ``x``, m: (2, 2, ...), by body (lower, upper), load point and the shape
        of ``x``.

        Continuous; usually largest at the trailing edge of the contact, where the slope is infinite.
        """
        found: Array = AtPoints(self._on_surfaces)(x)
        return found

    def inside(self, x: npt.ArrayLike, y: npt.ArrayLike) -> Array:
        """sigma_xx, sigma_yy and sigma_xy (Pa) at the points (``x``, ``y``), m: (2, 3, ...), by load point, component
        and the common shape of ``x`` and ``y``. Points with y <= 0 are in the lower body."""
        found: Array = AtPoints(lambda x, y: self._at(x, np.abs(y), np.where(y <= 0, 1.0, -1.0)))(x, y)
        return found

    def _on_surfaces(self, x: Array) -> Array:
        return np.stack([self._at(x, 0 * x, side)[:, 0] for side in (np.ones_like(x), -np.ones_like(x))])

    def _at(self, x: Array, depth: Array, side: Array) -> Array:
        """Stresses (2, 3, k), Pa, in the lower (``side`` = 1) and the upper body (-1).

        Let P = (1/pi) int p dt/(t - z), T the same of q, z = x - i depth and y = -depth. In the lower body

            sigma_xx = Im P + y Re P' - 2 Re T + y Im T',    sigma_yy = Im P - y Re P' - y Im T',
            sigma_xy = Im T - y Im P' + y Re T'

        (Muskhelishvili, Some basic problems of the mathematical theory of elasticity). The upper body is the mirror
        image of the lower body under the opposite q.
        """
        y = -depth / self.contact.a
        (P, T), (P_z, T_z) = self._cauchy(self.contact.scaled(x) + 1j * np.minimum(y, -_SURFACE))
        along = y * T_z.imag - 2 * T.real
        sticks = (y == 0) & (np.abs(x - self._zone.centre) <= self._zone.half_width)
        unit = self.f * self.contact.p0
        pressure = self.contact.p0 * np.stack([P.imag + y * P_z.real, P.imag - y * P_z.real, -side * y * P_z.imag])
        shear = unit * np.stack([side * along, -side * y * T_z.imag, T.imag + y * T_z.real])
        # no relative strain in the stick zone: the bodies share the tension
        tension = self.dsigma + self.dslope * x
        shear[0] = np.where(sticks, -side * tension / 4, shear[0]) + np.where(side > 0, tension / 2, 0.0)
        if self.dslope:  # sigma_xx = s x is in equilibrium with sigma_xy = -s y
            shear[2] += np.where(side > 0, self.dslope / 2 * depth, 0.0)
        return np.stack([pressure - shear, pressure + shear])

    @cached_property
    def _cauchy(self) -> Cauchy:
        """Cauchy integrals of p/p0 and q/(f p0) at load point 2, lengths scaled by a."""
        shape = self.contact.shape
        change = loading(self.contact, self.f, self.dQ, self.dsigma, self.dslope, bound=2)
        turn, mirror = change.turn, change.mirror
        centre, c = float(self.contact.scaled(self._zone.centre)), float(self._zone.half_width) / self.contact.a
        zone, seen = StickZone(mirror * centre, c, int(self._zone.s)), shape if mirror > 0 else shape.mirrored
        ends = [centre - c, centre + c] if c > _APART else [centre]
        inner = np.sort([place for place in (*shape.kinks, *ends) if abs(place) < 1 - _APART])
        inner = inner[np.diff(inner, prepend=-1.0) > _APART]
        return Cauchy(
            lambda x: np.stack([shape.pressure(x), turn * half_range(mirror * x, zone, seen, change.gf)]),
            np.concatenate([[-1.0], inner, [1.0]]),
        )
