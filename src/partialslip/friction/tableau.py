"""Principal pivots of a symmetric compliance: what the nodes answer to a unit force or slip at one node."""

import numpy as np
import scipy.linalg as la

from partialslip.tools.arrays import Array, Indices, Mask

_TOGETHER = 48  # cost: pivots whose updates of V are added at once: as many as columns cost what an update costs


class Tableau:
    """Linear answers of n nodes, of which some stick, to given rates.

    With the bordered matrix A = [[C, 1], [1, 0]], rates obey A (T', -shift') = (g' + r', Q'). Known are r' = 0 at
    sticking nodes, T' = 0 at slipping nodes, and Q'. The rows of A that belong to the sticking nodes and to the sum are
    swept: the symmetric matrix V holds -A_ss^-1, A_ss^-1 A_sh and the Schur complement of A_ss. The unknown rates
    p = (-T' where nodes stick, r' where they slip, shift') follow from V by a product. A node that changes between
    sticking and slipping is a pivot: an update of rank one (Cottle, Pang and Stone, 1992, section 2.3). Updates are
    kept apart, and added to V many at once.

    Parameters
    ----------
    inverse : (n, n) array
        Inverse of the symmetric positive definite compliance C.
    """

    def __init__(self, inverse: Array) -> None:
        count = len(inverse)
        uniform = inverse.sum(axis=1)
        total = float(uniform.sum())
        self._fresh = np.empty((count + 1, count + 1), order="F")
        self._fresh[:count, :count] = np.multiply.outer(uniform / total, uniform) - inverse
        self._fresh[count, :count] = self._fresh[:count, count] = -uniform / total
        self._fresh[count, count] = 1 / total
        self._V = self._fresh.copy(order="F")
        self._added, self._signs = np.empty((count + 1, _TOGETHER), order="F"), np.empty(_TOGETHER)
        self._count = 0  # of the updates that are not yet in V
        self.sticks: Mask = np.ones(count, dtype=bool)
        self.pivots = 0

    def restart(self, slipping: Indices) -> None:
        """Let the nodes ``slipping`` slip and all others stick, free of the rounding errors of earlier pivots."""
        self._V = self._fresh.copy(order="F")
        self.sticks = np.ones(len(self.sticks), dtype=bool)
        self.pivots = self._count = 0
        if len(slipping):
            V, rows = self._V, self._fresh[slipping]
            solved = np.linalg.solve(rows[:, slipping], rows)
            V -= rows.T @ solved
            V[slipping] = -solved
            V[:, slipping] = -solved.T
            V[np.ix_(slipping, slipping)] = -np.linalg.inv(rows[:, slipping])
            self.sticks[slipping] = False

    def column(self, node: int) -> Array:
        """Change of p (n + 1,) by a unit slip rate r' of the ``node`` if it sticks, or a unit T' if it slips."""
        result: Array = np.concatenate([self._V[node, :node], self._V[node:, node]])
        if self._count:
            added = self._added[:, : self._count]
            result += added @ (self._signs[: self._count] * added[node])
        return result

    def columns(self, nodes: Indices) -> Array:
        """:meth:`column` of each of the ``nodes`` (k,), (n + 1, k)."""
        self._add()
        rows = np.arange(len(self._V))[:, None]
        return self._V[np.maximum(rows, nodes), np.minimum(rows, nodes)]

    def pivot(self, node: int, column: Array) -> None:
        """Let the ``node`` slip if it sticks, and stick if it slips; ``column`` is :meth:`column` of it."""
        if self._count == _TOGETHER:
            self._add()
        at = column[node]
        # the node's own row and column begin anew: 1/at of the column, with the sign of the change, and -1/at
        self._V[node, :node] = self._V[node:, node] = self._added[node, : self._count] = 0.0
        update = self._added[:, self._count]
        np.multiply(column, 1 / np.sqrt(abs(at)), out=update)
        update[node] = (1 if self.sticks[node] else -1) / np.sqrt(abs(at))
        self._signs[self._count] = -np.sign(at)
        self._count += 1
        self.sticks[node] = not self.sticks[node]
        self.pivots += 1

    def solve(self, g: Array, Q: float, along: Array | float = 0.0) -> Array:
        """Unknown rates p (n + 1,) under ``g`` (n,), the rate of the free displacements, and ``Q``, that of the sum.

        With ``along`` (n,), which is T' at the slipping nodes, p holds along - T' where nodes stick.
        """
        known = np.append(np.where(self.sticks, g, along), Q)
        p: Array = la.blas.dsymv(1.0, self._V, known, lower=1)
        if self._count:
            added = self._added[:, : self._count]
            p += added @ (self._signs[: self._count] * (known @ added))
        p[:-1] += np.where(self.sticks, along, -g)
        return p

    def exchange(self, node: int, *unknown: Array) -> None:
        """:meth:`pivot` at the ``node``; ``unknown`` rates p (n + 1,) each become those after it."""
        column, sticks = self.column(node), self.sticks[node]
        for p in unknown:
            rate = -p[node] / column[node]
            p += rate * column
            p[node] = rate if sticks else -rate
        self.pivot(node, column)

    def _add(self) -> None:
        """Add all updates to V."""
        for sign in (-1.0, 1.0):
            some = self._added[:, np.flatnonzero(self._signs[: self._count] == sign)]
            if some.size:
                self._V = la.blas.dsyrk(sign, some, beta=1.0, c=self._V, lower=1, overwrite_c=1)
        self._count = 0
