"""Marching of half-planes of like materials: the exact pressure, and shear step by step through any load history.

Shear is constant on cells, refined towards the ends of the contact and of the computed stick zone.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from partialslip.friction import coulomb_constant_pressure, coulomb_varying_pressure
from partialslip.friction.contact_line import passing
from partialslip.friction.history import SHEARS, History, certificate, last_cycle_change
from partialslip.friction.load_path import load_path, stretched
from partialslip.friction.regime import permanent_zone, steady_state
from partialslip.friction.step_errors import Errors, of_steps, steps_matter
from partialslip.friction.steps import follow_or_step
from partialslip.friction.warm_start import Trail
from partialslip.friction.zone_ends import finest, sticking_zones
from partialslip.halfplane.remarks import no_stresses
from partialslip.halfplane.states import Around, sliding_state, without_shear
from partialslip.halfplane.stress import SURFACE_REACH, along_surface
from partialslip.halfplane.tractions import CellTractions
from partialslip.march import driver
from partialslip.march.cell_stress import CellStresses
from partialslip.march.cells import (
    NEAR_ENDS,
    cells_around,
    compliance,
    contact_line,
    friction_on,
    norm_parts,
    on_cells,
    relative_change,
)
from partialslip.march.driver import LastLevel
from partialslip.march.pressing import NormalLoads
from partialslip.result import Clock, Result, StressAt, Traction
from partialslip.result.state import State
from partialslip.scene import Scene
from partialslip.scene.plan import Plan
from partialslip.tools.arrays import Array
from partialslip.tools.bars import LEAST_SHEAR

_MESHES = ((1e-2, 0.2), (1e-3, 0.1), (1e-4, 0.05), (1e-5, 0.025))  # accuracy: (cell size at the ends, in a; growth)
_CELLS, _SOMEWHERE = 4.0, 0.5  # accuracy: a zone of fewer cells is unresolved: the error of an end in cells
_AT_BENDS = 32.0  # cost: most size of cells at kinks of the coefficient of friction, over the size at the ends
# cost: Excess of errors up to which the next mesh is halfway, which mostly divides them by 4 to 20; the same of q, q1
# and q2 after the first step, when halfway meshes hardly reduce the estimates of these
_NEARLY = 3.0, 0.7
_WORK = 5e11  # limit: cells^3 times load steps of a mesh
_LEG = 6.0  # cost: work of a leg that is followed while cells touch and open, over that of a load step (measured)
_HALVED = 1.7  # accuracy: growth that is less reduced is that of a halfway mesh: 2 times is usual, sqrt(2) halfway
# accuracy: Errors of m and n, as parts of the change to the next mesh and to a halfway one (measured:
# benchmarks/estimates.py), and of growth^3. Parts of growth^3 and of growth^2 of ends that are soft, over their
# stiffness, 1 in Hertz contacts: an error of the loads moves an end the more the less stiff the end is. It falls with
# growth^2, but the first meshes err by more (measured on 18 ends)
_MOVED, _CUBIC = (0.1, 0.43), 0.15
_CUBIC_OF_SOFT, _SQUARE_OF_SOFT = 0.05, 2.5e-3
# accuracy: The same part in a narrow stick zone, which its surroundings move as a whole. Cells nearby are reduced
# with the zone: only growth is halved from mesh to mesh, and errors are of second order in it
_CARRIED = 1 / 3, 1.0
# accuracy: The same where slip turns round; also, at an end that moves over cells that slipped, parts of the cell's
# size; and parts of the change of q, which is locked in where the zone has moved, by the share of such points
# (measured)
_TURNED, _CAUGHT_UP, _LOCKED = 2.0, 0.5, 0.2
# accuracy: cells inside an end of the stick zone from which its stiffness is found; least stiffness
_FITTED, _SOFTEST = 4, 1e-3
# accuracy: errors of q, q1 and q2 as parts of the change to the second mesh, to later meshes, and to halfway ones
_CHANGED, _CHANGED_HALFWAY = (0.4, 0.35), 0.5
# accuracy: the same where slip turns round, in those: what the way locks in does not fall with each mesh (measured: of
# 196 scenes 13 were beyond, at most 3.9 times)
_LOCKED_IN = 2.0
_SEVERAL = "more than one zone sticks, as the coefficient of friction varies"
Added = Callable[[Array], Array]


@dataclass(frozen=True)
class SimilarLevel(driver.Level):
    """Solution on one mesh of cells; lengths in half-widths of the frame (:class:`NormalLoads`) from its middle, forces
    in P.
    ``pressed`` are the normal forces, ``kinks`` are those of q at the load points; ``stepped`` are errors due to the
    load steps, from the mesh on which these were chosen last. ``number``: of the mesh, from 0; ``growth``: its growth.
    ``trail``: where load steps on the next mesh begin.
    """

    pressed: Array
    kinks: tuple[float, ...] = ()
    stepped: Errors = field(default_factory=dict)
    number: int = 0
    growth: float = 0.0
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

    nearly = _NEARLY

    def __init__(self, scene: Scene, plan: Plan, start: State | None, clock: Clock, added: Added | None) -> None:
        self.added, self.normal, path = added, NormalLoads.of(scene), load_path(scene, plan, start)
        # a path out of phase takes more than one coarse mesh to find its stick zone
        self.coarse = 2 if path and not path.in_phase and len(_MESHES) > 1 else 1
        frame, meshes = self.normal.frame, (*_MESHES[:1] * self.coarse, *_MESHES[1:])
        super().__init__(scene, start, clock, path, (frame.centre, frame.a), meshes)
        self._ends = [*self.normal.ends, *self.normal.within(scene.profile.kinks)]
        self._inner = self.normal.within(finest(start.q.x)) if start else []
        self._friction = self.normal.within(scene.friction.sharp_kinks(self.length))

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
        number, stepped = (level.number + 1, level.stepped) if level else (0, Errors())
        first = number == self.coarse
        choose = first or (steps_matter(stepped, self.scene.fem.accuracy) and not self.clock.limited)
        cells = self.cells(level, mesh)
        found = _solve_level(self, cells, choose, level.trail if level else None)
        if first and found.history:
            self.path = found.history.path
        return replace(found, stepped=found.stepped or stepped, number=number, growth=mesh[1])

    def mesh_errors(self, level: SimilarLevel, before: SimilarLevel) -> Errors:
        return _mesh_errors(self.normal, level, before, level.number == self.coarse)

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


def _mesh_errors(normal: NormalLoads, level: SimilarLevel, before: SimilarLevel, first: bool) -> dict[str, float]:
    """Discretisation errors of m and n (in half-widths of the contact at the largest P) and of q, q1 and q2 (relative
    L2 of cell averages).

    Errors of m and n are a part of the change from the mesh ``before``, or a multiple of growth^3 or growth^2, the
    latter the larger the less stiff the end is. Errors of q are a part of the change, for which ``first`` tells whether
    the mesh before is the first one. The factors are calibrated on random scenes with known solutions.
    """
    assert level.stick
    assert before.stick
    assert level.history
    assert before.history
    left, right = normal.common
    gaps = np.diff([left, *level.zone, right])
    # an end of the stick zone at the end of the contacts is known
    gap = np.minimum(np.where(gaps[:-1] > 0, gaps[:-1], np.inf), np.where(gaps[1:] > 0, gaps[1:], np.inf))
    cells = np.clip(np.searchsorted(level.vertices, level.zone) - 1, 0, len(level.pressed) - 1)
    size = np.diff(level.vertices)[cells]
    unseen = _SOMEWHERE * size * (gap < _CELLS * size)
    moved = max(abs(level.stick.left - before.stick.left), abs(level.stick.right - before.stick.right))
    growth = level.growth
    soft = max(_CUBIC_OF_SOFT * growth**3, _SQUARE_OF_SOFT * growth**2)
    between = np.maximum(_CUBIC * growth**3, soft / _stiffness(level))
    between *= np.minimum(NEAR_ENDS * gap, 1.0)
    part = _CARRIED if NEAR_ENDS * gaps[1] < 1 else _MOVED
    halfway = not first and before.growth < _HALVED * level.growth
    changed = _CHANGED_HALFWAY if halfway else _CHANGED[not first]
    known = np.maximum(unseen, np.maximum(part[halfway] * moved, between))
    changes = {
        key: changed * _apart(level, of, before.history, before.vertices, 2 if key == "q" else 1)
        for key, of in SHEARS.items()
    }
    if level.history.turns:
        known = _TURNED * known + _CAUGHT_UP * size * np.array(level.stick.moved)
        known = np.maximum(known, _LOCKED * _passed(level) * changes["q"]) + level.stick.strips
        changes = {key: _LOCKED_IN * change for key, change in changes.items()}
    known *= normal.frame.a / normal.largest.a
    return dict(zip("mn", known.tolist(), strict=True)) | changes


def _passed(level: SimilarLevel) -> float:
    """Share of the stick zone whose points slip on the way."""
    assert level.stick
    assert level.history
    still = permanent_zone(level.x, level.history, level.stick)
    if still is None or level.stick.left == level.stick.right:
        return 0.0
    width = 0.0 if np.isnan(still[0]) else still[1] - still[0]
    return 1.0 - width / (level.stick.right - level.stick.left)


def _stiffness(level: SimilarLevel) -> Array:
    """Stiffness K of the ends of the stick zone, (2,), at most 1: f p - |dq|/2 is K f p0 sqrt(2 c r)/a at a small
    distance r inside an end, with p0 of a Hertz contact and the half-width c of the zone. Beside the flat part of a
    punch K is small. 1 at ends that moved over cells that slipped, where the room begins with another power."""
    history, stick, vertices = level.history, level.stick, level.vertices
    assert history
    assert stick
    after, c = np.searchsorted(vertices, level.zone), (stick.right - stick.left) / 2
    ranges = (after[0] - 1, after[0] + _FITTED), (after[1] - 1 - _FITTED, after[1])
    found = np.ones(2)
    for side, (first, last) in enumerate(np.clip(ranges, 0, len(vertices) - 1).tolist()):
        if stick.moved[side] or c == 0:
            continue
        room = float((history.bound - stick.signs[side] * history.change / 2)[first:last].sum())
        r = abs(float(vertices[first if side else last]) - level.zone[side])
        hertz = float(history.bound.sum()) * (2 / np.pi) * np.sqrt(2 * c) * (2 / 3) * r**1.5
        found[side] = np.clip(room / hertz, _SOFTEST, 1.0)
    return found


def _apart(level: SimilarLevel, of: Callable[[History], Array], other: History, cells: Array, shears: int) -> float:
    """Relative L2 difference of the means over ``cells`` (c + 1,), the cells of the ``other`` history, of the forces
    ``of`` the level and of the other history, which are sums of 1 or 2 ``shears``."""
    assert level.history
    known, bound = (norm_parts(level.vertices, each, cells) for each in (of(level.history), level.history.bound))
    others = norm_parts(cells, of(other), cells)
    return relative_change(known, others, shears * LEAST_SHEAR * float(np.linalg.norm(bound)))
