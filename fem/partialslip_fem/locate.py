"""Elements in which points lie."""

import numpy as np
from scipy.spatial import cKDTree

from partialslip.tools.arrays import Array, Indices

_STARTS = 6  # cost: nearest triangles from which the way to a point is tried
_STEPS = 1000  # limit: triangles on a way
_EDGE = 1e-9  # accuracy: barycentric coordinate above which a point is not outside


class Locator:
    """Finds the ``triangles`` (t, 3) of ``corners`` (n, 2) in which points lie: walks from near triangles across edges.

    Local coordinates are those in the order of each triangle's corners.
    """

    def __init__(self, corners: Array, triangles: Indices) -> None:
        corners = corners[triangles]
        self._tree, self._origin = cKDTree(corners.mean(axis=1)), corners[:, 0]
        self._inverse = np.linalg.inv(np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], axis=2))
        self._beside = _neighbours(triangles)

    def __call__(self, points: Array) -> tuple[Indices, Array]:
        """Triangle (k,), -1 outside the mesh, and local coordinates (2, k) of ``points`` (k, 2)."""
        cell, local = np.full(len(points), -1), np.zeros((2, len(points)))
        left = np.arange(len(points))
        for start in range(min(_STARTS, len(self._origin))):
            _, near = self._tree.query(points[left], [start + 1])
            cell[left], local[:, left] = self._walk(points[left], near[:, 0])
            left = left[cell[left] < 0]
            if not len(left):
                break
        return cell, local

    def _walk(self, points: Array, cell: Indices) -> tuple[Indices, Array]:
        cell, found, local = cell.copy(), np.full(len(cell), -1), np.zeros((2, len(cell)))
        active = np.arange(len(cell))
        for _ in range(_STEPS):
            here = cell[active]
            at = np.einsum("kij,kj->ki", self._inverse[here], points[active] - self._origin[here])
            coordinates = np.column_stack([1 - at.sum(axis=1), at])
            least = coordinates.argmin(axis=1)
            inside = coordinates[np.arange(len(at)), least] >= -_EDGE
            found[active[inside]], local[:, active[inside]] = here[inside], at[inside].T
            cell[active] = self._beside[here, least]
            active = active[~inside & (cell[active] >= 0)]
            if not len(active):
                break
        return found, local


def _neighbours(triangles: Indices) -> Indices:
    """Triangles (t, 3) across the edges opposite each corner, -1 where there is none."""
    edges = np.sort(triangles[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2), axis=1)
    order = np.lexsort(edges.T)
    same = (edges[order[1:]] == edges[order[:-1]]).all(axis=1)
    one, other = order[:-1][same], order[1:][same]
    result = np.full(len(edges), -1)
    result[one], result[other] = other // 3, one // 3
    return result.reshape(-1, 3)
