"""Vertices of the contact line at which at least three triangles meet.

Where only two triangles meet at a vertex of a straight side, incompressible elements of any order do not let the side
bend there: the divergence at the vertex, in one triangle less that in the other, is the jump of the side's slope along
the normal of their common edge. A nearly incompressible body then hardly moves under the forces that bend it there, so
that contact forces of this form are hardly determined: tractions oscillate from node to node.

Source: L. R. Scott and M. Vogelius, Norm estimates for a maximal right inverse of the divergence operator in spaces of
piecewise polynomials, M2AN 19 (1985) 111-143, who call such vertices singular.
"""

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from partialslip_meshes.mesh import Mesh

_FEWEST = 3  # fixed: triangles at a vertex that is not singular

_Rows = npt.NDArray[np.int64]


def fanned(mesh: Mesh) -> Mesh:
    """Halve triangles until at least three meet at each vertex inside the contact line.

    Of the two triangles at a vertex the one with the larger angle is halved, and so is its neighbour across the
    opposite edge. No vertex moves, and the contact line keeps its vertices.
    """
    ends, counts = np.unique(mesh.lines["contact"], return_counts=True)
    inside = ends[counts == 2]
    few = inside[np.bincount(mesh.triangles.ravel())[inside] < _FEWEST]
    points, triangles = mesh.points, mesh.triangles
    for vertex in few.tolist():
        around = triangles[(triangles == vertex).any(axis=1)]
        if len(around) < _FEWEST:  # a vertex beside it may have added one
            points, triangles = _halved(points, triangles, _opposite(points, around, vertex))
    return replace(mesh, points=points, triangles=triangles)


def _opposite(points: npt.NDArray[np.float64], around: _Rows, vertex: int) -> _Rows:
    """Ends (2,) of the edge opposite the ``vertex`` in the triangle ``around`` (k, 3) it that has the largest angle."""
    edges = around[around != vertex].reshape(-1, 2)
    along = points[edges] - points[vertex]
    lengths = np.linalg.norm(along, axis=2)
    cosines = (along[:, 0] * along[:, 1]).sum(axis=1) / lengths.prod(axis=1)
    return edges[np.argmin(cosines)]


def _halved(points: npt.NDArray[np.float64], triangles: _Rows, edge: _Rows) -> tuple[npt.NDArray[np.float64], _Rows]:
    """Points and triangles with the ``edge`` (2,), and the triangles that share it, halved."""
    first, last = edge.tolist()
    cut = np.isin(triangles, edge).sum(axis=1) == 2
    whole, middle = triangles[cut], len(points)
    halves = [np.where(whole == end, middle, whole) for end in (first, last)]
    return np.vstack([points, points[edge].mean(axis=0)]), np.concatenate([triangles[~cut], *halves])
