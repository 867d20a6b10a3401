"""Static condensation to the contact line: one factorisation, and the rest is dense and small."""

import numpy as np

from partialslip.arrays import Array
from partialslip_fem.elasticity import Body
from partialslip_fem.factor import Backend, Factor, factor
from partialslip_fem.farfield import FarField


class Condensed:
    """A body reduced to the degrees of freedom of its contact line.

    The stiffness is factored once with the contact last, so that its Schur complement is read off the factor's
    last rows. ``compliance`` (2n, 2n) is its inverse: displacements of the contact line, first all along x,
    then all along y, under unit nodal forces there. Without ``shear`` there are none along x: it is (n, n), all along
    y. ``far_field`` moves what is held of the outer boundary; without it that is clamped. ``pulled`` (2 N,), of a body
    that bears a tension, are all displacements under a unit of that. Unless what is ``inside`` is to be solved back
    for, the factor is not kept.
    """

    def __init__(
        self,
        body: Body,
        far_field: FarField | None = None,
        backend: Backend = "superlu",
        shear: bool = True,
        inside: bool = True,
    ) -> None:
        contact, held = body.contact[0 if shear else 1 :].ravel(), body.held
        inner = np.ones(body.stiffness.shape[0], dtype=bool)
        inner[contact] = inner[held] = False
        self._free, self._held, self._n = np.concatenate([np.flatnonzero(inner), contact]), held, len(contact)
        self._to_held = body.stiffness[self._free][:, held]
        self._far = far_field.along_y if far_field and not shear else far_field
        self._factor: Factor | None = factor(body.stiffness, np.flatnonzero(inner), contact, backend)
        # first, as reading the Schur complement may use the factor up
        self.pulled: Array | None = None
        if body.pull is not None:
            self.pulled = np.zeros(len(body.pull))
            self.pulled[self._free] = self._factor.solve(body.pull[self._free, None])[:, 0]
        moved: Array | float = 0.0
        if self._far:
            fields = self._solve(np.zeros((self._n, self.far_columns)), self._far.fields)[-self._n :]
            moved = fields @ self._far.moments
        self.compliance = self._factor.inverse_of_schur() + moved
        if not inside:
            self._factor = None

    @property
    def columns(self) -> int:
        """Degrees of freedom of the contact line that are kept."""
        return self._n

    @property
    def far_columns(self) -> int:
        """Fields that move the outer boundary."""
        return self._far.fields.shape[1] if self._far else 0

    @property
    def factorizations(self) -> int:
        """How often the stiffness has been factored: once more where a factor that was taken apart is asked again."""
        return self._factor.made if self._factor else 1

    def displace(self, forces: Array) -> Array:
        """Displacements of all degrees of freedom, (N, k), under contact forces (2n, k); without shear (n, k)."""
        far = self._far
        held = far.fields @ (far.moments @ forces) if far else np.zeros((len(self._held), forces.shape[1]))
        result = np.empty((len(self._free) + len(self._held), forces.shape[1]))
        result[self._free], result[self._held] = self._solve(forces, held), held
        return result

    def _solve(self, forces: Array, held: Array) -> Array:
        load = -(self._to_held @ held)
        load[-self._n :] += forces
        assert self._factor
        return self._factor.solve(load)
