"""Pressure under convex even profiles of piecewise constant curvature: flat and rounded punches, tables. Scaled as in
:mod:`partialslip.halfplane.shape`."""

import math
from functools import cached_property

import numpy as np
import numpy.typing as npt

from partialslip.arrays import Array
from partialslip.halfplane.shape import Shape

_FEW = 24  # flats up to which pressures are summed directly
_NEAR = 6  # flats near a panel, summed directly
_NARROWEST = 1e-13  # width below which panels are not halved
_DEGREES = 22  # coefficients, and nodes, of a panel's polynomial
_NODES = np.cos(np.pi * (np.arange(_DEGREES) + 0.5) / _DEGREES)
_TO_COEFFICIENTS = np.polynomial.chebyshev.chebvander(_NODES, _DEGREES - 1).T * 2 / _DEGREES
_TO_COEFFICIENTS[0] /= 2
# values at the nodes of each half of a panel from the panel's coefficients
_VALUES = [np.polynomial.chebyshev.chebvander((_NODES + side) / 2, _DEGREES - 1) for side in (-1, 1)]


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
        if len(self.flats) <= _FEW:
            return self.kinks
        strong = self.flats[np.abs(self._weights) > np.abs(self._weights).sum() / _FEW]
        return tuple(sorted({sign * float(flat) for flat in strong if flat > 0 for sign in (-1, 1)}))

    def pressure(self, x: Array) -> Array:
        x = np.minimum(np.abs(x), 1.0)
        sum_ = self._all(x) if len(self.flats) <= _FEW else self._panels(x)
        result: Array = np.where(x < 1, np.maximum(sum_, 0.0), 0.0)
        return result

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
    def _panels(self) -> "_Panels":
        return _Panels(self.flats, self._ends, self._weights)


class _Panels:
    """Pressure of many flats at a cost per point independent of the number of flats.

    The range [0, pi/2] of arcsin(x) is halved into panels until at most ``_NEAR`` kinks, or few more, lie within a
    panel or a panel's width of it. The pressures of these near flats are summed directly. The sum of all far flats is
    interpolated: its nearest singularity is a panel's width away, and Chebyshev interpolation converges like 5.8^-k.
    Each half inherits the far sum of its parent and adds the flats that have become far.
    """

    def __init__(self, flats: Array, ends: Array, weights: Array) -> None:
        # the last flat has weight 0 and pads rows of indices
        flats, wedges, weights = (np.append(values, 0.0) for values in (flats, math.pi - 2 * ends, weights))
        low, high, far = np.array([0.0]), np.array([np.pi / 2]), np.zeros((_DEGREES, 1))
        near = np.arange(len(ends))[None]
        done: list[tuple[Array, Array, Array, npt.NDArray[np.int64]]] = []
        while len(low):
            split = (near < len(ends)).sum(axis=1) > _NEAR
            split &= high - low > _NARROWEST
            done.append((low[~split], high[~split], far[:, ~split], near[~split]))
            middle = (low[split] + high[split]) / 2
            halves = (low[split], middle), (middle, high[split])
            inherited = [_VALUES[side] @ far[:, split] for side in (0, 1)]
            low, high = (np.concatenate(each) for each in zip(*halves, strict=True))
            parents = np.concatenate([near[split], near[split]])
            angles = np.append(ends, np.inf)[parents]
            width = (high - low)[:, None]
            stays = (angles > low[:, None] - width) & (angles < high[:, None] + width)
            gone = np.where(stays, len(ends), parents)
            x = np.sin((low + high) / 2 + width.T / 2 * _NODES[:, None])
            unit = _unit(x[..., None], flats[gone], wedges[gone])
            far = _TO_COEFFICIENTS @ (np.concatenate(inherited, axis=1) + (unit * weights[gone]).sum(axis=-1))
            near = np.sort(np.where(stays, parents, len(ends)), axis=1)[:, : stays.sum(axis=1).max(initial=0)]
        order = np.argsort(np.concatenate([each[0] for each in done]))
        low, high = (np.concatenate([each[i] for each in done])[order] for i in (0, 1))
        self._low, self._middles, self._halves = low, (low + high) / 2, (high - low) / 2
        self._far = np.concatenate([each[2] for each in done], axis=1)[:, order]
        most = max(int((each[3] < len(ends)).sum(axis=1).max(initial=0)) for each in done)
        which = np.full((len(low), most), len(ends))
        row = 0
        for *_, near in done:
            part = near[:, :most]
            which[row : row + len(part), : part.shape[1]] = part
            row += len(part)
        which = which[order]
        self._flats, self._wedges, self._weights = flats[which], wedges[which], weights[which]

    def __call__(self, x: Array) -> Array:
        """Pressure at ``x`` in [0, 1], an array of any shape."""
        flat_x, angle = x.ravel(), np.arcsin(x).ravel()
        panel = np.searchsorted(self._low, angle, "right") - 1
        place = (angle - self._middles[panel]) / self._halves[panel]
        result = _clenshaw(place, self._far, panel)
        for flats, wedges, weights in zip(self._flats.T, self._wedges.T, self._weights.T, strict=True):
            result += weights[panel] * _unit(flat_x, flats[panel], wedges[panel])
        return result.reshape(x.shape)


def _clenshaw(place: Array, coefficients: Array, column: npt.NDArray[np.int64]) -> Array:
    """Chebyshev sums at ``place`` (n,), each with the ``column`` (n,) of ``coefficients`` (k, columns)."""
    one, two = np.zeros_like(place), np.zeros_like(place)
    for row in coefficients[:0:-1]:
        one, two = row[column] + 2 * place * one - two, one
    result: Array = coefficients[0][column] + place * one - two
    return result


def _unit(x: Array, flats: Array, wedges: Array) -> Array:
    """Pressure at ``x`` in [0, 1] under ``flats`` of half-width b = sin(end) with corners of curvature 1; ``wedges``
    are pi - 2 end. With t = tan(angle/2), x = sin(angle), the four logarithms of the usual form become two, and the
    factor of each logarithm vanishes at the singularity."""
    cosine = np.sqrt((1 - x) * (1 + x))
    t, tau = x / (1 + cosine), flats / (1 + np.sqrt((1 - flats) * (1 + flats)))
    both = t * tau
    u, v = (t + tau) / (1 + both), np.abs(t - tau) / np.where(both == 1, 1.0, 1 - both)
    u, v = np.where(u == 0, 1.0, u), np.where(v == 0, 1.0, v)
    result: Array = wedges * cosine + (x + flats) * np.log(u) - (x - flats) * np.log(v)
    return result


def punch_force(psi: Array) -> Array:
    """2 psi - sin(2 psi), the resultant for unit curvature beyond b = cos(``psi``), without cancellation at small psi.

    P = a^2/(2 A) times the sum over steps w of curvature of w times this resultant.
    """
    series = 4 / 3 * psi**3 * (1 - psi**2 / 5 * (1 - 2 * psi**2 / 21))
    result: Array = np.where(psi < 1e-2, series, 2 * psi - np.sin(2 * psi))
    return result
