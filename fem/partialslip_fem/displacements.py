"""Displacements inside both bodies, from the contact forces."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PPoly

from partialslip.tools.arrays import Array
from partialslip_fem.contact import CondensedBody
from partialslip_fem.mesh_solution import MeshSolution
from partialslip_fem.mortar import transfer
from partialslip_fem.problem import Part, ScaledProblem
from partialslip_fem.recovery import traction


@dataclass(frozen=True)
class DisplacedBody:
    """A body under the contact tractions and its bulk tension, at load points 1 and 2; scaled.

    Parameters
    ----------
    condensed : CondensedBody
    part : Part
    way : int
        1 for the lower body; -1 for the upper body, whose mesh is a mirror image below its contact line.
    u : (2, 2, N) array
        Displacements of the nodes on sides of elements, by load point and component.
    pressures : two of PPoly
        Pressure on the contact line, by load point.
    """

    condensed: CondensedBody
    part: Part
    way: int
    u: Array
    pressures: tuple[PPoly, ...]


def displace_bodies(solution: MeshSolution, problem: ScaledProblem) -> tuple[DisplacedBody, DisplacedBody]:
    """Solve for the displacements of the lower and the upper body in ``solution`` of ``problem``.

    Positive q acts from the lower on the upper body; the bulk tension acts in the lower body.
    """
    history, line = solution.history, solution.lower
    loads = solution.forces
    pressures = tuple(traction(line, normal) for _, normal in loads)
    strains, angles = np.array(problem.strains), history.angles if history else (solution.pressing.turn,) * 2
    displaced = []
    for condensed, part, way in zip((solution.bodies * 2)[:2], (problem.parts * 2)[:2], (1, -1), strict=True):
        # q acts in the opposite direction on the lower body
        forces = np.array([np.concatenate([-way * shear, -normal]) for shear, normal in loads]).T
        if condensed is not solution.bodies[0]:
            back = transfer(line, condensed.body).T
            forces = np.concatenate([back @ forces[: len(line.x)], back @ forces[len(line.x) :]])
        u = condensed.condensation.displace(forces[-condensed.condensation.columns :]).T.reshape(2, 2, -1)
        if way > 0:
            u = u + np.multiply.outer(strains[:, 0], condensed.stretched)
            if strains[:, 1].any():  # only half-planes: x counts from the scene's x = 0
                u = u + np.multiply.outer(strains[:, 1], condensed.bent + problem.origin * condensed.stretched)
        if problem.pin is not None and part.support == "pivot":
            u = u + np.multiply.outer(angles, condensed.turned(abs(problem.pin)))
        displaced.append(DisplacedBody(condensed, part, way, u, pressures))
    lower, upper = displaced
    return lower, upper
