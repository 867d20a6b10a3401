"""Two bodies pressed together, on their condensed compliances.

Scaled: lengths by sqrt(A R P), forces by P and displacements by A P, so that nothing depends on units.
Nodal contact forces are the Lagrange multipliers of the relative displacements of the two surfaces.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from partialslip.arrays import Array
from partialslip.condensed.bounded import Solution, solve_bounded
from partialslip.condensed.coupled import Relative
from partialslip_fem.condensation import Condensed
from partialslip_fem.elasticity import Body
from partialslip_fem.mortar import transfer
from partialslip_meshes import Mesh


@dataclass(frozen=True)
class Half:
    """One body, meshed below its contact line, and condensed to it. The upper body is the mirror image of that."""

    mesh: Mesh
    body: Body
    condensed: Condensed

    @property
    def stretched(self) -> Array:
        """Displacements of all nodes, (2, N), under the tension whose uniform strain of a long body would be 1: that
        strain, but for a body that is pulled at its end."""
        result: Array = self.body.points * np.array([[1.0], [-(3 - self.body.kappa) / (1 + self.body.kappa)]])
        if self.condensed.pulled is not None:
            result = 4 / self.body.compliance * self.condensed.pulled.reshape(2, -1)
        return result

    @property
    def stretch(self) -> Array:
        """Those of the contact line, (2, n)."""
        if self.condensed.pulled is None:
            return np.array([self.body.x, 0 * self.body.x])
        result: Array = self.stretched[:, self.body.contact[0]]
        return result


def relative_compliances(halves: Sequence[Half], coupled: bool = True) -> Relative:
    """Relative displacements of the two surfaces, at the nodes of the lower one, under nodal forces there; what shear
    does along y, and pressure along x, only of ``coupled`` bodies. Bodies condensed without shear have none of it.

    Of the lower and the upper body; of one that is mirrored, that one alone. Mirrored bodies move by the same amount
    in opposite directions: twice what one does, while what shear does along y, and pressure along x, cancels.
    """
    lower = halves[0]
    n = len(lower.body.x)
    C = lower.condensed.compliance
    # With every moment of the forces in the far field the compliance is symmetric but for the discretisation of the
    # far boundary (1e-7 or less). A truncated expansion would not be, and must not be symmetrised.
    sheared = len(C) > n
    if len(halves) == 1:
        xx, yy = C[:-n, :-n], C[-n:, -n:]
        return Relative(xx + xx.T if sheared else None, yy + yy.T, None)
    upper = halves[1]
    U, k = upper.condensed.compliance, len(upper.body.x)
    T = transfer(lower.body, upper.body)

    along_x, along_y = 0, len(C) // n - 1

    def total(rows: int, columns: int) -> Array:
        of_lower = C[rows * n : rows * n + n, columns * n : columns * n + n]
        of_upper = T @ U[rows * k : rows * k + k, columns * k : columns * k + k] @ T.T
        return of_lower + of_upper if rows == columns else of_lower - of_upper

    yy = total(along_y, along_y)
    if not sheared:
        return Relative(None, (yy + yy.T) / 2, None)
    xx = total(along_x, along_x)
    xy = (total(along_x, along_y) + total(along_y, along_x).T) / 2 if coupled else None
    return Relative((xx + xx.T) / 2, (yy + yy.T) / 2, xy)


def press(normal: Array, gap: Array, P: float) -> Solution:
    """Nodal normal forces, none of them tensile, that close ``gap`` and sum to ``P``."""
    return solve_bounded(normal, -gap, np.zeros(len(gap)), np.full(len(gap), np.inf), P)
