"""Functions of points, slip, stresses, and deformed bodies."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from partialslip.tools.arrays import Array, Indices, Mask
from partialslip.tools.errors import InputError
from partialslip.tools.shown import Short
from partialslip.tools.threads import one_thread

_LOAD_POINTS = (0.0, 0.5)  # fixed: phases of load points 1 and 2


@dataclass(frozen=True)
class AtPoints:
    """Function of points of any shape, NumPy's way: an array has the shape of the points, a number gives a number.

    Parameters
    ----------
    function : callable
        Function of coordinates (k,), one array for each axis, that returns an array (..., k) or a named
        tuple of arrays (k,) and of None.
    """

    function: Callable[..., Any]

    def __call__(self, *coordinates: npt.ArrayLike) -> Any:
        """Return the values at ``coordinates``, which are broadcast to one shape; NaN where a coordinate is NaN.

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
        unknown = np.any([np.isnan(each) for each in points], axis=0)
        if isinstance(found, tuple):
            return type(found)(*(_shaped(each, unknown) for each in found))
        return _shaped(found, unknown)


def _shaped(values: Array | None, unknown: Mask) -> Any:
    """Return ``values`` (..., k) in the shape of the points, NaN at the ``unknown`` ones."""
    if values is None:
        return None
    found = values.reshape((*values.shape[:-1], *unknown.shape))
    return (np.where(unknown, np.nan, found) if unknown.any() else found)[()]


def at_points(function: Callable[..., Any] | None) -> AtPoints | None:
    """Return ``function`` as a function of points of any shape; None for None."""
    return function if function is None or isinstance(function, AtPoints) else AtPoints(function)


@dataclass(frozen=True, repr=False)
class Slip(Short):
    """Slip over half a cycle.

    Parameters
    ----------
    x : (k,) array
        Points, ascending, m.
    slip : (k,) array
        Change, from load point 1 to 2, of the displacement of the lower body, which exerts q, relative to the upper
        body, m.
    dissipated : float
        Work against friction over one cycle, per unit depth, J/m.
    dissipated_error : float or None
        Its estimated error, J/m; None if it is not known.
    """

    x: Array
    slip: Array
    dissipated: float
    dissipated_error: float | None = None


@dataclass(frozen=True, repr=False)
class SurfaceStress(Short):
    """Direct stress sigma_xx along the surfaces of the bodies, bulk tension included.

    Parameters
    ----------
    x : (k,) array
        Points, ascending, within the contact, at its ends and beyond, m.
    sigma : (2, 2, k) array
        sigma_xx by body (lower, upper) and load point, Pa. The lower body carries the bulk tension and exerts q on the
        upper body.
    at : callable
        ``at(x) -> (2, 2, ...)``: sigma_xx, Pa, at points ``x``, m: a number, a list or an array of any shape.
    """

    x: Array
    sigma: Array
    at: Callable[[Array], Array]

    def __post_init__(self) -> None:
        object.__setattr__(self, "at", at_points(self.at))

    @property
    def largest(self) -> tuple[float, float]:
        """Position, m, and value, Pa, of the largest sigma_xx of the lower body; usually a contact edge, x = +-a."""
        highest = self.sigma[0].max(axis=0)
        return float(self.x[highest.argmax()]), float(highest.max())


@dataclass(frozen=True, repr=False)
class DeformedBody(Short):
    """Mesh of a body with displacements and stresses.

    Parameters
    ----------
    name : str
    points : (n, 2) array
        Undeformed, m.
    triangles : (t, 3) int array
    lines : dict of (k, 2) int arrays
        Named groups of boundary edges.
    displacements : dict of (n, 2) arrays
        Displacements of the nodes by name, m.
    stresses : dict of (t, 3) arrays
        sigma_xx, sigma_yy and sigma_xy at the triangles' centroids by name, Pa.
    """

    name: str
    points: Array
    triangles: Indices
    lines: Mapping[str, Indices]
    displacements: Mapping[str, Array]
    stresses: Mapping[str, Array] = field(default_factory=dict)


@dataclass(frozen=True)
class StressAt:
    """Stresses sigma_xx, sigma_yy and sigma_xy at points (x, y), m, of any shape: the lower body is y <= 0.

    Parameters
    ----------
    function : callable
        ``function(x, y, phases) -> (s, 3, k)``: stresses, Pa, at finite points (k,), m, and ``phases`` (s,).
    """

    function: Callable[[Array, Array, Array], Array]

    @one_thread
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
        found: Array = AtPoints(lambda x, y: self._where_finite(x, y, stages.ravel()))(x, y)
        return found.reshape(*stages.shape, *found.shape[1:])

    def _where_finite(self, x: Array, y: Array, phases: Array) -> Array:
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
