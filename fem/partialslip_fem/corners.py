"""Singular corners of finite bodies, where stresses go like a negative power of the distance.

Displacements begin with distance^k. Elements of size h at a corner, of any order, leave an error of about (h/L)^(2 k)
in the energy, and so in the displacements of the contact line; L is the size of the body.

Source of the exponents: M. L. Williams, Stress singularities resulting from various boundary conditions in angular
corners of plates in extension, J. Appl. Mech. 19 (1952) 526-528.
"""

import numpy as np

from partialslip.tools.arrays import Array

_LEAST, _COUNT = 0.2, 4001  # accuracy: smallest exponent tried, and number of exponents tried up to 1


def free_exponent(angle: float) -> float:
    """Exponent k of the displacements at a corner of ``angle`` (rad) with two free sides; 1 without singularity."""
    k = np.linspace(_LEAST, 1.0, _COUNT)[:-1]
    return _first(np.sin(k * angle) + k * np.sin(angle), k)


def held_exponent(angle: float, kappa: float) -> float:
    """Exponent k at a corner of ``angle`` (rad) between a held and a free side; the real part of a complex exponent.

    ``kappa`` is Kolosov's constant.
    """
    k = np.linspace(_LEAST, 1.0, _COUNT)[:-1]
    return _first((kappa + 1) ** 2 / (4 * kappa) - k**2 * np.sin(angle) ** 2 / kappa - np.sin(k * angle) ** 2, k)


def size(tolerance: float, exponent: float) -> float:
    """Element size at a corner, in the size of the body, for an error of ``tolerance``, relative."""
    return float(min(tolerance ** (1 / (2 * exponent)), 1.0))


def _first(values: Array, k: Array) -> float:
    """First of ``k`` where ``values`` are not positive or have a minimum, beside which a complex exponent lies; 1
    without either."""
    turns = np.zeros(len(k), dtype=bool)
    turns[1:-1] = (values[1:-1] <= values[:-2]) & (values[1:-1] < values[2:])
    found = np.flatnonzero(turns | (values <= 0))
    return float(k[found[0]]) if len(found) else 1.0
