"""Factors of sparse symmetric positive definite matrices that keep chosen unknowns last.

Two back ends behind one interface: SuperLU, which SciPy brings, and CHOLMOD (supernodal Cholesky, through cvxopt),
several times faster, where it is installed: ``pip install partialslip[fast]``.
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
_options = threading.Lock()  # those of CHOLMOD are one dictionary for all threads
_SYMMETRIC = {"diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}


class Factor(Protocol):
    """A factor of a symmetric positive definite matrix that kept n chosen unknowns last; ``made`` so many times."""

    made: int

    def take_inverse_of_schur(self) -> Array:
        """(n, n): the inverse of the Schur complement onto the last unknowns."""

    def back_substitute(self, load: Array) -> Array:
        """Solution under ``load``, (N, k), the last unknowns being the last rows of both."""


def default_backend() -> Backend:
    """The fastest that is installed."""
    return "cholmod" if importlib.util.find_spec("cvxopt") else "superlu"


def factor(K: sp.csr_matrix, inner: Indices, last: Indices, backend: Backend) -> Factor:
    """Factor the rows and columns ``inner`` and ``last`` of ``K`` once, the former in an order that reduces fill.

    Raises
    ------
    MissingLibraryError
        If CHOLMOD is asked for and is not installed.
    """
    return _Cholmod(K, inner, last) if backend == "cholmod" else _SuperLU(K, inner, last)


class _SuperLU:
    def __init__(self, K: sp.csr_matrix, inner: Indices, last: Indices) -> None:
        # SuperLU hands its minimum-degree order out with a factor only, so let it drop every entry
        block = K[inner][:, inner].tocsc()
        ordered = spla.spilu(block, drop_tol=np.inf, fill_factor=1, permc_spec="MMD_AT_PLUS_A", **_SYMMETRIC)
        self._n, self._order = len(last), np.argsort(ordered.perm_c)
        unknowns = np.concatenate([inner[self._order], last])
        self._factor = spla.splu(K[unknowns][:, unknowns].tocsc(), permc_spec="NATURAL", **_SYMMETRIC)
        self.made = 1

    def take_inverse_of_schur(self) -> Array:
        n, first = self._n, len(self._order)
        place = self._factor.perm_c[-n:]  # where the factor put the last: last, but perhaps in another order
        if place.min() < first or not np.array_equal(self._factor.perm_r, self._factor.perm_c):
            raise AssertionError("the factor has not kept the last unknowns last and its pivots on the diagonal")
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
        self._order = np.asarray(self._cvxopt.amd.order(self._lower(K[inner][:, inner]))).ravel()
        unknowns = np.concatenate([inner[self._order], last])
        # CHOLMOD goes through the elimination tree from its leaves to its root. An entry, zero, between the last of the
        # inner unknowns and the first of the last ones makes all the rest of the tree hang below these.
        self._matrix = self._lower(K[unknowns][:, unknowns], (len(inner), len(inner) - 1))
        self._factored = self._numeric()

    def take_inverse_of_schur(self) -> Array:
        n, first = self._n, len(self._order)
        place = self._cvxopt.matrix(np.arange(first + n, dtype=float))
        self._cvxopt.cholmod.solve(self._factored, place, sys=7)  # puts it into the factor's order
        if not np.array_equal(np.asarray(place).ravel()[first:], np.arange(first, first + n)):
            raise AssertionError("the factor has not kept the last unknowns last")
        starts, rows, values = (np.asarray(part).ravel() for part in self._cvxopt.cholmod.getfactor(self._factored).CCS)
        self._factored = None  # it has been taken apart
        lower = np.zeros((n, n), order="F")
        kept = slice(starts[first], None)
        lower[rows[kept] - first, np.repeat(np.arange(n), np.diff(starts[first:]))] = values[kept]
        return _inverse(lower)

    def back_substitute(self, load: Array) -> Array:
        self._factored = self._factored or self._numeric()
        solution = self._cvxopt.matrix(_forth(self._order, load))
        self._cvxopt.cholmod.solve(self._factored, solution)
        return _back(self._order, np.asarray(solution))

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
        """The lower triangle, with ``zeros`` as entries."""
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
    """Inverse of L L^T, with ``lower`` = L, which it is put in the place of."""
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
