"""The estimated error of the largest sigma_xx along the surface of the lower body."""

import numpy as np

from partialslip.result.result import Result

SIGMA = "sigma_xx"
# accuracy: error of the largest sigma_xx of fem, in the discretisation error of q, relative L2, times the largest |q|:
# up to 15.9 in 31 solutions of half-planes that are known exactly
_AT_ENDS = 20.0
# accuracy: the same in all other errors of q: up to 0.12 in 47 solutions of march; fem's steps were seen on one rig
# only
_ELSEWHERE = 2.0


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
