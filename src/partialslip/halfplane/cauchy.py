"""Cauchy integrals of functions on an interval of the real axis, accurate at any distance from the interval.

Between breaks the functions are interpolated by polynomials, panel by panel, in v, the square root of the distance from
the nearer break. Gauss's rule integrates panels far from the point; in near panels the rule's known error is added.
"""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from partialslip.tools.arrays import Array, Complex

_COUNT = 16  # accuracy: nodes on a panel
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(_COUNT)
_BARYCENTRIC = (-1.0) ** np.arange(_COUNT) * np.sqrt((1 - _NODES**2) * _WEIGHTS)
_VALUES = np.polynomial.legendre.legvander(_NODES, _COUNT - 1)  # Legendre polynomials, (nodes, degrees)
_COEFFICIENTS = (np.arange(_COUNT) + 0.5)[:, None] * (_VALUES * _WEIGHTS[:, None]).T
_ENDS = np.polynomial.legendre.legvander(np.array([-1.0, 1.0]), _COUNT - 1) @ _COEFFICIENTS
_SLOPES = _VALUES[:, :-1] @ np.polynomial.legendre.legder(_COEFFICIENTS)
_RESOLVED = 1e-13  # accuracy: last coefficients of a panel, relative to the largest value
_SMALL = 1e-9  # accuracy: coefficients, relative to the largest value, that may be rounding of the functions
_LEVELS = 40  # limit: halvings of a panel
_NEAR = 3 + 1 / 3  # accuracy: |zeta - 1| + |zeta + 1| up to which Gauss's rule has an error above rounding
_AT_ONCE = 2**20  # cost: pairs of points in memory


class Cauchy:
    """(1/pi) int g(t)/(t - z) dt of functions g, and the derivatives of these integrals.

    Parameters
    ----------
    functions : callable
        (n,) points to (k, n) real values.
    breaks : (b,) array
        Ascending; the first and the last are the ends of the interval. Between breaks the functions are smooth; at
        breaks they may have square roots or weaker singularities.
    """

    def __init__(self, functions: Callable[[Array], Array], breaks: Array) -> None:
        middles = (breaks[1:] + breaks[:-1]) / 2
        origin = np.concatenate([breaks[:-1], breaks[1:]])
        way = np.repeat([1.0, -1.0], len(middles))
        # t = origin + way v^2; panels store their ends as t, so that neighbours share them to the last digit
        todo = np.stack([origin, way, origin, np.concatenate([middles, middles])])
        panels, values, largest, before = [], [], 0.0, np.full(len(origin), np.inf)
        for level in range(_LEVELS):
            middle, half = _in_v(todo)
            t = todo[0, :, None] + todo[1, :, None] * (middle[:, None] + half[:, None] * _NODES) ** 2
            found = functions(t.ravel()).reshape(-1, *t.shape)
            largest = max(largest, float(np.abs(found).max()))
            # error of the functions due to the rounding of t
            noise = 4 * np.finfo(float).eps * np.ptp(found, axis=-1) / np.abs(todo[3] - todo[2])
            tail = np.abs(found @ _COEFFICIENTS[-2:].T).max(axis=-1)
            rough = (tail > _RESOLVED * largest + noise).any(axis=0) & (level < _LEVELS - 1)
            # a small tail that halving the panel did not reduce is rounding of the functions
            size = tail.max(axis=0)
            rough &= (size > _SMALL * largest) | (size < before / 2)
            panels.append(todo[:, ~rough])
            values.append(found[:, ~rough])
            if not rough.any():
                break
            origin, way, low, high = todo[:, rough]
            between = origin + way * middle[rough] ** 2
            parts = [origin, way, low, between], [origin, way, between, high]
            todo, before = np.concatenate([np.stack(part) for part in parts], axis=1), np.tile(size[rough], 2)
        self._panels, self._values = np.concatenate(panels, axis=1), np.concatenate(values, axis=1)
        self._slopes = self._values @ _SLOPES.T

    def __call__(self, z: Complex) -> Complex:
        """Integrals and their derivatives, (2, k, m), at points ``z`` (m,) off the interval."""
        origin, way, *_ = self._panels
        middle, half = _in_v(self._panels)
        v = middle[:, None] + half[:, None] * _NODES
        beyond, ends = way[:, None] * v**2, self._panels[2:].T.ravel()
        # far panels; the derivative by parts, with terms at the panels' ends
        integral = self._values * _WEIGHTS * 2 * v * half[:, None]
        derivative = self._slopes * _WEIGHTS * way[:, None]
        edges = self._values @ _ENDS.T * way[:, None] * [1, -1]
        of_nodes = np.concatenate([integral, derivative]).reshape(2 * len(edges), -1).T
        of_ends = np.concatenate([0 * edges, edges]).reshape(2 * len(edges), -1).T
        result = np.empty((len(z), 2 * len(edges)), complex)
        for part in np.array_split(np.arange(len(z)), len(z) * v.size // _AT_ONCE + 1):
            apart = z[part, None] - origin
            far, v_z = beyond - apart[..., None], np.sqrt(way * apart)
            near = _ellipse((v_z - middle) / half) < _NEAR
            far[near] = np.inf
            result[part] = (1 / far).reshape(len(part), v.size) @ of_nodes + (1 / (ends - z[part, None])) @ of_ends
            point, panel = np.nonzero(near)
            np.add.at(result, part[point], self._near(z[part][point], v_z[near], panel).T)
        result /= np.pi
        return result.T.reshape(2, len(edges), len(z))

    def along(self, z: Complex) -> Complex:
        """Integrals (k, m) at points ``z`` (m,) so close to the axis that far panels see points on it."""
        origin, way, *_ = self._panels
        middle, half = _in_v(self._panels)
        v = middle[:, None] + half[:, None] * _NODES
        beyond, count, x = way[:, None] * v**2, len(self._values), z.real
        of_nodes = (self._values * _WEIGHTS * 2 * v * half[:, None]).reshape(count, -1).T
        # squares of v between which points may be near: the ellipse lies in a circle
        inner, outer = np.maximum(middle - _NEAR / 2 * half, 0.0) ** 2, (middle + _NEAR / 2 * half) ** 2
        result = np.empty((len(z), count), complex)
        for part in np.array_split(np.arange(len(z)), len(z) * v.size // _AT_ONCE + 1):
            apart = x[part, None] - origin
            far, size = beyond - apart[..., None], np.abs(apart)
            point, panel = np.nonzero((size >= inner) & (size <= outer))
            v_z = np.sqrt(way[panel] * (z[part[point]] - origin[panel]))
            near = _ellipse((v_z - middle[panel]) / half[panel]) < _NEAR
            point, panel, v_z = point[near], panel[near], v_z[near]
            far[point, panel] = np.inf
            result[part] = np.reciprocal(far, out=far).reshape(len(part), v.size) @ of_nodes
            np.add.at(result, part[point], self._near(z[part[point]], v_z, panel)[:count].T)
        result /= np.pi
        return result.T

    def _near(self, z: Complex, v_z: Complex, panel: npt.NDArray[np.int64]) -> Complex:
        """Integrals and derivatives over near panels, one per pair of point and panel, (2 k, pairs).

        dt/(t - z) = dv/(v - v_z) + dv/(v + v_z), and dv/(t - z) = (dv/(v - v_z) - dv/(v + v_z))/(2 v_z).
        """
        _, way, low, high = self._panels[:, panel]
        middle, half = (values[panel] for values in _in_v(self._panels))
        functions = np.concatenate([self._values, self._slopes])[:, panel]
        across = (v_z + middle + half) / (v_z + middle - half)
        plus = _pole(functions, (v_z - middle) / half, np.log((z - high) / (z - low) / across))
        minus = _pole(functions, (-v_z - middle) / half, np.log(across))
        count = len(self._values)
        return np.concatenate([way * (plus + minus)[:count], (plus - minus)[count:] / (2 * v_z * half)])


def _in_v(panels: Array) -> tuple[Array, Array]:
    """Midpoints and half-widths of panels in v."""
    origin, _, *ends = panels
    low, high = (np.sqrt(np.abs(end - origin)) for end in ends)
    return (low + high) / 2, (high - low) / 2


def _ellipse(zeta: Complex) -> Array:
    """Sum of the distances from -1 and 1."""
    return np.abs(zeta - 1) + np.abs(zeta + 1)


def _pole(functions: Array, zeta: Complex, logarithm: Complex) -> Complex:
    """int g(s)/(s - zeta) ds over [-1, 1] of polynomials, given by their values at the nodes, (k, pairs, nodes).

    Gauss's value plus g(zeta) (logarithm - R), where R is Gauss's value of int ds/(s - zeta) = ``logarithm``. The value
    at the nearest node is subtracted first, so that nothing cancels beside a node.
    """
    kernel = 1 / (_NODES - zeta[:, None])
    nearest = np.abs(kernel).argmax(axis=-1)
    value = functions[:, np.arange(len(zeta)), nearest]
    rest = functions - value[..., None]
    rule = kernel @ _WEIGHTS
    near = _ellipse(zeta) < _NEAR
    interpolant = (rest * kernel) @ _BARYCENTRIC / np.where(near, kernel @ _BARYCENTRIC, 1.0)
    left_out = np.where(near, logarithm - rule, 0.0)
    return (rest * kernel) @ _WEIGHTS + value * (rule + left_out) + interpolant * left_out
