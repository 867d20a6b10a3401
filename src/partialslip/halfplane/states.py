"""States of a steady cycle by phase, from which stresses follow: contacts and shear tractions, known exactly."""

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from partialslip.halfplane.contact import Contact
from partialslip.halfplane.levels import Levels
from partialslip.halfplane.loading import Loading
from partialslip.halfplane.mean_pressure import PressurePath, Ways
from partialslip.halfplane.proportional import loading
from partialslip.halfplane.stress import Acting, Fields, Points, Shear, StressState, half_of, reached
from partialslip.halfplane.turning import Turning
from partialslip.halfplane.varying import Cycle
from partialslip.result import StickZone
from partialslip.scene import Load, Scene
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

_SLIDING = 1e-9  # limit: |Q|, relative to f P, that is closer to f P slides with q = f p
_Sum = tuple[tuple[float, Acting], ...]


class _Way(Protocol):
    """A way of the loads."""

    def __call__(self, *, back: bool, share: float) -> tuple[Contact, _Sum]: ...


@dataclass(frozen=True)
class Around:
    """Stresses around a steady cycle.

    Parameters
    ----------
    load : Load
    fields : Fields
        Of the states at load points 1 and 2.
    way : callable
        ``way(*, back, share)``: the contact at this share of the way from load point 1 to 2 (``back``: from 2 to 1),
        and the change of q since the beginning of the way.
    unknown : str
        Why the states between the load points are not known; empty if they are known.
    """

    load: Load
    fields: Fields
    way: _Way
    unknown: str = ""
    _known: dict[float, StressState] = field(default_factory=dict, repr=False, compare=False)

    def inside(self, x: Array, y: Array, phases: Array) -> Array:
        """Stresses (s, 3, k), Pa, at points (``x``, ``y``), m, (k,) each, and ``phases`` (s,) from 0 to 1.

        Raises
        ------
        InputError
            If the state at a phase has no closed form.
        """
        return self.fields.at(Points.of(x, y), [self._state_at(phase) for phase in phases.tolist()])

    def surface(self, x: Array) -> Array:
        """sigma_xx (Pa) along the surfaces at ``x`` (k,), m: (2, 2, k), by body (lower, upper) and load point."""
        return self.fields.surface(x)

    def _state_at(self, phase: float) -> StressState:
        """State at a ``phase``, stored: criteria evaluate the same phases at one group of points after another."""
        if phase not in self._known:
            self._known[phase] = self._state(phase)
        return self._known[phase]

    def _state(self, phase: float) -> StressState:
        first, second = self.fields.ends
        if phase in (0.0, 0.5, 1.0):
            return second if phase == 0.5 else first
        back, share = self._share(phase)
        if self.unknown:
            raise InputError(f"phases: {phase:g} is between load points 1 and 2, where {self.unknown}; use march")
        begin, end = (second, first) if back else (first, second)
        pressed, change = self.way(back=back, share=share)
        sigma, slope = (
            one + share * (other - one) for one, other in ((begin.sigma, end.sigma), (begin.slope, end.slope))
        )
        return StressState(pressed, _merged((*begin.shears, *change)), sigma, slope)

    def _share(self, phase: float) -> tuple[bool, float]:
        """Whether the loads go back from load point 2 to 1 at ``phase``, and the share of this way."""
        back = phase > 0.5
        first, second = self.load.ends
        progress = np.roll(self.load.progress, -first)
        way = np.append(1 - progress[second - first :], 1.0) if back else progress[: second - first + 1]
        if (np.diff(way) < 0).any():
            raise InputError(f"phases: {phase:g} is between load points between which the loads turn; use march")
        position = (2 * phase - back) * (len(way) - 1)
        return back, float(np.interp(position, np.arange(len(way)), way))


def constant(scene: Scene, found: Levels) -> Around:
    """Stresses under constant pressure, between the tractions ``found`` at the load points."""
    load, pressed = scene.load, found.pressed
    _, sigma, slope = load.along[load.ends[found.known]]
    known = (1.0, reached(pressed, found.first, sigma, slope))
    change = half_of(pressed, found.cycle, load.dsigma, load.dslope)
    other = _merged((known, (-2.0 if found.known else 2.0, change)))
    first, second = (other, (known,)) if found.known else ((known,), other)
    unknown = "" if found.cycle.holds else "slip reverses"
    fields = Fields(pressed.f, (StressState(pressed, first), StressState(pressed, second)))
    return Around(load, fields, _Constant(load, found), unknown)


def varying(cycle: Cycle, loaded: Loading) -> Around:
    """Stresses in a ``cycle`` under varying pressure, from the first loading to load point 2."""
    load = cycle.scene.load
    way = _Varying(cycle.ways)
    _, sigma, slope = load.along[load.ends[1]]
    second: _Sum = ((1.0, Shear.of(cycle.second, loaded, sigma, slope)),)
    _, change = way(back=False, share=1.0)
    first = (*second, *((-factor, shear) for factor, shear in change))
    fields = Fields(cycle.scene.friction.f, (StressState(cycle.first, first), StressState(cycle.second, second)))
    return Around(load, fields, way, "slip reverses" if cycle.turns_round else "")


def without_shear(scene: Scene, ways: Ways | None = None) -> Around:
    """Stresses of bodies that are pressed together without any shear traction; ``ways`` between the load points, where
    they are known."""
    ways = ways or PressurePath.both(scene)
    return Around(scene.load, Fields(scene.friction.f, _states_without_shear(scene, ways)), _Pressed(ways))


def sliding_state(scene: Scene, ways: Ways | None = None) -> Around | None:
    """Stresses at the load points of a contact that slides at both, with q = f p, as of :func:`without_shear`; None
    where Q is larger, or smaller at a load point: q is then not known."""
    found, ways = [], ways or PressurePath.both(scene)
    for point, state in zip(scene.load.ends, _states_without_shear(scene, ways), strict=True):
        Q, contact = scene.load.points[point][0], state.pressed
        f = contact.f
        if abs(abs(Q) - f * contact.P) > _SLIDING * f * contact.P:
            return None
        nothing = StickZone(-np.inf, 0.0, 1)
        shear = Shear(contact, nothing, 1 if Q > 0 else -1, 1, 0.0, 0.0, 0.0)
        found.append(state._replace(shears=((1.0, shear),)))
    return Around(scene.load, Fields(f, tuple(found)), _Pressed(ways), "the contact slides")


def _states_without_shear(scene: Scene, ways: Ways) -> tuple[StressState, StressState]:
    """States at load points 1 and 2 without shear traction."""
    path, load = ways[0], scene.load
    contacts = (path.begin, path.end) if scene.presses_anew else (path.begin,) * 2
    first, second = (
        StressState(each, (), *load.along[point][1:]) for each, point in zip(contacts, load.ends, strict=True)
    )
    return first, second


@dataclass(frozen=True)
class _Constant:
    """Ways under constant pressure."""

    load: Load
    found: Levels

    def __call__(self, *, back: bool, share: float) -> tuple[Contact, _Sum]:
        load, cycle, pressed = self.load, self.found.cycle, self.found.pressed
        loads = share * load.dQ, share * load.dsigma, share * load.dslope
        change = cycle.part(share) if isinstance(cycle, Turning) else loading(pressed, pressed.f, *loads, bound=2)
        return pressed, ((-2.0 if back else 2.0, half_of(pressed, change, *loads[1:])),)


@dataclass(frozen=True)
class _Varying:
    """Ways under varying pressure."""

    ways: Ways

    def __call__(self, *, back: bool, share: float) -> tuple[Contact, _Sum]:
        path = self.ways[back]
        now, mean, change = path.stage(share)
        return now, ((2.0, Shear.of(mean, change, share * path.dsigma, share * path.dslope)),)


@dataclass(frozen=True)
class _Pressed:
    """Ways without shear."""

    ways: Ways

    def __call__(self, *, back: bool, share: float) -> tuple[Contact, _Sum]:
        return self.ways[back].at(share), ()


def _merged(shears: _Sum) -> _Sum:
    """Sum of ``shears``, each of which occurs once."""
    factors: dict[Acting, float] = {}
    for factor, shear in shears:
        factors[shear] = factors.get(shear, 0.0) + factor
    return tuple((factor, shear) for shear, factor in factors.items() if factor)
