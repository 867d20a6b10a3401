"""Half a steady cycle in which slip turns round, under gradual loads (docs/theory.md, section 7). Scaled: lengths by a,
tractions by f p0, slip by A f p0 a."""

import math
from dataclasses import dataclass
from functools import cached_property

from partialslip.halfplane.change import Change
from partialslip.halfplane.contact import Contact
from partialslip.halfplane.gradual_path.certificate import certificate_of
from partialslip.halfplane.gradual_path.from_zero import MOST_LOADS, from_zero
from partialslip.halfplane.gradual_path.gradual_mean_bound import gradual_mean_load_bound
from partialslip.halfplane.gradual_path.half_cycle import HalfCycle, steady
from partialslip.halfplane.gradual_path.slips import loop, resultants, slips
from partialslip.halfplane.gradual_path.stage import Loads, LostError, Stage
from partialslip.halfplane.gradual_path.tractions import Tractions
from partialslip.halfplane.loading import Loading, loading
from partialslip.halfplane.slip import Worn
from partialslip.halfplane.steady import UNEVEN_FRICTION
from partialslip.result import StickZone
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

_HELD = 1e-6  # limit: f p0: violation of a condition above which a way with a slip zone inside is not taken


@dataclass(frozen=True)
class Turning(Change):
    """Half a steady cycle in which slip turns round: the change ``once`` of the loads in a single step, which does not
    hold, and the ``way`` of gradual loads, for positive changes."""

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

    def seen_from(self, interval: tuple[float, float]) -> tuple[float, float]:
        """Ends of an ``interval`` of the mirrored x, or of x, on the other of both."""
        left, right = interval
        return (left, right) if self.mirror > 0 else (-right, -left)

    @property
    def breaks(self) -> list[float]:
        return self.whole.breaks

    @cached_property
    def whole(self) -> "PartOfWay":
        """The change from load point to load point."""
        return self.part(1.0)

    def part(self, share: float) -> "PartOfWay":
        """The change up to a ``share`` of the loads."""
        return PartOfWay(self, self.way.at(share))

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
class PartOfWay:
    """Change of shear traction in a ``cycle`` from load point 1 up to the stage ``at`` a share of the loads."""

    cycle: Turning
    at: Stage

    @property
    def breaks(self) -> list[float]:
        """Places at which the change is not smooth, ascending."""
        inner = {*self.at.q.breaks, *self.cycle.way.start.breaks}
        return sorted(self.cycle.mirror * each for each in inner)

    @property
    def stuck(self) -> tuple[float, float] | None:
        """Ends of the zone of points that have not slipped, for the signs of the loads; None if there are none."""
        left, right = self.cycle.way.stuck_until(self.at)
        return self.cycle.seen_from((left, right)) if left < right else None

    def traction(self, x: Array) -> Array:
        """Change of shear traction at ``x``, in f p0."""
        way, seen = self.cycle.way, self.cycle.mirror * x
        return self.cycle.turn * (self.at.q(seen) - way.start(seen))


@dataclass(frozen=True, eq=False)
class Reached:
    """Shear traction at load point 2 of a ``cycle`` in which all points slip."""

    cycle: Turning

    stuck = None

    @property
    def breaks(self) -> list[float]:
        """Places at which the traction is not smooth, ascending."""
        return self.cycle.breaks

    def traction(self, x: Array) -> Array:
        """q at ``x``, in f p0."""
        return self.cycle.traction(x) / 2


@dataclass(frozen=True, eq=False)
class Followed:
    """Shear traction at load point 2 of a ``cycle`` after loads that begin at zero: ``q``, and the ends of the interval
    that has ``never`` slipped (None if every point has), both for positive changes of the loads."""

    cycle: Turning
    q: Tractions
    never: tuple[float, float] | None

    @classmethod
    def from_zero(cls, cycle: Turning, shear: float, tension: float, cycles: int | None = None) -> "Followed":
        """Follow the loads to load point 2, with ``shear`` (in f p0 a) and ``tension`` (in f p0), and then through so
        many ``cycles``, by default until q repeats.

        Raises
        ------
        LostError
            If the way is not known.
        """
        first = Loads(cycle.turn * cycle.mirror * tension, cycle.turn * shear)
        return cls(cycle, *from_zero(first, cycle.way, cycles or MOST_LOADS))

    @property
    def breaks(self) -> list[float]:
        """Places at which the traction is not smooth, ascending."""
        return sorted(self.cycle.mirror * each for each in self.q.breaks)

    @property
    def stuck(self) -> tuple[float, float] | None:
        """Ends of the zone of points that have never slipped, for the signs of the loads; None if there are none."""
        return self.cycle.seen_from(self.never) if self.never else None

    def traction(self, x: Array) -> Array:
        """q at ``x``, in f p0."""
        return self.cycle.turn * self.q(self.cycle.mirror * x)


def half_cycle(
    pressed: Contact, f: float, dQ: float, dsigma: float, dslope: float = 0.0, *, parts: bool = True
) -> Change:
    """Half a steady cycle between loads that change by ``dQ`` (N/m), ``dsigma`` (Pa) and ``dslope`` (Pa/m), of any
    sign, with |dQ| < 2 f P. Where slip turns round and the gradual way is not known, the single step, which does not
    hold (:attr:`Loading.holds`). Without ``parts`` a slip zone inside the stick zone is not followed, and the way has
    no certificate: for differences between pressures that are nearly the same.

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
