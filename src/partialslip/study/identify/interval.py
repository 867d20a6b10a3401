"""A value with its interval of 95 %."""

import msgspec
import numpy as np


class Interval(msgspec.Struct, frozen=True):
    """A ``value`` and the ends of its interval of 95 %, ``low`` and ``high``: infinite where the data give no end, NaN
    where no error is known."""

    value: float
    low: float
    high: float

    @property
    def one_sided(self) -> bool:
        """Whether the data give no upper end."""
        return bool(np.isinf(self.high))
