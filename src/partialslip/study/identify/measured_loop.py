"""A measured loop of Q over displacement: its rows, turning points, branches and noise; SI units.

A branch begins at a turning point of Q. Rows before the first turning point may be a first loading and are left out.
The noise of a column is the standard deviation of its third differences from row to row over sqrt(20): what is smooth
cancels.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from partialslip.scene.columns import dimension_of, place_of, split_unit, unknown_unit
from partialslip.scene.texttable import TextTable, decoded, read_table
from partialslip.scene.units import SI, Dimension, Units
from partialslip.tools.arrays import Array, Indices
from partialslip.tools.errors import InputError
from partialslip.tools.inputfile import read_bytes

_LARGEST, _MOST, _FEWEST = 20_000_000, 100_000, 16  # limit: bytes of a file, most and fewest rows of a loop
_NAMES = {
    "displacement": {"displacement", "disp", "d", "u", "delta", "travel", "dx"},
    "Q": {"q", "force", "shear", "tangential force", "shear force", "load"},
    "time": {"time", "t"},
}
_DIMENSIONS: dict[str, Dimension] = {"displacement": "m", "Q": "N/m"}
_APART = 0.3  # limit: of the range of Q: a turning point is that near to an extreme
_NEAR = 0.1  # accuracy: of the range of Q: rows near a turning point, from which its Q is read
_GAP = 4.0  # limit: of the time between rows: rows are missing
_CURVE = 5  # fixed: fewest rows for the fit at a turning point
_SURE = 5.0  # accuracy: standard errors by which turning points of one amplitude may differ
_LEAST = 5e-4  # accuracy: of the range of Q: least error of a turning point, that of the fit to half a sine
_SAME = 0.02  # limit: of the range of Q: the same
_BACK = 0.1  # limit: of the range of Q: by how much it runs back on a branch
_AMPLITUDE = "must have one amplitude, and a column time where rows are missing: keep cycles of one amplitude"


@dataclass(frozen=True, eq=False)
class MeasuredLoop:
    """Rows in the order of time: ``displacement`` (m), ``Q`` (N/m) and ``time`` (row numbers without a column of it),
    (n,) each; ``origin``, the file's name, and ``notes`` on what was left out."""

    displacement: Array
    Q: Array
    time: Array
    origin: str = "loop"
    notes: tuple[str, ...] = ()


class Branches(NamedTuple):
    """Rows on branches of a loop.

    Parameters
    ----------
    loop : MeasuredLoop
        Without the rows before the first turning point.
    way : (n,) array
        1 where Q rises, -1 where it falls.
    turns : (2,) array
        Q of the lower and the upper turning points, N/m.
    turns_error : (2,) array
        Their standard errors, N/m.
    noise : (2,) array
        Standard deviations of displacement (m) and Q (N/m).
    halves : int
        Number of branches.
    """

    loop: MeasuredLoop
    way: Indices
    turns: Array
    turns_error: Array
    noise: Array
    halves: int


def read_loop(
    file: str | Path, units: Units = SI, columns: Mapping[str, str] | None = None, factors: tuple[float, float] = (1, 1)
) -> MeasuredLoop:
    """Read a measured loop from a table.

    Parameters
    ----------
    file : str or path
    units : Units
        Of columns whose heading states no unit.
    columns : mapping of str to str, optional
        Names, or numbers from 1, of the columns displacement, Q and time; default: those that are named so.
    factors : (float, float)
        Of displacement and Q, after the units.

    Raises
    ------
    InputError
        If the file is no table with these columns, or has too few or too many rows.
    """
    origin = str(file)
    table = read_table(decoded(read_bytes(file, _LARGEST), origin)[0], origin)
    places = _places(table, columns or {}, origin)
    numbers = {name: table.numbers(place, origin) for name, place in places.items()}
    known = np.all([np.isfinite(each) for each in numbers.values()], axis=0)
    values = {}
    for (name, of), factor in zip(_DIMENSIONS.items(), factors, strict=True):
        heading = table.names[places[name]]
        if dimension_of(heading) not in (None, of) or (unknown_unit(heading) and factor == 1):
            must = "per unit depth, in N/m or N/mm" if name == "Q" else "a length, in m, mm or um"
            size = ", or give the size of its unit by --factors D,Q" if unknown_unit(heading) else ""
            raise InputError(f"{origin}: column {heading!r}: must be {must}{size}")
        stated = split_unit(heading)[1]
        own = numbers[name][known]
        values[name] = factor * (own * stated if stated else units.to_si(own, of))
    time = numbers["time"][known] if "time" in numbers else np.flatnonzero(known).astype(float)
    if (np.diff(time) < 0).any():
        line = table.lines[int(np.flatnonzero(known)[int((np.diff(time) < 0).argmax()) + 1])]
        raise InputError(f"{origin}: line {line}: time runs back: must be one record, in the order of time")
    if not _FEWEST <= len(time) <= _MOST:
        raise InputError(f"{origin}: {len(time)} rows with values: must be {_FEWEST} to {_MOST}: keep whole cycles")
    left_out = int(np.count_nonzero(~known))
    notes = (*table.notes, *([f"left out: {left_out} rows without values"] if left_out else []))
    return MeasuredLoop(values["displacement"], values["Q"], time, origin, notes)


def _places(table: TextTable, columns: Mapping[str, str], origin: str) -> dict[str, int]:
    """Indices of the columns, by name; without time where there is none."""
    if wrong := next((name for name in columns if name not in _NAMES), ""):
        raise InputError(f"--columns {wrong}={columns[wrong]}: must name displacement, Q or time")
    bare = [re.sub(r"[\[({].*", "", split_unit(name)[0]).strip().lower() for name in table.names]
    shown = ", ".join(table.names)
    found = {}
    for name, words in _NAMES.items():
        here = [k for k, each in enumerate(bare) if each in words]
        if name in columns:
            place = place_of(columns[name], table.names)
            here = [] if place is None else [place]
        if len(here) == 1:
            found[name] = here[0]
        elif name in columns or name != "time":
            raise InputError(
                f"{origin}: column {columns.get(name, name)}: must be one of {shown[:100]}: "
                "name it by --columns displacement=1,Q=2"
            )
    return found


def branches_of(loop: MeasuredLoop) -> Branches:
    """Find turning points, branches and noise of a ``loop``.

    The Q of a turning point at the time t0 is the c0 of the least squares fit c0 + c1 |t - t0| + c2 (t - t0)^2 to rows
    near it, sharp or smooth.

    Raises
    ------
    InputError
        If Q or the displacement does not change, Q does not both rise and fall, or its amplitude changes.
    """
    Q = loop.Q
    for name, values, of in (("Q", Q, "N/m"), ("displacement", loop.displacement, "m")):
        if not np.ptp(values) > 0:
            raise InputError(f"{loop.origin}: {name} is {values[0]:.6g} {of} in all rows: must change")
    noise = np.array([_scatter(loop.displacement), _scatter(Q)])
    span, side = np.ptp(Q), np.zeros(len(Q), np.int64)
    side[(Q.max() - Q) < _APART * span], side[(Q - Q.min()) < _APART * span] = 1, -1
    near = np.flatnonzero(side)
    runs = np.split(near, np.flatnonzero(np.diff(side[near])) + 1)
    sides = [int(side[run[0]]) for run in runs]
    turns = [_turn(loop, np.arange(run[0], run[-1] + 1), of, noise[1]) for run, of in zip(runs, sides, strict=True)]
    rows = [row for row, _, _ in turns]
    kept = np.arange(rows[0] + 1, len(Q))
    branch = np.searchsorted(rows, kept) - 1
    way = -np.array(sides)[branch]
    if min(np.count_nonzero(way == 1), np.count_nonzero(way == -1)) < _FEWEST / 2:
        raise InputError(
            f"{loop.origin}: Q must rise and fall after its first turning point, "
            f"in {_FEWEST // 2} rows or more each: record one cycle more"
        )
    for part in np.split(way * Q[kept], np.flatnonzero(np.diff(branch)) + 1):
        if (np.maximum.accumulate(part) - part).max() > max(2 * _SURE * noise[1], _BACK * span):
            raise InputError(f"{loop.origin}: Q turns back between its least and its largest: {_AMPLITUDE}")
    found = [_mean([turn for turn, of in zip(turns, sides, strict=True) if of == which], span, loop)
             for which in (-1, 1)]  # fmt: skip
    notes = loop.notes + ((f"left out: {kept[0]} rows up to the first turning point",) if rows[0] > 0 else ())
    measured = replace(loop, displacement=loop.displacement[kept], Q=Q[kept], time=loop.time[kept], notes=notes)
    values, errors = np.array(found).T
    return Branches(measured, way, values, errors, noise, len(set(rows) - {len(Q) - 1}))


def _scatter(values: Array) -> float:
    """Standard deviation of the noise of ``values`` (n,): robust, from third differences."""
    return float(1.4826 * np.median(np.abs(np.diff(values, 3))) / np.sqrt(20))


def _turn(loop: MeasuredLoop, rows: Indices, side: int, noise: float) -> tuple[int, float, float]:
    """Row, Q (N/m) and standard error of a turning point near ``rows``, an upper one if ``side`` is 1; NaN for Q
    where rows are missing, and at the ends of the loop, where rows may be on one side of it only."""
    top = side * loop.Q[rows]
    near = np.flatnonzero(top > np.max(side * loop.Q) - _NEAR * np.ptp(loop.Q))
    rows = rows[near[0] : near[-1] + 1] if len(near) else rows
    Q, time = loop.Q[rows], loop.time[rows]
    t = (time - time.mean()) / (np.ptp(time) or 1.0)
    at = t[np.argmax(side * Q)]
    value, error = float(side * np.max(side * Q)), noise
    if len(rows) >= _CURVE:
        inverse = np.linalg.pinv(np.vander(t, 3))
        bend, slope, _ = inverse @ Q
        at_error = noise * np.linalg.norm(inverse[1]) / abs(2 * bend) if bend else np.inf
        at = np.clip(-slope / (2 * bend), t[0], t[-1]) if bend * side < 0 else at
        inverse = np.linalg.pinv(np.stack([np.ones_like(t), np.abs(t - at), (t - at) ** 2], axis=1))
        value, kink, _ = inverse @ Q
        error = float(np.hypot(noise * np.linalg.norm(inverse[0]), kink * at_error))
    middle = (loop.Q.max() + loop.Q.min()) / 2
    far = np.flatnonzero(side * (loop.Q - middle) < 0)
    at_end = not (len(far) and far[0] < rows[0] and far[-1] > rows[-1])
    gap = not len(near) or np.diff(time).max(initial=0) > _GAP * np.median(np.diff(loop.time))
    return int(rows[0] + np.searchsorted(t, at, side="right") - 1), np.nan if at_end or gap else float(value), error


def _mean(turns: list[tuple[int, float, float]], span: float, loop: MeasuredLoop) -> tuple[float, float]:
    """Mean Q of the ``turns`` of one side and its standard error, N/m; infinite where none is known."""
    known = np.array([(value, error) for _, value, error in turns if np.isfinite(value)])
    if not len(known):
        rows = [row for row, _, _ in turns]
        return float(np.mean(loop.Q[rows])), np.inf
    values, errors = known.T
    weights = np.hypot(errors, _LEAST * span) ** -2
    mean = float(weights @ values / weights.sum())
    if (np.abs(values - mean) > np.maximum(_SURE * errors, _SAME * span)).any():
        raise InputError(
            f"{loop.origin}: turning points of Q from {values.min():.4g} to {values.max():.4g} N/m: {_AMPLITUDE}"
        )
    return mean, float(weights.sum() ** -0.5)
