"""Static condensation to the contact line: one factorisation of the stiffness, then a small dense compliance."""

import numpy as np

from partialslip.tools.arrays import Array
from partialslip_fem.elasticity import DiscreteBody
from partialslip_fem.factor import Backend, Factor, Held, factor
from partialslip_fem.farfield import FarField


class Condensation:
    """Compliance of a body's contact line.

    The stiffness is factored once with the contact line last, so that the Schur complement is read off the last rows
    of the factor.

    Parameters
    ----------
    body : Body
    far_field : FarField, optional
        Displacements of the held nodes under the contact forces; without it the held nodes are fixed.
    backend : "superlu" or "cholmod"
        Library that factors.
    shear : bool
        Whether the contact line has degrees of freedom along x.
    inside : bool
        Whether to keep the factor, which :meth:`displace` needs.

    Attributes
    ----------
    compliance : (2 n, 2 n) array, or (n, n) without ``shear``
        Displacements of the contact line, first along x, then along y, under unit nodal forces.
    pulled : (2 N,) array or None
        Displacements of the nodes on sides of elements, of a body that is pulled on its right side, under a unit
        tension there.
    """

    def __init__(
        self,
        body: DiscreteBody,
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
        fields = Held(held, self._far.fields) if self._far else None
        self._factor: Factor | None = factor(body.stiffness, np.flatnonzero(inner), contact, backend, fields)
        # before take_inverse_of_schur, which may use the factor up
        self.pulled: Array | None = None
        if body.pull is not None:
            pulled, load = body.pulling()
            pulled[self._free] = self._factor.back_substitute(load[self._free, None])[:, 0]
            self.pulled = body.under_unit_tension(pulled)
        self.compliance, moved = self._factor.take_inverse_of_schur()
        if self._far:
            self.compliance += moved @ self._far.moments
        if not inside:
            self._factor = None

    @property
    def columns(self) -> int:
        """Number of degrees of freedom of the contact line."""
        return self._n

    @property
    def far_columns(self) -> int:
        """Number of displacement fields of the far field."""
        return self._far.fields.shape[1] if self._far else 0

    @property
    def factorizations(self) -> int:
        """Number of factorisations: 2 if :meth:`displace` had to restore a factor that was used up."""
        return self._factor.made if self._factor else 1

    def displace(self, forces: Array) -> Array:
        """Displacements of the nodes on sides of elements, (2 N, k), under contact forces (2 n, k), or (n, k) without
        shear."""
        far = self._far
        held = far.fields @ (far.moments @ forces) if far else np.zeros((len(self._held), forces.shape[1]))
        result = np.empty((len(self._free) + len(self._held), forces.shape[1]))
        result[self._free], result[self._held] = self._displace_free(forces, held), held
        return result

    def _displace_free(self, forces: Array, held: Array) -> Array:
        """Displacements of the free degrees of freedom, contact line last, for given contact forces and ``held``
        displacements."""
        load = -(self._to_held @ held)
        load[-self._n :] += forces
        assert self._factor
        return self._factor.back_substitute(load)
