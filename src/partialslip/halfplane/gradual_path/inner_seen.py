"""What points have seen of two stick intervals, between which q is on the lower friction bound: the change of q by the
rates so far. Scaled as in :mod:`partialslip.halfplane.shape`."""

from typing import NamedTuple

import numpy as np

from partialslip.arrays import Array, Indices, Mask
from partialslip.halfplane.gradual_path.inner_rates import PAST, RESTS, SHARES, WEIGHTS, A, B, L, Panel, R, Z

_APART = 0.15  # accuracy: of the way of an end in a panel: integrals over it are smooth at points so far from its end


class Past(NamedTuple):
    """Panels: where they ``begin`` and end (5, panels), how far ends have ``moved`` in them, and the ``ways``
    (5, panels, nodes) with ``weights`` (panels, nodes) of integrals that are smooth."""

    begins: Array
    ends: Array
    moved: Array
    ways: Array
    weights: Array


class Seen:
    """Change of q during ``panels`` of the ways of the ends, under changes of the tension up to ``tension``; ``least``
    is c*."""

    def __init__(self, tension: float, least: float) -> None:
        self._tension, self._least = tension, least
        self.panels: list[Panel] = []

    def rates(self, apart: Array) -> Array:
        """Rates of q at points of the right interval of which the ends and z0 are ``apart`` (5, ...); minus those at
        points of the left one."""
        other = (apart[L] + apart[A] + apart[B] + apart[R]) / 2 - self._least - apart[Z]
        root_ = np.sqrt(np.abs(apart[L] * apart[A] * apart[B] * apart[R]))
        return self._tension / 4 * apart[Z] * other / np.where(root_ == 0, np.inf, root_)

    def seen(
        self, begin: Array, end: int, offsets: Array, until: float = np.inf, only: Mask | None = None
    ) -> tuple[Array, Array]:
        """Change of q by the rates of the panels so far, or ``only`` of some, or ``until`` a lambda, at points (n,), by
        their ``offsets`` from an ``end`` of ``begin``, and its derivative by x. Points that b has taken have seen what
        came after."""
        total, slope = np.zeros_like(offsets), np.zeros_like(offsets)
        x = begin[end] + offsets
        entered = np.full(len(x), np.inf)  # number of the panel in which b took the point last
        right = end in (B, R)
        if right:
            for number, panel in enumerate(self.panels):
                if panel.takes and panel.progress < until:
                    entered[x < panel.begin[B]] = number
        for number, panel in enumerate(self.panels):
            if only is not None and not only[number]:
                continue
            part_of = min((until - panel.progress) / panel.length, 1.0)
            if part_of <= 0:
                break
            whole = np.flatnonzero(~np.isfinite(entered) | (entered < number))
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

    def _ahead(self, begin: Array, end: int, offsets: Array, past: Past) -> tuple[Array, Array]:
        """What :meth:`seen` returns, at points that an ``end`` has not reached: integrals over panels whose ends stay
        apart from the points are smooth, unless b was among the points."""
        least, most = float(offsets.min()), float(offsets.max())
        among = end == R and any(panel.takes and panel.begin[B] > begin[end] + least for panel in self.panels)
        if not self.panels or end == B or among:
            return self.seen(begin, end, offsets)
        sides = [L, A] if end in (L, A) else [B, R]
        reached = past.ends[sides] - begin[end]
        apart = np.maximum(reached - most, least - reached)
        smooth = (apart > _APART * past.moved[sides]).all(axis=0)
        total, slope = self.seen(begin, end, offsets, only=~smooth)
        if smooth.any():
            ways = ((past.begins[:, smooth] - begin[end])[:, :, None] + past.ways[:, smooth]).reshape(5, 1, -1)
            weights = past.weights[smooth].ravel()
            self._add(total, slope, np.arange(len(offsets)), ways - offsets[:, None], weights, end == R)
        return total, slope

    def _past(self) -> Past:
        """The panels so far."""
        panels = self.panels
        return Past(
            np.array([panel.begin for panel in panels]).reshape(-1, 5).T,
            np.array([panel.end for panel in panels]).reshape(-1, 5).T,
            np.array([np.abs(panel.offsets).max(axis=1) for panel in panels]).reshape(-1, 5).T,
            np.array([panel.offsets @ panel.by.past.T for panel in panels]).reshape(-1, 5, PAST).swapaxes(0, 1),
            np.array([panel.length * panel.by.past_weights for panel in panels]).reshape(-1, PAST),
        )

    def _add(self, total: Array, slope: Array, which: Indices, apart: Array, weights: Array, right: bool) -> None:
        with np.errstate(divide="ignore", invalid="ignore"):
            other = (apart[L] + apart[A] + apart[B] + apart[R]) / 2 - self._least - apart[Z]
            inverse = 1 / apart
            roots = np.sqrt(np.abs(inverse[L] * inverse[A] * inverse[B] * inverse[R]))
            rates = (self._tension / 4 * (1 if right else -1)) * weights * apart[Z] * other * roots
            by_x = (inverse[L] + inverse[A] + inverse[B] + inverse[R]) / 2 - inverse[Z] - 1 / other
            at_end = ~np.isfinite(roots)
            rates[at_end] = 0.0
            total[which] += rates.sum(axis=-1)
            slope[which] += np.where(rates == 0, 0.0, rates * by_x).sum(axis=-1)
