"""The solution on one mesh of each body. Scaled as in :mod:`partialslip_fem.problem`."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
from scipy.interpolate import PPoly

from partialslip.friction.active_set import Solution, spread
from partialslip.friction.contact_line import common_ends
from partialslip.friction.coupled_step import Relative
from partialslip.friction.history import History
from partialslip.friction.pressing import Pressed
from partialslip.friction.warm_start import Trail
from partialslip.friction.zone_ends import StickInterval
from partialslip.tools.arrays import Array, Indices
from partialslip_fem.contact import CondensedBody
from partialslip_fem.elasticity import DiscreteBody
from partialslip_fem.recovery import traction

# accuracy: mean traction of an open node, relative to the largest: rounding of the mass matrix's inverse
_TOUCHES = 1e-9


@dataclass(frozen=True)
class ContactForces:
    """Contact forces along the load path, on nodes of the lower contact line.

    Parameters
    ----------
    nodes : (k,) int array
        Nodes of the lower contact line that are in contact at load point 1 or 2.
    pressing : Solution
        Normal forces on all nodes of the contact line, at load point 2.
    most : (n,) array
        The largest normal forces on the path, on all nodes of the contact line.
    history : History or None
        Tangential forces on ``nodes`` along the load path; None without friction.
    first : (n,) array or None
        Normal forces on all nodes of the contact line at load point 1, where the pressure varies or bodies are coupled.
    pressed : Pressed or None
        How coupled bodies were pressed together before the load path.
    step_errors : mapping of str to float
        Errors of the load steps (:mod:`partialslip.friction.step_errors`), where they were asked for.
    path_errors : mapping of str to float
        The same of the load path of coupled bodies, besides the steps in which they were pressed together.
    path_moves : (2, 2) array
        Errors of the displacement of the plates, and of Q, at load points 1 and 2 (columns), of the same load path.
    trail : Trail or None
        Which nodes of coupled bodies touch and slip in each step.
    """

    nodes: Indices
    pressing: Solution
    most: Array
    history: History | None = None
    first: Array | None = None
    pressed: Pressed | None = None
    step_errors: Mapping[str, float] = field(default_factory=dict)
    path_errors: Mapping[str, float] = field(default_factory=dict)
    path_moves: Array = field(default_factory=lambda: np.zeros((2, 2)))
    trail: Trail | None = None

    @property
    def slips_when_pressed(self) -> bool:
        """Whether coupled bodies slipped while P alone acted on them and no load cycle follows.

        The stick zone is then where the bodies stuck throughout.
        """
        still = self.history is not None and not self.history.path.moves
        return bool(still and self.pressed and self.pressed.slipped())

    @property
    def iterations(self) -> int:
        """Linear solves of the active-set iterations for normal contact and friction."""
        return self.pressing.iterations + (self.history.iterations if self.history else 0)


@dataclass(frozen=True)
class Zones:
    """Contact and stick zone.

    Parameters
    ----------
    left, right : float
        Ends of the contact at load point 2.
    ends_at_1 : (float, float) or ()
        Ends of the contact at load point 1, if they can differ from those at load point 2.
    fits : (e,) array
        Distances between the ends of the contact that many and few vertices of the mesh tell, of the 2 ends at load
        point 2 and the ``ends_at_1``: errors of the fit.
    stick : StickInterval or None
        Stick zone, if there is one.
    kinks : tuple of float
        Points where q1 or q2, but not q2 - q1, has a kink, besides the ends of the stick zone.
    passing : tuple of float
        Points where q has a kink at single load points, but neither q1 nor q2 has.
    """

    left: float
    right: float
    ends_at_1: tuple[float, float] | tuple[()]
    fits: Array
    stick: StickInterval | None
    kinks: tuple[float, ...]
    passing: tuple[float, ...]

    @property
    def zone_ends(self) -> Array:
        """Points to refine at: ends of the contact at load point 2, of the stick zone, of the contact at load point
        1."""
        stick = (self.stick.left, self.stick.right) if self.stick else ()
        return np.array([self.left, self.right, *stick, *self.ends_at_1])

    @property
    def contact_end_places(self) -> tuple[list[int], list[int]]:
        """Indices in ``zone_ends`` of the left and of the right ends of the contact."""
        count = len(self.zone_ends)
        return ([0, count - 2], [1, count - 1]) if self.ends_at_1 else ([0], [1])

    @property
    def contact_ends(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Ends of the contact at load points 1 and 2."""
        second = self.left, self.right
        return (self.ends_at_1 or second), second


@dataclass(frozen=True, kw_only=True)
class MeshSolution(ContactForces, Zones):
    """Contact forces and zones on one mesh of each body.

    Parameters
    ----------
    bodies : tuple of CondensedBody
        The lower and the upper body; one entry if the bodies are mirror images.
    factored : int
        Factorisations made for this solution.
    relative : Relative or None
        Compliances of the nodes of the contact line, of two finite bodies.
    coupled : bool
        Whether p and q were solved together.
    dissimilar : bool
        Whether shear moves surfaces along y as it does in half-planes of dissimilar materials (Dundurs' beta is not 0).
    moving : bool
        Whether the pressure varies.
    largest : int
        Load point with the larger P, 1 or 2, whose contact scales the results.
    """

    bodies: tuple[CondensedBody, ...]
    factored: int
    relative: Relative | None
    coupled: bool
    dissimilar: bool
    moving: bool
    largest: int

    def slipping(self, x: Array) -> npt.NDArray[np.int8] | None:
        """Signs of slip at ``x`` (k,) under loads that grow from nothing, 0 where the surfaces stick; None without
        friction. Where no node slips, an end of the stick zone is one of the contact, but for rounding."""
        if not self.stick or not self.history:
            return None
        first, last = self.history.slips[[0, -1]]
        sides = first & (x < self.stick.left), last & (x > self.stick.right)
        return np.select(sides, self.stick.signs, 0).astype(np.int8)

    @property
    def wanders(self) -> bool:
        """Whether ends of the stick zone move over parts of the contact where no zone ends at a load point: slip
        reverses on the way, or the loads are out of phase. Kinks of q are locked in there, far from the points that
        meshes are graded to. Not known for coupled bodies, nor out of phase where the pressure varies."""
        if not self.history or self.coupled:
            return False
        return self.history.turns or not (self.moving or self.history.path.in_phase)

    @property
    def turning(self) -> list[float]:
        """Points where an end of the stick zone reversed: kinks of q, beside which the ends of the stick zone are
        uncertain."""
        return self.history.turning(self.lower.x[self.nodes]) if self.history else []

    @property
    def lower(self) -> DiscreteBody:
        """The lower body. Nodal contact forces act on the nodes of the lower contact line."""
        return self.bodies[0].body

    @property
    def dofs(self) -> int:
        """Degrees of freedom of all bodies."""
        return sum(each.body.unknowns for each in self.bodies)

    def element_sizes(self, points: Array) -> Array:
        """Sizes of the elements of the contact line that ``points`` (k,) lie in, (k,): each the mean of an element
        and its two neighbours, which matter where elements grow fast."""
        vertices = self.lower.x[:: self.lower.order]
        cells = np.searchsorted(vertices, points)[:, None] + np.arange(-2, 1)
        return np.diff(vertices)[np.clip(cells, 0, len(vertices) - 2)].mean(axis=1)

    def inside(self, points: Array) -> Array:
        """Distances of ``points`` (k,) from the nearest vertices, in the elements that they lie in, (k,): 0 to 0.5."""
        vertices = self.lower.x[:: self.lower.order]
        after = np.clip(np.searchsorted(vertices, points), 1, len(vertices) - 1)
        share = (points - vertices[after - 1]) / (vertices[after] - vertices[after - 1])
        nearest: Array = np.clip(np.minimum(share, 1 - share), 0.0, 0.5)
        return nearest

    @property
    def enclosed(self) -> bool:
        """Whether the contact ends within the contact line, on the whole path."""
        return bool(self.most[0] == 0 == self.most[-1])

    @property
    def reach(self) -> tuple[float, float]:
        """Ends of the contact at load point 2; of all that touches on the load path where the contact moves, as it does
        with Q between coupled bodies."""
        if not (self.moving or self.coupled):
            return self.left, self.right
        ends, touched = np.array(self.contact_ends), self.lower.x[self.most > 0]
        return min(float(ends.min()), float(touched[0])), max(float(ends.max()), float(touched[-1]))

    @property
    def pieces(self) -> int:
        """Number of pieces of the contact that are an element or more apart."""
        touching = np.lib.stride_tricks.sliding_window_view(self.pressing.x > 0, self.lower.order + 1)
        cells = touching[:: self.lower.order].any(axis=1)
        return int((np.diff(cells.astype(np.int8), prepend=0) == 1).sum())

    @property
    def common(self) -> tuple[float, float] | None:
        """Ends of what is in contact at both load points; None where the pressure is constant."""
        return common_ends(self.contact_ends) if self.moving else None

    @property
    def swept(self) -> list[tuple[float, float]]:
        """Intervals between the ends of the contacts at load points 1 and 2 beside which the surfaces stick."""
        if not (self.moving and self.stick):
            return []
        (left1, right1), (left2, right2) = self.contact_ends
        sides = (
            (min(left1, left2), max(left1, left2), self.stick.left <= max(left1, left2)),
            (min(right1, right2), max(right1, right2), self.stick.right >= min(right1, right2)),
        )
        return [(low, high) for low, high, sticks in sides if sticks and low < high]

    @property
    def half_width(self) -> float:
        """Contact half-width at load point 2, or at that with the larger P."""
        left, right = self.contact_ends[self.largest - 1]
        return (right - left) / 2

    def pressure(self) -> PPoly:
        """p along the contact line at load point 2."""
        return traction(self.lower, self.pressing.x)

    def pressures(self) -> tuple[PPoly, PPoly] | None:
        """p at load points 1 and 2; None if p is the same at both."""
        return None if self.first is None else (traction(self.lower, self.first), self.pressure())

    def tension(self) -> float:
        """Largest -p at both load points in cells of which, as of the cells on both sides, all nodes are pressed; 0 if
        there is none. Only the part of -p counts by which p is below the straight line that fits p in the cell: p
        oscillates there. In the last cells of a contact the error of the mesh makes p negative, in others rounding
        only: nodal forces of a traction that oscillates within the cells may still be positive. Beside a peak narrower
        than a cell the traction recovered from the forces is negative without such an oscillation."""
        order, both = self.lower.order, self.pressures()
        straight = np.vander(self.lower.x[: order + 1] - self.lower.x[0], 2)
        fit = straight @ np.linalg.pinv(straight)
        tractions = both or (self.pressure(),)
        most = 0.0
        for pressure in tractions:
            values = pressure(self.lower.x)
            touching = np.abs(self.lower.mass @ values) > _TOUCHES * self.lower.weights * np.abs(values).max()
            inner = np.lib.stride_tricks.sliding_window_view(touching, 3 * order + 1)[::order].all(axis=1)
            cells = np.lib.stride_tricks.sliding_window_view(values, order + 1)[order:-order:order][inner]
            most = max(most, float(np.minimum(-cells, cells @ fit.T - cells).max(initial=0.0)))
        return most

    def shear(self, forces: Array) -> PPoly:
        """Traction along the contact line that is equivalent to ``forces`` (k,) on the nodes in contact."""
        return traction(self.lower, self.on_line(forces))

    @property
    def forces(self) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        """Nodal forces along x and across on the contact line, (n,) each, at load points 1 and 2."""
        second = self.pressing.x
        if not self.history:
            first = second if self.first is None else self.first
            return (0 * first, first), (0 * second, second)
        at_1, at_2 = zip(self.history.at_ends, self.history.pressures, strict=True)
        return (self.on_line(at_1[0]), self.on_line(at_1[1])), (self.on_line(at_2[0]), self.on_line(at_2[1]))

    def on_line(self, values: Array) -> Array:
        """Extend ``values`` (k,) on the nodes in contact by zeros to the whole contact line, (n,)."""
        return spread(values, self.nodes, len(self.lower.x))


@dataclass(frozen=True)
class Adapted:
    """The solution on the last mesh, with error estimates and the work on all meshes.

    Parameters
    ----------
    solution : MeshSolution
    errors : dict of float
        Estimated errors: ends in contact half-widths, tractions relative. Empty if nothing was refined.
    meshes, factorizations, iterations : int
        Numbers of meshes, factorisations and linear solves of the active-set iterations.
    width : float
        Half-width of blocks that stand for half-planes, in contact half-widths.
    settled : float or None
        Accuracy that the allowance of CPU seconds sufficed for; None without an allowance.
    plates_error : float or None
        Estimated error of the compliance of the plates, relative.
    other : History or None
        Of elements of the neighbouring order on the same mesh; None if there is none.
    """

    solution: MeshSolution
    errors: dict[str, float]
    meshes: int
    factorizations: int
    iterations: int
    width: float
    settled: float | None = None
    plates_error: float | None = None
    other: History | None = None
