"""Linear systems of all partitions of nodes into open, slipping and sticking ones, from one factor of the compliances.

Most nodes stick in the middle of the contact. With these nodes first, and the others by their distance from them, one
Cholesky factor C = L L^T serves all partitions: the first nodes stick in each of them and are eliminated, and what they
leave of the compliances of the others is the product of the last rows of L. Systems are of the others only. Those of
fewer nodes, in a contact that grows, are leading parts of the same factor.
"""

from typing import NamedTuple, Protocol

import numpy as np
import scipy.linalg as la

from partialslip.friction.active_set import Sides
from partialslip.tools.arrays import Array, Indices, Mask, submatrix

_KEPT = 2  # cost: factors
_TAILS = 3  # cost: products of their last rows
_PAYS = 0.7  # cost: of the unknowns without a factor: a system with more is better solved directly
_COST = 6.0  # cost: of a factor of n nodes, as a multiple of the cost of a system of n unknowns
_EVEN = 0.45  # cost: of the nodes that stick: so many on the shorter side of the middle are about half of them
_ROOM = 1.05  # cost: nodes in a factor, relative to those that it is made for
_SLACK = 0.3  # cost: of the nodes that are not eliminated: so many that stick may be among them


class Compliances(Protocol):
    """Relative compliances (n, n), symmetric together (:class:`partialslip.friction.coupled_step.Relative`)."""

    @property
    def xx(self) -> Array | None:
        """Of displacements along x under forces along x."""

    @property
    def yy(self) -> Array:
        """Of displacements along y under forces along y."""

    @property
    def xy(self) -> Array | None:
        """Of displacements along x under forces along y."""


class Forces(NamedTuple):
    """Forces ``p`` and ``q`` (n,) of a partition, and the rigid motion of the bodies: approach, shift and, of a body on
    a pin, the angle by which it has turned."""

    p: Array
    q: Array
    rigid: Array


class Factors:
    """Factors of the compliances ``C``, made where they save more than they cost: when systems that an earlier one with
    other nodes in the middle would have made smaller have cost as much. ``made`` counts them."""

    def __init__(self, C: Compliances) -> None:
        self._C, self._kept = C, list[Nested]()
        self._missed = 0.0
        self.made = 0

    def partition(self, touch: Mask, slip: Sides, f: Array) -> "Partition | None":
        """The linear system of nodes (n,) that ``touch``, and slip where ``slip`` is the sign of q, with the friction
        ``f`` (n,); None if it is better solved directly."""
        sticks, count = touch & (slip == 0), int(np.count_nonzero(touch))
        every = count + int(np.count_nonzero(sticks))
        first, last = longest(sticks)
        best = max(self._kept, key=lambda each: each.core(sticks), default=None)
        left = every - 2 * best.core(sticks) if best else every
        self._missed += left**3 - (every - 2 * (last - first)) ** 3
        if self._missed > _COST * count**3 or not best:
            self._missed, left = 0.0, every - 2 * (last - first)
            best = Nested(self._C, _middle(touch, first, last))
            self._kept = [*self._kept[-_KEPT + 1 :], best]
        if left > _PAYS * every:
            return None
        self.made += best.reach(touch)
        return Partition(best, touch, slip, f)


class Nested:
    """Cholesky factor ``L`` of the compliances ``C`` of the nodes nearest to the node ``middle``, by their distance
    from it, y and x of each node in turn."""

    def __init__(self, C: Compliances, middle: int) -> None:
        self._C, n = C, len(C.yy)
        self.order: Indices = np.argsort(np.abs(np.arange(n) - middle), kind="stable")
        self.L, self.by_rigid = np.empty((0, 0)), np.empty((0, 2))
        self._tails = list[tuple[int, Array]]()
        self._loaded: tuple[Array, Array] = np.empty((2, 0)), np.empty(0)

    def core(self, sticks: Mask) -> int:
        """Number of leading nodes of the elimination order that all stick; ``sticks`` (n,)."""
        return _leading(sticks[self.order])

    def reach(self, touch: Mask) -> bool:
        """Extend the factor to all nodes that ``touch`` (n,); True if it was extended."""
        count = int(np.flatnonzero(touch[self.order])[-1]) + 1
        if 2 * count <= len(self.L):
            return False
        known, count = len(self.L) // 2, min(int(_ROOM * count) + 2, len(touch))
        rows = self._rows(known, count)
        L, end = np.zeros((2 * count, 2 * count), order="F"), 2 * known
        L[:end, :end] = self.L
        if known:  # the rows of the nodes that are new
            L[end:, :end] = la.blas.dtrsm(1.0, self.L, rows[:, :end], side=True, lower=True, trans_a=True)
            rows = rows[:, end:] - L[end:, :end] @ L[end:, :end].T
        L[end:, end:], failed = la.lapack.dpotrf(rows, lower=True, clean=True)
        if failed:
            raise la.LinAlgError(f"the leading minor {end + failed} of the compliances is not positive")
        rigid = np.zeros((2 * count, 2), order="F")
        rigid[::2, 0] = rigid[1::2, 1] = 1
        self.L, self.by_rigid = L, la.blas.dtrsm(1.0, L, rigid, lower=True)
        return True

    def _rows(self, first: int, count: int) -> Array:
        """Rows of the compliances of the nodes from the ``first`` in their order to the one before ``count``."""
        C, at = self._C, self.order[:count]
        assert C.xx is not None
        assert C.xy is not None
        rows = np.empty((2 * (count - first), 2 * count), order="F")
        rows[::2, ::2], rows[1::2, 1::2] = (submatrix(each, at[first:], at) for each in (C.yy, C.xx))
        rows[1::2, ::2], rows[::2, 1::2] = submatrix(C.xy, at[first:], at), submatrix(C.xy, at, at[first:]).T
        return rows

    def loaded(self, load: Array) -> Array:
        """L^-1 of the displacements ``load`` (2, n) of the first nodes, (m,); that of the last load is remembered."""
        if self._loaded[0] is not load or len(self._loaded[1]) != len(self.L):
            given = load[:, self.order[: len(self.L) // 2]].T.ravel()
            self._loaded = load, la.blas.dtrsv(self.L, given, lower=True)
        return self._loaded[1]

    def transposed(self, forces: Array) -> Array:
        """L^-T ``forces``, (m,)."""
        return la.blas.dtrsv(self.L, forces, lower=True, trans=True)

    def tail(self, core: int, count: int) -> tuple[int, Array]:
        """How many of the first ``core`` nodes are eliminated, and the compliances of those that follow, up to
        ``count`` nodes at least."""
        for begin, matrix in self._tails:
            if begin <= core <= begin + _SLACK * (count - begin) and len(matrix) >= 2 * (count - begin):
                return begin, matrix
        begin = max(core - int(_SLACK / 3 * (count - core)) - 1, 0)
        end = min(int(_ROOM * count) + 2, len(self.L) // 2)
        found = begin, _by_its_transpose(self.L[2 * begin : 2 * end, 2 * begin : 2 * end])
        self._tails = [found, *self._tails[: _TAILS - 1]]
        return found


class Partition:
    """The linear system of nodes (n,) that ``touch``, and slip where ``slip`` is the sign of q; ``by`` a factor, with
    the coefficients of friction ``f`` (n,)."""

    def __init__(self, by: Nested, touch: Mask, slip: Sides, f: Array) -> None:
        order = by.order[: int(np.flatnonzero(touch[by.order])[-1]) + 1]
        touches, slips = touch[order], slip[order]
        self._by, self._n, self._order = by, len(touch), order
        self._begin, matrix = by.tail(by.core(touch & (slip == 0)), len(order))
        on = np.flatnonzero(touches[self._begin :])
        self._drag = (f[order] * slips)[self._begin :][on]
        sticks = on[self._drag == 0]
        self._along_y, self._along_x, self._all_x = 2 * on, 2 * sticks + 1, 2 * on + 1
        self._rows = np.concatenate([self._along_y, self._along_x])
        rows = matrix.take(self._rows, axis=0)
        left = rows.take(self._along_y, axis=1) + rows.take(self._all_x, axis=1) * self._drag
        system = np.concatenate([left, rows.take(self._along_x, axis=1)], axis=1)
        self._factors = la.lu_factor(system, overwrite_a=True, check_finite=False) if len(on) else None

    def solve(self, load: Array, totals: Array, actuator: float | None = None) -> Forces:
        """Forces for the displacements ``load`` (2, n), along y and x, that sum to ``totals`` (2,). The second of these
        may be that of the shift and the ``actuator`` times the sum of q (:class:`coupled_step.LoadStep`)."""
        by, cut, end = self._by, 2 * self._begin, 2 * len(self._order)
        given = np.column_stack([by.loaded(load)[:end], by.by_rigid[:end]])
        last = by.L[cut:end, cut:end] @ given[cut:]
        forces = np.zeros((len(last), 3))
        if self._factors:
            found = la.lu_solve(self._factors, last[self._rows], check_finite=False)
            pressed = found[: len(self._along_y)]
            forces[self._along_y], forces[self._all_x] = pressed, self._drag[:, None] * pressed
            forces[self._along_x] = found[len(self._along_y) :]
        first = given[:cut] - by.L[cut:end, :cut].T @ forces
        sums = by.by_rigid[:cut].T @ first + np.stack([forces[::2].sum(axis=0), forces[1::2].sum(axis=0)])
        if actuator is not None:
            sums[1] = actuator * sums[1] + [0.0, 0.0, 1.0]
        rigid = np.linalg.solve(sums[:, 1:], totals - sums[:, 0])
        weights = np.append(1.0, rigid)
        every = np.zeros(len(by.L))
        every[:cut] = first @ weights
        every = by.transposed(every)
        every[cut:end] = forces @ weights
        p, q = np.zeros(self._n), np.zeros(self._n)
        p[self._order], q[self._order] = every[:end:2], every[1:end:2]
        return Forces(p, q, rigid)


def _middle(touch: Mask, first: int, last: int) -> int:
    """The node in the middle of those that ``touch`` (n,), if those that stick, from the ``first`` up to the ``last``,
    reach about as far on both sides of it; otherwise the one in the middle of these."""
    ends = np.flatnonzero(touch)[[0, -1]]
    middle = int(ends.sum()) // 2
    return middle if min(middle - first, last - 1 - middle) > _EVEN * (last - first) else (first + last - 1) // 2


def _by_its_transpose(L: Array) -> Array:
    """L L^T of a lower triangular matrix."""
    upper = np.asfortranarray(L[::-1, ::-1])  # LAPACK has U U^T of an upper one
    product, _ = la.lapack.dlauum(upper, lower=False, overwrite_c=True)
    whole: Array = product + product.T
    np.fill_diagonal(whole, product.diagonal())
    return whole[::-1, ::-1]


def _leading(mask: Mask) -> int:
    """Number of leading true values."""
    return len(mask) if mask.all() else int(np.argmin(mask))


def longest(mask: Mask) -> tuple[int, int]:
    """The longest run of true values, from the first index up to the other."""
    ends = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]))).reshape(-1, 2)
    if not len(ends):
        return 0, 0
    first, last = ends[np.argmax(ends[:, 1] - ends[:, 0])]
    return int(first), int(last)
