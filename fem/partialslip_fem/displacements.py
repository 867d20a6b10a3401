"""Displacements of both bodies, solved back from the contact forces; only when they are asked for."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PPoly

from partialslip.arrays import Array
from partialslip_fem.contact import Half
from partialslip_fem.level import Level, Part, Problem
from partialslip_fem.mortar import transfer
from partialslip_fem.recovery import traction


@dataclass(frozen=True)
class Moved:
    """A body under the contact tractions and its bulk tension, at load points 1 and 2; scaled.

    The upper body (``way`` = -1) is seen as the mirror image of one below its contact line. ``u`` (2, 2, N) are the
    displacements of all nodes by load point and component, ``pressures`` those on the contact line.
    """

    half: Half
    part: Part
    way: int
    u: Array
    pressures: tuple[PPoly, ...]


def solve_back(level: Level, problem: Problem) -> tuple[Moved, Moved]:
    """The lower and the upper body. Positive q is what the lower one exerts on the upper one, and sigma is its own."""
    history, line = level.history, level.body
    ends = zip(history.at_ends, history.bounds, strict=True) if history else ()
    loads = [(level.on_line(shear), level.on_line(bound) / problem.f) for shear, bound in ends]
    loads = loads or [(0 * line.x, level.pressing.x)] * 2
    pressures = tuple(traction(line, normal) for _, normal in loads)
    strains = [history.path.cycle[end][1] for end in history.path.ends] if history else [0.0, 0.0]
    bodies = []
    for half, part, way in zip((level.halves * 2)[:2], (problem.parts * 2)[:2], (1, -1), strict=True):
        # q acts the other way round on the upper body
        forces = np.array([np.concatenate([-way * shear, -normal]) for shear, normal in loads]).T
        if half is not level.halves[0]:
            back = transfer(line, half.body).T
            forces = np.concatenate([back @ forces[: len(line.x)], back @ forces[len(line.x) :]])
        u = half.condensed.displace(forces[-half.condensed.columns :]).T.reshape(2, 2, -1)
        if way > 0:
            u = u + np.multiply.outer(strains, half.stretched)
        bodies.append(Moved(half, part, way, u, pressures))
    lower, upper = bodies
    return lower, upper
