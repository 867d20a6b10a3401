"""Marching of half-planes of like materials: the exact pressure, and shear step by step through any load history.

Shear is constant on cells, refined towards the ends of the contact and of the computed stick zone.
"""

import itertools
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from partialslip.friction import coulomb_constant_pressure, coulomb_varying_pressure
from partialslip.friction.active_set import spread
from partialslip.friction.history import History, certificate, last_cycle_change
from partialslip.friction.load_path import Path, load_path, stretched
from partialslip.friction.regime import steady_state
from partialslip.friction.step_errors import Errors, of_steps, steps_matter
from partialslip.friction.steps import follow_or_step
from partialslip.friction.warm_start import Trail
from partialslip.friction.zone_ends import StickInterval, apart, finest, kinks, read_stick_zone, sticking_zones, within
from partialslip.halfplane.remarks import no_stresses
from partialslip.halfplane.states import Around, sliding_state, without_shear
from partialslip.halfplane.stress import SURFACE_REACH, along_surface
from partialslip.halfplane.tractions import CellTractions
from partialslip.march import changes, driver
from partialslip.march.cell_stress import CellStresses
from partialslip.march.cells import (
    compliance,
    friction_on,
    graded_cells,
    nearest,
    on_cells,
)
from partialslip.march.driver import LastLevel
from partialslip.march.pressing import NormalLoads
from partialslip.result import Clock, Result, StressAt, Traction
from partialslip.result.state import State
from partialslip.scene import Scene
from partialslip.scene.plan import Plan
from partialslip.tools.arrays import Array

_NEAR = 10.0  # accuracy: cells at ends closer to each other than a/10 are reduced in proportion
_SMALLEST = 1e-9  # accuracy: in a: closer ends are merged, and smaller cells are not requested
_INNER = 8.0  # cost: size of cells at kinks of q over the size at the ends: kinks hardly affect m and n
# cost: the same at kinks that neither q1 nor q2 has, and, at most, at kinks of the coefficient of friction
_PASSING = 32.0
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
    def passing(self) -> list[float]:
        """Kinks that neither q1 nor q2 has: out of phase these are -f p and f p beside the stick zone, where the kinks
        of single load points pass by, if the pressure is constant. Kinks in the stick zone last."""
        if not self.stick or not self.history or self.history.path.in_phase or self.history.path.presses_anew:
            return []
        return [kink for kink in self.kinks if not self.stick.left <= kink <= self.stick.right]


class SimilarBodies(driver.CellProblem[SimilarLevel]):
    """Half-planes of like materials, for :func:`partialslip.march.driver.march`; ``added`` as for
    :func:`partialslip.march.method.solve`."""

    def __init__(self, scene: Scene, plan: Plan, start: State | None, clock: Clock, added: Added | None) -> None:
        self.added, self.normal, path = added, NormalLoads.of(scene), load_path(scene, plan, start)
        frame = self.normal.frame
        super().__init__(scene, start, clock, path, (frame.centre, frame.a))
        self._ends = [*self.normal.ends, *self.normal.within(scene.profile.kinks)]
        self._inner = self.normal.within(finest(start.q.x)) if start else []
        self._friction = self.normal.within(scene.friction.sharp_kinks(self.length))

    def cells(self, level: SimilarLevel | None, mesh: tuple[float, float]) -> Array:
        return _cells(self._ends, self._inner, self._friction, level, *mesh)

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
        found = _solve_level(
            self.normal, self.path, self.start, cells, self.clock, choose, self.added, level.trail if level else None
        )
        if first and found.history:
            self.path = found.history.path
        return replace(found, stepped=found.stepped or stepped)

    def changes(self, level: SimilarLevel, other: SimilarLevel) -> Errors:
        assert level.history
        assert other.history
        moved = changes.of_ends(np.array(level.zone), np.array(other.zone))
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
        known = found.centre is not None
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
            model="two half-planes, exact pressure, cells of constant shear",
            counts=counts,
            contact_ends=(normal.first.ends, normal.second.ends) if anew or frame.centre else None,
            notes=(f"m, n: {_SEVERAL}: those of the one with the most room are told",) if several else (),
        )


def add_stresses(found: Result, normal: NormalLoads, level: SimilarLevel, clock: Clock) -> Result:
    """Result with stresses, where q1 and q2 are known."""
    scene = normal.scene
    if level.history:
        stresses: CellStresses | Around | None = CellStresses.of(normal, level.vertices, level.history.around)
    else:
        stresses = sliding_state(scene) if scene.slides else without_shear(scene)
    if not stresses:
        return replace(found, undetermined={**found.undetermined, **no_stresses("the contact slides")})
    far = normal.frame.places([-SURFACE_REACH, SURFACE_REACH])
    breaks = np.unique([*far, *normal.frame.places([*normal.ends, *level.zone])])
    surface = along_surface(stresses.surface, breaks)
    return replace(found, surface=surface, stress_at=StressAt(stresses.inside), cost=clock.cost())


def _cells(
    ends: list[float], inner: list[float], friction: list[float], level: SimilarLevel | None, size: float, growth: float
) -> Array:
    """Ends of cells (c + 1,) of ``size`` at the ``ends`` and at the stick zone's ends on the previous ``level``, and of
    a larger size at ``inner`` kinks of q and at the kinks on that level, the largest at those that are passing.

    Cells are small compared with the distance of neighbouring ends: q is steep in narrow slip zones and stick zones.
    Each kink of the coefficient of ``friction`` is an end of a cell, and as many cells as ``growth`` tells lie
    between two of them: no dip is left out.
    """
    fine: Array = np.sort(apart([*ends, *(level.zone if level else ())], _SMALLEST))
    bends = apart(friction, _SMALLEST, fine.tolist())[len(fine) :]
    gap = nearest(np.array([*fine, *bends]))
    moving = level.passing if level else []
    lasting = [kink for kink in (level.kinks if level else ()) if kink not in moving]
    known = apart([*inner, *lasting], _INNER * size, fine.tolist())
    passing = apart(moving, _PASSING * size, [*known, *bends])[len(known) + len(bends) :]
    points = np.array([*known, *bends, *passing])
    sizes = np.full(len(points), _PASSING * size)
    sizes[: len(known)] = _INNER * size
    sizes[: len(fine)] = np.maximum(size * np.minimum(_NEAR * gap[: len(fine)], 1.0), _SMALLEST)
    at_bends = slice(len(known), len(known) + len(bends))
    sizes[at_bends] = np.minimum(sizes[at_bends], growth * gap[len(fine) :])
    order = np.argsort(points)
    return graded_cells(points[order], sizes[order], growth)


def _solve_level(
    normal: NormalLoads,
    path: Path | None,
    start: State | None,
    vertices: Array,
    clock: Clock,
    choose: bool,
    added: Added | None,
    before: Trail | None,
) -> SimilarLevel:
    scene, frame = normal.scene, normal.frame
    if not path:
        return SimilarLevel(vertices, None, None, normal.forces(normal.second, vertices))
    x = (vertices[1:] + vertices[:-1]) / 2
    if start:
        path = replace(path, before=on_cells(start.q, frame.places(vertices)) / scene.P)
    with clock.phase("compliance"):
        normally = compliance(vertices / 2)  # scaling lengths adds a rigid shift only
        tangential = normally + added(frame.places(vertices)) if added else normally
    with clock.phase("contact"):
        f = friction_on(scene.friction, frame.places(vertices))
        moved = stretched(x * frame.a / scene.length, frame.centre / scene.length)

        def zone(of: History) -> StickInterval:
            if not of.path.presses_anew:
                known = of.lasting, of.unsteady, of.stuck
                return read_stick_zone(x, of.bound, of.change, vertices, lambda values: values, *known)
            on = np.flatnonzero(of.bound > 0)
            here, forces = of.of(on), partial(spread, where=on, count=len(x))
            known = here.lasting, here.unsteady, here.stuck
            found = read_stick_zone(x[on], here.bound, here.change, vertices, forces, *known)
            return within(found, normal.common, vertices)

        def errors(of: History, gradual: History) -> dict[str, float]:
            return of_steps(of, gradual, (zone(of), zone(gradual)), np.diff(vertices), normal.largest.a / frame.a)

        if path.presses_anew:
            presses = normal.presses(vertices, normally)
            trail = Trail(x, before)
            along = partial(coulomb_varying_pressure.march, x, tangential, moved, f, presses, trail=trail)
            history, stepped = follow_or_step(along, path, scene.fem.accuracy, errors if choose else None)
        else:
            trail = None
            history = coulomb_constant_pressure.march(tangential, moved, normal.forces(frame, vertices), f, path)
            stepped = {}
        inner = [kinks(x, held, q, vertices, lambda values: values) for q, held in reversed(history.visited)]
        inner.append(history.turning(x))
        forces = normal.forces(normal.second, vertices)
        return SimilarLevel(
            vertices,
            history,
            zone(history),
            forces,
            tuple(itertools.chain.from_iterable(inner)),
            stepped,
            trail=trail,
        )
