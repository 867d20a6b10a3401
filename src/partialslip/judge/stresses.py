"""Errors of the stresses along the surfaces and inside the bodies."""

import numpy as np

from partialslip.judge.means import means
from partialslip.result import Result

_NEAR = 3.0  # contact half-widths within which stresses inside are compared


def surface_error(result: Result, reference: Result) -> float | None:
    """Return the relative L2 error of sigma_xx along both surfaces, by averages over the cells of ``result``.

    None if ``result`` or ``reference`` has no surface stresses, or ``result`` no cells.
    """
    cells = result.traction.cells
    if not result.surface or not reference.surface or cells is None:
        return None
    breaks = np.union1d(result.traction.breaks, reference.traction.breaks)
    found, true = (means(each.at, cells, breaks) for each in (result.surface, reference.surface))
    widths = np.diff(cells)
    return float(np.sqrt(((found - true) ** 2 @ widths).sum() / (true**2 @ widths).sum()))


def inside_error(result: Result, reference: Result) -> float | None:
    """Return the relative L2 error, by area, of the stresses at the centroids of the triangles within 3 a.

    None if ``result`` has no bodies or ``reference`` no stresses.
    """
    if not result.bodies or not reference.stress_at:
        return None
    off, norm = 0.0, 0.0
    for body in result.bodies:
        corners = body.points[body.triangles]
        near = (np.abs(corners.mean(axis=1)) <= _NEAR * reference.a).all(axis=1)
        along, across = np.moveaxis(corners[near, 1:] - corners[near, :1], 0, -1)
        x, y = corners[near].mean(axis=1).T
        areas = np.abs(along[0] * across[1] - along[1] * across[0])
        truth = reference.stress_at(x, y)
        values = np.stack([stress[near].T for stress in body.stresses.values()])
        off, norm = off + float(((values - truth) ** 2 @ areas).sum()), norm + float((truth**2 @ areas).sum())
    return float(np.sqrt(off / norm))
