"""Loads: the normal force, and the cycle of shear force and bulk tension."""

from typing import Annotated

import msgspec
import numpy as np

from partialslip.errors import InputError
from partialslip.scene.limits import ROUGH
from partialslip.scene.table import Positive, Table

Turns = Annotated[tuple[float, ...], msgspec.Meta(min_length=2, max_length=1000)]


class Load(Table, frozen=True, kw_only=True):
    """Loads per unit depth; they vary linearly from one load point of the cycle to the next.

    ``P`` (N/m) is constant; for Hertz ``a`` (m) or ``p0`` (Pa) may be given instead. ``M`` (N) is the moment of the
    pressure about x = 0, int x p dx; instead the eccentricity ``e`` = M/P (m) may be given. Without either M = 0.
    ``Q`` (N/m) and ``sigma`` (Pa, bulk tension of the lower body less that of the upper body) are values at the load
    points: usually points 1 and 2, between which the loads cycle in phase, or more points. The path begins at zero
    load, goes to the last point, and then ``cycles`` times through all points. Methods that follow the path take at
    least ``steps`` load steps between points.
    """

    P: Positive | None = None
    a: Positive | None = None
    p0: Positive | None = None
    M: float | None = None
    e: float | None = None
    Q: Turns = (0.0, 0.0)
    sigma: Turns = (0.0, 0.0)
    cycles: Annotated[int, msgspec.Meta(ge=1, le=1000)] = 1
    steps: Annotated[int, msgspec.Meta(ge=1, le=1000)] = 1

    def __post_init__(self) -> None:
        if self.M is not None and self.e is not None:
            raise InputError(f"load.e = {self.e}: must not be given together with load.M")
        others = [values for values in (self.Q, self.sigma) if any(values) or len(values) > 2]
        if len(self.Q) != len(self.sigma) and len(others) > 1:
            raise InputError(f"load.sigma: must have as many numbers as load.Q, {len(self.Q)}, not {len(self.sigma)}")

    @property
    def points(self) -> tuple[tuple[float, float], ...]:
        """(Q, sigma) at the load points of the cycle."""
        count = max(len(self.Q), len(self.sigma))
        Q, sigma = (values if any(values) else (0.0,) * count for values in (self.Q, self.sigma))
        return tuple(zip(Q, sigma, strict=True))

    @property
    def ends(self) -> tuple[int, int]:
        """Indices of load points 1 and 2, the extremes of the cycle in the order of visits; out of phase the extremes
        of Q."""
        Q, sigma = np.array(self.points).T
        values = Q if np.ptp(Q) > 0 else sigma
        first, second = sorted((int(np.argmin(values)), int(np.argmax(values))))
        return (first, second) if first != second else (0, len(values) - 1)

    @property
    def in_phase(self) -> bool:
        """Whether Q and sigma are in phase: all load points lie on one straight line."""
        Q, sigma = np.array(self.points).T
        first, second = self.ends
        Q, sigma = Q - Q[first], sigma - sigma[first]
        return bool((np.abs(Q * sigma[second] - sigma * Q[second]) <= ROUGH * np.ptp(Q) * np.ptp(sigma)).all())

    @property
    def dQ(self) -> float:
        """Q2 - Q1, N/m (paper, eq. (2))."""
        first, second = self.ends
        return self.points[second][0] - self.points[first][0]

    @property
    def dsigma(self) -> float:
        """sigma2 - sigma1, Pa (paper, eq. (3))."""
        first, second = self.ends
        return self.points[second][1] - self.points[first][1]

    @property
    def Q_mean(self) -> float:
        """(Q1 + Q2)/2, N/m."""
        first, second = self.ends
        return (self.points[first][0] + self.points[second][0]) / 2

    @property
    def fully_reversed(self) -> bool:
        """Whether the loads are in phase with Q1 = -Q2 and sigma1 = -sigma2, without mean loads."""
        (Q1, sigma1), (Q2, sigma2) = (self.points[end] for end in self.ends)
        return self.in_phase and Q1 == -Q2 and sigma1 == -sigma2
