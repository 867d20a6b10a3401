"""Two condensed bodies and their relative displacements.

Scaled as in :mod:`partialslip_fem.problem`. Nodal contact forces are the Lagrange multipliers of the relative
displacements of the two surfaces.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from partialslip.friction.coupled_step import Relative
from partialslip.tools.arrays import Array
from partialslip_fem.condensation import Condensation
from partialslip_fem.elasticity import DiscreteBody
from partialslip_fem.mortar import transfer
from partialslip_meshes import Mesh


@dataclass(frozen=True)
class CondensedBody:
    """A body that is condensed to its contact line.

    The ``mesh`` lies below the contact line; the mesh of the upper body is mirrored. ``body`` has the stiffness,
    ``condensation`` the compliance of the contact line.
    """

    mesh: Mesh
    body: DiscreteBody
    condensation: Condensation

    @property
    def stretched(self) -> Array:
        """Displacements of the nodes on sides of elements, (2, N), under the tension that strains a long body by 1.

        The strain is uniform, except in a body that is pulled at its end.
        """
        result: Array = self.body.points * np.array([[1.0], [-(3 - self.body.kappa) / (1 + self.body.kappa)]])
        if self.condensation.pulled is not None:
            result = 4 / self.body.compliance * self.condensation.pulled.reshape(2, -1)
        return result

    @property
    def bent(self) -> Array:
        """Displacements of a half-plane, (2, N), under the tension that strains its surface by x: the
        stresses sigma_xx = s x and sigma_xy = -s y, without sigma_yy."""
        (x, y), kappa = self.body.points, self.body.kappa
        return np.array([x**2 / 2 - (5 + kappa) / (1 + kappa) * y**2 / 2, -(3 - kappa) / (1 + kappa) * x * y])

    def turned(self, height: float) -> Array:
        """Displacements (2, N) of a body that turns by 1 about a pin at the ``height``."""
        x, y = self.body.points
        return np.array([-(y + height), x])

    @property
    def stretch(self) -> Array:
        """Displacements of the contact line's nodes under the same tension, (2, n); zero along y if uniform."""
        if self.condensation.pulled is None:
            return np.array([self.body.x, 0 * self.body.x])
        return self.stretched[:, self.body.contact[0]]

    def at_right_grip(self, shear: Array, normal: Array) -> float:
        """Force along x on the plate that holds the right side of the lower body under contact forces ``shear`` and
        ``normal`` (n,), by reciprocity: a plate that moves by 1 moves the contact line as the tension does."""
        moved = self.stretched
        u, v = self.stretch
        return float((shear @ u + normal @ v) / moved[0, self.body.gripped[0]])


def relative_compliances(bodies: Sequence[CondensedBody], coupled: bool = True) -> Relative:
    """Relative displacements of the two surfaces under unit nodal forces, at the nodes of the lower contact line.

    Parameters
    ----------
    bodies : one or two of CondensedBody
        The lower and the upper body; one entry if the bodies are mirror images. The surfaces of mirror images move by
        equal amounts in opposite directions, so that the coupling of p and q cancels.
    coupled : bool
        Whether to compute the coupling ``xy``.

    Returns
    -------
    Relative
        ``xx`` is None if the bodies were condensed without shear.
    """
    lower = bodies[0]
    n = len(lower.body.x)
    C = lower.condensation.compliance
    # With every moment of the forces in the far field the compliance is symmetric, except for the discretisation of
    # the far boundary (1e-7 or less). A truncated expansion would not be, and must not be symmetrised.
    sheared = len(C) > n
    if len(bodies) == 1:
        xx, yy = C[:-n, :-n], C[-n:, -n:]
        return Relative(xx + xx.T if sheared else None, yy + yy.T, None)
    upper = bodies[1]
    U, k = upper.condensation.compliance, len(upper.body.x)
    matching = np.array_equal(lower.body.x, upper.body.x)
    T = None if matching else transfer(lower.body, upper.body)

    along_x, along_y = 0, len(C) // n - 1

    def total(rows: int, columns: int) -> Array:
        of_lower = C[rows * n : rows * n + n, columns * n : columns * n + n]
        of_upper = U[rows * k : rows * k + k, columns * k : columns * k + k]
        if T is not None:
            of_upper = T @ of_upper @ T.T
        return of_lower + of_upper if rows == columns else of_lower - of_upper

    yy = total(along_y, along_y)
    if not sheared:
        return Relative(None, (yy + yy.T) / 2, None)
    xx = total(along_x, along_x)
    xy = (total(along_x, along_y) + total(along_y, along_x).T) / 2 if coupled else None
    return Relative((xx + xx.T) / 2, (yy + yy.T) / 2, xy)
