"""Problems in which slip reverses (docs/theory.md, section 7), and a second way to their targets: boundary elements
that are followed event by event."""

from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from partialslip.friction.path_following import Bounds, Follower, Leg
from partialslip.halfplane import contact
from partialslip.halfplane.shape import Shape
from partialslip.halfplane.turning import Turning, half_cycle
from partialslip.march.cells import compliance, forces
from partialslip.scene import Scene
from partialslip.scene.gradual import may_turn_round
from partialslip.tools.arrays import Array

_CELLS = (128, 256)  # accuracy: across the zone that drifts
_HALF_CYCLES = 8  # accuracy: after the first loading; an even number
_LAST = 8  # accuracy: events from which an end is extrapolated to the load point


class _Half(NamedTuple):
    """Last half cycle on cells between ``vertices``: change ``dq`` (c,) of their shear, and the ``leg``; scaled."""

    vertices: Array
    bound: Array
    dq: Array
    leg: Leg


def slip_reverses(scene: Scene) -> bool:
    """Whether slip reverses between the load points of similar half-planes at constant pressure."""
    load = scene.load
    if scene.sized or not scene.mirrored or scene.presses_anew or not load.in_phase:
        return False
    if scene.only_pressed or scene.free or scene.slides or not may_turn_round(scene):
        return False
    cycle = half_cycle(contact(scene), scene.friction.f, load.dQ, load.dsigma, load.dslope)
    return isinstance(cycle, Turning) or not cycle.holds


def event_by_event(scene: Scene, places: tuple[float, ...]) -> dict[str, float]:
    """m, n, dq at the ``places`` (x/a) and the dissipated energy of a ``scene`` in which slip reverses; SI units, by
    keys of targets. The changes of Q and sigma are positive.

    m and n come from the moments at which cells begin to slip and re-stick, extrapolated to the load point and to
    cells of no width. Their width divides that of the zone that drifts, 8 Q_f a/s_f, which is whole cells wide: others
    move m by up to half a cell.
    """
    pressed, f, load = contact(scene), scene.friction.f, scene.load
    Qf, sf = load.dQ / (2 * f * scene.P), load.dsigma / (f * pressed.p0)
    halves = [_half(Qf, sf, count, pressed.shape) for count in _CELLS]
    coarse, fine = (np.array(_stick_ends(half)) for half in halves)
    left, right = (2 * fine - coarse) * pressed.a
    half = halves[-1]
    middles = (half.vertices[1:] + half.vertices[:-1]) / 2
    dq = f * pressed.p0 * CubicSpline(middles, half.dq)(places)
    dissipated = 2 * float(half.leg.path @ half.bound) * scene.material.A * (f * pressed.p0 * pressed.a) ** 2
    shear = {f"dq@{place:g}": float(each) for place, each in zip(places, dq, strict=True)}
    return {"m": float(-left), "n": float(right), **shear, "dissipated": dissipated}


def _half(Qf: float, sf: float, count: int, shape: Shape) -> _Half:
    width = _width(Qf, sf, count)
    whole = round(2 / width)
    vertices = np.linspace(-1, whole * width - 1, whole + 1)
    vertices[-1] = 1.0  # the last cell has what is left
    bound = np.pi / 2 * forces(shape, vertices)
    held = Bounds.constant(bound)
    follower = Follower(compliance(vertices / 2))
    g, Q = sf * (vertices[1:] + vertices[:-1]) / 8, np.pi * Qf
    leg = follower.leg(held, np.zeros_like(bound), g / 2, Q / 2)
    for number in range(_HALF_CYCLES):
        start, sign = leg.forces, (number % 2) * 2 - 1
        leg = follower.leg(held, start, sign * g, sign * Q)
    return _Half(vertices, bound, (leg.forces - start) / np.diff(vertices), leg)


def _width(Qf: float, sf: float, count: int) -> float:
    """Width of ``count`` cells across the zone that drifts, 2 c*."""
    return 8 * Qf / sf / count


def _stick_ends(half: _Half) -> tuple[float, float]:
    """Left and right end at the load point, x/a: where the last cells re-stuck and where the last began to slip."""
    x, leg = (half.vertices[1:] + half.vertices[:-1]) / 2, half.leg
    middle = x[~leg.slips].mean()
    taken, left = (leg.stuck > 0) & (x < middle), (leg.began > 0) & leg.slips & (x > middle)
    return _last(leg.stuck[taken], x[taken]), _last(leg.began[left], x[left])


def _last(share: Array, x: Array) -> float:
    """Where an end that is at ``x`` at a ``share`` of the loads arrives."""
    late = np.argsort(share)[-_LAST:]
    return float(np.polyfit(share[late] - 1, x[late], 2)[-1])
