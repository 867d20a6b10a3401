"""What the exact method finds, whether the pressure varies or not, and the result that is made of it; SI units."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple, Protocol

import numpy as np

from partialslip.halfplane.contact import Contact
from partialslip.halfplane.levels import FRICTIONLESS, SLIDES
from partialslip.halfplane.mean_pressure import Ways
from partialslip.halfplane.remarks import no_stresses, remarks, undetermined
from partialslip.halfplane.states import Around, sliding_state, without_shear
from partialslip.halfplane.stress import SURFACE_REACH, along_surface
from partialslip.halfplane.tractions import sample
from partialslip.result import Clock, Result, Slip, SteadyState, StressAt, Traction, TractionAt
from partialslip.scene import Scene
from partialslip.tools.arrays import Array


class AtLoadPoints(Protocol):
    """Shear tractions at load points 1 and 2."""

    @property
    def breaks(self) -> list[float]:
        """Places at which they are not smooth, m."""

    def q(self, x: Array) -> tuple[Array, Array]:
        """q1 and q2 at ``x`` (m), Pa."""


@dataclass(frozen=True)
class ExactTractions:
    """Tractions of the steady state: of the contacts ``second`` and ``first`` at load points 2 and 1 (``first`` is None
    if they are the same), the change of shear ``dq`` (None if nothing sticks), and the shear at the load points (None
    if no closed form gives it)."""

    second: Contact
    first: Contact | None
    dq: Callable[[Array], Array] | None
    levels: AtLoadPoints | None

    def at(self, x: Array) -> TractionAt:
        """Tractions at ``x`` (m), Pa; zero outside the contact."""
        p, p1 = self.second.pressure(x), self.first.pressure(x) if self.first else None
        dq = self.dq(x) if self.dq else np.zeros_like(p)
        q1, q2 = self.levels.q(x) if self.levels else (None, None)
        return TractionAt(p, dq, q1, q2, p1)


class Answer(NamedTuple):
    """Steady state found by the exact method.

    Parameters
    ----------
    first, second : Contact
        Contacts at load points 1 and 2.
    state : SteadyState
        Without notes.
    levels : AtLoadPoints or str
        q1 and q2, or the reason why there are none.
    stress : Around or None
        Stresses, where they are asked for and known.
    dq : callable, optional
        Change of shear traction (Pa) at places (m); None if nothing sticks.
    breaks : sequence of float
        Places at which dq is not smooth, m.
    turns : bool
        Whether slip reverses between the load points, and a single step does not hold.
    """

    first: Contact
    second: Contact
    state: SteadyState
    levels: AtLoadPoints | str
    stress: Around | None
    dq: Callable[[Array], Array] | None = None
    breaks: Sequence[float] = ()
    turns: bool = False
    slip: Slip | None = None
    certificate: Mapping[str, float] = {}
    limits: Mapping[str, float] = {}


def without_cycle(scene: Scene, first: Contact, second: Contact, ways: Ways | None, inside: bool) -> Answer:
    """Of a contact that slides, or has no friction; ``ways`` between the load points, where the pressure varies, and
    ``inside``: whether stresses are asked for."""
    if scene.free:
        stress = without_shear(scene, ways) if inside else None
        return Answer(first, second, SteadyState("frictionless"), FRICTIONLESS, stress)
    return Answer(first, second, SteadyState("sliding"), SLIDES, sliding_state(scene, ways) if inside else None)


def result_of(scene: Scene, found: Answer, inside: bool, clock: Clock) -> Result:
    """Result of the exact method for the steady state ``found``; ``inside``: with stresses below the surface, or the
    reason why they are missing."""
    first, second, state, levels, stress, *_ = found
    anew, regime, turns = scene.presses_anew, state.regime, found.turns
    tractions = ExactTractions(second, first if anew else None, found.dq, None if isinstance(levels, str) else levels)
    breaks = _breaks(scene, found)
    x = sample(breaks if anew else np.union1d(breaks, [second.centre]))
    largest = (first, second)[scene.largest - 1]
    far = abs(sum(largest.ends) / 2 if anew else largest.centre) + SURFACE_REACH * largest.a
    why = undetermined(regime, turns, levels) | (no_stresses(levels) if inside and not stress else {})
    bodies, varying = "strips" if largest.layer else "half-planes", " under varying pressure" if anew else ""
    state = state._replace(notes=remarks(regime, turns, why, anew))
    return replace(
        Result.of("exact", state, largest.a, largest.p0, Traction(x, tractions.at(x), tractions.at, breaks), clock),
        slip=found.slip,
        settings={"model": f"two {bodies}, steady state{varying}"},
        limits=found.limits,
        certificate=found.certificate,
        estimate=largest.layer.left_out(largest.a) if largest.layer else {},
        surface=along_surface(stress.surface, np.sort([-far, *breaks, far])) if stress else None,
        stress_at=StressAt(stress.inside) if stress else None,
        undetermined=why,
        path_dependent=turns,
        contact_ends=(first.ends, second.ends) if anew or second.centre else None,
    )


def _breaks(scene: Scene, found: Answer) -> Array:
    """Points where tractions are not smooth (b,), ascending, m: ends of contacts and of stick zones, and kinks of p."""
    ends = [*found.first.ends, *found.second.ends]
    inner = [*found.breaks, *scene.profile.kinks, *([] if isinstance(found.levels, str) else found.levels.breaks)]
    return np.unique([*ends, *(point for point in inner if min(ends) < point < max(ends))])
