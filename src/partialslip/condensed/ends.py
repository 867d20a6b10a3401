"""Where zones end, below mesh size.

Towards the end of the contact p falls like a square root, and so does 2 f p - |dq| towards the end of the stick
zone. The force between a mesh vertex and the end therefore goes like distance^(3/2): its power 2/3 is a smooth
function of x whose root is the end. Forces are far better than nodal values here: what a traction does within the
last elements hardly touches them.
"""

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from partialslip.arrays import Array

_VERTICES = 5
_BESIDE, _FINER = 3, 0.95  # cells on either side of a fine place, and how small it is beside them
_STICKS = 1e-9  # what slips has used up its bound to rounding, whatever the units
_LEAVES = 1e-6  # of the bound: a traction nearer to it than that is at it, as kinks so slight do not matter
_RUN = 4  # nodes in a row that make a zone; fewer are noise


@dataclass(frozen=True)
class StickInterval:
    """The stick zone and the signs of dq in the slip zones on its left and right."""

    left: float
    right: float
    signs: tuple[int, int]


def stick_zone(
    x: Array, bound: Array, change: Array, vertices: Array, cell_forces: Callable[[Array], Array]
) -> StickInterval:
    """Read the stick zone from the range 2 f p - |dq|, never from what sticks at one instant.

    Parameters
    ----------
    x, bound, change : (n,) arrays
        Nodes in contact, f times their normal forces, and changes of their tangential forces over the cycle.
    vertices : (c + 1,) array
        Ends of the cells of the contact line.
    cell_forces : callable
        Takes forces of the nodes in contact to integrals over the cells.
    """
    room = np.divide(2 * bound - np.abs(change), bound, out=np.zeros_like(bound), where=bound > 0)
    sticks = _around(int(np.argmax(room)), x, room > _STICKS, vertices)
    signs = (1 if change[0] > 0 else -1), (1 if change[-1] > 0 else -1)
    if len(sticks) == 0:  # a stick zone smaller than a cell: it is where the slip turns round
        turn = int(np.argmax(np.sign(change) != np.sign(change[0])))
        point = float(x[max(turn - 1, 0)] + x[turn]) / 2
        return StickInterval(point, point, signs)
    left = left_end(vertices, cell_forces(2 * bound - signs[0] * change), x[sticks])
    right = right_end(vertices, cell_forces(2 * bound - signs[1] * change), x[sticks])
    return StickInterval(left, max(right, left), signs)


def _around(most: int, x: Array, sticks: npt.NDArray[np.bool_], vertices: Array) -> npt.NDArray[np.int64]:
    """Nodes that stick around the one with the ``most`` room, up to the first cell on either side that slips.

    The stick zone is one interval. Where there is hardly any room (close to sliding), what the elements cannot resolve
    leaves a node here and there short of its bound, and they are not part of it.
    """
    before, after = (np.searchsorted(vertices, x, side) for side in ("left", "right"))  # a vertex is in two cells
    slips = np.ones(len(vertices) + 1, dtype=bool)
    slips[before[sticks]] = slips[after[sticks]] = False
    slips[[0, -1]] = True  # there is nothing beyond the line
    ends = np.flatnonzero(slips)
    last = np.searchsorted(ends, after[most])
    result: npt.NDArray[np.int64] = np.flatnonzero(sticks & (after > ends[last - 1]) & (before < ends[last]))
    return result


def kinks(x: Array, bound: Array, q: Array, vertices: Array, cell_forces: Callable[[Array], Array]) -> list[float]:
    """Points inside the contact where q leaves its bound f p or -f p: a mesh is to be fine there.

    Towards such a point the difference of q and the bound it meets falls like a square root, just as beside the ends of
    the stick zone.

    Parameters
    ----------
    x, bound, q : (n,) arrays
        Nodes in contact, f times their normal forces, and their tangential forces at one moment.
    vertices : (c + 1,) array
        Ends of the cells of the contact line.
    cell_forces : callable
        Takes forces of the nodes in contact to integrals over the cells.
    """
    side = np.where(np.abs(q) >= (1 - _LEAVES) * bound, np.sign(q), 0).astype(np.int8)
    starts = np.concatenate([[0], np.flatnonzero(np.diff(side)) + 1, [len(x)]])
    starts = starts[:-1][np.diff(starts) >= _RUN]
    if not len(starts):
        return []
    starts = np.append(starts[np.append(True, np.diff(side[starts]) != 0)], len(x))
    found: list[float] = []
    for run, (first, last) in enumerate(itertools.pairwise(starts)):  # runs of one side: a handful
        if side[first] != 0:
            continue
        inside = x[first:last]
        for beside, way in ((run - 1, -1), (run + 1, 1)):
            if not 0 <= beside < len(starts) - 1:
                continue
            held = slice(starts[beside], starts[beside + 1])
            room = bound - side[held.start] * q
            room[held] = 0.0
            room[held.stop :] *= way < 0
            room[: held.start] *= way > 0
            forces = cell_forces(room)
            found.append((right_end if way > 0 else left_end)(vertices, forces, inside))
    return sorted(found)


def finest(vertices: Array) -> list[float]:
    """Inner vertices that a graded mesh is fine around: the cells beside them are the smallest far and wide."""
    widths = np.diff(vertices)
    if len(widths) < 2 * _BESIDE + 1:
        return []
    smallest = (widths[1:] + widths[:-1]) / 2
    wide = np.lib.stride_tricks.sliding_window_view(np.pad(smallest, _BESIDE, constant_values=np.inf), 2 * _BESIDE + 1)
    far = np.pad(widths, _BESIDE, mode="edge")
    larger = np.minimum(far[: len(smallest)], far[2 * _BESIDE + 1 :][: len(smallest)])
    places: list[float] = vertices[1:-1][(smallest <= wide.min(axis=1)) & (smallest < _FINER * larger)].tolist()
    return places


def apart(ends: list[float], size: float) -> list[float]:
    """Without those that lie within ``size`` of an earlier one: where the next mesh is to be fine."""
    kept: list[float] = []
    for end in ends:
        if all(abs(end - other) > size for other in kept):
            kept.append(end)
    return kept


def right_end(vertices: Array, forces: Array, inside: Array) -> float:
    """Where the zone ends on the right.

    Parameters
    ----------
    vertices : (c + 1,) array
        Ends of the cells, ascending.
    forces : (c,) array
        Integral of the traction that vanishes at the end, over each cell.
    inside : (n,) array
        Nodes inside the zone, ascending: the end is less than a cell and its neighbour beyond the last one.
    """
    last = np.searchsorted(vertices, inside[-1])  # the first vertex at or beyond the last node
    x = vertices[:last][::-1]
    x = x[x >= inside[0]]
    force = np.cumsum(forces[::-1])[len(forces) - last :][: len(x)]
    # the nearest vertex has but part of a cell beyond it: leave it out where there are others
    skip = 1 if len(x) > _VERTICES else 0
    x, force = x[skip : skip + _VERTICES], force[skip : skip + _VERTICES]
    near, far = inside[-1], vertices[min(last + 1, len(vertices) - 1)]
    beyond = vertices[min(int(np.searchsorted(vertices, near, "right")), len(vertices) - 1)]
    if len(x) >= 3 and (force > 0).all():
        roots = _roots(x, force ** (2 / 3))
        between = roots[(roots > x[0]) & (roots < far)]
        if len(between):
            return float(between.min())
    return float((near + max(near, beyond)) / 2)


def left_end(vertices: Array, forces: Array, inside: Array) -> float:
    """Where the zone ends on the left: :func:`right_end` of the mirror image."""
    return -right_end(-vertices[::-1], forces[::-1], -inside[::-1])


def _roots(x: Array, y: Array) -> Array:
    """Real roots of the quadratic through (x, y), in the sense of relative least squares.

    Without cancellation: y is all but linear where the zone ends like a square root.
    """
    scale = x[0] - x[-1]
    t = (x - x[0]) / scale
    c, b, a = np.polynomial.polynomial.polyfit(t, y, 2, w=1 / y).tolist()
    square = b**2 - 4 * a * c
    q = -(b + math.copysign(math.sqrt(max(square, 0.0)), b)) / 2
    if square < 0 or q == 0:
        return np.empty(0)
    roots: Array = x[0] + scale * np.array([c / q, q / a] if a else [c / q])
    return roots
