"""Tractions along the contact."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from partialslip.result.fields import at_points
from partialslip.tools.arrays import Array
from partialslip.tools.shown import Short


class TractionAt(NamedTuple):
    """Tractions at points, Pa; arrays of one shape.

    Parameters
    ----------
    p, dq : arrays
        Pressure at load point 2 and change of shear traction, q2 - q1.
    q1, q2 : arrays or None
        Shear traction at load points 1 and 2. None where the method determines dq only: with mean loads a closed
        form does not give the shear locked in by the first cycles. Where Q and sigma are out of phase, the least and
        the largest shear of the last cycle.
    p1 : array or None
        Pressure at load point 1; None where the pressure is the same at both load points.
    """

    p: Array
    dq: Array
    q1: Array | None = None
    q2: Array | None = None
    p1: Array | None = None

    @classmethod
    def between(cls, p: Array, q1: Array, q2: Array, known: bool, p1: Array | None = None) -> "TractionAt":
        """From shear at the load points of which only the change counts, unless it is ``known`` to be q1 and q2."""
        return cls(p, q2 - q1, q1 if known else None, q2 if known else None, p1)

    @property
    def pressures(self) -> tuple[Array, Array]:
        """Pressure at load points 1 and 2, Pa."""
        return (self.p if self.p1 is None else self.p1), self.p

    @property
    def levels(self) -> tuple[Array, Array] | None:
        """q1 and q2, Pa; None where the method determines dq only."""
        return None if self.q1 is None or self.q2 is None else (self.q1, self.q2)


def largest(x: Array, p: Array) -> float:
    """Return the largest of the values ``p`` (n,) at ascending points ``x`` (n,), interpolated by a parabola through
    the largest one and the two beside it."""
    if len(x) < 3:
        return float(p.max())
    near = np.clip(int(p.argmax()), 1, len(x) - 2) + np.array([-1, 0, 1])
    x, p = x[near], p[near]
    if np.diff(x).min() <= 0:
        return float(p.max())
    before, after = np.diff(p) / np.diff(x)
    bend = (after - before) / (x[2] - x[0])
    slope = before + bend * (x[1] - x[0])
    rise = -(slope**2) / (4 * bend) if bend < 0 and abs(slope) < -bend * (x[2] - x[0]) else 0.0
    return float(max(p.max(), p[1] + rise))


class Observed(NamedTuple):
    """Meaning of the values of a table, for a comparison of like with like: sampled values, cell means or nodal values.

    Parameters
    ----------
    cells : (n, 2) array
        Ends of the part of the contact line that each value stands for, ascending, m. No value stands for what lies
        between them, or beyond.
    of : callable
        ``of(function, breaks)``: values, (keys, n), that the table would have of ``function``, (k,) -> (keys, k), which
        is not smooth at ``breaks`` (m).
    """

    cells: Array
    of: Callable[[Callable[[Array], Array], Array], Array]


@dataclass(frozen=True, repr=False)
class Traction(Short):
    """Tractions over the contact line.

    Parameters
    ----------
    x : (n,) array
        Points, ascending, m.
    values : TractionAt
        Tractions at ``x``, (n,) each.
    at : callable
        ``at(x) -> TractionAt``: tractions at any points, a number, a list or an array of any shape (m), interpolated by
        the method; zero outside the contact, NaN at NaN. It gives what ``values`` has, and None for the rest.
    breaks : (k,) array
        Points where the tractions are not smooth, m: the ends of the contact and of the stick zone.
    cells : (c + 1,) array or None
        Ends of the cells (contact edges of the mesh) for cell averages, m; None if the method has no cells.
    observed : Observed or None
        What the values stand for if they are those of a table; None if the tractions are functions of x.
    """

    x: Array
    values: TractionAt
    at: Callable[[Array], TractionAt]
    breaks: Array
    cells: Array | None = None
    observed: Observed | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "at", at_points(self.at))

    @property
    def p(self) -> Array:
        """Pressure at load point 2 at ``x``, (n,), Pa."""
        return self.values.p

    @property
    def dq(self) -> Array:
        """Change of shear traction, q2 - q1, at ``x``, (n,), Pa."""
        return self.values.dq

    @property
    def q1(self) -> Array | None:
        """Shear traction at load point 1 at ``x``, (n,), Pa; None where the method determines dq only."""
        return self.values.q1

    @property
    def q2(self) -> Array | None:
        """Shear traction at load point 2 at ``x``, (n,), Pa; None where the method determines dq only."""
        return self.values.q2

    @property
    def p1(self) -> Array | None:
        """Pressure at load point 1 at ``x``, (n,), Pa; None where it is that at load point 2."""
        return self.values.p1

    @property
    def p_max(self) -> float:
        """The largest pressure at load point 2, Pa, interpolated by a parabola through the largest value and the two
        beside it."""
        return largest(self.x, self.p)


@dataclass(frozen=True)
class Sliding:
    """Tractions of a contact that slides at both load points: q = ``signs`` f p, with the pressure of ``traction``.

    Parameters
    ----------
    traction : Traction
        The pressure counts.
    f : callable
        ``f(x)``: coefficient of friction at points, m.
    signs : (int, int)
        Signs of q at load points 1 and 2.
    """

    traction: Traction
    f: Callable[[Array], Array]
    signs: tuple[int, int]

    def at(self, x: Array) -> TractionAt:
        """Tractions at ``x`` (m), Pa."""
        found, f = self.traction.at(x), self.f(x)
        q1, q2 = (sign * f * p for sign, p in zip(self.signs, found.pressures, strict=True))
        return found._replace(dq=q2 - q1, q1=q1, q2=q2)


def sliding(traction: Traction, f: Callable[[Array], Array], signs: tuple[int, int]) -> Traction:
    """Return ``traction`` with the shear of a contact that slides at both load points, in the directions ``signs``."""
    slides = Sliding(traction, f, signs)
    shear = slides.at(traction.x)
    values = traction.values._replace(dq=shear.dq, q1=shear.q1, q2=shear.q2)
    return replace(traction, values=values, at=slides.at)
