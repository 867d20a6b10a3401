"""Profiles: the gap between the undeformed bodies."""

import itertools
import math
from typing import Annotated, Any, Literal, NamedTuple

import msgspec
import numpy as np

from partialslip.scene.measured import Measured
from partialslip.scene.table import ROUGH, Positive, Table
from partialslip.scene.table import STEEPEST as STEEPEST
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

_SHARP = 0.05  # accuracy: step of curvature, relative to the largest curvature, above which a point is a kink


class Curvature(NamedTuple):
    """Curvature of a gap, constant between points.

    Parameters
    ----------
    lowest : float
        Point of zero slope, m.
    breaks : (k,) array
        Points of the steps of curvature, ascending, m.
    values : (k + 1,) array
        Curvatures between the points, 1/m, not negative but around the middle of a hollow flat.
    reach : (float, float)
        Ends of the range in which the gap is known, m.
    """

    lowest: float
    breaks: Array
    values: Array
    reach: tuple[float, float]

    @property
    def mirrored(self) -> "Curvature":
        """Curvature of the mirror image."""
        low, high = self.reach
        return Curvature(-self.lowest, -self.breaks[::-1], self.values[::-1], (-high, -low))

    def tilted(self, tilt: float) -> "Curvature":
        """Curvature of the gap less ``tilt`` x: the same but for the point of zero slope."""
        number = int(np.searchsorted(self.breaks, self.lowest, "right"))
        ends = np.concatenate([[-math.inf], self.breaks, [math.inf]])
        base, slope = self.values[number], 0.0
        x, way = self.lowest, 1 if tilt > 0 else -1
        if base < 0 and ends[number] < (inner := self.lowest + tilt / base) < ends[number + 1]:
            return self._replace(lowest=float(inner))
        while True:  # outwards, where the slope grows
            end = ends[number + (way > 0)]
            value = self.values[number]
            if math.isinf(end) or way * (slope + value * (end - x) - tilt) >= 0:
                return self._replace(lowest=float(x + (tilt - slope) / value if tilt != slope else x))
            slope, x, number = slope + value * (end - x), end, number + way

    def slope_at(self, x: Array) -> Array:
        """Slope of the gap at ``x`` (m)."""
        return self._integrated(1, x)

    def gap_at(self, x: Array) -> Array:
        """Gap at ``x`` (m), m; zero at the lowest point."""
        return self._integrated(2, x)

    def _integrated(self, times: int, x: Array) -> Array:
        """Curvature integrated once or twice (``times``) from the lowest point outwards."""
        x = np.asarray(x, float)
        right, steps = self.breaks >= self.lowest, np.diff(self.values)
        base = self.values[np.count_nonzero(~right)]
        ahead = np.maximum(x[..., None] - self.breaks[right], 0.0)
        behind = np.maximum(self.breaks[~right] - x[..., None], 0.0)
        sums = ahead**times @ steps[right] - (-1) ** times * (behind**times @ steps[~right])
        return (base * (x - self.lowest) ** times + sums) / times


class Even(Table, frozen=True, kw_only=True):
    """Profiles with an even gap."""

    @property
    def even(self) -> bool:
        """Whether the gap is even in x: yes."""
        return True

    @property
    def turns(self) -> bool:
        """Whether the bodies turn until the moment is the given one: yes."""
        return True


class Hertz(Even, frozen=True, kw_only=True, tag_field="kind", tag="hertz"):
    """Undeformed gap x^2/(2R); relative radius ``R``, m."""

    R: Positive

    @property
    def curvature(self) -> Curvature:
        """Curvature of the gap."""
        return Curvature(0.0, np.array([]), np.array([1 / self.R]), (-math.inf, math.inf))

    @property
    def kinks(self) -> tuple[float, ...]:
        """Points at which the gap is not smooth, m: none."""
        return ()

    def gap_at(self, x: Array) -> Array:
        """Gap before loading at ``x`` (m), m."""
        return x**2 / (2 * self.R)

    def curved(self, curvature: float) -> dict[str, Any]:
        """Keys of the profile that has this ``curvature`` (1/m) more."""
        return {"R": 1 / (1 / self.R + curvature)}

    @property
    def widest(self) -> float:
        """Half-width of the widest pad with this profile, m."""
        return STEEPEST * self.R

    def face_at(self, x: Array) -> Array:
        """Distance of a cylindrical pad's face from the tangent in the middle, m, at ``x`` (m)."""
        return _arc(x, self.R)


class FlatRounded(Even, frozen=True, kw_only=True, tag_field="kind", tag="flat-rounded"):
    """Flat of half-width ``b`` (m) with corners of radius ``R`` (m): undeformed gap (|x| - b)^2/(2R) for |x| > b.

    A flat that is not quite flat has the radius ``crown`` (m), negative if it is hollow: x^2/(2 crown) more gap.
    """

    R: Positive
    b: Positive
    crown: float | None = None

    def __post_init__(self) -> None:
        if self.crown is not None and -self.R <= self.crown <= 0:
            raise InputError(
                f"profile.crown = {self.crown}: must be > 0, or < {-self.R} m, hollow by less than the corners"
            )

    @property
    def bow(self) -> float:
        """Curvature of the flat, 1/m: 1/crown, or zero."""
        return 1 / self.crown if self.crown else 0.0

    @property
    def curvature(self) -> Curvature:
        """Curvature of the gap."""
        values = np.array([1, 0, 1]) / self.R + self.bow
        return Curvature(0.0, np.array(self.kinks), values, (-math.inf, math.inf))

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
        return np.maximum(np.abs(x) - self.b, 0.0) ** 2 / (2 * self.R) + np.square(x) * (self.bow / 2)

    def curved(self, curvature: float) -> dict[str, Any]:
        """Keys of the profile that has this ``curvature`` (1/m) more."""
        bow = self.bow + curvature
        return {"crown": 1 / bow if bow else None}

    @property
    def widest(self) -> float:
        """Half-width of the widest pad with this profile, m."""
        return self.b + STEEPEST * self.R

    def face_at(self, x: Array) -> Array:
        """Distance of the face of a pad with circular corners from the flat, m, at ``x`` (m)."""
        return _arc(np.maximum(np.abs(x) - self.b, 0.0), self.R)

    def curvature_steps(self) -> tuple[Array, Array]:
        """Points of the steps of the gap's curvature (|x|, m), (k,), and the steps (1/m), (k,)."""
        if self.bow:
            return np.array([0.0, self.b]), np.array([self.bow, 1 / self.R])
        return np.array([self.b]), np.array([1 / self.R])


class Tabulated(Table, frozen=True, kw_only=True, tag_field="kind", tag="tabulated"):
    """Convex gap given by a table: ``gap`` (m) at ``x`` (m), ascending.

    If x begins at 0 the gap is even, and begins at 0. If x begins below 0 the table has both sides, and any gap may be
    the smallest. ``measured`` tells how a table was made from a file. ``tilt`` = "fixed": the bodies do not turn, and
    the tilt of the table stays. By default they turn until the moment of the pressure is load.M.

    The slope in the middle of each interval is that of the chord and is interpolated linearly between middles. This is
    of second order, exact for a parabola, and convex like the table. Beyond the last middle the curvature is constant.
    """

    x: Annotated[tuple[float, ...], msgspec.Meta(min_length=3, max_length=1000)]
    gap: Annotated[tuple[float, ...], msgspec.Meta(min_length=3, max_length=1000)]
    tilt: Literal["free", "fixed"] = "free"
    measured: Measured | None = None

    def __post_init__(self) -> None:
        if len(self.x) != len(self.gap):
            raise InputError(f"profile.gap: must have as many numbers as profile.x, {len(self.x)}, not {len(self.gap)}")
        self._check_points()
        slopes = np.diff(self.gap) / np.diff(self.x)
        falls = np.flatnonzero(np.diff(slopes, prepend=0.0 if self.even else -math.inf) < -ROUGH * np.abs(slopes).max())
        if len(falls):
            x = self.x[falls[0]]
            raise InputError(f"profile.gap: must be convex; its slope decreases at x = {x} m")
        if not slopes[-1] > 0:
            where = "with x; the gap is constant" if self.even else "at the last x, right of the lowest point"
            raise InputError(f"profile.gap: must increase {where}")
        if not (self.even or slopes[0] < 0):
            raise InputError("profile.gap: must fall at the first x, left of the lowest point; it increases")

    def _check_points(self) -> None:
        """Raise InputError if the points are not ascending, or the gap does not begin at 0."""
        if self.x[0] > 0 or (self.even and self.gap[0] != 0):
            name, values = ("x", self.x) if self.x[0] > 0 else ("gap", self.gap)
            sides = ", or below 0 for a table of both sides" if name == "x" else ""
            raise InputError(f"profile.{name}[0] = {values[0]}: must be 0, the middle of the contact{sides}")
        for i, (before, x) in enumerate(itertools.pairwise(self.x)):
            if not x > before:
                raise InputError(f"profile.x[{i + 1}] = {x}: must be > profile.x[{i}] = {before}")
        if self.x[-1] <= 0:
            raise InputError(f"profile.x[{len(self.x) - 1}] = {self.x[-1]}: must be > 0")

    @property
    def even(self) -> bool:
        """Whether the gap is even in x: the table begins at x = 0."""
        return self.x[0] == 0

    @property
    def turns(self) -> bool:
        """Whether the bodies turn until the moment is the given one."""
        return self.tilt == "free"

    @property
    def R(self) -> float:
        """Radius of a parabola of about the table's size, m, as a measure of size."""
        if self.even:
            return self.x[-1] ** 2 / (2 * self.gap[-1])
        return (self.x[-1] - self.x[0]) ** 2 / (4 * (self.gap[0] + self.gap[-1] - 2 * min(self.gap)))

    @property
    def reach(self) -> float:
        """Largest |x| at which the gap is known, m."""
        return min(self.x[-1], -self.x[0]) if not self.even else self.x[-1]

    @property
    def curvature(self) -> Curvature:
        """Curvature of the gap."""
        if self.even:
            at, steps = self.curvature_steps()
            curvatures = np.cumsum(steps)
            inner = at > 0
            base = 0.0 if at[0] else curvatures[0]  # a flat in the middle, or none
            values = np.array([*curvatures[inner][::-1], base, *curvatures[inner]])
            breaks = np.concatenate([-at[inner][::-1], at[inner]])
            return Curvature(0.0, breaks, values, (-self.reach, self.reach))
        x = np.array(self.x)
        middles, slopes = (x[1:] + x[:-1]) / 2, np.maximum.accumulate(np.diff(self.gap) / np.diff(x))
        curvatures = np.diff(slopes) / np.diff(middles)
        steps = np.diff(curvatures)
        real = np.abs(steps) > ROUGH * curvatures.max()
        values = curvatures[np.append(True, real)]
        # the slope is zero between two middles, or beyond all of them, where the curvature goes on
        after = int(np.clip(np.searchsorted(slopes, 0.0), 1, len(slopes) - 1))
        flat = np.flatnonzero(slopes == 0)
        lowest = middles[flat].mean() if len(flat) else middles[after] - slopes[after] / curvatures[after - 1]
        return Curvature(float(lowest), middles[1:-1][real], values, (self.x[0], self.x[-1]))

    @property
    def kinks(self) -> tuple[float, ...]:
        """Points at which the gap is not smooth, m: steps of curvature above 5 % of the largest curvature."""
        _, breaks, values, _ = self.curvature
        return tuple(breaks[np.abs(np.diff(values)) > _SHARP * values.max()].tolist())

    def gap_at(self, x: Array) -> Array:
        """Gap before loading at ``x`` (m), m."""
        if not self.even:
            return self.curvature.gap_at(x)
        at, steps = self.curvature_steps()
        beyond = np.maximum(np.abs(x)[..., None] - at, 0.0)
        return beyond**2 @ steps / 2

    def curved(self, curvature: float) -> dict[str, Any]:
        """Keys of the profile that has this ``curvature`` (1/m) more."""
        return {"gap": (np.array(self.gap) + curvature * np.array(self.x) ** 2 / 2).tolist(), "tilt": "free"}

    @property
    def widest(self) -> float:
        """Half-width of the widest pad with this profile, m."""
        return self.reach

    def face_at(self, x: Array) -> Array:
        """Distance of a pad's face from the tangent in the middle, m, at ``x`` (m)."""
        return self.gap_at(x)

    def curvature_steps(self) -> tuple[Array, Array]:
        """Points of the steps of an even gap's curvature (|x|, m), (k,), and the steps (1/m), (k,)."""
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
