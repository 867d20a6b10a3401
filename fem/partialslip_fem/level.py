"""One mesh, from its size to the zones found on it. Scaled as in :mod:`partialslip_fem.contact`."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.interpolate import PPoly

from partialslip.condensed.bounded import Solution
from partialslip.condensed.friction import History, Path, march
from partialslip.condensed.zones import Zone, left_end, right_end, stick_zone
from partialslip.result import Array, Clock
from partialslip_fem.condensation import Condensed
from partialslip_fem.contact import press, relative_compliances
from partialslip_fem.elasticity import Body, Indices, body
from partialslip_fem.farfield import FarField, half_plane
from partialslip_fem.recovery import traction
from partialslip_meshes import Mesh, block


@dataclass(frozen=True)
class Problem:
    """What is to be solved, scaled: a gap, smooth but for its ``kinks``, and P = 1. Without a ``path`` of loads there
    is no friction to solve."""

    gap: Callable[[Array], Array]
    kinks: tuple[float, ...]
    f: float
    path: Path | None
    kappa: float
    order: int
    far_field: Literal["half-plane", "box"]


@dataclass(frozen=True)
class Level:
    """The solution on one mesh. ``nodes`` of the contact line are in contact, over [left, right]."""

    mesh: Mesh
    body: Body
    condensed: Condensed
    far_field: FarField | None
    nodes: Indices
    pressing: Solution
    history: History | None
    left: float
    right: float
    stick: Zone | None

    @property
    def ends(self) -> Array:
        """Ends of the contact and of the stick zone: where the next mesh is to be fine."""
        return np.array([self.left, self.right, *((self.stick.left, self.stick.right) if self.stick else ())])

    @property
    def enclosed(self) -> bool:
        """Whether the contact ends within the contact line."""
        return bool(self.pressing.x[0] == 0 == self.pressing.x[-1])

    @property
    def half_width(self) -> float:
        """Contact half-width."""
        return (self.right - self.left) / 2

    @property
    def iterations(self) -> int:
        """Faces solved, for normal contact and friction."""
        return self.pressing.iterations + (self.history.iterations if self.history else 0)

    def pressure(self) -> PPoly:
        """p along the contact line."""
        return traction(self.body, self.pressing.x)

    def shear(self, forces: Array) -> PPoly:
        """q along the contact line that belongs to tangential forces of the nodes in contact."""
        return traction(self.body, self.on_line(forces))

    def on_line(self, values: Array) -> Array:
        """Values of the nodes in contact, as those of the whole line, zero elsewhere."""
        result = np.zeros(len(self.body.x))
        result[self.nodes] = values
        return result


def solve_level(
    problem: Problem,
    width: float,
    contact: tuple[float, float],
    sizes: Mapping[float, float],
    growth: float,
    clock: Clock,
) -> Level:
    """Mesh a block of half-width ``width`` (:func:`partialslip_meshes.block`) and solve on it."""
    with clock.phase("mesh"):
        mesh = block(width, contact, sizes, growth)
    return solve_on(mesh, problem, width, clock)


def solve_on(mesh: Mesh, problem: Problem, width: float, clock: Clock) -> Level:
    """Solve on a mesh of the block of half-width ``width``."""
    with clock.phase("assembly"):
        half = body(mesh, problem.kappa, problem.order)
    with clock.phase("factorisation"):
        condensed = Condensed(half)
    with clock.phase("far field"):
        outer = half_plane(half.far_points, half.x, width, problem.kappa) if problem.far_field == "half-plane" else None
        tangential, normal = relative_compliances(half, condensed, outer)
    with clock.phase("contact"):
        pressing = press(normal, problem.gap(half.x), 1.0)
        nodes = np.flatnonzero(pressing.x > 0)
        bound = problem.f * pressing.x[nodes]
        inner = tangential[np.ix_(nodes, nodes)]
        history = march(inner, half.x[nodes], bound, problem.path) if problem.path else None
        forces = _cell_forces(half, pressing.x)
        return Level(
            mesh, half, condensed, outer, nodes, pressing, history,
            left=left_end(half.x[:: half.order], forces, half.x[nodes]),
            right=right_end(half.x[:: half.order], forces, half.x[nodes]),
            stick=_stick_zone(half, nodes, bound, history) if history else None,
        )  # fmt: skip


def _stick_zone(half: Body, nodes: Indices, bound: Array, history: History) -> Zone:
    def cell_forces(forces: Array) -> Array:
        on_line = np.zeros(len(half.x))
        on_line[nodes] = forces
        return _cell_forces(half, on_line)

    return stick_zone(half.x[nodes], bound, history.change, half.x[:: half.order], cell_forces)


def _cell_forces(half: Body, forces: Array) -> Array:
    """Integrals over each cell of the contact line of the traction that belongs to nodal forces."""
    resultant = traction(half, forces).antiderivative()
    return np.diff(resultant(half.x[:: half.order]))
