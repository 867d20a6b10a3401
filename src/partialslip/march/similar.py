"""Marching of half-planes of like materials: the exact pressure, and shear step by step through any load history.

Shear is constant on cells, refined towards the ends of the contact and of the computed stick zone.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from partialslip.friction import coulomb_constant_pressure, coulomb_varying_pressure
from partialslip.friction.contact_line import passing
from partialslip.friction.history import certificate, last_cycle_change
from partialslip.friction.load_path import load_path, stretched
from partialslip.friction.regime import steady_state
from partialslip.friction.step_errors import Errors, of_steps, steps_matter
from partialslip.friction.steps import follow_or_step
from partialslip.friction.warm_start import Trail
from partialslip.friction.zone_ends import finest, sticking_zones
from partialslip.halfplane.levels import PRESSED
from partialslip.halfplane.remarks import no_stresses
from partialslip.halfplane.states import Around, sliding_state, without_shear
from partialslip.halfplane.stress import SURFACE_REACH, along_surface
from partialslip.halfplane.tractions import CellTractions
from partialslip.march import changes, driver
from partialslip.march.cell_stress import CellStresses
from partialslip.march.cells import (
    cells_around,
    compliance,
    contact_line,
    friction_on,
    on_cells,
)
from partialslip.march.driver import LastLevel
from partialslip.march.pressing import NormalLoads
from partialslip.result import Clock, Result, StressAt, Traction
from partialslip.result.state import State
from partialslip.scene import Scene
from partialslip.scene.plan import Plan
from partialslip.tools.arrays import Array

_AT_BENDS = 32.0  # cost: most size of cells at kinks of the coefficient of friction, over the size at the ends
_WORK = 5e11  # limit: cells^3 times load steps of a mesh
_LEG = 6.0  # cost: work of a leg that is followed while cells touch and open, over that of a load step (measured)
_SEVERAL = "more than one zone sticks, as the coefficient of friction varies"
Added = Callable[[Array], Array]


@dataclass(frozen=True)
class SimilarLevel(driver.Level):
    """Solution on one mesh of cells; lengths in half-widths of the frame (:class:`NormalLoads`) from its middle, forces
    in P.
    ``pressed`` are the normal forces, ``kinks`` are those of q at the load points; ``stepped`` are errors due to the
    load steps, from the mesh on which these were chosen last.
    ``trail``: where load steps on the next mesh begin.
    """

    pressed: Array
    kinks: tuple[float, ...] = ()
    stepped: Errors = field(default_factory=dict)
    trail: Trail | None = None

    @property
    def zone(self) -> tuple[float, ...]:
        """Ends of the stick zone; empty without friction."""
        return (self.stick.left, self.stick.right) if self.stick else ()

    @property
    def passing(self) -> tuple[float, ...]:
        """Kinks that neither q1 nor q2 has."""
        return passing(self.kinks, self.stick, self.history)


class SimilarBodies(driver.CellProblem[SimilarLevel]):
    """Half-planes of like materials, for :func:`partialslip.march.driver.march`; ``added`` as for
    :func:`partialslip.march.method.solve`."""

    def __init__(self, scene: Scene, plan: Plan, start: State | None, clock: Clock, added: Added | None) -> None:
        self.normal, path = NormalLoads.of(scene), load_path(scene, plan, start)
        frame = self.normal.frame
        self.added = frame.layer.added if frame.layer else added
        super().__init__(scene, start, clock, path, (frame.centre, frame.a))
        self._ends = [*self.normal.ends, *self.normal.within(scene.profile.kinks)]
        self._inner = self.normal.within(finest(start.q.x)) if start else []
        self._friction = self.normal.within(scene.friction.sharp_kinks(self.length))

    @property
    def drags(self) -> bool:
        """Whether pressing locks in shear that is not followed."""
        return bool(self.normal.frame.layer and self.normal.frame.layer.drags)

    def cells(self, level: SimilarLevel | None, mesh: tuple[float, float]) -> Array:
        ends = [*self._ends, *(level.zone if level else ())]
        moving = level.passing if level else ()
        kinks = [*self._inner, *(kink for kink in (level.kinks if level else ()) if kink not in moving)]
        return cells_around(ends, mesh, 1.0, kinks, moving, self._friction, _AT_BENDS)

    def too_large(self, level: SimilarLevel, count: int) -> bool:
        history = level.history
        if not history:
            return True
        one = _LEG if history.path.followed and history.path.presses_anew else 1.0
        return one * history.load_steps * count**3 > _WORK

    def solve(self, level: SimilarLevel | None, mesh: tuple[float, float]) -> SimilarLevel:
        # steps are chosen on the first mesh that is not coarse and used on all later meshes. Finer cells see more of a
        # moving stick zone: where steps matter, each later mesh halves them once and estimates their errors anew
        stepped, first = level.stepped if level else Errors(), self.meshes == driver.COARSE
        choose = first or (steps_matter(stepped, self.scene.fem.accuracy) and not self.clock.limited)
        cells = self.cells(level, mesh)
        found = _solve_level(self, cells, choose, level.trail if level else None)
        if first and found.history:
            self.path = found.history.path
        return replace(found, stepped=found.stepped or stepped)

    def changes(self, level: SimilarLevel, other: SimilarLevel) -> Errors:
        assert level.history
        assert other.history
        moved = changes.of_zone(level.vertices, np.array(level.zone), np.array(other.zone))
        shear = changes.of_shear(level.vertices, level.history, other.vertices, other.history)
        return dict.fromkeys("mn", moved * self.normal.frame.a / self.normal.largest.a) | shear

    def step_errors(self, level: SimilarLevel) -> Errors:
        return level.stepped

    def answer(self, level: SimilarLevel) -> LastLevel:
        normal, scene, history = self.normal, self.scene, level.history
        frame, largest, anew, f = normal.frame, normal.largest, scene.presses_anew, scene.friction.f
        widths, p0 = np.diff(level.vertices), 2 / np.pi * (frame.a / largest.a)
        places = self.places(level)
        x = (places[1:] + places[:-1]) / 2
        found = steady_state(scene, history, level.stick, 1.0, x=level.x, common=normal.common if anew else None)
        q1, q2 = (scene.P / frame.a * q / widths for q in (history.q1, history.q2)) if history else (0 * x, 0 * x)
        known = found.centre is not None and not self.drags
        if found.centre is not None and self.drags:
            unknown = {**dict.fromkeys(("q1", "q2"), PRESSED), **found.undetermined}
            found = found._replace(undetermined=unknown, notes=(*found.notes, f"q1 and q2: {PRESSED}"))
        several = scene.friction.varies and history and sticking_zones(history.bound, history.change) > 1
        if several:
            found = found._replace(undetermined={**found.undetermined, **dict.fromkeys("mn", _SEVERAL)})
        before = normal.first if anew else None
        tractions = CellTractions(frame, normal.second, before, level.vertices, q1, q2, known)
        counts = {
            "events": history.events if history else 0,
            "friction_iterations": history.changes if history else 0,
        }
        pressed = level.pressed
        if history:
            pressed = normal.forces(normal.last, level.vertices) if anew else history.end[1]
        return LastLevel(
            a=largest.a,
            p0=largest.p0,
            found=found,
            traction=Traction(x, tractions.at(x), tractions.at, places, places),
            cells=slice(None),
            pressed=pressed,
            certificate=certificate(history, widths, f, p0) if history else {},
            change=last_cycle_change(history, widths, f, p0) if history else None,
            model=f"two {'strips' if frame.layer else 'half-planes'}, exact pressure, cells of constant shear",
            counts=counts,
            contact_ends=(normal.first.ends, normal.second.ends) if anew or frame.centre else None,
            notes=(f"m, n: {_SEVERAL}: those of the one with the most room are told",) if several else (),
        )


def add_stresses(found: Result, normal: NormalLoads, level: SimilarLevel, clock: Clock) -> Result:
    """Result with stresses, where q1 and q2 are known."""
    scene, why = normal.scene, "the contact slides"
    stresses: CellStresses | Around | None = None
    if PRESSED in found.undetermined.values():
        why = PRESSED
    elif level.history:
        stresses = CellStresses.of(normal, level.vertices, level.history.around)
    else:
        stresses = sliding_state(scene) if scene.slides else without_shear(scene)
    if not stresses:
        return replace(found, undetermined={**found.undetermined, **no_stresses(why)})
    far = normal.frame.places([-SURFACE_REACH, SURFACE_REACH])
    breaks = np.unique([*far, *normal.frame.places([*normal.ends, *level.zone])])
    surface = along_surface(stresses.surface, breaks)
    return replace(found, surface=surface, stress_at=StressAt(stresses.inside), cost=clock.cost())


def _solve_level(problem: SimilarBodies, vertices: Array, choose: bool, before: Trail | None) -> SimilarLevel:
    """Solve on the cells between ``vertices``, and ``choose`` the load steps."""
    normal, path, clock = problem.normal, problem.path, problem.clock
    scene, frame, forces = normal.scene, normal.frame, normal.forces(normal.second, vertices)
    if not path:
        return SimilarLevel(vertices, None, None, forces)
    line, places, trail, stepped = contact_line(vertices), frame.places(vertices), None, Errors()
    if problem.start:
        path = replace(path, before=on_cells(problem.start.q, places) / scene.P)
    with clock.phase("compliance"):
        normally = compliance(vertices / 2)  # scaling lengths adds a rigid shift only
        tangential = normally + problem.added(places) if problem.added else normally
    with clock.phase("contact"):
        f = friction_on(scene.friction, places)
        moved = stretched(line.x * frame.a / scene.length, frame.centre / scene.length)
        if path.presses_anew:
            presses, trail = normal.presses(vertices, normally), Trail(line.x, before)
            along = partial(coulomb_varying_pressure.march, line.x, tangential, moved, f, presses, trail=trail)
            errors = partial(of_steps, line, half_width=normal.largest.a / frame.a, common=normal.common)
            history, stepped = follow_or_step(along, path, scene.fem.accuracy, errors if choose else None)
        else:
            history = coulomb_constant_pressure.march(tangential, moved, normal.forces(frame, vertices), f, path)
        stick, kinks = line.stick_zone(history, normal.common), tuple(line.kinks(history))
        return SimilarLevel(vertices, history, stick, forces, kinks, stepped, trail=trail)
