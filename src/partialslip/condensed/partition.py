"""Linear systems of all partitions of nodes into open, slipping and sticking ones, from one inverse.

Forces z = (p, q) under the displacements g that the contact has to undo, and reactions r at nodes that do not:
C z = g + r, with r along y at open nodes and along x at open and slipping nodes. As many conditions determine r: open
nodes have no forces, and q = f p, or -f p, at slipping nodes. With the inverse of C the system is of their number only,
where the forces themselves are of the number of touching and of sticking nodes.
"""

from typing import NamedTuple

import numpy as np
import scipy.linalg as la

from partialslip.arrays import Array, Mask, submatrix
from partialslip.condensed.bounded import Sides, inverse


class Forces(NamedTuple):
    """Forces ``p`` and ``q`` (n,) of a partition, and the rigid motion of the bodies, (2,): approach and shift."""

    p: Array
    q: Array
    rigid: Array


class Inverse:
    """Inverse of the compliances ``yy``, ``xx``, ``xy`` and ``yx`` (n, n) of
    :class:`partialslip.condensed.coupled.Relative`, ``symmetric`` or not."""

    def __init__(self, xx: Array, yy: Array, xy: Array, yx: Array, symmetric: bool) -> None:
        whole, n = np.block([[yy, yx], [xy, xx]]), len(yy)
        self.matrix = inverse(whole) if symmetric else la.inv(whole, check_finite=False)
        self.under_rigid = np.stack([self.matrix[:, :n].sum(axis=1), self.matrix[:, n:].sum(axis=1)], axis=1)
        self.sums = np.stack([self.matrix[:n].sum(axis=0), self.matrix[n:].sum(axis=0)])


class Partition:
    """The linear system of one partition.

    Parameters
    ----------
    by : Inverse
    touch : (n,) bool array
        Nodes that touch.
    slip : (n,) int8 array
        Sign of q at nodes that slip; 0 at others.
    f : float
        Coefficient of friction.
    """

    def __init__(self, by: Inverse, touch: Mask, slip: Sides, f: float) -> None:
        n = len(touch)
        self._by, self._open, self._slipping = by, np.flatnonzero(~touch), np.flatnonzero(touch & (slip != 0))
        self._drag = f * slip[self._slipping]
        self._held = np.concatenate([self._open, n + self._open, n + self._slipping])
        matrix = submatrix(by.matrix, self._held, self._held)
        matrix[2 * len(self._open) :] -= self._drag[:, None] * submatrix(by.matrix, self._slipping, self._held)
        self._factors = la.lu_factor(matrix, overwrite_a=True, check_finite=False) if len(self._held) else None
        self._by_rigid = self._reactions(by.under_rigid)
        of_rigid = np.stack([by.under_rigid[:n].sum(axis=0), by.under_rigid[n:].sum(axis=0)])
        self._totals = of_rigid + by.sums[:, self._held] @ self._by_rigid

    def solve(self, load: Array, totals: Array) -> Forces:
        """Forces for the displacements ``load`` (2, n), along y and x, that sum to ``totals`` (2,)."""
        n = load.shape[1]
        free = self._by.matrix @ load.ravel()
        first = self._reactions(free)
        missing = totals - free.reshape(2, n).sum(axis=1) - self._by.sums[:, self._held] @ first
        rigid = np.linalg.solve(self._totals, missing)
        reactions = np.zeros(2 * n)
        reactions[self._held] = first + self._by_rigid @ rigid
        p, q = (free + self._by.under_rigid @ rigid + self._by.matrix @ reactions).reshape(2, n)
        p[self._open] = q[self._open] = 0.0
        q[self._slipping] = self._drag * p[self._slipping]
        return Forces(p, q, rigid)

    def _reactions(self, forces: Array) -> Array:
        """Reactions (m,) or (m, k) that make the ``forces`` (2 n,) or (2 n, k) meet the conditions of the partition."""
        if not self._factors:
            return forces[:0]
        at, slipping, n = self._open, self._slipping, len(forces) // 2
        drag = self._drag.reshape(-1, *(1,) * (forces.ndim - 1))
        off = np.concatenate([forces[at], forces[n + at], forces[n + slipping] - drag * forces[slipping]])
        result: Array = -la.lu_solve(self._factors, off, check_finite=False)
        return result
