"""Stresses in the half-planes, on their surfaces and inside; SI units."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from partialslip.halfplane.cauchy import Cauchy
from partialslip.halfplane.change import Change
from partialslip.halfplane.contact import Contact, one_step_zone
from partialslip.halfplane.layer import Acting as Transformed
from partialslip.halfplane.layer import Along
from partialslip.halfplane.loading import Loading
from partialslip.halfplane.shape import rule_over
from partialslip.halfplane.sheared_layers import InLayers
from partialslip.halfplane.traction import half_range
from partialslip.halfplane.tractions import sample
from partialslip.halfplane.turning import Turned, Turning, half_cycle
from partialslip.result import StickZone, SurfaceStress
from partialslip.result.below import under_pressure, under_shear, under_tension
from partialslip.result.fields import AtPoints
from partialslip.tools.arrays import Array, Complex

_SURFACE = 1e-30  # accuracy: depth of points on the surface, as a fraction of a
_APART = 1e-12  # accuracy: distance below which breaks are merged, as a fraction of a
_ALONG = 1500  # cost: points along a surface with many breaks: each sees all panels of the contact
SURFACE_REACH = 4.0  # limit: half-widths up to which surface stresses are reported


@dataclass(frozen=True)
class Shear:
    """Shear traction of one proportional change of the loads, with which a contact slips up to f p; of half a cycle,
    which slips up to 2 f p, half of the change.

    Parameters
    ----------
    contact : Contact
    stick : StickZone
        Stick zone, m.
    turn, mirror, gf
        As of :class:`partialslip.halfplane.loading.Loading`.
    sigma, slope : float
        Change of the bulk tension at x = 0, Pa, and of its slope, Pa/m; of half a cycle, half of the change.
    """

    contact: Contact
    stick: StickZone[float]
    turn: int
    mirror: int
    gf: float
    sigma: float
    slope: float

    @classmethod
    def of(cls, contact: Contact, change: Loading, sigma: float, slope: float) -> "Shear":
        """Shear of ``change``, a loading of ``contact`` by the tension ``sigma`` and its ``slope``."""
        zone, share = change.zone, 1 / change.bound
        stick = StickZone(contact.centre + change.mirror * zone.centre * contact.a, zone.half_width * contact.a, zone.s)
        return cls(contact, stick, change.turn, change.mirror, change.gf, share * sigma, share * slope)

    @property
    def breaks(self) -> list[float]:
        """Ends of the stick zone, scaled; one place if the zone is too narrow."""
        centre, c = self._scaled
        return [centre - c, centre + c] if c > _APART else [centre]

    @property
    def _scaled(self) -> tuple[float, float]:
        return float(self.contact.scaled(self.stick.centre)), float(self.stick.half_width) / self.contact.a

    def traction(self, x: Array) -> Array:
        """q at ``x`` (scaled), in f p0."""
        centre, c = self._scaled
        bound = self.contact.friction_bound
        shape = bound if self.mirror > 0 else bound.mirrored
        zone = StickZone(self.mirror * centre, c, int(self.stick.s))
        return self.turn * half_range(self.mirror * x, zone, shape, self.gf)

    def stresses(self, unit: float, T: Complex, T_z: Complex, at: "Points") -> Array:
        """Stresses (3, k), Pa, at points, from the Cauchy integrals of q in ``unit``."""
        y = -at.depth / self.contact.a
        sticks = (y == 0) & (np.abs(at.x - self.stick.centre) <= self.stick.half_width)
        tension = self.sigma + self.slope * at.x
        found = unit * under_shear(T, y * T_z, at.side)
        # no relative strain in the stick zone: the bodies share the tension
        found[0] = np.where(sticks, -at.side * tension / 2, found[0])
        return found + under_tension(tension, self.slope, at.depth, at.side)


@dataclass(frozen=True)
class TurnedShear:
    """Shear traction ``share`` times that of ``change``, in which slip has reversed on the way, or of layers, under the
    bulk tension ``sigma`` (Pa)."""

    contact: Contact
    change: Turned | InLayers
    share: float
    sigma: float

    @property
    def breaks(self) -> list[float]:
        """Places at which q is not smooth, scaled."""
        return self.change.breaks

    def traction(self, x: Array) -> Array:
        """q at ``x`` (scaled), in f p0."""
        return self.share * self.change.traction(x)

    def stresses(self, unit: float, T: Complex, T_z: Complex, at: "Points") -> Array:
        """Stresses (3, k), Pa, at points, from the Cauchy integrals of q in ``unit``."""
        y = -at.depth / self.contact.a
        found = unit * under_shear(T, y * T_z, at.side)
        left, right = self.change.stuck or (math.inf, -math.inf)
        x = self.contact.scaled(at.x)
        sticks = (y == 0) & (x >= left) & (x <= right)
        found[0] = np.where(sticks, -at.side * self.sigma / 2, found[0])
        return found + under_tension(self.sigma + 0 * at.x, 0.0, at.depth, at.side)


def half_of(contact: Contact, change: Change | Turned, sigma: float, slope: float) -> Shear | TurnedShear:
    """Half of the shear of a ``change`` of a steady cycle, by the tension ``sigma`` and its ``slope``."""
    if isinstance(change, InLayers):
        return TurnedShear(contact, change, 1 / 2, sigma / 2)
    if isinstance(change, Loading):
        return Shear.of(contact, change, sigma, slope)
    assert isinstance(change, Turning | Turned)
    return TurnedShear(contact, change.whole if isinstance(change, Turning) else change, 1 / 2, sigma / 2)


def reached(contact: Contact, first: Loading | Turned, sigma: float, slope: float) -> Shear | TurnedShear:
    """Shear at a load point, ``first`` reached under the tension ``sigma`` and its ``slope``."""
    if isinstance(first, Loading) and not isinstance(first, InLayers):
        return Shear.of(contact, first, sigma, slope)
    return TurnedShear(contact, first, 1.0, sigma)


@dataclass(frozen=True)
class SlipZones:
    """Shear traction f p beside the ends of a contact, in the directions ``signs``: up to ``left`` and from ``right``
    on, scaled; none between them."""

    contact: Contact
    left: float
    right: float
    signs: tuple[int, int]

    @property
    def breaks(self) -> list[float]:
        """Inner ends of the zones, scaled."""
        return [self.left, self.right]

    def traction(self, x: Array) -> Array:
        """q at ``x`` (scaled), in f p0."""
        sign = np.where(x < self.left, self.signs[0], np.where(x > self.right, self.signs[1], 0))
        return sign * self.contact.friction_bound.pressure(x)

    def stresses(self, unit: float, T: Complex, T_z: Complex, at: "Points") -> Array:
        """Stresses (3, k), Pa, at points, from the Cauchy integrals of q in ``unit``."""
        return unit * under_shear(T, -at.depth / self.contact.a * T_z, at.side)


Acting = Shear | TurnedShear | SlipZones
_Acting = Contact | Acting
Integrals = dict[Cauchy, Complex]


class Points(NamedTuple):
    """Points ``x`` (k,), m, at ``depth`` (k,), m, in the lower (``side`` = 1) or the upper body (-1)."""

    x: Array
    depth: Array
    side: Array

    @classmethod
    def of(cls, x: Array, y: Array) -> "Points":
        """Points (``x``, ``y``); those of the lower body have y <= 0."""
        return cls(x, np.abs(y), np.where(y <= 0, 1.0, -1.0))

    @classmethod
    def on_both_sides(cls, x: Array) -> tuple["Points", "Points"]:
        """Points ``x`` on the surfaces of the lower and of the upper body."""
        return cls(x, 0 * x, np.ones_like(x)), cls(x, 0 * x, -np.ones_like(x))

    def scaled(self, contact: Contact) -> Complex:
        """x + i y, scaled by ``contact``, for Cauchy integrals."""
        return contact.scaled(self.x) + 1j * np.minimum(-self.depth / contact.a, -_SURFACE)


class StressState(NamedTuple):
    """Tractions at a moment: the contact that is ``pressed``, and the sum of ``shears``, each with its factor, in slip
    under f p, and of the bulk tension ``sigma`` (Pa) and its ``slope`` (Pa/m) that act without friction."""

    pressed: Contact
    shears: tuple[tuple[float, Acting], ...] = ()
    sigma: float = 0.0
    slope: float = 0.0


@dataclass(frozen=True)
class Fields:
    """Stresses of half-planes.

    The lower body, y <= 0, exerts q on the upper body and carries all of the bulk tension.

    Parameters
    ----------
    f : float
        Coefficient of friction.
    ends : tuple of StressState
        States at the load points, whose Cauchy integrals share panels.
    """

    f: float
    ends: tuple[StressState, ...]
    _known: dict[_Acting, tuple[Cauchy, int]] = field(default_factory=dict, repr=False, compare=False)
    _transforms: dict[_Acting, Transformed] = field(default_factory=dict, repr=False, compare=False)

    def surface(self, x: Array) -> Array:
        """sigma_xx (Pa) along the surfaces at ``x`` (k,), m: (2, 2, k), by body (lower, upper) and load point."""
        integrals: Integrals = {}
        return np.stack([self.at(side, self.ends, integrals)[:, 0] for side in Points.on_both_sides(x)])

    def at(self, at: "Points", states: Sequence[StressState], integrals: Integrals | None = None) -> Array:
        """sigma_xx, sigma_yy and sigma_xy (Pa) at k points: (s, 3, k), by state.

        Points on both sides of the surface have the same ``integrals``, which the first call puts in.
        """
        made: dict[_Acting, Array] = {}
        integrals = {} if integrals is None else integrals

        def stresses(of: _Acting) -> Array:
            if of not in made:
                contact = of if isinstance(of, Contact) else of.contact
                cauchy, row = self._cauchy(of)
                if cauchy not in integrals:
                    integrals[cauchy] = _integrals(cauchy, at, contact)
                value, slope = integrals[cauchy][:, row]
                if isinstance(of, Contact):
                    made[of] = of.p0 * under_pressure(value, -at.depth / of.a * slope, at.side)
                else:
                    made[of] = of.stresses(self._unit(contact), value, slope, at)
                if contact.layer:
                    along: Along = "normal" if isinstance(of, Contact) else "shear"
                    made[of] = made[of] + contact.layer.stresses(*at, self._seen_by_layers(of, contact), along)
            return made[of]

        result = np.empty((len(states), 3, len(at.x)))
        for found, state in zip(result, states, strict=True):
            found[:] = stresses(state.pressed)
            if state.shears:
                found += sum(factor * stresses(shear) for factor, shear in state.shears)
            if state.sigma or state.slope:
                found += under_tension(state.sigma + state.slope * at.x, state.slope, at.depth, at.side)
        return result

    def _unit(self, contact: Contact) -> float:
        """f p0, Pa."""
        return (contact.f if contact.bound else self.f) * contact.p0

    def _seen_by_layers(self, of: _Acting, contact: Contact) -> Transformed:
        """Pressure or shear as layers see it."""
        if of not in self._transforms:
            inner = [] if isinstance(of, Contact) else of.breaks
            x, weights = rule_over(np.unique(np.clip([-1.0, *contact.friction_bound.kinks, *inner, 1.0], -1, 1)))
            on = contact.p0 * of.shape.pressure(x) if isinstance(of, Contact) else self._unit(contact) * of.traction(x)
            assert contact.layer
            self._transforms[of] = Transformed.of(contact.layer, contact.places(x), contact.a * weights * on)
        return self._transforms[of]

    def _cauchy(self, of: _Acting) -> tuple[Cauchy, int]:
        """Cauchy integrals of p/p0 or q/(f p0), lengths scaled by a, and the row of these integrals."""
        if not self._known:
            self._add(*dict.fromkeys(each for state in self.ends for each in _summands(state)))
        if of not in self._known:
            self._add(of)
        return self._known[of]

    def _add(self, *all_: _Acting) -> None:
        groups: dict[Contact, list[_Acting]] = {}
        for each in all_:
            groups.setdefault(each if isinstance(each, Contact) else each.contact, []).append(each)
        for contact, group in groups.items():
            ends = [place for each in group if not isinstance(each, Contact) for place in each.breaks]
            inner = np.sort([place for place in (*contact.friction_bound.kinks, *ends) if abs(place) < 1 - _APART])
            inner = inner[np.diff(inner, prepend=-1.0) > _APART]
            rows = [each.shape.pressure if isinstance(each, Contact) else each.traction for each in group]
            cauchy = Cauchy(
                lambda x, rows=rows: np.stack([row(x) for row in rows]),  # type: ignore[misc]
                np.concatenate([[-1.0], inner, [1.0]]),
            )
            self._known.update((each, (cauchy, row)) for row, each in enumerate(group))


def _integrals(cauchy: Cauchy, at: Points, contact: Contact) -> Complex:
    """Cauchy integrals and derivatives (2, rows, k); on the surface no derivatives, which count times the depth."""
    z = at.scaled(contact)
    if at.depth.any():
        return cauchy(z)
    values = cauchy.along(z)
    return np.stack([values, np.zeros_like(values)])


def _summands(state: StressState) -> list[_Acting]:
    return [state.pressed, *(shear for _, shear in state.shears)]


def along_surface(surface: Callable[[Array], Array], breaks: Array) -> SurfaceStress:
    """Stresses along the surfaces, from the first to the last of the ``breaks`` (b,), m."""
    x = sample(breaks, _ALONG)
    return SurfaceStress(x, surface(x), surface)


class Stress:
    """Stresses of the steady state between -(dQ, dsigma)/2 at load point 1 and (dQ, dsigma)/2 at load point 2.

    The lower body, y <= 0, exerts q on the upper body and carries all of the bulk tension. The loads are fully
    reversed; for mean loads, which the first cycles determine, see :attr:`partialslip.Result.stress_at`.

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
        self._zone = one_step_zone(contact, f, dQ, dsigma, dslope)
        half = half_of(contact, half_cycle(contact, f, dQ, dsigma, dslope), dsigma, dslope)
        self._fields = Fields(f, tuple(StressState(contact, ((sign, half),)) for sign in (-1.0, 1.0)))

    def surface(self, x: npt.ArrayLike) -> Array:
        """sigma_xx (Pa) along the surfaces at ``x``, m: (2, 2, ...), by body (lower, upper), load point and the shape
        of ``x``.

        Continuous; usually largest at the trailing edge of the contact, where the slope is infinite.
        """
        return AtPoints(self._fields.surface)(x)

    def inside(self, x: npt.ArrayLike, y: npt.ArrayLike) -> Array:
        """sigma_xx, sigma_yy and sigma_xy (Pa) at the points (``x``, ``y``), m: (2, 3, ...), by load point, component
        and the common shape of ``x`` and ``y``. Points with y <= 0 are in the lower body."""
        return AtPoints(lambda x, y: self._fields.at(Points.of(x, y), self._fields.ends))(x, y)
