"""Refinement of load steps where slip reverses between load points."""

import itertools
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
import numpy.typing as npt

from partialslip.arrays import Array
from partialslip.bars import BARS
from partialslip.condensed.bounded import Factored, Sides, solve_bounded
from partialslip.condensed.history import History, march
from partialslip.condensed.path import Path
from partialslip.condensed.route import Route
from partialslip.condensed.step_errors import Errors

_GROUPS, _HALVINGS, _SOLVES = 64, 6, 400  # groups of nodes on which steps are chosen; limits of halvings and of solves
_TELLING = 1e-7  # change of the forces, relative to f P, above rounding
_TRIED = (0, 1 / 32, 1 / 8, 1 / 2, 3 / 4, 7 / 8, 1)  # fractions of a step tried to detect a reversal of slip
_MANY = 4  # steps per load point from which on each step is tried in halves only
_PROBED = 16  # steps from load point to load point with which fewer steps are compared
_FINER = 16.0  # factor by which the tolerance of steps is reduced if their errors are too large
_FALLS = 0.7  # largest ratio of the errors of steps to those of steps twice as long that makes finer steps worthwhile
MOST = 64  # mean number of steps between load points above which steps are not refined
_CLOSES = 3  # fewest cycles if the first loading does not determine the cycle; most cycles on which steps are chosen


def march_refined(
    tangential: Array,
    stretch: Array,
    bound: Array,
    path: Path,
    accuracy: float,
    errors: Callable[[History, History], Errors] | None = None,
    most: int = MOST,
    factored: Factored | None = None,
    route: Route | None = None,
) -> tuple[History, Errors]:
    """:func:`partialslip.condensed.history.march`, at constant pressure, with steps refined as by
    :func:`follow_refined`."""
    problem, known = (tangential, stretch, bound), (factored or Factored(tangential), route or Route())

    def along(path: Path) -> History:
        return march(*problem, path, *known)

    return follow_refined(along, partial(refined, *problem), path, accuracy, errors, most)


def follow_refined(
    along: Callable[[Path], History],
    chosen: Callable[[Path, float], Path],
    path: Path,
    accuracy: float,
    errors: Callable[[History, History], Errors] | None = None,
    most: int = MOST,
) -> tuple[History, Errors]:
    """Follow the path with refined load steps; return the history and the estimated errors due to the steps.

    Parameters
    ----------
    along : callable
        ``along(path)``: the history along a path, in the steps of the path.
    chosen : callable
        ``chosen(path, tolerance)``: the path with steps chosen for a tolerance (of a), for example by :func:`refined`.
    path : Path
        A path with known ``ways`` is followed in these steps and once more in their halves.
    accuracy : float
        Accuracy of ends, as a fraction of a.
    errors : callable, optional
        ``errors(history, finer)``: errors from a history and the history with all steps halved. Steps are refined until
        every error is at most half of the allowed one. By default steps are not refined further and have no errors.
    most : int
        Mean number of steps from load point to load point above which steps are not refined further.

    The errors are empty if slip does not reverse between load points.

    Each way is compared with at least ``_PROBED`` steps, even where one step seems to suffice: where a small stick zone
    moves while the loads change, a few steps all end with the same tractions, and only many steps follow the zone. The
    first cycles decide.
    """
    known = bool(path.ways)
    history = along(path if known else chosen(path, accuracy))
    if errors is None or history.path.half or one_step_suffices(path):
        return history, {}
    if known:
        halved = along(path.halved)
        return halved, errors(history, halved)
    tolerance, cycles, before = accuracy, min(path.cycles, _CLOSES), np.inf
    while True:
        own = history.path
        whole = own.cycles <= cycles
        first = history if whole else along(replace(own, cycles=cycles))
        finer = along(replace(own.halved.with_steps(_PROBED), cycles=first.path.cycles))
        left = errors(first, finer)
        if all(error <= BARS[key] * accuracy / 2 for key, error in left.items()):
            return history, left
        worst = max(error / BARS[key] for key, error in left.items())
        if (
            path.presses_anew and worst > _FALLS * before
        ):  # what is left is due to the nodes that touch, not to the steps
            return history, left
        before = worst
        if finer.path.mean_steps > most:
            return (finer if whole else history), left
        tolerance /= _FINER
        better = chosen(path, tolerance)
        if better.most_steps > own.most_steps:
            history = along(better.with_steps(_PROBED))
        else:
            history = finer if whole else along(replace(finer.path, cycles=own.cycles))


def one_step_suffices(path: Path) -> bool:
    """Whether the bulk tension is constant, so that Q drives all slip one way, and slip does not reverse; where the
    pressure varies, whether this is known from the loads (:attr:`Path.one_way`)."""
    constant = len({load[1:3] for load in (path.begin, *path.cycle)}) == 1
    return constant and (path.one_way or not path.presses_anew)


def refined(tangential: Array, stretch: Array, bound: Array, path: Path, accuracy: float) -> Path:
    """Path with steps chosen by marching on groups of neighbouring nodes.

    One step suffices where slip does not reverse: the conditions of one step are then those of gradual loading.
    Otherwise each of some steps, smaller towards the load points, is halved until halving does not change the result.
    Slip reverses at one instant, so that few steps are halved often.
    """
    if one_step_suffices(path):
        return path
    coarse = _Coarse(tangential, stretch, bound, accuracy)
    load = np.array(path.begin)
    q = coarse.sums(0 * bound if path.before is None else path.before)
    ways: list[tuple[float, ...]] = []
    ends: list[Array] = []
    followed = max(min(path.cycles, _CLOSES), 1)  # the first cycles differ most
    for point in (*path.cycle[-1:], *followed * path.cycle):
        end = np.array(point)
        fractions, q = coarse.way(q, load, end, path.substeps)
        ways.append(fractions)
        ends.append(q)
        load = end
    if path.half and all(len(fractions) == 1 for fractions in ways) and coarse.same(ends[0], -ends[1]):
        return replace(path, ways=path.fractions)
    if path.half:  # the first loading does not determine the cycle: follow cycles until q is periodic
        path = replace(path, half=False, cycles=max(path.cycles, _CLOSES))
    first, *others = ways
    cycle = len(path.cycle)
    united = (tuple(sorted(set(itertools.chain(*others[number::cycle])))) for number in range(cycle))
    return replace(path, ways=(first, *united))


class _Coarse:
    """Problem on groups of neighbouring nodes: forces of a group are distributed like the friction bounds."""

    def __init__(self, tangential: Array, stretch: Array, bound: Array, accuracy: float) -> None:
        self._first = _groups(len(bound))
        self._bound = self.sums(bound)
        share = bound / np.repeat(self._bound, np.diff(self._first, append=len(bound)))
        self._C = np.add.reduceat(self.sums(share[:, None] * tangential) * share, self._first, axis=1)
        self._factored = Factored(self._C)
        self._factored.expect(_SOLVES)
        self._stretch = [self.sums(share * each) for each in stretch]
        self._sides: Sides | None = None  # of the step before: where the next step begins
        self._near, self._solves = max(accuracy, _TELLING) * float(self._bound.sum()), 0

    def sums(self, forces: Array) -> Array:
        """Sums of nodal ``forces`` (n,) over the groups."""
        result: Array = np.add.reduceat(forces, self._first)
        return result

    def same(self, q: Array, other: Array) -> bool:
        """Whether ``q`` and the ``other`` differ by less than the tolerance."""
        return float(np.abs(q - other).sum()) <= self._near

    def way(self, q: Array, load: Array, end: Array, substeps: int) -> tuple[tuple[float, ...], Array]:
        """Choose steps from ``load`` to ``end``: fractions at which steps end, and the forces at the end."""
        fractions: list[float] = []
        self._solves = 0
        for number in range(substeps):
            stops = [(number + part) / substeps for part in (_TRIED if substeps < _MANY else (0, 1 / 2, 1))]
            loads = [load + stop * (end - load) for stop in stops]
            tried = [q]
            self._sides = None
            for start, stop in itertools.pairwise(loads):
                tried.append(self._step(tried[-1], start, stop))
            whole = self._step(q, loads[0], loads[-1])
            if self.same(tried[-1], whole):
                fractions.append(stops[-1])
                q = whole
                continue
            for (begins, start), (ends, stop) in itertools.pairwise(zip(stops, loads, strict=True)):
                parts, q = self._halve(q, start, stop, self._step(q, start, stop), _HALVINGS)
                fractions += [begins + part * (ends - begins) for part in parts]
        fractions[-1] = 1.0
        return tuple(fractions), q

    def _halve(self, q: Array, load: Array, end: Array, whole: Array, depth: int) -> tuple[list[float], Array]:
        """Fractions and forces for one step, halved until halving changes nothing; ``whole``: forces after one step."""
        middle = (load + end) / 2
        self._sides = None
        first = self._step(q, load, middle)
        second = self._step(first, middle, end)
        if depth == 0 or self._solves > _SOLVES or self.same(second, whole):
            return [1.0], second
        left, at_middle = self._halve(q, load, middle, first, depth - 1)
        right, at_end = self._halve(at_middle, middle, end, self._step(at_middle, middle, end), depth - 1)
        return [0.5 * at for at in left] + [0.5 + 0.5 * at for at in right], at_end

    def _step(self, q: Array, load: Array, end: Array) -> Array:
        self._solves += 1
        free = self._C @ q + (end[1] - load[1]) * self._stretch[0] + (end[2] - load[2]) * self._stretch[1]
        bounds = -self._bound, self._bound
        found = solve_bounded(self._C, free, *bounds, float(end[0]), self._sides, self._factored)
        self._sides = found.sides
        return found.x


def _groups(count: int) -> npt.NDArray[np.int64]:
    """First members of groups of about equal numbers of neighbours, mirror-symmetric."""
    groups = min(_GROUPS, count)
    groups -= (count - groups) % 2
    left = np.arange(groups // 2 + 1) * count // groups
    return np.concatenate([left, count - left[1 : (groups + 1) // 2][::-1]])
