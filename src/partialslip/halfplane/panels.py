"""Sums of many pressures with one kink each, at a cost per point independent of their number."""

from collections.abc import Callable

import numpy as np

from partialslip.tools.arrays import Array, Indices

_NEAR = 6  # cost: kinks near a panel, summed directly
_NARROWEST = 1e-13  # accuracy: width below which panels are not halved
_DEGREES = 22  # accuracy: coefficients, and nodes, of a panel's polynomial
NODES = np.cos(np.pi * (np.arange(_DEGREES) + 0.5) / _DEGREES)
TO_COEFFICIENTS = np.polynomial.chebyshev.chebvander(NODES, _DEGREES - 1).T * 2 / _DEGREES
TO_COEFFICIENTS[0] /= 2
# values at the nodes of each half of a panel from the panel's coefficients
_VALUES = [np.polynomial.chebyshev.chebvander((NODES + side) / 2, _DEGREES - 1) for side in (-1, 1)]

UnitDensity = Callable[[Array, Indices], Array]


class Panels:
    """Weighted sum of pressures over x = sin(angle).

    The ``span`` of angles is halved into panels until at most ``_NEAR`` kinks, or few more, lie within a panel or a
    panel's width of it. The pressures of these near kinks are summed directly. The sum of all far ones is
    interpolated: its nearest singularity is a panel's width away, and Chebyshev interpolation converges like 5.8^-k.
    Each half inherits the far sum of its parent and adds the pressures whose kinks have become far.

    Parameters
    ----------
    span : (float, float)
    ends : (k,) array
        Angles of the kinks.
    weights : (k,) array
    unit : callable
        ``unit(x, number)``: pressures at ``x`` with the indices ``number``, arrays that broadcast to one shape.
    """

    def __init__(self, span: tuple[float, float], ends: Array, weights: Array, unit: UnitDensity) -> None:
        # the last member has weight 0 and pads rows of indices
        weights = np.append(weights, 0.0)
        self._unit, self._last = unit, len(ends) - 1
        low, high, far = np.array([span[0]]), np.array([span[1]]), np.zeros((_DEGREES, 1))
        near = np.arange(len(ends))[None]
        done: list[tuple[Array, Array, Array, Indices]] = []
        while len(low):
            split = (near < len(ends)).sum(axis=1) > _NEAR
            split &= high - low > _NARROWEST
            done.append((low[~split], high[~split], far[:, ~split], near[~split]))
            middle = (low[split] + high[split]) / 2
            halves = (low[split], middle), (middle, high[split])
            inherited = [_VALUES[side] @ far[:, split] for side in (0, 1)]
            low, high = (np.concatenate(each) for each in zip(*halves, strict=True))
            parents = np.concatenate([near[split], near[split]])
            at = np.append(ends, np.inf)[parents]
            width = (high - low)[:, None]
            stays = (at > low[:, None] - width) & (at < high[:, None] + width)
            gone = np.where(stays, len(ends), parents)
            x = np.sin((low + high) / 2 + width.T / 2 * NODES[:, None])
            values = self._values(x[..., None], gone)
            far = TO_COEFFICIENTS @ (np.concatenate(inherited, axis=1) + (values * weights[gone]).sum(axis=-1))
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
        self._which, self._weights = which, weights[which]

    def __call__(self, x: Array) -> Array:
        """Sum at ``x``, an array of any shape."""
        flat_x, angle = x.ravel(), np.arcsin(x).ravel()
        panel = np.maximum(np.searchsorted(self._low, angle, "right") - 1, 0)
        place = (angle - self._middles[panel]) / self._halves[panel]
        result = clenshaw(place, self._far, panel)
        for which, weights in zip(self._which.T, self._weights.T, strict=True):
            result += weights[panel] * self._values(flat_x, which[panel])
        return result.reshape(x.shape)

    def _values(self, x: Array, number: Indices) -> Array:
        return self._unit(x, np.minimum(number, self._last))


def clenshaw(place: Array, coefficients: Array, column: Indices) -> Array:
    """Chebyshev sums at ``place`` (n,), each with the ``column`` (n,) of ``coefficients`` (k, columns)."""
    one, two = np.zeros_like(place), np.zeros_like(place)
    for row in coefficients[:0:-1]:
        one, two = row[column] + 2 * place * one - two, one
    return coefficients[0][column] + place * one - two
