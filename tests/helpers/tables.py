"""Tables of tractions as files."""

import numpy as np


def written(path, table, names="x,p,dq"):
    """The ``path`` of a file with the columns of ``table``, or of an array (n, k)."""
    rows = table if isinstance(table, np.ndarray) else np.column_stack(table)
    np.savetxt(path, rows, delimiter=",", header=names, comments="", fmt="%.17g")
    return path


def sampled(result, count, reach=1.1):
    """x, off the middle by an odd amount, and the exact p and dq there, (count, 3)."""
    x = reach * result.a * np.linspace(-1, 1.003, count)
    return np.column_stack([x, *result.traction.at(x)[:2]])
