"""The permanent stick zone of the steady state (paper, sections 3 and 4), scaled as in
:mod:`partialslip.halfplane.shape`."""

import math
from collections.abc import Callable

import numpy as np
from scipy.optimize.elementwise import find_root

from partialslip.arrays import Array
from partialslip.halfplane.hertz import Hertz
from partialslip.halfplane.shape import NARROW, Conditions, Shape
from partialslip.result import StickZone

NARROWEST = 1e-100  # stick zones narrower than that are not told apart
_CHUNK = 2**14  # zones at a time: what they need stays in the processor's cache
_CLOSE = 1e-9  # after a Newton step as small as that, rounding is all that is left
_SETTLED = 1e-13
_ROUNDING = 4 * np.finfo(float).eps
_STEPS = 40


def stick_zone(Qf: float, sf: float, shape: Shape) -> StickZone[float]:
    """The stick zone for 0 <= ``Qf`` < 1 and ``sf`` >= 0; see :func:`stick_zones`."""
    centre, half_width, s = stick_zones(Qf, sf, shape)
    return StickZone(float(centre), float(half_width), int(s))


def stick_zones(Qf: Array | float, sf: Array | float, shape: Shape) -> StickZone[Array]:
    """Centres, half-widths and s of the stick zones for many loads, of the shape to which these broadcast.

    For 0 <= ``Qf`` < 1 and ``sf`` >= 0. Other signs follow: mirroring x turns dQ round and keeps dsigma, turning q
    round turns both round.

    Raises
    ------
    ValueError
        For other loads.
    """
    Qf, sf = np.broadcast_arrays(np.asarray(Qf, float), np.asarray(sf, float))
    if not ((Qf >= 0) & (Qf < 1) & (sf >= 0)).all():
        raise ValueError("must be 0 <= Qf < 1 (from 1 on the contact slides) and sf >= 0")
    edge, c = np.empty(Qf.size), np.empty(Qf.size)
    flat_Qf, flat_sf = Qf.ravel(), np.minimum(sf.ravel(), 1e5)  # beyond, all are narrowest
    for start in range(0, Qf.size, _CHUNK):
        part = slice(start, start + _CHUNK)
        edge[part], c[part] = _solve(flat_Qf[part], flat_sf[part], shape)
    centre, s = np.abs(edge) + c - 1, np.where(edge < 0, -1, 1)
    return StickZone(centre.reshape(Qf.shape), c.reshape(Qf.shape), s.reshape(Qf.shape))


def transition(Qf: Array | float, shape: Shape) -> Array:
    """dsigma/(f p0) at which small tension ends: the left slip zone has gone (for Hertz the paper's eq. (23))."""
    return _at(shape, 0.0, _touching(np.asarray(Qf, float), shape)).sf


def _solve(Qf: Array, sf: Array, shape: Shape) -> tuple[Array, Array]:
    """(s * edge, c) for each pair of loads, by Newton's method; where that does not end, by bracketing.

    s * edge is the one unknown that goes through the transition smoothly: as tension grows, the left slip zone
    shrinks to nothing and grows again with slip of the other sign, and the loads have a continuous derivative in it.
    The derivative is known: what is added to the loads adds the adhered traction of the stick zone, singular at its
    ends, and the ends move so that the sum is bounded. Narrow zones are taken by log c.
    """
    edge, c, exact = Hertz().guess(Qf, sf)
    active = np.flatnonzero(~exact | (not isinstance(shape, Hertz)))
    for _ in range(_STEPS):
        if not len(active):
            return edge, c
        e, width = edge[active], c[active]
        at = _at(shape, e, width)
        dQf, dsf = Qf[active] - at.Qf, sf[active] - at.sf
        to_n, to_edge = -(dQf / 2 + width * dsf / 8) / at.right, (dQf / 2 - width * dsf / 8) / at.left
        # of log c, for large tension in a form with nothing that cancels where c is small
        narrow = (dQf / 4 * at.skew - dsf / 16 * (at.right + at.left)) / (at.right * at.left)
        grow = np.where(e < 0, narrow, (to_n - to_edge) / (2 * width))
        grow = np.where((width <= NARROWEST) & (grow < 0), 0.0, grow)
        new = np.maximum(
            np.minimum(width * np.exp(np.clip(grow, np.log(width) / 2 - 1, 1.0)), (1 + width) / 2), NARROWEST
        )
        edge[active], c[active] = np.clip(e + to_edge, new - 1, 1 - new), new
        slip = 2 - 2 * width  # both slip zones together: what is small is small against that
        close = (np.abs(to_edge) < _CLOSE * slip + _ROUNDING) & (np.abs(grow) < _CLOSE * slip + _ROUNDING)
        # the step in log c leaves dQf out where skew is not known
        close &= (width > NARROW) | (np.abs(dQf) <= _SETTLED)
        exact = (np.abs(dQf) <= _ROUNDING) & (np.abs(dsf) <= _ROUNDING * np.maximum(sf[active], 8))
        active = active[~(close | exact)]
    if len(active):
        edge[active], c[active] = _bracketed(Qf[active], sf[active], shape)
    return edge, c


def _bracketed(Qf: Array, sf: Array, shape: Shape) -> tuple[Array, Array]:
    """(s * edge, c) by two nested searches, each for the root of a falling function."""
    touching = _touching(Qf, shape)
    edge, c = np.empty_like(Qf), np.empty_like(Qf)
    small = sf <= _at(shape, 0.0, touching).sf
    if small.any():
        edge[small], c[small] = _bracketed_small(Qf[small], sf[small], shape)
    if not small.all():
        edge[~small], c[~small] = _bracketed_large(Qf[~small], sf[~small], touching[~small], shape)
    return edge, c


def _bracketed_small(Qf: Array, sf: Array, shape: Shape) -> tuple[Array, Array]:
    """At a given half-width the tension fixes the place, and dQ falls as it grows, up to where the zone touches the
    contact's end."""

    def edge(c: Array, sf: Array) -> Array:
        return (1 - c) * _root(lambda way, c, sf: _at(shape, (1 - c) * way, c).sf - sf, 0 * c, 1 + 0 * c, c, sf)

    def excess(log_c: Array, Qf: Array, sf: Array) -> Array:
        c = np.exp(log_c)
        return _at(shape, edge(c, sf), c).Qf - Qf

    low = math.log(NARROWEST) + 0 * sf
    widest = _root(lambda log_c, sf: _at(shape, 0.0, np.exp(log_c)).sf - sf, low, 0 * sf, sf)
    c = np.exp(_root(excess, low, widest, Qf, sf))
    return edge(c, sf), c


def _bracketed_large(Qf: Array, sf: Array, touching: Array, shape: Shape) -> tuple[Array, Array]:
    """At a given half-width the condition on dQ fixes how far the zone lies from the contact's end (0 .. 1 of the
    way to the middle), and along that line the tension falls as c grows, up to where the zone touches the end."""

    def edge(c: Array, Qf: Array) -> Array:
        def excess(way: Array, c: Array, Qf: Array) -> Array:
            return np.where(way < 1, _at(shape, (c - 1) * way, c).Qf, 0.0) - Qf  # in the middle dQ = 0

        return (c - 1) * _root(excess, 0 * c, 1 + 0 * c, c, Qf)

    def excess(log_c: Array, Qf: Array, sf: Array) -> Array:
        c = np.exp(log_c)
        return _at(shape, edge(c, Qf), c).sf - sf

    c = np.exp(_root(excess, math.log(NARROWEST) + 0 * Qf, np.log(touching), Qf, sf))
    return edge(c, Qf), c


def _touching(Qf: Array, shape: Shape) -> Array:
    """Half-width of the zone that touches the contact's end: where small tension turns large."""
    low = math.log(NARROWEST) + 0 * Qf
    return np.exp(_root(lambda log_c, Qf: _at(shape, 0.0, np.exp(log_c)).Qf - Qf, low, 0 * Qf, Qf))


def _at(shape: Shape, edge: Array | float, c: Array) -> Conditions:
    edge = edge + 0 * c
    return shape.conditions(np.abs(edge), c, np.where(edge < 0, -1, 1))


def _root(function: Callable[..., Array], low: Array, high: Array, *args: Array) -> Array:
    """Where falling functions change sign; an end of the bracket where rounding, or a limit, leaves no change."""
    with np.errstate(invalid="ignore"):  # its own, where an interval has shrunk to rounding
        found = find_root(function, (low, high), args=args)
    result: Array = np.where(found.success, found.x, np.where(found.f_bracket[1] >= 0, high, low))
    return result
