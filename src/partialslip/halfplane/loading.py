"""One proportional change of the loads: the first loading of a contact without shear, or half a steady cycle, which is
a first loading under twice the bound. Scaled: lengths by a, tractions by f p0, slip by A f p0 a."""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from partialslip.halfplane.change import Change
from partialslip.halfplane.contact import Contact
from partialslip.halfplane.mean_bound import mean_load_bound
from partialslip.halfplane.shape import Shape
from partialslip.halfplane.slip import Worn, dissipation, slip
from partialslip.halfplane.steady import NARROWEST, TOO_STEEP, UNEVEN_FRICTION, drive, steady_stick_zone, stick_zones
from partialslip.halfplane.traction import half_range
from partialslip.result import StickZone
from partialslip.scene.gradual import left_end_turns, turns_round
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

_NOTHING = StickZone(0.0, 1.0, 1)
_STAGES = 16  # accuracy: of the way from load point to load point
_SHARES = np.arange(9) / 8  # of slip zones
_ROUNDING = 1e-9  # accuracy: lengths in a, tractions in f p0


@dataclass(frozen=True)
class Loading(Change):
    """Change of shear traction and slip due to one proportional change of the loads, in a single step."""

    @property
    def loads(self) -> tuple[float, float]:
        """Qf and sf with their signs."""
        return self.turn * self.Qf, self.turn * self.mirror * self.sf

    @property
    def signs(self) -> tuple[int, int]:
        """Signs of the change of traction in the left and the right slip zone."""
        left, right = (self.turn * int(self.zone.s), self.turn)[:: self.mirror]
        return left, right

    def traction(self, x: Array) -> Array:
        if self.nothing:
            return np.zeros_like(x)
        return self.turn * self.bound * half_range(self.mirror * x, self.zone, self.seen, self.gf)

    def slip(self, x: Array) -> Array:
        """Slip at ``x``, in A f p0 a."""
        if self.nothing:
            return np.zeros_like(x)
        return self.turn * self.bound / 2 * slip(self.mirror * x, self.zone, self.seen, self.gf)

    def left_end_turns(self, half_width: float | None = None) -> bool:
        """Whether slip in the left slip zone reverses under gradual loading before the stick zone has ``half_width``
        (default: the final one); see :func:`partialslip.scene.gradual.left_end_turns`."""
        if not self._simple:
            return self.turns_round
        half_width = self.zone.half_width if half_width is None else half_width
        return bool(left_end_turns(self.Qf, self.sf, self.zone.s, half_width))

    @property
    def certificate(self) -> dict[str, float]:
        """Residuals of the loads of the stick zone: ``tension`` in f p0, or relative if sf > 1, and ``shear`` in 2 f P.

        The narrowest stick zone stands for all larger tensions. Near sliding, 1 - Qf is known only to the rounding of
        dQ, which the tension residual therefore leaves out.
        """
        c, sf, Qf = self.zone.half_width, self.sf, self.Qf
        at = np.array(1 + self.zone.centre - c), np.array(c), np.array(self.zone.s)
        found = self.seen.conditions(*at)
        found = found.sloped(np.array(self.gf), *at) if self.gf else found
        tension = 0.0 if c <= NARROWEST and sf > found.sf else abs(float(found.sf) - sf) / max(sf, 1.0)
        rounding = np.finfo(float).eps / max(1 - Qf, np.finfo(float).eps)
        return {"tension": max(tension - float(rounding), 0.0), "shear": abs(float(found.Qf) - Qf)}

    @cached_property
    def mean_load_bound(self) -> float:
        """Largest \\|Q_mean\\|/(f P) of a steady state whose half cycle this is; see
        :func:`partialslip.halfplane.mean_bound.mean_load_bound`."""
        return mean_load_bound(self.zone, self.seen, self.Qf, self.sf, self.gf, reverses=self.turns_round)

    @property
    def holds(self) -> bool:
        """Whether a single step gives what gradual loads give: slip does not reverse."""
        return not self.turns_round

    @property
    def final(self) -> bool:
        """Whether the single load step is the answer: nothing changes, slip does not reverse, or the tension varies
        along x, for which no solution under gradual loads is known."""
        return self.nothing or bool(self.gf) or self.holds

    @property
    def one_way(self) -> bool:
        return self.zone.s > 0 and self.gf <= 0 and self.shape.convex

    @property
    def _simple(self) -> bool:
        """Whether two inequalities decide on slip reversal: neither the tension nor f varies along x."""
        return not self.gf and self.shape.convex

    @property
    def worn(self) -> Worn:
        return dissipation(self.zone, self.seen, self.gf).turned(self.mirror, self.turn)

    @cached_property
    def turns_round(self) -> bool:
        """Whether slip reverses in half a cycle of gradual loading: :func:`partialslip.scene.gradual.turns_round`."""
        if not self._simple:
            return self._reverses()
        return bool(turns_round(self.Qf, self.sf, self.zone.s, self.zone.centre, self.zone.half_width))

    def _reverses(self) -> bool:
        """Whether slip reverses at stages of the way: the stick zone does not shrink, or does not always have the slip
        of the last stage, or an increment of the loads pushes points that slip back. Points that slip must
        be pushed in the direction of slip by the adhered traction of the whole contact, too, as the way begins.

        An increment slips the surfaces at the distance c cosh(eta) from the middle e of the stick zone, on the side
        tau = +-1, by the integral of its strain, in proportion to

            dQ/2 eta + tau c/8 (dsigma + dslope e) sinh(eta) + c^2/32 dslope sinh(2 eta).

        Where the adhered traction of the whole contact has one sign slip only grows, whatever the friction bound: the
        traction that slip causes elsewhere has this sign, too (an obstacle problem).
        """
        if self._pushed(np.clip([-1.0, 1.0, -self.sf / (2 * self.gf) if self.gf else 1.0], -1, 1)).min() >= 0:
            return False
        zones = self._zones_at_stages
        if not (zones.s == self.zone.s).all() or np.isnan(zones.half_width).any():
            return True
        if (np.diff(zones.left, prepend=-1.0) < -_ROUNDING).any() or (
            np.diff(zones.right, prepend=1.0) > _ROUNDING
        ).any():
            return True
        e, c = zones.centre[:, None], zones.half_width[:, None]
        for side, sign in ((1, 1), (-1, self.zone.s)):
            width = np.maximum(1 - side * e - c, 0.0)
            eta = 2 * np.arcsinh(np.sqrt(width / (2 * c))) * _SHARES
            slips = self.Qf / 2 * eta + side * c / 8 * (self.sf + self.gf * e) * np.sinh(eta)
            slips += c**2 / 32 * self.gf * np.sinh(2 * eta)
            y = side * (zones.right if side > 0 else -zones.left)[-1] + side * width[-1] * _SHARES
            if (sign * slips < -_ROUNDING * eta).any() or (sign * self._pushed(y) < -_ROUNDING).any():
                return True
        return False

    def _pushed(self, y: Array) -> Array:
        """Adhered traction of the whole contact at ``y``, times a positive factor."""
        return self.Qf / 2 + y / 8 * self.sf + (y**2 - 0.5) / 8 * self.gf

    @cached_property
    def _zones_at_stages(self) -> StickZone[Array]:
        """Stick zones at equal stages of the change of the loads; NaN where there are several."""
        shares = np.arange(1, _STAGES + 1) / _STAGES
        return stick_zones(shares * self.Qf, shares * self.sf, self.seen, shares * self.gf)

    @property
    def parts(self) -> bool:
        """Whether slip may reverse, as more than one zone sticks at a stage of the way."""
        return self.turns_round and not self._simple and bool(np.isnan(self._zones_at_stages.half_width).any())


def in_half_planes(pressed: Contact, f: float, dQ: float, dsigma: float, dslope: float = 0.0, *, bound: int) -> Loading:
    """Loading by ``dQ`` (N/m), ``dsigma`` (Pa) and ``dslope`` (Pa/m) of any sign, with |dQ| < ``bound`` f P.

    Raises
    ------
    InputError
        If the tension varies too much along x for a single stick zone.
    """
    at_middle = dsigma + dslope * pressed.centre
    Qf, sf = dQ / (bound * f * pressed.P), 2 * abs(at_middle) / (bound * f * pressed.p0)
    gf = 2 * dslope * pressed.a / (bound * f * pressed.p0)
    turn = -1 if drive(Qf, gf) < 0 else 1
    mirror = turn * (-1 if at_middle < 0 else 1)
    found = Loading(pressed.friction_bound, turn * Qf, sf, turn, mirror, bound, _NOTHING, turn * gf)
    return found if found.nothing else _with_stick_zone(found)


def one_step(Qf: float, sf: float, shape: Shape, gf: float = 0.0) -> Loading:
    """Half a steady cycle by changes ``Qf`` (of 2 f P), ``sf`` and ``gf`` (of f p0, f p0/a) of positive sign; see
    :class:`partialslip.halfplane.shape.Shape`.

    Raises
    ------
    InputError
        If the tension varies too much along x for a single stick zone.
    """
    return _with_stick_zone(Loading(shape, Qf, sf, 1, 1, 2, _NOTHING, gf))


def _with_stick_zone(found: Loading) -> Loading:
    zone = steady_stick_zone(found.Qf, found.sf, found.seen, found.gf)
    if math.isnan(zone.half_width):
        raise InputError(f"load.sigma_slope: {TOO_STEEP}" if found.shape.convex else UNEVEN_FRICTION)
    return replace(found, zone=zone)
