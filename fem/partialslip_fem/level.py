"""One mesh, from its size to the zones found on it. Scaled as in :mod:`partialslip_fem.contact`."""

import math
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Literal

import numpy as np
from scipy.interpolate import PPoly

from partialslip.arrays import Array, Indices
from partialslip.bars import BARS
from partialslip.condensed import coupled, step_errors
from partialslip.condensed.bounded import Solution
from partialslip.condensed.coupled import Pressed
from partialslip.condensed.ends import StickInterval, apart, finest, kinks, left_end, right_end, stick_zone
from partialslip.condensed.history import History
from partialslip.condensed.path import Path
from partialslip.condensed.steps import march_refined
from partialslip.errors import InputError
from partialslip.result import Clock
from partialslip.scene import Profile
from partialslip_fem.condensation import Condensed
from partialslip_fem.contact import Half, press, relative_compliances
from partialslip_fem.corners import free_exponent, held_exponent, size
from partialslip_fem.elasticity import ALL_AROUND, Body, Held, body
from partialslip_fem.factor import Backend
from partialslip_fem.farfield import half_plane
from partialslip_fem.mortar import nodal_forces
from partialslip_fem.recovery import traction
from partialslip_meshes import Corner, Mesh, block

Support = Literal["clamped", "roller", "sides"]
_HELD: dict[Support, Held] = {
    "clamped": (("back",), ("back",)),
    "roller": (("left", "right"), ("back",)),
    "sides": (("left", "right"), ("left", "right")),
}


@dataclass(frozen=True)
class Face:
    """How far a pad's face lies back at x, in lengths of ``length`` (m)."""

    profile: Profile
    length: float

    def __call__(self, x: Array) -> Array:
        result: Array = self.profile.face_at(x * self.length) / self.length
        return result

    @property
    def radius(self) -> float:
        """Of its curvature."""
        return self.profile.R / self.length


@dataclass(frozen=True)
class Part:
    """One of the two bodies: its (kappa+1)/(2 mu) in the pair's A; and the size of its elements, relative to what is
    asked for.

    It is a block with half-widths and heights ``extent`` and ``holder``, and ``face`` if that is not flat; or a
    ``mesh``; without either, a block that stands for a half-plane.
    """

    name: str
    kappa: float
    compliance: float
    fineness: float = 1.0
    extent: tuple[float, float] | None = None
    holder: tuple[float, float] | None = None
    face: Face | None = None
    mesh: Mesh | None = None
    support: Support = "clamped"
    pulled: bool = False

    @property
    def finite(self) -> bool:
        """Whether it stands for itself."""
        return self.extent is not None or self.mesh is not None

    @property
    def held(self) -> Held:
        """Lines that are held along x, and along y."""
        if not self.finite:
            return ALL_AROUND, ALL_AROUND
        along_x, along_y = (
            [line for line in lines if line != "right" or not self.pulled] for lines in _HELD[self.support]
        )
        return along_x, along_y

    def corners(self, tolerance: float) -> dict[Corner, float]:
        """Element sizes at the corners that disturb, of a block: the size of what is at the contact is then known to
        about ``tolerance``, relative."""
        assert self.extent
        width, height = self.extent
        across, (low, deep) = math.pi / 2, self.holder or self.extent
        held = set(self.held[0]) & set(self.held[1])
        found: dict[Corner, float] = {}
        if held:  # a held side meets a free one
            found["foot"] = held_exponent(across, self.kappa)
        if held - {"back"}:
            angle = across if not self.holder or low > width else 3 * across if low < width else 2 * across
            found["shoulder"] = held_exponent(angle, self.kappa)
        if self.holder and low != width and ("shoulder" not in found or low > width):
            found["notch"] = free_exponent(3 * across)
        least = min(width, height, low, deep)
        return {corner: least * size(tolerance, exponent) for corner, exponent in found.items()}


@dataclass(frozen=True)
class Problem:
    """What is to be solved, scaled: a gap, smooth but for its ``kinks``, and P = 1. Without a ``path`` of loads there
    is no friction to solve, and ``strain`` is due to the tension at load point 2; the path begins with the tractions p
    and q of ``start``, if given. ``parts`` are the lower and the upper body; of mirror images the lower one alone. Only
    if they are ``coupled`` do pressure and shear act across. ``inside`` says whether what is inside them will be asked
    for."""

    gap: Callable[[Array], Array]
    kinks: tuple[float, ...]
    f: float
    path: Path | None
    parts: tuple[Part, ...]
    order: int
    far_field: Literal["half-plane", "box"]
    backend: Backend
    start: tuple[PPoly, PPoly] | None = None
    coupled: bool = True
    inside: bool = True
    strain: float = 0.0
    similar: bool = False
    accuracy: float = 1e-3

    @property
    def meshed(self) -> bool:
        """Whether the meshes of all bodies are given."""
        return all(part.mesh for part in self.parts)


@dataclass(frozen=True)
class Level:
    """The solution on one mesh of each body: of the lower one, and, unless that is mirrored, of the upper one.

    ``nodes`` of the lower one's contact line are in contact at load point 1 or 2, at 2 it is over [left, right], and
    the ends at 1 are ``others``, where they differ. ``kinks`` are points where q1 or q2 is not smooth, beside the ends
    of the stick zone, while the change of q is. ``factored`` counts the factorisations made for it; pressure and
    shear are solved together where bodies are ``coupled``. ``stepped`` is what the steps make it off by
    (:mod:`partialslip.condensed.step_errors`), where that was asked for.
    """

    halves: tuple[Half, ...]
    factored: int
    nodes: Indices
    pressing: Solution
    history: History | None
    left: float
    right: float
    stick: StickInterval | None
    others: tuple[float, float] | tuple[()] = ()
    kinks: tuple[float, ...] = ()
    coupled: bool = False
    pressed: Pressed | None = None
    stepped: Mapping[str, float] = field(default_factory=dict)

    @property
    def slips_when_pressed(self) -> bool:
        """Whether no load cycle acts, and coupled bodies have slipped while they were pressed: the stick zone is then
        where they stuck all through."""
        still = self.history is not None and not self.history.path.moves
        return bool(still and self.pressed and self.pressed.slipped())

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
    def contact_at(self) -> tuple[list[int], list[int]]:
        """Which of the ``ends`` are left, and which are right ends of the contact."""
        count = len(self.ends)
        return ([0, count - 2], [1, count - 1]) if self.others else ([0], [1])

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
    def pieces(self) -> int:
        """Of the contact, an element or more apart."""
        touching = np.lib.stride_tricks.sliding_window_view(self.pressing.x > 0, self.body.order + 1)
        cells = touching[:: self.body.order].any(axis=1)
        return int((np.diff(cells.astype(np.int8), prepend=0) == 1).sum())

    @property
    def half_width(self) -> float:
        """Contact half-width."""
        return (self.right - self.left) / 2

    @property
    def iterations(self) -> int:
        """Faces solved, for normal contact and friction."""
        return self.pressing.iterations + (self.history.iterations if self.history else 0)

    def pressure(self) -> PPoly:
        """p along the contact line, at load point 2."""
        return traction(self.body, self.pressing.x)

    def pressures(self, f: float) -> tuple[PPoly, PPoly] | None:
        """p at load points 1 and 2, where they differ."""
        if not self.history or not self.coupled:
            return None
        first, second = (self.shear(bound / f) for bound in self.history.bounds)
        return first, second

    def shear(self, forces: Array) -> PPoly:
        """q along the contact line that belongs to tangential forces of the nodes in contact."""
        return traction(self.body, self.on_line(forces))

    def on_line(self, values: Array) -> Array:
        """Values of the nodes in contact, as those of the whole line, zero elsewhere."""
        result = np.zeros(len(self.body.x))
        result[self.nodes] = values
        return result


_ROUNDING = 1e-9  # of a contact line's length
_ONE = 1e-3  # of the half-width: kinks of q that are nearer to each other are one
_KEPT = 2  # sets of bodies: those of a rough mesh, and of the uniform one made from it


class Kept(threading.local):
    """Condensed bodies of the last meshes, for runs with other loads, friction or profiles on the same meshes.

    Whoever wants them kept makes one and passes it to each run. Each thread has bodies of its own in it.
    """

    def __init__(self) -> None:
        self._bodies: dict[tuple[object, ...], tuple[Half, ...]] = {}

    def find(self, key: tuple[object, ...]) -> tuple[Half, ...] | None:
        """The bodies under ``key``, if they are there."""
        return self._bodies.get(key)

    def add(self, key: tuple[object, ...], bodies: tuple[Half, ...]) -> None:
        """Keep ``bodies`` under ``key``, and of others those added last."""
        self._bodies[key] = bodies
        for oldest in list(self._bodies)[:-_KEPT]:
            del self._bodies[oldest]


def solve_level(
    problem: Problem,
    width: float,
    contact: tuple[float, float],
    sizes: Mapping[float, float],
    growth: float,
    clock: Clock,
    along: float | None = None,
    keep: Kept | None = None,
    rounding: float | None = None,
    corners: float | None = None,
    steps: int | None = None,
) -> Level:
    """Mesh the bodies, blocks of half-width ``width`` unless they have an extent or a mesh of their own, and solve on
    them.

    ``contact``, ``sizes``, ``growth`` and ``along`` are as for :func:`partialslip_meshes.block`. ``rounding`` is how
    far a round face may be from its elements' straight sides, in half-widths of the contact line; ``corners`` what
    elements at the corners of finite bodies may change at the contact, relative. Condensed bodies are taken from
    ``keep`` and added to it. With ``steps`` the load path is followed in as many as the accuracy takes, but not many
    more than that from load point to load point, and what they leave is told (:attr:`Level.stepped`).
    """
    kind = (problem.parts, problem.order, problem.far_field, problem.backend, problem.path is None, problem.inside)
    key = (*kind, width, contact, tuple(sizes.items()), growth, along, rounding, corners)
    if keep and (known := keep.find(key)):
        return _level(problem, known, 0, clock, steps)
    meshes = []
    for part in problem.parts:
        with clock.phase("mesh"):
            mesh = part.mesh or _block(part, width, contact, sizes, growth, along, rounding, corners)
        clock.add_meshing(mesh.cpu_s)
        meshes.append(mesh)
    level = solve_on(meshes, problem, width, clock, steps)
    if keep:
        keep.add(key, level.halves)
    return level


def _opposite(mesh: Mesh, other: Mesh) -> Mesh:
    """The mesh, with what lies opposite the other's contact line for its own."""
    line, ends = mesh.lines["contact"], other.points[other.lines["contact"], 0]
    x, room = mesh.points[line, 0], _ROUNDING * np.ptp(ends)
    line = line[((x >= ends.min() - room) & (x <= ends.max() + room)).all(axis=1)]
    if not len(line):
        raise InputError(
            "bodies.lower, bodies.upper: the contact lines must lie opposite each other; is their unit right?"
        )
    return replace(mesh, lines=mesh.lines | {"contact": line})


def _block(
    part: Part,
    width: float,
    contact: tuple[float, float],
    sizes: Mapping[float, float],
    growth: float,
    along: float | None,
    rounding: float | None,
    corners: float | None,
) -> Mesh:
    half_width, height = part.extent or (width, width)
    finer = {x: size * part.fineness for x, size in sizes.items()}
    everywhere = None if along is None else along * part.fineness
    facets = None
    if part.face and rounding:  # a chord of length c is c^2/(8 R) from its arc; what that does falls with the distance
        facets = math.sqrt(8 * rounding * part.face.radius / (contact[1] - contact[0]) * 2)
    shape = (part.holder, part.face, facets, part.corners(corners) if part.extent and corners else {})
    return block(half_width, contact, finer, growth * part.fineness, height, everywhere, *shape)


def solve_on(meshes: Sequence[Mesh], problem: Problem, width: float, clock: Clock, steps: int | None = None) -> Level:
    """Solve on meshes of the bodies, in the order of the problem's parts; ``width`` and ``steps`` as for
    :func:`solve_level`."""
    if len(meshes) > 1 and any(part.mesh for part in problem.parts):
        meshes = [_opposite(*meshes), *meshes[1:]]
    halves = tuple(_half(*pair, problem, width, clock) for pair in zip(meshes, problem.parts, strict=True))
    return _level(problem, halves, len(halves), clock, steps)


def _level(problem: Problem, halves: tuple[Half, ...], factored: int, clock: Clock, steps: int | None) -> Level:
    with clock.phase("condensation"):
        relative = relative_compliances(halves, problem.coupled)
    with clock.phase("contact"):
        line = halves[0].body
        pressing, history, nodes, first, left_by_steps = _solve(problem, relative, halves[0], steps)
        left, right = _ends(line, pressing.x)
        others: tuple[float, float] | tuple[()] = ()
        if history and relative.xy is not None:
            at_first = np.zeros(len(line.x))
            at_first[nodes] = history.bounds[0]
            others = _ends(line, at_first)
        stick = _stick_zone(line, nodes, history, _grown(first, nodes, problem)) if history else None
        if stick:  # of both contacts, whatever a coarse mesh makes of its ends
            at_left, at_right = others or (left, right)
            stick = replace(stick, left=max(stick.left, left, at_left), right=min(stick.right, right, at_right))
        ends = min([left, *others[:1]]), max([right, *others[1:]])
        locked = _kinks(problem, line, nodes, history) if history else ()
        locked = tuple(kink for kink in locked if ends[0] < kink < ends[1])
        if history and first:
            left_by_steps = step_errors.pressed_together(history, first, line.weights, nodes)
        two = relative.xy is not None
        return Level(
            halves, factored, nodes, pressing, history, left, right, stick, others, locked, two, first, left_by_steps
        )


def _half(mesh: Mesh, part: Part, problem: Problem, width: float, clock: Clock) -> Half:
    with clock.phase("assembly"):
        half = body(mesh, part.kappa, problem.order, part.compliance, part.held, part.pulled)
    far = None
    if problem.far_field == "half-plane" and not part.finite:
        with clock.phase("far field"):
            far = half_plane(half.held_points, half.x, width, part.kappa, part.compliance)
    with clock.phase("factorisation"):
        return Half(mesh, half, Condensed(half, far, problem.backend, problem.path is not None, problem.inside))


def _solve(
    problem: Problem, C: coupled.Relative, lower: Half, steps: int | None
) -> tuple[Solution, History | None, Indices, Pressed | None, step_errors.Errors]:
    """Normal forces, the history of the tangential ones on the nodes in contact, those nodes, how coupled bodies were
    pressed, and what the steps of others leave."""
    line, stretch = lower.body, lower.stretch
    gap, path, pressed = problem.gap(line.x), problem.path, None
    if path and problem.start:
        pressed, before = (nodal_forces(line, traction) for traction in problem.start)
        path = replace(path, before=before)
    if path and C.xy is not None:
        along = coupled.Line(line.x, line.weights, lambda forces: _ends(line, forces), problem.similar)
        near = BARS["q"] * problem.accuracy
        history, pressing, first = coupled.march(C, gap, stretch, problem.f, path, pressed, along, near)
        nodes = np.flatnonzero(history.bound > 0)
        return pressing, history.of(nodes), nodes, first, {}
    pressing = press(C.yy, gap if path else gap - problem.strain * stretch[1], 1.0)
    nodes = np.flatnonzero(pressing.x > 0)
    if not path:
        return pressing, None, nodes, None, {}
    if path.before is not None:
        path = replace(path, before=path.before[nodes])
    assert C.xx is not None
    inner, bound = C.xx[np.ix_(nodes, nodes)], problem.f * pressing.x[nodes]
    half_width = float(np.subtract(*_ends(line, pressing.x)[::-1])) / 2

    def errors(history: History, finer: History) -> step_errors.Errors:
        zones = _stick_zone(line, nodes, history, None), _stick_zone(line, nodes, finer, None)
        return step_errors.halved(history, finer, zones, line.weights[nodes], half_width)

    tangential = inner, stretch[0][nodes], bound, path, problem.accuracy
    history, left = march_refined(*tangential, None if steps is None else errors, steps or 0)
    return pressing, history, nodes, None, left


def _grown(first: Pressed | None, nodes: Indices, problem: Problem) -> tuple[Array, Array] | None:
    """Bounds and tangential forces that grow with the last of P, where nothing but P has acted on coupled bodies."""
    if not first or not problem.path or problem.path.moves:
        return None
    p, q = first.growth
    return problem.f * np.maximum(p[nodes], 0.0), 2 * q[nodes]


def _stick_zone(line: Body, nodes: Indices, history: History, grown: tuple[Array, Array] | None) -> StickInterval:
    bound, change = grown or (history.bound, history.change)
    return stick_zone(line.x[nodes], bound, change, line.x[:: line.order], partial(_forces_of, line, nodes))


def _kinks(problem: Problem, line: Body, nodes: Indices, history: History) -> tuple[float, ...]:
    """Points where slip has left q1 and q2 not smooth, or what the path begins with is not. Where the first loading
    tells the whole there are none but the ends of the stick zone."""
    if history.path.half:
        return ()
    x, vertices, forces = line.x[nodes], line.x[:: line.order], partial(_forces_of, line, nodes)
    found = finest(problem.start[1].x) if problem.start else []
    for q, bound in reversed(history.visited):
        found += kinks(x, bound, q, vertices, forces)
    return tuple(apart(found, _ONE * (x[-1] - x[0]) / 2))


def _forces_of(line: Body, nodes: Indices, forces: Array) -> Array:
    """Integrals over the cells of the contact line of the traction that belongs to forces of some nodes."""
    on_line = np.zeros(len(line.x))
    on_line[nodes] = forces
    return _cell_forces(line, on_line)


def _ends(line: Body, normal: Array) -> tuple[float, float]:
    """Of the contact under nodal normal forces."""
    forces, touching = _cell_forces(line, normal), line.x[normal > 0]
    vertices = line.x[:: line.order]
    return left_end(vertices, forces, touching), right_end(vertices, forces, touching)


def _cell_forces(line: Body, forces: Array) -> Array:
    """Integrals over each cell of the contact line of the traction that belongs to nodal forces."""
    resultant = traction(line, forces).antiderivative()
    return np.diff(resultant(line.x[:: line.order]))
