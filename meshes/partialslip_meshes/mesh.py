"""Meshes as plain arrays."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt


@dataclass(frozen=True, eq=False)
class Mesh:
    """A mesh of straight-sided triangles.

    Parameters
    ----------
    points : (n, 2) float array
    triangles : (t, 3) int array
        Corners, counter-clockwise.
    lines : dict of (k, 2) int arrays
        Boundary edges by name: "contact" is the contact line, "back" the opposite side, "left" and "right" the sides
        between.
    cpu_s : float
        CPU seconds of the gmsh process for this mesh.
    """

    points: npt.NDArray[np.float64]
    triangles: npt.NDArray[np.int64]
    lines: dict[str, npt.NDArray[np.int64]]
    cpu_s: float = 0.0

    @cached_property
    def edges(self) -> npt.NDArray[np.int64]:
        """Points at the ends of the edges of the triangles, (e, 2), each edge once."""
        sides = np.sort(np.concatenate([self.triangles[:, [k, k - 1]] for k in range(3)]), axis=1)
        found = np.unique(sides[:, 0] * len(self.points) + sides[:, 1])
        return np.stack(np.divmod(found, len(self.points)), axis=1)


@dataclass(frozen=True)
class QuadMesh:
    """A mesh of straight-sided quadrilaterals ``quads`` (k, 4), counter-clockwise; the rest as in :class:`Mesh`."""

    points: npt.NDArray[np.float64]
    quads: npt.NDArray[np.int64]
    lines: dict[str, npt.NDArray[np.int64]]
