"""Laws of the differences over the size, and the sizes from which on a body acts as a half-plane."""

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.stats import t as student

from partialslip.arrays import Array
from partialslip.study.size.case import HALF_PLANE

CLEAR = 10.0  # accuracy: a difference counts if it exceeds the mesh's error by this factor
LEVELS = (1e-2, 1e-3, 1e-4)  # display: differences for which the sizes needed are told
_FEWEST = 3  # accuracy: points of a law
_SHARE = 0.95  # accuracy: of confidence
# accuracy: times the largest solved size: as far as a law is trusted; and the size: the farthest end of its interval
_BEYOND = 10.0


@dataclass(frozen=True)
class Sizes:
    """A sweep along one axis: how far half-planes are from the finite elements.

    Parameters
    ----------
    name : str
        ``half-plane``, or ``equivalent`` for half-planes with the data that make them act like the bodies.
    size : (k,) array
        Values along the axis.
    off : mapping of str to (k,) array
        Difference by quantity: a and p_max (largest p) relative, m and n as fractions of a, p and q in relative L2, and
        stresses (:func:`stress_quantities`) relative to those of the finite elements.
    mesh : mapping of str to (k,) array
        Part of the difference that may be an error of the meshes; NaN if not known.
    failed : mapping of float to str
        Values along the axis without a solution, and why.
    """

    name: str
    size: Array
    off: Mapping[str, Array]
    mesh: Mapping[str, Array]
    failed: Mapping[float, str] = field(default_factory=dict)

    @property
    def title(self) -> str:
        """Title of a table of the differences."""
        return f"Differences of the {self.name}" if self.name == HALF_PLANE else "Differences of equivalent half-planes"

    @cached_property
    def trends(self) -> "list[Trend]":
        """Trends of all quantities that have a value at one size above 0 at least."""
        known = [quantity for quantity, off in self.off.items() if np.isfinite(off[self.size > 0]).any()]
        return [trend(self, quantity) for quantity in known]

    def part(self, quantities: Collection[str]) -> "Sizes":
        """Return the same for some ``quantities`` alone."""
        off, mesh = ({key: each[key] for key in each if key in quantities} for each in (self.off, self.mesh))
        return replace(self, off=off, mesh=mesh)


class PointStatus(StrEnum):
    """What the law makes of a point; the text says why a point is not fitted."""

    FITTED = "fitted"
    SMALLER = "among the smaller sizes; the law holds for large ones"
    UNCLEAR = f"difference less than {CLEAR:g} times the mesh's error"
    UNKNOWN = "the mesh's error is not known: give fem.accuracy instead of fem.size"
    FEW = f"fewer than {_FEWEST} points are left for a law"
    NO_LAW = "the points tell no power law: its exponent may be 0 (95 %)"
    NO_VALUE = "no value to compare"


class Kind(StrEnum):
    """How the size for a level is known."""

    MEASURED = "measured"
    INTERPOLATED = "interpolated"
    EXTRAPOLATED = "extrapolated"
    BOUND = "bound"


@dataclass(frozen=True)
class Law:
    """Fitted law difference = C size^-k, by least squares in logarithms.

    Parameters
    ----------
    C, k : float
    sizes : tuple of float
        Fitted sizes.
    scatter : float
        Standard deviation of the logarithm of the difference about the law, times Student's factor for a confidence of
        95 %.
    """

    C: float
    k: float
    sizes: tuple[float, ...]
    scatter: float

    @property
    def bounds(self) -> tuple[float, float]:
        """95 % confidence interval of k."""
        beside = self.scatter / math.sqrt(self._spread)
        return self.k - beside, self.k + beside

    @property
    def falls(self) -> bool:
        """Whether the difference falls with the size, with a confidence of 95 %."""
        return self.bounds[0] > 0

    @property
    def _spread(self) -> float:
        """Sum of squared distances of the logarithms of the sizes from their mean."""
        logs = np.log(self.sizes)
        return float(np.sum((logs - logs.mean()) ** 2))

    def size_for(self, level: float) -> tuple[float, float, float]:
        """Return the size at which the law gives ``level``, and the ends of the 95 % confidence interval of that size
        (Fieller, 1954)."""
        middle = float(np.log(self.sizes).mean())
        rise = math.log(level) - math.log(self.C) + self.k * middle
        slope = self.scatter**2 / self._spread
        steep = self.k**2 - slope
        beside = math.sqrt(slope * rise**2 + self.scatter**2 / len(self.sizes) * steep)
        low, high = (math.exp(middle + (-self.k * rise + way * beside) / steep) for way in (-1, 1))
        return float((self.C / level) ** (1 / self.k)), low, high


@dataclass(frozen=True)
class Needed:
    """Size from which on the difference is below ``level``.

    Parameters
    ----------
    level : float
    kind : Kind
        ``measured``: at a solved size the difference equals the level within the mesh's error. ``interpolated`` between
        two solved sizes. ``extrapolated`` by the law. ``bound``: only ``low`` and ``high`` are known.
    size : float
        NaN for a bound.
    low, high : float
        Solved sizes beside the size: at ``low`` the difference is above the level (0 if no such size was solved), from
        ``high`` on below (infinite if no such size was solved). If extrapolated, the 95 % confidence interval.
    """

    level: float
    kind: Kind
    size: float
    low: float
    high: float

    def __str__(self) -> str:
        if self.kind is Kind.EXTRAPOLATED:
            return f"{_digits(self.size)} ({_digits(self.low)} to {_digits(self.high)}), {self.kind}"
        if self.kind is Kind.INTERPOLATED:
            return f"{_digits(self.size)}, {self.kind}"
        if self.kind is Kind.MEASURED:
            return f"{self.size:.4g}, {self.kind}"
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
        One per level in LEVELS.
    """

    quantity: str
    points: tuple[PointStatus, ...]
    law: Law | None
    needed: tuple[Needed, ...]


def trend(sizes: Sizes, quantity: str) -> Trend:
    """Fit the law of ``quantity`` and find the sizes for all levels.

    A point is clear if the difference is more than ten times the mesh's error. Of six or more clear points the larger
    half is fitted, of fewer the last three. There is a law where the difference falls with a confidence of 95 %.
    """
    size, off, mesh = sizes.size, sizes.off[quantity], sizes.mesh[quantity]
    known = np.isfinite(off) & (size > 0)
    clear = known & (off > 0) & (off > CLEAR * mesh)
    at = np.flatnonzero(clear)
    used = at[len(at) // 2 :] if len(at) >= 2 * _FEWEST else at[-_FEWEST:]
    fitted = np.isin(np.arange(len(size)), used) & (len(used) >= _FEWEST)
    law = _fit(size[fitted], off[fitted]) if fitted.any() else None
    clear_but = PointStatus.SMALLER if law else PointStatus.NO_LAW if fitted.any() else PointStatus.FEW
    which = [fitted & bool(law), clear, known & np.isnan(mesh), known]
    points = np.select(
        which, [PointStatus.FITTED, clear_but, PointStatus.UNKNOWN, PointStatus.UNCLEAR], PointStatus.NO_VALUE
    )
    order = np.flatnonzero(known)
    needed = tuple(_needed(level, size[order], off[order], mesh[order], clear[order], law) for level in LEVELS)
    return Trend(quantity, tuple(map(PointStatus, points)), law, needed)


def _fit(size: Array, off: Array) -> Law | None:
    """Law through the points; None if the difference may not fall."""
    x, y = np.log(size), np.log(off)
    slope, start = np.polyfit(x, y, 1)
    free = len(x) - 2
    scatter = math.sqrt(np.sum((y - slope * x - start) ** 2) / free)
    factor = float(student.ppf((1 + _SHARE) / 2, free))
    law = Law(math.exp(start), -float(slope), tuple(size.tolist()), factor * scatter)
    return law if law.falls else None


def _needed(
    level: float, size: Array, off: Array, mesh: Array, clear: npt.NDArray[np.bool_], law: Law | None
) -> Needed:
    """Return the size from which on the difference ``off``, with errors ``mesh``, is below ``level``."""
    above = off - mesh > level
    last = int(np.flatnonzero(~(off + mesh <= level)).max(initial=-1))
    low = float(size[above].max(initial=0.0))
    high = float(size[last + 1]) if last + 1 < len(size) else math.inf
    if last >= 0 and clear[last] and not above[last]:
        return Needed(level, Kind.MEASURED, float(size[last]), low, high)
    if last >= 0 and high < math.inf and clear[last] and clear[last + 1]:
        ends = slice(last, last + 2)
        between = np.interp(-math.log(level), -np.log(off[ends]), np.log(size[ends]))
        return Needed(level, Kind.INTERPOLATED, math.exp(between), low, high)
    if last >= 0 and law:
        at, *interval = (min(max(each, low), high) for each in law.size_for(level))
        if at <= _BEYOND * size[-1] and interval[1] <= _BEYOND * at:
            return Needed(level, Kind.EXTRAPOLATED, at, *interval)
    return Needed(level, Kind.BOUND, math.nan, low, high)
