"""What changed from one mesh of cells to another: ends of zones, and tractions as means over cells."""

import numpy as np

from partialslip.friction.history import SHEARS, History
from partialslip.friction.step_errors import Errors
from partialslip.march.cells import off_cells, on_cells
from partialslip.tools.arrays import Array
from partialslip.tools.bars import LEAST_SHEAR

_CELLS = 4.0  # accuracy: a zone of fewer cells is unresolved


def of_ends(found: Array, others: Array) -> float:
    """The largest change of left and right ends: where one of them happens to stay, it is not known any better."""
    return float(np.abs(found - others).max())


def of_zone(vertices: Array, zone: Array, other: Array) -> float:
    """Change of the stick ``zone`` (left, right end) on cells between ``vertices`` (n + 1,) since the ``other``, and no
    less than what these cells cannot see."""
    return max(of_ends(zone, other), unseen(vertices, zone))


def unseen(vertices: Array, zone: Array) -> float:
    """Half of a cell where the ``zone`` (left, right end) is narrower than a few cells between ``vertices`` (n + 1,):
    meshes that do not resolve a zone agree on where it is not. Otherwise zero."""
    cells = np.diff(vertices)
    size = float(cells[np.clip(np.searchsorted(vertices, zone) - 1, 0, len(cells) - 1)].max())
    return size / 2 if zone[1] - zone[0] < _CELLS * size else 0.0


def of_shear(vertices: Array, history: History, cells: Array, other: History) -> Errors:
    """Changes of q, q1 and q2 (:func:`of_traction`), of the ``history`` on cells between ``vertices`` (n + 1,) from the
    ``other`` one on ``cells`` (c + 1,). Each is relative to at least a part of the bound f p; q is half of dq."""
    least = {key: LEAST_SHEAR * (2 if key == "q" else 1) * other.bound for key in SHEARS}
    return {key: of_traction(vertices, of(history), cells, of(other), least[key]) for key, of in SHEARS.items()}


def of_traction(vertices: Array, forces: Array, cells: Array, others: Array, least: float | Array = 0.0) -> float:
    """L2 distance of ``forces`` (n,) between ``vertices`` (n + 1,) from the ``others`` (c,) on ``cells`` (c + 1,), of
    means over these, relative to their norm or to that of the ``least`` forces (c,)."""
    found = on_cells(off_cells(forces, vertices), cells)  # the meshes have hardly a vertex in common
    off, *sizes = (float(np.linalg.norm(each / np.sqrt(np.diff(cells)))) for each in (others - found, found, least))
    return off / max(sizes) if max(sizes) > 0 else 0.0
