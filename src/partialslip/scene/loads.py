"""Loads: the normal force and its moment, and the cycle of shear force and bulk tension."""

import functools
import itertools
from typing import Annotated

import msgspec
import numpy as np

from partialslip.scene.dimensions import shown
from partialslip.scene.table import ROUGH, Positive, Table
from partialslip.scene.units import SI, Units
from partialslip.tools.arrays import Array, Indices
from partialslip.tools.errors import InputError

_FEW, _MOST = 2, 1000  # limit: least and largest number of load points
_LISTS = ("Q", "displacement", "Q_found", "sigma", "sigma_slope", "P", "M", "e")
Turns = Annotated[tuple[float, ...], msgspec.Meta(min_length=_FEW, max_length=_MOST)]
NormalForces = Annotated[tuple[Positive, ...], msgspec.Meta(min_length=_FEW, max_length=_MOST)]


class Load(Table, frozen=True, kw_only=True):
    """Loads per unit depth; they vary linearly from one load point of the cycle to the next.

    ``P`` (N/m): a number if it is constant, otherwise its values at the load points; for Hertz a constant ``a`` (m) or
    ``p0`` (Pa) may be given instead. ``M`` (N) is the moment of the pressure about x = 0, int x p dx, a number or its
    values at the load points; instead the eccentricity ``e`` = M/P (m) may be given: P and M, not e, vary linearly
    between the load points. Without either M = 0. ``Q`` (N/m) and ``sigma`` (Pa, bulk tension of the lower body less
    that of the upper body) are values at the load points: usually points 1 and 2, between which the loads cycle in
    phase, or more points. Two finite bodies may be driven by the ``displacement`` (m) of the lower body's plate along
    x, less that of the upper body's, in place of Q; where an elastic actuator drives them, ``spring`` (N/m per m and
    unit depth, Pa) is its stiffness. Q is then a result, which a run adds as ``Q_found`` (N/m). With ``sigma_slope``
    (Pa/m) the bulk tension varies along x: it is sigma + sigma_slope x. The path begins at P and M of the last load
    point without Q, sigma and sigma_slope, where the displacement counts from, goes to the last point, and then
    ``cycles`` times through all points; by default until nothing changes any more. Methods that follow the path take at
    least ``steps`` load steps between points.
    """

    P: Positive | NormalForces | None = None
    a: Positive | None = None
    p0: Positive | None = None
    M: float | Turns | None = None
    e: float | Turns | None = None
    Q: Turns = (0.0, 0.0)
    displacement: Turns | None = None
    spring: Positive | None = None
    Q_found: Turns | None = None
    sigma: Turns = (0.0, 0.0)
    sigma_slope: Turns = (0.0, 0.0)
    cycles: Annotated[int, msgspec.Meta(ge=1, le=1000)] | None = None
    steps: Annotated[int, msgspec.Meta(ge=1, le=1000)] = 1

    def __post_init__(self) -> None:
        if self.M is not None and self.e is not None:
            raise InputError(f"load.e = {self.shown('e')}: must not be given together with load.M")
        for key in ("spring", "Q_found"):
            if getattr(self, key) is not None and self.displacement is None:
                raise InputError(f"load.{key} = {self.shown(key)}: must be given only with load.displacement")
        if self.displacement is not None and any(self.Q):
            raise InputError(
                f"load.Q = {self.shown('Q')}: must be left out or [0, 0] with load.displacement, from which it follows"
            )
        lists = {key: len(getattr(self, key)) for key in _LISTS if self._matters(key)}
        for key, length in list(lists.items())[1:]:
            first, count = next(iter(lists.items()))
            if length != count:
                raise InputError(f"load.{key}: must have as many numbers as load.{first}, {count}, not {length}")

    def shown(self, key: str, units: Units | None = None) -> str:
        """Value of ``key`` in a message, as a scene file has it; with ``units`` from SI in these, with the unit."""
        value = getattr(self, key)
        if units:
            return shown(f"load.{key}", value, units)
        return str(list(value) if isinstance(value, tuple) else value)

    def _matters(self, key: str) -> bool:
        """Whether ``key`` is a list whose length counts: two zeros stand for as many as there are load points."""
        values = getattr(self, key)
        return isinstance(values, tuple) and (any(values) or len(values) > _FEW)

    @property
    def driving(self) -> tuple[float, ...]:
        """Q (N/m) or the prescribed displacement (m) at the load points."""
        return self._at_points("Q" if self.displacement is None else "displacement")

    @property
    def tension(self) -> tuple[tuple[float, float], ...]:
        """(sigma, sigma_slope) at the load points."""
        return tuple(zip(self._at_points("sigma"), self._at_points("sigma_slope"), strict=True))

    @property
    def points(self) -> tuple[tuple[float, float], ...]:
        """(Q, sigma) at the load points of the cycle.

        Raises
        ------
        InputError
            If displacements are given, and Q has not been found.
        """
        if self.Q_found is None:
            self.require_forces()
        Q = self._at_points("Q") if self.Q_found is None else self.Q_found
        return tuple(zip(Q, self._at_points("sigma"), strict=True))

    def require_forces(self, units: Units = SI) -> None:
        """Raise InputError, in ``units``, if displacements of plates are given in place of Q."""
        if self.displacement is not None:
            given = self.shown("displacement", units)
            raise InputError(f"load.displacement = {given}: must be load.Q here; only runs with fem find Q")

    @property
    def along(self) -> tuple[tuple[float, float, float], ...]:
        """(Q, sigma, sigma_slope), all loads along x, at the load points of the cycle; raises as :attr:`points`."""
        return tuple((Q, *tension) for (Q, _), tension in zip(self.points, self.tension, strict=True))

    def _at_points(self, key: str) -> tuple[float, ...]:
        """Values of ``key`` at the load points; zeros where it is not given."""
        values = getattr(self, key)
        if isinstance(values, tuple) and self._matters(key):
            return values
        count = max((len(getattr(self, other)) for other in _LISTS if self._matters(other)),
                    default=max(len(self.Q), len(self.sigma)))  # fmt: skip
        return ((0.0 if isinstance(values, tuple) else values) or 0.0,) * count

    def pressing(self, P: float) -> tuple[tuple[float, float], ...]:
        """(P, M) at the load points, N/m and N; ``P`` (N/m) where the normal force is not given."""
        forces = self._at_points("P") if self.P is not None else (P,) * len(self.driving)
        moments = self._at_points("M")
        if self.e is not None:
            moments = tuple(force * e for force, e in zip(forces, self._at_points("e"), strict=True))
        return tuple(zip(forces, moments, strict=True))

    @property
    def presses_anew(self) -> bool:
        """Whether P or M varies."""
        return len(set(self.pressing(1.0))) > 1

    @property
    def _all(self) -> Array:
        """Q or displacement, sigma, P, M and sigma_slope at the load points, (points, 5)."""
        (sigma, slope), (P, M) = zip(*self.tension, strict=True), zip(*self.pressing(1.0), strict=True)
        return np.array([self.driving, sigma, P, M, slope]).T

    @property
    def ends(self) -> tuple[int, int]:
        """Indices of load points 1 and 2, the extremes of the cycle in the order of visits: the extremes of Q, or of
        the displacement, or of sigma where Q is constant, or of P, or of M, or of sigma_slope."""
        return _extreme_points(self)

    @property
    def progress(self) -> Array:
        """Share of the way from load point 1 to 2 at the load points of loads in phase, (points,); 0 if no load
        varies."""
        values, (first, second) = self._leading, self.ends
        way: float = values[second] - values[first]
        return (values - values[first]) / (way or 1.0)

    def stations(self, phases: Array) -> tuple[Indices, Array]:
        """Index (s,) of the load point that is passed last at ``phases`` (s,) of a cycle, and share (s,) of the way to
        the next load point. Phase 0 is load point 1, 0.5 load point 2, 1 load point 1 again; load points between them
        divide the ways into equal parts."""
        first, second = self.ends
        count = len(self.driving)
        position = np.interp(phases, [0.0, 0.5, 1.0], [first, second, first + count])
        passed = np.floor(position).astype(np.int64)
        return passed % count, position - passed

    @property
    def _leading(self) -> Array:
        """Values at the load points of the first load that varies."""
        loads = self._all.T
        return next((each for each in loads if np.ptp(each) > 0), loads[0])

    @property
    def in_phase(self) -> bool:
        """Whether all loads are in phase: all load points lie on one straight line."""
        return _in_phase(self)

    @property
    def dQ(self) -> float:
        """Q2 - Q1, N/m (paper, eq. (2))."""
        first, second = self.ends
        return self.points[second][0] - self.points[first][0]

    @property
    def dsigma(self) -> float:
        """sigma2 - sigma1, Pa (paper, eq. (3))."""
        first, second = self.ends
        return self.tension[second][0] - self.tension[first][0]

    @property
    def dslope(self) -> float:
        """Change of sigma_slope from load point 1 to 2, Pa/m."""
        first, second = self.ends
        return self.tension[second][1] - self.tension[first][1]

    @property
    def path_steps(self) -> int:
        """Least number of load steps of the whole path: to the last load point, and ``cycles`` times through all."""
        return self.steps * (1 + (self.cycles or 1) * len(self.driving))

    @property
    def Q_mean(self) -> float:
        """(Q1 + Q2)/2, N/m."""
        first, second = self.ends
        return (self.points[first][0] + self.points[second][0]) / 2

    @property
    def fully_reversed(self) -> bool:
        """Whether P and M are constant and the other loads are in phase with Q1 = -Q2 and sigma1 = -sigma2, without
        mean loads; so are displacements."""
        first, second = ((self.driving[end], *self.tension[end]) for end in self.ends)
        return (
            self.in_phase and not self.presses_anew and all(one == -two for one, two in zip(first, second, strict=True))
        )


@functools.lru_cache(maxsize=64)  # a run asks for them hundreds of times
def _extreme_points(load: Load) -> tuple[int, int]:
    values = load._leading
    first, second = sorted((int(np.argmin(values)), int(np.argmax(values))))
    return (first, second) if first != second else (0, len(values) - 1)


@functools.lru_cache(maxsize=64)
def _in_phase(load: Load) -> bool:
    first, second = load.ends
    loads = (load._all - load._all[first]).T
    return all(
        bool((np.abs(one * other[second] - other * one[second]) <= ROUGH * np.ptp(one) * np.ptp(other)).all())
        for one, other in itertools.combinations(loads, 2)
    )
