"""Coulomb friction under a constant normal force, step by step through the load history.

Scaled: lengths by sqrt(A R P), forces by P and displacements by A P, so that nothing depends on units.
"""

from collections.abc import Iterable, Mapping
from typing import NamedTuple

import numpy as np

from partialslip.condensed.bounded import Solution, solve_bounded
from partialslip.condensed.zones import Zone
from partialslip.plan import Plan
from partialslip.result import Array, Regime
from partialslip.scene import Scene

_STEADY = 1e-6  # change of q in a cycle, in f p0, that counts as none


class Verdict(NamedTuple):
    """Regime, the stick zone's centre and half-width (None where nothing sticks), and what must be said of them."""

    regime: Regime
    centre: float | None
    half_width: float | None
    notes: tuple[str, ...]


def load_points(scene: Scene, plan: Plan) -> list[tuple[float, float]]:
    """(Q, relative strain of the surfaces due to bulk tension) at the load points in turn, scaled.

    The cycle runs 0 -> point 2 -> point 1 -> point 2 ...; empty where there is no friction to solve.
    """
    if not plan.needs("friction") or slides(scene):
        return []
    P, L, load = scene.P, scene.length, scene.load
    point1, point2 = ((Q / P, sigma * L / (4 * P)) for Q, sigma in zip(load.Q, load.sigma, strict=True))
    return [point2] + [point1, point2] * load.cycles


def slides(scene: Scene) -> bool:
    """Whether friction cannot carry Q: no forces within the bound could sum to it."""
    return max(map(abs, scene.load.Q)) >= scene.friction.f * scene.P


def march(
    tangential: Array, x: Array, bound: Array, loads: Iterable[tuple[float, float]], substeps: int = 1
) -> list[Solution]:
    """Tangential forces at each load point, certified over the way there.

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
    loads : iterable of (Q, strain)
        Tangential force and relative strain of the two surfaces due to bulk tension, at each load point.
    substeps : int
        In how many equal steps each is reached. Slip that turns round on the way shows in several only.
    """
    points: list[Solution] = []
    before, load_before = 0 * x, np.zeros(2)
    for load in loads:
        way = []
        for Q, strain in np.linspace(load_before, load, substeps + 1)[1:].tolist():
            free = tangential @ before + (strain - load_before[1]) * x
            way.append(solve_bounded(tangential, free, -bound, bound, Q))
            before, load_before = way[-1].x, np.array([Q, strain])
        points.append(
            Solution(
                x=way[-1].x,
                residual=np.max([step.residual for step in way], axis=0),
                imbalance=max(step.imbalance for step in way),
                iterations=sum(step.iterations for step in way),
            )
        )
    return points


def certificate(steps: list[Solution], weights: Array, f: float, p0: float) -> dict[str, float]:
    """``kkt``: residuals as tractions, in f p0; ``equilibrium``: of Q, relative to f P; ``steady``: change of q between
    the last two visits of load point 2, in f p0. ``weights`` (n,) turn tractions into forces."""
    held = weights * f * p0
    return {
        "kkt": max(float((step.residual / held).max()) for step in steps),
        "equilibrium": max(step.imbalance for step in steps) / f,
        "steady": float((np.abs(steps[-1].x - steps[-3].x) / held).max()),
    }


def judge(scene: Scene, stick: Zone | None, half_width: float) -> Verdict:
    """What it means that the stick zone of ``scene`` has been found to be ``stick`` (None: there was no friction to
    solve), in a contact of ``half_width``; lengths in any one unit."""
    load = scene.load
    if slides(scene):
        note = "the contact slides: |Q| >= f P at a load point; there is no steady partial slip"
        return Verdict("sliding", None, None, (note,))
    if stick is None or (load.dQ == 0 and load.dsigma == 0):  # nothing changes over the cycle: all of it sticks
        return Verdict("stuck", 0.0, half_width, ())
    notes: tuple[str, ...] = ()
    if stick.left == stick.right:
        notes = ("the stick zone is smaller than an element: m and n are where the slip turns round",)
    regime: Regime = "small tension" if stick.signs[0] == stick.signs[1] else "large tension"
    return Verdict(regime, (stick.right + stick.left) / 2, (stick.right - stick.left) / 2, notes)


def doubts(certificate: Mapping[str, float], errors: Mapping[str, float], accuracy: float) -> tuple[str, ...]:
    """Notes on an accuracy that was not reached, and on q that still changed in the last cycle."""
    notes: tuple[str, ...] = ()
    if max(errors.values(), default=0.0) > accuracy:
        known = ", ".join(f"{key} {error:.1e}" for key, error in errors.items())
        notes += (f"accuracy {accuracy:g} not reached: the ends are known to {known} a",)
    if (change := certificate.get("steady", 0.0)) > max(accuracy, _STEADY):
        notes += (f"not steady: q changed by {change:.1e} f p0 in the last cycle; take more of them (load.cycles)",)
    return notes
