"""Where zones end, below mesh size.

Towards the end of the contact p falls like a square root, and so does 2 f p - |dq| towards the end of the stick
zone. The force between a mesh vertex and the end therefore goes like distance^(3/2): its power 2/3 is a smooth
function of x whose root is the end. Forces are far better than nodal values here: what a traction does within the
last elements hardly touches them.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from partialslip.result import Array

_VERTICES = 5
_STICKS = 1e-9  # what slips has used up its bound to rounding, whatever the units


@dataclass(frozen=True)
class Zone:
    """The stick zone and the signs of dq in the slip zones on its left and right."""

    left: float
    right: float
    signs: tuple[int, int]


def stick_zone(x: Array, bound: Array, change: Array, vertices: Array, cell_forces: Callable[[Array], Array]) -> Zone:
    """Read the stick zone from the range 2 f p - |dq|, never from what sticks at one instant.

    Parameters
    ----------
    x, bound, change : (n,) arrays
        Nodes in contact, f times their normal forces, and changes of their tangential forces over the cycle.
    vertices : (c + 1,) array
        Ends of the cells of the contact line.
    cell_forces : callable
        Takes forces of the nodes in contact to integrals over the cells.
    """
    sticks = np.flatnonzero(2 * bound - np.abs(change) > _STICKS * bound)
    signs = (1 if change[0] > 0 else -1), (1 if change[-1] > 0 else -1)
    if len(sticks) == 0:  # a stick zone smaller than a cell: it is where the slip turns round
        turn = int(np.argmax(np.sign(change) != np.sign(change[0])))
        point = float(x[max(turn - 1, 0)] + x[turn]) / 2
        return Zone(point, point, signs)
    left = left_end(vertices, cell_forces(2 * bound - signs[0] * change), x[sticks])
    right = right_end(vertices, cell_forces(2 * bound - signs[1] * change), x[sticks])
    return Zone(left, max(right, left), signs)


def apart(ends: list[float], size: float) -> list[float]:
    """Without those that lie within ``size`` of an earlier one: where the next mesh is to be fine."""
    kept: list[float] = []
    for end in ends:
        if all(abs(end - other) > size for other in kept):
            kept.append(end)
    return kept


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
