"""Tolerances of a scene's numbers, propagated to its results."""

from partialslip.study.tolerance.propagate import propagate as propagate
from partialslip.study.tolerance.propagate import with_tolerance as with_tolerance
