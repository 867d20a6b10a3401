"""Stick zones of the steady state under gradual loads, of many loads at once; SI units."""

import numpy as np
import numpy.typing as npt

from partialslip.arrays import Array
from partialslip.errors import InputError
from partialslip.gradual import turns_round
from partialslip.halfplane.contact import Contact, one_step_zone
from partialslip.halfplane.gradual_table import tabled
from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.turning import half_cycle
from partialslip.result import StickZone


def stick_zone(
    contact: Contact,
    f: npt.ArrayLike,
    dQ: npt.ArrayLike,
    dsigma: npt.ArrayLike,
    dslope: npt.ArrayLike = 0.0,
    *,
    checked: bool = True,
) -> StickZone[Array]:
    """Stick zones of the steady state under gradual loads, m; arrays of the broadcast shape.

    A stick zone is the zone of the tractions: \\|dq\\| is less than 2 f p between the load points. Where slip does not
    turn round on the way it follows from the consistency conditions (:func:`one_step_zone`), a million in about a
    second. Elsewhere (docs/theory.md, section 7) arrays of loads of a Hertz contact take their zones from a table,
    within 1e-6 a of the solver, where it has them; it goes up to dsigma = 10.4 f p0. Where an inner zone slips it has
    only loads up to 9.2 f p0 under which all points that slipped inside slip again at the left. Each other pair of
    loads, and a single pair, takes the solver, one after the other: about half a second, one to twenty where an inner
    zone slips. A thousand of these take an hour, so leave them out of large arrays: they are those for which
    :func:`partialslip.halfplane.gradual_table.tabled` has NaN.

    Where the loads of an array make the contact slide, \\|dQ\\| >= 2 f P, the stick zone is NaN, and
    :attr:`StickZone.slides` is true. Numbers give numbers; a single pair of loads that slides is an error.

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

    Where the zone under gradual loads is not known, it is NaN with s not 0; an error for numbers.

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
            found.s,
        )
        turned &= np.isnan(centre)
    for index in map(tuple, np.argwhere(turned)):
        cycle = half_cycle(contact, *(float(load[index]) for load in loads))
        if not cycle.holds and turned.ndim == 0:
            raise InputError(
                f"dQ = {dQ_}, dsigma = {dsigma_}: slip turns round on the way, and the zone of gradual loads is not "
                "known; one_step_zone has that of a single step"
            )
        known = cycle.zone if cycle.holds else StickZone(np.nan, np.nan, cycle.zone.s)
        centre[index] = contact.centre + cycle.mirror * known.centre * contact.a
        half_width[index], s[index] = known.half_width * contact.a, known.s
    return StickZone(centre[()], half_width[()], s[()])
