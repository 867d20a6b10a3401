"""A distribution of shear traction: on the friction bound in slip zones, interpolated elsewhere. Scaled as in
:mod:`partialslip.halfplane.shape`, tractions by f p0."""

import itertools
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from partialslip.halfplane.gradual_path.graded import Smooth, spans
from partialslip.halfplane.shape import Shape
from partialslip.tools.arrays import Array

_LAST, _DECAYED = 4, 1e-10  # accuracy: coefficients in a window that have decayed where q is smooth
_ANGLES = np.pi * (np.arange(24) + 0.5) / 24
_WINDOW = -np.cos(_ANGLES)  # Chebyshev nodes
_COEFFICIENTS = np.linalg.inv(np.polynomial.chebyshev.chebvander(_WINDOW, 23))
_ALIKE = 1e-2  # accuracy: of a run of parts, within which cuts of two states correspond


class Piece(NamedTuple):
    """From ``low`` to ``high`` the traction is ``factor`` p plus a ``smooth`` rest: without a rest, the point is on the
    friction bound."""

    low: float
    high: float
    factor: float
    smooth: Smooth | None = None

    def rest(self, from_low: Array, from_high: Array) -> Array:
        """q - ``factor`` p at distances from both ends, which keep their digits."""
        if not self.smooth:
            return np.zeros_like(from_low)
        return self.smooth.near(self.low - self.smooth.low + from_low, self.smooth.high - self.high + from_high)

    def plus(self, change: Callable[[Array, Array], Array]) -> "Piece":
        """The part with a ``change`` added; ``change(from_low, from_high)`` takes distances from both ends."""

        def values(from_low: Array, from_high: Array) -> Array:
            return self.rest(from_low, from_high) + change(from_low, from_high)

        return self._replace(smooth=Smooth(self.low, self.high, values))


@dataclass(frozen=True)
class Tractions:
    """Shear traction over [-1, 1] in ``parts``, from left to right."""

    shape: Shape
    parts: tuple[Piece, ...]

    @classmethod
    def of(cls, shape: Shape, parts: Iterable[Piece]) -> "Tractions":
        """Tractions of ``parts``, of which empty ones are dropped."""
        return cls(shape, tuple(part for part in parts if part.high > part.low))

    @property
    def breaks(self) -> list[float]:
        """Places at which parts meet."""
        return [part.low for part in self.parts[1:]]

    @property
    def cuts(self) -> list[float]:
        """Places between which q is smooth and well resolved."""
        inner = (part.smooth.cuts for part in self.parts if part.smooth)
        return sorted({*self.breaks, *(float(cut) for cuts in inner for cut in cuts)})

    def less(self, factor: float, x: Array, origin: float = 0.0) -> Array:
        """``factor`` p - q at ``origin`` + ``x``, without cancellation where q is on the bound. Distances from an
        origin at which parts meet keep their digits."""
        result = np.zeros_like(x)
        p = self.shape.pressure(origin + x)
        which = np.searchsorted(np.array(self.breaks) - origin, x)
        for number, part in enumerate(self.parts):
            here = which == number
            if here.any():
                rest = part.rest((origin - part.low) + x[here], (part.high - origin) - x[here])
                result[here] = (factor - part.factor) * p[here] - rest
        return result

    def __call__(self, x: Array) -> Array:
        """q at ``x``."""
        return -self.less(0.0, x)

    @property
    def force(self) -> float:
        """Integral of q."""
        ends = np.array([-1.0, *sorted({*self.cuts, *self.shape.strong_kinks}), 1.0])
        from_low, _, weights = spans(ends[:-1], ends[1:])
        return float(weights.ravel() @ self((ends[:-1, None] + from_low).ravel()))

    def within(self, low: float, high: float, from_low: Array, from_high: Array) -> Array:
        """q at distances from two places, which keep their digits."""
        x = low + from_low
        result = np.zeros_like(x)
        parts = self.between(low, high)
        which = np.searchsorted([part.low for part in parts[1:]], x)
        for number, part in enumerate(parts):
            here = which == number
            rest = part.rest(low - part.low + from_low[here], part.high - high + from_high[here])
            result[here] = part.factor * self.shape.pressure(x[here]) + rest
        return result

    def __neg__(self) -> "Tractions":
        negated = (Piece(low, high, -factor, None if rest is None else -rest) for low, high, factor, rest in self.parts)
        return Tractions(self.shape, tuple(negated))

    def between(self, low: float, high: float) -> list[Piece]:
        """Parts between two places."""
        cut = (part._replace(low=max(part.low, low), high=min(part.high, high)) for part in self.parts)
        return [part for part in cut if part.high > part.low]

    def joined(self) -> "Tractions":
        """The same tractions, in which parts are one where q is smooth from one to the next."""
        parts: list[Piece] = []
        for run in _runs(self.parts):
            group = run[:1]
            for part in run[1:]:
                if part.smooth is None or not _smooth_between(group[-1], part):
                    parts.append(_one(group))
                    group = []
                group.append(part)
            parts.append(_one(group))
        return Tractions(self.shape, tuple(parts))

    def toward(self, other: "Tractions", share: float) -> "Tractions | None":
        """State between two (beyond them if ``share`` is not between 0 and 1) that resemble each other: the places at
        which parts meet are mixed, and the tractions between them. None if the parts do not correspond."""
        runs = [_runs(each.parts) for each in (self, other)]
        kinds = [[(run[0].factor, run[0].smooth is None) for run in each] for each in runs]
        if kinds[0] != kinds[1]:
            return None
        mixed = [_mixed(one, two, share) for pairs in zip(*runs, strict=True) for one, two in _matched(*pairs)]
        whole = all(part.low < part.high for part in mixed)
        return Tractions(self.shape, tuple(mixed)) if whole else None


def _smooth_between(left: Piece, right: Piece) -> bool:
    """Whether q is smooth where two parts meet: in a window there, its Chebyshev coefficients decay."""
    reach = min(left.high - left.low, right.high - right.low) / 2
    before, after = reach * -_WINDOW[_WINDOW < 0], reach * _WINDOW[_WINDOW > 0]
    values = left.rest(left.high - left.low - before, before), right.rest(after, right.high - right.low - after)
    found = _COEFFICIENTS @ np.concatenate(values)
    return bool(np.abs(found[-_LAST:]).max() < _DECAYED)


def _one(parts: list[Piece]) -> Piece:
    """One part in place of neighbours with the same factor."""
    if len(parts) == 1:
        return parts[0]
    low, high = parts[0].low, parts[-1].high
    inner = np.array([part.low for part in parts[1:]])

    def rest(from_low: Array, from_high: Array) -> Array:
        result = np.empty_like(from_low)
        which = np.searchsorted(inner - low, from_low)
        for number, part in enumerate(parts):
            here = which == number
            result[here] = part.rest(low - part.low + from_low[here], part.high - high + from_high[here])
        return result

    return Piece(low, high, parts[0].factor, Smooth(low, high, rest))


def _runs(parts: Iterable[Piece]) -> list[list[Piece]]:
    """Neighbouring parts with the same factor."""
    groups = itertools.groupby(parts, key=lambda part: (part.factor, part.smooth is None))
    return [list(group) for _, group in groups]


def _matched(one: list[Piece], other: list[Piece]) -> list[tuple[Piece, Piece]]:
    """Parts that correspond, one by one; places at which only one of the runs is cut cut the other, too."""
    runs = one, other
    width = [run[-1].high - run[0].low for run in runs]
    cuts = [[(part.low - run[0].low) / wide for part in run[1:]] for run, wide in zip(runs, width, strict=True)]
    pairs = [(0.0, 0.0)]
    while any(cuts):
        first, second = (each[0] if each else np.inf for each in cuts)
        least = min(first, second)
        pairs.append((first if first - least < _ALIKE else least, second if second - least < _ALIKE else least))
        cuts = [each[1:] if place - least < _ALIKE else each for each, place in zip(cuts, (first, second), strict=True)]
    pairs.append((1.0, 1.0))
    found = []
    for (first, second), (third, fourth) in itertools.pairwise(pairs):
        pieces = []
        for run, wide, low, high in zip(runs, width, (first, second), (third, fourth), strict=True):
            part = next(each for each in run if run[0].low + (low + high) / 2 * wide < each.high or each is run[-1])
            within = run[0].low + low * wide, run[0].low + high * wide
            pieces.append(part._replace(low=max(within[0], part.low), high=min(within[1], part.high)))
        found.append((pieces[0], pieces[1]))
    return found


def _mixed(one: Piece, other: Piece, share: float) -> Piece:
    low, high = one.low + share * (other.low - one.low), one.high + share * (other.high - one.high)
    if one.smooth is None or not high > low:
        return Piece(low, high, one.factor)

    def rest(from_low: Array, from_high: Array) -> Array:
        first, second = (
            part.rest(
                from_low * ((part.high - part.low) / (high - low)), from_high * ((part.high - part.low) / (high - low))
            )
            for part in (one, other)
        )
        return first + share * (second - first)

    return Piece(low, high, one.factor, Smooth(low, high, rest))
