"""Contacts whose pressure is not even: profiles with two different sides, and bodies turned by a moment.

The gap's curvature is constant between points. In a contact [L, R] the gap's slope is therefore a linear function plus
half-steps, w (x - b) for x > b on the right of a middle point, and w (x - b) for x < b on its left. For a contact with
middle c and half-width a, and b = c + a cos(psi), a half-step on the right adds (Muskhelishvili's inversion)

    to A P:                 a^2 w (2 psi - sin(2 psi))/4
    to A M, about c:        a^3 w sin(psi)^3/6
    to the tilt:            a w (sin(psi) - psi cos(psi))/pi
    to A p at angle theta:  a w h/pi,  h = psi sin(theta) + (x - b)/a log|sin((theta + psi)/2)/sin((theta - psi)/2)|,

x = c + a cos(theta); a constant curvature is the half-step with psi = pi. A half-step on the left is the mirror image.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from partialslip.halfplane.panels import Panels
from partialslip.halfplane.punch import FEW, punch_force
from partialslip.halfplane.shape import Shape
from partialslip.scene.profiles import Curvature
from partialslip.tools.arrays import Array, Indices

# accuracy: length, in the size of the contact, below which ends of the contact are found linearly, above by logs
_TINY = 1e-14
_STEPS = 60  # cost: Newton steps before bracketing
_LONGEST = 2.0  # cost: largest Newton step, in the logarithm of an end
_SETTLED = 1e-14  # accuracy: Newton step after which only rounding errors remain
_ROUNDING = 64 * float(np.finfo(float).eps)
_SMALL = 0.3  # accuracy: argument below which differences of functions are summed as series
_SERIES = 14  # accuracy: terms


class _Steps(NamedTuple):
    """Half-steps of the slope in a contact: curvature ``base`` at the middle, ``weights`` (k,), 1/m, angles ``psi``
    (k,), and ``side`` (k,), 1 on the right of the middle and -1 on its left."""

    centre: float
    a: float
    base: float
    at_middle: float  # slope of the gap at the middle of the contact, without half-steps
    weights: Array
    psi: Array
    side: npt.NDArray[np.int8]

    @property
    def force(self) -> float:
        """A P, m."""
        return self.a**2 / 4 * (self.base * 2 * math.pi + float(self.weights @ punch_force(self.psi)))

    @property
    def moment(self) -> float:
        """A M about x = 0, m^2."""
        cubes = np.sin(self.psi) ** 3
        return self.force * self.centre + self.a**3 / 6 * float((self.side * self.weights) @ cubes)

    @property
    def tilt(self) -> float:
        """Angle by which the bodies have turned."""
        turned = np.sin(self.psi) - self.psi * np.cos(self.psi)
        return self.at_middle + self.a / math.pi * float((self.side * self.weights) @ turned)

    @property
    def rates(self) -> tuple[Array, Array]:
        """Derivatives of (force, tilt) by the right end and by the left end, (2,) each."""
        w, psi, side = self.weights, self.psi, self.side
        force_c, force_a = self.a * float((side * w) @ np.sin(psi)), self.a * (self.base * math.pi + float(w @ psi))
        tilt_c, tilt_a = self.base + float(w @ psi) / math.pi, float((side * w) @ np.sin(psi)) / math.pi
        by_c, by_a = np.array([force_c, tilt_c]), np.array([force_a, tilt_a])
        return (by_c + by_a) / 2, (by_c - by_a) / 2


@dataclass(frozen=True)
class _Ends:
    """Ends of a contact: ``left`` and ``right`` are the distances of the ends beyond the points ``low`` and ``high``,
    between which the gap has no curvature. Short distances keep their digits."""

    low: float
    high: float
    left: float
    right: float

    @property
    def a(self) -> float:
        return (self.high - self.low + self.left + self.right) / 2

    @property
    def centre(self) -> float:
        return (self.high + self.low + self.right - self.left) / 2

    def steps(self, of: Curvature) -> _Steps:
        """Half-steps of the gap with the curvature ``of`` in this contact."""
        a, first, last = self.a, self.low - self.left, self.high + self.right
        middle = min(max(of.lowest, first), last)
        number = int(np.searchsorted(of.breaks, middle, "right"))
        beyond = of.breaks[number:] - self.high, self.low - of.breaks[:number]
        inside = beyond[0] < self.right, beyond[1] < self.left
        jumps = np.diff(of.values)
        weights = jumps[number:][inside[0]], -jumps[:number][inside[1]]
        widths = self.right - beyond[0][inside[0]], self.left - beyond[1][inside[1]]
        psi = [2 * np.arcsin(np.sqrt(np.minimum(width / (2 * a), 1.0))) for width in widths]
        base = float(of.values[number])
        side = np.repeat([1, -1], [len(each) for each in psi]).astype(np.int8)
        at_middle = float(of.slope_at(np.array(middle))) + base * (self.centre - middle)
        return _Steps(self.centre, a, base, at_middle, np.concatenate(weights), np.concatenate(psi), side)


class PressedBodies(NamedTuple):
    """A contact that is not even: middle ``centre`` and half-width ``a``, m, scaled pressure ``shape``, and the angle
    ``tilt`` (rad) by which the bodies have turned."""

    centre: float
    a: float
    shape: "Uneven"
    tilt: float


def press_uneven(of: Curvature, force: float, moment: float | None, scale: float) -> PressedBodies | None:
    """Press two half-planes together; None if the contact extends beyond the range in which the gap is known.

    Parameters
    ----------
    of : Curvature
        Curvature of the gap.
    force : float
        A P, m.
    moment : float or None
        A M about x = 0, m^2; None if the bodies do not turn.
    scale : float
        Length of about the contact's size, m.
    """
    number = int(np.searchsorted(of.breaks, of.lowest, "right"))
    flat = of.values[number] <= 0
    low, high = (of.breaks[number - 1], of.breaks[number]) if flat else (of.lowest, of.lowest)
    origin = moment / force if moment is not None else 0.0
    search = _Search(of, force, moment, float(low), float(high), _TINY * scale, origin)
    ends = search.newton(scale) or search.bracketed(scale)
    if not ends:
        return None
    steps = ends.steps(of)
    return PressedBodies(steps.centre, steps.a, Uneven(steps), steps.tilt)


@dataclass(frozen=True)
class _Search:
    """Search for the ends of the contact; fields as the arguments of :func:`press_uneven`. The unknowns are u, with the
    distance beyond the flat ``tiny`` sinh(u)."""

    of: Curvature
    force: float
    moment: float | None
    low: float
    high: float
    tiny: float
    origin: float

    def ends(self, u: Array) -> _Ends:
        left, right = (self.tiny * np.sinh(u)).tolist()
        return _Ends(self.low, self.high, left, right)

    def missing(self, ends: _Ends) -> tuple[Array, Array]:
        """Force, and moment about the line of action of P or tilt, that are missing, (2,), in units of the force and of
        force times a (or of the largest tilt); and their derivatives by the distances (left, right), (2, 2)."""
        steps = ends.steps(self.of)
        by_right, by_left = steps.rates
        off = np.array([self.force - steps.force, -steps.tilt])
        rates = np.array([[-by_left[0], by_right[0]], [-by_left[1], by_right[1]]])
        if self.moment is not None:
            # the pressure that moves one end is singular there: its resultant acts half way to this end
            arms = steps.centre - self.origin + steps.a / 2 * np.array([-1.0, 1.0])
            off[1], rates[1] = -(steps.moment - self.origin * steps.force), arms * rates[0]
        units = np.array([self.force, self.force * steps.a if self.moment is not None else self.force / steps.a])
        return off / units, rates / units[:, None]

    def newton(self, scale: float) -> _Ends | None:
        """Ends by Newton's method; None if it does not converge."""
        low, high = self.of.reach
        u = np.arcsinh(np.array([scale, scale]) / self.tiny)
        most = np.arcsinh(np.array([self.low - low, high - self.high]) / self.tiny)
        for _ in range(_STEPS):
            u = np.minimum(u, most)
            if (ends := self.ends(u)).a <= 0:
                return None
            off, rates = self.missing(ends)
            try:
                step = np.linalg.solve(rates * (self.tiny * np.cosh(u)), off)
            except np.linalg.LinAlgError:
                return None
            u = u + np.clip(step, -_LONGEST, _LONGEST)
            if np.abs(step).max() < _SETTLED or (np.abs(off).max() < _ROUNDING and np.abs(step).max() < 1e-9):
                return self.ends(u) if (u <= most).all() else None
        return None

    def bracketed(self, scale: float) -> _Ends | None:
        """Ends by nested bracketing; None if they are beyond the reach of the gap.

        At a given right end the force grows with the left distance. Along the contacts with the right force, moment and
        tilt grow with the right end.
        """
        from scipy.optimize import brentq  # imports slowly, and Newton's method hardly ever fails

        far = 1e8 * max(scale, self.high - self.low)
        low, high = self.of.reach
        most = np.arcsinh(np.minimum([self.low - low, high - self.high], far) / self.tiny)
        span = self.high - self.low

        def narrowest(distance: float) -> float:
            """u of the other distance at which nothing of the contact is left."""
            return math.asinh(-(span + distance) / self.tiny) + 1e-12

        def left(right: float) -> float:
            def lacks(u: float) -> float:
                ends = self.ends(np.array([u, right]))
                return -1.0 if ends.a <= 0 else -float(self.missing(ends)[0][0])

            least = narrowest(self.tiny * math.sinh(right))
            return float(most[0] if lacks(most[0]) < 0 else brentq(lacks, least, most[0], xtol=1e-14, rtol=1e-15))

        def turned(right: float) -> float:
            return -float(self.missing(self.ends(np.array([left(right), right])))[0][1])

        least = narrowest(self.tiny * math.sinh(most[0])) + 1.0
        if turned(most[1]) < 0 or turned(least) > 0:
            return None
        right = brentq(turned, least, most[1], xtol=1e-14, rtol=1e-15)
        ends = self.ends(np.array([left(right), right]))
        if abs(self.missing(ends)[0][0]) > 1e-6:
            return None
        return ends


class Uneven(Shape):
    """Pressure under half-steps of the slope; scaled as in :mod:`partialslip.halfplane.shape`."""

    even = False

    def __init__(self, steps: _Steps) -> None:
        total = 2 * math.pi * steps.base + float(steps.weights @ punch_force(steps.psi))
        # the resultant of h is pi (2 psi - sin 2 psi)/4; that of p/p0 is pi/2
        self._base, self._weights = 2 * math.pi * steps.base / total, 2 * steps.weights / total
        self._psi, self._side = steps.psi, steps.side
        self._tau = np.tan(steps.psi / 2)
        places = steps.side * np.cos(steps.psi)
        self.kinks = tuple(np.unique(places).tolist())
        strong = np.abs(self._weights) > np.abs(self._weights).sum() / FEW
        self._strong = tuple(np.unique(places[strong]).tolist())

    @property
    def strong_kinks(self) -> tuple[float, ...]:
        return self.kinks if len(self._psi) <= FEW else self._strong

    def pressure(self, x: Array) -> Array:
        inside = np.clip(x, -1.0, 1.0)
        if len(self._psi) <= FEW:
            sums = np.zeros_like(inside)
            for number, weight in enumerate(self._weights.tolist()):
                sums += weight * self._half_step(inside, np.array(number))
        else:
            sums = self._panels(inside)
        return np.where(np.abs(x) < 1, np.maximum(self._base * np.sqrt((1 - inside) * (1 + inside)) + sums, 0.0), 0.0)

    def _half_step(self, x: Array, number: Indices) -> Array:
        """h at ``x`` of the half-steps with the indices ``number``; arrays that broadcast to one shape.

        With t = tan(theta/2) and tau = tan(psi/2), cos(theta) - cos(psi) = 2 (tau^2 - t^2)/((1 + t^2)(1 + tau^2)), and
        the logarithm is 2 artanh of the smaller over the larger of t and tau. Where t > tau, leading terms cancel and
        are left out of both functions.
        """
        x, tau = self._side[number] * x, self._tau[number]
        t = np.sqrt((1 - x) / np.maximum(1 + x, 1e-300))
        inner = t > tau
        ratio = np.where(inner, tau / np.where(inner, t, 1.0), t / np.where(inner | (tau == 0), 1.0, tau))
        ratio = np.minimum(ratio, 1.0)
        square, apart = 1 + t**2, (t - tau) * (t + tau) / (1 + tau**2)
        log = np.where(ratio < 1, _artanh_rest(np.minimum(ratio, 1 - 1e-16)), 0.0)
        within = 2 * t * np.arctan(tau) - 2 * apart * (log + ratio)
        safe = np.where(inner, t, 1.0)
        beyond = 2 * tau**3 * square / (safe * (1 + tau**2)) + 2 * t * _arctan_rest(tau) - 2 * apart * log
        return 2 / square * np.where(inner, beyond, within)

    @property
    def _panels(self) -> Panels:
        if "_made" not in self.__dict__:
            angles = np.arcsin(np.clip(self._side * np.cos(self._psi), -1, 1))
            self._made = Panels((-np.pi / 2, np.pi / 2), angles, self._weights, self._half_step)
        return self._made


def _arctan_rest(z: Array) -> Array:
    """arctan(z) - z without cancellation."""
    return _rest(z, np.arctan(z) - z, -1.0)


def _artanh_rest(z: Array) -> Array:
    """artanh(z) - z without cancellation, for z < 1."""
    return _rest(z, np.arctanh(z) - z, 1.0)


def _rest(z: Array, direct: Array, sign: float) -> Array:
    """sum over k >= 1 of sign^k z^(2 k + 1)/(2 k + 1) for small z, otherwise ``direct``."""
    square, sums = np.minimum(z, _SMALL) ** 2 * sign, np.zeros_like(z)
    for k in range(_SERIES, 0, -1):
        sums = square * (1 / (2 * k + 1) + sums)
    return np.where(z < _SMALL, z * sums, direct)
