"""How the contact of bodies grows with the force that presses them together, under a convex even gap.

It grows as under flat punches. Where the gap's curvature gains the step w at |x| = b, punches of the half-width s get
the force P'(s) ds = w s Psi(b/s) ds that closes the gap beyond b,

    int_b^x U(x/s) P'(s) ds = w (x - b)^2/2 for all x > b,

if U(x/s) is what the force 1 on a flat punch of the half-width s opens at x. Without coupling U = arcosh(x/s) and Psi =
arccos(b/s). In dissimilar half-planes with friction the shear that pressing locks in changes the pressure under a
punch, and with it U: at the punch's ends, which slip, it has the power 1/2 + eps, and Psi the power 1/2 - eps, with
tan(pi eps) = f beta (Spence 1975). Psi is arccos(b/s)^(1 - 2 eps) times a polynomial in b/s then, fitted to the gap.
That is as good as the ends are wide that slip: it leaves 2e-4 of the gap where these are 0.01 of the contact, 2e-3 at
0.002, and up to 0.06 where hardly anything slips.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import CubicHermiteSpline, CubicSpline

from partialslip.scene import Hertz, Scene
from partialslip.tools.arrays import Array

_AT, _WEIGHTS = (np.polynomial.legendre.leggauss(48) + np.array([[1.0], [0.0]])) / 2
_DENSE = np.linspace(0.0, 1.0, 257)  # accuracy: roots of places between steps of the curvature
_AT_CELL, _OF_CELL = (np.polynomial.legendre.leggauss(3) + np.array([[1.0], [0.0]])) / 2
_TERMS = 8  # accuracy: terms of the polynomial
_CLOSED = 1 + np.geomspace(1e-3, 1e3, 60)  # accuracy: where the gap is to close, in b, from its step on
_ANGLES, _BY_ANGLE = (np.polynomial.legendre.leggauss(400) + np.array([[1.0], [0.0]])) / 2 * np.pi
_OPENED = np.geomspace(1e-3, 1.01 * np.arccosh(_CLOSED[-1]), 200)  # accuracy: arcosh of places where U is known


@dataclass(frozen=True)
class EvenGap:
    """Convex even gap whose curvature gains the ``steps`` (k,) at |x| = ``places`` (k,), ascending, in any units.
    Punches under it get forces with the ``power`` of arccos(b/s), times the polynomial in b/s with the coefficients
    ``terms``; by default, those without coupling. They leave ``off`` of the gap, root mean square."""

    places: Array
    steps: Array
    power: float = 1.0
    terms: Array | None = None
    off: float = 0.0

    @property
    def parabolic(self) -> bool:
        """Whether the gap is a parabola."""
        return len(self.places) == 1 and not self.places[0]

    def force(self, half_width: float) -> float:
        """Force that presses half-planes together up to the ``half_width``, in a unit of its own."""
        begins = self.places[self.places < half_width, None]
        s = begins + (half_width - begins) * _AT**2
        return float(
            self.steps[: len(s)] @ (self._rates(begins, s) * 2 * (half_width - begins) * _AT * _WEIGHTS).sum(1)
        )

    def rate(self, half_widths: Array) -> Array:
        """Derivative of the force with the half-width, at ``half_widths`` of any shape."""
        total = np.zeros_like(half_widths)
        for place, step in zip(self.places.tolist(), self.steps.tolist(), strict=True):
            total += step * self._rates(place, np.maximum(half_widths, place))
        return total

    def weighed(self, reach: float) -> CubicHermiteSpline:
        """Integral of P(s)/s^2 over the half-widths s, from nothing to those up to ``reach``."""
        ends = np.append(self.places[self.places < reach], reach)
        s = np.unique(np.append(0.0, ends[:-1, None] + np.diff(ends)[:, None] * _DENSE**2))
        within = s[:-1, None] + np.diff(s)[:, None] * _AT_CELL
        rates, weights = self.rate(within), np.diff(s)[:, None] * _OF_CELL
        force, over = (np.append(0.0, np.cumsum((each * weights).sum(1))) for each in (rates, rates / within))
        ratio = np.divide(force, s, out=np.zeros_like(s), where=s > 0)
        slope = np.divide(ratio, s, out=np.full_like(s, ratio[1] / s[1]), where=s > 0)
        return CubicHermiteSpline(s, over - ratio, slope)

    def under(self, ends: Array, forces: Array, pushes: float) -> "EvenGap":
        """The gap under punches with given ``forces`` (c,) on cells between ``ends`` (c + 1,), from the middle, 0, to
        the punch's end, 1; their ends slip, and ``pushes`` is f times the size of Dundurs' beta."""

        def opened(x: Array) -> Array:  # by all forces, against the middle
            logs = _logs(x[:, None] - ends) - _logs(x[:, None] + ends)
            return np.asarray(-np.diff(logs, axis=1) @ (forces / np.diff(ends)), float)

        own, at = 1 - 2 / np.pi * np.arctan(pushes), np.log(_OPENED)
        known = CubicSpline(at, np.log(opened(np.cosh(_OPENED)) - opened(np.ones(1))))
        logs = np.log(_CLOSED)[:, None]
        s = np.exp(logs * (1 - np.cos(_ANGLES)) / 2)
        places = np.log(np.arccosh(_CLOSED[:, None] / s))
        nearer = np.minimum(places - at[0], 0.0)  # than U is known
        opens = np.exp(known(places - nearer) + (2 - own) * nearer)
        closing = opens * s * np.arccos(1 / s) ** own * (s * logs / 2 * np.sin(_ANGLES) * _BY_ANGLE)
        rows = np.stack([(closing / s**degree).sum(1) for degree in range(_TERMS)], 1)
        rows /= (_CLOSED[:, None] - 1) ** 2 / 2
        terms = np.linalg.lstsq(rows, np.ones(len(rows)), rcond=None)[0]
        return replace(self, power=float(own), terms=terms, off=float(np.sqrt(np.mean((rows @ terms - 1) ** 2))))

    def _rates(self, place: Array | float, half_widths: Array) -> Array:
        """Derivative of the force due to a step 1 at the ``place``, for half-widths beyond it."""
        ratio = np.divide(place, half_widths, out=np.zeros_like(half_widths), where=half_widths > 0)
        angle: Array = np.arccos(ratio)
        if self.terms is not None:
            angle = angle**self.power * np.polynomial.polynomial.polyval(ratio, self.terms)
        return half_widths * angle


PARABOLA = EvenGap(np.zeros(1), np.ones(1))


def _logs(x: Array) -> Array:
    """Integral of ln|x|."""
    size = np.abs(x)
    return np.asarray(x * (np.log(np.where(size > 0, size, 1.0)) - 1), float)


def even_gap(scene: Scene, length: float) -> EvenGap | None:
    """Return the curvature of the gap of ``scene``, lengths in ``length``, m; None if the contact does not grow with P
    alone, with one f, in a convex even gap."""
    if not scene.even or scene.presses_anew or scene.friction.varies:
        return None
    if isinstance(scene.profile, Hertz):
        return PARABOLA
    if (scene.profile.curvature.values < 0).any():
        return None
    places, steps = scene.profile.curvature_steps()
    return EvenGap(places / length, steps)
