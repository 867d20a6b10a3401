"""Static condensation to the contact line: one factorisation, and the rest is dense and small."""

import numpy as np

from partialslip.result import Array
from partialslip_fem.elasticity import Body
from partialslip_fem.factor import Backend, factor
from partialslip_fem.farfield import FarField


class Condensed:
    """A body reduced to the degrees of freedom of its contact line.

    The stiffness is factored once with the contact last, so that its Schur complement is read off the factor's
    last rows. ``compliance`` (2n, 2n) is its inverse: displacements of the contact line, first all along x,
    then all along y, under unit nodal forces there. ``far_field`` moves what is held of the outer boundary; without it
    that is clamped. ``pulled`` (2 N,), of a body that bears a tension, are all displacements under a unit of that.
    """

    def __init__(self, body: Body, far_field: FarField | None = None, backend: Backend = "superlu") -> None:
        contact, held = body.contact.ravel(), body.held
        inner = np.ones(body.stiffness.shape[0], dtype=bool)
        inner[contact] = inner[held] = False
        self._free, self._held, self._n = np.concatenate([np.flatnonzero(inner), contact]), held, len(contact)
        self._to_held = body.stiffness[self._free][:, held]
        self._far = far_field
        self._factor = factor(body.stiffness, np.flatnonzero(inner), contact, backend)
        # first, as reading the Schur complement may use the factor up
        self.pulled = None
        if body.pull is not None:
            self.pulled = np.zeros(len(body.pull))
            self.pulled[self._free] = self._factor.solve(body.pull[self._free, None])[:, 0]
        if not far_field:
            self.compliance = self._factor.inverse_of_schur()
            return
        moved = self._solve(np.zeros((self._n, far_field.fields.shape[1])), far_field.fields)[-self._n :]
        self.compliance = self._factor.inverse_of_schur() + moved @ far_field.moments

    def displace(self, forces: Array) -> Array:
        """Displacements of all degrees of freedom, (N, k), under contact forces (2n, k)."""
        far = self._far
        held = far.fields @ (far.moments @ forces) if far else np.zeros((len(self._held), forces.shape[1]))
        result = np.empty((len(self._free) + len(self._held), forces.shape[1]))
        result[self._free], result[self._held] = self._solve(forces, held), held
        return result

    def _solve(self, forces: Array, held: Array) -> Array:
        load = -(self._to_held @ held)
        load[-self._n :] += forces
        return self._factor.solve(load)
