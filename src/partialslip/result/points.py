"""Functions of points of any shape: numbers, lists and arrays."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from partialslip.arrays import Array
from partialslip.errors import InputError


@dataclass(frozen=True)
class AtPoints:
    """Function of points of any shape, NumPy's way: an array has the shape of the points, a number gives a number.

    Parameters
    ----------
    function : callable
        Function of coordinates (k,), one array for each axis, that returns an array (..., k) or a tuple of arrays (k,).
    """

    function: Callable[..., Any]

    def __call__(self, *coordinates: npt.ArrayLike) -> Any:
        """Return the values at ``coordinates``, which are broadcast to one shape.

        Raises
        ------
        InputError
            If a coordinate is not a number, or the shapes do not fit each other.
        """
        try:
            points = np.broadcast_arrays(*(np.asarray(each, float) for each in coordinates))
        except (TypeError, ValueError) as error:
            raise InputError(f"points: must be numbers or arrays of numbers of shapes that fit: {error}") from None
        found = self.function(*(each.ravel() for each in points))
        shape = points[0].shape
        return tuple(_shaped(each, shape) for each in found) if isinstance(found, tuple) else _shaped(found, shape)


def _shaped(values: Array, shape: tuple[int, ...]) -> Any:
    return values.reshape((*values.shape[:-1], *shape))[()]


def at_points(function: Callable[..., Any] | None) -> AtPoints | None:
    """Return ``function`` as a function of points of any shape; None for None."""
    return function if function is None or isinstance(function, AtPoints) else AtPoints(function)
