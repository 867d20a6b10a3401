"""Rows of a file at equal x: averaged where they tell the same, refused where they tell different tractions."""

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from partialslip.tools.arrays import Array, Indices
from partialslip.tools.bars import LARGEST
from partialslip.tools.errors import InputError

_EQUAL = 1e-7  # accuracy: of the points' extent: largest distance of rows at equal x
_NOTHING = 1e-9  # accuracy: of the norm: differences due to rounding
_FEW = 12  # display: most values of a column that tells rows apart


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
    off = np.linalg.norm(most - least, axis=1) / np.where(norms > 0, norms, 1.0)
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
