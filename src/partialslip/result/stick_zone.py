"""The stick zone, of one pair of loads or of many."""

from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np

from partialslip.tools.arrays import Array, Mask
from partialslip.tools.shown import span

Number = TypeVar("Number", float, Array)


class StickZone(NamedTuple, Generic[Number]):
    """Stick zone [-m, n], or arrays of stick zones of one shape. All lengths are in m, or all are fractions of a.

    ``centre`` is (n - m)/2. ``half_width`` is (n + m)/2, which keeps its digits in a narrow zone. ``s`` is +1 where
    both ends slip the same way (small tension) and -1 where they slip opposite ways (large tension). Where the contact
    slides as a whole, ``centre`` and ``half_width`` are NaN and ``s`` is 0; see :attr:`slides`. Where the tension
    varies so much along x that there is no such zone, they are NaN, too, and ``s`` is not 0.
    """

    centre: Number
    half_width: Number
    s: Number

    def __repr__(self: "StickZone[Any]") -> str:
        """m, n and s; the ranges of arrays."""
        shape = np.shape(self.half_width)
        m, n, s = (span(np.asarray(values)) for values in (self.m, self.n, self.s))
        count = f", shape {shape}, {np.count_nonzero(self.slides)} sliding" if shape else ""
        return f"StickZone(m = {m}, n = {n}, s = {s}{count})"

    @property
    def slides(self) -> Mask:
        """Whether the contact slides as a whole and there is no stick zone; an array of the zones' shape."""
        return np.asarray(self.s) == 0

    @property
    def left(self) -> Number:
        """Left end, x = -m."""
        return self.centre - self.half_width

    @property
    def right(self) -> Number:
        """Right end, x = n."""
        return self.half_width + self.centre

    @property
    def m(self) -> Number:
        """Distance of the left end from x = 0; negative if the left end is at x > 0."""
        return self.half_width - self.centre

    @property
    def n(self) -> Number:
        """Distance of the right end from x = 0; negative if the right end is at x < 0."""
        return self.right
