"""Array types, and parts of arrays."""

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]
Indices = npt.NDArray[np.int64]
Mask = npt.NDArray[np.bool_]

_BLOCKS = 16  # cost: of consecutive rows and columns: up to so many are faster copied one by one


def runs(members: Indices) -> list[slice]:
    """Slices of consecutive ``members`` (k,) in turn: parts of arrays without a copy."""
    if not len(members):
        return []
    breaks = np.flatnonzero(members[1:] - members[:-1] != 1).tolist()
    firsts, lasts = [0, *(at + 1 for at in breaks)], [*breaks, len(members) - 1]
    return [slice(int(members[one]), int(members[two]) + 1) for one, two in zip(firsts, lasts, strict=True)]


def submatrix(matrix: Array, rows: Indices, columns: Indices) -> Array:
    """``rows`` and ``columns`` of a ``matrix``, copied: several times faster than by ``np.ix_``."""
    down = runs(rows)
    across = down if columns is rows else runs(columns)
    if len(down) * len(across) > _BLOCKS:
        return matrix.take(rows, axis=0).take(columns, axis=1)
    result = np.empty((len(rows), len(columns)))
    top = 0
    for rowwise in down:
        left, bottom = 0, top + rowwise.stop - rowwise.start
        for columnwise in across:
            right = left + columnwise.stop - columnwise.start
            result[top:bottom, left:right] = matrix[rowwise, columnwise]
            left = right
        top = bottom
    return result
