"""Tractions read from a file of results."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from partialslip.codes.score.ends import possible_averages
from partialslip.codes.score.headers import FIRST
from partialslip.codes.score.kinds import EVERY, Average, Kind, cells_around, cells_of_nodes
from partialslip.codes.score.rows import check_equal_x, starts
from partialslip.scene import SMALLEST
from partialslip.tools.arrays import Array, Mask
from partialslip.tools.errors import InputError

_DIGITS = 8  # accuracy: digits of x: numbers with fewer count as rounded
_WHOLE = 1e-5  # accuracy: of a unit in the last place: deviation from a whole number of units
LARGEST = 1e30  # limit: of a value of a table; powers of larger ones overflow
PLAUSIBLE = f"zero or of a size from {SMALLEST} to {LARGEST}"
FEWEST_POINTS = 6  # limit: points in contact that locate its ends


@dataclass(frozen=True)
class Samples:
    """Tractions along the contact line, as read from a file.

    Parameters
    ----------
    x : (n,) array
        Points, ascending, m.
    p, dq : (n,) arrays
        Pressure at load point 2, and the change q2 - q1 of shear traction between load points 1 and 2, Pa.
    q1, q2 : (n,) arrays or None
        Shear traction at the load points, Pa, if known.
    cells : (n + 1,) array or None
        Ends of the cells, m, of means over cells and of nodal forces over weights; None for values at points.
    resolution : float
        Standard deviation of x, m, if x is written with few digits; otherwise 0.
    made_of : str
        Expressions for the columns, if they differ from the columns' names.
    notes : tuple of str
        Notes for the author of the file.
    p1 : (n,) array or None
        Pressure at load point 1, Pa; None where the pressure does not vary.
    kind : "sampled", "mean" or "nodal"
        Values at points, means over cells, or nodal forces of linear elements over the nodes' weights.
    guessed : bool
        Whether the kind was guessed, and not given.
    averages : tuple of Average
        What the values may be, the kind first.
    """

    x: Array
    p: Array
    dq: Array
    q1: Array | None = None
    q2: Array | None = None
    cells: Array | None = None
    resolution: float = 0.0
    made_of: str = ""
    notes: tuple[str, ...] = ()
    p1: Array | None = None
    kind: Kind = "sampled"
    guessed: bool = False
    averages: tuple[Average, ...] = (Average("sampled"),)

    @property
    def p_mean(self) -> Array:
        """Mean pressure of load points 1 and 2, (n,), Pa: in slip |dq| is 2 f times as large."""
        return self.p if self.p1 is None else (self.p + self.p1) / 2

    def moved(self, shift: float) -> "Samples":
        """Return the samples moved along x by ``shift``, m."""
        return replace(self, x=self.x + shift, cells=None if self.cells is None else self.cells + shift)

    def coarser(self, first: int) -> "Samples":
        """Return every second point from index ``first`` (0 or 1) on; of means over cells those over two cells."""
        starts = np.arange(first, len(self.x), 2)
        weights = None if self.cells is None else np.diff(self.cells)

        def of(values: Array | None) -> Array | None:
            if values is None or weights is None:
                return values if values is None else values[starts]
            return np.add.reduceat(values * weights, starts) / np.add.reduceat(weights, starts)

        columns: dict[str, Any] = {name: of(getattr(self, name)) for name in ("x", "p", "dq", "q1", "q2", "p1")}
        cells = None if self.cells is None else np.append(self.cells[starts], self.cells[-1])
        return replace(self, **columns, cells=cells)


def samples(
    columns: dict[str, Array], origin: str, factors: tuple[float, float, float], order: int, kind: Kind | None = None
) -> Samples:
    """Make samples from columns by name.

    Parameters
    ----------
    columns : dict of (n,) arrays
        In this order: x (m); p (Pa), or nodal normal forces Fn (N/m); p1 or Fn1 where the pressure varies; and one of:
        dq; q = dq/2; q1 and q2; dFt; Ft; Ft1 and Ft2. Points in any order. Points with the same x, as in a mesh with a
        depth, are averaged.
    origin : str
        Name of the file, for messages.
    factors : (float, float, float)
        Factors of x, of the pressures (forces Fn) and of the shear, for other units and signs.
    order : int
        Order of the elements of nodal forces: 1, or 2 with every second node in the middle of an edge.
    kind : "sampled", "mean" or "nodal", optional
        What the values are; by default guessed.

    Raises
    ------
    InputError
        If too few points are in contact, or a value is not a number of a plausible size.
    """
    names = [*columns]
    normal, pressed = names[1], 2 + (names[2] in FIRST.values())  # the pressures end before column ``pressed``
    sizes = [factors[0], *[factors[1]] * (pressed - 1), *[factors[2]] * (len(names) - pressed)]
    values = np.stack([column * size for column, size in zip(columns.values(), sizes, strict=True)])
    _check(values, names, origin)
    notes = check_equal_x(dict(zip(names, values, strict=True)), (), origin, "")
    values = _merged(values)
    x, cells, resolution = values[0], None, abs(factors[0]) * _resolution(columns["x"])
    if normal == "Fn":
        if order == 2 and len(x) % 2 == 0:
            raise InputError(f"{origin}: {len(x)} nodes: must be an odd number for elements of order 2")
        if order == 2:
            values = _of_linear_elements(values)
            x = values[0]
        cells = cells_of_nodes(x)
        values[1:] /= np.diff(cells)
    for name, p in zip(names[1:pressed], values[1:pressed], strict=True):
        touching = np.count_nonzero(p > 0)
        if touching < FEWEST_POINTS:
            hint = "; pressure must be positive" if p.min(initial=0) < 0 else ""
            raise InputError(f"{origin}: {name} > 0 at {touching} points: must be at least {FEWEST_POINTS}{hint}")
    p, p1, shears = values[1], (values[2] if pressed > 2 else None), values[pressed:]
    if len(shears) == 2:
        dq, q1, q2 = shears[1] - shears[0], shears[0], shears[1]
    elif names[pressed] in ("q", "Ft"):
        dq, q1, q2 = 2 * shears[0], -shears[0], shears[0]
    else:
        dq, q1, q2 = shears[0], None, None
    averages = (Average(kind),) if kind else _guessed(x, p, normal == "Fn")
    own = kind or ("nodal" if normal == "Fn" else averages[0].kind)
    if normal != "Fn" and own != "sampled":
        cells = cells_around(x) if own == "mean" else cells_of_nodes(x)
    return Samples(x, p, dq, q1, q2, cells, resolution, "", notes, p1, own, kind is None, averages)


def _guessed(x: Array, p: Array, forces: bool) -> tuple[Average, ...]:
    """What the values of the pressure ``p`` at ``x`` (n,) may be, the likeliest first: nodal forces or values at points
    where they may be."""
    likely: Kind = "nodal" if forces else "sampled"
    return possible_averages(x, p, sorted(EVERY, key=lambda each: each.kind != likely))


def _check(values: Array, names: list[str], origin: str) -> None:
    for name, column in zip(names, values, strict=True):
        if (wrong := unusable(column)).any():
            raise InputError(f"{origin}: {name} = {column[wrong.argmax()]:g}: must be {PLAUSIBLE}")


def unusable(values: Array) -> Mask:
    """Where ``values`` are not finite, or of an implausible size."""
    size = np.abs(values)
    return ~np.isfinite(values) | (size > LARGEST) | ((size > 0) & (size < SMALLEST))


def _resolution(x: Array) -> float:
    """Standard deviation of ``x`` due to rounding to few digits, m; 0 if x has many digits."""
    x = np.unique(x)
    large = x[np.abs(x) > 0.1 * np.abs(x).max(initial=0.0)]
    if len(large) < FEWEST_POINTS:
        return 0.0
    units = 10.0 ** (np.floor(np.log10(np.abs(large).max())) - np.arange(_DIGITS))
    off = np.abs(large[:, None] / units - np.round(large[:, None] / units)).max(axis=0)
    if not (off < _WHOLE).any():
        return 0.0
    unit = float(units[(off < _WHOLE).argmax()])
    uneven = 1.4826 * float(np.median(np.abs(np.diff(x, 3)))) / np.sqrt(20)
    return float(min(uneven, 5 * unit))  # the largest numbers are rounded to a place before that of the least


def _merged(values: Array) -> Array:
    """Sort the columns of ``values`` by the first row and average columns with equal first entries, to rounding."""
    values = values[:, np.argsort(values[0], kind="stable")]
    first = starts(x := values[0])
    if not len(first):
        return values
    return np.add.reduceat(values, first, axis=1) / np.diff(np.append(first, len(x)))


def _of_linear_elements(values: Array) -> Array:
    """Rows of x and of nodal forces of quadratic elements as of linear ones, whose shape functions are those of the
    corners and half of those of the middles beside them."""
    corners, middles = values[:, ::2].copy(), values[1:, 1::2] / 2
    corners[1:, :-1] += middles
    corners[1:, 1:] += middles
    return corners
