"""The data of half-planes that act like bodies of a size (docs/theory.md, section 12).

What a rig adds to the displacements of half-planes is smooth: v(x), an opening, acts like a change of the gap, and u(x)
like a bulk strain. Half-planes take the linear and the quadratic part of v, a tilt and a curvature, and the constant
and the linear part of the strain, a tension that varies along x. Each is the projection on Chebyshev polynomials over
the contact, or over the stick zone: the conditions that fix their ends then hold exactly, whatever the rest is.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from partialslip.result import Result
from partialslip.result.rig import Rig
from partialslip.scene import Scene
from partialslip.tools.arrays import Array

_POINTS = 32  # accuracy: of quadrature
_NODES = np.cos(np.pi * (np.arange(_POINTS) + 0.5) / _POINTS)  # Gauss-Chebyshev's rule
_ROUNDING = 1e-13  # accuracy: of the slope of the gap at the ends of the contact
_STEP = 1e-4  # accuracy: of the contact, for the slope of a face


class Moments(NamedTuple):
    """Moments int (x/reach)^j p dx and int (x/reach)^j q dx, N/m, at all load points, (points, k)."""

    p: Array
    q: Array


@dataclass(frozen=True, eq=False)
class HalfPlaneData:
    """Data of half-planes at all load points; arrays (points,).

    Parameters
    ----------
    curvature : Array
        What the curvature of the gap gains, 1/m.
    tilt : Array
        What the slope of the gap at x = 0 gains, rad.
    sigma : Array
        Differential bulk tension at x = 0, Pa.
    sigma_slope : Array
        Slope of the differential bulk tension along x, Pa/m.
    rest : Array
        Chebyshev coefficients, from the second on, of what half-planes leave out of the slope of the gap over the
        contact, (points, c).
    strain_rest : Array
        The same of the strain over the stick zone, (points, c).
    """

    curvature: Array
    tilt: Array
    sigma: Array
    sigma_slope: Array
    rest: Array
    strain_rest: Array

    def scaled(self, scene: Scene) -> Array:
        """The data but for the rests, (4, points), relative to the curvature of the gap of ``scene``, its slope at the
        ends of the contact, and the mean pressure."""
        values = np.array([self.curvature, self.tilt, self.sigma, self.sigma_slope])
        return values / _units(scene)

    def moved(self, scaled: Array, scene: Scene) -> "HalfPlaneData":
        """These data with others in their place, ``scaled`` (4, points) as by :meth:`scaled`."""
        curvature, tilt, sigma, sigma_slope = scaled * _units(scene)
        return replace(self, curvature=curvature, tilt=tilt, sigma=sigma, sigma_slope=sigma_slope)


def moments_of(rig: Rig, scene: Scene, result: Result) -> Moments:
    """Moments of the tractions of ``result``, a solution of ``scene``.

    Between load points 1 and 2, moments other than the resultants P and Q are taken as linear. What a cycle locks in
    and the method does not determine does not count.
    """
    of, x, weights = result.traction, *_rule(result.traction.breaks)
    at = of.at(x)
    levels = at.levels or (-at.dq / 2, at.dq / 2)
    p1, p2, q1, q2 = (rig.moments(x, weights * each) for each in (*at.pressures, *levels))
    shares = _shares(scene)[:, None]
    q = q1 + shares * (q2 - q1)
    q[:, 0] = [Q for Q, *_ in scene.load.points]
    return Moments(p1 + shares * (p2 - p1), q)


def data_of(rig: Rig, scene: Scene, moments: Moments, result: Result, shear: bool) -> HalfPlaneData:
    """Data for tractions with ``moments``, projected over the contacts and the stick zone of ``result``. Without
    ``shear`` the strain by shear tractions does not count."""
    A, sigma = scene.material.A, np.array([sigma for _, sigma, *_ in scene.load.points])
    strain = scene.material.bodies[0].A / 4 * sigma[:, None]  # of the lower body
    opening = A * rig.opening(*moments) + rig.reach * strain * rig.terms.pulled[1]
    shift = A * rig.shift(moments.p, moments.q * shear) + rig.reach * strain * rig.terms.pulled[0]
    (left1, right1), (left2, right2) = result.ends
    shares = _shares(scene)
    centres = ((1 - shares) * (left1 + right1) + shares * (left2 + right2)) / 2
    a = (right1 - left1 + right2 - left2) / 4
    x = centres[:, None] + a * _NODES
    slope = np.array([rig.slopes(at, own) for at, own in zip(x, opening, strict=True)]) + _arc(scene, x)
    gap = chebyshev_coefficients(slope)
    centre, c = result.stick_centre, result.stick_half_width
    if centre is None or c is None:
        centre, c = 0.0, a
    tilt = gap[:, 0] - gap[:, 1] / a * centres
    lost = chebyshev_coefficients(-4 / A * rig.slopes(centre + c * _NODES, shift))
    return HalfPlaneData(
        curvature=gap[:, 1] / a,
        tilt=np.where(np.abs(tilt) > _ROUNDING * a / scene.profile.R, tilt, 0.0),
        sigma=sigma + lost[:, 0] - lost[:, 1] / c * centre,
        sigma_slope=lost[:, 1] / c,
        rest=gap[:, 2:],
        strain_rest=lost[:, 2:],
    )


def _units(scene: Scene) -> Array:
    """Sizes of curvature, tilt, sigma and its slope, (4, 1)."""
    R, length, stress = scene.profile.R, scene.length, scene.P / scene.length
    return np.array([[1 / R], [length / R], [stress], [stress / length]])


def _shares(scene: Scene) -> Array:
    """Places of the load points on the way from load point 1, at 0, to load point 2, at 1: by Q, or by sigma where Q is
    constant."""
    Q, sigma = (np.array(loads) for loads in list(zip(*scene.load.points, strict=True))[:2])
    along = Q if np.ptp(Q) > 0 else sigma
    first, second = scene.load.ends
    way = along[second] - along[first]
    return (along - along[first]) / way if way else np.zeros_like(along)


def nodes() -> Array:
    """Points in [-1, 1] at which functions are projected."""
    return _NODES


def chebyshev_coefficients(values: Array) -> Array:
    """Chebyshev coefficients (..., c) of functions with ``values`` (..., n) at the nodes."""
    count = _POINTS // 2
    result: Array = 2 / _POINTS * values @ np.polynomial.chebyshev.chebvander(_NODES, count)
    result[..., 0] /= 2
    return result


def _rule(breaks: Array) -> tuple[Array, Array]:
    """Points and weights of quadrature between neighbouring ``breaks``, for functions with square roots there."""
    nodes, weights = np.polynomial.legendre.leggauss(_POINTS)
    angles, half = np.pi / 2 * (1 + nodes), np.diff(breaks)[:, None] / 2
    factors = half * np.pi / 2 * weights * np.sin(angles)
    return (breaks[:-1, None] + half * (1 - np.cos(angles))).ravel(), factors.ravel()


def _arc(scene: Scene, x: Array) -> Array:
    """Slope at ``x`` (..., n), m, of the gap of a pad's true face less that of the profile."""
    if not scene.bodies.pad:
        return np.zeros_like(x)
    step = _STEP * float(np.ptp(x))
    after, before = (scene.gap_at(x + by) - scene.profile.gap_at(x + by) for by in (step, -step))
    return (after - before) / (2 * step)
