"""One mesh, from its size to the zones found on it. Scaled as in :mod:`partialslip_fem.contact`."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from scipy.interpolate import PPoly

from partialslip.condensed import coupled
from partialslip.condensed.bounded import Solution
from partialslip.condensed.friction import History, Path, march
from partialslip.condensed.zones import Zone, left_end, right_end, stick_zone
from partialslip.result import Array, Clock
from partialslip_fem.condensation import Condensed
from partialslip_fem.contact import Half, press, relative_compliances
from partialslip_fem.elasticity import Body, Indices, body
from partialslip_fem.factor import Backend
from partialslip_fem.farfield import half_plane
from partialslip_fem.mortar import nodal_forces
from partialslip_fem.recovery import traction
from partialslip_meshes import Mesh, block


@dataclass(frozen=True)
class Part:
    """One of the two bodies: its (kappa+1)/(2 mu) in the pair's A, its half-width and height (None: those of a block
    that stands for a half-plane), and the size of its elements, relative to what is asked for."""

    name: str
    kappa: float
    compliance: float
    extent: tuple[float, float] | None
    fineness: float


@dataclass(frozen=True)
class Problem:
    """What is to be solved, scaled: a gap, smooth but for its ``kinks``, and P = 1. Without a ``path`` of loads there
    is no friction to solve; it begins with the tractions p and q of ``start``, if given. ``parts`` are the lower and
    the upper body; of mirror images the lower one alone."""

    gap: Callable[[Array], Array]
    kinks: tuple[float, ...]
    f: float
    path: Path | None
    parts: tuple[Part, ...]
    order: int
    far_field: Literal["half-plane", "box"]
    backend: Backend
    start: tuple[PPoly, PPoly] | None = None


@dataclass(frozen=True)
class Level:
    """The solution on one mesh of each body: of the lower one, and, unless that is mirrored, of the upper one.

    ``nodes`` of the lower one's contact line are in contact at load point 1 or 2, at 2 it is over [left, right], and
    the ends at 1 are ``others``, where they differ. ``factored`` counts the factorisations made for it.
    """

    halves: tuple[Half, ...]
    factored: int
    nodes: Indices
    pressing: Solution
    history: History | None
    left: float
    right: float
    stick: Zone | None
    others: tuple[float, float] | tuple[()] = ()

    @property
    def body(self) -> Body:
        """The lower body: nodal contact forces are those of its nodes."""
        return self.halves[0].body

    @property
    def dofs(self) -> int:
        """Degrees of freedom."""
        return sum(half.body.stiffness.shape[0] for half in self.halves)

    @property
    def ends(self) -> Array:
        """Ends of the contact, at load point 1, too, and of the stick zone: where the next mesh is to be fine."""
        stick = (self.stick.left, self.stick.right) if self.stick else ()
        return np.array([self.left, self.right, *stick, *self.others])

    @property
    def contact_ends(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Ends of the contact at load points 1 and 2."""
        second = self.left, self.right
        return (self.others or second), second

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


_KEPT = 2  # sets of bodies: those of a rough mesh, and of the uniform one made from it
_kept: dict[tuple[object, ...], tuple[Half, ...]] = {}


def solve_level(
    problem: Problem,
    width: float,
    contact: tuple[float, float],
    sizes: Mapping[float, float],
    growth: float,
    clock: Clock,
    along: float | None = None,
    keep: bool = False,
) -> Level:
    """Mesh the bodies, blocks of half-width ``width`` unless they have an extent of their own, and solve on them.

    ``contact``, ``sizes``, ``growth`` and ``along`` are as for :func:`partialslip_meshes.block`. With ``keep`` the
    condensed bodies are kept for other loads, friction and profiles on the same mesh.
    """
    kind = (problem.parts, problem.order, problem.far_field, problem.backend)
    key = (*kind, width, contact, tuple(sizes.items()), growth, along)
    if keep and key in _kept:
        return _level(problem, _kept[key], 0, clock)
    meshes = []
    for part in problem.parts:
        half_width, height = part.extent or (width, width)
        with clock.phase("mesh"):
            finer = {x: size * part.fineness for x, size in sizes.items()}
            everywhere = None if along is None else along * part.fineness
            meshes.append(block(half_width, contact, finer, growth * part.fineness, height, everywhere))
    level = solve_on(meshes, problem, width, clock)
    if keep:
        _kept[key] = level.halves
        for oldest in list(_kept)[:-_KEPT]:
            del _kept[oldest]
    return level


def solve_on(meshes: Sequence[Mesh], problem: Problem, width: float, clock: Clock) -> Level:
    """Solve on meshes of the bodies, in the order of the problem's parts; ``width`` as for :func:`solve_level`."""
    halves = tuple(_half(*pair, problem, width, clock) for pair in zip(meshes, problem.parts, strict=True))
    return _level(problem, halves, len(halves), clock)


def _level(problem: Problem, halves: tuple[Half, ...], factored: int, clock: Clock) -> Level:
    with clock.phase("condensation"):
        relative = relative_compliances(halves)
    with clock.phase("contact"):
        line = halves[0].body
        pressing, history, nodes = _solve(problem, relative, line)
        left, right = _ends(line, pressing.x)
        others: tuple[float, float] | tuple[()] = ()
        if history and len(halves) > 1:
            at_first = np.zeros(len(line.x))
            at_first[nodes] = history.bounds[0]
            others = _ends(line, at_first)
        stick = _stick_zone(line, nodes, history) if history else None
        if stick:  # of both contacts, whatever a coarse mesh makes of its ends
            at_left, at_right = others or (left, right)
            stick = replace(stick, left=max(stick.left, left, at_left), right=min(stick.right, right, at_right))
        return Level(halves, factored, nodes, pressing, history, left, right, stick, others)


def _half(mesh: Mesh, part: Part, problem: Problem, width: float, clock: Clock) -> Half:
    with clock.phase("assembly"):
        held = ("back",) if part.extent else ("back", "sides")
        half = body(mesh, part.kappa, problem.order, part.compliance, held)
    far = None
    if problem.far_field == "half-plane" and not part.extent:
        with clock.phase("far field"):
            far = half_plane(half.held_points, half.x, width, part.kappa, part.compliance)
    with clock.phase("factorisation"):
        return Half(mesh, half, Condensed(half, far, problem.backend))


def _solve(problem: Problem, C: coupled.Relative, line: Body) -> tuple[Solution, History | None, Indices]:
    """Normal forces, the history of the tangential ones on the nodes in contact, and those nodes."""
    gap, path, pressed = problem.gap(line.x), problem.path, None
    if path and problem.start:
        pressed, before = (nodal_forces(line, traction) for traction in problem.start)
        path = replace(path, before=before)
    if path and C.xy is not None:
        history, pressing = coupled.march(C, gap, line.x, problem.f, path, pressed)
        nodes = np.flatnonzero(history.bound > 0)
        return pressing, history.of(nodes), nodes
    pressing = press(C.yy, gap, 1.0)
    nodes = np.flatnonzero(pressing.x > 0)
    if not path:
        return pressing, None, nodes
    if path.before is not None:
        path = replace(path, before=path.before[nodes])
    inner = C.xx[np.ix_(nodes, nodes)]
    return pressing, march(inner, line.x[nodes], problem.f * pressing.x[nodes], path), nodes


def _stick_zone(line: Body, nodes: Indices, history: History) -> Zone:
    def cell_forces(forces: Array) -> Array:
        on_line = np.zeros(len(line.x))
        on_line[nodes] = forces
        return _cell_forces(line, on_line)

    return stick_zone(line.x[nodes], history.bound, history.change, line.x[:: line.order], cell_forces)


def _ends(line: Body, normal: Array) -> tuple[float, float]:
    """Of the contact under nodal normal forces."""
    forces, touching = _cell_forces(line, normal), line.x[normal > 0]
    vertices = line.x[:: line.order]
    return left_end(vertices, forces, touching), right_end(vertices, forces, touching)


def _cell_forces(line: Body, forces: Array) -> Array:
    """Integrals over each cell of the contact line of the traction that belongs to nodal forces."""
    resultant = traction(line, forces).antiderivative()
    return np.diff(resultant(line.x[:: line.order]))
