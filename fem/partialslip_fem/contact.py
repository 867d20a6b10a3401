"""Two mirror-image bodies pressed together, on their condensed compliances.

Scaled: lengths by sqrt(A R P), forces by P and displacements by A P, so that nothing depends on units.
Nodal contact forces are the Lagrange multipliers of the relative displacements of the two surfaces.
"""

import numpy as np

from partialslip.condensed.bounded import Solution, solve_bounded
from partialslip.result import Array
from partialslip_fem.condensation import Condensed
from partialslip_fem.elasticity import Body
from partialslip_fem.farfield import FarField


def relative_compliances(body: Body, condensed: Condensed, far_field: FarField | None) -> tuple[Array, Array]:
    """Relative displacements, (n, n) along x and along y, of a body and its mirror image under unit forces.

    The two move by the same amount in opposite directions: twice what one does, while what shear does along y,
    and pressure along x, cancels. ``far_field`` moves the outer boundary; without it the boundary is clamped.
    """
    compliance = condensed.compliance
    if far_field:
        compliance = compliance + condensed.respond(far_field.fields) @ far_field.moments
    n = len(body.x)
    # With every moment of the forces in it the compliance is symmetric but for the discretisation of the far
    # boundary (1e-7 or less). A truncated expansion would not be, and must not be symmetrised.
    tangential, normal = compliance[:n, :n], compliance[n:, n:]
    return tangential + tangential.T, normal + normal.T


def press(normal: Array, gap: Array, P: float) -> Solution:
    """Nodal normal forces, none of them tensile, that close ``gap`` and sum to ``P``."""
    return solve_bounded(normal, -gap, np.zeros(len(gap)), np.full(len(gap), np.inf), P)
