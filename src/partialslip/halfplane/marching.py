"""Marching in time: the exact pressure, and shear step by step through any load history at constant P.

Unlike the steady closed form it knows what the first cycles lock in. Cells of constant shear traction, graded to the
ends of the contact and of the stick zone that it finds itself; each step is a convex problem with a certificate.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import PPoly

from partialslip.condensed.friction import History, Path, certificate, doubts, judge, load_path, march
from partialslip.condensed.threads import one_thread
from partialslip.condensed.zones import Zone, apart, stick_zone
from partialslip.halfplane.cells import compliance, forces, graded
from partialslip.halfplane.contact import Contact, contact
from partialslip.plan import Plan
from partialslip.result import Array, Clock, Result, Slip, Traction
from partialslip.scene import Scene
from partialslip.state import State

# Errors of m and n fall at least fivefold from mesh to mesh, so that a quarter of the last change bounds the rest.
_MESHES = ((1e-2, 0.2), (1e-3, 0.1), (1e-4, 0.05), (1e-5, 0.025))  # cell size at the ends (in a), and growth
_CELLS, _SOMEWHERE = 4.0, 0.5  # between zones with fewer cells than that an end is somewhere in one of them


@dataclass(frozen=True)
class _Level:
    """The solution on one mesh of cells; lengths in contact half-widths, forces in P."""

    vertices: Array
    pressed: Array
    history: History | None
    stick: Zone | None


@one_thread
def solve(
    scene: Scene, plan: Plan, progress: Callable[[str], None] = lambda _: None, start: State | None = None
) -> Result:
    """Solve ``scene`` by marching through its load history, as two elastically similar half-planes.

    Parameters
    ----------
    scene, plan
        The scene, and which effects it calls for.
    progress : callable, optional
        Called with one line after each mesh.
    start : State, optional
        What the path of the loads begins with, instead of bodies without shear.
    """
    clock = Clock()
    pressed = contact(scene)
    path = load_path(scene, plan, start)
    ends = [-1.0, 1.0, *(kink / pressed.a for kink in scene.profile.kinks if abs(kink) < pressed.a)]
    level: _Level | None = None
    errors: dict[str, float] = {}
    meshes, iterations = 0, 0
    for size, growth in _MESHES:
        found = [level.stick.left, level.stick.right] if level and level.stick else []
        points = np.sort(apart([*ends, *found], size))
        before, level = level, _solve_level(scene, pressed, path, start, graded(points, size, growth), clock)
        meshes, iterations = meshes + 1, iterations + (level.history.iterations if level.history else 0)
        if level.stick is None:
            break
        if before and before.stick:
            moved = {"m": level.stick.left - before.stick.left, "n": level.stick.right - before.stick.right}
            unseen = _SOMEWHERE * size * (np.diff([-1.0, level.stick.left, level.stick.right, 1.0]) < _CELLS * size)
            beside = np.maximum(unseen[:-1], unseen[1:])
            errors = {key: max(abs(moved[key]) / 4, least) for key, least in zip(moved, beside.tolist(), strict=True)}
            progress(f"mesh {meshes}: {len(level.pressed):,} cells, m, n known to {max(errors.values()):.1e} a")
            if max(errors.values()) <= scene.fem.accuracy:
                break
    assert level is not None
    return _result(scene, pressed, level, errors, {"meshes": meshes, "iterations": iterations}, clock)


def _solve_level(
    scene: Scene, pressed: Contact, path: Path | None, start: State | None, vertices: Array, clock: Clock
) -> _Level:
    normal = forces(pressed.shape, vertices)
    if not path:
        return _Level(vertices, normal, None, None)
    x = (vertices[1:] + vertices[:-1]) / 2
    bound = scene.friction.f * normal
    if start:
        resultant, known = start.q.antiderivative(), start.q.x
        before = np.diff(resultant(np.clip(vertices * pressed.a, known[0], known[-1]))) / scene.P
        path = replace(path, before=before)
    with clock.phase("compliance"):
        tangential = compliance(vertices / 2)  # a change of length is a rigid shift, which is free
    with clock.phase("contact"):
        history = march(tangential, x * pressed.a / scene.length, bound, path)
        stick = stick_zone(x, bound, history.change, vertices, lambda values: values)
    return _Level(vertices, normal, history, stick)


def _result(
    scene: Scene, pressed: Contact, level: _Level, errors: dict[str, float], counts: dict[str, int], clock: Clock
) -> Result:
    P, a, p0, widths, history = scene.P, pressed.a, pressed.p0, np.diff(level.vertices), level.history
    certified = certificate(history, widths, scene.friction.f, 2 / np.pi) if history else {}
    found = judge(scene, history, level.stick, 1.0)
    x = (level.vertices[1:] + level.vertices[:-1]) / 2
    q1, q2 = (P / a * force / widths for force in (history.q1, history.q2)) if history else (0 * x, 0 * x)
    unit = scene.material.A * P  # of displacement

    def at(points: Array) -> tuple[Array, Array]:
        scaled = points / a
        cell = np.clip(np.searchsorted(level.vertices, scaled) - 1, 0, len(x) - 1)
        return pressed.pressure(points), np.where(np.abs(scaled) <= 1, (q2 - q1)[cell], 0.0)

    return Result(
        method="march",
        a=a,
        p0=p0,
        regime=found.regime,
        stick_centre=None if found.centre is None else found.centre * a,
        stick_half_width=None if found.half_width is None else found.half_width * a,
        traction=Traction(
            x=x * a,
            p=pressed.pressure(x * a),
            dq=q2 - q1,
            q1=q1 if found.regime != "sliding" else None,
            q2=q2 if found.regime != "sliding" else None,
            at=at,
            breaks=level.vertices * a,
            cells=level.vertices * a,
        ),
        cost=clock.cost(),
        state=_state(scene, level, a) if history else None,
        slip=Slip(x * a, history.slip * unit, history.dissipated * unit * P) if history else None,
        settings={"model": "two half-planes, exact pressure, cells of constant shear", "accuracy": scene.fem.accuracy},
        counts={
            "cells": len(x),
            "tangential_unknowns": len(x) if history else 0,
            "cycles": history.cycles if history else 0,
            "load_steps": history.load_steps if history else 0,
            "friction_iterations": history.changes if history else 0,
            "opposing_nodes": history.opposing if history else 0,
            **counts,
        },
        certificate=certified,
        estimate=errors,
        notes=found.notes + doubts(certified, errors, scene.fem.accuracy),
    )


def _state(scene: Scene, level: _Level, a: float) -> State:
    """What the path of the loads ends with."""
    assert level.history
    shear, bound = level.history.end
    stress = scene.P / (a * np.diff(level.vertices))
    p, q = (PPoly((stress * forces)[None], a * level.vertices) for forces in (bound / scene.friction.f, shear))
    return State(scene.P, scene.material.A, *scene.load.points[-1], p, q)
