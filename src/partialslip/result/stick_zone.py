"""The stick zone, of one pair of loads or of many."""

from typing import Generic, NamedTuple, TypeVar

from partialslip.arrays import Array

Number = TypeVar("Number", float, Array)


class StickZone(NamedTuple, Generic[Number]):
    """Stick zone [-m, n], or arrays of stick zones of one shape. All lengths are in m, or all are fractions of a.

    ``centre`` is (n - m)/2. ``half_width`` is (n + m)/2, which keeps its digits in a narrow zone. ``s`` is +1 where
    both ends slip the same way (small tension) and -1 where they slip opposite ways (large tension).
    """

    centre: Number
    half_width: Number
    s: Number

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
