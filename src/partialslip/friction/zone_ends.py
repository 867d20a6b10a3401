"""Ends of the contact and of the stick zone, located to a fraction of a cell.

Towards the end of the contact p falls like a square root, and so does 2 f p - |dq| towards the end of the stick zone.
The force between a mesh vertex and the end therefore varies like distance^(3/2). Force^(2/3) is a smooth function of x,
and its root is the end. Forces are more accurate than nodal tractions: they hardly depend on the error of the traction
in the last elements.

The fit needs a smooth function. Cells grow away from the end, so its vertices may reach as far as a kink of the
profile, or as far as the gap departs from a parabola. A second fit, to fewer vertices, tells by how much that matters.

Where the stick zone moves over nodes that have slipped, they re-stick, and 2 f p - |dq| falls towards the end like
distance^(3/2): the force varies like distance^(5/2), and force^(2/5) is smooth. The loads at which these nodes re-stuck
tell the end, too: it is read from them where many stuck at once.

An end that came back into a strip of such nodes is fitted to this strip alone: at its other side q has a kink. Where
the strip is narrow, the end lies between the last node that sticks and the first one that slips. The strip may be
narrower than the distance of two nodes: then no node lies in it, but the first one beyond had re-stuck before it
slips, if it slips at all.
"""

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from partialslip.tools.arrays import Array, Indices, Mask

VERTICES = 5  # accuracy: of the fit
# accuracy: of the fit that tells its error (measured on flat-rounded contacts: beside kinks it is several times more
# accurate; without a kink both fits agree to a tenth of the error that the elements leave)
NEAREST = 3
_BESIDE, _FINER = 3, 0.95  # accuracy: cells compared on each side of a refined point; relative size of refined cells
_STICKS = 1e-9  # accuracy: room, relative to the bound, up to which a node slips
_LEAVES = 1e-6  # accuracy: distance of q from the bound, relative, that counts as none: such weak kinks do not matter
_CAUGHT = 20  # accuracy: nodes that tell where an end that moves outwards is
# accuracy: times the room of a node at an end: that of its neighbours, where it does not grow inwards; and their number
# (beside a square root up to 14 equal cells have room as even as that)
_SAME, _MANY = 4.0, 16
_RUN = 4  # accuracy: fewest neighbouring nodes that make a zone; fewer are noise
_ROOT, _CAUGHT_UP = 2 / 3, 2 / 5  # fixed: powers of the force that vanish linearly at an end
# fixed: powers of the distance with which the normal force grows from an end of the contact
ROUNDED, CORNER = 3 / 2, 1 / 2


@dataclass(frozen=True)
class StickInterval:
    r"""Stick zone [``left``, ``right``], where \|dq\| is below the sum of the bounds, with what its ends are read from;
    pairs: left, right.

    ``signs``: of dq beside the ends. ``moved``: whether the end last moved outwards, over points that had slipped.
    ``caught``: such ends from the loads at which the nodes beside them re-stuck; nan without such nodes. ``strips``:
    lengths within which an end is uncertain: few nodes slipped there, or room is hardly any, or too few nodes for a fit
    slipped, or, beside an end that moved, the two readings differ. ``fits``: differences between fits to many and to
    few vertices, the errors of the fit.
    """

    left: float
    right: float
    signs: tuple[int, int]
    moved: tuple[bool, bool] = (False, False)
    caught: tuple[float, float] = (math.nan, math.nan)
    strips: tuple[float, float] = (0.0, 0.0)
    fits: tuple[float, float] = (0.0, 0.0)


def read_stick_zone(
    x: Array,
    bound: Array,
    change: Array,
    vertices: Array,
    cell_forces: Callable[[Array], Array],
    changed: Array | None = None,
    unsteady: Array | None = None,
    stuck: Array | None = None,
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
    changed : (n,) array, optional
        When nodes last began to slip or to stick; nan where they did neither, or do not in the steady state.
    unsteady : (n,) array, optional
        Room that counts as none.
    stuck : (n,) array, optional
        When nodes last re-stuck, be it that they slipped once more; nan where they never did.
    """
    room = np.divide(2 * bound - np.abs(change), bound, out=np.zeros_like(bound), where=bound > 0)
    still = room > _STICKS  # nodes whose room is unsteady re-stick, too
    if unsteady is not None:
        room = np.where(room * bound <= unsteady, 0.0, room)
        change = np.where(room > 0, change, np.sign(change) * 2 * bound)
    sticks = _around(int(np.argmax(room)), x, room > _STICKS, vertices)
    first, last = (sticks[0], sticks[-1] + 1) if len(sticks) else (0, len(x))
    signs = _sign(change[:first], bound[:first], change[0]), _sign(change[last:][::-1], bound[last:][::-1], change[-1])
    if len(sticks) == 0:  # a stick zone smaller than a cell lies where slip changes sign
        turn = int(np.argmax(np.sign(change) != np.sign(change[0])))
        point = float(x[max(turn - 1, 0)] + x[turn]) / 2
        return StickInterval(point, point, signs)
    rooms = (cell_forces(2 * bound - sign * change) for sign in signs)
    powers = [_power(changed, still, sticks[:_RUN], first - 1), _power(changed, still, sticks[::-1][:_RUN], last)]
    # at the other side of nodes that slipped before, q has a kink, which no fit may reach across
    fitted = [
        inside if power != _ROOT else inside[: _slipped(changed, inside) or len(inside)]
        for inside, power in zip((sticks, sticks[::-1]), powers, strict=True)
    ]
    (left, near_left), (right, near_right) = (
        [end_of(vertices, room, np.sort(x[nodes]), power, count) for count in (VERTICES, NEAREST)]
        for end_of, room, nodes, power in zip((left_end, right_end), rooms, fitted, powers, strict=True)
    )
    fits = abs(left - near_left), abs(right - near_right)
    if changed is not None:  # beside a point where an end reversed, few vertices are left to the fit
        left = float(np.clip(left, *x[np.clip([first - 2, first + 1], 0, len(x) - 1)]))
        right = float(np.clip(right, *x[np.clip([last - 2, last + 1], 0, len(x) - 1)]))
    moved = powers[0] != _ROOT, powers[1] != _ROOT
    if changed is None:
        return StickInterval(left, max(right, left), signs, moved, fits=fits)
    caught = _caught_up(x, changed, sticks), _caught_up(x, changed, sticks[::-1])
    ends, strips = [left, right], [0.0, 0.0]
    for side, (inside, beyond) in enumerate(((sticks, first - 1), (sticks[::-1], last))):
        strips[side] = _flat(x, room, inside)
        if not 0 <= beyond < len(x):
            continue
        if moved[side]:
            ends[side], unsure = _outward_end(
                x, changed, inside, ends[side], caught[side], fits[side], bool(still[beyond])
            )
            strips[side] = max(strips[side], unsure)
            continue
        count = _slipped(changed, inside)
        few = count > 0 and _vertices(x[inside[[0, count - 1]]], vertices) < VERTICES
        again = stuck is not None and bool(np.isfinite(stuck[beyond]) and not stuck[beyond] >= changed[beyond])
        none = again and bool(np.isnan(changed[inside[0]]))
        if few or none:
            ends[side] = float(x[inside[0]] + x[beyond]) / 2
            apart = inside[count] if 0 < count <= _RUN else beyond
            strips[side] = max(strips[side], abs(float(x[apart] - x[inside[0]])))
    left, right = ends
    return StickInterval(left, max(right, left), signs, moved, caught, (strips[0], strips[1]), fits)


def _outward_end(
    x: Array, changed: Array, inside: Indices, read: float, caught: float, fit: float, hidden: bool
) -> tuple[float, float]:
    r"""An end of the stick zone that has moved outwards, and its error.

    Two readings: ``read``, from the room 2 f p - \|dq\|, with the error ``fit`` of its fit; ``caught``, from the loads
    at which the nodes ``inside`` re-stuck, which replaces ``read`` where ``_RUN`` nodes or more re-stuck in one event
    and both agree. The error is their difference, at most the length of these nodes. ``hidden``: the room there is
    within rounding.
    """
    apart = abs(caught - read)
    if not math.isfinite(apart):
        return read, 0.0
    if hidden:
        return read, apart
    together = int(np.count_nonzero(changed[inside] == changed[inside[0]]))
    reach = x[inside[: max(together, _RUN)]]
    near = abs(float(reach[-1] - reach[0]))  # readings farther apart than few nodes tell no more
    if together >= _RUN:
        return caught if apart <= near else read, min(apart, near)
    return read, min(apart, near) if fit == 0 else 0.0


def _slipped(changed: Array | None, inside: Indices) -> int:
    """Number of nodes ``inside`` the stick zone, from an end on, up to the first one that has not slipped; 0 if all
    have, or if this is not known."""
    if changed is None:
        return 0
    still = np.flatnonzero(~np.isfinite(changed[inside]))
    return int(still[0]) if len(still) else 0


def _vertices(between: Array, vertices: Array) -> int:
    """Number of ``vertices`` (c + 1,) ``between`` two points (2,)."""
    return abs(int(np.subtract(*np.searchsorted(vertices, between))))


def _flat(x: Array, room: Array, inside: Indices) -> float:
    """Length beside an end of the stick zone over which the ``room`` of the nodes ``inside``, over the bound, is small
    and uniform, so that the end is uncertain by this length; 0 where room grows with the distance from the end, as
    usual."""
    found = room[inside]
    flat = (found <= _LEAVES) & (found <= _SAME * found[0])
    count = len(flat) if flat.all() else int(np.argmin(flat))
    return abs(float(x[inside[count - 1]] - x[inside[0]])) if count >= _MANY else 0.0


def _caught_up(x: Array, changed: Array, inside: Indices) -> float:
    """Where an end of the stick zone is at the end of a leg on which it moved outwards, from the shares of the leg at
    which the nodes ``inside`` the zone, from the end on, re-stuck: its speed is finite there; nan if they
    stuck at fewer than ``_RUN`` instants."""
    since = 1 - changed[inside[:_CAUGHT]]
    still = np.flatnonzero(~np.isfinite(since))
    count = int(still[0]) if len(still) else len(since)
    since = since[:count]
    if len(np.unique(since)) < _RUN:
        return math.nan
    return float(np.linalg.lstsq(np.vander(since / since.max(), 3), x[inside[:count]], rcond=None)[0][-1])


def _power(changed: Array | None, still: Mask, inside: Indices, outside: int) -> float:
    """Power of the force at an end of the stick zone with the nodes ``inside`` it, from the end on, and the node
    ``outside``: whether the end has moved outwards, over nodes that slipped before. It has if the node outside sticks
    ``still`` (n,), too, with room that counts as none."""
    if changed is None or not 0 <= outside < len(changed) or not np.isfinite(changed[inside]).all():
        return _ROOT
    since = np.nan_to_num(changed[[inside[0], inside[-1], outside]], nan=-1.0)
    return _CAUGHT_UP if still[outside] or since[:2].max() > since[2] else _ROOT


def _sign(changes: Array, bounds: Array, outermost: float) -> int:
    """Sign of the changes of q (k,) in a slip zone, from the end of the contact on: of the first one that is not
    rounding beside the friction ``bounds`` (k,), as q may not change at all where the contact comes and goes; of the
    ``outermost`` change if nothing slips."""
    clear = np.flatnonzero(np.abs(changes) > _STICKS * bounds)
    return 1 if (changes[clear[0]] if len(clear) else outermost) > 0 else -1


def _around(most: int, x: Array, sticks: Mask, vertices: Array) -> Indices:
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
    return np.flatnonzero(sticks & (after > ends[last - 1]) & (before < ends[last]))


def within(stick: StickInterval, common: tuple[float, float], vertices: Array) -> StickInterval:
    """``stick`` limited to the ``common`` part of the contacts at both load points. An end within a cell of the end of
    that part is the end of that part, where no slip is seen."""
    low, high = common
    cells = np.clip(np.searchsorted(vertices, [low, high]), 1, len(vertices) - 1)
    near = np.diff(vertices)[cells - 1]
    left = low if stick.left < low + near[0] else stick.left
    right = high if stick.right > high - near[1] else stick.right
    return replace(stick, left=min(left, right), right=right)


def sticking_zones(bound: Array, change: Array) -> int:
    """Number of zones of at least ``_RUN`` neighbouring nodes that stick, from the ``bound`` and the ``change`` (n,) of
    tangential forces from load point 1 to 2."""
    sticks = np.concatenate([[False], 2 * bound - np.abs(change) > _STICKS * bound, [False]])
    turns = np.flatnonzero(np.diff(sticks))
    return int(np.count_nonzero(turns[1::2] - turns[::2] >= _RUN))


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


def turning_points(x: Array, still: Mask, slips: Mask) -> list[float]:
    """Points where an end of the stick zone reversed, which leaves a kink in q: between the nodes ``x`` (n,),
    ascending, that are ``still`` (n,) in a steady cycle and those that slip, but for the ends of the stick zone, beside
    which a node ``slips`` (n,) from load point 1 to 2."""
    starts = np.concatenate([[0], np.flatnonzero(np.diff(still)) + 1, [len(x)]])
    starts = starts[:-1][np.diff(starts) >= _RUN]
    turns = starts[1:][np.diff(still[starts])]
    ends = np.append(np.flatnonzero(np.diff(slips)) + 1, len(x) + _RUN)
    turns = turns[np.abs(turns[:, None] - ends).min(axis=1) > 1]
    return ((x[turns - 1] + x[turns]) / 2).tolist()


def finest(vertices: Array) -> list[float]:
    """Inner vertices around which a graded mesh is refined: cells beside them are the smallest in the neighbourhood."""
    widths = np.diff(vertices)
    if len(widths) < 2 * _BESIDE + 1:
        return []
    smallest = (widths[1:] + widths[:-1]) / 2
    wide = np.lib.stride_tricks.sliding_window_view(np.pad(smallest, _BESIDE, constant_values=np.inf), 2 * _BESIDE + 1)
    far = np.pad(widths, _BESIDE, mode="edge")
    larger = np.minimum(far[: len(smallest)], far[2 * _BESIDE + 1 :][: len(smallest)])
    return vertices[1:-1][(smallest <= wide.min(axis=1)) & (smallest < _FINER * larger)].tolist()


def apart(ends: Sequence[float], size: float, known: Sequence[float] = ()) -> list[float]:
    """The ``known`` ends, and the ``ends`` without those within ``size`` of a known or an earlier one."""
    kept = [*known]
    for end in ends:
        if all(abs(end - other) > size for other in kept):
            kept.append(end)
    return kept


def right_end(vertices: Array, forces: Array, inside: Array, power: float = _ROOT, count: int = VERTICES) -> float:
    """Right end of a zone.

    Parameters
    ----------
    vertices : (c + 1,) array
        Ends of the cells, ascending.
    forces : (c,) array
        Integrals over the cells of the traction that vanishes at the end.
    inside : (n,) array
        Nodes inside the zone, ascending. The end lies at most two cells beyond the last node.
    power : float
        Power of the force from the end on that is smooth.
    count : int
        Number of vertices next to the end that the smooth function is fitted to.
    """
    last = np.searchsorted(vertices, inside[-1])  # the first vertex at or beyond the last node
    x = vertices[:last][::-1]
    x = x[x >= inside[0]]
    force = np.cumsum(forces[::-1])[len(forces) - last :][: len(x)]
    # leave out the nearest vertex, beyond which the zone covers only part of a cell, if there are enough others
    skip = 1 if len(x) > VERTICES else 0
    x, force = x[skip : skip + count], force[skip : skip + count]
    near, far = inside[-1], vertices[min(last + 1, len(vertices) - 1)]
    beyond = vertices[min(int(np.searchsorted(vertices, near, "right")), len(vertices) - 1)]
    if len(x) >= 3 and (force > 0).all():
        roots = _roots(x, force**power)
        between = roots[(roots > x[0]) & (roots < far)]
        if len(between):
            return float(between.min())
    return float((near + max(near, beyond)) / 2)


def contact_ends(
    vertices: Array,
    normal: Array,
    inside: Array,
    shear: Array | None = None,
    beta: float = 0.0,
    rise: float = ROUNDED,
    count: int = VERTICES,
) -> tuple[float, float]:
    """Left and right end of the contact.

    Where dissimilar bodies slip under q = r p, p varies near the right end like distance^(1/2 + atan(beta r)/pi), and
    near the left end like distance^(1/2 - atan(beta r)/pi) (Comninou 1976).

    Parameters
    ----------
    vertices : (c + 1,) array
        Ends of the cells, ascending.
    normal, shear : (c,) arrays
        Integrals of p and q over the cells. Without ``shear`` the powers are those of like bodies.
    inside : (n,) array
        Nodes in contact, ascending.
    beta : float
        Dundurs' constant: positive where pressure moves the upper surface more than the lower one towards the load.
    rise : float
        Power of the distance with which the normal force grows from an end where q vanishes: ``ROUNDED`` where the
        surfaces part smoothly, ``CORNER`` under a flat punch.
    count : int
        As for :func:`right_end`.
    """
    more = [0.0, 0.0]
    if shear is not None and beta:
        first, last = np.searchsorted(vertices, inside[[0, -1]])
        for side, cells in enumerate(
            (slice(max(first - 1, 0), first - 1 + VERTICES), slice(max(last - VERTICES, 0), last))
        ):
            total = float(normal[cells].sum())
            more[side] = math.atan(beta * float(shear[cells].sum()) / total) / math.pi if total > 0 else 0.0
    left = left_end(vertices, normal, inside, 1 / (rise - more[0]), count)
    return left, right_end(vertices, normal, inside, 1 / (rise + more[1]), count)


def left_end(vertices: Array, forces: Array, inside: Array, power: float = _ROOT, count: int = VERTICES) -> float:
    """Left end of a zone: :func:`right_end` of the mirror image."""
    return -right_end(-vertices[::-1], forces[::-1], -inside[::-1], power, count)


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
    return x[0] + scale * np.array([c / q, q / a] if a else [c / q])
