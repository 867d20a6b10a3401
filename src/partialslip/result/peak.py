"""The estimated errors of the largest pressure, and of the largest sigma_xx along the surface of the lower body."""

import math

import numpy as np

from partialslip.result.result import Result
from partialslip.result.traction import largest

SIGMA = "sigma_xx"
_FINER = 65  # accuracy: points around the largest pressure: parabolas through these are 1e-5 of the first one off
# accuracy: error of the largest sigma_xx of fem, in the discretisation error of q, relative L2, times the largest |q|:
# up to 15.9 in 31 solutions of half-planes that are known exactly
_AT_ENDS = 20.0
# accuracy: the same in all other errors of q: up to 0.12 in 47 solutions of march; fem's steps were seen on one rig
# only
_ELSEWHERE = 2.0


def pressure_peaks(result: Result, error: float) -> tuple[tuple[float, float], ...]:
    """Return the largest pressure, Pa, and its error at load points 1 and 2, or at both at once if the pressure is the
    same; ``error`` is the estimated error of p, relative L2.

    An error of p with the L2 norm e is at most e/sqrt(h) high over a length h: h is the cell at the peak, or a
    without cells, where the data of the pressure are off. The change by finer points around the peak adds to it.
    """
    traction = result.traction
    x, pressures = traction.x, (traction.p,) if traction.p1 is None else traction.values.pressures
    found = []
    for point, p in enumerate(pressures, start=2 - (len(pressures) == 2)):
        top, at = largest(x, p), int(p.argmax())
        h = result.a
        if traction.cells is not None and len(traction.cells) > 1:
            cell = np.clip(np.searchsorted(traction.cells, x[at]) - 1, 0, len(traction.cells) - 2)
            h = float(np.diff(traction.cells)[cell])
        finer = np.linspace(x[max(at - 1, 0)], x[min(at + 1, len(x) - 1)], _FINER)
        between = abs(largest(finer, traction.at(finer).pressures[point - 1]) - top)
        high = error * math.sqrt(float(np.trapezoid(p**2, x)) / h) if error else 0.0
        found.append((top, high + between))
    return tuple(found)


def peak_error(result: Result) -> float | None:
    """Return the estimated error of the largest sigma_xx, Pa; None without estimates, or without stresses.

    An error of q that is spread along the contact moves sigma_xx by about as much; one of the mesh stands at the ends
    of the contact and of the stick zone, where tractions end like square roots, and counts more.
    """
    if result.surface is None:
        return None
    if result.method == "exact":
        return 0.0
    if SIGMA in result.estimate:
        return float(result.estimate[SIGMA] * abs(result.surface.largest[1]))
    if "q" not in result.estimate:
        return None
    found = 0.0
    for source, share in result.shares.items():
        largest = max((share[key] for key in ("q", "q1", "q2") if key in share), default=0.0)
        at_ends = result.method == "fem" and source == "discretisation"
        found += (_AT_ENDS if at_ends else _ELSEWHERE) * largest
    levels = result.traction.values.levels or (result.traction.dq / 2,)
    return float(found * max(np.abs(q).max() for q in levels))
