"""Steady cycles under varying normal load and moment, in closed form (docs/theory.md, section 11)."""

import functools
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from partialslip.halfplane.contact import Contact
from partialslip.halfplane.loading import Loading
from partialslip.halfplane.mean_pressure import Mean, PressurePath, PressureStage, Ways, common
from partialslip.halfplane.steady import admissible
from partialslip.result import EndSlip, Regime, Slip
from partialslip.scene import Hertz, Scene
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

_STAGES = 16  # accuracy: of the way from load point to load point
_NEAR = 0.5 ** np.arange(5, 15)  # from either end of a way: an end of the stick zone may reverse shortly before
_STOPS = np.unique([*np.arange(1, _STAGES) / _STAGES, *_NEAR, *(1 - _NEAR), 1.0])
_ROUNDING = 1e-9  # accuracy: lengths in a, tractions in f p0
_EQUAL = 1e-12  # accuracy: relative difference of rates that is rounding
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(32)
# accuracy: Gauss points, of a way and of a slip zone, and the fewest between kinks: of the work, and of the rule that
# tells its error
_STEPS, _BETWEEN = (20, 12), (3, 2)
_PIECES = 8  # accuracy: most pieces between kinks that have as many points as a whole slip zone
_SHARES = (1 - np.cos(np.linspace(0, np.pi, 14)))[1:-1] / 2  # of the way, at which points touch or open
_ALONG = 32  # accuracy: stages of a way at which q is within its bounds
_PANELS = 16  # accuracy: of the stick zone, on which bounds along the way are integrated
_PLACES = np.cos(np.linspace(np.pi, 0, 401))[1:-1]
_ROOM = 1e-12  # accuracy: of Q, in f P, beyond the bounds that is rounding


@dataclass(frozen=True)
class Cycle:
    """A steady cycle under varying pressure.

    Parameters
    ----------
    scene : Scene
    ways : two PressurePath
        From load point 1 to 2, and back.
    mean : Contact
        The union of the contacts at both load points, under the mean pressure.
    change : Loading or None
        Change of shear from load point 1 to 2; None where no end slips.
    slips : two EndSlip
        How the left and the right end of the contact slip from load point 1 to 2; "part of the cycle" where the stick
        zone of the closed form does not lie inside both contacts: the end then slips at most during part of the cycle.
    turns_round : bool
        Whether slip reverses on the way.
    """

    scene: Scene
    ways: Ways
    mean: Contact
    change: Loading | None
    slips: tuple[EndSlip, EndSlip]
    turns_round: bool = False

    @property
    def first(self) -> Contact:
        """Contact at load point 1."""
        return self.ways[0].begin

    @property
    def second(self) -> Contact:
        """Contact at load point 2."""
        return self.ways[0].end

    @property
    def stick(self) -> tuple[float, float]:
        """Ends of the stick zone, m; those of the part that both contacts have in common where no end slips."""
        if self.change:
            return PressureStage(self.second, self.mean, self.change).stick
        return common(self.first, self.second)

    @property
    def regime(self) -> Regime:
        """Regime of the cycle; the mean of Q is known to rounding."""
        point, _ = self.scene.load.ends
        low, high = self.bounds_of_Q1
        room = _ROOM * self.scene.friction.f * self.scene.P
        if not low - room <= self.scene.load.points[point][0] <= high + room:
            return "ratchets"
        if self.change is None:
            return "no slip"
        return "small tension" if self.change.zone.s > 0 else "large tension"

    def dq(self, x: Array) -> Array:
        """Change of shear traction at ``x`` (m), Pa."""
        if self.change:
            return self.change.within(self.mean, self.scene.friction.f, x)
        load, (one, other) = self.scene.load, (self.first, self.second)
        if load.dQ == 0 and load.dsigma == 0 and load.dslope == 0:
            return np.zeros(np.shape(x))
        ratio = (load.dQ + math.pi / 4 * x * load.dsigma) / (other.P - one.P)
        return ratio * (other.pressure(x) - one.pressure(x))

    @functools.cached_property
    def bounds_of_Q1(self) -> tuple[float, float]:
        """Least and largest Q at load point 1 of a steady state, N/m: some q1 must keep within the bounds all along
        both ways; at the load points only, where slip reverses: the stages are then not those of the formula."""
        f, (left, right) = self.scene.friction.f, self.stick
        slipping = 0.0
        if self.change:
            outer = self.first.ends
            for sign, low, high in zip(self.change.signs, (outer[0], right), (left, outer[1]), strict=True):
                slipping -= sign * f * float(_integral(self.first.pressure, low, high, self._kinks))

        def apart(sign: int) -> Callable[[Array], Array]:
            return lambda x: self.dq(x) - sign * f * (self.second.pressure(x) - self.first.pressure(x))

        crossings = [point for sign in (-1, 1) for point in _crossings(apart(sign), left, right)]
        panels = np.linspace(left, right, _PANELS + 1 if self.change else 2).tolist()
        low, high = slipping + _integral(self._tightest, left, right, [*self._kinks, *panels, *crossings])
        return float(low), float(high)

    def _tightest(self, x: Array) -> Array:
        """Least and largest q1 at ``x`` (k,), Pa, (2, k): the bounds of q at load points 1 and 2 and at stages of both
        ways, less the change of q since load point 1."""
        f, dq = self.scene.friction.f, self.dq(x)
        first, second = (f * self.first.pressure(x), 0 * x), (f * self.second.pressure(x), dq)

        def between(stages: list[PressureStage], before: Array) -> list[tuple[Array, Array]]:
            return [(f * now.pressure(x), before + change.within(mean, f, x)) for now, mean, change in stages]

        forth, back = self._stages_between
        ways = [first, *between(forth, 0 * x), second], [second, *between(back, dq), first]
        rooms = [[_least(np.array([bound + sign * moved for bound, moved in way])) for way in ways] for sign in (1, -1)]
        return np.array([[-1.0], [1.0]]) * np.min(rooms, axis=1)

    @functools.cached_property
    def _stages_between(self) -> tuple[list[PressureStage], list[PressureStage]]:
        """Stages between the load points, from 1 to 2 and back; none where there is no slip or slip reverses."""
        if not self.change or self.turns_round:
            return [], []
        forth, back = ([way.stage(share) for share in (np.arange(1, _ALONG) / _ALONG).tolist()] for way in self.ways)
        return forth, back

    @property
    def _kinks(self) -> list[float]:
        return self.mean.places(self.mean.shape.kinks).tolist()

    def slip(self) -> Slip | None:
        """Slip of points while they are in contact; the error of its work is not known where slip reverses on the way.

        A part of the surfaces that slips under the pressure p does the work f p for each length of slip. On the way
        from one load point to the other this is f p s at the end of the way, less the integral of s f dp.
        """
        if not self.change:
            return None
        unit = self._unit(self.mean)
        worn = self.change.worn
        x, slips = self.mean.places(worn.x), unit * worn.slip
        low, high = common(self.first, self.second)
        inside = (x > low) & (x < high)
        ends = np.array([low, high])
        x, slips = np.append(x[inside], ends), np.append(slips[inside], unit * self.change.slip(self.mean.scaled(ends)))
        for share in _SHARES.tolist():  # points that touch or open on the way
            now, mean, part = self.ways[0].stage(share)
            places = np.array(now.ends)
            places = places[(places < low) | (places > high)]
            so_far = self._unit(mean) * part.slip(mean.scaled(places))
            opens = self.first.pressure(places) > 0
            x = np.append(x, places)
            slips = np.append(
                slips, np.where(opens, so_far, unit * self.change.slip(self.mean.scaled(places)) - so_far)
            )
        order = np.argsort(x)
        work, other = (
            sum(self._dissipated(way, *counts) for way in self.ways) for counts in zip(_STEPS, _BETWEEN, strict=True)
        )
        return Slip(x[order], slips[order], work, None if self.turns_round else abs(work - other))

    def _unit(self, mean: Contact) -> float:
        """Unit of slip under the pressure of ``mean``, m."""
        return self.scene.material.A * self.scene.friction.f * mean.p0 * mean.a

    def _dissipated(self, path: PressurePath, count: int, fewest: int) -> float:
        """Work on the way along the ``path``: by ``count`` points a way and a slip zone, the ``fewest`` at least
        between kinks."""
        f = self.scene.friction.f

        def slipped(stage: PressureStage, weight: Callable[[Array, Array], Array]) -> float:
            """Integral over the contact of |slip| since the beginning of the way, times the ``weight``."""
            now, mean, change = stage
            unit, total = self._unit(mean), 0.0
            stick, kinks = now.scaled(stage.stick), now.scaled(mean.places(mean.shape.kinks))
            for low, high in ((-1.0, stick[0]), (stick[1], 1.0)):
                inner = [kink for kink in kinks if low < kink < high]
                angles = np.arccos(np.clip(np.unique([low, *inner, high]), -1, 1))[::-1]
                half = np.diff(angles)[:, None] / 2
                nodes, weights = np.polynomial.legendre.leggauss(min(count, max(_PIECES * count // len(half), fewest)))
                # slip begins as d^(3/2) at the distance d from a kink or the stick zone: smooth in sqrt(d)
                turn = np.pi / 2 * (1 + nodes)
                angle = (angles[:-1, None] + half * (1 - np.cos(turn))).ravel()
                y = np.cos(angle)
                amount = np.abs(unit * change.slip(mean.scaled(now.places(y))))
                along = np.pi / 2 * (half * np.sin(turn) * weights).ravel()
                total += float(along @ (amount * weight(y, np.sin(angle))))
            return total

        last = path.stage(1.0)
        end = last.now
        work = slipped(last, lambda y, sine: end.a * sine * end.p0 * end.shape.pressure(y))
        shares, weights = np.polynomial.legendre.leggauss(count)
        roots = (1 + shares) / 2  # slip of a share t of the way, over the contact, begins as t^(5/2)
        for share, weight in zip(roots**2, roots * weights, strict=True):
            stage = path.stage(float(share))
            uniform, turned = path.pressed(stage.now)
            work -= weight * slipped(stage, lambda y, _, u=uniform, t=turned: u + t * y)  # type: ignore[misc]
        return f * work


@functools.lru_cache(maxsize=1)
def steady_cycle(scene: Scene) -> Cycle:
    """The steady cycle of ``scene``, whose pressure varies, with friction and without sliding, under loads in phase."""
    ways, f = PressurePath.both(scene), scene.friction.f
    path = ways[0]
    first, second = path.begin, path.end
    mean = Mean(first, second).contact
    left, right = common(first, second)
    if not (left < right and _exceeds(path, f).any()):
        return Cycle(scene, ways, mean, None, ("never" if left < right else "part of the cycle",) * 2)
    last = path.stage(1.0)
    change, ends, room = last.change, last.stick, _ROUNDING * mean.a
    told: list[EndSlip] = ["forwards" if sign > 0 else "backwards" for sign in change.signs]
    inside = left - room <= ends[0], ends[1] <= right + room
    if all(inside) and not admissible(change.zone, change.seen, change.gf):
        inside = False, False
    slips = (told[0] if inside[0] else "part of the cycle", told[1] if inside[1] else "part of the cycle")
    if not all(inside):
        return Cycle(scene, ways, mean, None, slips)
    return Cycle(scene, ways, mean, change, slips, any(_turns(way, f, change) for way in ways))


def closed_form(scene: Scene) -> str:
    """Why there is no closed form of the steady cycle of ``scene``, whose pressure varies; empty if there is one."""
    if scene.friction.varies:
        return "the coefficient of friction varies along x, and the pressure in time: no exact solution is known"
    cycle = steady_cycle(scene)
    if cycle.change:
        return ""
    if set(cycle.slips) == {"never"}:
        if scene.load.dQ == 0 and scene.load.dsigma == 0 and scene.load.dslope == 0:
            return ""
        if isinstance(scene.profile, Hertz) and scene.even and scene.load.dslope == 0:
            return ""
        without = "a moment and sigma_slope" if scene.load.dslope else "a moment"
        return f"neither end of the contact slips, and only for hertz without {without} an exact solution is known"
    sides = zip(("left", "right"), cycle.slips, strict=True)
    told = " and ".join(f"the {side} end" for side, how in sides if how == "part of the cycle")
    slips = "slips" if told.count("end") == 1 else "slip"
    return f"{told} of the contact {slips} at most during part of the cycle: no exact solution is known"


def require_closed_form(scene: Scene) -> None:
    """Raise InputError if the steady cycle of ``scene`` has no closed form."""
    if why := closed_form(scene):
        raise InputError(f"load.P, load.M: {why}; must be solved by march")


def _exceeds(path: PressurePath, f: float) -> Array:
    """Whether the increments of q at the ends of the adhered contact are larger than f times those of p: at stages of
    the way and the left and right end, (stages, 2). If they never are, no end slips."""
    found = []
    for share in np.linspace(0, 1, _STAGES + 1).tolist():
        rates = path.rates(path.at(share))
        found.append(np.abs(rates.shear) > f * np.abs(rates.pressure) * (1 + _EQUAL))
    return np.array(found)


def _turns(path: PressurePath, f: float, change: Loading) -> bool:
    """Whether slip reverses on the way: the stick zones of the stages do not shrink, or not always with the slip of
    the whole ``change``, or slip begins in the wrong direction."""
    if _goes_back(path, f, path.stage(1.0)):
        return True
    before = path.begin.ends
    for share in _STOPS.tolist():
        stage = path.stage(share)
        (left, right), room = stage.stick, _ROUNDING * stage.mean.a
        inner = common(path.begin, stage.now)
        if stage.change.zone.s != change.zone.s or left < max(before[0], inner[0]) - room:
            return True
        if right > min(before[1], inner[1]) + room:
            return True
        before = left, right
    return False


def _goes_back(path: PressurePath, f: float, last: PressureStage) -> bool:
    """Whether points that slip on the way to the ``last`` stage slip on at its beginning in the direction of the way
    before: the increments of q in the contact, which sticks as a whole, then lead beyond the bound, whose increments
    are those of f p."""
    begin, (left, right) = path.begin, path.begin.scaled(np.array(last.stick)).tolist()
    for sign, low, high in zip(last.change.signs, (-1.0, min(right, 1.0)), (max(left, -1.0), 1.0), strict=True):
        rates = path.rates(begin, np.linspace(low, high, _STAGES + 1))
        if (sign * rates.shear + f * rates.pressure < -_ROUNDING * f * begin.P).any():
            return True
    return False


def _least(values: Array) -> Array:
    """Least of ``values`` (n, k) at n evenly spaced places, (k,): of the parabola through the least one and its two
    neighbours."""
    if len(values) < 3:
        return values.min(axis=0)
    place = values.argmin(axis=0)
    before, at, after = (
        np.take_along_axis(values, np.clip(place + way, 0, len(values) - 1)[None], 0)[0] for way in (-1, 0, 1)
    )
    bend = before - 2 * at + after
    inside = (place > 0) & (place < len(values) - 1) & (bend > 0)
    return np.where(inside, at - (after - before) ** 2 / (8 * np.where(inside, bend, 1.0)), at)


def _integral(function: Callable[[Array], Array], low: float, high: float, kinks: list[float]) -> Array:
    """Integrals from ``low`` to ``high`` of the values or rows of values of the ``function``, which has square roots at
    both and at the ``kinks``."""
    high = max(low, high)
    ends = np.unique([low, *(kink for kink in kinks if low < kink < high), high])
    half = np.diff(ends)[:, None] / 2
    angle = np.pi / 2 * (1 + _NODES)
    x = ends[:-1, None] + half * (1 - np.cos(angle))
    return function(x.ravel()) @ (half * np.pi / 2 * _WEIGHTS * np.sin(angle)).ravel()


def _crossings(function: Callable[[Array], Array], low: float, high: float) -> list[float]:
    """Zeros of ``function`` between ``low`` and ``high``."""
    from scipy.optimize import brentq  # takes long to import

    x = (low + high) / 2 + (high - low) / 2 * _PLACES
    signs = np.sign(function(x))
    where = np.flatnonzero(signs[:-1] * signs[1:] < 0)
    return [
        float(
            brentq(lambda at: float(function(np.array([at]))[0]), x[i], x[i + 1], xtol=1e-15 * abs(high - low) + 1e-300)
        )
        for i in where
    ]
