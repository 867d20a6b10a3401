"""What the next meshes will cost in CPU seconds, by what the meshes before them cost in this very run.

The work of a mesh follows from its number of unknowns. Beside a point of the contact line elements of size h grow with
the depth y like sqrt(h^2 + (g y)^2), so that there are pi/(2 g h) 4/sqrt(3) of them per unit of length, each with k^2
unknowns at order k.
"""

from collections.abc import Iterable, Mapping

import numpy as np

from partialslip.result import Clock

_PER_LENGTH = 2 * np.pi / np.sqrt(3)
_STEEPER, _FIXED = (1e4, 0.4), 1e3  # unknowns from which factors fill, and the power of that; what any mesh costs
_START = 6e3  # work of starting the process that makes meshes, with the first mesh
_UNMESHED = 0.8  # of the work of a mesh: solving on it once more
_POINTS = 200  # per side of each graded point


class Expense:
    """Measured seconds of meshes, and predictions from them. Seconds are those that ``clock`` has left."""

    def __init__(self, clock: Clock, bodies: int) -> None:
        self._clock, self._before = clock, clock.remaining()
        self._rate, self._ratio, self._start = 0.0, float(bodies), _START

    @property
    def limited(self) -> bool:
        """Whether there is an allowance."""
        return self._clock.limited

    def measure(self, unknowns: int, expected: float | None = None) -> None:
        """Take the seconds spent since the last call for those of a mesh of so many ``unknowns``, of which there were
        to be ``expected``."""
        if self.limited:
            left = self._clock.remaining()
            self._rate = max(self._before - left, 0.0) / (_work(unknowns) + self._start)
            self._before, self._start = left, 0.0
            if expected:
                self._ratio *= unknowns / expected

    def pass_over(self) -> None:
        """Leave out the seconds spent since the last call."""
        self._before = self._clock.remaining()

    def unknowns(self, sizes: Mapping[float, float], growth: float, order: int, width: float) -> float:
        """Expected unknowns of a mesh on [-``width``, ``width``] with the ``sizes`` of elements at points, from where
        they grow with the distance."""
        at, size = np.array([*sizes]), np.array([*sizes.values()])
        steps = np.geomspace(size.min(), 2 * width, _POINTS)
        x = np.unique(np.clip(at[:, None] + np.concatenate([-steps, [0.0], steps]), -width, width))
        local = (size + growth * np.abs(x[:, None] - at)).min(axis=1)
        return float(self._ratio * _PER_LENGTH * order**2 / growth * np.trapezoid(1 / local, x))

    def affords(self, meshes: Iterable[float], again: float) -> bool:
        """Whether what is left suffices for meshes of so many unknowns, and for solving on the last one ``again`` times
        the work of its own."""
        works = [_work(unknowns) for unknowns in meshes]
        return self._rate * (sum(works) + again * works[-1]) <= self._clock.remaining()


def again(order: int, other: int) -> float:
    """Work of solving with elements of order ``other`` on a mesh that is there, relative to that of ``order``."""
    return _UNMESHED * (other / order) ** 2


def _work(unknowns: float) -> float:
    start, power = _STEEPER
    return float(unknowns * (1 + unknowns / start) ** power + _FIXED)
