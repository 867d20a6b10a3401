"""Marching of half-planes of unlike materials: pressure and shear step by step, on one set of cells.

Pressure moves the surfaces along x and shear opens the gap, by Dundurs' beta. Each step of the load path is solved for
both together (:mod:`partialslip.friction.coulomb_coupled`). Scaled: lengths by sqrt(A R P), forces by P, displacements
by A P.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from msgspec.structs import replace as changed

from partialslip.friction import coulomb_coupled
from partialslip.friction.active_set import Solution
from partialslip.friction.contact_line import common_ends
from partialslip.friction.even_gap import PARABOLA, even_gap
from partialslip.friction.history import certificate, last_cycle_change
from partialslip.friction.load_path import Path, load_path, stretched
from partialslip.friction.normal import press
from partialslip.friction.pressing import Pressed
from partialslip.friction.regime import steady_state, steps_of_coupled
from partialslip.friction.step_errors import Errors, along_path, more_steps, other_steps, pressed_together, summed
from partialslip.friction.work import told_by_finer
from partialslip.halfplane.tractions import CoupledTractions
from partialslip.march import changes, driver
from partialslip.march.cells import cells_around, contact_line, friction_on, on_cells
from partialslip.march.driver import LastLevel
from partialslip.march.pressing import NormalLoads
from partialslip.march.punch_growth import OnCells, PunchGrowth, relative
from partialslip.result import Clock, Traction, TractionAt
from partialslip.result.state import State
from partialslip.scene import Scene
from partialslip.scene.materials import Material
from partialslip.scene.plan import Plan
from partialslip.tools.arrays import Array
from partialslip.tools.bars import BARS

_BEYOND = 1.2  # accuracy: extent of the cells, in that of the contact without coupling ...
_WIDER = 1.5  # cost: ... and how many times wider they are made where they do not enclose the contact
_ROUNDING = 1e-12  # accuracy: relative difference of two compliances that is rounding
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(6)


def dundurs(scene: Scene) -> float:
    """Dundurs' beta of the materials of ``scene``: positive where pressure moves the upper surface more than the lower
    one towards the load."""
    lower, upper = ((body.kappa - 1) / body.mu for body in scene.material.bodies)
    beta = (upper - lower) / (4 * scene.material.A)
    return beta if abs(upper - lower) > _ROUNDING * abs(upper) else 0.0


@dataclass(frozen=True)
class UnlikeLevel(driver.Level):
    """Solution on one mesh of cells: normal forces, how the bodies were ``pressed`` together, the ``ends`` of the
    contact at load points 1 and 2, and ``kinks`` of q."""

    pressing: Solution
    pressed: Pressed | None
    ends: tuple[tuple[float, float], tuple[float, float]]
    kinks: tuple[float, ...] = ()

    @property
    def a(self) -> tuple[float, float]:
        """Half-widths of the contact at load points 1 and 2."""
        (left1, right1), (left2, right2) = self.ends
        return (right1 - left1) / 2, (right2 - left2) / 2

    @property
    def common(self) -> tuple[float, float]:
        """Ends of what is in contact at both load points."""
        return common_ends(self.ends)

    @property
    def fine(self) -> list[float]:
        """Points to refine at: ends of the contact and of the stick zone."""
        return [*self.ends[1], *self.ends[0], *((self.stick.left, self.stick.right) if self.stick else ())]


class UnlikeBodies(driver.CellProblem[UnlikeLevel]):
    """Half-planes of unlike materials, for :func:`partialslip.march.driver.march`: ``beta``, zero without coupling, and
    the flat ``punch`` as which the contact grows under an even ``gap``, if it is one. ``followed`` are the errors of
    the load steps, on the first cells that are not coarse. There as many steps are taken as these errors call for."""

    steps_count = False  # they are as many as their errors call for

    def __init__(self, scene: Scene, plan: Plan, start: State | None, clock: Clock) -> None:
        super().__init__(scene, start, clock, load_path(scene, plan, start), (scene.origin, scene.length))
        self.beta = dundurs(scene) if plan.needs("coupling") and plan.needs("friction") else 0.0
        self.gap = None if start else even_gap(scene, self.length)
        self.punch = PunchGrowth.of(self.beta, scene.friction.f) if self.beta and self.gap else None
        if self.punch and self.gap and not self.gap.parabolic:
            ends = self.punch.vertices
            pushes = scene.friction.f * abs(self.beta)
            self.gap = self.gap.under(ends, self.punch.normal * np.diff(ends), pushes)
        self.width = _extent(scene)
        self.followed: Errors = {}

    def solve(self, level: UnlikeLevel | None, mesh: tuple[float, float]) -> UnlikeLevel:
        found = self._enclosed(level, mesh)
        if self.meshes >= driver.COARSE and not self.followed and self.path and self.path.moves and self.beta:
            return self._in_enough_steps(found)
        return found

    def _in_enough_steps(self, level: UnlikeLevel) -> UnlikeLevel:
        """The ``level`` in as many load steps as their errors call for, which all finer cells take, too."""
        while level.history and level.stick:
            level, self.followed = _path_errors(self, level)
            assert level.history
            self.path = path = replace(level.history.path, before=None)
            more = more_steps(path, self.followed, _step_errors(level), self.scene.fem.accuracy)
            if not more or self.clock.remaining() <= 0:
                break
            self.path = more
            level = _solve_on(self, more, level.vertices, max(level.a))
        return level

    def _enclosed(self, level: UnlikeLevel | None, mesh: tuple[float, float]) -> UnlikeLevel:
        """The solution on cells that enclose the contact."""
        wider = 1.0
        while True:
            near = max(level.a) if level else None
            found = _solve_on(self, self.path, self.cells(level, mesh, wider), near)
            touching = [found.pressing.x] + ([found.history.bound] if found.history else [])
            if not any(forces[0] or forces[-1] for forces in touching):
                return found
            wider *= _WIDER

    def changes(self, level: UnlikeLevel, other: UnlikeLevel) -> Errors:
        a, meshes = level.a[self.scene.largest - 1], (level.vertices, other.vertices)
        found = dict.fromkeys(("a", "left", "right"), changes.of_ends(np.array(level.ends), np.array(other.ends)) / a)
        found["p"] = changes.of_traction(meshes[0], level.pressing.x, meshes[1], other.pressing.x)
        if level.stick and other.stick:
            zones = (np.array([stick.left, stick.right]) for stick in (level.stick, other.stick))
            found |= dict.fromkeys("mn", changes.of_zone(meshes[0], *zones) / a)
        if level.history and other.history:
            found |= changes.of_shear(meshes[0], level.history, meshes[1], other.history)
        return found

    def mesh_errors(self, level: UnlikeLevel, before: UnlikeLevel, earlier: UnlikeLevel) -> Errors:
        errors = super().mesh_errors(level, before, earlier)
        if self.punch and level.history and not level.history.path.moves:  # its stick zone is that of all meshes
            errors |= {key: errors[key] + 2 * self.punch.off for key in "mn"}
        return errors

    def step_errors(self, level: UnlikeLevel) -> Errors:
        return summed(_step_errors(level), self.followed)

    def answer(self, level: UnlikeLevel) -> LastLevel:
        scene, history, L, P = self.scene, level.history, self.length, self.scene.P
        widths, stress, pressing = np.diff(level.vertices), P / L, level.pressing
        a = level.a[scene.largest - 1]
        p0 = 2 / np.pi / a
        certified = {"kkt": float((pressing.residual / widths).max() / p0), "equilibrium": pressing.imbalance}
        change = None
        if history:
            own = certificate(history, widths, scene.friction.f, p0)
            certified = {key: max(own[key], certified[key]) for key in own}
            change = last_cycle_change(history, widths, scene.friction.f, p0)
        pushed = bool(history and not history.path.moves and level.pressed and level.pressed.slipped())
        anew = level.common if scene.presses_anew else None
        found = steady_state(scene, history, level.stick, a, pushed, level.x, anew)
        known = history is not None and found.centre is not None
        forces = history.pressures if history else (pressing.x, pressing.x)
        shear = (history.q1, history.q2) if history else (0 * level.x, 0 * level.x)
        units = L, stress, scene.origin
        tractions = CoupledTractions.of(level.vertices, level.ends, forces, shear, units, known, not history)
        on = np.flatnonzero((forces[0] > 0) | (forces[1] > 0))
        (p1, p2), (q1, q2) = ([stress * each[on] / widths[on] for each in pair] for pair in (forces, shear))
        traction = Traction(
            x=level.x[on] * L + scene.origin,
            values=TractionAt.between(p2, q1, q2, known, p1 if history else None),
            at=tractions.at,
            breaks=np.unique([*level.fine, *level.kinks]) * L + scene.origin,
            cells=level.vertices[on[0] : on[-1] + 2] * L + scene.origin,
        )
        (left1, right1), (left2, right2) = (np.array(level.ends) * L + scene.origin).tolist()
        return LastLevel(
            a=a * L,
            p0=p0 * stress,
            found=found,
            traction=traction,
            cells=on,
            pressed=history.end[1] if history else pressing.x,
            certificate=certified,
            change=change,
            model="two half-planes, cells of constant pressure and shear",
            counts={
                "friction_iterations": pressing.changes if history else 0,
                "iterations": pressing.iterations + (history.iterations if history else 0),
            },
            contact_ends=((left1, right1), (left2, right2)),
            notes=steps_of_coupled(history, self.followed, scene.fem.accuracy) if self.beta else (),
        )

    def cells(self, level: UnlikeLevel | None, mesh: tuple[float, float], wider: float = 1.0) -> Array:
        """Cells that reach ``wider`` than usual beyond the contact."""
        scene, far, a = self.scene, _BEYOND * wider * self.width, max(level.a) if level else self.width
        kinks = [*(level.kinks if level else ()), *self._scaled(scene.profile.kinks)]
        kinks += [0.0] if self.punch and self.gap and self.gap.parabolic else []  # there q/p is x ln|x|
        bends = self._scaled(scene.friction.sharp_kinks(a * scene.length))
        kinks, bends = ([each for each in points if abs(each) < far] for points in (kinks, bends))
        wide = mesh[1] * (far - self.width)
        outer = (-far, wide), (far, wide)
        return cells_around(level.fine if level else [-self.width, self.width], mesh, a, kinks, (), bends, outer=outer)

    def _scaled(self, points: Sequence[float]) -> list[float]:
        return [(point - self.scene.origin) / self.scene.length for point in points]


def _extent(scene: Scene) -> float:
    """Largest distance of the contact's ends from x = 0 without coupling."""
    alike = changed(scene, material=Material(E=4 / scene.material.A, nu=0.0))
    found = NormalLoads.of(alike).frame.ends
    return max(abs(end) for end in found) / scene.length


def _solve_on(problem: UnlikeBodies, path: Path | None, vertices: Array, near: float | None) -> UnlikeLevel:
    """Solve on the cells between ``vertices``, for a contact of about the half-width ``near`` if that is known."""
    scene, clock = problem.scene, problem.clock
    line, L = contact_line(vertices, problem.beta), scene.length
    x = line.x
    with clock.phase("compliance"):
        C = relative(vertices, problem.beta)
    with clock.phase("contact"):
        points = (x[:, None] + line.weights[:, None] / 2 * _NODES) * L + scene.origin
        gap = scene.gap_at(points) @ (_WEIGHTS / 2) / (scene.material.A * scene.P)
        if not path:
            pressing = press(C.yy, gap, 1.0)
            return UnlikeLevel(vertices, None, None, pressing, None, (line.ends(pressing.x),) * 2)
        begins = None
        if problem.start:
            places = vertices * L + scene.origin
            begins, shear = (on_cells(each, places) / scene.P for each in (problem.start.p, problem.start.q))
            path = replace(path, before=shear)
        under = problem.gap or PARABOLA
        stages = OnCells(problem.punch, vertices, under) if problem.punch else None
        growth = coulomb_coupled.Growth(stages is not None, near=near, stages=stages, under=under)
        moved = stretched(x, scene.origin / L)
        stretch, allowed = np.array([moved[0], 0 * x]), BARS["q"] * scene.fem.accuracy
        loaded = C, gap, stretch, moved[1], friction_on(scene.friction, vertices * L + scene.origin), path
        history, pressing, pressed = coulomb_coupled.march(*loaded, line, growth, begins, allowed)
        history = replace(history, rooms=None)  # room that fades from cycle to cycle counts as room
        at_points = line.ends_at_points(history)
        both = common_ends(at_points)
        stick = line.stick_zone(history, both, pressed)
        if problem.punch and not history.path.moves:  # the punch knows it better than the cells
            reach = problem.punch.stick * (both[1] - both[0]) / 2
            stick = replace(stick, left=-reach, right=reach)
        kinks: list[float] = []
        for q, bound in history.visited:
            on = np.flatnonzero(bound > 0)
            kinks += line.on(on).kinks_at(q[on], bound[on])
        within = tuple(kink for kink in kinks if both[0] < kink < both[1])
        return UnlikeLevel(vertices, history, stick, pressing, pressed, at_points, within)


def _step_errors(level: UnlikeLevel) -> Errors:
    """Errors of the steps of pressing."""
    if not level.history or not level.pressed:
        return {}
    return pressed_together(level.history, level.pressed, np.diff(level.vertices), np.arange(len(level.x)))


def _path_errors(problem: UnlikeBodies, level: UnlikeLevel) -> tuple[UnlikeLevel, Errors]:
    """The ``level`` with the work that its load steps miss, and their errors on its cells; empty if not known."""
    assert level.history
    path = replace(level.history.path, before=None)
    finer = _solve_on(problem, other_steps(path), level.vertices, max(level.a))
    if not finer.history:
        return level, {}
    line = contact_line(level.vertices, problem.beta)
    off = along_path(line, level.history, finer.history, problem.scene.largest)
    return replace(level, history=told_by_finer(level.history, finer.history)), off
