"""Factors of sparse symmetric positive definite matrices that keep chosen unknowns last.

Two libraries with one interface: SuperLU, part of SciPy, and CHOLMOD (supernodal Cholesky, through cvxopt), several
times faster: ``pip install partialslip[fast]``.
"""

import importlib.util
import threading
from types import ModuleType
from typing import Literal, Protocol

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
import scipy.sparse.linalg as spla

from partialslip.arrays import Array, Indices
from partialslip.errors import MissingLibraryError

Backend = Literal["superlu", "cholmod"]
_options = threading.Lock()  # CHOLMOD's options are one dictionary for all threads
_SYMMETRIC = {"diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}


class Factor(Protocol):
    """Factor of a symmetric positive definite matrix with n chosen unknowns last; ``made`` counts factorisations."""

    made: int

    def take_inverse_of_schur(self) -> Array:
        """Return the inverse of the Schur complement onto the last unknowns, (n, n).

        This may use the factor up: a later :meth:`back_substitute` then factors the matrix again.
        """

    def back_substitute(self, load: Array) -> Array:
        """Solution for the right-hand sides ``load``, (N, k); the last unknowns are the last rows of both."""


def default_backend() -> Backend:
    """The fastest installed library."""
    return "cholmod" if importlib.util.find_spec("cvxopt") else "superlu"


def factor(K: sp.csr_matrix, inner: Indices, last: Indices, backend: Backend) -> Factor:
    """Factor the rows and columns ``inner`` and ``last`` of the stiffness ``K``, ``inner`` in an order that reduces
    fill. Unknowns of K are the displacements of all nodes along x, then those along y.

    Raises
    ------
    MissingLibraryError
        If ``backend`` is "cholmod" and cvxopt is not installed.
    """
    return _Cholmod(K, inner, last) if backend == "cholmod" else _SuperLU(K, inner, last)


class _SuperLU:
    def __init__(self, K: sp.csr_matrix, inner: Indices, last: Indices) -> None:
        # SuperLU returns its minimum-degree order with a factor only: an incomplete one without entries is cheapest
        block = K[inner][:, inner].tocsc()
        ordered = spla.spilu(block, drop_tol=np.inf, fill_factor=1, permc_spec="MMD_AT_PLUS_A", **_SYMMETRIC)
        self._n, self._order = len(last), np.argsort(ordered.perm_c)
        unknowns = np.concatenate([inner[self._order], last])
        self._factor = spla.splu(K[unknowns][:, unknowns].tocsc(), permc_spec="NATURAL", **_SYMMETRIC)
        self.made = 1

    def take_inverse_of_schur(self) -> Array:
        n, first = self._n, len(self._order)
        place = self._factor.perm_c[-n:]  # the last unknowns are last in the factor, but perhaps in another order
        if place.min() < first or not np.array_equal(self._factor.perm_r, self._factor.perm_c):
            raise AssertionError("the factor must keep the last unknowns last and its pivots on the diagonal")
        upper = self._factor.U[-n:, -n:].toarray()
        pivots = np.sqrt(np.diag(upper))
        inverse = _inverse((upper / pivots[:, None]).T)  # S = L D L^T, and U = D L^T
        return inverse[np.ix_(place - first, place - first)]

    def back_substitute(self, load: Array) -> Array:
        return _back(self._order, self._factor.solve(_forth(self._order, load)))


class _Cholmod:
    def __init__(self, K: sp.csr_matrix, inner: Indices, last: Indices) -> None:
        self._cvxopt = _import_cvxopt()
        self._n, self.made = len(last), 0
        self._order = self._minimum_degree(K, inner)
        unknowns = np.concatenate([inner[self._order], last])
        # CHOLMOD orders the elimination tree from its leaves to its root. An explicit zero between the last inner
        # unknown and the first of the last unknowns puts the rest of the tree below these.
        self._matrix = self._lower(K[unknowns][:, unknowns], (len(inner), len(inner) - 1))
        self._factored = self._numeric()

    def take_inverse_of_schur(self) -> Array:
        n, first = self._n, len(self._order)
        place = self._cvxopt.matrix(np.arange(first + n, dtype=float))
        self._cvxopt.cholmod.solve(self._factored, place, sys=7)  # permutes into the factor's order
        if not np.array_equal(np.asarray(place).ravel()[first:], np.arange(first, first + n)):
            raise AssertionError("the factor must keep the last unknowns last")
        starts, rows, values = (np.asarray(part).ravel() for part in self._cvxopt.cholmod.getfactor(self._factored).CCS)
        self._factored = None  # getfactor has converted it; back_substitute factors again
        lower = np.zeros((n, n), order="F")
        kept = slice(starts[first], None)
        lower[rows[kept] - first, np.repeat(np.arange(n), np.diff(starts[first:]))] = values[kept]
        return _inverse(lower)

    def back_substitute(self, load: Array) -> Array:
        self._factored = self._factored or self._numeric()
        solution = self._cvxopt.matrix(_forth(self._order, load))
        self._cvxopt.cholmod.solve(self._factored, solution)
        return _back(self._order, np.asarray(solution))

    def _minimum_degree(self, K: sp.csr_matrix, inner: Indices) -> Indices:
        """Order of the unknowns ``inner`` by nodes: both displacements of a node have the same neighbours."""
        count = K.shape[0] // 2
        nodes = np.unique(inner % count)
        rank = np.empty(count, dtype=np.int64)
        by_degree = np.asarray(self._cvxopt.amd.order(self._lower(K[:count, :count][nodes][:, nodes]))).ravel()
        rank[nodes[by_degree]] = np.arange(len(nodes))
        order: Indices = np.argsort(rank[inner % count], kind="stable")
        return order

    def _numeric(self) -> object:
        cholmod, as_it_is = self._cvxopt.cholmod, self._cvxopt.matrix(np.arange(len(self._order) + self._n))
        with _options:
            cholmod.options["nmethods"] = 1  # no other order than the given one
            try:
                factored = cholmod.symbolic(self._matrix, p=as_it_is)
                cholmod.numeric(self._matrix, factored)
                self.made += 1
            finally:
                del cholmod.options["nmethods"]
        return factored

    def _lower(self, K: sp.csr_matrix, *zeros: tuple[int, int]) -> object:
        """Lower triangle of ``K`` with explicit ``zeros`` at the given rows and columns."""
        lower = sp.tril(K, format="coo")
        rows, columns = (
            self._cvxopt.matrix(np.append(index.astype(np.int64), [zero[axis] for zero in zeros]).astype(np.int64))
            for axis, index in enumerate((lower.row, lower.col))
        )
        values = self._cvxopt.matrix(np.append(lower.data, np.zeros(len(zeros))))
        return self._cvxopt.spmatrix(values, rows, columns, K.shape)


def _forth(order: Indices, load: Array) -> Array:
    return np.concatenate([load[order], load[len(order) :]])


def _back(order: Indices, solution: Array) -> Array:
    result = solution.copy()
    result[order] = solution[: len(order)]
    return result


def _inverse(lower: Array) -> Array:
    """Inverse of L L^T for ``lower`` = L, which is overwritten."""
    half, _ = la.lapack.dpotri(lower, lower=True, overwrite_c=True)  # zero above the diagonal, as L is
    inverse: Array = half + half.T
    inverse[np.diag_indices_from(inverse)] /= 2
    return inverse


def _import_cvxopt() -> ModuleType:
    try:
        import cvxopt
        import cvxopt.amd
        import cvxopt.cholmod
    except ImportError:
        raise MissingLibraryError("fem.factor = 'cholmod': cvxopt is missing; pip install partialslip[fast]") from None
    return cvxopt  # type: ignore[no-any-return]
