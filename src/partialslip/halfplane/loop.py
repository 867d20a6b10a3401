"""Hysteresis loops of a steady cycle: shear force over displacement, and moment of shear over tension; SI units."""

from typing import NamedTuple

import numpy as np

from partialslip.halfplane.contact import Contact, one_step_zone
from partialslip.halfplane.turning import Turning, half_cycle
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError
from partialslip.tools.shown import short

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)


class Loop(NamedTuple):
    """A steady cycle, from load point 1 to 2 and back: arrays (2 k - 1,).

    ``Q`` (N/m) and ``sigma`` (Pa) are relative to load point 1. ``displacement`` (m) is the relative displacement of
    the bodies due to slip: the total less that of the adhered contact, which depends on the point of measurement (like
    (A/pi) log of its distance). ``moment`` (N) is int x q dx, the conjugate of A sigma/4. The energy dissipated per
    cycle is the area of both loops, int Q d(displacement) + (A/4) int moment d(sigma).
    """

    Q: Array
    sigma: Array
    displacement: Array
    moment: Array

    def __repr__(self) -> str:
        return short(self)


def hysteresis(contact: Contact, A: float, f: float, dQ: float, dsigma: float, count: int = 51) -> Loop:
    """Hysteresis loop for proportional loading between the load points.

    At the share r of (dQ, dsigma), let the stick zone have the half-width c and the centre e. A further increment adds
    the adhered traction of this stick zone, so that

        d(displacement)/dr = (A/pi) dQ ln(a/c) - (A/4) dsigma e,    d(moment)/dr = dQ e + (pi/8) dsigma c^2.

    Where slip reverses between the load points, displacement and moment follow from the tractions of gradual loads
    (docs/theory.md, section 7); where these are not known, the loop is that of single steps.

    Parameters
    ----------
    contact : Contact
    A : float
        Compliance of the pair of materials, 1/Pa (:attr:`partialslip.scene.Material.A`).
    f, dQ, dsigma : float
        As for :func:`partialslip.halfplane.stick_zone`.
    count : int
        Points on each branch.

    Raises
    ------
    InputError
        As :func:`partialslip.halfplane.stick_zone`, and if count < 2.
    """
    if count < 2:
        raise InputError(f"count = {count}: must be >= 2")
    one_step_zone(contact, f, dQ, dsigma)  # refuses loads under which the contact slides
    share = np.linspace(0, 1, count)
    # closer points near the end, where the stick zone may shrink fast
    ends = 1 - (1 - share) ** 2
    cycle = half_cycle(contact, f, dQ, dsigma)
    if isinstance(cycle, Turning):
        stress = f * contact.p0
        scales = A * stress * contact.a, stress * contact.a**2
        loading = [scale * values for scale, values in zip(scales, cycle.loop(ends), strict=True)]
    else:
        loading = _shrinking(contact, A, f, dQ, dsigma, ends)
    returning = [path[-1] - path[1:] for path in (ends, *loading)]
    way, displacement, moment = (np.concatenate(pair) for pair in zip((ends, *loading), returning, strict=True))
    return Loop(way * dQ, way * dsigma, displacement, moment)


def _shrinking(contact: Contact, A: float, f: float, dQ: float, dsigma: float, ends: Array) -> list[Array]:
    """Displacement and moment at the shares ``ends`` of the changes, from stick zones that only shrink."""
    half = np.diff(ends)[:, None] / 2
    zone = one_step_zone(contact, f, *((ends[:-1, None] + half * (1 + _NODES)) * change for change in (dQ, dsigma)))
    rates = (
        A / np.pi * dQ * np.log(contact.a / zone.half_width) - A / 4 * dsigma * zone.centre,
        dQ * zone.centre + np.pi / 8 * dsigma * zone.half_width**2,
    )
    return [np.concatenate([[0.0], np.cumsum((half * rate) @ _WEIGHTS)]) for rate in rates]
