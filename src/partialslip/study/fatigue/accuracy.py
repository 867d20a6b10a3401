"""Estimated errors of fatigue criteria: by how much they change if the stresses change by their own errors."""

from typing import NamedTuple

import numpy as np

from partialslip.result import Result
from partialslip.result.peak import peak_error
from partialslip.study.fatigue.criteria import Criterion
from partialslip.study.fatigue.critical_plane import Ruiz
from partialslip.tools.arrays import Array

# accuracy: error of stresses at the surface in the difference at the ends of the contact (_edge_error): up to 2.5 in 59
# solutions of fem
_SURFACE = 3.0
# accuracy: error of averaged stresses in the error of the stresses at the ends of the contact: up to 0.52 in 57
# such solutions of fem
_AVERAGED = 0.6
# accuracy: height of a peak above the largest value at points, in the fall from there to the lower neighbour: 1/8 at
# most if the peak is a parabola
_BETWEEN = 0.25


class CriterionErrors(NamedTuple):
    """Relative errors at the ``surface``, and ``below`` it: of averages and inside the body."""

    surface: float
    below: float


def errors_of_stresses(result: Result, body: str) -> CriterionErrors | None:
    """Return the errors of the stresses of a ``body``; None for the upper one, where the ``result`` has no estimate of
    them, and where it does not claim to hold."""
    error = peak_error(result)
    if error is None or body != "lower" or result.path_dependent or result.surface is None:
        return None
    share, edge = error / (abs(result.surface.largest[1]) or 1.0), _edge_error(result)
    return CriterionErrors(share + _SURFACE * edge, share + _AVERAGED * edge)


def criterion_errors(
    of: Criterion, stress: Array, change: float, errors: CriterionErrors | None
) -> CriterionErrors | None:
    """Return the errors of a criterion for the ``errors`` of the ``stress`` path (s, 4) of its point, and its own
    ``change`` over load points around the cycle, NaN if that is not known."""
    if errors is None:
        return None
    beside = 0.0 if np.isnan(change) else change
    now, *grown = (float(of.at((1.0 + share) * stress).value) for share in (0.0, *errors))
    changed = (abs(then / now - 1) if now else share for then, share in zip(grown, errors, strict=True))
    return CriterionErrors(*(each + beside for each in changed))


def ruiz_errors(of: Ruiz, errors: CriterionErrors | None) -> tuple[float, float] | None:
    """Return the relative errors of F1 and F2 for the ``errors`` of the stresses, to which shear and slip are
    proportional, and for points that miss the peaks."""
    if errors is None:
        return None
    grown = (1.0 + errors.surface) ** 3 - 1
    return grown + _missed(of.work), grown + _missed(of.product)


def _missed(values: Array) -> float:
    """Relative height by which the peak between points may exceed the largest of the ``values`` at the points."""
    peak = int(values.argmax())
    beside = values[max(peak - 1, 0) : peak + 2].min()
    return float(_BETWEEN * (1 - beside / values[peak])) if values[peak] > 0 else 0.0


def _edge_error(result: Result) -> float:
    """Relative error of the stresses at the ends of the contact.

    Tractions end like square roots. Their Cauchy integrals, from which criteria are found, are less accurate there than
    the strain of the surface beyond the ends: the difference is the error.
    """
    assert result.surface
    assert result.stress_at
    ends, sigma = np.array(result.ends), result.surface.sigma[0]
    at = np.abs(result.surface.x[:, None] - ends.ravel()).argmin(axis=0).reshape(ends.shape)
    integrals = result.stress_at(result.surface.x[at], np.zeros(ends.shape))[:, 0]  # by load point, then both ends
    apart = [np.abs(integrals[k, k] - sigma[k, at[k]]).max() for k in range(len(ends))]
    return float(max(apart) / np.abs(sigma).max())
