"""The exact solution for two elastically similar half-planes: numpy and scipy only."""

from partialslip.halfplane.method import solve as solve
