"""The permanent stick zone of the steady state (paper, sections 3 and 4), scaled as in
:mod:`partialslip.halfplane.shape`."""

import math
from collections.abc import Callable

import numpy as np

from partialslip.arrays import Array
from partialslip.halfplane.hertz import Hertz
from partialslip.halfplane.shape import NARROW, Conditions, Shape
from partialslip.result import StickZone

NARROWEST = 1e-100  # half-width: smaller stick zones are reported with this one
_CHUNK = 2**14  # stick zones at a time: their arrays fit the processor's cache
_CLOSE = 1e-9  # Newton step after which only rounding errors remain
_SETTLED = 1e-13  # residual of Qf
_ROUNDING = 4 * np.finfo(float).eps
_STEPS = 40  # Newton steps before bracketing


def stick_zone(Qf: float, sf: float, shape: Shape) -> StickZone[float]:
    """Stick zone for 0 <= ``Qf`` < 1 and ``sf`` >= 0; see :func:`stick_zones`."""
    centre, half_width, s = stick_zones(Qf, sf, shape)
    return StickZone(float(centre), float(half_width), int(s))


def stick_zones(Qf: Array | float, sf: Array | float, shape: Shape) -> StickZone[Array]:
    """Stick zones for 0 <= ``Qf`` < 1 and ``sf`` >= 0, as fractions of a; arrays of the broadcast shape.

    Other signs follow by symmetry: mirroring x reverses dQ and keeps dsigma; reversing q reverses both.

    Raises
    ------
    ValueError
        If a load is out of range.
    """
    Qf, sf = np.broadcast_arrays(np.asarray(Qf, float), np.asarray(sf, float))
    if not ((Qf >= 0) & (Qf < 1) & (sf >= 0)).all():
        raise ValueError("must be 0 <= Qf < 1 (from 1 on the contact slides) and sf >= 0")
    edge, c = np.empty(Qf.size), np.empty(Qf.size)
    flat_Qf, flat_sf = Qf.ravel(), np.minimum(sf.ravel(), 1e5)  # above 1e5 all have half-width NARROWEST
    for start in range(0, Qf.size, _CHUNK):
        part = slice(start, start + _CHUNK)
        edge[part], c[part] = _solve(flat_Qf[part], flat_sf[part], shape)
    centre, s = np.abs(edge) + c - 1, np.where(edge < 0, -1, 1)
    return StickZone(centre.reshape(Qf.shape), c.reshape(Qf.shape), s.reshape(Qf.shape))


def transition(Qf: Array | float, shape: Shape) -> Array:
    """dsigma/(f p0) at which small tension ends because the left slip zone vanishes (Hertz: paper, eq. (23))."""
    return _at(shape, 0.0, _touching(np.asarray(Qf, float), shape)).sf


def _solve(Qf: Array, sf: Array, shape: Shape) -> tuple[Array, Array]:
    """Solve for (s * edge, c) of each pair of loads by Newton's method, by bracketing where it does not converge.

    The unknown s * edge passes smoothly through the transition: as tension grows, the left slip zone shrinks to nothing
    and grows again with the opposite slip, and the loads have a continuous derivative in s * edge. The derivative is
    known: an increment of the loads adds the adhered traction of the stick zone, singular at the zone's ends, and the
    ends move until the sum is bounded. Newton's unknown for the half-width is log c.
    """
    edge, c, exact = Hertz().guess(Qf, sf)
    active = np.flatnonzero(~exact | (not isinstance(shape, Hertz)))
    last = _last(shape)
    for _ in range(_STEPS):
        if not len(active):
            return edge, c
        e, width = edge[active], c[active]
        at = _at(shape, e, width)
        dQf, dsf = Qf[active] - at.Qf, sf[active] - at.sf
        to_n, to_edge = -(dQf / 2 + width * dsf / 8) / at.right, (dQf / 2 - width * dsf / 8) / at.left
        # step of log c; for large tension in a form without cancellation at small c
        narrow = (dQf / 4 * at.skew - dsf / 16 * (at.right + at.left)) / (at.right * at.left)
        grow = np.where(e < 0, narrow, (to_n - to_edge) / (2 * width))
        grow = np.where((width <= NARROWEST) & (grow < 0), 0.0, grow)
        new = np.maximum(
            np.minimum(width * np.exp(np.clip(grow, np.log(width) / 2 - 1, 1.0)), (1 + width) / 2), NARROWEST
        )
        edge[active], c[active] = np.clip(e + to_edge, last * (new - 1), last * (1 - new)), new
        slip = 2 - 2 * width  # both slip zones together: the scale of the tolerances
        close = (np.abs(to_edge) < _CLOSE * slip + _ROUNDING) & (np.abs(grow) < _CLOSE * slip + _ROUNDING)
        # the step of log c leaves out dQf where skew is unknown
        close &= (width > NARROW) | (np.abs(dQf) <= _SETTLED)
        exact = (np.abs(dQf) <= _ROUNDING) & (np.abs(dsf) <= _ROUNDING * np.maximum(sf[active], 8))
        active = active[~(close | exact)]
    if len(active):
        edge[active], c[active] = _bracketed(Qf[active], sf[active], shape)
    return edge, c


def _bracketed(Qf: Array, sf: Array, shape: Shape) -> tuple[Array, Array]:
    """Solve for (s * edge, c) by two nested root searches on decreasing functions."""
    touching = _touching(Qf, shape)
    edge, c = np.empty_like(Qf), np.empty_like(Qf)
    small = sf <= _at(shape, 0.0, touching).sf
    if small.any():
        edge[small], c[small] = _bracketed_small(Qf[small], sf[small], shape)
    if not small.all():
        edge[~small], c[~small] = _bracketed_large(Qf[~small], sf[~small], touching[~small], shape)
    return edge, c


def _bracketed_small(Qf: Array, sf: Array, shape: Shape) -> tuple[Array, Array]:
    """Small tension: sf fixes ``edge`` at a given c; along this line Qf decreases with c, up to the c at which the
    stick zone touches the contact's end."""
    last = _last(shape)

    def edge(c: Array, sf: Array) -> Array:
        return (1 - c) * _root(lambda way, c, sf: _at(shape, (1 - c) * way, c).sf - sf, 0 * c, last + 0 * c, c, sf)

    def excess(log_c: Array, Qf: Array, sf: Array) -> Array:
        c = np.exp(log_c)
        return _at(shape, edge(c, sf), c).Qf - Qf

    low = math.log(NARROWEST) + 0 * sf
    widest = _root(lambda log_c, sf: _at(shape, 0.0, np.exp(log_c)).sf - sf, low, 0 * sf, sf)
    c = np.exp(_root(excess, low, widest, Qf, sf))
    return edge(c, sf), c


def _bracketed_large(Qf: Array, sf: Array, touching: Array, shape: Shape) -> tuple[Array, Array]:
    """Large tension: Qf fixes ``edge`` at a given c (``way``: 0 at the contact's left end, 1 in the middle, 2 at the
    right end); along this line sf decreases with c, up to the c at which the stick zone touches the contact's end."""
    last = _last(shape)  # in the middle of an even pressure, dQ = 0

    def edge(c: Array, Qf: Array) -> Array:
        def excess(way: Array, c: Array, Qf: Array) -> Array:
            return np.where(shape.even & (way == 1), 0.0, _at(shape, (c - 1) * way, c).Qf) - Qf

        return (c - 1) * _root(excess, 0 * c, last + 0 * c, c, Qf)

    def excess(log_c: Array, Qf: Array, sf: Array) -> Array:
        c = np.exp(log_c)
        return _at(shape, edge(c, Qf), c).sf - sf

    c = np.exp(_root(excess, math.log(NARROWEST) + 0 * Qf, np.log(touching), Qf, sf))
    return edge(c, Qf), c


def _last(shape: Shape) -> int:
    """Largest ``edge`` of the stick zones, in 1 - c: under an even pressure their centres are on the left."""
    return 1 if shape.even else 2


def _touching(Qf: Array, shape: Shape) -> Array:
    """Half-width of the stick zone that touches the contact's end, at the transition to large tension."""
    if isinstance(shape, Hertz):
        return np.maximum(np.sqrt(1 - Qf), NARROWEST)  # paper, eq. (22)
    low = math.log(NARROWEST) + 0 * Qf
    return np.exp(_root(lambda log_c, Qf: _at(shape, 0.0, np.exp(log_c)).Qf - Qf, low, 0 * Qf, Qf))


def _at(shape: Shape, edge: Array | float, c: Array) -> Conditions:
    edge = edge + 0 * c
    return shape.conditions(np.abs(edge), c, np.where(edge < 0, -1, 1))


def _root(function: Callable[..., Array], low: Array, high: Array, *args: Array) -> Array:
    """Roots of decreasing functions; an end of the bracket if the function does not change sign within it."""
    from scipy.optimize.elementwise import find_root  # takes long to import

    with np.errstate(invalid="ignore"):  # find_root divides 0 by 0 in intervals of rounding size
        found = find_root(function, (low, high), args=args)
    result: Array = np.where(found.success, found.x, np.where(found.f_bracket[1] >= 0, high, low))
    return result
