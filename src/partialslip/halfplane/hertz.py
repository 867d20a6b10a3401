"""Hertz: the frictionless contact of a parabola with a half-plane (paper, eq. (19))."""

import numpy as np

from partialslip.result import Array


def half_width(P: float, A: float, R: float) -> float:
    """Contact half-width a = sqrt(2 A R P/pi), m, from the force ``P`` (N/m), ``A`` (1/Pa) and ``R`` (m)."""
    return float(np.sqrt(2 * A * R * P / np.pi))


def pressure(x: Array, a: float, p0: float) -> Array:
    """Pressure p0 sqrt(1 - (x/a)^2) at ``x`` (m), zero outside [-a, a]; Pa. ``p0`` = a/(A R)."""
    return p0 * np.sqrt(np.maximum((1 - x / a) * (1 + x / a), 0.0))
