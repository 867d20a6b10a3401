"""Errors of the stresses along the surfaces and inside the bodies."""

import numpy as np

from partialslip.judge.means import means
from partialslip.result import Result

_NEAR = 3.0  # contact half-widths within which stresses inside are compared
_POINTS = 60  # along each side of the square of points


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
    """Return the relative L2 error, by area, of the stresses within 3 a of both bodies, at fixed points.

    None if ``result`` or ``reference`` has no stresses inside. Points outside a body do not count.
    """
    if not result.stress_at or not reference.stress_at:
        return None
    line = (np.arange(_POINTS) + 0.5) * (2 / _POINTS) - 1
    x, y = (_NEAR * reference.a * each.ravel() for each in np.meshgrid(line, line))
    found, true = (stresses(x, y) for stresses in (result.stress_at, reference.stress_at))
    both = np.isfinite(found).all(axis=(0, 1)) & np.isfinite(true).all(axis=(0, 1))
    off, norm = (np.linalg.norm(each[..., both]) for each in (found - true, true))
    return float(off / norm)
