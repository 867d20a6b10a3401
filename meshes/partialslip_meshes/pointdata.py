"""Reading what is known at the points of a mesh through meshio, which reads many formats but says little when it
cannot."""

from pathlib import Path

import meshio
import numpy as np
import numpy.typing as npt

from partialslip.errors import InputError
from partialslip_meshes.quiet import quiet

# Of the endings that meshio knows, those of formats with point data; its readers of others may not come to an end.
FORMATS = {".vtu", ".vtk", ".xdmf", ".xmf", ".msh", ".med", ".e", ".exo", ".ex2"}


def read_point_data(path: Path) -> tuple[npt.NDArray[np.float64], dict[str, npt.NDArray[np.float64]]]:
    """Points (n, 3), and values (n,) by name, of a file in a format of meshio's, chosen by its ending; where there are
    cells that are lines, of their points alone.

    Raises
    ------
    InputError
        If it cannot be read.
    """
    mesh = _read(path)
    try:
        points = np.asarray(mesh.points, dtype=float)
        points = np.column_stack([points, np.zeros((len(points), 3 - points.shape[1]))])
        data = {name: np.asarray(values, dtype=float) for name, values in mesh.point_data.items()}
        lines = [block.data.ravel() for block in mesh.cells if block.type.startswith("line")]
        on_line = np.unique(np.concatenate(lines)).astype(int) if lines else np.arange(len(points))
        scalars = {name: values.reshape(len(points), -1) for name, values in data.items()}
        return points[on_line], {name: v[on_line, 0] for name, v in scalars.items() if v.shape[1] == 1}
    except (ValueError, IndexError, TypeError):
        raise InputError(f"{path}: its points, lines and point data do not fit each other") from None


def _read(path: Path) -> meshio.Mesh:
    """meshio prints and exits where it cannot read, and its readers raise what they run into."""
    try:
        with quiet():
            return meshio.read(path)
    except ImportError as error:
        raise InputError(f"{path}: cannot be read without the package {error.name}") from None
    except (Exception, SystemExit) as error:
        reason = " ".join(str(error).split())[:100] if not isinstance(error, SystemExit) else ""
        raise InputError(f"{path}: cannot be read{f': {reason}' if reason else ''}") from None
