"""Ruiz's parameters of fretting damage: tangential stress, shear traction and slip along the contact; SI units."""

from typing import NamedTuple

import numpy as np

from partialslip.arrays import Array
from partialslip.result import Result


class Ruiz(NamedTuple):
    """Ruiz's parameters, Pa^2 m.

    Parameters
    ----------
    F1 : float
        Largest sigma_T times largest tau delta, wherever each of them is.
    F2 : float
        Largest product sigma_T tau delta of one point.
    x1, x2 : float
        Where tau delta, and where the product is largest, m.
    x : (k,) array
        Points of the contact, m.
    product : (k,) array
        sigma_T tau delta at these points, Pa^2 m.
    """

    F1: float
    F2: float
    x1: float
    x2: float
    x: Array
    product: Array


def ruiz(result: Result, sigma: Array) -> Ruiz:
    """Return Ruiz's parameters F1 and F2 of a result with slip.

    sigma_T is the largest tangential stress sigma_xx of the surface during the cycle (0 under compression), tau the
    amplitude \\|q2 - q1\\|/2 of the shear traction, and delta the amplitude of slip, half of its change between load
    points 1 and 2.

    Parameters
    ----------
    result : Result
        With ``slip``.
    sigma : (s, k) array
        sigma_xx along the load path at the points ``result.slip.x``, Pa.

    References
    ----------
    C. Ruiz, P. H. B. Boddington, K. C. Chen, An investigation of fatigue and fretting in a dovetail joint, Exp. Mech.
    24 (1984) 208-217.
    """
    assert result.slip
    x = result.slip.x
    tension = np.maximum(sigma.max(axis=0), 0.0)
    work = np.abs(result.traction.at(x)[1]) / 2 * np.abs(result.slip.slip) / 2
    product = tension * work
    most, both = int(work.argmax()), int(product.argmax())
    return Ruiz(float(tension.max() * work[most]), float(product[both]), float(x[most]), float(x[both]), x, product)
