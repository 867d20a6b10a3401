"""Tractions along the contact."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from partialslip.arrays import Array
from partialslip.result.fields import at_points
from partialslip.shown import Short


@dataclass(frozen=True, repr=False)
class Traction(Short):
    """Tractions over the contact line.

    The functions take a number, a list or an array of any shape, and return values of that shape.

    Parameters
    ----------
    x : (n,) array
        Points, ascending, m.
    p, dq : (n,) arrays
        Pressure at load point 2 and change of shear traction, q2 - q1, Pa.
    q1, q2 : (n,) arrays or None
        Shear traction at load points 1 and 2, Pa. None where the method determines dq only: with mean loads a closed
        form does not give the shear locked in by the first cycles. Where Q and sigma are out of phase, the least and
        the largest shear of the last cycle.
    at : callable
        ``at(x) -> (p, dq)``: tractions at any points, Pa, interpolated by the method; zero outside the contact.
    breaks : (k,) array
        Points where the tractions are not smooth, m: the ends of the contact and of the stick zone.
    cells : (c + 1,) array or None
        Ends of the cells (contact edges of the mesh) for cell averages, m; None if the method has no cells.
    levels_at : callable or None
        ``levels_at(x) -> (q1, q2)`` at any points, Pa, zero outside the contact; None where ``q1`` and ``q2`` are None.
    p1 : (n,) array or None
        Pressure at load point 1, Pa; None where the pressure is the same at both load points.
    pressures_at : callable or None
        ``pressures_at(x) -> (p1, p2)`` at any points, Pa; None where ``p1`` is None.
    """

    x: Array
    p: Array
    dq: Array
    q1: Array | None
    q2: Array | None
    at: Callable[[Array], tuple[Array, Array]]
    breaks: Array
    cells: Array | None = None
    levels_at: Callable[[Array], tuple[Array, Array]] | None = None
    p1: Array | None = None
    pressures_at: Callable[[Array], tuple[Array, Array]] | None = None

    def __post_init__(self) -> None:
        for name in ("at", "levels_at", "pressures_at"):
            object.__setattr__(self, name, at_points(getattr(self, name)))

    @property
    def p_max(self) -> float:
        """The largest pressure, Pa, interpolated by a parabola through the largest value and the two beside it."""
        if len(self.x) < 3:
            return float(self.p.max())
        near = np.clip(int(self.p.argmax()), 1, len(self.x) - 2) + np.array([-1, 0, 1])
        x, p = self.x[near], self.p[near]
        if np.diff(x).min() <= 0:
            return float(p.max())
        before, after = np.diff(p) / np.diff(x)
        bend = (after - before) / (x[2] - x[0])
        slope = before + bend * (x[1] - x[0])
        rise = -(slope**2) / (4 * bend) if bend < 0 and abs(slope) < -bend * (x[2] - x[0]) else 0.0
        return float(max(p.max(), p[1] + rise))


@dataclass(frozen=True)
class Sliding:
    """Shear of a contact that slides at both load points: q = ``signs`` f p, with the pressure of ``traction``.

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

    def levels_at(self, x: Array) -> tuple[Array, Array]:
        """q1 and q2 at ``x`` (m), Pa."""
        of = self.traction
        p1, p2 = of.pressures_at(x) if of.pressures_at else (of.at(x)[0],) * 2
        f = self.f(x)
        return self.signs[0] * f * p1, self.signs[1] * f * p2

    def at(self, x: Array) -> tuple[Array, Array]:
        """p at load point 2 and dq at ``x`` (m), Pa."""
        q1, q2 = self.levels_at(x)
        return self.traction.at(x)[0], q2 - q1


def sliding(traction: Traction, f: Callable[[Array], Array], signs: tuple[int, int]) -> Traction:
    """Return ``traction`` with the shear of a contact that slides at both load points, in the directions ``signs``."""
    slides = Sliding(traction, f, signs)
    q1, q2 = slides.levels_at(traction.x)
    return replace(traction, dq=q2 - q1, q1=q1, q2=q2, at=slides.at, levels_at=slides.levels_at)
