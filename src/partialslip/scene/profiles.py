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

_SHARP = 0.05


class Hertz(Table, frozen=True, kw_only=True, tag_field="kind", tag="hertz"):
    """Undeformed gap x^2/(2R), with ``R`` the relative radius in m."""

    R: Positive

    @property
    def kinks(self) -> tuple[float, ...]:
        """Where the gap is not smooth, m: nowhere."""
        return ()

    def gap_at(self, x: Array) -> Array:
        """Gap before loading at ``x`` (m), m."""
        result: Array = x**2 / (2 * self.R)
        return result

    @property
    def widest(self) -> float:
        """Half-width of the widest pad of this shape, m."""
        return STEEPEST * self.R

    def face_at(self, x: Array) -> Array:
        """How far a pad of this shape, a cylinder, lies back at ``x`` (m), m."""
        return _arc(x, self.R)


class FlatRounded(Table, frozen=True, kw_only=True, tag_field="kind", tag="flat-rounded"):
    """A flat of half-width ``b`` (m) with corners of radius ``R`` (m): undeformed gap (|x| - b)^2/(2R) beyond it."""

    R: Positive
    b: Positive

    @property
    def kinks(self) -> tuple[float, ...]:
        """Where the gap is not smooth, m: the ends of the flat."""
        return (-self.b, self.b)

    @property
    def reach(self) -> float:
        """How far the profile is known, m."""
        return math.inf

    def gap_at(self, x: Array) -> Array:
        """Gap before loading at ``x`` (m), m."""
        result: Array = np.maximum(np.abs(x) - self.b, 0.0) ** 2 / (2 * self.R)
        return result

    @property
    def widest(self) -> float:
        """Half-width of the widest pad of this shape, m."""
        return self.b + STEEPEST * self.R

    def face_at(self, x: Array) -> Array:
        """How far a pad of this shape, whose corners are arcs, lies back at ``x`` (m), m."""
        return _arc(np.maximum(np.abs(x) - self.b, 0.0), self.R)

    def curvature_steps(self) -> tuple[Array, Array]:
        """Where the gap's curvature steps up (|x|, m), and by how much (1/m)."""
        return np.array([self.b]), np.array([1 / self.R])


class Tabulated(Table, frozen=True, kw_only=True, tag_field="kind", tag="tabulated"):
    """An even, convex gap by a table: ``gap`` (m) at ``x`` (m), both from 0 on.

    The slope goes linearly from the middle of each interval, where it is that of the chord, to the next: second-order
    accurate, exact for a parabola, and convex as the table is. Beyond the last middle the curvature stays as it is.
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
                raise InputError(f"profile.x[{i + 1}] = {x}: must be > {before}, the one before it")
        slopes = np.diff(self.gap) / np.diff(self.x)
        falls = np.flatnonzero(np.diff(slopes, prepend=0.0) < -ROUGH * max(slopes.max(), 0.0))
        if len(falls):
            x = self.x[falls[0]]
            raise InputError(f"profile.gap: must be convex, a slope that never falls: it does at x = {x}")
        if not slopes[-1] > 0:
            raise InputError("profile.gap: must rise somewhere")

    @property
    def R(self) -> float:
        """Radius of the parabola through the last point, m: a measure of size only."""
        return self.x[-1] ** 2 / (2 * self.gap[-1])

    @property
    def reach(self) -> float:
        """How far the profile is known, m."""
        return self.x[-1]

    @property
    def kinks(self) -> tuple[float, ...]:
        """Where the gap is not smooth, m: where its curvature steps by more than a twentieth of the largest one."""
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
        """Half-width of the widest pad of this shape, m."""
        return self.reach

    def face_at(self, x: Array) -> Array:
        """How far a pad of this shape lies back at ``x`` (m), m."""
        return self.gap_at(x)

    def curvature_steps(self) -> tuple[Array, Array]:
        """Where the gap's curvature steps (|x|, m), and by how much (1/m)."""
        x = np.array(self.x)
        middles = np.concatenate([[0.0], (x[1:] + x[:-1]) / 2])
        slopes = np.maximum.accumulate(np.concatenate([[0.0], np.diff(self.gap) / np.diff(x)]))
        curvatures = np.diff(slopes) / np.diff(middles)
        steps = np.diff(curvatures, prepend=0.0)
        real = np.abs(steps) > ROUGH * curvatures.max()
        return middles[:-1][real], steps[real]


def _arc(x: Array, R: float) -> Array:
    """R - sqrt(R^2 - x^2), without cancellation; not a number beyond the circle."""
    with np.errstate(invalid="ignore"):
        result: Array = x**2 / (R + np.sqrt(R**2 - x**2))
    return result


Profile = Hertz | FlatRounded | Tabulated
