"""What points have seen of two stick intervals, between which q is on the lower friction bound: the change of q by the
rates so far. Scaled as in :mod:`partialslip.halfplane.shape`."""

from typing import NamedTuple

import numpy as np

from partialslip.halfplane.gradual_path.inner_rates import LAST, RESTS, SHARES, WEIGHTS, A, B, L, Panel, R, Z
from partialslip.tools.arrays import Array, Indices, Mask

_APART = 1.0  # accuracy: of the way of an end in a panel: integrals over it are smooth at points so far from its end


class Past(NamedTuple):
    """Panels: lambda at their ``starts`` and ``stops`` (panels,), where the ends ``begin`` and how far they have
    ``moved`` (5, panels), whether b ``takes`` points (panels,), and the ``ways`` (5, panels, nodes) with ``weights``
    (panels, nodes) of integrals that are smooth."""

    starts: Array
    stops: Array
    begin: Array
    moved: Array
    takes: Mask
    ways: Array
    weights: Array


class Seen:
    """Change of q during ``panels`` of the ways of the ends, under changes of the tension up to ``tension``; ``least``
    is c*."""

    def __init__(self, tension: float, least: float) -> None:
        self._tension, self._least = tension, least
        self.panels: list[Panel] = []
        self._kept: Past | None = None

    def rates(self, apart: Array) -> Array:
        """Rates of q at points of the right interval of which the ends and z0 are ``apart`` (5, ...); minus those at
        points of the left one."""
        other = (apart[L] + apart[A] + apart[B] + apart[R]) / 2 - self._least - apart[Z]
        root_ = np.sqrt(np.abs(apart[L] * apart[A] * apart[B] * apart[R]))
        return self._tension / 4 * apart[Z] * other / np.where(root_ == 0, np.inf, root_)

    def seen(self, begin: Array, end: int, offsets: Array, until: float = np.inf) -> tuple[Array, Array]:
        """Change of q by the rates of the panels so far, or ``until`` a lambda, at points (n,), by their ``offsets``
        from an ``end`` of ``begin``, and its derivative by x. Points that b has taken have seen what came after."""
        total, slope = np.zeros_like(offsets), np.zeros_like(offsets)
        if not (self.panels and len(offsets)):
            return total, slope
        past, x, right = self._past, begin[end] + offsets, end in (B, R)
        begun = past.starts < until
        entered = np.full(len(x), -1)  # number of the panel in which b took the point last
        if right and past.takes.any():
            taken = (x[:, None] < past.begin[B]) & past.takes & begun
            entered = np.where(taken, np.arange(taken.shape[1]), -1).max(axis=1)
        smooth = (past.stops <= until) & (np.arange(len(begun)) > entered.max())
        smooth &= self._integrals_smooth(begin, end, offsets)
        if smooth.any():
            ways = ((past.begin[:, smooth] - begin[end])[:, :, None] + past.ways[:, smooth]).reshape(5, 1, -1)
            weights = past.weights[smooth].ravel()
            self._add(total, slope, slice(None), ways - offsets[:, None], weights, right)
        for number in np.flatnonzero(begun & ~smooth):
            panel = self.panels[number]
            part_of = min((until - panel.progress) / panel.length, 1.0)
            whole = np.flatnonzero(entered < number)
            if len(whole):
                if part_of < 1:
                    way = panel.at(panel.by.place(part_of * SHARES, (1 - part_of) + part_of * RESTS))
                else:
                    way = panel.offsets @ panel.by.whole.T
                apart = ((panel.begin - begin[end])[:, None] + way)[:, None] - offsets[whole, None]
                self._add(total, slope, whole, apart, panel.length * part_of * WEIGHTS, right)
            part = np.flatnonzero(entered == number)
            if len(part):
                first = np.minimum(panel.by.share(panel.place(x[part]))[:, None], part_of)
                shares = first + (part_of - first) * SHARES
                rests = (1 - part_of) + (part_of - first) * RESTS
                s = panel.by.place(shares, rests)
                apart = (panel.begin - begin[end])[:, None, None] + panel.at(s) - offsets[part, None]
                self._add(total, slope, part, apart, panel.length * (part_of - first) * WEIGHTS, right)
        return total, slope

    def _integrals_smooth(self, begin: Array, end: int, offsets: Array) -> Mask:
        """Whether the ends of the interval stay so far from all points in each panel that integrals over it are
        smooth."""
        past, sides = self._past, [L, A] if end in (L, A) else [B, R]
        first = past.begin[sides] - begin[end]
        last = first + past.moved[sides]
        apart = np.maximum(np.minimum(first, last) - offsets.max(), offsets.min() - np.maximum(first, last))
        result: Mask = (apart > _APART * np.abs(past.moved[sides])).all(axis=0)
        return result

    @property
    def _past(self) -> Past:
        """The panels so far."""
        panels = self.panels
        if not self._kept or len(self._kept.stops) != len(panels):
            self._kept = Past(
                np.array([panel.progress for panel in panels]),
                np.array([panel.progress + panel.length for panel in panels]),
                np.array([panel.begin for panel in panels]).T,
                np.array([panel.offsets @ LAST for panel in panels]).T,
                np.array([panel.takes for panel in panels]),
                np.array([panel.offsets @ panel.by.past.T for panel in panels]).swapaxes(0, 1),
                np.array([panel.length * panel.by.past_weights for panel in panels]),
            )
        return self._kept

    def _add(
        self, total: Array, slope: Array, which: Indices | slice, apart: Array, weights: Array, right: bool
    ) -> None:
        left_, low, high, right_, zero = apart
        outer, inner = left_ * right_, low * high
        other = (left_ + low + high + right_) / 2 - self._least - zero
        product = outer * inner
        inverse = 1 / np.where(product == 0, np.inf, product)
        each = weights * (self._tension / 4 * (1 if right else -1)) * np.sqrt(np.abs(inverse))
        rates = zero * other
        by_x = rates * ((left_ + right_) * inner + (low + high) * outer) * (inverse / 2) - (zero + other)
        total[which] += (each * rates).sum(axis=-1)
        slope[which] += (each * by_x).sum(axis=-1)
