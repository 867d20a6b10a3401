"""The critical plane: the plane through a point on which a measure of the stress path is largest.

The normal of a plane is (cos tilt cos angle, cos tilt sin angle, sin tilt). As sigma_xz = sigma_yz = 0, planes with
tilts of opposite sign have equal measures, and the measure is stationary across tilt = 0. A plane with tilt may still
be critical: sigma_zz is not zero in plane strain, and in plane stress the shear across the xy plane is not.

Sampled planes alone would be off by the square of their spacing. The measure is the largest of smooth functions, one
for each choice of load points, and a local maximum of the largest is a local maximum of one of them. Newton's method
from the best sampled planes therefore finds the maximum to rounding.
"""

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from partialslip.tools.arrays import Array, Indices, Mask

ANGLES, TILTS = 36, 5  # accuracy: sampled planes: 5 degrees apart in the xy plane, 22.5 degrees across
_STARTS = 3  # accuracy: sampled planes from which the maximum is sought
_EARLY = 1  # cost: steps from all starts; then only those go on that may still win
_CLOSE = 0.01  # accuracy: relative distance from the best within which a start may still win
_SAME = 0.2  # accuracy: distance, in spacings of the samples, of starts that climb the same peak
_MOST, _FINEST = 20, 1e-4  # accuracy: steps, and size of the last stencil over that of the first
# cost: numbers in an array, about: points are taken in blocks that fit into the memory of the processor
_BLOCK = 4_000_000


class Critical(NamedTuple):
    """Largest measure over all planes, and the normal of its plane.

    Parameters
    ----------
    value : array
        In the unit of the measure; NaN where the stress is NaN.
    angle : array
        Angle of the normal from the x axis in the xy plane, rad, from -pi/2 to pi/2.
    tilt : array
        Angle of the normal from the xy plane, rad, from 0 to pi/2.
    """

    value: Array
    angle: Array
    tilt: Array


@dataclass(frozen=True)
class OnPlanes:
    """Stresses on planes; the first axis of each array is the load path.

    Parameters
    ----------
    normal : (s, ...) array
        Normal stress, Pa.
    trace : (s, ...) array
        sigma_xx + sigma_yy + sigma_zz, Pa.
    resolve : callable
        Returns :attr:`shear`.
    """

    normal: Array
    trace: Array
    resolve: Callable[[], tuple[Array, Array]]

    @property
    def shear(self) -> tuple[Array, Array]:
        """Components of the shear stress in the xy plane and across it, (s, ...) each, Pa; not every measure asks."""
        return self.resolve()


PlaneMeasure = Callable[[OnPlanes], Array]


def stresses_on(stress: Array, angle: Array, tilt: Array) -> OnPlanes:
    """Return the stresses on planes.

    Parameters
    ----------
    stress : (s, 4, ...) array
        sigma_xx, sigma_yy, sigma_xy and sigma_zz along the load path, Pa.
    angle, tilt : arrays
        Normals, rad, of shapes that broadcast with those of the points.
    """
    xx, yy, xy, zz = np.moveaxis(stress, 1, 0)
    cos, sin = np.cos(2 * angle), np.sin(2 * angle)
    half = (xx - yy) / 2
    in_plane = (xx + yy) / 2 + half * cos + xy * sin
    up, out = np.cos(tilt), np.sin(tilt)
    return OnPlanes(
        up**2 * in_plane + out**2 * zz,
        xx + yy + zz,
        lambda: (up * (xy * cos - half * sin), up * out * (zz - in_plane)),
    )


def largest(values: Array) -> Array:
    """Return the largest of ``values`` (s, ...) along the load path.

    Pair by pair: over a short first axis this is several times as fast as ``max(axis=0)``.
    """
    return functools.reduce(np.maximum, values)


def range_of(values: Array) -> Array:
    """Return the range of ``values`` (s, ...) along the load path."""
    return largest(values) - functools.reduce(np.minimum, values)


def longest_chord(shear: tuple[Array, Array]) -> Array:
    """Return the largest distance between two points of the path of the shear stress in its plane, Pa."""
    one, other = shear
    if not other.any():  # shear along one line
        return range_of(one)
    squares = (
        (np.roll(one, lag, axis=0) - one) ** 2 + (np.roll(other, lag, axis=0) - other) ** 2
        for lag in range(1, len(one) // 2 + 1)
    )
    longest = np.zeros(one.shape[1:])
    for square in squares:
        longest = np.maximum(longest, largest(square))
    return np.sqrt(longest)


def critical_plane(stress: Array, measure: PlaneMeasure) -> Critical:
    """Find the plane on which ``measure`` is largest, at each point.

    Parameters
    ----------
    stress : (s, 4, ...) array
        sigma_xx, sigma_yy, sigma_xy and sigma_zz along the load path, Pa.
    measure : callable
        ``measure(on_planes) -> array``.

    Returns
    -------
    Critical
        Of the shape of the points.
    """
    shape = stress.shape[2:]
    points = stress.reshape(*stress.shape[:2], -1)
    found = np.full((3, points.shape[2]), np.nan)
    known = np.flatnonzero(np.isfinite(points).all(axis=(0, 1)))
    count = max(1, _BLOCK // (ANGLES * TILTS * len(points)))
    for start in range(0, len(known), count):
        block = known[start : start + count]
        found[:, block] = _in_block(points[:, :, block], measure)
    value, angle, tilt = found.reshape(3, *shape)
    return Critical(value, angle, tilt)


def _in_block(stress: Array, measure: PlaneMeasure) -> Array:
    """Value, angle and tilt (3, n) of the critical planes at the points of ``stress`` (s, 4, n)."""
    angle, tilt = _starts(stress, measure)
    point = np.tile(np.arange(stress.shape[2]), (len(angle), 1))
    value, angle, tilt = _climb(stress, measure, point, angle, tilt)
    best = value.argmax(axis=0)[None]
    value, angle, tilt = (np.take_along_axis(each, best, axis=0)[0] for each in (value, angle, tilt))
    # the normal, up to its sign and its mirror image in the xy plane
    tilt = np.abs((tilt + np.pi / 2) % np.pi - np.pi / 2)
    return np.stack([value, (angle + np.pi / 2) % np.pi - np.pi / 2, tilt])


def _starts(stress: Array, measure: PlaneMeasure) -> tuple[Array, Array]:
    """Angles and tilts (_STARTS + 2, n) of the sampled planes with the largest local maxima, and of two beside the
    largest."""
    angles, tilts = np.arange(ANGLES) * np.pi / ANGLES, np.linspace(0.0, np.pi / 2, TILTS)
    values = measure(stresses_on(stress[:, :, None, None], angles[:, None, None], tilts[:, None]))
    around = np.pad(values, ((1, 1), (0, 0), (0, 0)), mode="wrap")
    around = np.pad(around, ((0, 0), (1, 1), (0, 0)), mode="reflect")  # mirror images of the planes
    highest = np.maximum(np.maximum(around[:-2], around[1:-1]), around[2:])
    highest = np.maximum(np.maximum(highest[:, :-2], highest[:, 1:-1]), highest[:, 2:])
    peaks = np.where(values >= highest, values, -np.inf)
    peaks[1:, -1] = -np.inf  # the same plane for all angles
    peaks = peaks.reshape(ANGLES * TILTS, -1)
    best = np.argpartition(peaks, -_STARTS, axis=0)[-_STARTS:]
    angle, tilt = angles[best // TILTS], tilts[best % TILTS]
    # a peak narrower than the spacing may hide beside the highest sample
    first = np.take_along_axis(best, np.take_along_axis(peaks, best, axis=0).argmax(axis=0)[None], axis=0)
    beside = angles[first // TILTS] + np.pi / ANGLES * np.array([[-1], [1]])
    return np.concatenate([angle, beside]), np.concatenate([tilt, tilts[np.repeat(first % TILTS, 2, axis=0)]])


def _climb(
    stress: Array, measure: PlaneMeasure, point: Indices, angle: Array, tilt: Array
) -> tuple[Array, Array, Array]:
    """Climb to maxima of ``measure`` from several planes at each point, all arrays (starts, n), by Newton's method on
    stencils of 3 x 3 planes, which shrink where the maximum is within."""
    shape, point, angle, tilt = angle.shape, point.ravel(), angle.ravel(), tilt.ravel()
    value, scale, active = np.full(angle.size, -np.inf), np.ones(angle.size), np.arange(angle.size)
    offsets = np.arange(-1, 2)[:, None]
    for step in range(_MOST):
        a, t, size = angle[active], tilt[active], scale[active]
        across, along = np.pi / ANGLES / 2 * size, np.pi / 2 / (TILTS - 1) / 2 * size
        here = stress[:, :, point[active]]
        f = measure(stresses_on(here[:, :, None, None], a + across * offsets[:, None], t + along * offsets))
        highest = f.reshape(9, -1).argmax(axis=0)
        steps = _newton(f)
        there = a + across * steps[0], t + along * steps[1]
        reached, best = measure(stresses_on(here, *there)), f.reshape(9, -1)[highest, np.arange(len(a))]
        newton = reached >= best
        value[active] = np.where(newton, reached, best)
        angle[active] = np.where(newton, there[0], a + across * (highest // 3 - 1))
        tilt[active] = np.where(newton, there[1], t + along * (highest % 3 - 1))
        inside = np.where(newton, np.maximum(*np.abs(steps)) < 1, highest == 4)
        scale[active] = np.where(inside, size * np.where(newton, 0.1, 0.4), size)
        if step == _EARLY:
            scale[~_may_win(value.reshape(shape), angle.reshape(shape), tilt.reshape(shape)).ravel()] = 0.0
        active = np.flatnonzero(scale > _FINEST)
        if not len(active):
            break
    return value.reshape(shape), angle.reshape(shape), tilt.reshape(shape)


def _may_win(value: Array, angle: Array, tilt: Array) -> Mask:
    """Whether a start may still win: the best of its point, or one nearly as high that climbs another peak."""
    best = value.argmax(axis=0)[None]
    highest, angle_0, tilt_0 = (np.take_along_axis(each, best, axis=0) for each in (value, angle, tilt))
    turned = np.abs((angle - angle_0 + np.pi / 2) % np.pi - np.pi / 2) * ANGLES / np.pi
    apart = np.maximum(turned, np.abs(tilt - tilt_0) * (TILTS - 1) / (np.pi / 2)) > _SAME
    return (apart & (value >= highest - _CLOSE * np.abs(highest))) | (np.arange(len(value))[:, None] == best)


def _newton(f: Array) -> tuple[Array, Array]:
    """Steps to the maximum of the quadratic function through ``f`` (3, 3, ...), in spacings, at most 2; where it has no
    maximum in one direction, no step in that direction."""
    slope = (f[2, 1] - f[0, 1]) / 2, (f[1, 2] - f[1, 0]) / 2
    bend = f[2, 1] - 2 * f[1, 1] + f[0, 1], f[1, 2] - 2 * f[1, 1] + f[1, 0]
    mixed = (f[2, 2] - f[2, 0] - f[0, 2] + f[0, 0]) / 4
    determinant = bend[0] * bend[1] - mixed**2
    regular = (bend[0] < 0) & (determinant > 1e-12 * bend[0] ** 2)
    safe = np.where(regular, determinant, 1.0)
    both = (
        (mixed * slope[1] - bend[1] * slope[0]) / safe,
        (mixed * slope[0] - bend[0] * slope[1]) / safe,
    )
    alone = (np.where(b < 0, -s / np.where(b < 0, b, 1.0), 0.0) for s, b in zip(slope, bend, strict=True))
    one, other = (np.clip(np.where(regular, x, y), -2, 2) for x, y in zip(both, alone, strict=True))
    return one, other
