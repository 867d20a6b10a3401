"""What an accuracy requires of the mesh: element sizes at the ends of zones, growth, round faces and corners.

The constants of this module, of :mod:`partialslip_fem.adapt` and of :mod:`partialslip_fem.grading` change the cost of a
run. They do not enter its error estimates, except ``_NEIGHBOUR`` there, and ``_FACET_SHARE``, ``_OF_FACETS``,
``_CORNER_ERROR`` and ``_TILTS``, which are added to these. Scripts that measure the constants are named where there are
any.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from partialslip.result.refining import worst
from partialslip.tools.arrays import Array
from partialslip.tools.bars import BARS
from partialslip_fem import estimate
from partialslip_fem.bodies import Grading
from partialslip_fem.mesh_solution import MeshSolution
from partialslip_fem.problem import ScaledProblem
from partialslip_meshes import Eased

# limit: Bounds on element sizes at the ends of zones, in contact half-widths.
FINEST = 1e-7  # limit: smallest: with smaller elements rounding errors dominate (benchmarks/accuracy.py floor)
COARSEST = 0.005  # cost: largest on a mesh whose errors are estimated; coarser meshes only locate the ends
FINER = 16.0  # cost: largest ratio of these sizes from mesh to mesh

# cost: Growth of the elements away from the ends: errors there are about (growth/2.8)^(2 order)
# (compare benchmarks/accuracy.py orders).
_SMOOTH = 2.8
_LARGEST_GROWTH = 0.7
ON_THE_WAY = 4  # cost: largest order on meshes before that with the element size of the goal
_EASED_BELOW = 3e-6  # cost: error away from the ends from which on growth is the same everywhere
_STEEPEST = 1.0  # cost: largest growth near the ends of zones, where it may be larger than elsewhere

# cost: Shares of the accuracy asked for.
# cost: error that meshes are designed for: estimates are right within a factor of two (benchmarks/estimates.py)
AIM = 0.5
BAR = 0.9  # limit: largest estimate that is accepted
_AWAY_SHARE = 0.5  # cost: of AIM: error away from the ends ...
# cost: ... and the same, by order, if elements grow faster near the ends of zones than elsewhere, which adds to it.
_EASED_SHARE = {4: 0.2, 6: 0.1}
_END_SHARE = 0.33  # cost: of AIM: largest error due to the elements at the ends
_FACET_SHARE = 0.25  # accuracy: largest distance of a round face from the elements
# accuracy: errors of ends due to a round face, in that distance. Pressure moves a surface as it moves one that is
# parallel to it: to first order, chords do not change the contact. Measured on four pads (R = 20 a): chords twice as
# long move a and the ends by up to 0.15 of the distance at accuracies of 1e-3 and 1e-4, and m and n by 0.1 to 1.1; at
# 2e-5 by up to 0.7 and 4, of which an unknown part is due to meshes that differ otherwise
_OF_FACETS = {"a": 0.25, "left": 0.25, "right": 0.25, "m": 1.0, "n": 1.0}
# accuracy: largest change of the contact due to elements at corners, as a multiple of the accuracy ...
_CORNER_ERROR = 10.0
LOOSEST = 1e-2  # limit: ... and absolute
# accuracy: Errors at the contact per change due to the corners of blocks.
_TILTS = {"left": 1e-3, "right": 1e-3, "p": 5e-3, "q": 5e-3, "q1": 5e-3, "q2": 5e-3}

_SWEPT = (0.2, 8e-3, 0.1)  # cost: element size, and bar of q, for which it suffices; largest element size

# cost: Element size at kinks that q has at single load points only, over the root of the accuracy: they move the ends
# of the stick zone by the square of that size.
PASSING = 20.0

_KNOWN = 0.3  # cost: error away from the ends on the way to smaller elements there, in the next mesh's element size
_NO_GAP = 1e-100  # accuracy: distance of zone ends that coincide: element sizes are divided by it
_REACHED = 1.01  # cost: element sizes within this factor of the goal count as having reached it


class OutlineErrors(NamedTuple):
    """Errors of a mesh at round faces and corners: ``facet_error`` and ``corner_error`` as for
    :class:`partialslip_fem.bodies.Grading`, and the ``errors`` at the contact that these leave, by key."""

    facet_error: float
    corner_error: float
    errors: Mapping[str, float]

    @classmethod
    def at(cls, accuracy: float, problem: ScaledProblem, mesh: "NextMesh | None" = None) -> "OutlineErrors":
        """Errors of facets and corners that ``accuracy`` allows in ``problem``; on an intermediate ``mesh``, coarser
        facets suffice: facet_error is in proportion to the error away from the zone ends."""
        found = max(_KNOWN * mesh.size / mesh.finer / (_AWAY_SHARE * AIM), accuracy) if mesh else accuracy
        corner_error = min(_CORNER_ERROR * accuracy, LOOSEST)
        tilting = any(part.extent for part in problem.parts)
        facet_error = _FACET_SHARE * found if any(part.face for part in problem.parts) else 0.0
        errors = {
            key: _TILTS.get(key, 0.0) * corner_error * tilting + _OF_FACETS.get(key, 0.0) * facet_error
            for key in _TILTS | _OF_FACETS
        }
        return cls(facet_error, corner_error, errors)


class NextMesh(NamedTuple):
    """Element size at the ends in contact half-widths, ``growth`` away from them, and by which factor the elements at
    the ends are ``finer`` than on the mesh before."""

    size: float
    growth: float
    finer: float


class MeshPlan(NamedTuple):
    """Plan of the next ``mesh``: elements of ``order``, whose size at the zone ends is on the way to ``enough``, and
    the errors of its ``outline``, round faces and corners."""

    mesh: NextMesh
    order: int
    enough: float
    outline: OutlineErrors

    @property
    def arrived(self) -> bool:
        """Whether the elements at the ends are as small as is enough."""
        return size_reached(self.mesh.size, self.enough)


@dataclass(frozen=True)
class Goal:
    """What one ``accuracy`` requires of the mesh and of the estimated errors.

    Parameters
    ----------
    accuracy : float
    bar : float
        Largest estimated error.
    end_error : float
        Largest error due to the elements at the ends.
    growth : float
        Growth of the elements for which the error away from the ends is small enough.
    outline : OutlineErrors
        Allowed errors of round faces and corners.
    """

    accuracy: float
    bar: float
    end_error: float
    growth: float
    outline: OutlineErrors

    @classmethod
    def at(cls, accuracy: float, problem: ScaledProblem) -> "Goal":
        """Bars, element growth and outline errors that ``accuracy`` requires in ``problem``."""
        return cls(
            accuracy=accuracy,
            bar=BAR * accuracy,
            end_error=_END_SHARE * AIM * accuracy,
            growth=growth_at(accuracy, problem.order),
            outline=OutlineErrors.at(accuracy, problem),
        )

    def element_size(self, solution: MeshSolution, problem: ScaledProblem) -> float:
        """Element size at the ends that suffices, in contact half-widths."""
        size = self.end_error / worst(estimate.end_errors(solution, *_far_apart(solution)))
        size = min(size, estimate.stick_element_size(solution, gaps(solution, problem), self.end_error))
        return min(max(size, FINEST), COARSEST / 2)

    def plan(self, before: MeshPlan, solution: MeshSolution, problem: ScaledProblem, least: float) -> MeshPlan:
        """The mesh after that of ``before`` and its ``solution``; with elements of the same size where the contact line
        cut the contact. ``least`` as for :func:`next_mesh`."""
        order, (size, _, finer), enough = problem.order, before.mesh, self.element_size(solution, problem)
        mesh = next_mesh(size, finer, enough, least, order)
        if order > ON_THE_WAY and not size_reached(mesh.size, enough):
            order = ON_THE_WAY
            mesh = next_mesh(size, finer, enough, growth_at(self.accuracy, order), order)
        if not solution.enclosed:
            return before._replace(order=order, enough=enough)
        on_the_way = None if size_reached(mesh.size, enough) else mesh
        return MeshPlan(mesh, order, enough, OutlineErrors.at(self.accuracy, problem, on_the_way))


def swept_size(accuracy: float) -> float:
    """Element size for an ``accuracy``, as a part of the width over which sticking surfaces come into contact; the
    error of q falls like size^1.5."""
    return float(min(_SWEPT[0] * (BARS["q"] * accuracy / _SWEPT[1]) ** (2 / 3), _SWEPT[2]))


def swept(solution: MeshSolution, accuracy: float) -> list[tuple[float, float, float]]:
    """Intervals in which surfaces that stick come into contact, and the element size there: what is locked in depends
    on the distance of the nodes."""
    share = swept_size(accuracy)
    return [(low, high, (high - low) * share) for low, high in solution.swept]


def at_kinks_of_friction(
    solution: MeshSolution, problem: ScaledProblem, accuracy: float, grading: Grading, coarsest: float
) -> dict[float, float]:
    """Element sizes at kinks of the coefficient of friction that leave an error within an element, of the ``coarsest``
    body. A vertex there suffices, and elements are hardly larger than the distance of two kinks."""
    a, (places, jumps) = solution.half_width, problem.friction_kinks
    inside = (places > grading.contact[0]) & (places < grading.contact[1])
    size = grading.at(places) * coarsest / a
    inside &= jumps * a * size**2 > accuracy
    kept, sizes = places[inside], size[inside] * a
    between = np.diff(kept, prepend=-np.inf, append=np.inf)
    sizes = np.minimum(sizes, np.minimum(between[1:], between[:-1]))
    return dict(zip(kept.tolist(), (sizes / coarsest).tolist(), strict=True))


def size_reached(size: float, goal: float) -> bool:
    """Whether the element ``size`` is as small as the ``goal``."""
    return size <= _REACHED * goal


def next_mesh(size: float, finer: float, goal: float, least: float, order: int) -> NextMesh:
    """The next mesh on the way from element ``size`` at the ends to ``goal``.

    Parameters
    ----------
    size, goal : float
        In contact half-widths.
    finer : float
        Refinement, if ``size`` has reached ``goal``; otherwise equal steps of at most ``FINER``.
    least : float
        Growth of the last mesh; that of meshes before follows from the element size of the next one.
    order : int
        Polynomial order of the elements.
    """
    if not size_reached(size, goal):
        finer = (size / goal) ** (1 / math.ceil(math.log(size / goal, FINER)))
    size = max(size / finer, FINEST)
    growth = least if size_reached(size, goal) else max(least, growth_for(_KNOWN * size / finer, order))
    return NextMesh(size, growth, finer)


def growth_for(error: float, order: int) -> float:
    """Growth for which elements of ``order`` leave about ``error`` away from the ends."""
    return float(min(_SMOOTH * error ** (0.5 / order), _LARGEST_GROWTH))


def growth_at(accuracy: float, order: int) -> float:
    """Growth of elements of ``order`` far from the ends for an ``accuracy``."""
    if order in _EASED_SHARE:
        growth = growth_for(_EASED_SHARE[order] * AIM * accuracy, order)
        if growth < growth_for(_EASED_BELOW, order):
            return growth
    return growth_for(_AWAY_SHARE * AIM * accuracy, order)


def eased(solution: MeshSolution, problem: ScaledProblem, order: int, growth: float) -> Eased | None:
    """Faster growth of elements of ``order`` near the zone ends than ``growth`` far away; None if growth is the same.

    An end of a zone depends on elements of size h at the distance r like (h/r)^(2 order) r^2, as long as tractions vary
    over the contact half-width. Beside a kink of the profile they vary over its distance from the contact edge: corners
    of punches carry large parts of p and q. Where zone ends wander, tractions are not smooth.
    """
    if order not in _EASED_SHARE or growth >= growth_for(_EASED_BELOW, order) or solution.wanders:
        return None
    return Eased(_STEEPEST, min(solution.half_width, corner(solution, problem)), 1 / order)


def corner(solution: MeshSolution, problem: ScaledProblem) -> float:
    """Least distance of a kink of the profile in the contact from an end of the contact; infinite without kinks."""
    kinks = np.array([kink for kink in problem.kinks if solution.left < kink < solution.right])
    return float(np.minimum(kinks - solution.left, solution.right - kinks).min(initial=np.inf))


def gaps(solution: MeshSolution, problem: ScaledProblem) -> Array:
    """Distances of each zone end to the zone ends, kinks of the profile and of the coefficient of friction, and points
    where slip reverses beside it, (2, k), in contact half-widths.

    Row 0: from each end of the stick zone to the other end of the stick zone; infinite for other ends. Row 1: to the
    nearest of all other ends and kinks.
    """
    kinks = [*problem.kinks, *problem.sharp_kinks(solution.half_width), *solution.turning]
    apart = np.abs(solution.zone_ends[:, None] - np.array([*solution.zone_ends, *kinks]))
    np.fill_diagonal(apart, np.inf)
    across = np.full(len(solution.zone_ends), np.inf)
    if solution.stick:
        across[2:4] = apart[2, 3]
        apart[2, 3] = apart[3, 2] = np.inf
    return np.maximum(np.array([across, apart.min(axis=1)]) / solution.half_width, _NO_GAP)


def _far_apart(solution: MeshSolution) -> tuple[Array, Array, Array, Array]:
    """Arguments of ``end_errors`` for elements as large as the contact half-width at ends that are far apart and at
    vertices."""
    count = len(solution.zone_ends)
    return np.ones(count), np.zeros(count), np.full((2, count), np.inf), np.zeros(len(solution.kinks))
