"""Rows of a file at equal x: averaged where they tell the same, refused where they tell different tractions."""

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from partialslip.tools.arrays import Array, Indices
from partialslip.tools.bars import LARGEST
from partialslip.tools.errors import InputError

_EQUAL = 1e-7  # accuracy: of the points' extent: largest distance of rows at equal x
_NOTHING = 1e-9  # accuracy: of the norm: differences due to rounding
_NOISE = 1e-6  # accuracy: of the largest column's norm: shear of a contact without friction is noise
_FEW = 12  # display: most values of a column that tells rows apart
_PASS = 12  # limit: fewest rows of a pass over the contact
_IN_TURN = 0.5  # limit: of the norm: largest difference of every other row from those beside it


class Label(NamedTuple):
    """Column that may tell rows at equal x apart: its ``name``, its ``number`` from 1, and its ``values`` by row."""

    name: str
    number: int
    values: Sequence[object]

    @property
    def kinds(self) -> list[str]:
        """Its values as text, each once."""
        return [f"{kind:g}" if isinstance(kind, float) else str(kind) for kind in dict.fromkeys(self.values)]


def starts(x: Array) -> Indices:
    """Index of the first of each group of equal values of ``x`` (n,), ascending."""
    return np.flatnonzero(np.concatenate([[True], np.diff(x) > _EQUAL * np.ptp(x)])) if len(x) else np.zeros(0, int)


def check_equal_x(values: Mapping[str, Array], labels: Iterable[Label], origin: str, advice: str) -> tuple[str, ...]:
    """Check rows at equal x, and return a note if some differ a little.

    Parameters
    ----------
    values : mapping of str to (n,) array
        Columns by name, x first.
    labels : iterable of Label
        Columns that may tell them apart; looked at only if rows differ.
    origin : str
        Name of the file for messages.
    advice : str
        What to do if the label ``{name}``, column ``{number}``, tells them apart, and rows with ``{kept}`` are kept.

    Raises
    ------
    InputError
        If they differ, in a norm, by more than the largest bar: they are of different surfaces, or load points.
    """
    x, *columns = values.values()
    order = np.argsort(x, kind="stable")
    first = starts(x[order])
    if len(first) == len(x):
        return ()
    rows = np.stack(columns)[:, order]
    most, least = (extreme.reduceat(rows, first, axis=1) for extreme in (np.maximum, np.minimum))
    norms = np.linalg.norm(np.maximum(np.abs(most), np.abs(least)), axis=1)
    floor = _NOISE * norms.max()
    off = np.linalg.norm(most - least, axis=1) / (np.maximum(norms, floor) if floor else 1.0)
    worst = int(off.argmax())
    name = [*values][1 + worst]
    if off[worst] <= _NOTHING:
        return ()
    if off[worst] <= LARGEST:
        return (f"rows at equal x were averaged; they differ by {off[worst]:.1%} in {name}",)
    group = int((most - least)[worst].argmax())
    same = order[first[group] :][: (np.append(first, len(x))[1:] - first)[group]]
    told = f"{origin}: rows at equal x differ by {off[worst]:.0%} in {name}: must be one row for each x"
    for label in labels:
        kinds = label.kinds
        if len(kinds) <= _FEW and len({label.values[row] for row in same}) == len(same):
            sums = dict.fromkeys(reversed(kinds), 0.0)
            for value, size in zip(label.values, np.abs(columns[worst]).tolist(), strict=True):
                sums[f"{value:g}" if isinstance(value, float) else str(value)] += size
            likely = max(sums, key=lambda kind: sums[kind])  # of other lines of points values are zero
            kept = advice.format(name=label.name, number=label.number, kept=likely)
            raise InputError(f"{told}; {label.name} is {', '.join(kinds)}: {kept}")
    raise InputError(f"{told}: keep those of one surface and load point")


def check_passes(values: Mapping[str, Array], labels: Iterable[Label], origin: str, advice: str) -> None:
    """Refuse rows, in the order of the file, of several passes over the contact that tell different tractions, at
    whatever x: one after another, or rows of two in turn. Parameters are those of :func:`check_equal_x`.

    Raises
    ------
    InputError
        If they differ, in a norm, by more than the largest bar; where rows are in turn, by half of the norm.
    """
    x, *columns = values.values()
    pressed = np.flatnonzero(np.any(np.stack(columns) != 0, axis=0))
    if len(pressed) < 2 * _PASS:
        return
    way = np.sign(np.diff(x[pressed]))
    runs = np.split(pressed, np.flatnonzero(np.diff(way)) + 1)
    runs = [run for run in runs if len(run) >= _PASS and np.ptp(x[run]) > np.ptp(x[pressed]) / 2]
    floor = _NOISE * max(float(np.linalg.norm(column)) for column in columns)
    order = pressed[np.argsort(x[pressed], kind="stable")]
    for passes, limit in ((runs, LARGEST), ([order[::2], order[1::2]], _IN_TURN)):
        for one in passes[1:]:
            off = {
                name: _off(x, column, passes[0], one, floor)
                for name, column in zip([*values][1:], columns, strict=True)
            }
            name = max(off, key=lambda each: off[each])
            if off[name] > limit:
                told = f"rows are of {len(passes)} passes over the contact, which differ by {off[name]:.0%} in {name}"
                keep = _kept(labels, passes, columns[[*off].index(name)], advice)
                raise InputError(
                    f"{origin}: {told}: must be of one: {keep or 'give a file for each, or a column for --where'}"
                )


def _off(x: Array, column: Array, one: Indices, other: Indices, floor: float) -> float:
    """Difference of a ``column`` between the rows ``one`` and ``other``, of the norm of the larger one or the
    ``floor``."""
    one = one[np.argsort(x[one])]
    other = other[(x[other] >= x[one[0]]) & (x[other] <= x[one[-1]])]
    beside = np.interp(x[other], x[one], column[one])
    norm = float(np.linalg.norm(np.maximum(np.abs(beside), np.abs(column[other]))))
    return float(np.linalg.norm(beside - column[other])) / (max(norm, floor) or 1.0)


def _kept(labels: Iterable[Label], passes: Sequence[Indices], column: Array, advice: str) -> str:
    """The ``advice`` on the first label that tells ``passes`` apart; empty if there is none."""
    largest = max(passes, key=lambda rows: float(np.abs(column[rows]).sum()))
    for label in labels:
        kinds = [{label.values[row] for row in rows.tolist()} for rows in passes]
        if all(len(kind) == 1 for kind in kinds) and len(set.union(*kinds)) == len(passes):
            value = label.values[int(largest[0])]
            kept = f"{value:g}" if isinstance(value, float) else str(value)
            return f"{label.name} is {', '.join(label.kinds)}: " + advice.format(name=label.name, kept=kept)
    return ""
