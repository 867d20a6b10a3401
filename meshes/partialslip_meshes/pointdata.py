"""Read point data of a mesh file with meshio."""

from pathlib import Path

import meshio
import numpy as np
import numpy.typing as npt

from partialslip.tools.errors import InputError
from partialslip_meshes.files import check_files, quiet

# Suffixes of meshio's formats with point data. Readers of other formats may not terminate.
WRITTEN_FORMATS = {".vtu", ".vtk", ".xdmf", ".xmf", ".msh", ".med", ".e", ".exo", ".ex2"}


def read_point_data(path: Path) -> tuple[npt.NDArray[np.float64], dict[str, npt.NDArray[np.float64]]]:
    """Points (n, 3), and values (n,) by name, of the file ``path``, whose suffix tells the format; of vectors by name
    and number, as in ``name:0``.

    If the mesh has line cells, only their points are returned.

    Raises
    ------
    InputError
        If the file cannot be read.
    """
    mesh = _read(path)
    try:
        points = np.asarray(mesh.points, dtype=float)
        points = np.column_stack([points, np.zeros((len(points), 3 - points.shape[1]))])
        data = {name: np.asarray(values, dtype=float) for name, values in mesh.point_data.items()}
        lines = [block.data.ravel() for block in mesh.cells if block.type.startswith("line")]
        on_line = np.unique(np.concatenate(lines)).astype(int) if lines else np.arange(len(points))
        rows = {name: values.reshape(len(points), -1)[on_line] for name, values in data.items()}
        return points[on_line], {
            name if of.shape[1] == 1 else f"{name}:{k}": of[:, k]
            for name, of in rows.items()
            for k in range(of.shape[1])
        }
    except (ValueError, IndexError, TypeError):
        raise InputError(f"{path}: points, lines and point data must have matching sizes") from None


def _read(path: Path) -> meshio.Mesh:
    """Read ``path``; turn meshio's exits and exceptions into InputError."""
    check_files(path, str(path))
    try:
        with quiet():
            return meshio.read(path)
    except ImportError as error:
        extra = {"h5py": "med", "netCDF4": "exodus"}.get(str(error.name))
        hint = f"; pip install partialslip[{extra}]" if extra else ""
        raise InputError(f"{path}: cannot be read: the package {error.name} is missing{hint}") from None
    except (Exception, SystemExit) as error:
        reason = " ".join(str(error).split())[:100] if not isinstance(error, SystemExit) else ""
        raise InputError(f"{path}: cannot be read{f': {reason}' if reason else ''}") from None
