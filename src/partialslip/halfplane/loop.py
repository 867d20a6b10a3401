"""The hysteresis loop of the shear force over the displacement between the bodies, and the path of their shear's
moment; in SI units."""

from typing import NamedTuple

import numpy as np

from partialslip.arrays import Array
from partialslip.errors import InputError
from partialslip.halfplane.contact import Contact, stick_zone

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)


class Loop(NamedTuple):
    """A steady cycle, from load point 1 to 2 and back: (2 k - 1,) arrays each.

    ``Q`` (N/m) and ``sigma`` (Pa) are counted from load point 1. ``displacement`` (m) is that of one body against
    the other by slip alone: in excess of what the adhered contact, whose compliance depends on where it is measured
    (it grows like (A/pi) log of the distance), gives way elastically. ``moment`` (N) is int x q dx, the conjugate of
    A sigma/4: the cycle dissipates the area of both loops, int Q d(displacement) + (A/4) int moment d(sigma).
    """

    Q: Array
    sigma: Array
    displacement: Array
    moment: Array


def hysteresis(contact: Contact, A: float, f: float, dQ: float, dsigma: float, count: int = 51) -> Loop:
    """The loop on a straight path between the load points.

    Where the loads have come to the share r of (dQ, dsigma), they go on as the adhered tractions of the stick zone of
    that moment, half-width c and centre e. Its rates are

        d(displacement)/dr = (A/pi) dQ ln(a/c) - (A/4) dsigma e,    d(moment)/dr = dQ e + (pi/8) dsigma c^2.

    It is that of the steady state where slip does not turn round on the way (docs/theory.md, section 7).

    Parameters
    ----------
    contact : Contact
    A : float
        Compliance of the pair of materials, 1/Pa (:attr:`partialslip.scene.Material.A`).
    f, dQ, dsigma : float
        As for :func:`partialslip.halfplane.stick_zone`.
    count : int
        Points on either branch.

    Raises
    ------
    InputError
        As :func:`partialslip.halfplane.stick_zone`; and if count < 2.
    """
    if count < 2:
        raise InputError(f"count = {count}: must be >= 2")
    share = np.linspace(0, 1, count)
    # closer to the end, where the stick zone may shrink fast
    ends = 1 - (1 - share) ** 2
    half = np.diff(ends)[:, None] / 2
    zone = stick_zone(contact, f, *((ends[:-1, None] + half * (1 + _NODES)) * change for change in (dQ, dsigma)))
    rates = (
        A / np.pi * dQ * np.log(contact.a / zone.half_width) - A / 4 * dsigma * zone.centre,
        dQ * zone.centre + np.pi / 8 * dsigma * zone.half_width**2,
    )
    loading = [np.concatenate([[0.0], np.cumsum((half * rate) @ _WEIGHTS)]) for rate in rates]
    returning = [path[-1] - path[1:] for path in (ends, *loading)]
    way, displacement, moment = (np.concatenate(pair) for pair in zip((ends, *loading), returning, strict=True))
    return Loop(way * dQ, way * dsigma, displacement, moment)
