"""Stresses in a half-plane below tractions on its surface, from Cauchy integrals of the tractions.

Let P = (1/pi) int p dt/(t - z), T the same of q, and z = x + i y with y = -depth. In the lower body

    sigma_xx = Im P + y Re P' - 2 Re T + y Im T',    sigma_yy = Im P - y Re P' - y Im T',
    sigma_xy = Im T - y Im P' + y Re T'

(Muskhelishvili, Some basic problems of the mathematical theory of elasticity). The upper body is the mirror image of
the lower body under the opposite q.

Tractions on a round face, at t + i h(t), are sums of Flamant's solutions at these points: the same with t + i h(t) for
t in the integrals, and with (1/pi) int (y - h) p dt/(t + i h - z)^2 for y P'.
"""

import math
from collections.abc import Sequence

import numpy as np

from partialslip.tools.arrays import Array, Complex, Indices

_TOGETHER = 32  # accuracy: cells of a group, divided by the degree: closed forms lose digits at some cells' distance
_COUNT = 16  # cost: nodes of a group
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(_COUNT)
_NEAR = 6.0  # accuracy: |zeta - 1| + |zeta + 1| up to which moments of degree 15 do not suffice
_AT_ONCE = 2**20  # cost: pairs of points in memory


def under_pressure(P: Complex, yP_z: Complex, side: Array) -> Array:
    """Stresses (3, k) xx, yy, xy due to p, from its Cauchy integral ``P`` (k,) and y P' (k,), in the lower (``side`` =
    1) and the upper body (-1)."""
    return np.stack([P.imag + yP_z.real, P.imag - yP_z.real, -side * yP_z.imag])


def under_shear(T: Complex, yT_z: Complex, side: Array) -> Array:
    """Stresses (3, k) due to q, which the lower body exerts; see :func:`under_pressure`."""
    return np.stack([side * (yT_z.imag - 2 * T.real), -side * yT_z.imag, T.imag + yT_z.real])


def below_surface(at: Complex, mirrored: Complex, slope: Complex, z: Complex) -> Array:
    """Stresses (3, k) of the lower body at ``z`` (k,), whose surface is free of tractions and is strained by u' and
    turned by v': from the values ``at`` z of S = E' (u' + i v') (E of plane stress), continued to complex z, at the
    ``mirrored`` places conj z, and its ``slope`` S'(z).

        sigma_xx + sigma_yy = Re S(z),    sigma_yy - i sigma_xy = (S(z) - S(conj z) + (z - conj z) conj S'(z))/4
    """
    across = (at - mirrored + (z - z.conj()) * slope.conj()) / 4
    return np.stack([at.real - across.real, across.real, -across.imag])


def under_tension(sigma: Array, slope: float, depth: Array, side: Array) -> Array:
    """Stresses (3, k) due to the bulk tension ``sigma`` (k,), which varies along x by ``slope``, in the lower body:
    sigma_xx = s x is in equilibrium with sigma_xy = -s y."""
    lower = np.where(side > 0, 1.0, 0.0)
    return np.stack([lower * sigma, 0 * depth, lower * slope * depth])


class PiecewiseCauchy:
    """(1/pi) int g(t)/(t - z) dt of piecewise polynomials g, and the derivatives of these integrals.

    Where the cells lie on a polygon y = h(x), t + i h(t) stands for t in the denominator.

    Parameters
    ----------
    vertices : (c + 1,) real or complex array
        Ends of the cells, ascending in x.
    coefficients : (r, k + 1, c) array
        Of r functions on each cell, in powers of the distance from the cell's left end, the highest power first, as in
        :class:`scipy.interpolate.PPoly`.
    """

    def __init__(self, vertices: Array | Complex, coefficients: Array) -> None:
        self._ends, self._middle, self._half = vertices, (vertices[1:] + vertices[:-1]) / 2, np.diff(vertices) / 2
        self._width = self._half.real
        self._local = _about_the_middle(coefficients, self._width)
        self._together = _TOGETHER // max(coefficients.shape[1] - 1, 2)
        first = np.arange(0, len(self._half), self._together)
        self._first = first
        low, high = vertices[first], vertices[np.append(first[1:], len(self._half))]
        self._centre, self._reach = (low + high) / 2, (high - low) / 2
        self._forces = self._at_nodes()

    def __call__(self, z: Complex, rows: Sequence[int] | None = None) -> Complex:
        """Integrals and their derivatives, (2, r, m), at points ``z`` (m,) off the interval: of all functions, or of
        those with the indices ``rows`` (r,), to which the work is proportional."""
        local, of_groups = (self._local, self._forces) if rows is None else (self._local[rows], self._forces[rows])
        groups = len(self._first)
        nodes = self._centre[:, None] + self._reach[:, None] * _NODES
        forces = of_groups.reshape(len(local), -1).T
        result = np.empty((2, len(local), len(z)), complex)
        for part in np.array_split(np.arange(len(z)), len(z) * nodes.size // _AT_ONCE + 1):
            zeta = (z[part, None] - self._centre) / self._reach
            near = np.abs(zeta - 1) + np.abs(zeta + 1) < _NEAR
            pole = 1 / (nodes.ravel() - z[part, None]).reshape(len(part), groups, _COUNT)
            pole[near] = 0.0
            pole = pole.reshape(len(part), nodes.size)
            result[0, :, part] = pole @ forces
            result[1, :, part] = np.multiply(pole, pole, out=pole) @ forces
            point, group = np.nonzero(near)
            for offset in range(self._together):
                cell = group * self._together + offset
                there = cell < len(self._half)
                value, slope = self._closed(local, z[part[point[there]]], cell[there])
                for order, of in enumerate((value, slope)):
                    np.add.at(result[order].T, part[point[there]], of.T)
        result /= np.pi
        return result

    def _at_nodes(self) -> Array | Complex:
        """Forces (r, groups, nodes) with the moments of the polynomials of each group."""
        degree = self._local.shape[1] - 1
        s, weights = np.polynomial.legendre.leggauss((_COUNT + degree) // 2 + 1)
        values = np.einsum("rkc,ks->rcs", self._local, s ** np.arange(degree + 1)[:, None]) * weights
        values = values * self._width[:, None]
        group = np.arange(len(self._half)) // self._together
        place = (self._middle[:, None] + self._half[:, None] * s - self._centre[group][:, None]) / self._reach[group][
            :, None
        ]
        legendre = np.polynomial.legendre.legvander(place, _COUNT - 1)
        moments = np.add.reduceat(np.einsum("rcs,csk->rck", values, legendre), self._first, axis=1)
        back = np.polynomial.legendre.legvander(_NODES, _COUNT - 1) * (np.arange(_COUNT) + 0.5)
        return (moments @ back.T) * _WEIGHTS

    def _closed(self, local: Array, z: Complex, cell: Indices) -> tuple[Complex, Complex]:
        """Integrals and derivatives (r, pairs) of the ``local`` coefficients (r, k + 1, c) over one cell for each pair
        of point and ``cell``.

        With the pole zeta, int g/(s - zeta) ds over [-1, 1] is g(zeta) log((zeta - 1)/(zeta + 1)) plus a polynomial.
        """
        half = self._half[cell]
        zeta = (z - self._middle[cell]) / half
        c = local[:, :, cell]
        # distances from vertices, which neighbours share, to the last digit
        low, high = z - self._ends[cell], z - self._ends[cell + 1]
        logarithm = np.log(high / low)
        g, g_z, rest, rest_z = (np.zeros((len(c), len(z)), complex) for _ in range(4))
        inner = _divided(c)
        for power in range(c.shape[1] - 1, -1, -1):  # Horner's rule, with derivatives
            g_z, g = g_z * zeta + g, g * zeta + c[:, power]
            rest_z, rest = rest_z * zeta + rest, rest * zeta + inner[:, power]
        along = self._width[cell] / half  # dx along the cell
        return (g * logarithm + rest) * along, (
            g_z * logarithm + g * (1 / high - 1 / low) * half + rest_z
        ) * along / half


def _about_the_middle(coefficients: Array, half: Array) -> Array:
    """Coefficients (r, k + 1, c) in powers of s, from the lowest: x = (1 + s) ``half`` from the cell's left end."""
    degree = coefficients.shape[1] - 1
    scaled = coefficients[:, ::-1] * half ** np.arange(degree + 1)[:, None]
    shift = np.array([[math.comb(power, k) for power in range(degree + 1)] for k in range(degree + 1)], float)
    return np.einsum("kp,rpc->rkc", shift, scaled)


def _divided(c: Array) -> Array:
    """Coefficients of int (g(s) - g(zeta))/(s - zeta) ds over [-1, 1] in powers of zeta."""
    result = np.zeros_like(c)
    for power in range(c.shape[1]):
        for j in range(0, power, 2):
            result[:, power - 1 - j] += 2 / (j + 1) * c[:, power]
    return result
