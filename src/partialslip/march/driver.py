"""Marching on finer and finer cells: one driver for bodies of like and of unlike materials.

Each of these problems solves p and q on given cells, tells the errors of these cells, and what the result is made of.
Scaled: lengths by the unit of the problem, forces by P, displacements by A P.
"""

from abc import abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Generic, TypeVar

import numpy as np

from partialslip.friction.history import History
from partialslip.friction.load_path import Path
from partialslip.friction.regime import doubts
from partialslip.friction.restart import begun, end_state
from partialslip.friction.step_errors import Errors
from partialslip.friction.work import work, work_error
from partialslip.friction.zone_ends import StickInterval
from partialslip.march.cells import off_cells, on_cells
from partialslip.result import Clock, Pace, Result, Slip, SteadyState, Traction
from partialslip.result.refining import OnMesh, Refinable, refine
from partialslip.result.state import State
from partialslip.scene import Scene
from partialslip.tools.arrays import Array, Indices
from partialslip.tools.bars import BARS

# accuracy: growth of cells, mesh by mesh: sqrt(2), for :meth:`CellProblem.mesh_errors`. On the first mesh nothing is
# known of the stick zone; out of phase the second one is to find it, too
_GROWTHS = (0.28, 0.28, 0.2, 0.14, 0.1, 0.07, 0.05, 0.035, 0.025, 0.0175)
# accuracy: (cell size at the ends, in a; growth): fine meshes look for narrow zones with far smaller cells
MESHES = tuple((min(4e-3 * growth, 2.0 * growth**3.3), growth) for growth in _GROWTHS)
COARSE = 3  # accuracy: of these, before the first one whose errors are estimated
_TIMES = 2.0  # accuracy: errors over changes (measured: benchmarks/estimates.py)
_LEFT = 3.0  # cost: times the seconds of the next mesh that must be left: finite elements follow in the same run


@dataclass(frozen=True)
class Level:
    """Solution on one mesh of cells with the ends ``vertices`` (c + 1,): the ``history`` of their shear and the zone
    ``stick``, scaled; None without friction."""

    vertices: Array
    history: History | None
    stick: StickInterval | None

    @property
    def x(self) -> Array:
        """Middles of the cells (c,)."""
        return (self.vertices[1:] + self.vertices[:-1]) / 2


L = TypeVar("L", bound=Level)


@dataclass(frozen=True)
class LastLevel:
    """What a problem tells of its last level, in SI units.

    Parameters
    ----------
    a, p0 : float
    found : SteadyState
        Scaled.
    traction : Traction
    cells : slice or indices
        Cells of the history that are in contact.
    pressed : (c,) array
        Normal forces on the cells at the end of the path, scaled.
    certificate : dict of float
    change : float or None
        Change of q in the last cycle, in f p0.
    model : str
        What is solved, in words.
    counts : dict of int
    contact_ends : two of (float, float) or None
    notes : tuple of str
        On the load steps.
    """

    a: float
    p0: float
    found: SteadyState
    traction: Traction
    cells: slice | Indices
    pressed: Array
    certificate: Mapping[str, float]
    change: float | None
    model: str
    counts: Mapping[str, int]
    contact_ends: tuple[tuple[float, float], tuple[float, float]] | None
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Refined(OnMesh, Generic[L]):
    """A ``level`` and the one ``before`` it, and its errors: those ``meshed`` are due to the cells, those ``stepped``
    to the load steps."""

    level: L
    before: L | None
    meshed: Errors = field(default_factory=Errors)
    stepped: Errors = field(default_factory=Errors)

    @property
    def unknowns(self) -> str:
        return f"{len(self.level.vertices) - 1:,} cells"

    @property
    def errors(self) -> Errors:
        return {key: error + self.stepped.get(key, 0.0) for key, error in self.meshed.items()}

    @property
    def shares(self) -> dict[str, Errors]:
        """Errors by what they are due to."""
        return {name: each for name, each in (("discretisation", self.meshed), ("steps", self.stepped)) if each}


class CellProblem(Refinable[Refined[L]]):
    """Bodies that are pressed together and sheared, on cells.

    ``origin`` and ``length`` (m) are those of scaled coordinates, ``path`` is that of the loads. ``steps_count``:
    whether the errors of load steps leave less to those of the cells.
    """

    steps_count = True

    def __init__(
        self,
        scene: Scene,
        start: State | None,
        clock: Clock,
        path: Path | None,
        frame: tuple[float, float],
    ) -> None:
        self.scene, self.start, self.clock, self.path = scene, start, clock, path
        self.origin, self.length = frame
        self.iterations = 0

    def places(self, level: L) -> Array:
        """Ends of the cells, m."""
        return self.origin + self.length * level.vertices

    @abstractmethod
    def cells(self, level: L | None, mesh: tuple[float, float]) -> Array:
        """Ends of the cells (c + 1,) of the ``mesh``, graded to the ends on the ``level`` before."""

    @abstractmethod
    def solve(self, level: L | None, mesh: tuple[float, float]) -> L:
        """Solve on the ``mesh`` after that of the ``level``."""

    @abstractmethod
    def changes(self, level: L, other: L) -> Errors:
        """Changes from the ``other`` level to this one, of ends in a and of tractions relative L2."""

    def mesh_errors(self, level: L, before: L, earlier: L) -> Errors:
        """Errors due to the cells of the ``level``: twice the changes since the level ``before``, whose cells are
        sqrt(2) times as large, and no less than the changes since the ``earlier`` one, whose cells are twice as large.

        An error C h^s changes by 2^(s/2) - 1 and 2^s - 1 of what is left of it: by all of it at s = 2 and s = 1.
        """
        late, early = self.changes(level, before), self.changes(level, earlier)
        return {key: max(_TIMES * late[key], early.get(key, 0.0)) for key in late}

    @abstractmethod
    def step_errors(self, level: L) -> Errors:
        """Errors due to the load steps."""

    def too_large(self, level: L, count: int) -> bool:  # noqa: ARG002
        """Whether a mesh with ``count`` ends of cells after that of the ``level`` is out of proportion."""
        return False

    def refined(self, before: Refined[L] | None) -> Refined[L]:
        last, earlier = (before.level, before.before) if before else (None, None)
        level = self.solve(last, MESHES[self.meshes])
        self.meshes += 1
        self.iterations += level.history.iterations if level.history else 0
        if not last or not earlier or self.meshes <= COARSE:
            return Refined(level, last)
        return Refined(level, last, self.mesh_errors(level, last, earlier), self.step_errors(level))

    def finished(self, found: Refined[L]) -> bool:
        if self.meshes == len(MESHES) or (found.errors and max(self._excess(found).values()) <= 1):
            return True
        return self.too_large(found.level, len(self.cells(found.level, MESHES[self.meshes])))

    def fits(self, pace: Pace, found: Refined[L]) -> bool:
        return not found.errors or pace.fits(_LEFT)

    def _excess(self, found: Refined[L]) -> Errors:
        """Errors due to the cells over what is allowed: at most 1 if finer cells are not needed, or of no use: they do
        not reduce the error of load steps."""
        allowed = {key: BARS[key] * self.scene.fem.accuracy for key in found.meshed}
        lost = found.stepped if self.steps_count else {}
        return {key: found.meshed[key] / max(most - lost.get(key, 0.0), most / 2) for key, most in allowed.items()}

    @abstractmethod
    def answer(self, level: L) -> LastLevel:
        """What the result is made of."""


def march(problem: CellProblem[L], progress: Callable[[str], None]) -> tuple[Result, L]:
    """Solve ``problem`` on finer and finer cells, until the errors are as small as the scene asks for, or the next
    mesh does not fit the allowance of its clock; errors are estimated in any case. Returns the result, and the
    level that it is of."""
    found = refine(problem, progress)
    return _result(problem, found), found.level


def _result(problem: CellProblem[L], found: Refined[L]) -> Result:
    scene, level, errors, shares = problem.scene, found.level, found.errors, found.shares
    history, answer, places = level.history, problem.answer(level), problem.places(level)
    accuracy, traction, widths = scene.fem.accuracy, answer.traction, np.diff(level.vertices)
    lost, notes = begun(errors, history, widths, problem.start, lambda state: on_cells(state.p, places) / scene.P)
    if lost:
        shares["start"] = lost
        errors = {key: error + lost.get(key, 0.0) for key, error in errors.items()}
    if answer.found.centre is None:
        errors = {key: error for key, error in errors.items() if key not in ("m", "n")}
    zones = answer.found.placed(problem.origin, problem.length)
    unit = scene.material.A * scene.P  # of displacement
    state = slip = None
    if history:
        p, q = (off_cells(scene.P * forces, places) for forces in (answer.pressed, history.end[0]))
        state = end_state(scene, p, q, errors, history, widths)
        other = found.before.history if found.before and errors else None
        off, energy = work_error(history, other, errors), unit * scene.P
        slip = Slip(
            traction.x,
            history.slip[answer.cells] * unit,
            work(history) * energy,
            None if off is None else off * energy,
        )
    return replace(
        Result.of("march", zones, answer.a, answer.p0, traction, problem.clock),
        state=state,
        slip=slip,
        settings={"model": answer.model, "accuracy": accuracy},
        counts={
            "cells": len(widths),
            "tangential_unknowns": len(widths) if history else 0,
            "cycles": history.cycles if history else 0,
            "load_steps": history.load_steps if history else 0,
            "steps": history.path.most_steps if history else 0,
            "opposing_nodes": history.opposing if history else 0,
            "meshes": problem.meshes,
            "iterations": problem.iterations,
            **answer.counts,
        },
        certificate=answer.certificate,
        last_cycle_change=answer.change,
        estimate=errors,
        shares=shares,
        notes=zones.notes + notes + answer.notes + doubts(answer.change, errors, accuracy),
        contact_ends=answer.contact_ends,
    )
