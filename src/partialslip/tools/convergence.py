"""Ladders of meshes: order of convergence, extrapolation and grid convergence index (GCI), by one rule.

The rule is that of P. J. Roache and ASME V&V 20, with the limits of the order of W. L. Oberkampf and C. J. Roy:

    GCI = F_s |change| / (ratio^p - 1)

with the change from the mesh before to the finest mesh and the ratio of their sizes. p is the observed order, not less
than 0.5 and not more than the formal order of the method, if that is known. F_s is 1.25 where the order that three
meshes or more show is trusted: not below 0.5, and not more than 0.5 above the formal order. Elsewhere it is 3.
"""

import math
from collections.abc import Sequence

import numpy as np

LOWEST = 0.5  # fixed: order below which an observed order is not trusted
ABOVE_FORMAL = 0.5  # fixed: above the formal order: orders higher than that are not trusted
TRUSTED, NOT_TRUSTED = 1.25, 3.0  # fixed: safety factors


def power(x: Sequence[float], y: Sequence[float]) -> float:
    """Return k of the power law ``y = C x^k``, by least squares in logarithms; NaN for fewer than two different x."""
    if len(set(x)) < 2:
        return math.nan
    return float(np.polyfit(np.log(x), np.log(np.maximum(y, 1e-300)), 1)[0])


def fitted_order(sizes: Sequence[float], changes: Sequence[float]) -> float | None:
    """Return the order fitted to the ``changes`` from mesh to mesh, each with the size of its finer mesh.

    Changes that vanish are left out; None if fewer than two are left. For two it is the order of three meshes.
    """
    known = [(size, change) for size, change in zip(sizes, changes, strict=True) if change > 0]
    return power(*zip(*known, strict=True)) if len(known) > 1 else None


def grid_convergence_index(change: float, ratio: float, order: float | None, formal: float = math.inf) -> float:
    """Return the GCI of the finest mesh, in the unit of ``change``.

    Parameters
    ----------
    change : float
        From the mesh before to the finest one, >= 0.
    ratio : float
        Size of the mesh before over that of the finest one, > 1.
    order : float or None
        Observed order; None if no order was observed.
    formal : float
        Formal order of the method; by default unknown.
    """
    trusted = order is not None and LOWEST <= order <= formal + ABOVE_FORMAL
    used = LOWEST if order is None else min(max(order, LOWEST), formal)
    rest = used * math.log(ratio)
    # change/(ratio^p - 1), where ratio^p may be larger than any number
    return (TRUSTED if trusted else NOT_TRUSTED) * change * math.exp(-rest) / -math.expm1(-rest)


def extrapolated(coarse: float, middle: float, fine: float) -> float:
    """Return Richardson's value of three meshes of one ratio, on which values come closer from mesh to mesh."""
    first, second = middle - coarse, fine - middle
    return fine + second * second / (first - second)
