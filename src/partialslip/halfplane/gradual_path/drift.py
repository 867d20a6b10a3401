"""Drift: a stick zone of constant half-width c moves to the left. Scaled as in :mod:`partialslip.halfplane.shape`.

The rate of q, (dsigma/4) sqrt((2c - u)/u) at the distance u from the right end, vanishes at the left end, where the
zone takes points back that were on the friction bound. Points leave at the right end. With the travel
tau = (e0 - e)/(2c) and h = d(lambda)/d(tau), the point that leaves at the travel t satisfies

    (dsigma/4) int_{max(0, t-1)}^t sqrt((1 - u)/u) h(tau) d(tau) = p - q_start,     u = t - tau,

a Volterra equation of Abel's type. h has half-integer powers of tau at 0, and logarithms at tau = 1.
"""

import functools
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from partialslip.halfplane.gradual_path.graded import DEGREES, RESTS, SHARES, at_share, integrals, powers, spans
from partialslip.tools.arrays import Array

_WIDTHS = 4  # accuracy: of the zone, after which a break of its beginning is seen no more
# accuracy: last coefficients of h above which a panel is halved, and panels that are not
_TAIL, _SHORTEST = 5e-10, 0.02

_Solver = Callable[[Array], Array]


class Drift:
    """Drift of a stick zone.

    Parameters
    ----------
    tension : float
        dsigma of the whole half cycle.
    lacking : callable
        ``lacking(tau, rest)``: p - q_start at the points (k,) that leave at the travel ``tau``; ``rest`` = 1 - tau. For
        tau > 1 these points were taken back during the drift.
    breaks : list of float
        Travels at which ``lacking`` is not smooth.
    farthest : float
        Travel up to which ``lacking`` is known.
    """

    def __init__(
        self, tension: float, lacking: Callable[[Array, Array], Array], breaks: list[float], farthest: float
    ) -> None:
        self._tension, self._lacking = tension, lacking
        after = [each + later for each in breaks for later in range(1, _WIDTHS)]  # seen again whole widths later
        inner = sorted(each for each in {*breaks, *after, *np.arange(1.0, farthest)} if 0 < each < farthest)
        self._ends = [0.0, *inner, farthest] if farthest > 1 else [0.0, *(each for each in inner if each < 1), 1.0]
        self._densities: list[Array] = []  # coefficients of h by panel
        self._progress = [0.0]  # lambda at the ends of panels, from the beginning of the drift

    @property
    def ends(self) -> list[float]:
        """Travels at which h is not smooth, as far as it is known, and others between."""
        return self._ends[: len(self._densities) + 1]

    def progress(self, tau: float) -> float:
        """lambda from the beginning of the drift to the travel ``tau``."""
        while self._ends[len(self._densities)] < tau:
            self._solve_panel()
        number = max(int(np.searchsorted(self._ends, tau)) - 1, 0)
        if not self._densities:
            return 0.0
        low, high = self._ends[number : number + 2]
        s, _ = at_share(np.array((tau - low) / (high - low)), np.array((high - tau) / (high - low)))
        return self._progress[number] + float(integrals(s) @ self._densities[number])

    def travel(self, progress: float, most: float) -> float:
        """Travel at which lambda has grown by ``progress`` since the beginning; ``most`` if it grows less up to it."""
        from scipy.optimize import brentq  # takes long to import

        while self._progress[-1] < progress and self._ends[len(self._densities)] < most:
            self._solve_panel()
        number = max(int(np.searchsorted(self._progress, progress)) - 1, 0)
        low, high = self._ends[number], min(self._ends[number + 1], most)
        if progress <= 0:
            return 0.0
        if self.progress(high) <= progress:
            return float(high)  # the steady zone stops at a break, where the right end stood before
        return brentq(lambda tau: self.progress(tau) - progress, low, high, xtol=1e-16, rtol=1e-15)

    def accumulated(self, place_: Array, tau: float) -> Array:
        """Change of q during the drift to the travel ``tau``, at places (k,): distances to the left from the zone's
        first left end, over 2c."""
        self.progress(tau)
        result = np.zeros_like(place_)
        begin, end = np.maximum(place_, 0.0), np.minimum(tau, place_ + 1)
        for low, high, density in zip(self._ends, self._ends[1:], self._densities, strict=False):
            first, last = np.maximum(begin, low), np.minimum(end, high)
            here = np.flatnonzero(last > first)
            if not len(here):
                continue
            # most points see the panel from its beginning up to one travel: the density there is computed once
            first, last, at = first[here], last[here], place_[here]
            seen, which = np.unique(first + 1j * last, return_inverse=True)
            from_first, to_last, weights = spans(seen.real, seen.imag)
            share, rest = (seen.real - low)[:, None] + from_first, (high - seen.imag)[:, None] + to_last
            s, slope = at_share(share / (high - low), rest / (high - low))
            weights *= np.polynomial.chebyshev.chebval(2 * s - 1, density) / slope / (high - low)
            left, right = (first - at)[:, None] + from_first[which], (at + 1 - last)[:, None] + to_last[which]
            result[here] += np.einsum("ki,ki->k", weights[which], np.sqrt(left / right))
        return self._tension / 4 * result

    def _solve_panel(self) -> None:
        """Find h on the next panel."""
        number = len(self._densities)
        low, high = self._ends[number : number + 2]
        lacking = self._lacking(low + (high - low) * SHARES, (1 - high) + (high - low) * RESTS)
        target = 4 / self._tension * lacking
        for first, last, density in zip(self._ends, self._ends[1:], self._densities, strict=False):
            if last > low - 1:
                target = target - _earlier(last - first, high - low, low - last) @ density
        density = _own(high - low)(target)
        if np.abs(density[-2:]).max() > _TAIL and high - low > _SHORTEST:
            self._ends.insert(number + 1, (low + high) / 2)
            return
        self._densities.append(density)
        self._progress.append(self._progress[-1] + float(integrals(np.array(1.0)) @ density))


def _density(share: Array, rest: Array) -> Array:
    """Basis of h on a panel of unit length, (..., degrees): polynomials in s over d(share)/ds, smooth where h is
    integrated."""
    s, slope = at_share(share, rest)
    return powers(s) / slope[..., None]


@functools.lru_cache(maxsize=16)
def _own(length: float) -> _Solver:
    """Solver for the coefficients of h on a panel of this ``length`` whose integrals over it are given at its nodes."""
    low, high, weights = spans(0 * SHARES, SHARES)
    near = (1 - length) + length * (RESTS[:, None] + low)  # 1 - u
    kernel = weights * np.sqrt(near / (length * high))
    matrix = np.einsum("ik,ikj->ij", kernel, _density(low, RESTS[:, None] + high))
    inverse: npt.NDArray[np.float64] = np.linalg.inv(matrix)
    return lambda target: inverse @ target


@functools.lru_cache(maxsize=32)
def _earlier(length: float, later: float, gap: float) -> Array:
    """Matrix from the coefficients of h on a panel of this ``length`` to the integrals over it, at the nodes of a panel
    of the length ``later``, which begins by ``gap`` after its end."""
    since = gap + later * SHARES  # from the panel's end
    begin = np.clip(since + length - 1, 0.0, length)  # the earlier part of the panel is more than 1 away
    result = np.zeros((len(since), DEGREES))
    near = begin < length
    begin, since = begin[near], since[near]
    from_low, from_high, weights = spans(begin, np.full(len(since), length))
    apart = np.maximum(begin - (since + length - 1), 0.0)[:, None] + from_low  # 1 - u
    kernel = weights * np.sqrt(apart / (since[:, None] + from_high)) / length
    result[near] = np.einsum("ik,ikj->ij", kernel, _density((begin[:, None] + from_low) / length, from_high / length))
    return result
