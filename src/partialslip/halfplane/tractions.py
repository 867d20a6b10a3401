"""Tractions of the half-planes at any points, as plain data; SI units."""

from dataclasses import dataclass

import numpy as np

from partialslip.arrays import Array
from partialslip.halfplane.contact import Contact
from partialslip.halfplane.levels import Levels
from partialslip.halfplane.loading import Loading
from partialslip.halfplane.turning import Turning

_POINTS = 101  # display: between neighbouring breaks


def sample(breaks: Array) -> Array:
    """Points between ``breaks``, closer towards the breaks, where tractions have square roots."""
    crowd = (1 - np.cos(np.linspace(0, np.pi, _POINTS))) / 2
    return np.unique(breaks[:-1, None] + np.diff(breaks)[:, None] * crowd)


@dataclass(frozen=True)
class ExactTractions:
    """Tractions of the steady state in closed form.

    The contact ``pressed``, the coefficient of friction ``f``, the change of shear traction over half a ``cycle`` (None
    if nothing sticks) and ``levels``, the shear tractions at the load points (None if no closed form gives them).
    """

    pressed: Contact
    f: float
    cycle: Loading | Turning | None
    levels: Levels | None

    def change(self, x: Array) -> tuple[Array, Array]:
        """p and dq at ``x`` (m), Pa; zero outside the contact."""
        p = self.pressed.pressure(x)
        return p, self._unit * self.cycle.traction(self.pressed.scaled(x)) if self.cycle else np.zeros_like(p)

    def at_load_points(self, x: Array) -> tuple[Array, Array]:
        """q1 and q2 at ``x`` (m), Pa; zero outside the contact."""
        assert self.levels
        q1, q2 = self.levels.at(self.pressed.scaled(x))
        return self._unit * q1, self._unit * q2

    @property
    def _unit(self) -> float:
        return self.f * self.pressed.p0


@dataclass(frozen=True)
class CellTractions:
    """Tractions of marching: the exact pressures of the contacts ``second`` and ``first`` at load points 2 and 1, and
    shear tractions ``q1`` and ``q2`` (c,), Pa, constant on the cells between ``vertices`` (c + 1,), which are scaled by
    the ``frame``."""

    frame: Contact
    second: Contact
    first: Contact
    vertices: Array
    q1: Array
    q2: Array

    def change(self, x: Array) -> tuple[Array, Array]:
        """p at load point 2 and dq at ``x`` (m), Pa; zero outside the contact."""
        before, after = self.at_load_points(x)
        return self.second.pressure(x), after - before

    def pressures(self, x: Array) -> tuple[Array, Array]:
        """p at load points 1 and 2 at ``x`` (m), Pa."""
        return self.first.pressure(x), self.second.pressure(x)

    def at_load_points(self, x: Array) -> tuple[Array, Array]:
        """q1 and q2 at ``x`` (m), Pa; zero outside the contact."""
        scaled = self.frame.scaled(x)
        cell = np.clip(np.searchsorted(self.vertices, scaled) - 1, 0, len(self.q1) - 1)
        inside = np.abs(scaled) <= 1
        return np.where(inside, self.q1[cell], 0.0), np.where(inside, self.q2[cell], 0.0)


@dataclass(frozen=True)
class CoupledTractions:
    """Tractions of marching where pressure, too, is constant on cells: p^2 and q/p, which are smooth, interpolated
    between the middles of cells.

    Each load point has points, p^2 and q/p at them, (k,); scaled by the ``length``, the ``stress`` and f as given, from
    ``origin``.
    """

    points: tuple[tuple[Array, Array, Array], tuple[Array, Array, Array]]
    length: float
    stress: float
    origin: float

    @classmethod
    def of(
        cls,
        vertices: Array,
        ends: tuple[tuple[float, float], tuple[float, float]],
        normal: tuple[Array, Array],
        tangential: tuple[Array, Array],
        length: float,
        stress: float,
        origin: float,
    ) -> "CoupledTractions":
        """From forces on the cells (c,) between ``vertices`` (c + 1,) and the ``ends`` of the contact, for load points
        1 and 2."""
        middles, widths = (vertices[1:] + vertices[:-1]) / 2, np.diff(vertices)
        found = []
        for (left, right), p, q in zip(ends, normal, tangential, strict=True):
            on = np.flatnonzero((p > 0) & (middles > left) & (middles < right))
            x = np.concatenate([[left], middles[on], [right]])
            ratio = q[on] / p[on]
            squares = np.concatenate([[0.0], (p[on] / widths[on]) ** 2, [0.0]])
            found.append((x, squares, np.concatenate([ratio[:1], ratio, ratio[-1:]])))
        return cls((found[0], found[1]), length, stress, origin)

    def change(self, x: Array) -> tuple[Array, Array]:
        """p at load point 2 and dq at ``x`` (m), Pa; zero outside the contact."""
        before, after = self.at_load_points(x)
        return self.pressures(x)[1], after - before

    def pressures(self, x: Array) -> tuple[Array, Array]:
        """p at load points 1 and 2 at ``x`` (m), Pa."""
        first, second = (self._pressure(x, at, squares) for at, squares, _ in self.points)
        return first, second

    def at_load_points(self, x: Array) -> tuple[Array, Array]:
        """q1 and q2 at ``x`` (m), Pa; zero outside the contact."""
        first, second = (
            self._pressure(x, at, squares) * np.interp(self._scaled(x), at, ratio) for at, squares, ratio in self.points
        )
        return first, second

    def _scaled(self, x: Array) -> Array:
        return (x - self.origin) / self.length

    def _pressure(self, x: Array, at: Array, squares: Array) -> Array:
        result: Array = self.stress * np.sqrt(np.interp(self._scaled(x), at, squares, left=0.0, right=0.0))
        return result
