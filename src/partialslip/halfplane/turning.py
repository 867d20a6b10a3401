"""Half a steady cycle in which slip reverses, under gradual loads (docs/theory.md, section 7). Scaled: lengths by a,
tractions by f p0, slip by A f p0 a."""

import math
from dataclasses import dataclass, replace
from functools import cached_property

from partialslip.halfplane.change import Change
from partialslip.halfplane.contact import Contact
from partialslip.halfplane.gradual_path.certificate import certificate_of
from partialslip.halfplane.gradual_path.from_zero import MOST_LOADS, from_zero
from partialslip.halfplane.gradual_path.gradual_mean_bound import gradual_mean_load_bound
from partialslip.halfplane.gradual_path.half_cycle import HalfCycle, steady
from partialslip.halfplane.gradual_path.slips import loop, resultants, slips
from partialslip.halfplane.gradual_path.stage import Loads, LostError
from partialslip.halfplane.gradual_path.tractions import Tractions
from partialslip.halfplane.loading import Loading
from partialslip.halfplane.proportional import loading
from partialslip.halfplane.slip import Worn
from partialslip.halfplane.steady import UNEVEN_FRICTION
from partialslip.result import StickZone
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

_HELD = 1e-6  # limit: f p0: violation of a condition above which a way with a slip zone inside is not taken


@dataclass(frozen=True)
class Turning(Change):
    """Half a steady cycle with slip reversal, for positive changes: the solution ``way`` under gradual loads, and the
    single load step ``once``, which is wrong there."""

    once: Loading
    way: HalfCycle

    @classmethod
    def of(cls, once: Loading, way: HalfCycle) -> "Turning":
        """The loads of ``once``, along the ``way``."""
        left, right = way.last.zone
        zone = StickZone((left + right) / 2, (right - left) / 2, way.sign)
        return cls(once.shape, once.Qf, once.sf, once.turn, once.mirror, once.bound, zone, 0.0, once, way)

    @property
    def permanent(self) -> tuple[float, float] | None:
        return self.whole.stuck

    @property
    def breaks(self) -> list[float]:
        return self.whole.breaks

    @cached_property
    def whole(self) -> "Turned":
        """The change from load point to load point."""
        return self.part(1.0)

    def part(self, share: float) -> "Turned":
        """The change up to a ``share`` of the loads."""
        at = self.way.at(share)
        left, right = self.way.stuck_until(at)
        return Turned(self.turn, self.mirror, at.q, self.way.start, (left, right) if left < right else None)

    @property
    def reached(self) -> "Turned":
        """Shear traction at load point 2, where all points slip."""
        return replace(self.whole, never=None, factor=1 / 2)

    def from_zero(self, shear: float, tension: float, cycles: int | None = None) -> "Turned":
        """Shear traction at load point 2 after loads that begin at zero: to load point 2, with ``shear`` (in f p0 a)
        and ``tension`` (in f p0), and then through so many ``cycles``, by default until q repeats.

        Raises
        ------
        LostError
            If the way is not known.
        """
        first = Loads(self.turn * self.mirror * tension, self.turn * shear)
        q, never = from_zero(first, self.way, cycles or MOST_LOADS)
        return Turned(self.turn, self.mirror, q, None, never)

    def traction(self, x: Array) -> Array:
        return self.whole.traction(x)

    @cached_property
    def certificate(self) -> dict[str, float]:
        """Residual of the ``shear`` force at the end, in 2 f P."""
        way = self.way
        found = resultants(way.phases[0].first, way.last)
        return {"shear": abs(found.shear - way.loads.shear) / math.pi}

    @cached_property
    def mean_load_bound(self) -> float:
        """Largest \\|Q_mean\\|/(f P) of a steady state whose half cycle this is: the room that the points that never
        slip have all along the way (frictional Melan theorem: Barber, Klarbring and Ciavarella, 2008)."""
        return gradual_mean_load_bound(self.way)

    def loop(self, shares: Array) -> tuple[Array, Array]:
        """Relative displacement of the bodies less that of the adhered contact, and moment of q, since the beginning of
        half a cycle, at ``shares`` (k,) of the loads, ascending from 0; in A f p0 a and f p0 a^2."""
        displacement, moment = loop(self.way, shares)
        return self.turn * displacement, self.turn * self.mirror * moment

    @cached_property
    def worn(self) -> Worn:
        return slips(self.way).turned(self.mirror, self.turn)


@dataclass(frozen=True, eq=False)
class Turned:
    """Shear traction after slip reversal, ``factor`` (``q`` - ``before``) (None: zero), and the ends of the interval of
    points that ``never`` slip (None if all do), for positive changes of the loads; ``turn`` and ``mirror`` as of
    :class:`Turning`."""

    turn: int
    mirror: int
    q: Tractions
    before: Tractions | None
    never: tuple[float, float] | None
    factor: float = 1.0

    @property
    def breaks(self) -> list[float]:
        """Places at which it is not smooth, ascending."""
        return sorted(self.mirror * each for each in {*self.q.breaks, *(self.before.breaks if self.before else ())})

    @property
    def stuck(self) -> tuple[float, float] | None:
        """Ends of the zone of points that have never slipped, for the signs of the loads; None if there are none."""
        if not self.never or self.mirror > 0:
            return self.never
        left, right = self.never
        return -right, -left

    def traction(self, x: Array) -> Array:
        """Shear traction at ``x``, in f p0."""
        q = self.q(self.mirror * x)
        return self.factor * self.turn * (q - self.before(self.mirror * x) if self.before else q)


def half_cycle(
    pressed: Contact, f: float, dQ: float, dsigma: float, dslope: float = 0.0, *, parts: bool = True
) -> Change:
    r"""Half a steady cycle between loads that change by ``dQ`` (N/m), ``dsigma`` (Pa) and ``dslope`` (Pa/m), of any
    sign, \|dQ\| < 2 f P.

    Under slip reversal the solution of gradual loads; where this is not known, the single load step, which does not
    hold (:attr:`Loading.holds`). Without ``parts`` an inner slip zone is not followed and the solution has no
    certificate: enough for differences between nearly equal pressures.

    Raises
    ------
    InputError
        As :func:`partialslip.halfplane.loading.loading`.
    """
    once = loading(pressed, f, dQ, dsigma, dslope, bound=2)
    if once.final:
        return once
    try:
        way = steady(Loads(once.sf, math.pi * once.Qf), once.seen, parts and not once.parts)
        sure = not parts or (not way.parted and pressed.friction_bound.convex)
        holds = sure or certificate_of(way).worst < _HELD
        if holds:
            return Turning.of(once, way)
    except LostError:
        pass
    if once.parts:
        raise InputError(UNEVEN_FRICTION)
    return once
