"""Places: where a function of the points of a body is largest, and averages near a point of the surface."""

from collections.abc import Callable, Sequence

import numpy as np

from partialslip.tools.arrays import Array

_FAR = 2.0  # accuracy: half-widths beyond the contact, and of depth, that are searched
_BETWEEN, _LEVELS = 12, 16  # accuracy: intervals between places where tractions are not smooth, and of depth
_WINDOW, _SHRINK, _ROUNDS = 5, 0.5, 16  # accuracy: points along a side of a window, its shrinkage and how often
_NODES = 24  # accuracy: of Gauss

Values = Callable[[Array, Array], Array]


def surface_points(breaks: Array, a: float, between: int = _BETWEEN) -> Array:
    """Return points x, m, along the surface, dense near ``breaks`` (b,), m, and up to two half-widths ``a`` beyond;
    ``between`` intervals from one break to the next."""
    ends = np.concatenate([[breaks[0] - _FAR * a], breaks, [breaks[-1] + _FAR * a]])
    ends = ends[np.append(True, np.diff(ends) > 1e-9 * a)]
    share = (1 - np.cos(np.linspace(0, np.pi, between + 1))) / 2
    return np.unique(np.concatenate([ends[:-1, None] + np.diff(ends)[:, None] * share]).ravel())


def depths(a: float, levels: int = _LEVELS) -> Array:
    """Return depths, m, from 0 to two half-widths ``a``, dense near the surface, in ``levels`` intervals."""
    return _FAR * a * np.linspace(0, 1, levels + 1) ** 2


def largest_at(function: Values, x: Array, depth: Array, values: Array) -> tuple[float, float]:
    """Return x and depth, m, where ``function(x, depth)`` is largest, to about 1e-5 of the spacing of the points.

    The largest of the ``values`` (k, l) on the grid of ``x`` (k,) and ``depth`` (l,) is followed into ever smaller
    windows. A peak that is a cusp at a point of the grid, such as the end of the contact, is found exactly. NaN counts
    as nothing.
    """
    i, j = np.unravel_index(np.nanargmax(values), values.shape)
    at = np.array([x[i], depth[j]])
    size = np.array([_spacing(x, int(i)), _spacing(depth, int(j))])
    offsets = np.linspace(-1, 1, _WINDOW)
    for _ in range(_ROUNDS):
        xs = at[0] + size[0] * offsets
        ys = np.unique(np.maximum(at[1] + size[1] * offsets, 0.0))
        values = function(xs[:, None], ys)
        i, j = np.unravel_index(np.nanargmax(values), values.shape)
        at = np.array([xs[i], ys[j]])
        size = size * _SHRINK
    return float(at[0]), float(at[1])


def _spacing(points: Array, number: int) -> float:
    """Largest distance of a point to its neighbours."""
    return float(np.diff(points[max(number - 1, 0) : number + 2]).max(initial=0.0))


def averaged(stress: Callable[[Array, Array], Array], x: float, distance: float, over: str) -> Array:
    """Return the stress path (s, 4), Pa, at or averaged near the point ``x``, m, of the surface.

    Parameters
    ----------
    stress : callable
        ``stress(x, depth) -> (s, 4, ...)``.
    x, distance : float
        m.
    over : "point", "line" or "area"
        At the depth ``distance``, along the normal from the surface to this depth, or over the half disc around the
        point with this radius.
    """
    if over == "point":
        return stress(np.array(x), np.array(distance))
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    share, weights = (nodes + 1) / 2, weights / 2
    # r = distance share^2: stresses go like the square root of the distance from the end of the contact
    r = distance * share**2
    if over == "line":
        return stress(np.full(_NODES, x), r) @ (2 * share * weights)
    angle = np.pi * share[:, None]
    of_area = (weights[:, None] * (4 * share**3 * weights)).ravel()  # sums to 1: int 2 r dr/distance^2
    values = stress(x + r * np.cos(angle), r * np.sin(angle))
    return values.reshape(*values.shape[:2], -1) @ of_area


OVER: Sequence[str] = ("point", "line", "area")
