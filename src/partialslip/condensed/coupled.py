"""Two bodies that are not mirror images: pressure moves them along x, and shear opens the gap.

Scaled as in :mod:`partialslip.condensed.friction`. Relative displacements of the surfaces, the upper body's less the
lower's along x and apart along y, under normal forces p and tangential forces q (of the lower body on the upper one):

    u = C_xx q + C_xy p,    v = C_xy^T q + C_yy p.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
import scipy.linalg as la

from partialslip.condensed.bounded import Sides, Solution, solve_bounded
from partialslip.condensed.friction import History, Path, follow, resting
from partialslip.result import Array

_ROUNDING = 16 * float(np.finfo(float).eps)
_PATIENCE = 4  # iterations without progress before another way is taken


@dataclass(frozen=True)
class Relative:
    """Relative compliances (n, n) of two bodies' contact nodes; ``xy`` is None where it vanishes or is left out, and
    so is ``xx`` without friction."""

    xx: Array | None
    yy: Array
    xy: Array | None


@dataclass(frozen=True)
class _Step:
    """One step's problem: p presses with ``P`` against ``gap`` (n,); q sums to ``Q`` and, where nothing slips, keeps
    the relative displacement along x at ``kept`` (n,), but for a rigid shift."""

    xx: Array
    yy: Array
    xy: Array
    f: float
    P: float
    gap: Array
    Q: float
    kept: Array

    def sweep(self, p: Solution, q: Solution) -> tuple[Solution, Solution]:
        """One iteration of the fixed point: p for the old q, then q for that p, a convex problem each."""
        n, pushed = len(self.gap), self.gap + self.xy.T @ q.x
        pressed = solve_bounded(self.yy, -pushed, np.zeros(n), np.full(n, np.inf), self.P, p.sides)
        on = np.flatnonzero(pressed.x > 0)
        bound = self.f * pressed.x[on]
        free = (self.kept - self.xy @ pressed.x)[on]
        held = solve_bounded(self.xx[np.ix_(on, on)], free, -bound, bound, self.Q, q.sides[on])
        x, rest, residual = (_spread(values, on, n) for values in (held.x, held.rest, held.residual))
        sheared = replace(held, x=x, rest=rest, residual=residual)
        moved = self.xy.T @ (sheared.x - q.x)  # what p does not know of yet
        return replace(pressed, residual=np.abs(moved - moved[on].mean()) / np.diag(self.yy)), sheared

    def newton(self, p: Solution, q: Solution) -> tuple[Solution, Solution] | None:
        """Solve for p and q together, in the partition of those given, until it is its own; None if that fails."""
        touch, slip = p.x > 0, q.sides * (p.x > 0)
        fewest, chances, iteration = 2 * len(touch), _PATIENCE, 0
        while chances > 0:
            iteration += 1
            if not (touch & (slip == 0)).any():
                return None
            p_new, q_new, opening, rest, scale = self._face(touch, slip)
            noise = _ROUNDING * scale
            pushed = p_new - opening / np.diag(self.yy)
            augmented, bound = q_new - rest / np.diag(self.xx), self.f * p_new
            touches = pushed > noise[0]
            slips = touches * ((augmented > bound + noise[1]).astype(np.int8) - (augmented < -bound - noise[1]))
            if np.array_equal(touches, touch) and np.array_equal(slips, slip):
                zero = np.zeros(len(self.gap))
                p_off, q_off = (abs(float(x.sum()) - total) for x, total in ((p_new, self.P), (q_new, self.Q)))
                p_in, q_in = np.maximum(p_new, 0.0), np.clip(q_new, -bound, bound)
                p_rest, q_rest = np.where(touch, 0.0, np.maximum(opening, 0.0)), np.where(slip == 0, 0.0, rest)
                p_left = np.abs(p_new - np.maximum(pushed, 0.0)) + np.abs(p_new - p_in)
                q_left = np.where(touch, np.abs(q_new - np.clip(augmented, -bound, bound)), zero)
                return (
                    Solution(p_in, p_rest, p_left, p_off, iteration, iteration - 1),
                    Solution(q_in, q_rest, q_left, q_off, 0),
                )
            wrong = int((touches != touch).sum() + (slips != slip).sum())
            chances = _PATIENCE if wrong < fewest else chances - 1
            touch, slip, fewest = touches, slips, min(wrong, fewest)
        return None

    def _face(self, touch: npt.NDArray[np.bool_], slip: Sides) -> tuple[Array, ...]:
        """p and q of one partition: what touches neither opens nor overlaps, what sticks does not move, and q = slip
        f p where it slips."""
        on, sticks = np.flatnonzero(touch), np.flatnonzero(touch & (slip == 0))
        i, end = len(on), len(on) + len(sticks)
        dragged = self.f * slip[on]
        matrix, right = np.zeros((end + 2, end + 2)), np.zeros(end + 2)
        matrix[:i, :i] = self.yy[np.ix_(on, on)] + self.xy[np.ix_(on, on)].T * dragged
        matrix[:i, i:end] = self.xy[np.ix_(sticks, on)].T
        matrix[i:end, :i] = self.xx[np.ix_(sticks, on)] * dragged + self.xy[np.ix_(sticks, on)]
        matrix[i:end, i:end] = self.xx[np.ix_(sticks, sticks)]
        matrix[:i, -2] = matrix[i:end, -1] = -1  # rigid shifts
        matrix[-2, :i] = 1
        matrix[-1, :i], matrix[-1, i:end] = dragged, 1
        right[:i], right[i:end], right[-2:] = -self.gap[on], self.kept[sticks], (self.P, self.Q)
        factors = la.lu_factor(matrix, check_finite=False)
        solution = la.lu_solve(factors, right, check_finite=False)
        solution += la.lu_solve(factors, right - matrix @ solution, check_finite=False)
        p, q, (approach, shift) = np.zeros(len(self.gap)), np.zeros(len(self.gap)), solution[-2:]
        p[on] = solution[:i]
        q[on] = dragged * p[on]
        q[sticks] = solution[i:end]
        opening = self.yy @ p + self.xy.T @ q + self.gap - approach
        rest = self.xx @ q + self.xy @ p - self.kept - shift
        total = np.abs(p).sum() + np.abs(q).sum()
        scale = total + np.stack(
            [
                (np.abs(self.gap) + abs(approach)) / np.diag(self.yy),
                (np.abs(self.kept) + abs(shift)) / np.diag(self.xx),
            ]
        )
        return p, q, opening, rest, scale


def march(
    C: Relative, gap: Array, stretch: Array, f: float, path: Path, pressed: Array | None = None
) -> tuple[History, Solution]:
    """Press the bodies together and go along the path; the history, and the normal forces at load point 2 with the
    residuals of all steps.

    Friction acts while the bodies are pressed together, too, in as many steps as the path has from point to point.

    Parameters
    ----------
    C : Relative
    gap : (n,) array
        Gap before loading.
    stretch : (2, n) array
        Displacements of the lower surface, along x and y, under the tension that strains a long body by 1.
    f : float
        Coefficient of friction.
    path : Path
    pressed : (n,) array, optional
        Normal forces where the path does not begin with bodies apart.
    """
    assert C.xx is not None
    xx, xy = C.xx, C.xy if C.xy is not None else 0 * C.xx
    done = [
        (resting(0 * gap if pressed is None else pressed), resting(0 * gap if path.before is None else path.before))
    ]
    cycle = sum(len(way) for way in path.fractions[1:])
    gap = gap - path.begin[1] * stretch[1]

    def advance(before: Solution, Q: float, strain: float, P: float = 1.0) -> tuple[Solution, Array]:
        nonlocal gap
        gap = gap - strain * stretch[1]
        kept = xx @ before.x + xy @ done[-1][0].x + strain * stretch[0]
        starts = [done[-1], *done[-cycle : 1 - cycle]]  # the step before, and this one a cycle ago
        pressed, sheared = _solve(_Step(xx, C.yy, xy, f, P, gap, Q, kept), starts)
        done.append((replace(pressed, residual=np.maximum(pressed.residual, sheared.residual / f)), sheared))
        return sheared, f * pressed.x

    q = done[0][1]
    for P in np.linspace(0, 1, path.substeps + 1)[1:].tolist() if pressed is None else ():
        q, _ = advance(q, 0.0, 0.0, P)
    history = follow(path, advance, q)
    last, _ = done[-cycle:][sum(len(way) for way in path.fractions[1 : path.ends[1] + 2]) - 1]
    return history, replace(
        last,
        residual=np.max([pressed.residual for pressed, _ in done], axis=0),
        imbalance=max(pressed.imbalance for pressed, _ in done),
        iterations=sum(pressed.iterations for pressed, _ in done),
        changes=sum(pressed.changes + sheared.changes for pressed, sheared in done),
    )


def _solve(step: _Step, starts: Sequence[tuple[Solution, Solution]]) -> tuple[Solution, Solution]:
    """Newton's iteration on all of the conditions, from the partitions of what may be near, until one is its own. If
    none is, a sweep of the fixed point, which contracts for all but the largest friction, brings a better one; if that
    does not help, either, rounding has stopped the sweeps."""
    iterations, changes, least, chances = 0, 0, np.inf, _PATIENCE
    while chances > 0:
        for p, q in reversed(starts):
            if (p.x > 0).any() and (together := step.newton(p, q)):
                p, q = together
                return p, replace(q, iterations=iterations, changes=changes)
        p, q = step.sweep(*starts[0])
        starts = [(p, q)]
        iterations += p.iterations + q.iterations
        changes += p.changes + q.changes
        left = float(p.residual.max())
        chances = _PATIENCE if left < least else chances - 1
        least = min(left, least)
    return replace(p, iterations=0, changes=0), replace(q, iterations=iterations, changes=changes)


def _spread(values: Array, where: npt.NDArray[np.int64], count: int) -> Array:
    result = np.zeros(count)
    result[where] = values
    return result
