"""Where zones end, below mesh size.

Towards the end of the contact p falls like a square root, and so does 2 f p - |dq| towards the end of the stick
zone. The force between a mesh vertex and the end therefore goes like distance^(3/2): its power 2/3 is a smooth
function of x whose root is the end. Forces are far better than nodal values here: what a traction does within the
last elements hardly touches them.
"""

import numpy as np

from partialslip.result import Array

_VERTICES = 5


def right_end(vertices: Array, forces: Array, inside: Array) -> float:
    """Where the zone ends on the right.

    Parameters
    ----------
    vertices : (c + 1,) array
        Ends of the cells, ascending.
    forces : (c,) array
        Integral of the traction that vanishes at the end, over each cell.
    inside : (n,) array
        Nodes inside the zone, ascending: the end is not far beyond the last one.
    """
    last = np.searchsorted(vertices, inside[-1])  # the first vertex at or beyond the last node
    x = vertices[:last][::-1]
    x = x[x >= inside[0]]
    force = np.cumsum(forces[::-1])[len(forces) - last :][: len(x)]
    # the nearest vertex has but part of a cell beyond it: leave it out where there are others
    skip = 1 if len(x) > _VERTICES else 0
    x, force = x[skip : skip + _VERTICES], force[skip : skip + _VERTICES]
    near, far = inside[-1], vertices[min(last + 1, len(vertices) - 1)]
    if len(x) >= 3 and (force > 0).all():
        roots = _roots(x, force ** (2 / 3))
        between = roots[(roots > x[0]) & (roots < far + (far - x[0]))]
        if len(between):
            return float(between.min())
    return float((near + max(near, vertices[last])) / 2)


def left_end(vertices: Array, forces: Array, inside: Array) -> float:
    """Where the zone ends on the left: :func:`right_end` of the mirror image."""
    return -right_end(-vertices[::-1], forces[::-1], -inside[::-1])


def _roots(x: Array, y: Array) -> Array:
    """Real roots of the quadratic through (x, y), in the sense of relative least squares."""
    scale = x[0] - x[-1]
    t = (x - x[0]) / scale
    polynomial = np.polynomial.polynomial
    roots = polynomial.polyroots(polynomial.polyfit(t, y, 2, w=1 / y))
    real: Array = x[0] + scale * roots.real[np.abs(roots.imag) < 1e-12]
    return real
