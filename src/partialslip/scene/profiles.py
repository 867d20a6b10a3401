"""Profiles: the gap between the undeformed bodies."""

import itertools
import math
from typing import Annotated

import msgspec
import numpy as np

from partialslip.arrays import Array
from partialslip.errors import InputError
from partialslip.scene.limits import ROUGH
from partialslip.scene.limits import STEEPEST as STEEPEST
from partialslip.scene.table import Positive, Table

_SHARP = 0.05  # step of curvature, relative to the largest curvature, above which a point is a kink


class Hertz(Table, frozen=True, kw_only=True, tag_field="kind", tag="hertz"):
    """Undeformed gap x^2/(2R); relative radius ``R``, m."""

    R: Positive

    @property
    def kinks(self) -> tuple[float, ...]:
        """Points at which the gap is not smooth, m: none."""
        return ()

    def gap_at(self, x: Array) -> Array:
        """Gap before loading at ``x`` (m), m."""
        result: Array = x**2 / (2 * self.R)
        return result

    @property
    def widest(self) -> float:
        """Half-width of the widest pad with this profile, m."""
        return STEEPEST * self.R

    def face_at(self, x: Array) -> Array:
        """Distance of a cylindrical pad's face from the tangent in the middle, m, at ``x`` (m)."""
        return _arc(x, self.R)


class FlatRounded(Table, frozen=True, kw_only=True, tag_field="kind", tag="flat-rounded"):
    """Flat of half-width ``b`` (m) with corners of radius ``R`` (m): undeformed gap (|x| - b)^2/(2R) for |x| > b."""

    R: Positive
    b: Positive

    @property
    def kinks(self) -> tuple[float, ...]:
        """Points at which the gap is not smooth, m: the ends of the flat."""
        return (-self.b, self.b)

    @property
    def reach(self) -> float:
        """Largest |x| at which the gap is known, m."""
        return math.inf

    def gap_at(self, x: Array) -> Array:
        """Gap before loading at ``x`` (m), m."""
        result: Array = np.maximum(np.abs(x) - self.b, 0.0) ** 2 / (2 * self.R)
        return result

    @property
    def widest(self) -> float:
        """Half-width of the widest pad with this profile, m."""
        return self.b + STEEPEST * self.R

    def face_at(self, x: Array) -> Array:
        """Distance of the face of a pad with circular corners from the flat, m, at ``x`` (m)."""
        return _arc(np.maximum(np.abs(x) - self.b, 0.0), self.R)

    def curvature_steps(self) -> tuple[Array, Array]:
        """Points of the steps of the gap's curvature (|x|, m), (1,), and the steps (1/m), (1,)."""
        return np.array([self.b]), np.array([1 / self.R])


class Tabulated(Table, frozen=True, kw_only=True, tag_field="kind", tag="tabulated"):
    """Even, convex gap given by a table: ``gap`` (m) at ``x`` (m), both beginning at 0.

    The slope in the middle of each interval is that of the chord and is interpolated linearly between middles. This is
    of second order, exact for a parabola, and convex like the table. Beyond the last middle the curvature is constant.
    """

    x: Annotated[tuple[float, ...], msgspec.Meta(min_length=3, max_length=1000)]
    gap: Annotated[tuple[float, ...], msgspec.Meta(min_length=3, max_length=1000)]

    def __post_init__(self) -> None:
        if len(self.x) != len(self.gap):
            raise InputError(f"profile.gap: must have as many numbers as profile.x, {len(self.x)}, not {len(self.gap)}")
        for name, values in (("x", self.x), ("gap", self.gap)):
            if values[0] != 0:
                raise InputError(f"profile.{name}[0] = {values[0]}: must be 0, the middle of the contact")
        for i, (before, x) in enumerate(itertools.pairwise(self.x)):
            if not x > before:
                raise InputError(f"profile.x[{i + 1}] = {x}: must be > profile.x[{i}] = {before}")
        slopes = np.diff(self.gap) / np.diff(self.x)
        falls = np.flatnonzero(np.diff(slopes, prepend=0.0) < -ROUGH * max(slopes.max(), 0.0))
        if len(falls):
            x = self.x[falls[0]]
            raise InputError(f"profile.gap: must be convex; its slope decreases at x = {x} m")
        if not slopes[-1] > 0:
            raise InputError("profile.gap: must increase with x; the gap is constant")

    @property
    def R(self) -> float:
        """Radius of the parabola through the last point, m, as a measure of size."""
        return self.x[-1] ** 2 / (2 * self.gap[-1])

    @property
    def reach(self) -> float:
        """Largest |x| at which the gap is known, m."""
        return self.x[-1]

    @property
    def kinks(self) -> tuple[float, ...]:
        """Points at which the gap is not smooth, m: steps of curvature above 5 % of the largest curvature."""
        at, steps = self.curvature_steps()
        sharp = at[(np.abs(steps) > _SHARP * np.cumsum(steps).max()) & (at > 0)]
        return (*(-sharp[::-1]).tolist(), *sharp.tolist())

    def gap_at(self, x: Array) -> Array:
        """Gap before loading at ``x`` (m), m."""
        at, steps = self.curvature_steps()
        beyond = np.maximum(np.abs(x)[..., None] - at, 0.0)
        result: Array = beyond**2 @ steps / 2
        return result

    @property
    def widest(self) -> float:
        """Half-width of the widest pad with this profile, m."""
        return self.reach

    def face_at(self, x: Array) -> Array:
        """Distance of a pad's face from the tangent in the middle, m, at ``x`` (m)."""
        return self.gap_at(x)

    def curvature_steps(self) -> tuple[Array, Array]:
        """Points of the steps of the gap's curvature (|x|, m), (k,), and the steps (1/m), (k,)."""
        x = np.array(self.x)
        middles = np.concatenate([[0.0], (x[1:] + x[:-1]) / 2])
        slopes = np.maximum.accumulate(np.concatenate([[0.0], np.diff(self.gap) / np.diff(x)]))
        curvatures = np.diff(slopes) / np.diff(middles)
        steps = np.diff(curvatures, prepend=0.0)
        real = np.abs(steps) > ROUGH * curvatures.max()
        return middles[:-1][real], steps[real]


def _arc(x: Array, R: float) -> Array:
    """R - sqrt(R^2 - x^2) without cancellation; NaN for |x| > R."""
    with np.errstate(invalid="ignore"):
        result: Array = x**2 / (R + np.sqrt(R**2 - x**2))
    return result


Profile = Hertz | FlatRounded | Tabulated
