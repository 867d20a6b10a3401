"""Factors of sparse symmetric positive definite matrices that keep chosen unknowns last.

Two libraries with one interface: SuperLU, part of SciPy, and CHOLMOD (supernodal Cholesky, through cvxopt), several
times faster: ``pip install partialslip[fast]``.
"""

import importlib.util
import threading
from collections.abc import Callable
from types import ModuleType
from typing import Literal, NamedTuple, Protocol

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
import scipy.sparse.linalg as spla

from partialslip.tools.arrays import Array, Indices
from partialslip.tools.errors import MissingLibraryError

Backend = Literal["superlu", "cholmod"]
_options = threading.Lock()  # CHOLMOD's options are one dictionary for all threads
_SYMMETRIC = {"diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}


class Factor(Protocol):
    """Factor of a symmetric positive definite matrix with n chosen unknowns last; ``made`` counts factorisations."""

    made: int

    def take_inverse_of_schur(self) -> tuple[Array, Array]:
        """Return S^-1 (n, n), with S the Schur complement onto the last n unknowns, and the values of these n unknowns
        under each field of the held unknowns, (n, k).

        The factor may be used up: a later :meth:`back_substitute` then factors the matrix again.
        """

    def back_substitute(self, load: Array) -> Array:
        """Solution for the right-hand sides ``load``, (N, k), while held unknowns are zero; the last unknowns are the
        last rows of both."""


def default_backend() -> Backend:
    """The fastest installed library."""
    return "cholmod" if importlib.util.find_spec("cvxopt") else "superlu"


class Held(NamedTuple):
    """Indices ``unknowns`` (h,) that are held, and their values in k ``fields`` (h, k)."""

    unknowns: Indices
    fields: Array


def factor(K: sp.csr_matrix, inner: Indices, last: Indices, backend: Backend, held: Held | None = None) -> Factor:
    """Factor the rows and columns ``inner`` and ``last`` of the stiffness ``K``, ``inner`` in an order that reduces
    fill. Unknowns of K are the displacements of all nodes along x, then those along y.

    Raises
    ------
    MissingLibraryError
        If ``backend`` is "cholmod" and cvxopt is not installed.
    """
    return (_Cholmod if backend == "cholmod" else _SuperLU)(K, inner, last, held)


class _Matrices:
    """The matrix with its unknowns ``inner`` in a given ``order`` and ``last`` after them; bordered by held fields.

    The factors of the fields, unknowns after the last, are eliminated with the matrix, which costs far less than k
    right-hand sides.
    """

    def __init__(self, K: sp.csr_matrix, inner: Indices, order: Indices, last: Indices, held: Held | None) -> None:
        unknowns = np.concatenate([inner[order], last])
        self.order, self.n, self.k = order, len(last), held.fields.shape[1] if held else 0
        self.plain = self.bordered = K[unknowns][:, unknowns]
        if held:
            across = sp.csr_matrix(K[:, held.unknowns] @ held.fields)
            # the fields' own block matters to no result: it need only make the matrix positive definite
            own = np.abs(held.fields.T @ across[held.unknowns]).sum(axis=1)
            self.bordered = sp.bmat([[self.plain, across[unknowns]], [across[unknowns].T, sp.diags(2 * own)]])

    def taken(self, lower: Array) -> tuple[Array, Array]:
        """Result of :meth:`Factor.take_inverse_of_schur` from the last rows of the factor, ``lower``."""
        n = self.n
        under = -la.solve_triangular(lower[:n, :n], lower[n:, :n].T, lower=True, trans="T")
        return _inverse(np.asfortranarray(lower[:n, :n])), under

    def solved(self, solve: Callable[[Array], Array], load: Array) -> Array:
        """Solution by ``solve`` of the plain matrix for ``load``, both in the order of ``inner`` and ``last``."""
        inner = len(self.order)
        result = solve(np.concatenate([load[self.order], load[inner:]])).copy()
        result[self.order] = result[:inner]
        return result


class _SuperLU:
    def __init__(self, K: sp.csr_matrix, inner: Indices, last: Indices, held: Held | None) -> None:
        # SuperLU returns its minimum-degree order with a factor only: an incomplete one without entries is cheapest
        block = K[inner][:, inner].tocsc()
        ordered = spla.spilu(block, drop_tol=np.inf, fill_factor=1, permc_spec="MMD_AT_PLUS_A", **_SYMMETRIC)
        self._of = _Matrices(K, inner, np.argsort(ordered.perm_c), last, held)
        self._factor: spla.SuperLU | None = None
        self.made = 0

    def take_inverse_of_schur(self) -> tuple[Array, Array]:
        of, first = self._of, len(self._of.order)
        found = self._numeric(of.bordered) if of.k else self._plain()
        place = found.perm_c[first:]  # the last unknowns are last in the factor, but perhaps in another order
        kept = place.min() >= first and place[: of.n].max() < first + of.n
        if not kept or not np.array_equal(found.perm_r, found.perm_c):
            raise AssertionError("the factor must keep the last unknowns last and its pivots on the diagonal")
        upper = found.U[first:, first:].toarray()
        lower = (upper / np.sqrt(np.diag(upper))[:, None]).T  # S = L D L^T, and U = D L^T
        inverse, under = of.taken(lower)
        at = place[: of.n] - first
        return inverse[np.ix_(at, at)], under[at]

    def back_substitute(self, load: Array) -> Array:
        return self._of.solved(self._plain().solve, load)

    def _plain(self) -> spla.SuperLU:
        self._factor = self._factor or self._numeric(self._of.plain)
        return self._factor

    def _numeric(self, matrix: sp.spmatrix) -> spla.SuperLU:
        self.made += 1
        return spla.splu(matrix.tocsc(), permc_spec="NATURAL", **_SYMMETRIC)


class _Cholmod:
    def __init__(self, K: sp.csr_matrix, inner: Indices, last: Indices, held: Held | None) -> None:
        self._cvxopt = _import_cvxopt()
        self._of = _Matrices(K, inner, self._minimum_degree(K, inner), last, held)
        self._factor: object | None = None
        self.made = 0

    def take_inverse_of_schur(self) -> tuple[Array, Array]:
        of, first = self._of, len(self._of.order)
        count = of.n + of.k
        found = self._numeric(of.bordered) if of.k else self._plain()
        place = self._cvxopt.matrix(np.arange(first + count, dtype=float))
        self._cvxopt.cholmod.solve(found, place, sys=7)  # permutes into the factor's order
        if not np.array_equal(np.asarray(place).ravel()[first:], np.arange(first, first + count)):
            raise AssertionError("the factor must keep the last unknowns last")
        kept = self._cvxopt.cholmod.getfactor(found)[first:, first:]
        if not of.k:
            self._factor = None  # getfactor has converted it
        starts, rows, values = (np.asarray(part).ravel() for part in kept.CCS)
        lower = np.zeros((count, count), order="F")
        lower[rows, np.repeat(np.arange(count), np.diff(starts))] = values
        return of.taken(lower)

    def back_substitute(self, load: Array) -> Array:
        self._plain()
        return self._of.solved(self._solve, load)

    def _plain(self) -> object:
        self._factor = self._factor or self._numeric(self._of.plain)
        return self._factor

    def _solve(self, load: Array) -> Array:
        solution = self._cvxopt.matrix(load)
        self._cvxopt.cholmod.solve(self._factor, solution)
        return np.asarray(solution)

    def _minimum_degree(self, K: sp.csr_matrix, inner: Indices) -> Indices:
        """Order of the unknowns ``inner`` by nodes: both displacements of a node have the same neighbours."""
        count = K.shape[0] // 2
        nodes = np.unique(inner % count)
        rank = np.empty(count, dtype=np.int64)
        by_degree = np.asarray(self._cvxopt.amd.order(self._lower(K[:count, :count][nodes][:, nodes]))).ravel()
        rank[nodes[by_degree]] = np.arange(len(nodes))
        return np.argsort(rank[inner % count], kind="stable")

    def _numeric(self, matrix: sp.spmatrix) -> object:
        cholmod, as_it_is = self._cvxopt.cholmod, self._cvxopt.matrix(np.arange(matrix.shape[0]))
        # CHOLMOD orders the elimination tree from its leaves to its root. An explicit zero between the last inner
        # unknown and the first of the last unknowns puts the rest of the tree below these.
        inner = len(self._of.order)
        lower = self._lower(matrix, (inner, inner - 1))
        with _options:
            cholmod.options["nmethods"] = 1  # no other order than the given one
            try:
                factored = cholmod.symbolic(lower, p=as_it_is)
                cholmod.numeric(lower, factored)
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
    return cvxopt
