"""States of a steady cycle by phase, from which stresses follow: contacts and shear tractions in closed form."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from partialslip.errors import InputError
from partialslip.halfplane.contact import Contact
from partialslip.halfplane.levels import Levels
from partialslip.halfplane.loading import Loading, loading
from partialslip.halfplane.mean import Path
from partialslip.halfplane.stress import Fields, Shear, State
from partialslip.result import StickZone
from partialslip.scene import Load, Scene

_SLIDING = 1e-9  # |Q|, relative to f P, that is closer to f P slides with q = f p
_Sum = tuple[tuple[float, Shear], ...]


class _Way(Protocol):
    """A way of the loads."""

    def __call__(self, *, back: bool, share: float) -> tuple[Contact, _Sum]: ...


@dataclass(frozen=True)
class Around:
    """States around a steady cycle.

    Parameters
    ----------
    load : Load
    first, second : State
        States at load points 1 and 2.
    way : callable
        ``way(*, back, share)``: the contact at this share of the way from load point 1 to 2 (``back``: from 2 to 1),
        and the change of q since the beginning of the way.
    unknown : str
        Why the states between the load points are not known; empty if they are known.
    """

    load: Load
    first: State
    second: State
    way: _Way
    unknown: str = ""

    def __call__(self, phase: float) -> State:
        """State at the ``phase``, from 0 to 1.

        Raises
        ------
        InputError
            If the state has no closed form.
        """
        if phase in (0.0, 0.5, 1.0):
            return self.second if phase == 0.5 else self.first
        back, share = self._share(phase)
        if self.unknown:
            raise InputError(f"phases: {phase:g} is between load points 1 and 2, where {self.unknown}; use march")
        begin, end = (self.second, self.first) if back else (self.first, self.second)
        pressed, change = self.way(back=back, share=share)
        sigma, slope = (
            one + share * (other - one) for one, other in ((begin.sigma, end.sigma), (begin.slope, end.slope))
        )
        return State(pressed, _merged((*begin.shears, *change)), sigma, slope)

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


def constant(scene: Scene, pressed: Contact, found: Levels) -> Fields:
    """Stresses under constant pressure, between the tractions ``found`` at the load points."""
    load = scene.load
    _, sigma, slope = load.along[load.ends[found.known]]
    known = (1.0, Shear.of(pressed, found.first, sigma, slope))
    change = Shear.of(pressed, found.cycle, load.dsigma, load.dslope)
    other = _merged((known, (-2.0 if found.known else 2.0, change)))
    first, second = (other, (known,)) if found.known else ((known,), other)
    unknown = "slip reverses" if found.cycle.turns_round else ""
    states = Around(load, State(pressed, first), State(pressed, second), _Constant(scene, pressed), unknown)
    return Fields(scene.friction.f, states)


def varying(scene: Scene, end: Contact, loaded: Loading, unknown: str) -> Fields:
    """Stresses under varying pressure, from the first loading to load point 2 in the contact ``end``."""
    load, way = scene.load, _Varying(scene)
    _, sigma, slope = load.along[load.ends[1]]
    second: _Sum = ((1.0, Shear.of(end, loaded, sigma, slope)),)
    _, change = way(back=False, share=1.0)
    first = (*second, *((-factor, shear) for factor, shear in change))
    begin = Path(scene).begin
    return Fields(scene.friction.f, Around(load, State(begin, first), State(end, second), way, unknown))


def without_shear(scene: Scene) -> Fields:
    """Stresses of bodies that are pressed together without any shear traction."""
    return Fields(scene.friction.f, Around(scene.load, *_ends(scene), _Pressed(scene)))


def sliding(scene: Scene) -> Fields | None:
    """Stresses at the load points of a contact that slides at both, with q = f p; None where Q is larger, or smaller at
    a load point: q is then not known."""
    f, shears = scene.friction.f, []
    for point, state in zip(scene.load.ends, _ends(scene), strict=True):
        Q, contact = scene.load.points[point][0], state.pressed
        if abs(abs(Q) - f * contact.P) > _SLIDING * f * contact.P:
            return None
        nothing = StickZone(-np.inf, 0.0, 1)
        shears.append(((1.0, Shear(contact, nothing, 1 if Q > 0 else -1, 1, 0.0, 0.0, 0.0)),))
    first, second = (state._replace(shears=each) for state, each in zip(_ends(scene), shears, strict=True))
    return Fields(f, Around(scene.load, first, second, _Pressed(scene), "the contact slides"))


def _ends(scene: Scene) -> tuple[State, State]:
    """States at load points 1 and 2 without shear traction."""
    path, load = Path(scene), scene.load
    contacts = (path.begin, path.at(1.0)) if scene.presses_anew else (path.begin,) * 2
    first, second = (State(each, (), *load.along[point][1:]) for each, point in zip(contacts, load.ends, strict=True))
    return first, second


@dataclass(frozen=True)
class _Constant:
    """Ways under constant pressure."""

    scene: Scene
    pressed: Contact

    def __call__(self, *, back: bool, share: float) -> tuple[Contact, _Sum]:
        load, f = self.scene.load, self.scene.friction.f
        loads = share * load.dQ, share * load.dsigma, share * load.dslope
        change = loading(self.pressed, f, *loads, bound=2)
        return self.pressed, ((-2.0 if back else 2.0, Shear.of(self.pressed, change, *loads[1:])),)


@dataclass(frozen=True)
class _Varying:
    """Ways under varying pressure."""

    scene: Scene

    def __call__(self, *, back: bool, share: float) -> tuple[Contact, _Sum]:
        path = Path(self.scene, back)
        now, mean, change = path.stage(share)
        return now, ((2.0, Shear.of(mean, change, share * path.dsigma, share * path.dslope)),)


@dataclass(frozen=True)
class _Pressed:
    """Ways without shear."""

    scene: Scene

    def __call__(self, *, back: bool, share: float) -> tuple[Contact, _Sum]:
        return Path(self.scene, back).at(share), ()


def _merged(shears: _Sum) -> _Sum:
    """Sum of ``shears``, each of which occurs once."""
    factors: dict[Shear, float] = {}
    for factor, shear in shears:
        factors[shear] = factors.get(shear, 0.0) + factor
    return tuple((factor, shear) for shear, factor in factors.items() if factor)
