"""Linear systems of all partitions of nodes into open, slipping and sticking ones, from one factor of the compliances.

Most nodes stick in the middle of the contact. With these nodes first, and the others by their distance from them, one
Cholesky factor C = L L^T serves all partitions: the first nodes stick in each of them and are eliminated, and what they
leave of the compliances of the others is the product of the last rows of L. Systems are of the others only. Those of
fewer nodes, in a contact that grows, are leading parts of the same factor.
"""

from typing import NamedTuple, Protocol

import numpy as np
import scipy.linalg as la

from partialslip.arrays import Array, Indices, Mask, submatrix
from partialslip.condensed.bounded import Sides

_CORE = 0.4  # of the touching nodes: if fewer stick in one piece, a factor does not pay
_USED = 0.7  # of the sticking piece: a factor whose first nodes cover less of it is a poor one
_POOR = 2  # partitions that a poor factor does not serve before another one is made
_ROOM = 1.05  # nodes in a factor, relative to those that it is made for
_SLACK = 0.3  # of the nodes that are not eliminated: so many that stick may be among them


class Compliances(Protocol):
    """Relative compliances (n, n), symmetric together (:class:`partialslip.condensed.coupled.Relative`)."""

    @property
    def xx(self) -> Array | None: ...
    @property
    def yy(self) -> Array: ...
    @property
    def xy(self) -> Array | None: ...


class Forces(NamedTuple):
    """Forces ``p`` and ``q`` (n,) of a partition, and the rigid motion of the bodies, (2,): approach and shift."""

    p: Array
    q: Array
    rigid: Array


class Factors:
    """The factor of the compliances ``C`` that serves the latest partitions."""

    def __init__(self, C: Compliances) -> None:
        self._C, self._poor = C, 0
        self._nested: Nested | None = None
        self.made = 0

    def partition(self, touch: Mask, slip: Sides, f: float) -> "Partition | None":
        """The linear system of nodes (n,) that ``touch``, and slip where ``slip`` is the sign of q, with the coefficient
        of friction ``f``; None if it is better solved directly."""
        first, last = _longest(touch & (slip == 0))
        if last - first < _CORE * np.count_nonzero(touch):
            return None
        nested = self._nested
        if nested is None or nested.core(touch, slip) < _USED * (last - first):
            self._poor += 1
            if nested is not None and self._poor <= _POOR:
                return None
            self._nested, self._poor = Nested(self._C, (first + last - 1) // 2), 0
        assert self._nested
        self.made += self._nested.reach(touch)
        return Partition(self._nested, touch, slip, f)


class Nested:
    """Cholesky factor ``L`` of the compliances ``C`` of the nodes nearest to the node ``middle``, by their distance
    from it, y and x of each node in turn."""

    def __init__(self, C: Compliances, middle: int) -> None:
        self._C, n = C, len(C.yy)
        self.order: Indices = np.argsort(np.abs(np.arange(n) - middle), kind="stable")
        self.L, self.by_rigid = np.empty((0, 0)), np.empty((0, 2))
        self._tail: tuple[int, Array] = 0, np.empty((0, 0))

    def core(self, touch: Mask, slip: Sides) -> int:
        """Number of the first nodes that all touch and stick."""
        return _leading((touch & (slip == 0))[self.order])

    def reach(self, touch: Mask) -> bool:
        """Include all nodes that ``touch`` (n,); whether this took a new factor."""
        count = int(np.flatnonzero(touch[self.order])[-1]) + 1
        if 2 * count <= len(self.L):
            return False
        C, count = self._C, min(int(_ROOM * count) + 2, len(touch))
        assert C.xx is not None
        assert C.xy is not None
        at = self.order[:count]
        whole = np.empty((2 * count, 2 * count), order="F")
        whole[::2, ::2], whole[1::2, 1::2] = submatrix(C.yy, at, at), submatrix(C.xx, at, at)
        whole[1::2, ::2] = submatrix(C.xy, at, at)
        whole[::2, 1::2] = whole[1::2, ::2].T
        self.L, failed = la.lapack.dpotrf(whole, lower=True, clean=True, overwrite_a=True)
        if failed:
            raise la.LinAlgError(f"the leading minor {failed} of the compliances is not positive")
        rigid = np.zeros((2 * count, 2), order="F")
        rigid[::2, 0] = rigid[1::2, 1] = 1
        self.by_rigid, self._tail = self.forward(rigid), (0, np.empty((0, 0)))
        return True

    def forward(self, load: Array) -> Array:
        """L^-1 ``load``, (m, k)."""
        result: Array = la.blas.dtrsm(1.0, self.L, load, lower=True)
        return result

    def backward(self, load: Array) -> Array:
        """L^-T ``load``, (m,)."""
        result: Array = la.blas.dtrsv(self.L, load, lower=True, trans=1)
        return result

    def tail(self, core: int, count: int) -> tuple[int, Array]:
        """How many of the first ``core`` nodes are eliminated, and the compliances of those that follow."""
        begin, matrix = self._tail
        if not begin <= core <= begin + _SLACK * (count - begin) or not len(matrix):
            begin = max(core - int(_SLACK / 3 * (count - core)) - 1, 0)
            rows = self.L[2 * begin :, 2 * begin :]
            self._tail = begin, rows @ rows.T
        return self._tail


class Partition:
    """The linear system of nodes (n,) that ``touch``, and slip where ``slip`` is the sign of q; ``by`` a factor, with
    the coefficient of friction ``f``."""

    def __init__(self, by: Nested, touch: Mask, slip: Sides, f: float) -> None:
        order = by.order[: len(by.L) // 2]
        touches, slips = touch[order], slip[order]
        self._by, self._n, self._order = by, len(touch), order
        self._begin, matrix = by.tail(by.core(touch, slip), len(order))
        on = np.flatnonzero(touches[self._begin :])
        self._drag = f * slips[self._begin :][on]
        sticks = on[self._drag == 0]
        self._along_y, self._along_x, self._all_x = 2 * on, 2 * sticks + 1, 2 * on + 1
        self._rows = np.concatenate([self._along_y, self._along_x])
        rows = matrix.take(self._rows, axis=0)
        left = rows.take(self._along_y, axis=1) + rows.take(self._all_x, axis=1) * self._drag
        system = np.concatenate([left, rows.take(self._along_x, axis=1)], axis=1)
        self._factors = la.lu_factor(system, overwrite_a=True, check_finite=False) if len(on) else None

    def solve(self, load: Array, totals: Array) -> Forces:
        """Forces for the displacements ``load`` (2, n), along y and x, that sum to ``totals`` (2,)."""
        by, cut = self._by, 2 * self._begin
        given = np.empty((len(by.L), 3), order="F")
        given[:, 0], given[:, 1:] = by.forward(load[:, self._order].T.reshape(-1, 1))[:, 0], by.by_rigid
        last = by.L[cut:, cut:] @ given[cut:]
        forces = np.zeros((len(last), 3))
        if self._factors:
            found = la.lu_solve(self._factors, last[self._rows], check_finite=False)
            pressed = found[: len(self._along_y)]
            forces[self._along_y], forces[self._all_x] = pressed, self._drag[:, None] * pressed
            forces[self._along_x] = found[len(self._along_y) :]
        first = given[:cut] - by.L[cut:, :cut].T @ forces
        sums = by.by_rigid[:cut].T @ first + np.stack([forces[::2].sum(axis=0), forces[1::2].sum(axis=0)])
        rigid = np.linalg.solve(sums[:, 1:], totals - sums[:, 0])
        weights = np.append(1.0, rigid)
        every = by.backward(np.concatenate([first @ weights, np.zeros(len(last))]))
        every[cut:] = forces @ weights
        p, q = np.zeros(self._n), np.zeros(self._n)
        p[self._order], q[self._order] = every[::2], every[1::2]
        return Forces(p, q, rigid)


def _leading(mask: Mask) -> int:
    """Number of leading true values."""
    return len(mask) if mask.all() else int(np.argmin(mask))


def _longest(mask: Mask) -> tuple[int, int]:
    """The longest run of true values, from the first index up to the other."""
    ends = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]))).reshape(-1, 2)
    if not len(ends):
        return 0, 0
    first, last = ends[np.argmax(ends[:, 1] - ends[:, 0])]
    return int(first), int(last)
