"""Pressure under convex even profiles of piecewise constant curvature: flat and rounded punches, tables. Scaled as in
:mod:`partialslip.halfplane.shape`."""

import math
from functools import cached_property

import numpy as np

from partialslip.halfplane.panels import Panels
from partialslip.halfplane.shape import Shape
from partialslip.tools.arrays import Array

FEW = 24  # cost: flats up to which pressures are summed directly


class Punch(Shape):
    """Pressure as a sum of flat and rounded punches (Ciavarella, Hills and Monno, 1998).

    A step w of the profile's curvature at |x| = b adds w times the pressure of a flat of half-width b with corners of
    curvature 1, as the pressure is linear in the profile for a given contact. b = 0 is Hertz.

    Parameters
    ----------
    flats : float or (k,) array_like
        Points b of the steps of curvature, as fractions of a; 0 <= b < 1.
    steps : (k,) array_like
        Steps w of curvature, in any unit.
    psi : (k,) array, optional
        arccos(flats), if known to more digits.
    """

    def __init__(self, flats: Array | float, steps: Array | float = 1.0, psi: Array | None = None) -> None:
        flats, steps = np.broadcast_arrays(np.atleast_1d(np.asarray(flats, float)), steps)
        self.flats, self._ends = flats, np.arcsin(flats)
        self._weights = steps / (steps @ punch_force(np.arccos(flats) if psi is None else psi))
        self.kinks = tuple(sorted({sign * float(flat) for flat in flats if flat > 0 for sign in (-1, 1)}))

    @property
    def strong_kinks(self) -> tuple[float, ...]:
        if len(self.flats) <= FEW:
            return self.kinks
        strong = self.flats[np.abs(self._weights) > np.abs(self._weights).sum() / FEW]
        return tuple(sorted({sign * float(flat) for flat in strong if flat > 0 for sign in (-1, 1)}))

    def pressure(self, x: Array) -> Array:
        x = np.minimum(np.abs(x), 1.0)
        sum_ = self._all(x) if len(self.flats) <= FEW else self._panels(x)
        return np.where(x < 1, np.maximum(sum_, 0.0), 0.0)

    def _all(self, x: Array) -> Array:
        total = np.zeros_like(x)
        angle, cosine = np.arcsin(x), np.sqrt((1 - x) * (1 + x))
        for flat, end, weight in zip(self.flats, self._ends, self._weights, strict=True):
            apart = np.abs(np.sin(angle - end))
            logarithm = np.log(np.sin(angle + end) / np.where(apart == 0, 1.0, apart)) if flat > 0 else 0.0
            # both logarithms of the usual form in one: their singularities at the flat's ends cancel
            rest = 2 * flat * np.log(np.sin((angle + end) / 2) / np.cos((angle - end) / 2)) if flat > 0 else 0.0
            total += weight * ((math.pi - 2 * end) * cosine + (x - flat) * logarithm + rest)
        return total

    @cached_property
    def _panels(self) -> Panels:
        wedges = math.pi - 2 * self._ends
        return Panels((0.0, np.pi / 2), self._ends, self._weights, lambda x, k: _unit(x, self.flats[k], wedges[k]))


def _unit(x: Array, flats: Array, wedges: Array) -> Array:
    """Pressure at ``x`` in [0, 1] under ``flats`` of half-width b = sin(end) with corners of curvature 1; ``wedges``
    are pi - 2 end. With t = tan(angle/2), x = sin(angle), the four logarithms of the usual form become two, and the
    factor of each logarithm vanishes at the singularity."""
    cosine = np.sqrt((1 - x) * (1 + x))
    t, tau = x / (1 + cosine), flats / (1 + np.sqrt((1 - flats) * (1 + flats)))
    both = t * tau
    u, v = (t + tau) / (1 + both), np.abs(t - tau) / np.where(both == 1, 1.0, 1 - both)
    u, v = np.where(u == 0, 1.0, u), np.where(v == 0, 1.0, v)
    return wedges * cosine + (x + flats) * np.log(u) - (x - flats) * np.log(v)


def punch_force(psi: Array) -> Array:
    """2 psi - sin(2 psi), the resultant for unit curvature beyond b = cos(``psi``), without cancellation at small psi.

    P = a^2/(2 A) times the sum over steps w of curvature of w times this resultant.
    """
    series = 4 / 3 * psi**3 * (1 - psi**2 / 5 * (1 - 2 * psi**2 / 21))
    return np.where(psi < 1e-2, series, 2 * psi - np.sin(2 * psi))
