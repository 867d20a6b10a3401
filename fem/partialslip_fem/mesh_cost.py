"""CPU seconds of the next meshes, predicted from the meshes before in the same run.

The work of a mesh follows from the number of unknowns. Below a point of the contact line the element size grows from h
with the depth y like sqrt(h^2 + (g y)^2). There are pi/(2 g h) 4/sqrt(3) elements per unit of length, each with k^2
unknowns at order k.
"""

from collections.abc import Iterable

import numpy as np

from partialslip.result import Clock
from partialslip_fem.bodies import Grading

_PER_LENGTH = 2 * np.pi / np.sqrt(3)
# cost: Work in unknowns of a small mesh.
_FILL = 1e4, 0.4  # cost: unknowns above which fill of the factor adds work, and the power of the growth
_FIXED = 1e3  # cost: work of any mesh
_START = 6e3  # cost: work of starting the gmsh process, with the first mesh
_UNMESHED = 0.8  # cost: of the work of a mesh: solving on the same mesh once more
_POINTS = 200  # cost: quadrature points on each side of each graded point


class Expense:
    """Measured and predicted CPU seconds of meshes.

    Parameters
    ----------
    clock : Clock
        Clock with the allowance.
    bodies : int
        Number of bodies that are meshed.
    """

    def __init__(self, clock: Clock, bodies: int) -> None:
        self._clock, self._before = clock, clock.remaining()
        self._seconds, self._work = 0.0, 1.0  # of the last mesh
        self._ratio, self._start = float(bodies), _START

    @property
    def limited(self) -> bool:
        """Whether there is an allowance."""
        return self._clock.limited

    def measure(self, unknowns: int, once_s: float = 0.0, expected: float | None = None) -> None:
        """Attribute the seconds since the last call to a mesh of so many ``unknowns``.

        The next mesh does without ``once_s`` of them. ``expected`` is the predicted number of unknowns, which corrects
        later predictions.
        """
        if self.limited:
            left = self._clock.remaining()
            self._seconds, self._work = max(self._before - left - once_s, 0.0), _work(unknowns) + self._start
            self._before, self._start = left, 0.0
            if expected:
                self._ratio *= unknowns / expected

    def add(self, seconds: float) -> None:
        """Add ``seconds`` to those of the last mesh: the next ones take more load steps."""
        self._seconds += seconds
        self.pass_over()

    def pass_over(self) -> None:
        """Attribute the seconds since the last call to no mesh."""
        self._before = self._clock.remaining()

    def unknowns(self, grading: Grading, order: int, width: float) -> float:
        """Predicted number of unknowns of a mesh on [-``width``, ``width``] with elements of ``order``."""
        at, size = np.array([*grading.sizes]), np.array([*grading.sizes.values()])
        steps = np.geomspace(size.min(), 2 * width, _POINTS)
        x = np.unique(np.clip(at[:, None] + np.concatenate([-steps, [0.0], steps]), -width, width))
        local = grading.at(x)
        growth = (local - size.min()) / np.maximum(np.abs(x[:, None] - at).min(axis=1), np.finfo(float).tiny)
        return float(
            self._ratio * _PER_LENGTH * order**2 * np.trapezoid(1 / (np.maximum(growth, grading.growth) * local), x)
        )

    def affords(self, meshes: Iterable[float], again: float, beyond: float = 0.0) -> bool:
        """Whether the seconds left, and ``beyond`` more, suffice for ``meshes`` of so many unknowns and for solving on
        the last one again.

        ``again`` is the work of solving again, relative to the work of the last mesh.
        """
        works = [_work(unknowns) for unknowns in meshes]
        return self.allows(self._seconds / self._work * (sum(works) + again * works[-1]), beyond)

    def allows(self, seconds: float, beyond: float = 0.0) -> bool:
        """Whether so many ``seconds`` are left, and ``beyond`` more."""
        return seconds <= self._clock.remaining() + beyond


def work_again(order: int, other: int) -> float:
    """Work of solving again on the same mesh with elements of order ``other``, relative to meshing and solving with
    ``order``."""
    return _UNMESHED * (other / order) ** 2


def _work(unknowns: float) -> float:
    start, power = _FILL
    return float(unknowns * (1 + unknowns / start) ** power + _FIXED)
