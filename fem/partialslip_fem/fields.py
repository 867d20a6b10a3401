"""Fields for the result: stresses along the surfaces and inside, the displaced bodies."""

from collections.abc import Sequence

import numpy as np
from scipy.interpolate import PPoly

from partialslip.result import Array, DeformedBody, SurfaceStress
from partialslip_fem.displacements import Moved
from partialslip_fem.elasticity import gradients
from partialslip_fem.recovery import inside, polynomials

_CELLS, _TERMS = 6, 4  # in the fit at the ends of the contact


def along_surfaces(
    bodies: Sequence[Moved], ends: Sequence[tuple[float, float]], length: float, stress: float
) -> SurfaceStress:
    """sigma_xx along both surfaces, the lower body's and the upper one's.

    With the strain e of the surface and the pressure p on it, of a body of compliance A = (kappa+1)/(2 mu),

        sigma_xx = (4/A) e - (3-kappa)/(kappa+1) p,

    and beyond the body nothing.

    Parameters
    ----------
    bodies : two of Moved
    ends : two of (float, float)
        Where the contact ends, at load points 1 and 2; scaled.
    length, stress : float
        What lengths and stresses are scaled by, m and Pa.
    """
    moved = [
        [polynomials(half.face_x, u, half.order) for u in body.u[:, 0, half.face]]
        for body in bodies
        for half in (body.half.body,)
    ]

    def at(points: Array) -> Array:
        x = np.asarray(points, float) / length
        sigma = [
            [
                4 / body.part.compliance * inside(u.derivative(), x)
                - (3 - body.part.kappa) / (body.part.kappa + 1) * inside(p, x)
                for u, p in zip(of_body, body.pressures, strict=True)
            ]
            for body, of_body in zip(bodies, moved, strict=True)
        ]
        return stress * np.array(sigma)

    nodes = bodies[0].half.body.face_x
    x = np.union1d(nodes, ends)
    sigma = at(length * x)
    for number, (body, of_body) in enumerate(zip(bodies, moved, strict=True)):
        for load, (u, (left, right)) in enumerate(zip(of_body, ends, strict=True)):
            for end, side in ((left, -1), (right, 1)):
                at_end = stress * 4 / body.part.compliance * _strain_beyond(u, end, side)
                sigma[number, load, np.searchsorted(x, end)] = at_end
    return SurfaceStress(length * x, sigma, at)


def _strain_beyond(u: PPoly, end: float, side: int) -> float:
    """Strain of the surface at the contact's ``end``, coming from outside (``side``).

    It goes like c_0 + c_1 r^(1/2) + c_2 r + ... with the distance r, which polynomials do not follow. Means over cells
    are far better than their values: fit those, of the cells next to the one at the end.
    """
    distance = np.sort(side * (u.x - end))
    distance = distance[distance > 0][1 : _CELLS + 2]
    powers, scale = np.arange(_TERMS) / 2, distance[-1]
    grown = (distance[:, None] / scale) ** (powers + 1) / (powers + 1)
    means = np.diff(u(end + side * distance)) * side
    weights = 1 / np.diff(distance)
    fit, *_ = np.linalg.lstsq(np.diff(grown, axis=0) * scale * weights[:, None], means * weights)
    return float(fit[0])


def deformed(body: Moved, length: float, unit: float, stress: float) -> DeformedBody:
    """Displacements of the mesh's points and stresses in the middle of its triangles.

    Parameters
    ----------
    length, unit, stress : float
        What lengths and displacements are scaled by, m, and stresses, Pa.
    """
    mesh, mirror = body.half.mesh, np.array([[1.0], [body.way]])
    moved = body.u[..., body.half.body.vertices[0]]
    stresses = _in_the_middle(body)
    return DeformedBody(
        "lower" if body.way > 0 else "upper",
        length * (mesh.points.T * mirror).T,
        mesh.triangles[:, :: body.way],
        mesh.lines,
        {f"displacement_{point}": unit * (u * mirror).T for point, u in enumerate(moved, start=1)},
        {f"stress_{point}": stress * sigma.T for point, sigma in enumerate(stresses, start=1)},
    )


def _in_the_middle(body: Moved) -> Array:
    """sigma_xx, sigma_yy and sigma_xy in the middle of the triangles, (2, 3, t), by load point; scaled."""
    kappa = body.part.kappa
    mu = (kappa + 1) / (2 * body.part.compliance)
    lam = mu * (3 - kappa) / (kappa - 1)
    result = []
    for u in body.u:
        (xx, xy), (yx, yy) = gradients(body.half.mesh, body.half.body.order, u)
        volume = lam * (xx + yy)
        result.append([volume + 2 * mu * xx, volume + 2 * mu * yy, body.way * mu * (xy + yx)])
    return np.array(result)
