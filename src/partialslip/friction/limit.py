"""Where cycles end: nothing changes from one to the next any more, or their limit is known.

A node beside an end of the stick zone may need hundreds of cycles to come to its bound, while nothing else changes any
more. Aitken's method finds the limit of cycles in geometric progression from four of them.

Whether a node slips in the steady state is told by the limit of its room up to the bound, and not by the room in the
last cycle: under mean loads zones whose room is a millionth of f p may slip in the next cycle. Cycles therefore go on
until each node is known to keep its room or to lose it.
"""

from collections.abc import Sequence

import numpy as np

from partialslip.tools.arrays import Array, Mask

# accuracy: change of a node's q over a cycle, relative to the largest sum of |q|: rounding (seen: 2.7e-14)
_REPEATS = 3e-14
# accuracy: the same, relative to the largest residual: rounding of displacements, which large tensions make (seen: 15)
_ROUNDED = 30.0
# accuracy: changes over a cycle, over those that count as none, that are rounding where they have not fallen for so
# many cycles
_SMALL, _RESTLESS = 100.0, 8
# accuracy: changes of the last cycle that may lie between it and the limit, however few cycles went before
LIMIT = 10.0
SLIPS = 1e-9  # accuracy: room up to the bound, relative, at which a node slips
# accuracy: of the room of the last cycle: a limit up to the first is none, from the second on some
_LOST, _KEPT = 0.5, 0.75
STATES = 4  # accuracy: ends of cycles that are looked at
_CLEAN = 0.1  # accuracy: of the last change: what the progression may leave unexplained
_STEADY = 0.3  # accuracy: of 1 - ratio: by how much the ratio may change from cycle to cycle


def cycle_change(forces: Array, before: Array, near: Array, largest: float, off: float) -> float:
    """Change of the ``forces`` (n,) over a cycle from those ``before`` it, over what counts as none: ``near`` (n,), and
    the rounding of the ``largest`` sum of forces, without sign, and of displacements, which leave the forces ``off``,
    in the cycle."""
    none = near + _REPEATS * largest + _ROUNDED * off
    return float(np.divide(np.abs(forces - before), none, out=np.zeros_like(none), where=none > 0).max())


def cycles_settled(changes: Sequence[float]) -> bool:
    """Whether nothing changes any more, from the ``changes`` of all cycles (:func:`change`); or nothing but roundings,
    which narrow stick zones under large tension add up to more: small changes that fall no more."""
    last, before = changes[-_RESTLESS:], changes[:-_RESTLESS]
    return changes[-1] <= 1 or (bool(before) and max(last) <= _SMALL and min(last) >= min(before))


def ahead(states: Sequence[Array], bound: Array) -> float | None:
    """Distance of the state at the end of a cycle from its limit, over its last change.

    Parameters
    ----------
    states : sequence of (n,) arrays
        Tangential forces at the same load point of cycles in turn, without any other step between them.
    bound : (n,) array
        f times the normal forces, which limit them.

    Returns
    -------
    float or None
        None if the changes from cycle to cycle are no geometric progression.
    """
    if len(states) < STATES:
        return None
    off = np.divide(np.diff(states[-STATES:], axis=0), bound, out=np.zeros((STATES - 1, len(bound))), where=bound > 0)
    squares = (off[:-1] ** 2).sum(axis=1)
    if not squares.all():
        return None
    before, ratio = ((off[:-1] * off[1:]).sum(axis=1) / squares).tolist()
    rest = np.abs(off[-1] - ratio * off[-2]).max()
    if not 0 < ratio < 1 or abs(ratio - before) > _STEADY * (1 - ratio) or rest > _CLEAN * np.abs(off[-1]).max():
        return None
    return float(ratio / (1 - ratio))


def limit(states: Sequence[Array], bound: Array, times: float) -> Array:
    """Limit (n,) of the ``states``, ``times`` their last change away (:func:`ahead`), within the ``bound``."""
    return np.clip(states[-1] + (states[-1] - states[-2]) * times, -bound, bound)


def room_of(visited: Sequence[tuple[Array, Array]], ends: tuple[int, int] | None) -> Array:
    """Room (n,) up to the bounds in a cycle, of q and the bounds f p, (n,) each, at its load points: 2 f p - \\|dq\\|
    between the ``ends`` of the cycle; out of phase, where there are none, the least room up to f p and down to -f p."""
    if ends:
        (q1, bound1), (q2, bound2) = (visited[end] for end in ends)
        return bound1 + bound2 - np.abs(q2 - q1)
    q, bounds = (np.array(each) for each in zip(*visited, strict=True))
    room: Array = (bounds - q).min(axis=0) + (bounds + q).min(axis=0)
    return room


def falls(rooms: Sequence[Array] | Array) -> Array:
    """Decrease of room still to come, (n,), by Aitken's method.

    From the last three of the ``rooms`` by cycle, with the decreases d1 and d2: d2^2/(d1 - d2), the rest of a geometric
    progression; 0 if d2 <= 0, nan if d2 >= d1, or with fewer cycles.
    """
    if len(rooms) < 3:
        return np.full(len(rooms[-1]), np.nan)
    fell, fall = -np.diff(rooms[-3:], axis=0)
    left = np.divide(fall**2, fell - fall, out=np.full(len(fall), np.nan), where=(fall > 0) & (fall < fell))
    return np.where(fall <= 0, 0.0, left)


def lost(rooms: Sequence[Array] | Array) -> Mask:
    """Nodes (n,) whose room tends to zero: :func:`falls` takes at least ``_LOST`` of it. Of room that decreases like a
    power of the number of cycles it takes less."""
    return falls(rooms) >= _LOST * rooms[-1]


def undecided(rooms: Sequence[Array] | Array, bound: Array, moved: float, cycles: int) -> Mask:
    """Nodes (n,) of which the cycles so far do not show whether they slip in the steady state.

    Parameters
    ----------
    rooms : sequence of (n,) arrays
        Rooms that q leaves up to the bounds in each of the cycles in turn.
    bound : (n,) array
        f times the normal forces.
    moved : float
        Largest change of q over the last cycle, in the bound.
    cycles : int
        Number of cycles so far: room that falls with a power of them lasts as many changes.
    """
    room = rooms[-1]
    near = (room > SLIPS * bound) & (room <= max(LIMIT, cycles) * moved * bound)
    if len(rooms) < 2:
        return near
    left = falls(rooms)
    fall = np.maximum(rooms[-2] - room, 0.0)
    unclear = np.where(np.isnan(left), fall > (1 - _KEPT) * room, (left > (1 - _KEPT) * room) & (left < _LOST * room))
    return near & unclear


class Cycles:
    """Cycles of one path, in turn: whether they end, and whether the last one is steady.

    Parameters
    ----------
    settled : float
        Largest change of q over the last cycle, in the bound; rounding comes on top.
    steady : float
        The same of a steady state.
    """

    def __init__(self, settled: float, steady: float) -> None:
        self._settled, self._steady, self._count = settled, steady, 0
        self.skipped()

    def skipped(self) -> None:
        """Forget the cycles: those that follow do not begin where they ended."""
        self.changes, self.rooms = list[float](), list[Array]()

    def add(self, q: Array, before: Array, bound: Array, room: Array, largest: float, off: float) -> None:
        """Add a cycle that changes the forces ``before`` (n,) to ``q`` and leaves the ``room`` (n,) to the bounds;
        ``largest`` and ``off`` as for :func:`cycle_change`."""
        self._count += 1
        self.changes.append(cycle_change(q, before, self._settled * bound, largest, off))
        self.rooms.append(room)
        moved = cycle_change(q, before, bound, largest, off)
        decided = not undecided(self.rooms, bound, moved, self._count).any()
        self.end = decided and cycles_settled(self.changes)
        self.steady = self.end or (decided and moved <= self._steady)
