"""Coulomb friction under a constant normal force, step by step through the load history.

Scaled: lengths by sqrt(A R P), forces by P and displacements by A P, so that nothing depends on units.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from partialslip.condensed.bounded import Solution, solve_bounded
from partialslip.condensed.zones import Zone
from partialslip.plan import Plan
from partialslip.result import Array, Regime
from partialslip.scene import Scene

_STEADY = 1e-6  # change of q in a cycle, in f p0, that counts as none
_RATCHETS = 1e-3  # net slip of a cycle, in the slip of half a cycle, that counts where q has settled


@dataclass(frozen=True)
class Path:
    """Where the loads go: (Q, relative strain of the surfaces due to bulk tension) at the points of a cycle, scaled.

    ``ends`` are the indices of load points 1 and 2, the extremes of the cycle.
    """

    cycle: tuple[tuple[float, float], ...]
    ends: tuple[int, int]
    in_phase: bool
    cycles: int
    substeps: int

    @property
    def loads(self) -> tuple[tuple[float, float], ...]:
        """The load points in turn: the last one, and then the cycle again and again."""
        return (self.cycle[-1], *(self.cycle * self.cycles))


@dataclass(frozen=True)
class History:
    """What a path has done.

    Parameters
    ----------
    path : Path
    points : list of Solution
        At the load points in turn, certified over the way there.
    at_ends : two (n,) arrays
        Tangential forces at load points 1 and 2 of the last cycle.
    q1, q2 : (n,) arrays
        The same; where Q and sigma are out of phase the least and the largest ones of that cycle.
    slip : (n,) array
        From load point 1 to 2 of the last cycle.
    net_slip : (n,) array
        What the last cycle has added to the slip: in a steady state nothing.
    dissipated : float
        Work against friction over the last cycle.
    """

    path: Path
    points: list[Solution]
    at_ends: tuple[Array, Array]
    q1: Array
    q2: Array
    slip: Array
    net_slip: Array
    dissipated: float

    @property
    def change(self) -> Array:
        """q2 - q1."""
        result: Array = self.q2 - self.q1
        return result

    @property
    def load_steps(self) -> int:
        """Steps solved."""
        return len(self.points) * self.path.substeps

    @property
    def iterations(self) -> int:
        """Faces solved."""
        return sum(step.iterations for step in self.points)


class Verdict(NamedTuple):
    """Regime, the stick zone's centre and half-width (None where nothing sticks), and what must be said of them."""

    regime: Regime
    centre: float | None
    half_width: float | None
    notes: tuple[str, ...]


def load_path(scene: Scene, plan: Plan) -> Path | None:
    """The path of the loads, scaled; None where there is no friction to solve."""
    if not plan.needs("friction") or slides(scene):
        return None
    P, L, load = scene.P, scene.length, scene.load
    cycle = tuple((Q / P, sigma * L / (4 * P)) for Q, sigma in load.points)
    return Path(cycle, load.ends, load.in_phase, load.cycles, load.steps)


def slides(scene: Scene) -> bool:
    """Whether friction cannot carry Q: no forces within the bound could sum to it."""
    return max(abs(Q) for Q, _ in scene.load.points) >= scene.friction.f * scene.P


def march(tangential: Array, x: Array, bound: Array, path: Path) -> History:
    """Tangential forces along the path, every step of it certified.

    At constant pressure a step is a convex problem: where nothing slips, the relative displacement keeps what it
    was, so that C (T - T_before) follows the increment of the free relative displacement.

    Parameters
    ----------
    tangential : (n, n) array
        Relative compliance C of what is in contact.
    x : (n,) array
        Where it is.
    bound : (n,) array
        f times its normal forces.
    path : Path
    """
    points: list[Solution] = []
    before, load_before = 0 * x, np.zeros(2)
    slip, dissipated, least, largest = 0 * x, 0.0, np.inf + x, -np.inf + x
    slips: list[Array] = []
    for number, load in enumerate(path.loads):
        in_last_cycle = number >= len(path.loads) - len(path.cycle)
        way = []
        for Q, strain in np.linspace(load_before, load, path.substeps + 1)[1:].tolist():
            free = tangential @ before + (strain - load_before[1]) * x
            way.append(solve_bounded(tangential, free, -bound, bound, Q))
            before, load_before = way[-1].x, np.array([Q, strain])
            if in_last_cycle:
                slip = slip - way[-1].rest
                dissipated -= float(way[-1].x @ way[-1].rest)
                least, largest = np.minimum(least, before), np.maximum(largest, before)
        slips.append(slip)
        points.append(
            Solution(
                x=before,
                rest=way[-1].rest,
                residual=np.max([step.residual for step in way], axis=0),
                imbalance=max(step.imbalance for step in way),
                iterations=sum(step.iterations for step in way),
            )
        )
    cycle, slips = points[-len(path.cycle) :], slips[-len(path.cycle) :]
    first, second = path.ends
    if path.in_phase:
        least, largest = cycle[first].x, cycle[second].x
    return History(
        path=path,
        points=points,
        at_ends=(cycle[first].x, cycle[second].x),
        q1=least,
        q2=largest,
        slip=slips[second] - slips[first],
        net_slip=slip,
        dissipated=dissipated,
    )


def certificate(history: History, weights: Array, f: float, p0: float) -> dict[str, float]:
    """``kkt``: residuals as tractions, in f p0; ``equilibrium``: of Q, relative to f P; ``steady``: change of q between
    the last two visits of the last load point, in f p0. ``weights`` (n,) turn tractions into forces."""
    held, points = weights * f * p0, history.points
    return {
        "kkt": max(float((step.residual / held).max()) for step in points),
        "equilibrium": max(step.imbalance for step in points) / f,
        "steady": float((np.abs(points[-1].x - points[-1 - len(history.path.cycle)].x) / held).max()),
    }


def judge(scene: Scene, history: History | None, stick: Zone | None, half_width: float, steady: float) -> Verdict:
    """What it means that the stick zone of ``scene`` has been found to be ``stick`` (None: there was no friction to
    solve), in a contact of ``half_width``; lengths in any one unit. ``steady`` is the certificate's."""
    load = scene.load
    if slides(scene):
        note = "the contact slides: |Q| >= f P at a load point; there is no steady partial slip"
        return Verdict("sliding", None, None, (note,))
    if history is None or stick is None or (load.dQ == 0 and load.dsigma == 0):  # nothing changes: all of it sticks
        return Verdict("stuck", 0.0, half_width, ())
    notes: tuple[str, ...] = ()
    if stick.left == stick.right:
        notes = ("the stick zone is smaller than an element: m and n are where the slip turns round",)
    regime: Regime = "small tension" if stick.signs[0] == stick.signs[1] else "large tension"
    if not load.in_phase:
        regime = "out of phase"
    added = float(np.abs(history.net_slip).max() / np.abs(history.slip).max())
    if steady <= _STEADY and added > _RATCHETS:
        regime = "ratchets"
        notes += (
            f"tractions repeat, slip does not: every cycle adds up to {added:.1g} times the slip of half a cycle",
        )
    return Verdict(regime, (stick.right + stick.left) / 2, (stick.right - stick.left) / 2, notes)


def doubts(certificate: Mapping[str, float], errors: Mapping[str, float], accuracy: float) -> tuple[str, ...]:
    """Notes on an accuracy that was not reached, and on q that still changed in the last cycle."""
    notes: tuple[str, ...] = ()
    ends = {key: error for key, error in errors.items() if key in ("a", "m", "n")}
    if max(ends.values(), default=0.0) > accuracy:
        known = ", ".join(f"{key} {error:.1e}" for key, error in ends.items())
        notes += (f"accuracy {accuracy:g} not reached: the ends are known to {known} a",)
    if (change := certificate.get("steady", 0.0)) > max(accuracy, _STEADY):
        notes += (f"not steady: q changed by {change:.1e} f p0 in the last cycle; take more of them (load.cycles)",)
    return notes
