"""Displacements of both bodies, solved back from the contact forces; only when they are asked for."""

import numpy as np

from partialslip.result import DeformedBody
from partialslip_fem.level import Level, Problem
from partialslip_fem.mortar import transfer


def displaced(level: Level, problem: Problem, length: float, unit: float) -> tuple[DeformedBody, DeformedBody]:
    """The lower and the upper body with their displacements at load points 1 and 2.

    Positive q is what the lower body exerts on the upper one, and the tension sigma is the lower body's. The
    displacements are those under the contact tractions and the tension.

    Parameters
    ----------
    length, unit : float
        What lengths and displacements are scaled by, m.
    """
    history, line = level.history, level.body
    ends = zip(history.at_ends, history.bounds, strict=True) if history else ()
    loads = [(level.on_line(shear), level.on_line(bound) / problem.f) for shear, bound in ends]
    loads = loads or [(0 * line.x, level.pressing.x)] * 2
    strains = [history.path.cycle[end][1] for end in history.path.ends] if history else [0.0, 0.0]
    bodies = []
    for half, part, way in zip((level.halves * 2)[:2], (problem.parts * 2)[:2], (1, -1), strict=True):
        # the upper body is the mirror image of one below its contact line, on which q acts the other way round
        forces = np.array([np.concatenate([-way * shear, -normal]) for shear, normal in loads]).T
        if half is not level.halves[0]:
            back = transfer(line, half.body).T
            forces = np.concatenate([back @ forces[: len(line.x)], back @ forces[len(line.x) :]])
        moved = np.moveaxis(half.condensed.displace(forces)[half.body.vertices], -1, 0)
        points, triangles, mirror = half.mesh.points.T, half.mesh.triangles, np.array([[1.0], [way]])
        if way > 0:
            stretch = points * np.array([[1.0], [-(3 - part.kappa) / (1 + part.kappa)]])
            moved = moved + np.multiply.outer(strains, stretch)
        bodies.append(
            DeformedBody(
                "lower" if way > 0 else "upper",
                length * (points * mirror).T,
                triangles[:, ::way],
                half.mesh.lines,
                {f"displacement_{point}": unit * (u * mirror).T for point, u in enumerate(moved, start=1)},
            )
        )
    lower, upper = bodies
    return lower, upper
