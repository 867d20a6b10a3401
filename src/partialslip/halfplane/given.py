"""A pressure given as a function; scaled as in :mod:`partialslip.halfplane.shape`."""

from collections.abc import Callable, Sequence

import numpy as np

from partialslip.arrays import Array
from partialslip.errors import InputError
from partialslip.halfplane.shape import Shape

_CHECKED = 1000  # points at which the pressure is checked
_EVEN = 1e-9  # tolerance of p(x) - p(-x), relative to the largest p


class Given(Shape):
    """Even pressure, given as a function on [-1, 1].

    Parameters
    ----------
    function : callable
        Points (n,) to pressures (n,), in any unit; ``scale`` is p0 in this unit.
    kinks : sequence of float
        Points at which the pressure is not smooth; -x is added for each x.

    Raises
    ------
    InputError
        If the pressure is not even, finite and positive inside.
    """

    def __init__(self, function: Callable[[Array], Array], kinks: Sequence[float] = ()) -> None:
        self._function, self.scale = function, 1.0
        self.kinks = tuple(sorted({sign * float(kink) for kink in kinks if abs(kink) < 1 for sign in (-1, 1)}))
        x = np.cos((np.arange(_CHECKED) + 0.5) * np.pi / (2 * _CHECKED))
        p, mirrored = self.pressure(x), self.pressure(-x)
        for fine, allowed in (
            (lambda: np.isfinite(p) & np.isfinite(mirrored), "finite"),
            (lambda: p > 0, "> 0 inside the contact"),
            (lambda: np.abs(p - mirrored) <= _EVEN * np.abs(p).max(), "even, equal at x and -x"),
        ):
            if not (right := fine()).all():
                raise InputError(f"pressure at x = {x[~right][0]:g} a: must be {allowed}, not {p[~right][0]:g}")
        # P = pi/2 p0 at half-width 1, by the rule for a slip zone beside a stick zone that shrinks to nothing
        t, _, weights = self.rule(1.0, 1e-30, 1)
        self.scale = 4 / np.pi * float((weights * self.pressure(t) * t).sum())

    def pressure(self, x: Array) -> Array:
        values = np.asarray(self._function(np.clip(x, -1.0, 1.0).ravel()), float)
        if values.shape != (np.size(x),):
            raise InputError(f"pressure: must return one value for each point, {np.size(x)}, not {values.shape}")
        result: Array = np.where(np.abs(x) < 1, values.reshape(np.shape(x)) / self.scale, 0.0)
        return result
