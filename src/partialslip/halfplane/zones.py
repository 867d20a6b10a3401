"""Stick zones of the steady state under gradual loads, of many loads at once; SI units."""

import numpy as np
import numpy.typing as npt

from partialslip.halfplane.contact import Contact, one_step_zone
from partialslip.halfplane.gradual_table import tabled
from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.turning import Turning, half_cycle
from partialslip.result import StickZone
from partialslip.scene.gradual import turns_round
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError


def stick_zone(
    contact: Contact,
    f: npt.ArrayLike,
    dQ: npt.ArrayLike,
    dsigma: npt.ArrayLike,
    dslope: npt.ArrayLike = 0.0,
    *,
    checked: bool = True,
) -> StickZone[Array]:
    r"""Stick zones of the steady state under gradual loads, m; arrays of the broadcast shape.

    A point is in the stick zone if \|dq\| < 2 f p between the load points. Without slip reversal the zone follows from
    the consistency conditions (:func:`one_step_zone`), about 1e6 pairs of loads per second. With slip reversal
    (docs/theory.md, section 7) arrays of loads of a Hertz contact take it from a table, within 1e-6 a; other profiles
    need the solver, 0.5 s a pair. An inner slip zone is in the table up to 9.2 f p0 if all its points slip again at the
    left; elsewhere an array has NaN, and a single pair takes the solver 1 to 20 s. Loads with \|dQ\| >= 2 f P slide:
    NaN and :attr:`StickZone.slides` in an array, an error for a single pair.

    Parameters
    ----------
    contact : Contact
    f : array_like
        Coefficient of friction; :attr:`Contact.f` where it varies along x.
    dQ, dsigma : array_like
        Changes of the shear force (N/m) and of the differential bulk tension (Pa) over half a cycle, of any sign.
    dslope : array_like
        Change of sigma_slope, Pa/m, of any sign: the change of tension at x is dsigma + dslope x. Zones of loads with a
        slope are those of a single step.
    checked : bool
        As of :func:`one_step_zone`.

    Where the zone under gradual loads is not known, or takes a solver for each pair, it is NaN with s not 0; an error
    for numbers if it is not known.

    Raises
    ------
    InputError
        As :func:`one_step_zone`, and if all loads are numbers and the zone is not known.
    """
    zone = one_step_zone(contact, f, dQ, dsigma, dslope, checked=checked)
    loads = np.broadcast_arrays(*(np.asarray(load, float) for load in (f, dQ, dsigma, dslope)))
    f_, dQ_, dsigma_, dslope_ = loads
    Qf, sf = np.abs(dQ_) / (2 * f_ * contact.P), np.abs(dsigma_) / (f_ * contact.p0)
    turned = turns_round(Qf, sf, zone.s, -np.abs(zone.centre - contact.centre) / contact.a, zone.half_width / contact.a)
    turned = (turned | (not contact.friction_bound.convex)) & (dslope_ == 0) & ~np.isnan(zone.half_width)
    if not turned.any():
        return zone
    centre, half_width, s = (np.array(values) for values in zone)
    if turned.ndim and isinstance(contact.friction_bound, HertzShape):
        found = tabled(Qf[turned], sf[turned])
        side = contact.a * np.where(dQ_ * dsigma_ < 0, -1, 1)[turned]
        centre[turned], half_width[turned], s[turned] = (
            contact.centre + side * found.centre,
            contact.a * found.half_width,
            np.where(found.s == 0, s[turned], found.s),
        )
        turned[:] = False
    parts = turned.ndim == 0 or not contact.friction_bound.convex
    for index in map(tuple, np.argwhere(turned)):
        known, mirror = _zone_and_mirror(contact, [float(load[index]) for load in loads], parts)
        if turned.ndim == 0 and np.isnan(known.half_width):
            raise InputError(
                f"dQ = {dQ_}, dsigma = {dsigma_}: slip turns round on the way, and the zone of gradual loads is not "
                "known; one_step_zone has that of a single step"
            )
        centre[index] = contact.centre + mirror * known.centre * contact.a
        half_width[index], s[index] = known.half_width * contact.a, known.s
    return StickZone(centre[()], half_width[()], s[()])


def _zone_and_mirror(contact: Contact, loads: list[float], parts: bool) -> tuple[StickZone[float], int]:
    """The stick zone under ``loads``, for positive changes, and -1 if x is mirrored; NaN if it is not known, or,
    without ``parts``, if a zone inside slips."""
    try:
        cycle = half_cycle(contact, *loads, parts=parts)
    except InputError:  # more than one zone sticks on the way
        return StickZone(np.nan, np.nan, 1), 1
    if not cycle.holds or (not parts and isinstance(cycle, Turning) and cycle.way.opens):
        return StickZone(np.nan, np.nan, cycle.zone.s), cycle.mirror
    return cycle.zone, cycle.mirror
