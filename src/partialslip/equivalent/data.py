"""The data of half-planes that act like bodies of a size (docs/theory.md, section 12).

What a rig adds to the displacements of half-planes is smooth: v(x), an opening, acts like a change of the gap, and u(x)
like a bulk strain. Half-planes take the linear and the quadratic part of v, a tilt and a curvature, and the constant and
the linear part of the strain, a tension that varies along x. Each is the projection on Chebyshev polynomials over the
contact, or over the stick zone, so that the conditions that fix their ends hold exactly, whatever the rest is.
"""

from dataclasses import dataclass

import numpy as np

from partialslip.arrays import Array
from partialslip.result import Result
from partialslip.rig import Rig
from partialslip.scene import Scene

_POINTS = 32  # of quadrature
_NODES = np.cos(np.pi * (np.arange(_POINTS) + 0.5) / _POINTS)  # Gauss-Chebyshev's rule
_STEP = 1e-4  # of the contact, for the slope of a face


@dataclass(frozen=True)
class Data:
    """Data of half-planes at load points 1 and 2; all arrays are (2,).

    Parameters
    ----------
    curvature : Array
        What the curvature of the gap gains, 1/m.
    tilt : Array
        Slope at x = 0 that the gap gains, rad.
    sigma : Array
        Differential bulk tension at x = 0, Pa.
    sigma_slope : Array
        Slope of the differential bulk tension along x, Pa/m.
    """

    curvature: Array
    tilt: Array
    sigma: Array
    sigma_slope: Array

    def apart(self, other: "Data", scene: Scene) -> float:
        """Largest difference of the ``other`` data, relative to curvature, slope of the gap, and stress of ``scene``."""
        R, length, stress = scene.profile.R, scene.length, scene.P / scene.length
        return max(
            float(np.abs(self.curvature - other.curvature).max()) * R,
            float(np.abs(self.tilt - other.tilt).max()) * R / length,
            float(np.abs(self.sigma - other.sigma).max()) / stress,
            float(np.abs(self.sigma_slope - other.sigma_slope).max()) * length / stress,
        )


@dataclass(frozen=True)
class Moments:
    """Moments int (x/reach)^j ... dx of the tractions at load points 1 and 2: ``p`` and ``q`` (2, k), N/m."""

    p: Array
    q: Array


def moments_of(rig: Rig, scene: Scene, result: Result) -> Moments:
    """Moments of the tractions of ``result``, a solution of ``scene``. What q is on the mean of a cycle does not count
    where the method does not determine it, but for its resultant."""
    of, (first, second) = result.traction, scene.load.ends
    Q = [scene.load.points[end][0] for end in (first, second)]
    x, weights = _rule(of.breaks)
    p2, dq = of.at(x)
    p1 = of.pressures_at(x)[0] if of.pressures_at else p2
    mean = np.zeros_like(dq)
    if of.levels_at:
        mean = sum(of.levels_at(x)) / 2
    p, q = np.array([p1, p2]), np.array([mean - dq / 2, mean + dq / 2])
    if not of.levels_at:  # the mean of Q acts somewhere: like the pressure, say
        q += np.mean(Q) / scene.P * p
    return Moments(rig.moments(x, weights * p), rig.moments(x, weights * q))


def data_of(rig: Rig, scene: Scene, moments: Moments, result: Result) -> Data:
    """Data for tractions with ``moments``, projected over the contacts and the stick zone of ``result``."""
    A, sigma = scene.material.A, np.array([scene.load.points[end][1] for end in scene.load.ends])
    strain = scene.material.bodies[0].A / 4 * sigma  # of the lower body
    opening = A * rig.opening(moments.p, moments.q) + rig.reach * strain[:, None] * rig.pulled[1]
    shift = A * rig.shift(moments.p, moments.q) + rig.reach * strain[:, None] * rig.pulled[0]
    curvature, tilt = np.empty(2), np.empty(2)
    for k, (left, right) in enumerate(result.ends):
        centre, a = (left + right) / 2, (right - left) / 2
        x = centre + a * _NODES
        slope = rig.slopes(x, opening[k]) + _arc(scene, x)
        curvature[k] = 2 * np.mean(slope * _NODES) / a
        tilt[k] = np.mean(slope) - curvature[k] * centre
    centre, c = result.stick_centre, result.stick_half_width
    if centre is None or c is None:
        centre, c = 0.0, result.a
    lost = -4 / A * np.array([rig.slopes(centre + c * _NODES, each) for each in shift])
    sigma_slope = 2 * np.mean(lost * _NODES, axis=1) / c
    return Data(curvature, tilt, sigma + lost.mean(axis=1) - sigma_slope * centre, sigma_slope)


def _rule(breaks: Array) -> tuple[Array, Array]:
    """Points and weights of quadrature between neighbouring ``breaks``, for functions with square roots there."""
    nodes, weights = np.polynomial.legendre.leggauss(_POINTS)
    angles, half = np.pi / 2 * (1 + nodes), np.diff(breaks)[:, None] / 2
    factors = half * np.pi / 2 * weights * np.sin(angles)
    return (breaks[:-1, None] + half * (1 - np.cos(angles))).ravel(), factors.ravel()


def _arc(scene: Scene, x: Array) -> Array:
    """Slope at ``x`` (n,), m, of the gap of a pad's true face less that of the profile."""
    if not scene.bodies.pad:
        return np.zeros_like(x)
    step = _STEP * np.ptp(x)
    more = scene.gap_at(x + [[step], [-step]]) - scene.profile.gap_at(x + [[step], [-step]])
    result: Array = (more[0] - more[1]) / (2 * step)
    return result
