"""Contact of two bodies that are not mirror images: pressure moves the surfaces along x, and shear opens the gap.

Scaled as in :mod:`partialslip.friction.history`. The surfaces' relative displacements u (upper body less lower body,
along x) and v (opening, along y) under normal forces p and tangential forces q (of the lower body on the upper one):

    u = C_xx q + C_xy p,    v = C_xy^T q + C_yy p.
"""

import itertools
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.linalg as la

from partialslip.arrays import Array, Mask, submatrix
from partialslip.friction.active_set import Sides, Solution, solve_bounded
from partialslip.friction.history import History, certified, follow, resting, still
from partialslip.friction.partition import Factors, Forces, longest
from partialslip.friction.path import Path
from partialslip.friction.pressing import Pressed, Punch, Punches, Stages
from partialslip.friction.trail import Trail
from partialslip.friction.zone_ends import CORNER

_ROUNDING = 16 * float(np.finfo(float).eps)
_STICKS = 1e-9  # accuracy: relative tolerance of the friction bound and of lengths
_TIMES = 2  # accuracy: iterations of the half-width in self-similar pressing
_PUNCHES = np.array([1.0, 0.5, 0.25])  # half-widths of flat punches on bodies of a size, in that of the contact
_ROUGH = 0.1  # accuracy: largest error of q for which these are used
_SETTLED = 1e-3  # accuracy: error of the half-width of the largest punch that is left
_FAR = 10.0  # accuracy: gap, in half-widths, that stays open
_ENDS = 15.0  # accuracy: tolerance of q over tolerance of the ends
_MOST, _WORK = 64, 16_000  # limit: steps of pressing, and of steps times nodes
_ANEW = "anew"  # key of steps that do not begin where others did
_PATIENCE = 4  # cost: iterations without progress before the method changes
_CLOSE = 32  # cost: changes of sides in an iteration without progress below which rounding errors may matter

Pair = tuple[Solution, Solution]
_Press = Callable[..., Pair]  # one step: force, gap, kept, where to begin, and its key
_Solver = Callable[[Array, Array], Forces]  # forces for the displacements (2, n) that sum to the totals (2,)


@dataclass(frozen=True)
class Relative:
    """Relative compliances (n, n) of the contact nodes of two bodies.

    ``xx``, ``yy`` and ``xy`` are C_xx, C_yy and C_xy; ``xx`` is None without friction, ``xy`` None if it vanishes or is
    neglected. ``yx`` gives the opening of the gap by q; default: the transpose of ``xy``, by reciprocity. It is zero in
    Goodman's approximation.
    """

    xx: Array | None
    yy: Array
    xy: Array | None
    yx: Array | None = None

    @property
    def opening(self) -> Array:
        """``yx``, by default from reciprocity."""
        assert self.xy is not None
        return self.xy.T if self.yx is None else self.yx

    def moved(self, p: Array, q: Array) -> tuple[Array, Array]:
        """Relative displacements (n,) along x, and opening along y, under the forces ``p`` and ``q`` (n,)."""
        assert self.xx is not None
        assert self.xy is not None
        return self.xx @ q + self.xy @ p, self.yy @ p + self.opening @ q

    @cached_property
    def factors(self) -> Factors | None:
        """Factors of all of them, with friction and coupling; None if they are not symmetric."""
        return Factors(self) if self.yx is None else None


@dataclass(frozen=True)
class _Step:
    """Problem of one load step with friction ``f`` (n,): p sums to ``P`` over the ``gap`` (n,) before loading, q sums
    to ``Q``, and nodes that stick have the relative displacement ``kept`` (n,) along x, up to a rigid shift.
    ``factors`` are those of the compliances, which many steps share."""

    xx: Array
    yy: Array
    xy: Array
    yx: Array
    f: Array
    P: float
    gap: Array
    Q: float
    kept: Array
    factors: Factors | None = None

    @cached_property
    def _load(self) -> Array:
        """Displacements (2, n) of nodes that touch and stick, along y and x."""
        return np.stack([-self.gap, self.kept])

    def sweep(self, p: Solution, q: Solution) -> tuple[Solution, Solution]:
        """One fixed-point iteration: solve for p with the old q, then for q with the new p; both problems are
        convex."""
        n, pushed = len(self.gap), self.gap + self.yx @ q.x
        pressed = solve_bounded(self.yy, -pushed, np.zeros(n), np.full(n, np.inf), self.P, p.sides)
        on = np.flatnonzero(pressed.x > 0)
        bound = self.f[on] * pressed.x[on]
        free = (self.kept - self.xy @ pressed.x)[on]
        held = solve_bounded(submatrix(self.xx, on, on), free, -bound, bound, self.Q, q.sides[on])
        sheared = held.spread(on, n)
        moved = self.yx @ (sheared.x - q.x)  # opening due to the change of q, which p does not include yet
        return replace(pressed, residual=np.abs(moved - moved[on].mean()) / np.diag(self.yy)), sheared

    def newton(self, p: Solution, q: Solution) -> tuple[Solution, Solution] | None:
        """Solve for p and q together, iterating on the partition from that of ``p`` and ``q``; None if that fails."""
        touch, slip = p.x > 0, q.sides * (p.x > 0)
        fewest, chances, iteration, refined = 2 * len(touch), _PATIENCE, 0, False
        solver, found = None, None
        while chances > 0:
            iteration += 1
            if not (touch & (slip == 0)).any():
                return None
            solver = solver or self._solver(touch, slip)
            found = self._linear_solve(solver, touch, slip, refined, found)
            opening, rest = self._off(found, (0, 0) if refined else longest(touch & (slip == 0)))
            scale, (p_new, q_new, _) = self._scale(found), found
            noise = _ROUNDING * scale
            pushed = p_new - opening / np.diag(self.yy)
            augmented, bound = q_new - rest / np.diag(self.xx), self.f * p_new
            touches = pushed > noise[0]
            slips = (augmented > bound + noise[1]).astype(np.int8) - (augmented < -bound - noise[1])
            # nodes on the bound to rounding, where the loads return to an earlier state, go on as they are
            slips = touches * np.where((slip != 0) & (slip * augmented > bound - noise[1]), slip, slips)
            if np.array_equal(touches, touch) and np.array_equal(slips, slip):
                if not refined:
                    refined, iteration = True, iteration - 1
                    continue
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
            refined = wrong <= _CLOSE and chances < _PATIENCE
            solver = found = None
        return None

    def _linear_solve(
        self, solve: _Solver, touch: Mask, slip: Sides, refined: bool, found: Forces | None = None
    ) -> Forces:
        """Forces of one partition, whose linear system ``solve`` solves: nodes that ``touch`` have no gap, nodes that
        stick keep their displacement, and q = ``slip`` f p at nodes that slip; ``refined`` to rounding, from those that
        were ``found``."""
        totals = np.array([self.P, self.Q])
        found = found or solve(self._load, totals)
        if not refined:
            return found
        opening, rest = self._off(found)
        sticks = touch & (slip == 0)
        left = -np.stack([np.where(touch, opening, 0.0), np.where(sticks, rest, 0.0)])
        change = solve(left, totals - [found.p.sum(), found.q.sum()])
        return Forces(*(each + more for each, more in zip(found, change, strict=True)))

    def _scale(self, found: Forces) -> Array:
        """Scale (2, n) of rounding errors of the forces."""
        p, q, (approach, shift) = found
        result: Array = (np.abs(p).sum() + np.abs(q).sum()) + np.stack(
            [
                (np.abs(self.gap) + abs(approach)) / np.diag(self.yy),
                (np.abs(self.kept) + abs(shift)) / np.diag(self.xx),
            ]
        )
        return result

    def _off(self, found: Forces, but: tuple[int, int] = (0, 0)) -> Array:
        """Opening of the gap, and slip, under the forces, (2, n). Nodes from the first up to the second of ``but``,
        which are known to touch and to stick, are left out."""
        p, q, (approach, shift) = found
        result = np.zeros((2, len(p)))
        for rows in (slice(0, but[0]), slice(but[1], None)):
            result[0, rows] = self.yy[rows] @ p + self.yx[rows] @ q + self.gap[rows] - approach
            result[1, rows] = self.xx[rows] @ q + self.xy[rows] @ p - self.kept[rows] - shift
        return result

    def _solver(self, touch: Mask, slip: Sides) -> _Solver:
        """What solves the linear system of one partition."""
        if self.factors and (partition := self.factors.partition(touch, slip, self.f)):
            return partition.solve
        on, sticks = np.flatnonzero(touch), np.flatnonzero(touch & (slip == 0))
        i, end = len(on), len(on) + len(sticks)
        dragged = self.f[on] * slip[on]
        matrix = np.zeros((end + 2, end + 2))
        matrix[:i, :i] = submatrix(self.yy, on, on) + submatrix(self.yx, on, on) * dragged
        matrix[:i, i:end] = submatrix(self.yx, on, sticks)
        matrix[i:end, :i] = submatrix(self.xx, sticks, on) * dragged + submatrix(self.xy, sticks, on)
        matrix[i:end, i:end] = submatrix(self.xx, sticks, sticks)
        matrix[:i, -2] = matrix[i:end, -1] = -1  # rigid shifts
        matrix[-2, :i] = 1
        matrix[-1, :i], matrix[-1, i:end] = dragged, 1
        factors = la.lu_factor(matrix, overwrite_a=True, check_finite=False)

        def solve(load: Array, totals: Array) -> Forces:
            solution = la.lu_solve(factors, np.concatenate([load[0][on], load[1][sticks], totals]), check_finite=False)
            p, q = np.zeros(len(touch)), np.zeros(len(touch))
            p[on] = solution[:i]
            q[on] = dragged * p[on]
            q[sticks] = solution[i:end]
            return Forces(p, q, solution[-2:])

        return solve


@dataclass(frozen=True)
class Nodes:
    """Nodes of the contact line: ``x`` (n,), ``weights`` (n,) that turn tractions into forces, and ``ends(p, q,
    rise=...) -> (left, right)``, the ends of the contact under nodal forces along y and x, (n,) each. ``resultants(p,
    q) -> (points, normal, tangential)``: points (k,) within the contact, and the forces on their left, (k,) each;
    needed without ``stages``. ``similar``: whether half-planes are pressed together under a parabolic gap, so that all
    stages of pressing are similar; ``stages`` gives them for a half-width, by default from a flat punch on the nodes.
    ``nearly_similar``: the same of bodies of a size; ``near``: about its size. ``trail``: where steps begin."""

    x: Array
    weights: Array
    ends: Callable[..., tuple[float, float]]
    resultants: Callable[[Array, Array], tuple[Array, Array, Array]] | None
    similar: bool
    nearly_similar: bool = False
    near: float | None = None
    trail: Trail | None = None
    stages: Callable[[float], Stages] | None = None


def press(
    C: Relative, gap: Array, f: Array, line: Nodes | None, least: int, accuracy: float, P: float = 1.0
) -> Pressed:
    """Press the bodies together under a force from 0 to ``P``, with friction and without Q.

    Nodes that stick keep their displacement. Under a parabolic gap bodies are pressed in one small step from an
    earlier stage, known from flat punches about its vertex (:mod:`partialslip.friction.pressing`). Others are pressed
    in at least ``least`` steps, doubled until q changes by less than ``accuracy`` (relative L2), or up to the limit.

    ``C`` are the compliances, ``gap`` (n,) the gap before loading, ``f`` (n,) the coefficients of friction, ``line``
    the nodes.
    """
    assert C.xx is not None
    assert C.xy is not None
    zero, xx, xy = 0 * gap, C.xx, C.xy
    apart = resting(zero), resting(zero)

    trail = line.trail if line is not None else None
    number = itertools.count()

    def step(P: float, gap: Array, kept: Array, before: Pair, key: Hashable = None) -> Pair:
        this = _Step(xx, C.yy, xy, C.opening, f, P, gap, 0.0, kept, C.factors)
        return _solve_near(this, [before], trail if key != _ANEW else None, ("pressing", key or next(number)))

    def steps(count: int) -> list[Pair]:
        found = [apart]
        for force in np.linspace(0, P, count + 1)[1:].tolist():
            found.append(step(force, gap, C.moved(found[-1][0].x, found[-1][1].x)[0], found[-1]))
        return found

    norm = 1 / line.weights if line is not None else np.ones(len(gap))

    def off(q: Array, other: Array) -> float:
        size = float(norm @ q**2)
        return float(np.sqrt(norm @ (q - other) ** 2 / size)) if size > 0 else 0.0

    vertex = 0.0
    if line is not None and (line.similar or line.nearly_similar):
        vertex = _vertex(line.x, gap)
        line = replace(line, x=line.x - vertex)
    if line is not None and line.similar:
        return _similar(C, gap, f, line, vertex, steps(1)[-1], step, off)
    if line is not None and line.nearly_similar:
        if not (reach := line.near):
            left, right = line.ends(*(each.x for each in steps(1)[-1]))
            reach = (right - left) / 2
        if found := _nearly_similar(C, gap, f, line, reach, step, off):
            return found
    last, count = steps(least), least
    while True:
        before, last, count = last, steps(2 * count), 2 * count
        errors = {"q": 2 * off(last[-1][1].x, before[-1][1].x)}
        if line is not None:
            errors["a"] = 2 * _moved(line, last[-1], before[-1])
        grown = last[-1][0].x - last[-2][0].x, last[-1][1].x - last[-2][1].x
        reached = errors["q"] <= accuracy and errors.get("a", 0.0) <= accuracy / _ENDS
        if reached or 2 * count > max(_MOST, 2 * least) or 2 * count * len(gap) > _WORK:
            return Pressed(*_certified(last[1:]), count, errors, grown, f)


def _vertex(x: Array, gap: Array) -> float:
    """Where a parabolic ``gap`` (n,) at ``x`` (n,) is smallest: there the bodies touch first."""
    return float(np.polynomial.Polynomial.fit(x, gap, 2).deriv().roots()[0].real)


def _moved(line: Nodes, forces: Pair, others: Pair) -> float:
    """Largest distance between the ends of two contacts, in half-widths."""
    (left, right), (l_other, r_other) = (line.ends(p.x, q.x) for p, q in (forces, others))
    return max(abs(left - l_other), abs(right - r_other)) * 2 / (right - left)


def _similar(
    C: Relative,
    gap: Array,
    f: Array,
    line: Nodes,
    vertex: float,
    last: Pair,
    step: _Press,
    off: Callable[[Array, Array], float],
) -> Pressed:
    """Press self-similarly about the ``vertex``, from which the nodes of the ``line`` count, with last steps of two
    sizes; the difference is the error estimate."""
    corners: tuple[float, float] | None = None
    for _ in range(_TIMES):
        left, right = line.ends(last[0].x, last[1].x)
        reach = (right - left) / 2
        if line.stages:
            stages = line.stages(reach)
        else:
            flat = np.where(np.abs(line.x) <= reach * (1 + _STICKS), 0.0, _FAR * reach)
            punch = step(1.0, flat, 0 * gap, (resting(0 * gap), resting(0 * gap)))
            corners = line.ends(punch[0].x, punch[1].x, rise=CORNER)  # between the last node and the next one
            assert line.resultants
            growth = punch[0].x, punch[1].x
            points, normal, tangential = line.resultants(*growth)
            between = corners[0] - vertex, corners[1] - vertex
            stages = Punch(between, line.x, line.weights, growth, points - vertex, (normal, tangential))
        found = []
        for size in (stages.last, stages.last / 2):
            p, q = stages.stage(1 - size)
            found.append(step(1.0, gap, C.moved(p, q)[0], (replace(last[0], x=p), replace(last[1], x=q))))
        rough, last = found
    errors = {"q": off(last[1].x, rough[1].x), "a": _moved(line, last, rough)}
    return Pressed(*_certified([last]), 2 + 2 * _TIMES, errors, stages.growth, f, corners)


def _nearly_similar(
    C: Relative, gap: Array, f: Array, line: Nodes, reach: float, step: _Press, off: Callable[[Array, Array], float]
) -> Pressed | None:
    """Press bodies of a size, whose contact has about the half-width ``reach``, with all punches and half of the last
    step after all but one and the whole last step. The difference is the error estimate; None if it is large."""
    reach = float(f"{reach:.2g}")  # so that the error of another mesh, from which it may be, does not matter
    none, half_widths = resting(0 * gap), reach * _PUNCHES

    def punch(half_width: float, like: Pair, wider: float) -> Pair:
        """The punch, from one that is so many times ``wider``."""
        covered, nearest = np.abs(line.x) <= half_width * (1 + _STICKS), np.searchsorted(middles, line.x * wider)
        guess = replace(none, x=covered.astype(float)), replace(none, rest=like[1].rest[nearest] * covered)
        return step(1.0, np.where(covered, 0.0, _FAR * half_width), none.x, guess, _ANEW)

    middles, under = (line.x[1:] + line.x[:-1]) / 2, [(none, none)]
    for half_width, wider in zip(half_widths.tolist(), (1.0, *_PUNCHES[:-1] / _PUNCHES[1:]), strict=True):
        under.append(punch(half_width, under[-1], wider))
    under = under[1:]
    known = [(p.x > 0, (p.x > 0) & (q.sides == 0), *C.moved(p.x, q.x)) for p, q in under]
    if not all(sticks.any() for _, sticks, _, _ in known):
        return None
    punches, found = Punches.of(half_widths, line.x, known), under[:1]
    for count, size in ((len(under) - 1, punches.last), (len(under), punches.last / 2)):
        kept = punches.kept(gap, reach, 1 - size, count)
        found.append(step(1.0, gap, kept, found[-1], ("last", count)))
        left, right = line.ends(*(each.x for each in found[-1]))
        reach = (right - left) / 2
    growing, rough, last = found
    errors = {"q": off(last[1].x, rough[1].x), "a": _moved(line, last, rough)}
    if errors["q"] > _ROUGH:
        return None
    if abs(reach / half_widths[0] - 1) > _SETTLED:
        growing = punch(reach, growing, half_widths[0] / reach)
    return Pressed(*_certified([last]), len(under) + 2, errors, (growing[0].x, growing[1].x), f)


def punched(C: Relative, f: float, sides: Sides) -> tuple[Array, Array]:
    """Normal and tangential forces (n,) under a flat punch with the force 1 that covers all nodes, with friction; from
    the guess that nodes slip under q = ``sides`` f p (n,)."""
    assert C.xx is not None
    assert C.xy is not None
    zero = np.zeros(len(C.yy))
    guess = replace(resting(zero), x=zero + 1 / len(zero)), replace(resting(zero), rest=-sides.astype(float))
    p, q = _solve(_Step(C.xx, C.yy, C.xy, C.opening, zero + f, 1.0, zero, 0.0, zero), [guess])
    return p.x, q.x


def _certified(done: Sequence[tuple[Solution, Solution]]) -> tuple[Solution, Solution]:
    """Last solution, with the residuals of all steps."""
    return certified([p for p, _ in done]), certified([q for _, q in done])


def march(
    C: Relative,
    gap: Array,
    stretch: Array,
    bent: Array,
    f: Array,
    path: Path,
    pressed: Array | None = None,
    line: Nodes | None = None,
    accuracy: float = 1e-3,
) -> tuple[History, Solution, Pressed | None]:
    """Press the bodies together with friction and follow the path of the loads.

    Returns the history, the normal forces at load point 2 with the residuals of all steps, and the pressing (None if
    the path begins with pressed bodies).

    Parameters
    ----------
    C : Relative
    gap : (n,) array
        Gap before loading.
    stretch : (2, n) array
        Displacements of the lower surface, along x and y, under the tension that strains a long body by 1.
    bent : (n,) array
        Displacements along x under the tension that strains the surface by x; there are none along y.
    f : (n,) array
        Coefficient of friction.
    path : Path
    pressed : (n,) array, optional
        Normal forces at the beginning of the path; default: the bodies are apart.
    line : Nodes, optional
        Nodes of the contact line.
    accuracy : float
        Tolerance of q for the steps of pressing, relative L2.
    """
    assert C.xx is not None
    xx, xy = C.xx, C.xy if C.xy is not None else 0 * C.xx
    full = replace(C, xy=xy)
    gap = gap - path.begin[1] * stretch[1]
    first: Pressed | None = None
    if pressed is None:
        first = press(full, gap, f, line, path.substeps, accuracy, path.begin[3] if path.presses_anew else 1.0)
        done = [(first.normal, first.tangential)]
    else:
        done = [(resting(pressed), resting(0 * gap if path.before is None else path.before))]
    cycle = sum(len(way) for way in path.fractions[1:])

    def advance(before: Solution, load: Array, change: Array) -> tuple[Solution, Array]:
        nonlocal gap
        Q, strain = float(load[0]), float(change[1])
        if not change.any():
            normal = done[-1][0]
            done.append((replace(still(normal), rest=normal.rest), still(before)))
            return done[-1][1], normal.x
        gap = gap - strain * stretch[1]
        kept = xx @ before.x + xy @ done[-1][0].x + strain * stretch[0] + change[2] * bent
        starts = [done[-1], *done[-cycle : 1 - cycle]]  # the previous step, and this step of the previous cycle
        P = float(load[3]) if path.presses_anew else 1.0
        this = _Step(xx, C.yy, xy, full.opening, f, P, gap, Q, kept, full.factors)
        normal, sheared = _solve_near(this, starts, line.trail if line is not None else None, ("path", len(done)))
        done.append((replace(normal, residual=np.maximum(normal.residual, sheared.residual / f)), sheared))
        return sheared, normal.x

    history = follow(path, advance, done[0][1], f)
    last, _ = done[-cycle:][sum(len(way) for way in path.fractions[1 : path.ends[1] + 2]) - 1]
    together = replace(
        last,
        residual=np.maximum.reduce([normal.residual for normal, _ in done]),
        imbalance=max(normal.imbalance for normal, _ in done),
        iterations=sum(normal.iterations for normal, _ in done),
        changes=sum(normal.changes + sheared.changes for normal, sheared in done),
    )
    return history, together, first


def _solve_near(
    step: _Step, starts: Sequence[tuple[Solution, Solution]], trail: Trail | None, key: Hashable
) -> tuple[Solution, Solution]:
    """Solve one step, first from what the ``trail`` knows of it under its ``key``."""
    found = _solve(step, [*starts, *(trail.starts(key) if trail else [])])
    if trail:
        trail.keep(key, found)
    return found


def _solve(step: _Step, starts: Sequence[tuple[Solution, Solution]]) -> tuple[Solution, Solution]:
    """Solve one step by Newton's method on the partition, from the partitions of ``starts``.

    If no iteration converges, a fixed-point sweep, which contracts unless friction is very large, gives the next start.
    The iteration ends when sweeps stop reducing the residual, at rounding.
    """
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
