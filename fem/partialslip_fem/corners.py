"""Corners of finite bodies that disturb: stresses go there like a negative power of the distance.

Displacements begin with distance^k. Elements of size h at a corner, of any order, leave an error in the energy, and so
in what the body does at the contact, of about (h/L)^(2 k), L being the size of the body.

Source of the exponents: M. L. Williams, Stress singularities resulting from various boundary conditions in angular
corners of plates in extension, J. Appl. Mech. 19 (1952) 526-528.
"""

import numpy as np

from partialslip.arrays import Array

_LEAST, _COUNT = 0.2, 4001  # exponents that are tried: from this one to 1


def free_exponent(angle: float) -> float:
    """Exponent k of the displacements at a corner of ``angle`` (rad) whose sides are both free; 1 if it disturbs
    nothing."""
    k = np.linspace(_LEAST, 1.0, _COUNT)[:-1]
    return _first(np.sin(k * angle) + k * np.sin(angle), k)


def held_exponent(angle: float, kappa: float) -> float:
    """Exponent where a held side meets a free one, in a material with Kolosov's constant ``kappa``; the real part where
    the exponent is complex."""
    k = np.linspace(_LEAST, 1.0, _COUNT)[:-1]
    return _first((kappa + 1) ** 2 / (4 * kappa) - k**2 * np.sin(angle) ** 2 / kappa - np.sin(k * angle) ** 2, k)


def size(tolerance: float, exponent: float) -> float:
    """Element size, in that of the body, which leaves an error of ``tolerance``."""
    return float(min(tolerance ** (1 / (2 * exponent)), 1.0))


def _first(values: Array, k: Array) -> float:
    """The first root of a function that is positive before it, or where the function comes nearest to one."""
    below = np.flatnonzero(values <= 0)
    if len(below):
        return float(k[below[0]])
    turns = np.flatnonzero((values[1:-1] <= values[:-2]) & (values[1:-1] < values[2:]))
    return float(k[1 + turns[0]]) if len(turns) else 1.0
