"""Grading of meshes: the element size over the distance from a point of the contact line."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

_Array = npt.NDArray[np.float64]


class Eased(NamedTuple):
    """Growth of the elements that is larger near a point.

    Stresses at the ends of zones are square roots. What elements of the size h at the small distance r are off by falls
    with r at the same h/r; so h may fall less steeply than r.

    Parameters
    ----------
    steepest : float
        Element size gained per unit of distance at the point.
    within : float
        Distance beyond which the growth is the one far away.
    power : float
        Growth at the distance r, as far as it is less than the steepest one: that far away times (within/r)^power.
    """

    steepest: float
    within: float
    power: float


def in_effect(eased: Eased | None, growth: float) -> Eased | None:
    """``eased``, if it is steeper than the ``growth`` far away."""
    return eased if eased is not None and eased.steepest > growth else None


def size_at(size: _Array, growth: float, distance: _Array, eased: Eased | None = None) -> _Array:
    """Element size at a ``distance`` from points with element ``size`` there, as :func:`formula`; arrays broadcast."""
    eased = in_effect(eased, growth)
    if eased is None:
        return size + growth * distance
    far = (distance / (distance + eased.within)) ** eased.power
    return size + distance / (1 / eased.steepest + (1 / growth - 1 / eased.steepest) * far)


def formula(size: float, growth: float, eased: Eased | None = None) -> str:
    """The element size as a formula of gmsh; it has F for the distance."""
    size, growth = float(size), float(growth)
    eased = in_effect(eased, growth)
    if eased is None:
        return f"{size!r} + {growth!r} * F"
    steepest, within, power = map(float, eased)
    far = f"(F / (F + {within!r}))^{power!r}"
    return f"{size!r} + F / ({1 / steepest!r} + {1 / growth - 1 / steepest!r} * {far})"
