"""Certificate of a half cycle: the conditions of stick and slip, checked at stages along the way from the tractions
alone. Scaled as in :mod:`partialslip.halfplane.shape`, tractions by f p0.

Nothing here knows how the stages were found. The quadrature is one of its own: the trapezoidal rule in
log((x - low)/(high - x)) on each panel between points at which q is not smooth. Half-way between its nodes it gives
principal values with the same exponential accuracy, so one matrix product gives the strains at all points.
"""

import itertools
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from partialslip.halfplane.gradual_path.half_cycle import HalfCycle, between
from partialslip.halfplane.gradual_path.retreat import Zone
from partialslip.halfplane.gradual_path.stage import Loads, Stage, lasting
from partialslip.halfplane.gradual_path.tractions import Tractions
from partialslip.tools.arrays import Array, Mask

_STEP, _REACH = 0.4, 39.0  # accuracy: of the trapezoidal rule, in the logarithm
_NEAR = 1e-5  # accuracy: distance from a panel's end from which on points are judged: nearer, x has too few digits
_EMPTY = 1e-13  # accuracy: width below which a panel is left out
_SHARES = (1e-3, 0.05, 0.25, 0.5, 0.75, 1.0)  # accuracy: stages in a phase
_ROWS = 64  # cost: of the matrix of a quadrature, at once
_OVERLAP = 0.7  # accuracy: of a stick zone that sticks up to the next stage, too


class Certificate(NamedTuple):
    """Largest violations in f p0.

    ``bound``: \\|q\\| beyond p, and distance of q from the bound in slip zones. ``equilibrium``: error of int q, over
    the width of the contact. ``stick``: mismatch of the strains in stick zones between neighbouring stages, and slip of
    one stick zone relative to another. ``slip``: slip over a, between neighbouring stages, against the traction.
    ``steady``: sum of q at the beginning and at the end, where points slip.
    """

    bound: float
    equilibrium: float
    stick: float
    slip: float
    steady: float

    @property
    def worst(self) -> float:
        """The largest violation."""
        return max(self)


def certificate_of(half: HalfCycle) -> Certificate:
    """Certificate of a steady half cycle, at six stages of each phase and more where it drifts far."""
    return certify(half.loads, stages(half))


def stages(half: HalfCycle, shares: Sequence[float] = _SHARES) -> list[Stage]:
    """Stages along a half cycle, at ``shares`` of each phase, ascending to 1; most of the stick zone sticks from each
    stage to the next."""
    found = [half.phases[0].first._replace(q=half.start)]
    for phase in half.phases:
        first, last = phase.first.progress, phase.last.progress
        for share in shares:
            stage = phase.last if share == 1 else phase.at(first + share * (last - first))
            found += between(phase, found[-1], stage, _OVERLAP)
    return found


def certify(loads: Loads, found: Sequence[Stage]) -> Certificate:
    """Certificate of ``found``, the stages of a half cycle from its beginning to its end.

    A point that sticks at neighbouring stages sticks between them; others slip one way only.
    """
    bound = stick = slip = equilibrium = pulled = 0.0
    for before, after in itertools.pairwise(found):
        step = after.progress - before.progress
        panels = _Panels(before, after)
        held = panels.within(before.sticks), panels.within(after.sticks)
        bound = max(bound, panels.violation(before.q, held[0]), panels.violation(after.q, held[1]))
        pulled += panels.integral(before.q, after.q)
        equilibrium = max(equilibrium, abs(pulled - (after.progress - found[0].progress) * loads.shear) / 2)
        strain = step * loads.tension / 4 + panels.strain(before.q, after.q)
        moved, both = panels.cumulative(strain), panels.within(lasting(before, after))
        if not both.any():
            return Certificate(bound, equilibrium, np.inf, np.inf, np.inf)
        moved = moved - np.median(moved[both])
        stick = max(stick, float(np.abs(moved[both]).max()), float(np.abs(strain[both & panels.judged]).max()))
        signs = [
            np.where(sticks, 0.0, np.sign(each.q(panels.x))) for each, sticks in zip((before, after), held, strict=True)
        ]
        slip = max(slip, -float(np.min(np.sign(signs[0] + signs[1]) * moved)))
    panels = _Panels(found[0], found[-1], tuple(end for each in found for zone in each.sticks for end in zone))
    slipped = ~np.logical_and.reduce([panels.within(each.sticks) for each in found])
    rest = np.abs(found[0].q(panels.x) + found[-1].q(panels.x))[slipped & panels.judged]
    return Certificate(bound, equilibrium, stick, slip, float(rest.max(initial=0.0)))


class _Panels:
    """Panels between the points at which tractions at two stages are not smooth; nodes and, half-way between them,
    points at which the conditions are judged."""

    def __init__(self, before: Stage, after: Stage, further: Iterable[float] = ()) -> None:
        ends = {-1.0, 1.0, *before.q.breaks, *after.q.breaks, *before.q.shape.strong_kinks, *further}
        ends |= {end for each in (before, after) for zone in each.sticks for end in zone}
        cuts = np.sort([end for end in ends if abs(end) <= 1])
        wide = np.diff(cuts) > _EMPTY
        self._low, self._high = cuts[:-1][wide, None], cuts[1:][wide, None]
        half = np.arange(-_REACH, _REACH, _STEP / 2)
        self._count = len(half) // 2
        near, off, weights = self._quadrature_points(half[0 : 2 * self._count : 2])
        self._nodes, self._near, self._off, self._weights = near + off, near, off, weights
        self._origin, self._offset, self._shares = self._quadrature_points(half[1 : 2 * self._count : 2])
        self.x: Array = self._origin + self._offset
        self.judged: Mask = np.abs(self._offset) > _NEAR

    def _quadrature_points(self, t: Array) -> tuple[Array, Array, Array]:
        """Nearest end of the panel, distance from it, and weight of the points at ``t``."""
        low, high, width = self._low, self._high, self._high - self._low
        share, rest = 1 / (1 + np.exp(-t)), 1 / (1 + np.exp(t))
        near, off = np.where(t < 0, low, high), np.where(t < 0, width * share, -width * rest)
        return near.ravel(), off.ravel(), (_STEP * width * share * rest).ravel()

    def within(self, sticks: Iterable[Zone]) -> Mask:
        """Whether the panel of each point lies in one of the intervals."""
        middle = ((self._low + self._high) / 2).ravel()
        inside = np.any([(zone.left < middle) & (middle < zone.right) for zone in sticks], axis=0)
        return np.repeat(inside, self._count)

    def violation(self, q: Tractions, sticks: Mask) -> float:
        """How far \\|q\\| is beyond p where the points stick, and away from p elsewhere."""
        upper, lower = q.less(1.0, self.x), -q.less(-1.0, self.x)
        room = np.minimum(upper, lower)
        return float(np.where(sticks, -room, np.abs(room))[self.judged].max())

    def integral(self, before: Tractions, after: Tractions) -> float:
        """Integral of the change of q."""
        return float(self._weights @ (after(self._nodes) - before(self._nodes)))

    def strain(self, before: Tractions, after: Tractions) -> Array:
        """Mismatch of the strains at the points by the change of q: minus its principal-value integral over pi."""
        change = self._weights * (after(self._nodes) - before(self._nodes))
        found = []
        for rows in np.array_split(np.arange(len(self.x)), max(len(self.x) // _ROWS, 1)):  # that fit into the cache
            apart = self._near - self._origin[rows, None]
            apart += self._off - self._offset[rows, None]
            found.append(np.reciprocal(apart, out=apart) @ change)
        return -np.concatenate(found) / np.pi

    def cumulative(self, values: Array) -> Array:
        """Integral of ``values`` at the points from -1 to the points."""
        parts = self._shares * values
        return np.cumsum(parts) - parts / 2
