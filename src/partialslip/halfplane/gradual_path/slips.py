"""Slip between stages of half a cycle, from the tractions alone; scaled as in :mod:`partialslip.halfplane.shape`.

A change dq of shear traction and dsigma of tension displace the surfaces relative to each other by

    k(x) = (1/pi) int dq(t) ln|x - t| dt + dsigma x/4,

up to a rigid displacement: k is constant where the surfaces stick. The slip is what k differs by from there. Within
one phase of the half cycle, each side of the stick zone slips one way, and so does a zone inside.
"""

import itertools
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from partialslip.halfplane.gradual_path.graded import spans
from partialslip.halfplane.gradual_path.half_cycle import HalfCycle, between
from partialslip.halfplane.gradual_path.stage import Stage, lasting
from partialslip.halfplane.slip import Worn
from partialslip.tools.arrays import Array

_COMMON = 0.25  # accuracy: least share of a stick zone that sticks from stage to stage
# accuracy: Gauss points between breaks: of the work, and of the rule that tells its error
_RULE, _FEWER = (np.polynomial.legendre.leggauss(count) for count in (16, 8))


class Resultants(NamedTuple):
    """Force int dq dx and moment int x dq dx of a change of q."""

    shear: float
    moment: float


def slip_stages(way: HalfCycle) -> list[Stage]:
    """Stages of the ``way``, between which phases do not change and some points stick."""
    found = [way.phases[0].first]
    for phase in way.phases:
        found += between(phase, found[-1], phase.last, _COMMON)
    return found


def slips(way: HalfCycle) -> Worn:
    """Slip over half a cycle and the dissipated energy; its error is the difference from a rule of fewer points."""
    along = slip_stages(way)
    ends = [*itertools.chain(*(_breaks(stage) for stage in along))]
    breaks = np.unique(np.round(ends, 14))
    breaks = breaks[np.append(True, np.diff(breaks) > 1e-13)]
    half = np.diff(breaks)[:, None] / 2
    rules = []
    for nodes, factors in (_RULE, _FEWER):
        angle = np.pi / 2 * (1 + nodes)
        x = (breaks[:-1, None] + half * (1 - np.cos(angle))).ravel()
        rules.append((x, (half * np.pi / 2 * factors * np.sin(angle)).ravel()))
    points = np.concatenate([[-1.0], *(x for x, _ in rules), [1.0]])
    pressure, count = way.start.shape.pressure(points), len(rules[0][0])
    net, worn = np.zeros(len(points)), np.zeros(len(points))
    for first, last in itertools.pairwise(along):
        slip = _slip_between_stages(way, first, last, points)
        net += slip
        worn += pressure * np.abs(slip)
    work, other = 2 * rules[0][1] @ worn[1 : count + 1], 2 * rules[1][1] @ worn[count + 1 : -1]
    of = np.array([0, *range(1, count + 1), len(points) - 1])
    return Worn(points[of], net[of], float(work), abs(float(work - other)))


def loop(way: HalfCycle, shares: Array) -> tuple[Array, Array]:
    """Displacement and moment since the beginning of half a cycle at ``shares`` (k,) of the loads, ascending from 0, in
    A f p0 a and f p0 a^2; see :func:`displacement`."""
    known = slip_stages(way)
    inner = [way.at(share) for share in shares.tolist() if 0 < share < 1]
    along = sorted([*known, *inner], key=lambda stage: stage.progress)
    pairs = list(itertools.pairwise(along))
    moved = np.cumsum([0.0, *(displacement(way, *pair) for pair in pairs)])
    moments = np.cumsum([0.0, *(resultants(*pair).moment for pair in pairs)])
    progress = [stage.progress for stage in along]
    return np.interp(shares, progress, moved), np.interp(shares, progress, moments)


def displacement(way: HalfCycle, first: Stage, last: Stage) -> float:
    """Relative displacement of the bodies, less that of the adhered contact, from the ``first`` to the ``last`` of two
    stages at which common points stick; in A f p0 a."""
    shear = (last.progress - first.progress) * way.loads.shear
    at = float(_mismatch(way, first, last, np.array([_sticks(first, last)]))[0])
    return -at - shear / math.pi * math.log(2)


def resultants(first: Stage, last: Stage) -> Resultants:
    """Resultants of the change of q from stage to stage."""
    t, weights, change = _sampled(first, last)
    return Resultants(float(weights @ change), float(weights @ (t * change)))


def _slip_between_stages(way: HalfCycle, first: Stage, last: Stage, x: Array) -> Array:
    """Slip at ``x`` (k,) from stage to stage."""
    found = _mismatch(way, first, last, np.append(x, _sticks(first, last)))
    sticks = np.any([(x >= low) & (x <= high) for low, high in lasting(first, last)], axis=0)
    return np.where(sticks, 0.0, found[:-1] - found[-1])


def _mismatch(way: HalfCycle, first: Stage, last: Stage, x: Array) -> Array:
    """k at ``x`` (k,): quadrature over the pieces between breaks; the piece around each point is split there."""
    breaks = _pieces(first, last)
    low, high = breaks[:-1], breaks[1:]
    t, weights, change = (each.reshape(len(low), -1) for each in _sampled(first, last))
    logs = np.log(np.maximum(np.abs(x[:, None, None] - t), 1e-300))
    by_piece = np.einsum("kpn,pn->kp", logs, weights * change)
    own = np.clip(np.searchsorted(breaks, x, "right") - 1, 0, len(low) - 1)
    by_piece[np.arange(len(x)), own] = 0.0
    result = by_piece.sum(axis=1)
    for side, begin, end in ((-1, low[own], x), (1, x, high[own])):
        from_begin, to_end, shares = spans(begin, np.maximum(end, begin))
        distance = from_begin if side > 0 else to_end
        at = x[:, None] + side * distance
        values = (last.q(at.ravel()) - first.q(at.ravel())).reshape(at.shape)
        result += (shares * values * np.log(np.maximum(distance, 1e-300))).sum(axis=1)
    tension = (last.progress - first.progress) * way.loads.tension
    return result / np.pi + tension / 4 * x


def _sampled(first: Stage, last: Stage) -> tuple[Array, Array, Array]:
    """Points, weights of quadrature and the change of q there from stage to stage."""
    breaks = _pieces(first, last)
    from_low, _, weights = spans(breaks[:-1], breaks[1:])
    t = (breaks[:-1, None] + from_low).ravel()
    return t, weights.ravel(), last.q(t) - first.q(t)


def _pieces(first: Stage, last: Stage) -> Array:
    """Places between which the change of q is smooth."""
    return np.unique([*_breaks(first), *_breaks(last)])


def _breaks(stage: Stage) -> Sequence[float]:
    shape = stage.q.shape
    inner = (*shape.kinks, *stage.q.breaks, *itertools.chain(*stage.sticks))
    return [-1.0, *(each for each in inner if -1 < each < 1), 1.0]


def _sticks(first: Stage, last: Stage) -> float:
    """Middle of the widest interval that sticks from stage to stage."""
    return max(lasting(first, last), key=lambda zone: zone.half_width).centre
