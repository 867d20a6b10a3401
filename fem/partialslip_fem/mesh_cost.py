"""CPU seconds of the next meshes, predicted from the meshes before in the same run.

The work of a mesh follows from the number of unknowns and from the number of nodes of the contact line. Below a point
of the contact line the element size grows from h with the depth y like sqrt(h^2 + (g y)^2). There are
pi/(2 g h) 4/sqrt(3) equilateral elements per unit of length, each with k^2 unknowns at order k, and k/h nodes. Beside
the line itself, where gmsh smooths the sizes, there is one more row of elements; all in all gmsh makes some more.

Contact and friction are predicted apart from the mesh: their work grows with the nodes alone, and with the linear
solves of the march along the load path. The next mesh may take fewer: it begins each step where this one ended.
"""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from partialslip.arrays import Array
from partialslip.result import Clock
from partialslip_fem.bodies import Grading
from partialslip_fem.mesh_solution import MeshSolution
from partialslip_meshes.grading import in_effect

_PER_LENGTH = 2 * np.pi / np.sqrt(3)
_MORE = 1.25  # cost: unknowns over those of equilateral elements (measured: within 5 %)
# cost: Work in unknowns of a small mesh.
_FILL = 1e4, 0.4  # cost: unknowns above which fill of the factor adds work, and the power of the growth
_DENSE = 7e-5  # cost: work of the dense compliance of the contact line, in its nodes to the third power
_FIXED = 1500  # cost: work of any mesh
_START = 6e3  # cost: work of starting the gmsh process, with the first mesh
_UNMESHED = 0.6  # cost: of the work of a mesh: solving on the same mesh once more
# cost: work of a linear solve of contact and friction: nodes and so many more, to the power
_MARCH = 400, 3.0
# cost: work of a load step of coupled bodies, in linear solves: 1 for the step itself, and 1.5 to 2.1 (measured) if it
# begins where that step ended on the mesh before, 3 to 6 if it begins anew
_WARM, _COLD = 2.7, 7.0
# cost: most cycles that are expected on the next mesh, after that on which the load steps are chosen and after others.
# Single nodes beside the ends of zones come to their bound slowly, on one mesh and not on the next: measured are 10 to
# 133 cycles on the first of these meshes and 1 to 15 on the next one, and 139 and 1
_CYCLES = 5, 15
_SMOOTHED = 0.29  # fixed: logarithm of the ratio of neighbours to which gmsh smooths elements along a line
_SAMPLES = 4000  # cost: points on each side of graded ones at which element sizes are summed up


class MeshSize(NamedTuple):
    """Number of ``unknowns`` of a mesh, and of ``nodes`` of its contact line."""

    unknowns: float
    nodes: float


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
        self._seconds, self._march_s = 0.0, 0.0  # of the last mesh without contact and friction, and of these
        self._size, self._work, self._ratio = MeshSize(1, 1), 1.0, np.array([float(bodies), 1.0])
        self._start = _START

    @property
    def limited(self) -> bool:
        """Whether there is an allowance."""
        return self._clock.limited

    def measure(
        self,
        solution: MeshSolution,
        march_s: float = 0.0,
        expected: MeshSize | None = None,
        anew: bool = False,
    ) -> None:
        """Attribute the seconds since the last call to the mesh of ``solution``.

        ``march_s`` of them are those of contact and friction, ``anew`` tells whether the load steps were chosen on this
        mesh. The next mesh does without the seconds of that choice. ``expected`` is the predicted size, which corrects
        later predictions.
        """
        if self.limited:
            left = self._clock.remaining()
            spent, self._size = self._before - left, MeshSize(solution.dofs, len(solution.lower.x))
            self._seconds = max(spent - solution.choosing_s - march_s, 0.0)
            self._work = _work(self._size) + self._start
            self._before, self._start = left, 0.0
            if expected:
                self._ratio *= np.divide(self._size, expected)
            self.march(solution, march_s, anew)

    def march(self, solution: MeshSolution, seconds: float, anew: bool = True) -> None:
        """Attribute ``seconds`` to contact and friction on the last mesh, with the load steps of ``solution``, and the
        seconds since the last call to no mesh; ``anew`` as for :meth:`measure`."""
        if self.limited:
            self._march_s = seconds * march_ahead(solution, anew)
            self.pass_over()

    def pass_over(self) -> None:
        """Attribute the seconds since the last call to no mesh."""
        self._before = self._clock.remaining()

    def size(
        self, grading: Grading, order: int, width: float, swept: Iterable[tuple[float, float, float]] = ()
    ) -> MeshSize:
        """Predicted size of a mesh on [-``width``, ``width``] with elements of ``order``; ``swept`` are ends of
        intervals and the element size in each."""
        at, size = np.array(sorted(grading.sizes.items())).T
        x, intervals = _sampled(at, size, width), [*swept]

        def sized(grading: Grading) -> Array:
            found = grading.at(x)
            for low, high, within in intervals:
                found = np.minimum(found, within + grading.growth * np.maximum(np.maximum(low - x, x - high), 0.0))
            return found

        local = sized(grading)
        growth = (local - size.min()) / np.maximum(np.abs(x[:, None] - at).min(axis=1), np.finfo(float).tiny)
        below = _PER_LENGTH * order**2 * np.trapezoid(1 / (np.maximum(growth, grading.growth) * local), x)
        if in_effect(grading.eased, grading.growth) is None:
            local = sized(grading._replace(growth=min(grading.growth, _SMOOTHED)))
        on_line = (grading.contact[0] <= x) & (x <= grading.contact[1])
        nodes = order * np.trapezoid(1 / local[on_line], x[on_line])
        unknowns = _MORE * (below + order * nodes)
        return MeshSize(*(self._ratio * (unknowns, nodes)).tolist())

    def affords(self, meshes: Sequence[MeshSize], order: int, other: int, inside: bool, beyond: float = 0.0) -> bool:
        """Whether the seconds left, and ``beyond`` more, suffice for ``meshes`` with elements of ``order``, and for
        solving on the last one again with elements of order ``other``; ``inside``: and for displacements inside the
        bodies."""
        return self.allows(self.seconds(meshes, order, other, inside), beyond)

    def seconds(self, meshes: Sequence[MeshSize], order: int, other: int, inside: bool) -> float:
        """Predicted seconds of what :meth:`affords` takes."""
        last, share = meshes[-1], other / order
        again = MeshSize(last.unknowns * share**2, last.nodes * share)
        works = sum(_work(mesh) for mesh in meshes) + _UNMESHED * _work(again) + inside * _work(last)
        marches = sum(_work_of_march(mesh) for mesh in (*meshes, again)) / _work_of_march(self._size)
        return self._seconds / self._work * works + self._march_s * marches

    def allows(self, seconds: float, beyond: float = 0.0) -> bool:
        """Whether so many ``seconds`` are left, and ``beyond`` more."""
        return seconds <= self._clock.remaining() + beyond


def _sampled(at: Array, size: Array, width: float) -> Array:
    """Points of [-``width``, ``width``], (m,), ascending: between those ``at`` which elements have a ``size``, (k,)
    each, evenly in the logarithm of the distance from the nearer one."""
    middles = (at[1:] + at[:-1]) / 2
    shares = np.linspace(0, 1, max(_SAMPLES // max(len(at), 40), 8))
    found = [at]
    for side, ends in ((-1, np.array([-width, *middles])), (1, np.array([*middles, width]))):
        reach = np.abs(ends - at)
        first = np.minimum(size, reach)[:, None]
        found.append((at[:, None] + side * first * (reach[:, None] / first) ** shares).ravel())
    return np.unique(np.clip(np.concatenate(found), -width, width))


def march_ahead(solution: MeshSolution, anew: bool) -> float:
    """Work of contact and friction that the next mesh is expected to take, relative to that on the mesh of
    ``solution`` and without the growth with the nodes. ``anew``: whether the load steps were chosen on that mesh."""
    history = solution.history
    if not history:
        return 1.0
    pressing, steps = _steps(solution, _CYCLES[not (anew and (solution.coupled or history.path.followed))])
    if solution.coupled:
        return min(_WARM * (pressing + steps) / _work_of_steps(solution), 1.0)
    return steps / history.load_steps


def march_in_more_steps(solution: MeshSolution, times: float) -> float:
    """Work of following the load path of coupled bodies in so many ``times`` as many steps, and in twice as many to
    check these, relative to the work of contact and friction of ``solution``."""
    pressing, steps = _steps(solution, _CYCLES[0])
    return _COLD * (2 * pressing + (3 * times + 1) * steps) / _work_of_steps(solution)


def _steps(solution: MeshSolution, cycles: int) -> tuple[int, int]:
    """Number of steps of pressing, and of load steps or legs in at most so many ``cycles``."""
    history = solution.history
    assert history
    in_steps = solution.coupled or (solution.moving and not history.path.followed)  # others go leg by leg
    cycle = sum(map(len, history.path.fractions[1:])) if in_steps else len(history.path.cycle)
    steps = history.load_steps - cycle * max(history.cycles - cycles, 0)
    return solution.pressed.steps if solution.pressed else 0, steps


def _work_of_steps(solution: MeshSolution) -> int:
    """Linear solves and steps of coupled bodies."""
    assert solution.history
    return max(sum(_steps(solution, solution.history.cycles)) + solution.iterations, 1)


def _work_of_march(size: MeshSize) -> float:
    more, power = _MARCH
    return float((size.nodes + more) ** power)


def _work(size: MeshSize) -> float:
    start, power = _FILL
    unknowns, nodes = size
    return float(unknowns * (1 + unknowns / start) ** power + _DENSE * nodes**3 + _FIXED)
