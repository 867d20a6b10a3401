"""Ends of the contact and of the stick zone, located to a fraction of a cell.

Towards the end of the contact p falls like a square root, and so does 2 f p - |dq| towards the end of the stick zone.
The force between a mesh vertex and the end therefore varies like distance^(3/2). Force^(2/3) is a smooth function of x,
and its root is the end. Forces are more accurate than nodal tractions: they hardly depend on the error of the traction
in the last elements.
"""

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from partialslip.arrays import Array

_VERTICES = 5  # of the fit
_BESIDE, _FINER = 3, 0.95  # cells compared on each side of a refined point; relative size of refined cells
_STICKS = 1e-9  # room, relative to the bound, up to which a node slips
_LEAVES = 1e-6  # distance of q from the bound, relative, that counts as none: such weak kinks do not matter
_RUN = 4  # fewest neighbouring nodes that make a zone; fewer are noise


@dataclass(frozen=True)
class StickInterval:
    """Interval [``left``, ``right``] that sticks throughout the cycle, and the ``signs`` of dq on its left and
    right."""

    left: float
    right: float
    signs: tuple[int, int]


def stick_zone(
    x: Array, bound: Array, change: Array, vertices: Array, cell_forces: Callable[[Array], Array]
) -> StickInterval:
    """Stick zone of a cycle, from the room 2 f p - |dq| and not from the state at one load point.

    Parameters
    ----------
    x, bound, change : (n,) arrays
        Nodes in contact; f times the normal forces; changes of the tangential forces from load point 1 to 2.
    vertices : (c + 1,) array
        Ends of the cells of the contact line.
    cell_forces : callable
        Takes forces of the nodes in contact to integrals over the cells.
    """
    room = np.divide(2 * bound - np.abs(change), bound, out=np.zeros_like(bound), where=bound > 0)
    sticks = _around(int(np.argmax(room)), x, room > _STICKS, vertices)
    first, last = (sticks[0], sticks[-1] + 1) if len(sticks) else (0, len(x))
    signs = _sign(change[:first], bound[:first], change[0]), _sign(change[last:][::-1], bound[last:][::-1], change[-1])
    if len(sticks) == 0:  # a stick zone smaller than a cell lies where slip changes sign
        turn = int(np.argmax(np.sign(change) != np.sign(change[0])))
        point = float(x[max(turn - 1, 0)] + x[turn]) / 2
        return StickInterval(point, point, signs)
    left = left_end(vertices, cell_forces(2 * bound - signs[0] * change), x[sticks])
    right = right_end(vertices, cell_forces(2 * bound - signs[1] * change), x[sticks])
    return StickInterval(left, max(right, left), signs)


def _sign(changes: Array, bounds: Array, outermost: float) -> int:
    """Sign of the changes of q (k,) in a slip zone, from the end of the contact on: of the first one that is not
    rounding beside the friction ``bounds`` (k,), as q may not change at all where the contact comes and goes; of the
    ``outermost`` change if nothing slips."""
    clear = np.flatnonzero(np.abs(changes) > _STICKS * bounds)
    return 1 if (changes[clear[0]] if len(clear) else outermost) > 0 else -1


def _around(most: int, x: Array, sticks: npt.NDArray[np.bool_], vertices: Array) -> npt.NDArray[np.int64]:
    """Indices of nodes that stick around the node ``most`` with the most room, up to the first slipping cell on each
    side.

    The stick zone is one interval. Close to sliding, discretisation errors leave single nodes elsewhere short of the
    bound; these do not belong to the stick zone.
    """
    before, after = (np.searchsorted(vertices, x, side) for side in ("left", "right"))  # a vertex belongs to two cells
    slips = np.ones(len(vertices) + 1, dtype=bool)
    slips[before[sticks]] = slips[after[sticks]] = False
    slips[[0, -1]] = True  # beyond the contact line
    ends = np.flatnonzero(slips)
    last = np.searchsorted(ends, after[most])
    result: npt.NDArray[np.int64] = np.flatnonzero(sticks & (after > ends[last - 1]) & (before < ends[last]))
    return result


def within(stick: StickInterval, common: tuple[float, float], vertices: Array) -> StickInterval:
    """``stick`` limited to the ``common`` part of the contacts at both load points. An end within a cell of the end of
    that part is the end of that part, where no slip is seen."""
    low, high = common
    cells = np.clip(np.searchsorted(vertices, [low, high]), 1, len(vertices) - 1)
    near = np.diff(vertices)[cells - 1]
    left = low if stick.left < low + near[0] else stick.left
    right = high if stick.right > high - near[1] else stick.right
    return replace(stick, left=min(left, right), right=right)


def kinks(x: Array, bound: Array, q: Array, vertices: Array, cell_forces: Callable[[Array], Array]) -> list[float]:
    """Points inside the contact at which q leaves the bound f p or -f p, where meshes must be refined.

    Towards such a point the difference of q and the bound falls like a square root, as at the ends of the stick zone.

    Parameters
    ----------
    x, bound, q : (n,) arrays
        Nodes in contact; f times the normal forces; tangential forces at one load point.
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
    """Inner vertices around which a graded mesh is refined: cells beside them are the smallest in the neighbourhood."""
    widths = np.diff(vertices)
    if len(widths) < 2 * _BESIDE + 1:
        return []
    smallest = (widths[1:] + widths[:-1]) / 2
    wide = np.lib.stride_tricks.sliding_window_view(np.pad(smallest, _BESIDE, constant_values=np.inf), 2 * _BESIDE + 1)
    far = np.pad(widths, _BESIDE, mode="edge")
    larger = np.minimum(far[: len(smallest)], far[2 * _BESIDE + 1 :][: len(smallest)])
    places: list[float] = vertices[1:-1][(smallest <= wide.min(axis=1)) & (smallest < _FINER * larger)].tolist()
    return places


def apart(ends: Sequence[float], size: float, known: Sequence[float] = ()) -> list[float]:
    """The ``known`` ends, and the ``ends`` without those within ``size`` of a known or an earlier one."""
    kept = [*known]
    for end in ends:
        if all(abs(end - other) > size for other in kept):
            kept.append(end)
    return kept


def right_end(vertices: Array, forces: Array, inside: Array) -> float:
    """Right end of a zone.

    Parameters
    ----------
    vertices : (c + 1,) array
        Ends of the cells, ascending.
    forces : (c,) array
        Integrals over the cells of the traction that vanishes at the end.
    inside : (n,) array
        Nodes inside the zone, ascending. The end lies at most two cells beyond the last node.
    """
    last = np.searchsorted(vertices, inside[-1])  # the first vertex at or beyond the last node
    x = vertices[:last][::-1]
    x = x[x >= inside[0]]
    force = np.cumsum(forces[::-1])[len(forces) - last :][: len(x)]
    # leave out the nearest vertex, beyond which the zone covers only part of a cell, if there are enough others
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
    """Left end of a zone: :func:`right_end` of the mirror image."""
    return -right_end(-vertices[::-1], forces[::-1], -inside[::-1])


def _roots(x: Array, y: Array) -> Array:
    """Real roots of the quadratic fitted to (x, y) by relative least squares, in a form without cancellation for nearly
    linear y."""
    scale = x[0] - x[-1]
    t = (x - x[0]) / scale
    c, b, a = np.polynomial.polynomial.polyfit(t, y, 2, w=1 / y).tolist()
    square = b**2 - 4 * a * c
    q = -(b + math.copysign(math.sqrt(max(square, 0.0)), b)) / 2
    if square < 0 or q == 0:
        return np.empty(0)
    roots: Array = x[0] + scale * np.array([c / q, q / a] if a else [c / q])
    return roots
