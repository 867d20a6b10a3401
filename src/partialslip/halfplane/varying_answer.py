"""Steady cycles under varying pressure: the regime, and q1 and q2 where the first loading determines them; SI units."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from partialslip.halfplane.answer import Answer, AtLoadPoints, without_cycle
from partialslip.halfplane.levels import RATCHETS, STARTED
from partialslip.halfplane.loading import Loading
from partialslip.halfplane.mean_pressure import PressurePath, common
from partialslip.halfplane.proportional import loading
from partialslip.halfplane.states import varying, without_shear
from partialslip.halfplane.varying import Cycle, steady_cycle
from partialslip.result import PATH_DEPENDENT, SteadyState
from partialslip.scene import Scene
from partialslip.tools.arrays import Array

_ROUNDING = 1e-9  # accuracy: lengths in a, tractions in f p0
_STAGES = np.linspace(0, 1, 9)
_PLACES = np.cos(np.linspace(np.pi, 0, 81))[1:-1]


def under_varying_pressure(scene: Scene, slipping: bool, started: bool, inside: bool) -> Answer:
    """The steady state of ``scene``, whose P or M varies, under loads in phase.

    ``slipping``: whether there is friction; ``started``: whether the path begins in a state, on which q1 and q2 then
    depend; ``inside``: whether stresses are asked for.
    """
    if slipping:
        return _cycling(steady_cycle(scene), started, inside)
    ways = PressurePath.both(scene)
    first, second = ways[0].begin, ways[0].end
    if scene.free or scene.slides:
        return without_cycle(scene, first, second, ways, inside)
    left, right = stick = common(first, second)
    state = SteadyState("stuck", (left + right) / 2, (right - left) / 2)
    return Answer(first, second, state, NoShear(), without_shear(scene, ways) if inside else None, breaks=stick)


def _cycling(cycle: Cycle, started: bool, inside: bool) -> Answer:
    (left, right), (low, high), half = cycle.stick, cycle.bounds_of_Q1, cycle.scene.load.dQ / 2
    regime, change, levels = cycle.regime, cycle.change, _levels(cycle, started)
    return Answer(
        cycle.first,
        cycle.second,
        SteadyState(regime, (left + right) / 2, (right - left) / 2, slips=cycle.slips),
        levels,
        varying(cycle, levels.loaded) if inside and isinstance(levels, FirstLoading) else None,
        cycle.dq,
        cycle.stick,
        cycle.turns_round,
        cycle.slip() if regime != "ratchets" else None,
        change.certificate if change else {},
        {"Q_mean_least": low + half, "Q_mean_most": high + half},
    )


@dataclass(frozen=True)
class FirstLoading:
    """q2 is that of the first loading, ``loaded``, to load point 2 of the ``cycle``; q1 differs by the change."""

    cycle: Cycle
    loaded: Loading

    @property
    def breaks(self) -> list[float]:
        """Ends of the stick zone of the first loading, m."""
        return self.cycle.second.places(self.loaded.ends).tolist()

    def q(self, x: Array) -> tuple[Array, Array]:
        """q1 and q2 at ``x`` (m), Pa."""
        q2 = self.loaded.within(self.cycle.second, self.cycle.scene.friction.f, x)
        return q2 - self.cycle.dq(x), q2


class NoShear:
    """q1 and q2 are zero."""

    breaks: ClassVar[list[float]] = []

    def q(self, x: Array) -> tuple[Array, Array]:
        """q1 and q2 at ``x`` (m), Pa."""
        return np.zeros_like(x), np.zeros_like(x)


def _levels(cycle: Cycle, started: bool) -> AtLoadPoints | str:
    """q1 and q2, or the reason why there are none."""
    if cycle.regime == "ratchets":
        return RATCHETS
    return STARTED if started else _first_loading(cycle)


def _first_loading(cycle: Cycle) -> FirstLoading | str:
    """The first loading to load point 2, if its traction is that of the steady ``cycle``; otherwise why not.

    As under constant pressure (:func:`partialslip.halfplane.levels.levels`): the first loading slips wherever the cycle
    slips, and the same way, and the traction less the change stays within the bound all the way to load point 1.
    """
    f, load = cycle.scene.friction.f, cycle.scene.load
    if cycle.change is None:
        return "where an end sticks, what the first cycles lock in has no closed form; use march"
    if load.ends[1] != len(load.points) - 1 or len(load.points) > 2:
        return "the path goes through more than two load points; use march"
    end = cycle.second
    loads = load.along[load.ends[1]]
    if not any(loads):
        return "no load acts along x at load point 2, and the cycle slips; use march"
    first = loading(end, f, *loads, bound=1)
    if first.left_end_turns():
        return f"{PATH_DEPENDENT}during the first loading; use march"
    left, right = end.places(first.ends)
    room = _ROUNDING * end.a
    if not (cycle.stick[0] - room <= left and right <= cycle.stick[1] + room) or first.signs != cycle.change.signs:
        return "mean loads act, and the cycle slips where the first loading sticks; use march"
    for back in (True, False):
        way = cycle.ways[back]
        for share in _STAGES[1:].tolist():
            now, mean, part = way.stage(share)
            x = mean.places(_PLACES)
            q = first.within(end, f, x) + part.within(mean, f, x)
            if not back:
                q = q - cycle.dq(x)
            if (np.abs(q) > f * (now.pressure(x) + _ROUNDING * mean.p0)).any():
                return "mean loads act, and the first loading less the change exceeds f p; use march"
    return FirstLoading(cycle, first)
