"""Phases of a cycle between the load steps of a method that marches."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from partialslip.scene import Load
from partialslip.tools.arrays import Array, Complex, Indices

_Values = TypeVar("_Values", Array, Complex)


@dataclass(frozen=True)
class Phases:
    """The states at the ends of load steps, and between them states that are linear in the loads, which keep to
    Coulomb's law and to equilibrium.

    Parameters
    ----------
    load : Load
    ways : tuple of tuple of float
        The steps to each load point, as ascending fractions up to 1.
    """

    load: Load
    ways: tuple[tuple[float, ...], ...]

    @property
    def loads(self) -> Array:
        """Loads at the ends of the steps, (steps, 5): Q (N/m), sigma (Pa), sigma_slope (Pa/m), and the share of the
        way from the load point before, and this load point's index."""
        along, rows = np.array(self.load.along), []
        for number, way in enumerate(self.ways):
            share = np.array(way)[:, None]
            before, after = along[number - 1], along[number]
            index = np.full_like(share, (number - 1) % len(along))
            rows.append(np.hstack([before + share * (after - before), share, index]))
        return np.concatenate(rows)

    def between(self, phases: Array) -> tuple[Indices, Indices, Array]:
        """Steps (s,) before and after ``phases`` (s,), and the weight (s,) of the step after."""
        ends = np.concatenate([number - 1 + np.array(way) for number, way in enumerate(self.ways)])
        ends, count = np.append(-1.0, ends), len(self.ways)
        passed, share = self.load.stations(phases)
        position = np.where(passed == count - 1, -1.0, passed) + share
        after = np.clip(np.searchsorted(ends, position), 1, len(ends) - 1)
        weight = (position - ends[after - 1]) / (ends[after] - ends[after - 1])
        return (after - 2) % (len(ends) - 1), after - 1, np.clip(weight, 0.0, 1.0)

    def interpolate(self, at_steps: Callable[[Sequence[int]], _Values], phases: Array) -> _Values:
        """Values (s, ...) at ``phases`` (s,) from those ``at_steps(numbers) -> (k, ...)``."""
        before, after, weight = self.between(phases)
        used = np.unique(np.concatenate([before[weight < 1], after[weight > 0]]))
        values = at_steps(used.tolist())
        weight = weight.reshape(-1, *(1,) * (values.ndim - 1))
        low, high = (np.minimum(np.searchsorted(used, each), len(used) - 1) for each in (before, after))
        found: _Values = np.where(weight > 0, values[high], values[low])
        inner = (weight > 0) & (weight < 1)
        return np.where(inner, (1 - weight) * values[low] + weight * found, found) if inner.any() else found
