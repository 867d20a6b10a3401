"""The one problem that normal contact and friction share: a convex quadratic programme with bounds and a sum."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy.linalg as la

from partialslip.arrays import Array

Sides = npt.NDArray[np.int8]

_EPS = float(np.finfo(float).eps)
_HALVINGS = 60  # of a step, after which less than rounding is left of it
_CHANCES = 3  # rounds in which the members on a wrong side may not have become fewer


@dataclass(frozen=True)
class Solution:
    """Multipliers ``x`` and what certifies them.

    ``rest`` (n,) is C x - g - shift: zero between the bounds, what a bound holds back elsewhere, at the lower one
    never negative and at the upper one never positive. ``residual`` (n,) is the distance of each multiplier from its
    augmented projection, ``imbalance`` that of the sum from the total, both in units of x; ``iterations`` counts the
    faces solved, and ``changes`` how often members changed sides: never where a linear solve was all that it took.
    """

    x: Array
    rest: Array
    residual: Array
    imbalance: float
    iterations: int
    changes: int = 0

    @property
    def sides(self) -> Sides:
        """Which bound holds each member back, (n,): -1 the lower, 0 neither, 1 the upper."""
        return (-np.sign(self.rest)).astype(np.int8)


def solve_bounded(C: Array, g: Array, lower: Array, upper: Array, total: float, start: Sides | None = None) -> Solution:
    """Minimise x.C x/2 - g.x over lower <= x <= upper with sum(x) = total.

    The multiplier of the sum is a rigid shift. With it the conditions read, for r = C x - g - shift and any
    rho > 0: x is the projection of the augmented multiplier x - rho r onto the bounds. Block pivoting solves them with
    the shift that each face needs for its sum, in a few rounds as a rule. Should these not end, it goes on at a given
    shift, where it ends for every positive definite C. Their sum(x) grows with the shift, piecewise linearly: a Newton
    step ends at the root or leaves its piece towards the root, so that the bracket shuts that piece out, and there are
    finitely many.

    Parameters
    ----------
    C : (n, n) array
        Symmetric positive definite.
    g, lower, upper : (n,) arrays
        ``upper`` may be infinite.
    total : float
        Between sum(lower) and sum(upper).
    start : (n,) int8 array, optional
        Sides to begin with, those of a problem like this one (:attr:`Solution.sides`); otherwise all are free.
    """
    pivoting = _BlockPivoting(C, g, lower, upper, start)
    low, high, shift = -np.inf, np.inf, pivoting.settle(total)
    while True:
        x, r, slope = pivoting.solve(shift)
        excess = float(x.sum() - total)
        if abs(excess) <= len(x) * _EPS * max(float(np.abs(x).sum()), abs(total)):
            break
        low, high = (shift, high) if excess < 0 else (low, shift)
        step = -excess / slope if slope > 0 else pivoting.to_next_free(r, excess < 0)
        following = shift + step
        if not low < following < high:
            following = (low + high) / 2
        if following in (low, high, shift) or not np.isfinite(following):
            break  # the sum cannot come closer to the total in this arithmetic
        shift = following
    found, x = x, np.clip(x, lower, upper)  # but for rounding it is within; whatever the clip does is to be certified
    r = r + C @ (x - found)
    residual = np.abs(x - np.clip(x - r / np.diag(C), lower, upper))
    rest = np.clip(r, np.where(x < upper, 0.0, -np.inf), np.where(x > lower, 0.0, np.inf))
    return Solution(x, rest, residual, abs(float(x.sum()) - total), pivoting.iterations, pivoting.changes)


class _BlockPivoting:
    """Minimise x.C x/2 - (g + shift).x over lower <= x <= upper.

    All members that violate their condition change sides at once, which takes a few rounds as a rule but may go round
    in circles. If their number has not fallen for three rounds, projected Newton steps take over (Bertsekas 1982):
    from a point within the bounds to the minimum of its face, clipped, as far as the objective falls. It falls each
    time, so that no face comes back, and what is left of the conditions when it cannot fall any more is rounding.
    """

    def __init__(self, C: Array, g: Array, lower: Array, upper: Array, start: Sides | None) -> None:
        self._C, self._g, self._lower, self._upper = C, g, lower, upper
        self._diagonal = np.diag(C).copy()
        self._side = np.zeros(len(g), dtype=np.int8)  # -1 at the lower bound, 0 free, +1 at the upper
        if start is not None and (start == 0).any():
            self._side[:] = start
        self._factored: npt.NDArray[np.bool_] | None = None
        self.iterations = self.changes = 0

    def settle(self, total: float) -> float:
        """The shift that gives the total with the sides to begin with, and then with those that it calls for in turn,
        until they call for no others or their number does not fall any more."""
        fewest, chances, shift = len(self._g) + 1, _CHANCES, 0.0
        while True:
            at_zero, slope = self._face(0.0)
            if slope <= 0:
                return shift
            shift = float((total - at_zero.sum()) / slope)
            x = at_zero
            x[self._side == 0] += shift * self._growth
            _, wanted = self._conditions(x, shift)
            wrong = int(np.count_nonzero(wanted != self._side))
            if wrong < fewest:
                fewest, chances = wrong, _CHANCES
            else:
                chances -= 1
            if wrong == 0 or chances < 0:
                return shift
            self._turn(wanted)

    def to_next_free(self, r: Array, more: bool) -> float:
        """With every member at a bound: free the nearest one that can give more (or less); the shift to it."""
        steps = np.where(self._side == (-1 if more else 1), np.abs(r), np.inf)
        nearest = int(np.argmin(steps))
        self._side[nearest] = 0
        self.changes += 1
        return float(steps[nearest] if more else -steps[nearest])

    def solve(self, shift: float) -> tuple[Array, Array, float]:
        """The minimiser, its r = C x - g - shift, and how fast its sum grows with the shift."""
        fewest, chances = len(self._g) + 1, _CHANCES
        while True:
            x, slope = self._face(shift)
            r, wanted = self._conditions(x, shift)
            wrong = np.flatnonzero(wanted != self._side)
            if len(wrong) == 0:
                return x, r, slope
            if len(wrong) < fewest:
                fewest, chances = len(wrong), _CHANCES
            elif chances > 0:
                chances -= 1
            else:
                return self._descend(x, shift)
            self._turn(wanted)

    def _descend(self, x: Array, shift: float) -> tuple[Array, Array, float]:
        """The same by projected Newton steps, from near ``x``.

        Members that their gradient alone would take to a bound go straight there, the others by Newton's step at what
        the gradient is now: both ways are downhill, and none stops right before a bound.
        """
        at = np.clip(x, self._lower, self._upper)
        while True:
            r, sides = self._conditions(at, shift)
            self._change(sides)
            x, slope = self._face(shift)
            new, wanted = self._conditions(x, shift)
            if np.array_equal(wanted, sides):
                return x, new, slope
            free, way = sides == 0, x - at
            if free.any():
                way[free] = -la.cho_solve(self._factor, r[free], check_finite=False)
            noise = self._noise(at, shift)
            for halvings in range(_HALVINGS):
                step = np.clip(at + 0.5**halvings * way, self._lower, self._upper) - at
                if step @ r + step @ self._C @ step / 2 < -np.abs(step) @ noise:
                    break
            else:
                return at, r, slope
            if np.all(self._diagonal * np.abs(step) <= noise):
                return at, r, slope
            at = at + step

    def _conditions(self, x: Array, shift: float) -> tuple[Array, Sides]:
        """r, and the sides that x and r call for, rounding aside."""
        r = self._C @ x - self._g - shift
        noise = self._noise(x, shift) / self._diagonal
        augmented = x - r / self._diagonal
        above, below = augmented > self._upper + noise, augmented < self._lower - noise
        return r, above.astype(np.int8) - below

    def _noise(self, x: Array, shift: float) -> Array:
        """What rounding makes of r."""
        noise: Array = 4 * _EPS * (self._diagonal * np.abs(x).sum() + np.abs(self._g) + abs(shift))
        return noise

    def _turn(self, wanted: Sides) -> None:
        """Members turn to the sides that are called for: from one bound to the other by way of neither."""
        self._change(np.where((self._side == 0) | (wanted == self._side), wanted, 0))

    def _change(self, sides: Sides) -> None:
        self.changes += not np.array_equal(sides, self._side)
        self._side = sides

    def _face(self, shift: float) -> tuple[Array, float]:
        """Minimise with the bound members held: x, and the growth of its sum with the shift."""
        self.iterations += 1
        free = self._side == 0
        x = np.select([self._side < 0, self._side > 0], [self._lower, self._upper], 0.0)
        if not free.any():
            return x, 0.0
        if self._factored is None or not np.array_equal(free, self._factored):
            self._factored = free
            self._factor = la.cho_factor(self._C[np.ix_(free, free)], check_finite=False)
            self._growth = la.cho_solve(self._factor, np.ones(free.sum()), check_finite=False)
        x[free] = la.cho_solve(self._factor, (self._g + shift - self._C @ x)[free], check_finite=False)
        return x, float(self._growth.sum())
