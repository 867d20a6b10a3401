"""Stresses in a half-plane below tractions on its surface, from Cauchy integrals of the tractions.

Let P = (1/pi) int p dt/(t - z), T the same of q, and z = x + i y with y = -depth. In the lower body

    sigma_xx = Im P + y Re P' - 2 Re T + y Im T',    sigma_yy = Im P - y Re P' - y Im T',
    sigma_xy = Im T - y Im P' + y Re T'

(Muskhelishvili, Some basic problems of the mathematical theory of elasticity). The upper body is the mirror image of
the lower body under the opposite q.

Tractions on a round face, at t + i h(t), are sums of Flamant's solutions at these points: the same with t + i h(t) for
t in the integrals, and with (1/pi) int (y - h) p dt/(t + i h - z)^2 for y P'.
"""

import numpy as np

from partialslip.tools.arrays import Array, Complex


def under_pressure(P: Complex, yP_z: Complex, side: Array) -> Array:
    """Stresses (3, k) xx, yy, xy due to p, from its Cauchy integral ``P`` (k,) and y P' (k,), in the lower (``side`` =
    1) and the upper body (-1)."""
    return np.stack([P.imag + yP_z.real, P.imag - yP_z.real, -side * yP_z.imag])


def under_shear(T: Complex, yT_z: Complex, side: Array) -> Array:
    """Stresses (3, k) due to q, which the lower body exerts; see :func:`under_pressure`."""
    return np.stack([side * (yT_z.imag - 2 * T.real), -side * yT_z.imag, T.imag + yT_z.real])


def under_tension(sigma: Array, slope: float, depth: Array, side: Array) -> Array:
    """Stresses (3, k) due to the bulk tension ``sigma`` (k,), which varies along x by ``slope``, in the lower body:
    sigma_xx = s x is in equilibrium with sigma_xy = -s y."""
    lower = np.where(side > 0, 1.0, 0.0)
    return np.stack([lower * sigma, 0 * depth, lower * slope * depth])
