"""Tolerances of a scene's numbers, propagated to its results."""

from partialslip.study.tolerance.propagation import propagate as propagate
from partialslip.study.tolerance.propagation import with_tolerance as with_tolerance
