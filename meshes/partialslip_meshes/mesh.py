"""The mesh, as plain arrays."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt


@dataclass(frozen=True, eq=False)
class Mesh:
    """Straight-sided triangles.

    Parameters
    ----------
    points : (n, 2) float array
    triangles : (t, 3) int array
        Corners, counter-clockwise.
    lines : dict of (k, 2) int arrays
        Named groups of boundary edges; "contact" is the contact line, "back" the side opposite to it, "left" and
        "right" are those beside it.
    cpu_s : float
        CPU seconds that it took in a process of its own.
    """

    points: npt.NDArray[np.float64]
    triangles: npt.NDArray[np.int64]
    lines: dict[str, npt.NDArray[np.int64]]
    cpu_s: float = 0.0


@dataclass(frozen=True)
class QuadMesh:
    """Straight-sided quadrilaterals: ``quads`` (k, 4), counter-clockwise; otherwise as :class:`Mesh`."""

    points: npt.NDArray[np.float64]
    quads: npt.NDArray[np.int64]
    lines: dict[str, npt.NDArray[np.int64]]
