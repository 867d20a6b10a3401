"""Displacements of both bodies, solved back from the contact forces; only when they are asked for."""

import numpy as np

from partialslip.result import DeformedBody
from partialslip_fem.level import Level, Problem


def displaced(level: Level, problem: Problem, length: float, unit: float) -> tuple[DeformedBody, DeformedBody]:
    """The lower and the upper body with their displacements at load points 1 and 2.

    Positive q is what the lower body exerts on the upper one, and the tension sigma is the lower body's. The
    displacements are those under the contact tractions and the tension.

    Parameters
    ----------
    length, unit : float
        What lengths and displacements are scaled by, m.
    """
    body, n = level.body, len(level.body.x)
    forces = np.zeros((2 * n, 3))  # pressed; sheared at load points 1 and 2
    forces[n:, 0] = -level.pressing.x
    history = level.history
    for column, tangential in enumerate(history.at_ends if history else (), start=1):
        forces[:n, column] = level.on_line(tangential)
    far = level.far_field
    held = far.fields @ (far.moments @ forces) if far else np.zeros((body.far.size, 3))
    pressed, *sheared = np.moveaxis(level.condensed.displace(forces, held)[body.vertices], -1, 0)

    points = level.mesh.points.T
    stretch = points * np.array([[1.0], [-(3 - problem.kappa) / (1 + problem.kappa)]])
    strains = [history.path.cycle[end][1] for end in history.path.ends] if history else [0.0, 0.0]
    mirror = np.array([[1.0], [-1.0]])
    lower = [pressed - shear + strain * stretch for shear, strain in zip(sheared, strains, strict=True)]
    upper = [mirror * (pressed + shear) for shear in sheared]
    names = ("displacement_1", "displacement_2")
    mesh = level.mesh
    return (
        DeformedBody(
            "lower", length * mesh.points, mesh.triangles, mesh.lines,
            {name: unit * u.T for name, u in zip(names, lower, strict=True)},
        ),
        DeformedBody(
            "upper", length * mesh.points * mirror.T, mesh.triangles[:, ::-1], mesh.lines,
            {name: unit * u.T for name, u in zip(names, upper, strict=True)},
        ),
    )  # fmt: skip
