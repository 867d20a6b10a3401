"""Array types, and parts of arrays."""

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]
Indices = npt.NDArray[np.int64]
Mask = npt.NDArray[np.bool_]


def submatrix(matrix: Array, rows: Indices, columns: Indices) -> Array:
    """``rows`` and ``columns`` of a ``matrix``, copied: several times faster than by ``np.ix_``."""
    return matrix.take(rows, axis=0).take(columns, axis=1)
