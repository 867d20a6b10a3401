"""Bodies of a size as half-planes with other data: another curvature, a tilt, another tension that varies along x."""

from partialslip.equivalent.method import solve as solve

__all__ = ["solve"]
