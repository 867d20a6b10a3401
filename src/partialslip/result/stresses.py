"""Stresses at any points of the bodies, at any phases of the steady cycle."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from partialslip.arrays import Array
from partialslip.errors import InputError
from partialslip.result.points import AtPoints

_LOAD_POINTS = (0.0, 0.5)  # phases of load points 1 and 2


@dataclass(frozen=True)
class StressAt:
    """Stresses sigma_xx, sigma_yy and sigma_xy at points (x, y), m, of any shape: the lower body is y <= 0.

    Parameters
    ----------
    function : callable
        ``function(x, y, phases) -> (s, 3, k)``: stresses, Pa, at finite points (k,), m, and ``phases`` (s,).
    """

    function: Callable[[Array, Array, Array], Array]

    def __call__(self, x: npt.ArrayLike, y: npt.ArrayLike, phases: npt.ArrayLike | None = None) -> Array:
        """Return the stresses (2, 3, ...), Pa, by load point, component xx, yy, xy, and the common shape of ``x`` and
        ``y``; with ``phases`` (s,) the first axis is that of the phases. Points outside the bodies are NaN.

        Phases are numbers from 0 to 1 around a steady cycle: 0 is load point 1, 0.5 load point 2, 1 load point 1 again.
        Other load points divide these ways into equal parts. Between load points the loads vary linearly.

        Raises
        ------
        InputError
            If a coordinate or a phase is not a number, the shapes of x and y do not fit each other, a phase is not from
            0 to 1, or the method does not know the stresses at a phase.
        """
        stages = np.array(_LOAD_POINTS) if phases is None else _checked(phases)
        found: Array = AtPoints(lambda x, y: self._inside(x, y, stages.ravel()))(x, y)
        return found.reshape(*stages.shape, *found.shape[1:])

    def _inside(self, x: Array, y: Array, phases: Array) -> Array:
        known = np.isfinite(x) & np.isfinite(y)
        if known.all():
            return self.function(x, y, phases)
        result = np.full((len(phases), 3, len(x)), np.nan)
        result[..., known] = self.function(x[known], y[known], phases)
        return result


def _checked(phases: npt.ArrayLike) -> Array:
    try:
        stages = np.asarray(phases, float)
    except (TypeError, ValueError):
        raise InputError(f"phases = {phases!r}: must be numbers from 0 to 1") from None
    outside = stages[~((stages >= 0) & (stages <= 1))]
    if outside.size:
        raise InputError(f"phases: {outside.flat[0]:g} is not allowed; must be from 0 to 1")
    return stages
