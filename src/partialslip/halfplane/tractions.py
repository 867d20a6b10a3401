"""Tractions of the half-planes at any points, as plain data; SI units."""

from dataclasses import dataclass

import numpy as np

from partialslip.halfplane.contact import Contact
from partialslip.result import TractionAt
from partialslip.tools.arrays import Array

_POINTS, _FEWEST = 101, 4  # display: between neighbouring breaks; between breaks of which there are many


def sample(breaks: Array, most: int | None = None) -> Array:
    """Points between ``breaks``, closer towards the breaks, where tractions have square roots; at about ``most`` of
    them, fewer between each two breaks."""
    count = _POINTS if most is None else max(min(_POINTS, most // len(breaks)), _FEWEST)
    crowd = (1 - np.cos(np.linspace(0, np.pi, count))) / 2
    return np.unique(breaks[:-1, None] + np.diff(breaks)[:, None] * crowd)


@dataclass(frozen=True)
class CellTractions:
    """Tractions of marching: the exact pressures of the contacts ``second`` and ``first`` at load points 2 and 1
    (``first`` is None if they are the same), and shear tractions ``q1`` and ``q2`` (c,), Pa, constant on the cells
    between ``vertices`` (c + 1,), which are scaled by the ``frame``; ``known`` says whether they are the tractions at
    the load points, or only their difference counts."""

    frame: Contact
    second: Contact
    first: Contact | None
    vertices: Array
    q1: Array
    q2: Array
    known: bool

    def at(self, x: Array) -> TractionAt:
        """Tractions at ``x`` (m), Pa; zero outside the contact."""
        scaled = self.frame.scaled(x)
        cell = np.clip(np.searchsorted(self.vertices, scaled) - 1, 0, len(self.q1) - 1)
        inside = np.abs(scaled) <= 1
        q1, q2 = (np.where(inside, each[cell], 0.0) for each in (self.q1, self.q2))
        p, p1 = self.second.pressure(x), self.first.pressure(x) if self.first else None
        return TractionAt.between(p, q1, q2, self.known, p1)


@dataclass(frozen=True)
class CoupledTractions:
    """Tractions of marching where pressure, too, is constant on cells: p^2 and q/p, which are smooth, interpolated
    between the middles of cells.

    Each load point has points, p^2 and q/p at them, (k,); scaled by the ``length``, the ``stress`` and f as given, from
    ``origin``. ``known`` says whether q1 and q2 are the tractions at the load points, or only their difference counts,
    ``same`` whether only the pressure at load point 2 does.
    """

    points: tuple[tuple[Array, Array, Array], tuple[Array, Array, Array]]
    length: float
    stress: float
    origin: float
    known: bool
    same: bool

    @classmethod
    def of(
        cls,
        vertices: Array,
        ends: tuple[tuple[float, float], tuple[float, float]],
        normal: tuple[Array, Array],
        tangential: tuple[Array, Array],
        units: tuple[float, float, float],
        known: bool,
        same: bool,
    ) -> "CoupledTractions":
        """From forces on the cells (c,) between ``vertices`` (c + 1,) and the ``ends`` of the contact, for load points
        1 and 2; ``units`` are length, stress and origin."""
        middles, widths = (vertices[1:] + vertices[:-1]) / 2, np.diff(vertices)
        found = []
        for (left, right), p, q in zip(ends, normal, tangential, strict=True):
            on = np.flatnonzero((p > 0) & (middles > left) & (middles < right))
            x = np.concatenate([[left], middles[on], [right]])
            ratio = q[on] / p[on]
            squares = np.concatenate([[0.0], (p[on] / widths[on]) ** 2, [0.0]])
            found.append((x, squares, np.concatenate([ratio[:1], ratio, ratio[-1:]])))
        return cls((found[0], found[1]), *units, known, same)

    def at(self, x: Array) -> TractionAt:
        """Tractions at ``x`` (m), Pa; zero outside the contact."""
        scaled = (x - self.origin) / self.length
        p1, p2 = (
            self.stress * np.sqrt(np.interp(scaled, at, squares, left=0.0, right=0.0)) for at, squares, _ in self.points
        )
        q1, q2 = (p * np.interp(scaled, at, ratio) for p, (at, _, ratio) in zip((p1, p2), self.points, strict=True))
        return TractionAt.between(p2, q1, q2, self.known, None if self.same else p1)
