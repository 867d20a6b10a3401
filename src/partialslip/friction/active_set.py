"""Convex quadratic programme with bounds and a prescribed sum: the problem of both normal contact and friction."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import scipy.linalg as la

from partialslip.tools.arrays import Array, Indices, Mask, runs, submatrix

Sides = npt.NDArray[np.int8]

_EPS = float(np.finfo(float).eps)
_HALVINGS = 60  # limit: of a step: the last one is below rounding
_MANY = 12  # cost: programmes with one C for which inverting it pays
_REFINEMENTS = 8  # accuracy: most steps of iterative refinement, in which members may still come to a bound
_CHANCES = 3  # cost: iterations in which the number of members on a wrong side need not decrease


@dataclass(frozen=True)
class Solution:
    """Multipliers ``x`` (n,) and certificate.

    ``rest`` (n,) is C x - g - shift: 0 between the bounds, >= 0 at the lower bound and <= 0 at the upper bound.
    ``residual`` (n,) is the distance of each multiplier from the projection of the augmented multiplier, ``imbalance``
    the distance of the sum from the total, both in units of x. ``iterations`` counts the linear solves of the
    active-set iteration, ``changes`` the changes of the active set: 0 if one linear solve sufficed. ``shift`` is the
    rigid one, ``turn`` the angle by which bodies that turn have turned since they were apart.
    """

    x: Array
    rest: Array
    residual: Array
    imbalance: float
    iterations: int
    changes: int = 0
    shift: float = 0.0
    turn: float = 0.0

    def spread(self, where: Indices, count: int) -> "Solution":
        """Solution at ``count`` members from that at the members ``where`` (indices); zero forces at all others."""
        x, rest, residual = (spread(values, where, count) for values in (self.x, self.rest, self.residual))
        return replace(self, x=x, rest=rest, residual=residual)

    @property
    def sides(self) -> Sides:
        """Active bound of each member, (n,): -1 the lower, 0 none, 1 the upper."""
        return (-np.sign(self.rest)).astype(np.int8)


def spread(values: Array, where: Indices, count: int) -> Array:
    """``values`` (k,) at the indices ``where`` of an array (``count``,) of zeros."""
    result = np.zeros(count)
    result[where] = values
    return result


class AffineFamily(NamedTuple):
    """Solutions of one active set, by the rigid shift: ``at(shift)`` is x (n,) and r = C x - g - shift (n,); x has the
    sum ``total`` + ``slope`` shift."""

    total: float
    slope: float
    at: Callable[[float], tuple[Array, Array]]


class Factored:
    """Symmetric positive definite ``C`` (n, n) with factors of its parts, for all programmes with the same C.

    For many programmes C is inverted, once: a factor of as many members as are held then suffices, if these are fewer
    than the free ones, and r, which is zero at free members, needs no product with C. The last factor and the last
    product are remembered.
    """

    def __init__(self, C: Array) -> None:
        self.C = C
        self.diagonal = np.diag(C).copy()
        self._inverse: Array | None = None
        self._uniform: Array = np.empty(0)
        self._last: tuple[Array, Indices] | None = None
        self._product: tuple[Array, Array] | None = None
        self._programmes = 0

    def expect(self, count: int) -> None:
        """Prepare for ``count`` more programmes."""
        self._programmes += count
        if self._programmes > _MANY:
            self._invert()

    @property
    def inverse(self) -> Array:
        """Inverse of C, (n, n)."""
        return self._invert()

    def _invert(self) -> Array:
        if self._inverse is None:
            self._inverse = inverse(self.C)
            self._uniform = self._refined(self._inverse, np.ones(len(self.C)))
        return self._inverse

    def times(self, x: Array) -> Array:
        """C ``x`` (n,)."""
        if self._product is None or self._product[0] is not x:
            self._product = x, self.C @ x
        return self._product[1]

    def remember(self, x: Array, product: Array) -> None:
        """Remember the ``product`` (n,) of C and ``x`` (n,): a load step begins with the forces of the step before."""
        self._product = x, product

    def all_free(self, g: Array) -> Array | None:
        """Solutions of C x = ``g`` (n,) or (n, k), which :meth:`line` can use; None if C has not been inverted."""
        return None if self._inverse is None else self._inverse @ g

    def refined(self, g: Array) -> Array | None:
        """:meth:`all_free` after a step of iterative refinement, for ``g`` of which many programmes take a share: what
        they find then seldom needs one."""
        return None if self._inverse is None else self._refined(self._inverse, g)

    def _refined(self, inverse: Array, g: Array) -> Array:
        x = inverse @ g
        return x + inverse @ (g - self.C @ x)

    def line(self, free: Mask, g: Array, held: Array, all_free: Array | None) -> AffineFamily:
        """Solutions with C x - ``g`` - shift = 0 at the ``free`` members (n,), the others at ``held`` (n,)."""
        others = np.flatnonzero(~free)
        if self._inverse is None or all_free is None or 2 * len(others) > len(free):
            return self._line_of_free(np.flatnonzero(free), g, np.where(free, 0.0, held))
        K, uniform = self._inverse, self._uniform[others]
        first = by = np.empty(0)
        if len(others):
            first, by = self._back(K, others, (held - all_free)[others], -uniform)

        def at(shift: float) -> tuple[Array, Array]:
            r = np.zeros(len(free))
            r[others] = first + shift * by
            x: Array = all_free + shift * self._uniform
            for run in runs(others):
                x += r[run] @ K[run]
            x[others] = held[others]
            return x, r

        return AffineFamily(float(all_free.sum() + uniform @ first), float(self._uniform.sum() + uniform @ by), at)

    def _line_of_free(self, members: Indices, g: Array, held: Array) -> AffineFamily:
        first, by = self._back(self.C, members, (g - self.C @ held)[members], np.ones(len(members)))

        def at(shift: float) -> tuple[Array, Array]:
            x = held.copy()
            x[members] = first + shift * by
            return x, self.C @ x - g - shift

        return AffineFamily(float(held.sum() + first.sum()), float(by.sum()), at)

    def newton(self, free: Mask, gradient: Array) -> Array:
        """Changes of the ``free`` members (n,), k of them, that make their ``gradient`` (k,) vanish."""
        return -self._back(self.C, np.flatnonzero(free), gradient)[0]

    def _back(self, matrix: Array, members: Indices, *loads: Array) -> Array:
        """Solutions of the rows and columns ``members`` of ``matrix`` for ``loads``, (m,) each."""
        if self._last is None or self._last[0] is not matrix or not np.array_equal(self._last[1], members):
            self._factor = _cholesky(submatrix(matrix, members, members))
            self._last = matrix, members
        found, _ = la.lapack.dpotrs(self._factor, np.array(loads).T, lower=True)
        return found.T


def _cholesky(matrix: Array) -> Array:
    """Lower factor of the symmetric ``matrix`` (m, m), which is overwritten. SciPy's wrapper costs more than a small
    factor."""
    factor: Array
    factor, failed = la.lapack.dpotrf(matrix.T, lower=True, clean=False, overwrite_a=True)
    if failed:
        raise la.LinAlgError(f"the leading minor {failed} of the compliance is not positive")
    return factor


def inverse(C: Array) -> Array:
    """Inverse of a symmetric positive definite ``C`` (n, n)."""
    half, _ = la.lapack.dpotri(_cholesky(C.copy()), lower=True, overwrite_c=True)
    half = np.tril(half)
    result: Array = half + half.T
    result[np.diag_indices_from(result)] /= 2
    return result


def solve_bounded(
    C: Array,
    g: Array,
    lower: Array,
    upper: Array,
    total: float,
    start: Sides | None = None,
    factored: Factored | None = None,
    all_free: Array | None = None,
) -> Solution:
    """Minimise x.C x/2 - g.x over lower <= x <= upper with sum(x) = total.

    The multiplier of the sum is a rigid shift. With r = C x - g - shift and any rho > 0, x is optimal if x is the
    projection of the augmented multiplier x - rho r onto the bounds. Block pivoting, with the shift that gives each
    active set the prescribed sum, usually converges in a few iterations. If it does not, a bracketed Newton search on
    the shift follows; at a given shift the iteration converges for every positive definite C. The sum of x grows with
    the shift, piecewise linearly: a Newton step ends at the root or leaves the current piece towards the root. The
    bracket then excludes this piece, and the number of pieces is finite.

    Parameters
    ----------
    C : (n, n) array
        Symmetric positive definite.
    g, lower, upper : (n,) arrays
        ``upper`` may be infinite.
    total : float
        Between sum(lower) and sum(upper).
    start : (n,) int8 array, optional
        Initial active set, from a similar problem (:attr:`Solution.sides`); default: all members are free.
    factored : Factored, optional
        Factors of ``C`` to use and to add to; default: none are known.
    all_free : (n,) array, optional
        Solution of C x = g, where it is known; default: found where C has been inverted.
    """
    factored = factored or Factored(C)
    pivoting = _BlockPivoting(factored, g, lower, upper, start, all_free)
    low, high, shift = -np.inf, np.inf, pivoting.settle(total)
    while True:
        x, r, slope = pivoting.solve(shift)
        excess = float(x.sum() - total)
        if abs(excess) <= _rounding(x, total):
            break
        low, high = (shift, high) if excess < 0 else (low, shift)
        step = -excess / slope if slope > 0 else pivoting.to_next_free(r, excess < 0)
        following = shift + step
        if not low < following < high:
            following = (low + high) / 2
        if following in (low, high, shift) or not np.isfinite(following):
            break  # the sum cannot come closer to the total in this arithmetic
        shift = following
    x, r, shift = pivoting.refined(x, shift, total)
    factored.remember(x, r + g + shift)
    # Any shift certifies x, also the mean that the free members ask for. The shift found has a rounding error, which
    # is a large traction on cells of 1e-9 of the contact.
    fit = r - r[pivoting.free].mean() if pivoting.free.any() else r
    residual = np.abs(x - np.clip(x - fit / pivoting.diagonal, lower, upper))
    rest = np.clip(r, np.where(x < upper, 0.0, -np.inf), np.where(x > lower, 0.0, np.inf))
    imbalance = abs(float(x.sum()) - total)
    return Solution(x, rest, residual, imbalance, pivoting.iterations, pivoting.changes, shift)


def _rounding(x: Array, total: float) -> float:
    """Rounding error of the sum of ``x`` (n,), which is to be ``total``."""
    return len(x) * _EPS * max(float(np.abs(x).sum()), abs(total))


class _BlockPivoting:
    """Minimise x.C x/2 - (g + shift).x over lower <= x <= upper by block pivoting.

    All members that violate their condition change sides at once. This usually converges in a few iterations but may
    cycle. If the number of violations has not decreased for three iterations, projected Newton steps take over
    (Bertsekas, 1982): from a feasible point towards the minimum of its active set, clipped to the bounds, as far as the
    objective decreases. No active set recurs, as the objective decreases in each step. When it cannot decrease further,
    the remaining residual is rounding.
    """

    def __init__(
        self,
        factored: Factored,
        g: Array,
        lower: Array,
        upper: Array,
        start: Sides | None,
        all_free: Array | None = None,
    ) -> None:
        self._factored, self._C, self.diagonal = factored, factored.C, factored.diagonal
        self._g, self._lower, self._upper = g, lower, upper
        self._all_free = factored.all_free(g) if all_free is None else all_free
        self._side = np.zeros(len(g), dtype=np.int8)  # -1 at the lower bound, 0 free, +1 at the upper
        if start is not None and (start == 0).any():
            self._side[:] = start
        self._line: AffineFamily | None = None  # of the present sides
        self._tried: tuple[float, Array, Array, Sides] | None = None  # a shift, with what it gives on these sides
        self.iterations = self.changes = 0

    def settle(self, total: float) -> float:
        """Return the shift that gives the ``total``, updating the active set with the shift in each iteration until no
        member changes sides or the number of changes stops decreasing."""
        fewest, chances, shift = len(self._g) + 1, _CHANCES, 0.0
        while True:
            line = self._solutions()
            if line.slope <= 0:
                return shift
            shift = (total - line.total) / line.slope
            _, _, wanted = self._solution_and_sides(shift)
            wrong = int(np.count_nonzero(wanted != self._side))
            if wrong < fewest:
                fewest, chances = wrong, _CHANCES
            else:
                chances -= 1
            if wrong == 0 or chances < 0:
                return shift
            self._turn(wanted)

    @property
    def free(self) -> Mask:
        """Members between the bounds, (n,)."""
        return self._side == 0

    def to_next_free(self, r: Array, more: bool) -> float:
        """With every member at a bound: free the first member that changes as the shift grows (``more``) or falls;
        return the change of the shift up to this point."""
        steps = np.where(self._side == (-1 if more else 1), np.abs(r), np.inf)
        nearest = int(np.argmin(steps))
        sides = self._side.copy()
        sides[nearest] = 0
        self._change(sides)
        return float(steps[nearest] if more else -steps[nearest])

    def solve(self, shift: float) -> tuple[Array, Array, float]:
        """Minimiser x (n,) at the ``shift``, r = C x - g - shift (n,), and the derivative of sum(x) by the shift."""
        fewest, chances = len(self._g) + 1, _CHANCES
        while True:
            x, r, wanted = self._solution_and_sides(shift)
            wrong = np.flatnonzero(wanted != self._side)
            if len(wrong) == 0:
                return x, r, self._solutions().slope
            if len(wrong) < fewest:
                fewest, chances = len(wrong), _CHANCES
            elif chances > 0:
                chances -= 1
            else:
                return self._descend(x, shift)
            self._turn(wanted)

    def refined(self, x: Array, shift: float, total: float) -> tuple[Array, Array, float]:
        """x within the bounds, r and the shift, after iterative refinement where an inverse has left more than
        rounding.

        Refinement may take free members beyond a bound that they nearly touch. These stay on the bound, and the others
        are refined again: otherwise the sum would be off, and a rigid shift of all free members would look like slip.
        """
        free, rounds = self._side == 0, 0
        while True:
            found, x = x, np.clip(x, self._lower, self._upper)
            free = free & (x == found)
            r, missing = self._C @ x - self._g - shift, total - float(x.sum())
            if self._all_free is None or not free.any() or rounds == _REFINEMENTS:
                return x, r, shift
            off = bool((2 * np.abs(r) > self._noise(x, shift))[free].any())
            if rounds and (np.array_equal(x, found) or not (off or abs(missing) > _rounding(x, total))):
                return x, r, shift
            if not rounds and not off:
                return x, r, shift
            load = np.where(free, -r, 0.0)
            line = self._factored.line(free, load, 0 * x, self._factored.all_free(load))
            change = (missing - line.total) / line.slope
            x, shift, rounds = x + line.at(change)[0], shift + change, rounds + 1

    def _descend(self, x: Array, shift: float) -> tuple[Array, Array, float]:
        """The same as :meth:`solve` by projected Newton steps, beginning near ``x``.

        Members that their own gradient step would take to a bound move to the bound; the others take the Newton step of
        the current gradient. Both directions decrease the objective, and no step stops just before a bound.
        """
        at = np.clip(x, self._lower, self._upper)
        while True:
            r = self._C @ at - self._g - shift
            sides = self._wanted(at, r, shift)
            self._change(sides)
            slope = self._solutions().slope
            x, new, wanted = self._solution_and_sides(shift)
            if np.array_equal(wanted, sides):
                return x, new, slope
            free, way = sides == 0, x - at
            if free.any():
                way[free] = self._factored.newton(free, r[free])
            noise = self._noise(at, shift)
            for halvings in range(_HALVINGS):
                step = np.clip(at + 0.5**halvings * way, self._lower, self._upper) - at
                if step @ r + step @ self._C @ step / 2 < -np.abs(step) @ noise:
                    break
            else:
                return at, r, slope
            if np.all(self.diagonal * np.abs(step) <= noise):
                return at, r, slope
            at = at + step

    def _wanted(self, x: Array, r: Array, shift: float) -> Sides:
        """The sides that x and r require, within rounding."""
        noise = self._noise(x, shift) / self.diagonal
        augmented = x - r / self.diagonal
        above, below = augmented > self._upper + noise, augmented < self._lower - noise
        return above.astype(np.int8) - below

    def _noise(self, x: Array, shift: float) -> Array:
        r"""Rounding error of the residual r = C x - g - shift: 4 eps (C_ii sum \|x\| + \|g\| + \|shift\|), (n,)."""
        return 4 * _EPS * (self.diagonal * np.abs(x).sum() + np.abs(self._g) + abs(shift))

    def _turn(self, wanted: Sides) -> None:
        """Move members to the ``wanted`` sides; a member at the other bound is freed first."""
        self._change(np.where((self._side == 0) | (wanted == self._side), wanted, 0))

    def _change(self, sides: Sides) -> None:
        if not np.array_equal(sides, self._side):
            self._side, self._line, self._tried = sides, None, None
            self.changes += 1

    def _solution_and_sides(self, shift: float) -> tuple[Array, Array, Sides]:
        """x of the present sides at the ``shift``, r, and the sides that they require."""
        if self._tried is None or self._tried[0] != shift:
            x, r = self._solutions().at(shift)
            self._tried = shift, x, r, self._wanted(x, r, shift)
        return self._tried[1:]

    def _solutions(self) -> AffineFamily:
        """Solutions with members at bounds held there, by the shift."""
        if self._line is None:
            self.iterations += 1
            free = self._side == 0
            held = np.where(self._side < 0, self._lower, self._upper)
            self._line = (
                self._factored.line(free, self._g, held, self._all_free)
                if free.any()
                else AffineFamily(float(held.sum()), 0.0, lambda shift: (held, self._C @ held - self._g - shift))
            )
        return self._line
