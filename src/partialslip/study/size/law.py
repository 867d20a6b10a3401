"""Laws of the differences over the size, and the sizes from which on a body acts as a half-plane.

A difference is d(s) = d_inf +- C s^-k: d_inf remains however large the varied sizes s are, as the other sizes stay.
"""

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.stats import t as student

from partialslip.study.size.case import EQUIVALENT, HALF_PLANE, STRIPS
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

CLEAR = 10.0  # accuracy: a difference counts if it exceeds the mesh's error by this factor
LEVELS = (1e-2, 1e-3, 1e-4)  # display: differences for which the sizes needed are told, unless others are given
_FEWEST = 3  # accuracy: points of a law
_SHARE = 0.95  # accuracy: of confidence
# accuracy: times the largest solved size: as far as a law is trusted; and the size: the farthest end of its interval
BEYOND = 10.0
NAMES = {HALF_PLANE: "half-planes", EQUIVALENT: "equivalent half-planes", STRIPS: "exact strips"}
# limit: times the largest difference of the sizes: a larger one at the size that stands for an infinite one has grown
_GROWS = 3.0


Levels = Mapping[str, tuple[float, ...]]


def levels(texts: Sequence[str]) -> Levels:
    """Parse levels ``2%`` or ``0.02`` of all quantities, key "", and ``m=2%`` of one.

    Raises
    ------
    InputError
        If a text is no share.
    """
    found: dict[str, tuple[float, ...]] = {}
    for text in texts:
        quantity, _, share = text.rpartition("=")
        try:
            level = float(share.strip().removesuffix("%")) / (100 if share.strip().endswith("%") else 1)
        except ValueError:
            level = math.nan
        if not 0 < level < 1:
            raise InputError(f"--level {text}: must be a share > 0 and < 1, for example 2% or, of one quantity, m=2%")
        found[quantity] = (*found.get(quantity, ()), level)
    return found


@dataclass(frozen=True)
class Sizes:
    """A sweep along one axis: how far half-planes are from the finite elements.

    Parameters
    ----------
    name : str
        ``half-plane``, ``equivalent`` for half-planes with the data that make them act like the bodies, or ``strips``
        for the exact solution of two equal strips.
    size : (k,) array
        Values along the axis.
    change : mapping of str to (k,) array
        Difference by quantity, with a sign where it has one: a and p_max (largest p) relative, m and n as fractions of
        a, p and q in relative L2, and stresses (:func:`stress_quantities`) relative to those of the finite elements.
    mesh : mapping of str to (k,) array
        Part of the difference that may be an error of the meshes; NaN if not known.
    failed : mapping of float to str
        Values along the axis without a solution, and why.
    limit : float
        Value that stands for an infinite size: the difference there is what remains; infinite if there is none.
    levels : mapping of str to tuple of float
        Differences by quantity for which the sizes needed are told (:func:`levels`).
    """

    name: str
    size: Array
    change: Mapping[str, Array]
    mesh: Mapping[str, Array]
    failed: Mapping[float, str] = field(default_factory=dict)
    limit: float = math.inf
    levels: "Levels" = field(default_factory=dict)

    @cached_property
    def off(self) -> Mapping[str, Array]:
        """Absolute difference by quantity."""
        return {key: np.abs(change) for key, change in self.change.items()}

    @property
    def title(self) -> str:
        """Title of a table of the differences."""
        return f"Differences of {'the half-plane' if self.name == HALF_PLANE else NAMES[self.name]}"

    @cached_property
    def trends(self) -> "list[Trend]":
        """Trends of all quantities that have a value at one size above 0 at least."""
        sizes = (self.size > 0) & (self.size < self.limit)
        known = [quantity for quantity, off in self.off.items() if np.isfinite(off[sizes]).any()]
        return [trend(self, quantity) for quantity in known]

    def part(self, quantities: Collection[str]) -> "Sizes":
        """Return the same for some ``quantities`` alone."""
        change, mesh = ({key: each[key] for key in each if key in quantities} for each in (self.change, self.mesh))
        return replace(self, change=change, mesh=mesh)


class PointStatus(StrEnum):
    """What the law makes of a point; the text says why a point is not fitted."""

    FITTED = "fitted"
    SMALLER = "among the smaller sizes; the law holds for large ones"
    UNCLEAR = f"difference less than {CLEAR:g} times the mesh's error"
    FLOOR = f"all but what remains at an infinite size is less than {CLEAR:g} times its error"
    LIMIT = "stands for an infinite size: what remains"
    NO_LIMIT = "what remains at an infinite size is not known"
    UNKNOWN = "the mesh's error is not known: give fem.accuracy instead of fem.size"
    FEW = f"fewer than {_FEWEST} points are left for a law"
    NO_LAW = "the points tell no power law: its exponent may be 0 (95 %), or the sign changes"
    NO_VALUE = "no value to compare"


class Kind(StrEnum):
    """How the size for a level is known."""

    MEASURED = "measured"
    INTERPOLATED = "interpolated"
    EXTRAPOLATED = "extrapolated"
    BOUND = "bound"
    NEVER = "never"


class Floor(NamedTuple):
    """Limit of a difference for infinite sizes, solved at a large size: ``value`` with its sign, error of the ``mesh``,
    and the part still ``falling``."""

    value: float
    mesh: float
    falling: float

    @property
    def error(self) -> float:
        """Error of the value."""
        return self.mesh + self.falling

    @property
    def clear(self) -> bool:
        """Whether anything remains beyond the error."""
        return abs(self.value) > self.error

    def __str__(self) -> str:
        return f"{abs(self.value):.2g}" if self.clear else f"< {abs(self.value) + self.error:.1g}"


@dataclass(frozen=True)
class Law:
    """Fitted law difference = abs(floor + C size^-k), by least squares in the logarithms of C size^-k.

    Parameters
    ----------
    C, k : float
    sizes : tuple of float
        Fitted sizes.
    scatter : float
        Standard deviation of the logarithm of C size^-k about the law, times Student's factor for a confidence of 95 %.
    floor : Floor
        Negative if what falls with the size has the opposite sign.
    """

    C: float
    k: float
    sizes: tuple[float, ...]
    scatter: float
    floor: Floor

    def at(self, size: Array) -> Array:
        """Return the difference at ``size``."""
        return np.abs(self.floor.value + self.C * size**-self.k)

    @property
    def bounds(self) -> tuple[float, float]:
        """95 % confidence interval of k."""
        beside = self.scatter / math.sqrt(self._log_spread)
        return self.k - beside, self.k + beside

    @property
    def falls(self) -> bool:
        """Whether the difference falls with the size, with a confidence of 95 %."""
        return self.bounds[0] > 0

    @property
    def _log_spread(self) -> float:
        """Sum of squared distances of the logarithms of the sizes from their mean."""
        logs = np.log(self.sizes)
        return float(np.sum((logs - logs.mean()) ** 2))

    def size_for(self, level: float) -> tuple[float, float, float]:
        """Return the size at which the law gives ``level``, and the ends of the 95 % confidence interval of that size
        (Fieller, 1954), with the error of what remains; infinite where nothing is left of the level beside it."""
        left, error = level - self.floor.value, self.floor.error
        return self._for(left)[0], self._for(left + error)[1], self._for(left - error)[2]

    def _for(self, left: float) -> tuple[float, float, float]:
        """Size at which C size^-k is ``left``, and the ends of its interval."""
        if left <= 0:
            return (math.inf,) * 3
        middle = float(np.log(self.sizes).mean())
        rise = math.log(left) - math.log(self.C) + self.k * middle
        slope = self.scatter**2 / self._log_spread
        steep = self.k**2 - slope
        beside = math.sqrt(slope * rise**2 + self.scatter**2 / len(self.sizes) * steep)
        low, high = (math.exp(middle + (-self.k * rise + way * beside) / steep) for way in (-1, 1))
        return float((self.C / left) ** (1 / self.k)), low, high


@dataclass(frozen=True)
class Needed:
    """Size from which on the difference is below ``level``.

    Parameters
    ----------
    level : float
    kind : Kind
        ``measured``: at a solved size the difference equals the level within the mesh's error. ``interpolated`` between
        two solved sizes. ``extrapolated`` by the law. ``bound``: only ``low`` and ``high`` are known. ``never``: more
        than the level remains at an infinite size.
    size : float
        NaN for a bound, infinite for never.
    low, high : float
        Solved sizes beside the size: at ``low`` the difference is above the level (0 if no such size was solved), from
        ``high`` on below (infinite if no such size was solved). If extrapolated, the 95 % confidence interval.
    remains : Floor or None
        What remains at an infinite size; None if not known.
    """

    level: float
    kind: Kind
    size: float
    low: float
    high: float
    remains: Floor | None = None

    def __str__(self) -> str:
        if self.kind is Kind.NEVER and self.remains:
            return f"{self.kind}: {100 * abs(self.remains.value):.2g} % remains"
        if self.kind is Kind.EXTRAPOLATED:
            return f"{self.short} ({_digits(self.low)} to {_digits(self.high)}), {self.kind}"
        return f"{self.short}, {self.kind}" if math.isfinite(self.size) else self.short

    @property
    def short(self) -> str:
        """The size, or its bounds, alone."""
        if self.kind is Kind.NEVER:
            return f"{self.kind}"
        if self.kind is not Kind.BOUND:
            return f"{self.size:.4g}" if self.kind is Kind.MEASURED else _digits(self.size)
        if self.low == 0:
            return f"<= {self.high:.4g}" if self.high < math.inf else "not known"
        return f"> {self.low:.4g}" if self.high == math.inf else f"{self.low:.4g} to {self.high:.4g}"


def _digits(size: float) -> str:
    """Return ``size`` with three digits, zeros included, and without an exponent up to a million."""
    text = f"{size:#.3g}".removesuffix(".")
    return f"{float(text):.0f}" if "e+" in text and size < 1e6 else text


@dataclass(frozen=True)
class Trend:
    """How one quantity of half-planes approaches that of the bodies.

    Parameters
    ----------
    quantity : str
    points : tuple of PointStatus
        One per size.
    law : Law or None
    needed : tuple of Needed
        One per level.
    floor : Floor or None
        What remains at an infinite size; None if not known.
    """

    quantity: str
    points: tuple[PointStatus, ...]
    law: Law | None
    needed: tuple[Needed, ...]
    floor: Floor | None


def trend(sizes: Sizes, quantity: str) -> Trend:
    """Fit the law of ``quantity`` and find the sizes for all levels.

    The law is that of d - d_inf. A point is clear if this exceeds ten times the errors of d (of the mesh) and of d_inf.
    Of six or more clear points the larger half is fitted, of fewer the last three. There is a law where d - d_inf has
    one sign and falls with a confidence of 95 %. Without d_inf there is none.
    """
    size, change, mesh = sizes.size, sizes.change[quantity], sizes.mesh[quantity]
    known, far = np.isfinite(change) & (size > 0), size >= sizes.limit
    near = known & ~far
    floor = _floor(size, change, mesh, known, sizes.limit)
    off, falling = np.abs(change), change - (floor.value if floor else math.nan)
    sure = near & (off > 0) & (off > CLEAR * mesh)
    clear = near & (np.abs(falling) > CLEAR * (mesh + (floor.error if floor else math.nan)))
    at = np.flatnonzero(clear)
    used = at[len(at) // 2 :] if len(at) >= 2 * _FEWEST else at[-_FEWEST:]
    fitted = np.isin(np.arange(len(size)), used) & (len(used) >= _FEWEST)
    law = _fit(size[fitted], falling[fitted], floor, sizes.limit) if floor and fitted.any() else None
    clear_but = PointStatus.SMALLER if law else PointStatus.NO_LAW if fitted.any() else PointStatus.FEW
    which = {
        PointStatus.LIMIT: far & known & bool(floor),
        PointStatus.FITTED: fitted & bool(law),
        clear_but: clear,
        PointStatus.UNKNOWN: near & np.isnan(mesh),
        PointStatus.NO_LIMIT: (sure | (far & known)) & (floor is None or math.isnan(floor.error)),
        PointStatus.FLOOR: sure,
        PointStatus.UNCLEAR: near,
    }
    points = np.select([*which.values()], [*which], PointStatus.NO_VALUE)
    order = np.flatnonzero(near)
    asked = sizes.levels.get(quantity) or sizes.levels.get("") or LEVELS
    needed = tuple(_needed(level, size[order], off[order], mesh[order], sure[order], law, floor) for level in asked)
    return Trend(quantity, tuple(map(PointStatus, points)), law, needed, floor)


def _floor(size: Array, change: Array, mesh: Array, known: npt.NDArray[np.bool_], limit: float) -> Floor | None:
    """Limit of the change at infinite size: the change at ``limit``.

    From the largest size to ``limit`` differences of bodies fall with 1/size at least (docs/sizes/half-plane.md). None
    where the change exceeds those of all sizes by far: a slender body bends, and its difference grows.
    """
    at, last = np.flatnonzero(known & (size >= limit)), np.flatnonzero(known & (size < limit))
    if not (at.size and last.size):
        return None
    value = float(change[at[-1]])
    if abs(value) > _GROWS * np.abs(change[last]).max() + mesh[at[-1]]:
        return None
    falling = abs(float(change[last[-1]]) - value) * float(size[last[-1]]) / limit
    return Floor(value, float(mesh[at[-1]]), falling)


def _fit(size: Array, falling: Array, floor: Floor, limit: float) -> Law | None:
    """Law through the points; None if what is ``falling`` changes its sign, or may not fall."""
    sign = np.sign(falling[-1])
    if (sign * falling <= 0).any():
        return None
    x, y = np.log(size), np.log(sign * falling)
    slope, start = np.polyfit(x, y, 1)
    free = len(x) - 2
    scatter = math.sqrt(np.sum((y - slope * x - start) ** 2) / free)
    factor = float(student.ppf((1 + _SHARE) / 2, free))
    law = Law(math.exp(start), -float(slope), tuple(size.tolist()), factor * scatter, floor)
    left = abs(float(falling[-1])) * (float(size[-1]) / limit) ** law.bounds[0]
    remains = floor._replace(value=float(sign) * floor.value, falling=left)
    return replace(law, floor=remains) if law.falls else None


def _needed(
    level: float,
    size: Array,
    off: Array,
    mesh: Array,
    sure: npt.NDArray[np.bool_],
    law: Law | None,
    floor: Floor | None,
) -> Needed:
    """Return the size from which on the difference ``off``, with errors ``mesh``, is below ``level``."""
    above = off - mesh > level
    last = int(np.flatnonzero(~(off + mesh <= level)).max(initial=-1))
    low = float(size[above].max(initial=0.0))
    if floor and abs(floor.value) - floor.error > level:
        return Needed(level, Kind.NEVER, math.inf, low, math.inf, floor)
    if floor and abs(floor.value) + floor.error > level:
        return Needed(level, Kind.BOUND, math.nan, low, math.inf, floor)
    high = float(size[last + 1]) if last + 1 < len(size) else math.inf
    if last >= 0 and sure[last] and not above[last]:
        return Needed(level, Kind.MEASURED, float(size[last]), low, high, floor)
    if last >= 0 and high < math.inf and sure[last] and sure[last + 1]:
        ends = slice(last, last + 2)
        between = np.interp(-math.log(level), -np.log(off[ends]), np.log(size[ends]))
        return Needed(level, Kind.INTERPOLATED, math.exp(between), low, high, floor)
    if last >= 0 and law:
        at, least, most = (min(max(each, low), high) for each in law.size_for(level))
        if at <= BEYOND * size[-1] and most <= BEYOND * at:
            return Needed(level, Kind.EXTRAPOLATED, at, least, most, floor)
    return Needed(level, Kind.BOUND, math.nan, low, high, floor)
