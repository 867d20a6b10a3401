"""Whether load steps suffice where the pressure varies."""

from collections.abc import Callable
from dataclasses import replace

from partialslip.friction.history import History
from partialslip.friction.load_path import Path
from partialslip.friction.step_errors import Errors
from partialslip.friction.work import last_cycle, told_missed
from partialslip.tools.bars import BARS

_CLOSES = 3  # cost: most cycles on which this is decided


def follow_or_step(
    along: Callable[[Path], History],
    path: Path,
    accuracy: float,
    errors: Callable[[History, History], Errors] | None = None,
) -> tuple[History, Errors]:
    """Go along the path in its load steps if these suffice, and event by event if not; return the history and the
    estimated errors due to the steps.

    Parameters
    ----------
    along : callable
        ``along(path)``: the history along a path, in its steps or event by event (:attr:`Path.followed`). The path
        of the returned history tells whether slip reverses on it.
    path : Path
    accuracy : float
        Accuracy of ends, as a fraction of a.
    errors : callable, optional
        ``errors(history, followed)``: errors of the steps of a history, from the history that is followed event by
        event. Steps suffice if every error is at most half of the allowed one. By default this is not decided.

    The errors are empty if one step is known to suffice, and on a path that is followed: there are no steps then. Where
    this is decided, the path of the returned history tells the work that steps miss.

    Gradual loads decide, and not finer steps: where a stick zone moves while the loads change, or slip reverses, few
    and many steps may all end with the same wrong tractions. The first cycles decide.
    """
    history = along(path)
    if errors is None or path.followed or path.half:
        return history, {}
    if one_step_suffices(path):
        return told_missed(history, history, along(last_cycle(history))), {}
    cycles = min(path.cycles, _CLOSES)
    first = history if history.cycles <= cycles else along(replace(path, cycles=cycles))
    gradual = replace(path, followed=True)
    followed = along(replace(gradual, cycles=cycles))
    left = errors(first, followed)
    if all(error <= BARS[key] * accuracy / 2 for key, error in left.items()):
        known = told_missed(history, first, followed)
        return replace(known, path=replace(known.path, turns=followed.turns)), left
    if followed.cycles < cycles or cycles == path.cycles:
        return followed, {}
    return along(gradual), {}


def one_step_suffices(path: Path) -> bool:
    """Whether one load step is exact: constant bulk tension, and Q drives all slip one way (:attr:`Path.one_way`)."""
    return path.one_way and path.tension_stays
