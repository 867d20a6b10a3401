"""A pressure of one's own; scaled as in :mod:`partialslip.halfplane.shape`."""

from collections.abc import Callable, Sequence

import numpy as np

from partialslip.arrays import Array
from partialslip.errors import InputError
from partialslip.halfplane.shape import Shape

_CHECKED = 1000
_EVEN = 1e-9  # differences of p(x) and p(-x), in the largest p, that count as none


class Given(Shape):
    """An even pressure, given as a function on [-1, 1].

    Parameters
    ----------
    function : callable
        (n,) points to (n,) pressures, in any unit: ``scale`` is how much of it p0 is.
    kinks : sequence of float
        Where it is not smooth; -x goes with x.

    Raises
    ------
    InputError
        If it is not even, finite and positive inside.
    """

    def __init__(self, function: Callable[[Array], Array], kinks: Sequence[float] = ()) -> None:
        self._function, self.scale = function, 1.0
        self.kinks = tuple(sorted({sign * float(kink) for kink in kinks if abs(kink) < 1 for sign in (-1, 1)}))
        x = np.cos((np.arange(_CHECKED) + 0.5) * np.pi / (2 * _CHECKED))
        p, mirrored = self.pressure(x), self.pressure(-x)
        for fine, allowed in (
            (lambda: np.isfinite(p) & np.isfinite(mirrored), "finite"),
            (lambda: p > 0, "> 0 inside the contact"),
            (lambda: np.abs(p - mirrored) <= _EVEN * np.abs(p).max(), "even: the same at -x"),
        ):
            if not (right := fine()).all():
                raise InputError(f"pressure at x = {x[~right][0]:g} a: must be {allowed}, not {p[~right][0]:g}")
        # P over a contact of half-width 1 is pi/2 p0: the limit of a stick zone that shrinks to nothing
        t, _, weights = self.rule(1.0, 1e-30, 1)
        self.scale = 4 / np.pi * float((weights * self.pressure(t) * t).sum())

    def pressure(self, x: Array) -> Array:
        values = np.asarray(self._function(np.clip(x, -1.0, 1.0).ravel()), float)
        if values.shape != (np.size(x),):
            raise InputError(f"pressure: must return one value for each point, {np.size(x)}, not {values.shape}")
        result: Array = np.where(np.abs(x) < 1, values.reshape(np.shape(x)) / self.scale, 0.0)
        return result
