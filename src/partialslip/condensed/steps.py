"""Refinement of load steps where the pressure varies."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from partialslip.bars import BARS
from partialslip.condensed.history import History
from partialslip.condensed.path import Path
from partialslip.condensed.step_errors import Errors

_PROBED = 16  # steps from load point to load point with which fewer steps are compared
_FALLS = 0.7  # largest ratio of the errors of steps to those of steps twice as long that makes finer steps worthwhile
MOST = 64  # mean number of steps between load points above which steps are not refined
_CLOSES = 3  # most cycles on which steps are chosen


def follow_refined(
    along: Callable[[Path], History],
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
    path : Path
        A path with known ``ways`` is followed in these steps and once more in their halves.
    accuracy : float
        Accuracy of ends, as a fraction of a.
    errors : callable, optional
        ``errors(history, finer)``: errors from a history and the history with all steps halved. Steps are refined until
        every error is at most half of the allowed one. By default steps are not refined further and have no errors.
    most : int
        Mean number of steps from load point to load point above which steps are not refined further.

    The errors are empty if one step suffices.

    Each way is compared with at least ``_PROBED`` steps, even where one step seems to suffice: where a small stick zone
    moves while the loads change, a few steps all end with the same tractions, and only many steps follow the zone. The
    first cycles decide.
    """
    history = along(path)
    if errors is None or path.half or one_step_suffices(path):
        return history, {}
    if path.ways:
        halved = along(path.halved)
        return halved, errors(history, halved)
    cycles, before = min(path.cycles, _CLOSES), np.inf
    while True:
        own = history.path
        whole = own.cycles <= cycles
        first = history if whole else along(replace(own, cycles=cycles))
        finer = along(replace(own.halved.with_steps(_PROBED), cycles=first.path.cycles))
        left = errors(first, finer)
        if all(error <= BARS[key] * accuracy / 2 for key, error in left.items()):
            return history, left
        worst = max(error / BARS[key] for key, error in left.items())
        if worst > _FALLS * before:  # what is left is due to the nodes that touch, not to the steps
            return history, left
        before = worst
        if finer.path.mean_steps > most:
            return (finer if whole else history), left
        history = finer if whole else along(replace(finer.path, cycles=own.cycles))


def one_step_suffices(path: Path) -> bool:
    """Whether the bulk tension is constant, so that Q drives all slip one way, which is known from the loads
    (:attr:`Path.one_way`)."""
    return path.one_way and len({load[1:3] for load in (path.begin, *path.cycle)}) == 1
