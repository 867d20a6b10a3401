"""Convex even profiles whose curvature is piecewise constant: flat and rounded punches and tables; scaled as in
:mod:`partialslip.halfplane.shape`."""

import math

import numpy as np

from partialslip.halfplane.shape import Shape
from partialslip.result import Array


class Punch(Shape):
    """A sum of flat and rounded punches (Ciavarella, Hills and Monno, 1998).

    Where the profile's curvature steps up by w at |x| = b, it adds w times the pressure of a flat of half-width b with
    corners of curvature 1: for a given contact the inversion is linear. b = 0 is Hertz.

    Parameters
    ----------
    flats : float or (k,) array_like
        Where the curvature steps, as fractions of a; 0 <= b < 1.
    steps : (k,) array_like
        By how much, in any unit.
    psi : (k,) array, optional
        arccos(flats), where more of its digits are known.
    """

    def __init__(self, flats: Array | float, steps: Array | float = 1.0, psi: Array | None = None) -> None:
        flats, steps = np.broadcast_arrays(np.atleast_1d(np.asarray(flats, float)), steps)
        self.flats, self._ends = flats, np.arcsin(flats)
        self._weights = steps / (steps @ punch_force(np.arccos(flats) if psi is None else psi))
        self.kinks = tuple(sorted({sign * float(flat) for flat in flats if flat > 0 for sign in (-1, 1)}))

    def pressure(self, x: Array) -> Array:
        x = np.minimum(np.abs(x), 1.0)
        total = np.zeros_like(x)
        angle, cosine = np.arcsin(x), np.sqrt((1 - x) * (1 + x))
        for flat, end, weight in zip(self.flats, self._ends, self._weights, strict=True):
            apart = np.abs(np.sin(angle - end))
            logarithm = np.log(np.sin(angle + end) / np.where(apart == 0, 1.0, apart)) if flat > 0 else 0.0
            # the two logarithms of the usual form, whose singularities at the flat's ends cancel, taken together
            rest = 2 * flat * np.log(np.sin((angle + end) / 2) / np.cos((angle - end) / 2)) if flat > 0 else 0.0
            total += weight * ((math.pi - 2 * end) * cosine + (x - flat) * logarithm + rest)
        result: Array = np.where(x < 1, np.maximum(total, 0.0), 0.0)
        return result


def punch_force(psi: Array) -> Array:
    """Resultant that goes with a punch of unit curvature beyond b = cos(psi): 2 psi - sin(2 psi), which cancels in a
    contact hardly wider than its flat. P = a^2/(2 A) times the sum of it over steps of curvature."""
    series = 4 / 3 * psi**3 * (1 - psi**2 / 5 * (1 - 2 * psi**2 / 21))
    result: Array = np.where(psi < 1e-2, series, 2 * psi - np.sin(2 * psi))
    return result
