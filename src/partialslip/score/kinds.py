"""What the values of a table are: values at points, means over cells, or nodal forces over the nodes' weights."""

from typing import Literal

import numpy as np

from partialslip.arrays import Array

Kind = Literal["sampled", "mean", "nodal"]
#: Kinds of values, in words.
KINDS: dict[Kind, str] = {
    "sampled": "values at points",
    "mean": "means over cells",
    "nodal": "nodal forces of linear elements over the nodes' weights",
}


def cells_around(x: Array) -> Array:
    """Ends of the cells around the points ``x`` (n,), (n + 1,), m: halfway between the points; the outermost cells lie
    evenly about their points."""
    inner = (x[1:] + x[:-1]) / 2
    return np.concatenate([[2 * x[0] - inner[0]], inner, [2 * x[-1] - inner[-1]]])


def cells_of_nodes(x: Array) -> Array:
    """Ends of the nodes' cells, (n + 1,), m, for nodes at ``x`` (n,): each as wide as the integral of the node's shape
    function, which is linear on the elements between the nodes."""
    return np.concatenate([[x[0]], (x[1:] + x[:-1]) / 2, [x[-1]]])
