"""The permanent stick zone of the steady state (paper, sections 3 and 4), scaled as in
:mod:`partialslip.halfplane.shape`."""

import math
from collections.abc import Callable

import numpy as np

from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.shape import NARROW, Conditions, Shape
from partialslip.halfplane.slip import slips_on
from partialslip.halfplane.traction import within_bound
from partialslip.result import StickZone
from partialslip.tools.arrays import Array, Indices, Mask

NARROWEST = 1e-100  # limit: half-width: smaller stick zones are reported with this one
TOO_STEEP = (
    "exact does not hold: the tension varies so much along x that points inside slip before the ends do; use march"
)
UNEVEN_FRICTION = (
    "friction.f: must vary less along x for exact: points inside slip before the ends do or stick in slip zones, and "
    "more than one zone sticks; use march"
)
_CHUNK = 2**14  # cost: stick zones at a time: their arrays fit the processor's cache
_CLOSE = 1e-9  # accuracy: Newton step after which only rounding errors remain
_SETTLED = 1e-13  # accuracy: residual of Qf
_ROUNDING = 4 * np.finfo(float).eps
_STEPS = 100  # cost: Newton steps before bracketing
_HELD = 1e-9  # limit: residual of loads above which no stick zone is found
_FEWER = 2**10  # cost: stick zones at a time whose tractions are compared with the bound


def steady_stick_zone(Qf: float, sf: float, shape: Shape, gf: float = 0.0) -> StickZone[float]:
    """Stick zone of one set of loads; see :func:`stick_zones`."""
    centre, half_width, s = stick_zones(Qf, sf, shape, gf)
    return StickZone(float(centre), float(half_width), int(s))


def stick_zones(
    Qf: Array | float, sf: Array | float, shape: Shape, gf: Array | float = 0.0, checked: bool = True
) -> StickZone[Array]:
    """Stick zones for \\|``Qf``\\| < 1, ``sf`` >= 0 and Qf + ``gf``/8 >= 0, as fractions of a; arrays of the broadcast
    shape. NaN where gf is so large, or the friction bound so uneven, that there is no such stick zone.

    Other signs follow by symmetry: mirroring x reverses dQ and dslope and keeps dsigma; reversing q reverses all.
    Whether the zones hold under ``gf``, or under a bound that is not the pressure of a convex profile, takes most of
    the time and can be left unchecked, for iterates.

    Raises
    ------
    ValueError
        If a load is out of range.
    """
    Qf, sf, gf = np.broadcast_arrays(*(np.asarray(load, float) for load in (Qf, sf, gf)))
    if not ((np.abs(Qf) < 1) & (drive(Qf, gf) >= 0) & (sf >= 0)).all():
        raise ValueError("must be |Qf| < 1 (from 1 on the contact slides), sf >= 0, and Qf + gf/8 >= 0")
    edge, c = np.empty(Qf.size), np.empty(Qf.size)
    flat_Qf, flat_sf = Qf.ravel(), np.minimum(sf.ravel(), 1e5)  # above 1e5 all have half-width NARROWEST
    for sloped in (False, True):
        numbers = np.flatnonzero((gf.ravel() != 0) == sloped)
        for start in range(0, len(numbers), _CHUNK):
            part = numbers[start : start + _CHUNK]
            slope = gf.ravel()[part] if sloped else None
            # where there is no stick zone, iterates reach the contact's right end
            with np.errstate(divide="ignore" if sloped else None, invalid="ignore" if sloped else None):
                edge[part], c[part] = _edge_and_centre(flat_Qf[part], flat_sf[part], shape, slope, checked)
    centre, s = np.abs(edge) + c - 1, np.where(edge < 0, -1, 1)
    return StickZone(centre.reshape(Qf.shape), c.reshape(Qf.shape), s.reshape(Qf.shape))


def drive(Qf: Array | float, gf: Array | float) -> Array | float:
    """The part of the slip of both ends in the first moments of loading that is the same way: its sign is that of q at
    the end that slips first. Qf + gf/8, from the adhered traction (docs/theory.md, section 3)."""
    return Qf + gf / 8


def transition(Qf: Array | float, shape: Shape) -> Array:
    """dsigma/(f p0) at which small tension ends because the left slip zone vanishes (Hertz: paper, eq. (23))."""
    return _conditions(shape, 0.0, _touching(np.asarray(Qf, float), shape)).sf


def _edge_and_centre(
    Qf: Array, sf: Array, shape: Shape, gf: Array | None = None, checked: bool = True
) -> tuple[Array, Array]:
    """Solve for (s * edge, c) of each pair of loads by Newton's method, by bracketing where it does not converge; None
    for ``gf`` stands for zeros.

    The unknown s * edge passes smoothly through the transition: as tension grows, the left slip zone shrinks to nothing
    and grows again with the opposite slip, and the loads have a continuous derivative in s * edge. The derivative is
    known: an increment of the loads adds the adhered traction of the stick zone, singular at the zone's ends, and the
    ends move until the sum is bounded. Newton's unknown for the half-width is log c.
    """
    edge, c, exact = HertzShape().guess(Qf, sf) if gf is None else HertzShape().sloped_guess(Qf, sf, gf)
    active = np.flatnonzero(~exact | (not isinstance(shape, HertzShape)))
    last = _last(shape, gf)
    for _ in range(_STEPS):
        if not len(active):
            break
        e, width = edge[active], c[active]
        at = _conditions(shape, e, width, _of(gf, active))
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
        edge[active], c[active] = _bracketed(Qf[active], sf[active], shape, _of(gf, active))
    if checked and (gf is not None or not shape.convex):
        edge[~_holds(edge, c, Qf, sf, shape, np.zeros_like(Qf) if gf is None else gf)] = np.nan
        c[np.isnan(edge)] = np.nan
    return edge, c


def _holds(edge: Array, c: Array, Qf: Array, sf: Array, shape: Shape, gf: Array) -> Mask:
    """Whether the loads are those of the stick zones, whose ends are stiff, \\|dq\\| <= 2 f p in them, and all points
    beside them slip: where the tension or f varies too much along x, points inside slip before the ends do, or points
    in slip zones stick."""
    at, s = _conditions(shape, edge, c, gf), np.where(edge < 0, -1, 1)
    found = (np.abs(at.Qf - Qf) < _HELD) & ((np.abs(at.sf - sf) < _HELD * np.maximum(sf, 8)) | (c <= NARROWEST))
    found &= (at.right > 0) & (at.left > 0) & (c <= 1)
    zones = StickZone(np.abs(edge) + c - 1, c, s)
    numbers = np.flatnonzero(found)
    for start in range(0, len(numbers), _FEWER):
        part = numbers[start : start + _FEWER]
        found[part] = within_bound(StickZone(*(each[part] for each in zones)), shape, gf[part])
    if not shape.convex:
        for number in np.flatnonzero(found).tolist():  # a zone takes as long as all its places together
            zone = StickZone(float(zones.centre[number]), float(c[number]), int(s[number]))
            found[number] = slips_on(zone, shape, float(gf[number]))
    return found


def admissible(zone: StickZone[float], shape: Shape, gf: float = 0.0) -> bool:
    """Whether \\|dq\\| <= 2 f p in a stick ``zone`` and all points beside it slip, under any bound."""
    one = StickZone(np.array([zone.centre]), np.array([zone.half_width]), np.array([zone.s]))
    return bool(within_bound(one, shape, np.array([gf]))[0]) and slips_on(zone, shape, gf)


def _of(gf: Array | None, numbers: Indices | Mask) -> Array | None:
    return None if gf is None else gf[numbers]


def _bracketed(Qf: Array, sf: Array, shape: Shape, gf: Array | None = None) -> tuple[Array, Array]:
    """Solve for (s * edge, c) by two nested root searches on decreasing functions."""
    touching = _touching(Qf, shape, gf)
    edge, c = np.empty_like(Qf), np.empty_like(Qf)
    small = sf <= _conditions(shape, 0.0, touching, gf).sf
    if small.any():
        edge[small], c[small] = _bracketed_small(Qf[small], sf[small], shape, _of(gf, small))
    if not small.all():
        large = ~small
        edge[large], c[large] = _bracketed_large(Qf[large], sf[large], touching[large], shape, _of(gf, large))
    return edge, c


def _bracketed_small(Qf: Array, sf: Array, shape: Shape, gf: Array | None) -> tuple[Array, Array]:
    """Small tension: sf fixes ``edge`` at a given c; along this line Qf decreases with c, up to the c at which the
    stick zone touches the contact's end."""
    last, slope = _last(shape, gf), () if gf is None else (gf,)

    def edge(c: Array, sf: Array, *gf: Array) -> Array:
        def excess(way: Array, c: Array, sf: Array, *gf: Array) -> Array:
            return _conditions(shape, (1 - c) * way, c, *gf).sf - sf

        return (1 - c) * _root(excess, 0 * c, last + 0 * c, c, sf, *gf)

    def excess(log_c: Array, Qf: Array, sf: Array, *gf: Array) -> Array:
        c = np.exp(log_c)
        return _conditions(shape, edge(c, sf, *gf), c, *gf).Qf - Qf

    low = math.log(NARROWEST) + 0 * sf
    widest = _root(lambda log_c, sf, *gf: _conditions(shape, 0.0, np.exp(log_c), *gf).sf - sf, low, 0 * sf, sf, *slope)
    c = np.exp(_root(excess, low, widest, Qf, sf, *slope))
    return edge(c, sf, *slope), c


def _bracketed_large(Qf: Array, sf: Array, touching: Array, shape: Shape, gf: Array | None) -> tuple[Array, Array]:
    """Large tension: Qf fixes ``edge`` at a given c (``way``: 0 at the contact's left end, 1 in the middle, 2 at the
    right end); along this line sf decreases with c, up to the c at which the stick zone touches the contact's end."""
    last, slope = _last(shape, gf), () if gf is None else (gf,)

    def edge(c: Array, Qf: Array, *gf: Array) -> Array:
        def excess(way: Array, c: Array, Qf: Array, *gf: Array) -> Array:
            # in the middle of an even pressure dQ = 0, unless the tension varies along x
            middle = shape.even & (way == 1) & (not gf)
            return np.where(middle, 0.0, _conditions(shape, (c - 1) * way, c, *gf).Qf) - Qf

        return (c - 1) * _root(excess, 0 * c, last + 0 * c, c, Qf, *gf)

    def excess(log_c: Array, Qf: Array, sf: Array, *gf: Array) -> Array:
        c = np.exp(log_c)
        return _conditions(shape, edge(c, Qf, *gf), c, *gf).sf - sf

    c = np.exp(_root(excess, math.log(NARROWEST) + 0 * Qf, np.log(touching), Qf, sf, *slope))
    return edge(c, Qf, *slope), c


def _last(shape: Shape, gf: Array | None) -> int:
    """Largest ``edge`` of the stick zones, in 1 - c: under an even pressure their centres are on the left, unless the
    tension varies along x."""
    return 1 if shape.even and gf is None else 2


def _touching(Qf: Array, shape: Shape, gf: Array | None = None) -> Array:
    """Half-width of the stick zone that touches the contact's end, at the transition to large tension."""
    if isinstance(shape, HertzShape):
        stiffness = 1.0 if gf is None else 1 + gf / 8
        return np.maximum(np.sqrt((1 - Qf) / stiffness), NARROWEST)  # paper, eq. (22)
    low, slope = math.log(NARROWEST) + 0 * Qf, () if gf is None else (gf,)
    return np.exp(
        _root(lambda log_c, Qf, *gf: _conditions(shape, 0.0, np.exp(log_c), *gf).Qf - Qf, low, 0 * Qf, Qf, *slope)
    )


def _conditions(shape: Shape, edge: Array | float, c: Array, gf: Array | None = None) -> Conditions:
    edge = edge + 0 * c
    s = np.where(edge < 0, -1, 1)
    found = shape.conditions(np.abs(edge), c, s)
    return found if gf is None else found.sloped(gf, np.abs(edge), c, s)


def _root(function: Callable[..., Array], low: Array, high: Array, *args: Array) -> Array:
    """Roots of decreasing functions; an end of the bracket if the function does not change sign within it."""
    from scipy.optimize.elementwise import find_root  # takes long to import

    with np.errstate(invalid="ignore"):  # find_root divides 0 by 0 in intervals of rounding size
        found = find_root(function, (low, high), args=args)
    return np.where(found.success, found.x, np.where(found.f_bracket[1] >= 0, high, low))
