"""Stresses at any points of the bodies, in SI units: of half-planes under the recovered tractions, and remainders."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import PPoly

from partialslip.friction.load_path import lower_strain
from partialslip.result.below import PiecewiseCauchy, under_pressure, under_shear, under_tension
from partialslip.result.phases import Phases
from partialslip.scene import Scene
from partialslip.tools.arrays import Array
from partialslip_fem.factor import default_backend
from partialslip_fem.mesh_solution import MeshSolution
from partialslip_fem.problem import Part, ScaledProblem, parts_of
from partialslip_fem.recovery import traction
from partialslip_fem.remainder import Remainder
from partialslip_fem.surroundings import height

_SURFACE = 1e-30  # accuracy: depth of points on a flat surface, scaled
_BELOW = 1e-13  # accuracy: depth of points on a round face below the polygon of its cells, scaled
_ROUNDING = 1e-9  # accuracy: part of the depth of a face


class Line:
    """Contact line of a body (``part``, perhaps round; the upper body is mirrored, ``side`` = -1) with the
    ``tractions`` on it: pressures in s states, then shears, (2 s) in the last axis. Scaled."""

    def __init__(self, tractions: PPoly, part: Part, side: float) -> None:
        self._side, self._x, self._round = side, tractions.x, part.face is not None
        self._count = tractions.c.shape[2] // 2  # states
        self._height, rows = height(part, tractions.x), np.moveaxis(tractions.c, 2, 0)
        if self._round:  # tractions times the height
            slopes = np.diff(self._height) / np.diff(self._x)
            raised = np.zeros((len(rows), rows.shape[1] + 1, rows.shape[2]))
            raised[:, 1:] = self._height[:-1] * rows
            raised[:, :-1] += slopes * rows
            rows = np.concatenate([np.pad(rows, ((0, 0), (1, 0), (0, 0))), raised])
        self._cauchy = PiecewiseCauchy(self._x + 1j * self._height if self._round else self._x, rows)

    def stresses(self, x: Array, depth: Array, states: list[int]) -> Array:
        """Stresses (s, 3, k) of the tractions in ``states``, as on a half-plane, at points at ``depth`` below y = 0."""
        side = np.full_like(x, self._side)
        if self._round:
            depth = np.maximum(depth, _BELOW - np.interp(x, self._x, self._height))
        parts = 4 if self._round else 2
        rows = np.add.outer(np.arange(parts) * self._count, states).ravel()
        found = self._cauchy(x - 1j * np.maximum(depth, _SURFACE), rows.tolist())
        value, slope = found.reshape(2, parts, len(states), len(x))
        P, T = value[:2]
        yP_z, yT_z = -depth * slope[:2]
        if self._round:
            yP_z, yT_z = yP_z - slope[2], yT_z - slope[3]
        return np.moveaxis(under_pressure(P, yP_z, side) + under_shear(T, yT_z, side), 1, 0)


@dataclass(frozen=True)
class BodyStresses:
    """Stresses at load steps and between them (:class:`partialslip.result.phases.Phases`).

    Parameters
    ----------
    scene : Scene
    phases : Phases
    tractions : PPoly
        Pressures at the steps, then shears, (2 s) in the last axis; scaled.
    contact : (float, float)
        Ends of all that is ever in contact, scaled.
    origin : float
        Origin of the scaled x, scaled.
    width : float or None
        Half-width of clamped blocks that stand for half-planes, scaled; None if there are none.
    """

    scene: Scene
    phases: Phases
    tractions: PPoly
    contact: tuple[float, float]
    origin: float
    width: float | None

    @classmethod
    def of(cls, scene: Scene, problem: ScaledProblem, solution: MeshSolution) -> "BodyStresses":
        """Stresses of both bodies in ``solution`` of ``problem``, the scaled ``scene``."""
        phases, shears, normals = _steps(scene, solution)
        both = [traction(solution.lower, each) for each in (*normals, *shears)]
        clamped = problem.far_field == "box" and not all(part.finite for part in problem.parts)
        return cls(
            scene,
            phases,
            PPoly(np.stack([each.c for each in both], axis=2), both[0].x),
            solution.reach,
            problem.origin,
            float(solution.bodies[0].mesh.points[:, 0].max()) if clamped else None,
        )

    def inside(self, x: Array, y: Array, phases: Array) -> Array:
        """Stresses (s, 3, k), Pa, at points (``x``, ``y``), m, (k,) each, and ``phases`` (s,) from 0 to 1."""
        return self.phases.interpolate(lambda steps: self._stresses_by_body(x, y, list(steps)), phases)

    def _stresses_by_body(self, x: Array, y: Array, steps: list[int]) -> Array:
        result = np.empty((len(steps), 3, len(x)))
        for body, here in enumerate((y <= 0, y > 0)):
            if here.any():
                result[..., here] = self._in_body(body, x[here], np.abs(y[here]), steps)
        return result

    def _in_body(self, body: int, x: Array, depth: Array, steps: list[int]) -> Array:
        part, remainder, side = self._parts[body], self._remainders[body], 1.0 - 2.0 * body
        along, deep = x / self.scene.length - self.origin, depth / self.scene.length
        face = -height(part, along)
        # where bodies touch, a round face is drawn flat
        touches = (along >= self.contact[0]) & (along <= self.contact[1])
        found = self._boundary_lines[body].stresses(along, np.maximum(deep, face), steps)
        if remainder:
            rest = remainder.stresses(along, -np.maximum(deep, face), steps)
            found += rest * np.array([1.0, 1.0, side])[:, None]
        found[..., (deep < (1 - _ROUNDING) * face) & ~touches] = np.nan
        found *= self.scene.P / self.scene.length
        if side > 0 and not part.pulled:
            for row, (_, sigma, slope, *_) in zip(found, self.phases.loads[steps].tolist(), strict=True):
                row += under_tension(sigma + slope * x, slope, depth, np.ones_like(x))
        return found

    @cached_property
    def _boundary_lines(self) -> tuple[Line, ...]:
        return tuple(Line(self.tractions, part, side) for part, side in zip(self._parts, (1.0, -1.0), strict=True))

    @cached_property
    def _parts(self) -> tuple[Part, Part]:
        return parts_of(self.scene, self.scene.length)

    @cached_property
    def _remainders(self) -> tuple[Remainder | None, ...]:
        strains = np.array([lower_strain(self.scene, sigma) for sigma in self.phases.loads[:, 1]])
        fem = self.scene.fem
        return tuple(
            Remainder.of(
                part, self.width or 0.0, fem.elements, self.tractions, way, strains, fem.factor or default_backend()
            )
            if part.finite or self.width
            else None
            for part, way in zip(self._parts, (1, -1), strict=True)
        )


def _steps(scene: Scene, solution: MeshSolution) -> tuple[Phases, list[Array], list[Array]]:
    """Load steps, and the forces along x and across on the nodes of the contact line at these steps."""
    history, load = solution.history, scene.load
    if history:
        steps = history.around
        shears = [solution.on_line(each) for each in steps.forces]
        pressures = np.broadcast_to(steps.pressures, steps.forces.shape)
        return Phases(load, steps.ways), shears, [solution.on_line(each) for each in pressures]
    second = solution.pressing.x
    first = second if solution.first is None else solution.first
    # between the load points the pressure was not solved for
    normals = [first + share * (second - first) for share in load.progress.tolist()]
    return Phases(load, ((1.0,),) * len(normals)), [0 * second] * len(normals), normals
