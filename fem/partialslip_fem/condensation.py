"""Static condensation to the contact line: one factorisation, and the rest is dense and small."""

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
import scipy.sparse.linalg as spla

from partialslip.result import Array
from partialslip_fem.elasticity import Body, Indices

_SYMMETRIC = {"diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}


class Condensed:
    """A body reduced to the degrees of freedom of its contact line, outer boundary held.

    The stiffness is factored once with the contact last, so that its Schur complement is read off the factor's
    last rows. ``compliance`` (2n, 2n) is its inverse: displacements of the contact line, first all along x,
    then all along y, under unit nodal forces there.
    """

    def __init__(self, body: Body) -> None:
        contact, held = body.contact.ravel(), body.far.ravel()
        inner = np.ones(body.stiffness.shape[0], dtype=bool)
        inner[contact] = inner[held] = False
        order = _fill_reducing(body.stiffness, np.flatnonzero(inner))
        self._free, self._held, self._n = np.concatenate([order, contact]), held, len(contact)
        rows = body.stiffness[self._free]
        self._to_held = rows[:, held]
        self._factor = spla.splu(rows[:, self._free].tocsc(), permc_spec="NATURAL", **_SYMMETRIC)
        self.compliance = self._invert_schur()

    def _invert_schur(self) -> Array:
        n = self._n
        place = self._factor.perm_c[-n:]  # where the factor put the contact: last, but perhaps in another order
        if place.min() < len(self._free) - n or not np.array_equal(self._factor.perm_r, self._factor.perm_c):
            raise AssertionError("the factor has not kept the contact last and its pivots on the diagonal")
        upper = self._factor.U[-n:, -n:].toarray()
        pivots = np.sqrt(np.diag(upper))
        inverse, _ = la.lapack.dpotri(upper / pivots[:, None])  # S = L D L^T, and U = D L^T
        inverse += np.triu(inverse, 1).T
        local = place - (len(self._free) - n)
        result: Array = inverse[np.ix_(local, local)]
        return result

    def respond(self, held: Array) -> Array:
        """Displacements of the contact line, (2n, k), under ``k`` displacement fields of the outer boundary."""
        return self._solve(np.zeros((self._n, held.shape[1])), held)[-self._n :]

    def displace(self, forces: Array, held: Array) -> Array:
        """Displacements of all degrees of freedom, (N, k), under contact forces (2n, k) and boundary (h, k)."""
        result = np.empty((len(self._free) + len(self._held), forces.shape[1]))
        result[self._free], result[self._held] = self._solve(forces, held), held
        return result

    def _solve(self, forces: Array, held: Array) -> Array:
        load = -(self._to_held @ held)
        load[-self._n :] += forces
        solution: Array = self._factor.solve(load)
        return solution


def _fill_reducing(stiffness: sp.csr_matrix, dofs: Indices) -> Indices:
    """Minimum-degree order of ``dofs``. SuperLU hands it out with a factor only, so let it drop every entry."""
    block = stiffness[dofs][:, dofs].tocsc()
    ordered = spla.spilu(block, drop_tol=np.inf, fill_factor=1, permc_spec="MMD_AT_PLUS_A", **_SYMMETRIC)
    result: Indices = dofs[np.argsort(ordered.perm_c)]
    return result
