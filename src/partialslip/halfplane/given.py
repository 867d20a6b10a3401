"""A pressure given as a function; scaled as in :mod:`partialslip.halfplane.shape`."""

from collections.abc import Callable, Sequence

import numpy as np

from partialslip.arrays import Array
from partialslip.errors import InputError
from partialslip.halfplane.shape import Shape

_CHECKED = 1000  # points at which the pressure is checked
_EVEN = 1e-9  # tolerance of p(x) - p(-x), relative to the largest p, of an even pressure


class Given(Shape):
    """Pressure, given as a function on [-1, 1].

    Parameters
    ----------
    function : callable
        Points (n,) to pressures (n,), in any unit; ``scale`` is p0 in this unit.
    kinks : sequence of float
        Points at which the pressure is not smooth; -x is added for each x.

    Raises
    ------
    InputError
        If the pressure is not finite and positive inside.
    """

    def __init__(self, function: Callable[[Array], Array], kinks: Sequence[float] = ()) -> None:
        self._function, self.scale = function, 1.0
        self.kinks = tuple(sorted({sign * float(kink) for kink in kinks if abs(kink) < 1 for sign in (-1, 1)}))
        x = np.cos((np.arange(_CHECKED) + 0.5) * np.pi / (2 * _CHECKED))
        p, mirrored = self.pressure(x), self.pressure(-x)
        at, both = np.append(x, -x), np.append(p, mirrored)
        for right, allowed in ((np.isfinite(both), "finite"), (~(both <= 0), "> 0 inside the contact")):
            if not right.all():
                raise InputError(f"pressure at x = {at[~right][0]:g} a: must be {allowed}, not {both[~right][0]:g}")
        self.even = bool((np.abs(p - mirrored) <= _EVEN * np.abs(p).max()).all())
        # P = pi/2 p0 at half-width 1, by the rule for a slip zone beside a stick zone that shrinks to nothing
        rules = (self.rule(1.0, 1e-30, side) for side in (1, -1))
        self.scale = 2 / np.pi * sum(float((weights * self.pressure(t) * np.abs(t)).sum()) for t, _, weights in rules)

    def pressure(self, x: Array) -> Array:
        values = np.asarray(self._function(np.clip(x, -1.0, 1.0).ravel()), float)
        if values.shape != (np.size(x),):
            raise InputError(f"pressure: must return one value for each point, {np.size(x)}, not {values.shape}")
        result: Array = np.where(np.abs(x) < 1, values.reshape(np.shape(x)) / self.scale, 0.0)
        return result
