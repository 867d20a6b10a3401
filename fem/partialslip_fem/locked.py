"""Errors of the ends of the stick zone due to slip that is locked in where nodes re-stuck on the way.

The ends depend on the loads and on the slip s that is locked in within the stick zone, and on nothing else: where no
node has slipped, s is zero without any error. An error of s answers at an end like a dislocation. With the zone's
half-width c, the distance t from its middle in c and w = sqrt((1 + t)/(1 - t)), it makes a singularity of the strength
K = 1/(pi sqrt(2 c)) \\|int w s' dx\\| at the right end, t = 1. The end moves by 2 K/S, where S is the strength of the
kink of q. An end that moved over points that slipped has no such kink: while the zone drifts its half-width follows
from the loads, so that both ends move alike.

Two errors of s are known. One is the difference of two solutions on the same mesh. The other has the same sign in both:
the end that moves outwards waits until the other end, which leaves node after node, has lost one. Then it jumps over
many nodes at once, however small their elements are. An end that waits while the loads cover the share d of a leg that
strains by 2 e, and is off by the length l, lets points ahead slip by too much or too little, by about
2/3 e d l^(3/2)/sqrt(2 c). Regular jumps over a length L go to and fro about the way of the end: 0.07 remains of this
with l = L. Where waits and lengths are not in proportion, the way between the jumps before and after, by interpolation,
passes the middle of the jump at a distance, and its sides at up to twice that: this is l, at most L. It rises from 0
since the jump before and falls to 0 until the jump after: d is 2/5 of that time. A short hop just before a long jump
hides nothing of it. l is L where there are no such jumps; d is then how long the end waited, as it is for a part.

An error of s that comes and goes within an interval answers with the change of w over the interval. Beside the end,
where w is singular, that is too much: an error that grows from one side of the interval to the other answers with the
mean of w. Where the other end has come back over a part of a jump, the part that is left has a share of the error that
does not go within the zone: there the mean counts, with the length of the whole jump. To and fro do not cancel in a
part: l is at least L/2. Errors of different places are independent of each other: their squares are added. But slip
that is off where an end reversed stays off for all points that the end takes after that: an end is known no better
than the sum, with signs, of what the difference of two solutions moves it by.
"""

import numpy as np

from partialslip.tools.arrays import Array, Indices
from partialslip_fem.mesh_solution import MeshSolution

# accuracy: errors of the ends, in what follows from the difference of the slip in two solutions; and factors of
# e d l^(3/2)/sqrt(2 c) for regular jumps with l = L, twice what theory says, and for jumps off the way (measured:
# benchmarks/estimates.py)
_DIFFERENT, _REGULAR, _OFF = 1.5, 0.15, 1.0
_RISES_AND_FALLS = 2 / 5  # fixed: mean of t^(3/2) for t from 0 to 1
_TINY = float(np.finfo(float).tiny)


def locked_in(solution: MeshSolution, other: MeshSolution, strengths: Array) -> Array:
    """Errors of the left and the right end of the stick zone of ``solution`` due to locked-in slip, (2,), scaled.

    Parameters
    ----------
    solution, other : MeshSolution
        On the same mesh, with elements of different order.
    strengths : (2,) array
        Strengths of the kinks of (q2 - q1)/2 at the ends.
    """
    stick, history = solution.stick, solution.history
    assert stick
    assert history
    half_width, middle = (stick.right - stick.left) / 2, (stick.left + stick.right) / 2
    if half_width <= 0:
        return np.zeros(2)
    places, differences = _differences(solution, other)
    intervals, jumps = _jumps(solution)
    answers = []
    for way, strength in zip((-1, 1), strengths.tolist(), strict=True):
        at = way * (places - middle)[::way] / half_width
        slip = differences[::way]
        apart = (slip[1:] + slip[:-1]) / 2 - slip[-1:]
        different = _DIFFERENT * np.diff(_weight(at)) * apart
        low, high = np.sort(way * (intervals - middle) / half_width, axis=0)
        inside = np.clip([low, high], -1.0, 1.0)
        weights = np.minimum(np.diff(_weight(inside), axis=0)[0], np.diff(_integral(inside), axis=0)[0] / (high - low))
        independent = np.hypot(np.linalg.norm(different), np.linalg.norm(weights * jumps))
        off = max(float(independent), abs(float(different.sum())))
        answers.append(2 * off / (np.pi * np.sqrt(2 * half_width) * max(strength, _TINY)))
    left, right = answers
    if stick.moved[0] != stick.moved[1]:
        left = right = right if stick.moved[0] else left
    return np.array([left, right])


def _weight(at: Array) -> Array:
    """w at the distances ``at`` from the middle of the stick zone, in its half-widths."""
    return np.sqrt(np.maximum(1 + at, 0.0) / np.maximum(1 - at, _TINY))


def _integral(at: Array) -> Array:
    """Integral of w over the distance, at the distances ``at`` from the middle of the stick zone, at most 1."""
    return np.arcsin(at) - np.sqrt(np.maximum(1 - at**2, 0.0))


def _differences(solution: MeshSolution, other: MeshSolution) -> tuple[Array, Array]:
    """Vertices in the stick zones of both solutions, (k,), and half of the difference of the slip there from load point
    1 to 2, (k,)."""
    vertices, slips = solution.lower.x[:: solution.lower.order], []
    for each in (solution, other):
        assert each.stick
        vertices = vertices[(vertices > each.stick.left) & (vertices < each.stick.right)]
    for each in (solution, other):
        assert each.history
        slips.append(np.interp(vertices, each.lower.x[each.nodes], each.history.slip))
    return vertices, (slips[1] - slips[0]) / 2


def _jumps(solution: MeshSolution) -> tuple[Array, Array]:
    """Intervals over which an end of the stick zone jumped, (2, j): nodes that re-stuck in one event, some of them in
    the stick zone of ``solution``; and errors of half the slip locked in there, (j,)."""
    stick, history = solution.stick, solution.history
    assert stick
    assert history
    if history.lasting is None or history.stuck is None:
        return np.empty((2, 0)), np.empty(0)
    since, x = np.where(np.isfinite(history.lasting), history.stuck, np.nan), solution.lower.x[solution.nodes]
    nodes = np.flatnonzero(np.isfinite(since))
    starts = np.flatnonzero((np.diff(since[nodes], prepend=np.nan) != 0) | (np.diff(nodes, prepend=-2) > 1))
    first, last = nodes[starts], nodes[np.append(starts[1:], len(nodes))[: len(starts)] - 1]
    edges = np.concatenate([x[:1], (x[1:] + x[:-1]) / 2, x[-1:]])
    intervals = np.array([edges[first], edges[last + 1]])
    (one, two), cycle = history.path.ends, history.path.cycle
    strain = abs(cycle[two][1] - cycle[one][1]) / 2
    lengths = np.diff(intervals, axis=0)[0]
    cut = (intervals[0] < stick.left) | (intervals[1] > stick.right)
    waited = _waited(since, first, last)
    apart, away = _off_the_way(since[first], intervals, waited)
    parted = np.where(cut, waited * (lengths / 2) ** 1.5, 0.0)
    off = np.hypot(_REGULAR * waited * lengths**1.5, _OFF * np.maximum(away * apart**1.5, parted))
    errors = strain * off / np.sqrt(stick.right - stick.left)
    left = (intervals[0] < stick.right) & (intervals[1] > stick.left)
    return intervals[:, left], errors[left]


def _waited(since: Array, first: Indices, last: Indices) -> Array:
    """Shares of the leg that an end waited before it jumped over the nodes from ``first`` to ``last``, (j,) each: at
    most since the jump over nodes beside these, and since the last instant at which any node changed."""
    instants = since[first]
    apart = np.abs(np.diff(instants, prepend=np.nan, append=np.nan))
    apart[1:-1][first[1:] > last[:-1] + 1] = np.nan
    every = np.append(0.0, np.unique(since[np.isfinite(since)]))
    before = instants - every[np.maximum(np.searchsorted(every, instants) - 1, 0)]
    return np.fmin(np.fmin(apart[1:], apart[:-1]), before)


def _off_the_way(instants: Array, intervals: Array, waited: Array) -> tuple[Array, Array]:
    """Distance of an end of the stick zone from its path, and duration (shares of the leg), (j,) each, at jumps over
    ``intervals`` (2, j) at the ``instants`` (j,).

    The distance is twice that of the middle of a jump from the line through the middles of the neighbouring jumps, at
    most the length of the jump; it rises and falls linearly between these. Without neighbouring jumps: the length of
    the jump, for the time that the end ``waited`` (j,).
    """
    lengths, middles = intervals[1] - intervals[0], intervals.mean(axis=0)
    result, times = lengths.copy(), waited.copy()
    if len(instants) < 3:
        return result, times
    since, until = np.diff(instants)[:-1], np.diff(instants)[1:]
    beside = intervals[1, :-1] == intervals[0, 1:]
    known = (since * until > 0) & beside[:-1] & beside[1:]
    share = np.divide(since, since + until, out=np.zeros_like(since), where=known)
    off = 2 * np.abs(middles[1:-1] - middles[:-2] - share * (middles[2:] - middles[:-2]))
    result[1:-1] = np.where(known, np.minimum(off, lengths[1:-1]), lengths[1:-1])
    times[1:-1] = np.where(known, _RISES_AND_FALLS * np.abs(since + until), times[1:-1])
    return result, times
