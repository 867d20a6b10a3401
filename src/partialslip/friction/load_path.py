"""Path of the loads, scaled: lengths by sqrt(A R P), forces by P, displacements by A P."""

import itertools
import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from partialslip.result.state import State
from partialslip.scene import Pressing, Scene
from partialslip.scene.plan import Plan
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

# limit: towards a steady state; 0.995 of the largest mean load takes 35, a large load before the cycles 300
MOST_CYCLES = 200
# accuracy: Change of q over a cycle, in f p, that ends cycles under fully reversed loads: a share of the accuracy,
# within limits
_SETTLED, _STILL = 5e-3, (1e-7, 1e-6)
# accuracy: of the accuracy of a, m and n: the same under other loads, and in cycles that count as steady, however many
# are asked for; q may be off by 15 times that accuracy
_SHARE = 0.5
# limit: tension beside Q, in f P over the scene's length: zones that stick narrow with it, down to rounding
_STRONGEST = 1e4
_STAGES = 32  # accuracy: fewest stages of a leg that is followed event by event


class Missed(NamedTuple):
    """Work of friction that load steps miss in the last cycle, and the error with which that is known; scaled."""

    work: float
    error: float


@dataclass(frozen=True)
class Path:
    """Load path: from ``begin`` to the last load point, then ``cycles`` times through all load points; scaled.

    Cycles end earlier when one changes the tangential force by less than ``settled`` f p at all nodes, and rounding:
    the steady state, where the scene prescribes no number of cycles.

    Parameters
    ----------
    cycle : tuple of tuples
        Loads at the load points: Q, relative strain of the surfaces due to bulk tension at x = 0, and its slope along
        x; under varying pressure also P and M (about the pin if a body pivots).
    ends : (int, int)
        Indices of load points 1 and 2, the extremes of the cycle.
    in_phase : bool
        Whether all load points lie on one line.
    cycles : int
    substeps : int
        Least number of load steps from load point to load point.
    begin : tuple of float
        Loads before the first step.
    before : (n,) array, optional
        Tangential forces before the first step; default zero.
    half : bool
        Whether the first loading determines the cycle: fully reversed loads, no initial shear, no slip reversal.
    one_way : bool
        Whether the pressure is always even and |dQ| >= f |dP| on each load segment, so that Q drives all slip one way.
    ways : tuple of tuples
        Ends of the load steps as ascending fractions up to 1 of each load segment: first to the last load point, then
        to each point of the cycle. Default: ``substeps`` equal steps.
    settled, steady : float
        Change of the tangential force over a cycle, over its bound, that ends the cycles, and that counts as zero in a
        steady state however many cycles are prescribed.
    followed : bool
        Whether, under varying pressure, each load segment is followed event by event, without load steps.
    turns : bool
        Whether slip is known to reverse on a load segment.
    actuator : float, optional
        Compliance of the actuator (0: rigid) whose displacement stands in place of Q; None without one.
    missed : Missed, optional
        Work of friction that the load steps miss: zero if ``followed``, None if not known.
    """

    cycle: tuple[tuple[float, ...], ...]
    ends: tuple[int, int]
    in_phase: bool
    cycles: int
    substeps: int
    begin: tuple[float, ...] = (0.0, 0.0, 0.0)
    before: Array | None = None
    half: bool = False
    one_way: bool = False
    ways: tuple[tuple[float, ...], ...] = ()
    settled: float = 0.0
    steady: float = 0.0
    followed: bool = False
    turns: bool = False
    actuator: float | None = None
    missed: Missed | None = None

    @property
    def fractions(self) -> tuple[tuple[float, ...], ...]:
        """``ways``, by default ``substeps`` equal steps."""
        equal = tuple(np.linspace(0, 1, self.substeps + 1)[1:].tolist())
        return self.ways or (equal,) * (1 + len(self.cycle))

    @property
    def stages(self) -> tuple[float, ...]:
        """Shares of each leg, ascending to 1, at which forces are kept where legs are followed event by event."""
        count = self.substeps * math.ceil(_STAGES / self.substeps)
        return tuple((np.arange(1, count + 1) / count).tolist())

    @property
    def tension_stays(self) -> bool:
        """Whether the bulk tension is constant: at constant pressure, Q drives all slip one way then."""
        return len({load[1:3] for load in (self.begin, *self.cycle)}) == 1

    @property
    def halved(self) -> "Path":
        """Path with every step halved."""
        middles = (
            [(before + after) / 2 for before, after in itertools.pairwise([0.0, *way])] for way in self.fractions
        )
        ways = (tuple(sorted([*way, *middle])) for way, middle in zip(self.fractions, middles, strict=True))
        return replace(self, ways=tuple(ways), half=False)

    def with_steps(self, count: int) -> "Path":
        """Path whose steps also end at ``count`` equal fractions of each way."""
        equal = {number / count for number in range(1, count + 1)}
        return replace(self, ways=tuple(tuple(sorted(equal.union(way))) for way in self.fractions), half=False)

    @property
    def presses_anew(self) -> bool:
        """Whether the pressure varies."""
        return len(self.begin) > 3

    @property
    def moves(self) -> bool:
        """Whether any load changes."""
        return len({self.begin, *self.cycle}) > 1

    @property
    def most_steps(self) -> int:
        """Largest number of steps from one load point to the next."""
        return max(len(way) for way in self.fractions)


def load_path(scene: Scene, plan: Plan, start: State | None = None, on_pin: bool = False) -> Path | None:
    """Scaled path of the loads of ``scene`` from ``start`` (default: zero load); None if ``plan`` has no friction.
    ``on_pin``: whether a body is on a pin, so that its pressure varies with Q.

    Raises InputError where the tension is too strong to be followed.
    """
    if not plan.needs("friction"):
        return None
    _check_tension(scene)
    P, load, A = scene.P, scene.load, scene.material.A
    begins = (start.Q, start.sigma, start.sigma_slope) if start else (0.0, 0.0, 0.0)
    L, unit, actuator = scene.length, P, None  # unit of Q or of the displacement
    if load.displacement is not None:
        unit, actuator = A * P, 1 / (A * load.spring) if load.spring else 0.0
    points = [(drives, *tension) for drives, tension in zip(load.driving, load.tension, strict=True)]
    along = [
        (drives / unit, lower_strain(scene, sigma), lower_strain(scene, slope * L))
        for drives, sigma, slope in (begins, *points)
    ]
    half, one_way = start is None and not plan.needs("history"), False
    loads: list[tuple[float, ...]] = [*along]
    if scene.presses_anew or on_pin:
        presses = scaled_pressing(scene)
        loads = [(*each, *down) for each, down in zip(along, (presses[-1], *presses), strict=True)]
        changes = np.abs(np.diff([loads[0], loads[-1], *loads[1:]], axis=0))
        even = scene.even and actuator is None and not scene.friction.varies and not on_pin
        one_way = even and bool((changes[:, 0] >= scene.friction.f * changes[:, 3]).all())
    begin, *cycle = loads
    # under mean loads the change of a cycle falls with its number only, and little of q changes
    accuracy, steady = scene.fem.accuracy, _SHARE * scene.fem.accuracy
    near = min(max(_SETTLED * accuracy, _STILL[0]), _STILL[1]) if load.fully_reversed else steady
    cycles, settled = (load.cycles, 0.0) if load.cycles else (MOST_CYCLES, near)
    return Path(
        tuple(cycle),
        load.ends,
        load.in_phase,
        cycles,
        load.steps,
        begin,
        half=half,
        one_way=one_way,
        settled=settled,
        steady=steady,
        actuator=actuator,
    )


def scaled_pressing(scene: Scene) -> tuple[tuple[float, float], ...]:
    """(P, M) at the load points, scaled; M about the line of action of P at the load point ``scene.largest``."""
    P, origin, L = scene.P, scene.origin, scene.length
    return tuple((force / P, ((moment or 0.0) - force * origin) / (P * L)) for force, moment in scene.pressing)


def unscaled_pressing(scene: Scene, P: float, M: float) -> Pressing:
    """Normal force and moment, SI, of ``P`` and ``M`` as of :func:`scaled_pressing`."""
    force = scene.P * P
    return Pressing(force, None if scene.M is None else scene.P * scene.length * M + force * scene.origin)


def stretched(x: Array, origin: float) -> Array:
    """Displacements along x, (2, n), at ``x`` (n,) from ``origin`` (scaled), under a strain of 1, and under the strain
    x of a slope of 1; less a rigid shift."""
    return np.array([x, x * (x / 2 + origin)])


def lower_strain(scene: Scene, sigma: float) -> float:
    """Relative strain of the surfaces under the tension ``sigma`` (Pa) of a long lower body, scaled."""
    return scene.material.bodies[0].A / scene.material.A * sigma * scene.length / (4 * scene.P)


def _check_tension(scene: Scene) -> None:
    """Raise InputError for tension that makes the stick zone too narrow for cells and nodes."""
    most = _STRONGEST * scene.friction.f * scene.P / scene.length
    tension = max(map(abs, scene.load.sigma), default=0.0)
    if tension > most and any(scene.load.driving):
        given, allowed = (scene.units.labelled(value, "Pa", 3) for value in (tension, most))
        raise InputError(
            f"load.sigma = {given}: must be <= {allowed} beside Q, by march and fem: what sticks is too narrow"
        )
