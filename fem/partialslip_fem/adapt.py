"""Mesh after mesh, each fine where the one before it found the ends of the contact and of the stick zone."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from partialslip.arrays import Array
from partialslip.bars import BARS
from partialslip.condensed.ends import apart
from partialslip.condensed.steps import MOST
from partialslip.errors import InputError
from partialslip.result import Clock
from partialslip_fem.estimate import ENDS, NEIGHBOUR, end_errors, enough, kink_sizes, neighbour, smooth_errors, together
from partialslip_fem.expense import Expense, again
from partialslip_fem.level import Kept, Level, Part, Problem, solve_level

_FIRST, _ROUGH = 0.1, 1.0  # element size of the first mesh, in its contact line's half-width; and growth
_FINER = 16.0  # from mesh to mesh at most: element size at the ends
_SMOOTH, _GROWTH = 2.8, 0.7  # away from the ends errors are about (growth/2.8)^(2 order); the largest growth
_CALMER = (0.4, 0.85)  # of growth, where that was not so
_AIM, _BAR = 0.5, 0.9  # of the accuracy: estimates are right within a factor of two as a rule
_ENDS = 0.33  # share of what is aimed at that the elements at the ends may take
_FINEST = 1e-7  # element size at the ends, in contact half-widths; below, rounding takes over
_BESIDE = 0.005  # element size at an end, in contact half-widths, beyond which the mesh is only good for finding it
_WAITS = 2  # meshes that may be too coarse at the ends and kinks found on them, once the errors of one are known
_ANYWAY = 1.5  # of the size that a kink needs: a mesh that is not coarser there is left as it is
_MOST = 200_000  # unknowns
_FILLS = 0.95  # of a finite body's width: as much as the contact line may take
_ROUNDING = 0.25  # of the accuracy: how far a round face may be from its elements, and the ends off for that
_CORNERS = 10.0  # of the accuracy: what elements at corners of finite bodies may be off by, at most
_LOOSEST = 1e-2  # the same, relative
_TILTS = {"left": 1e-3, "right": 1e-3, "p": 5e-3, "q": 5e-3, "q1": 5e-3, "q2": 5e-3}  # of that, felt at the contact
_CHOICES = 13  # accuracies between the one asked for and the loosest, to settle for
_WORTH = 1.2  # of the unknowns of a mesh that is there: one with fewer is not worth another
_FEWEST = 4  # elements of a mesh as it is that must lie in the contact


@dataclass(frozen=True)
class Adapted:
    """The last level, what it may still be off by (ends in contact half-widths, tractions relative), and the work of
    all levels; ``settled`` is the accuracy that the allowance sufficed for, None if there was none."""

    level: Level
    errors: dict[str, float]
    meshes: int
    factorizations: int
    iterations: int
    width: float
    settled: float | None = None


@dataclass(frozen=True)
class _Aim:
    """What an ``accuracy`` asks of meshes: estimates within ``bar``, elements at ends, faces and corners that take no
    more than their shares of it."""

    accuracy: float
    bar: float
    share: float
    least: float
    rounding: float
    corners: float
    tilts: dict[str, float]

    @classmethod
    def at(cls, accuracy: float, problem: Problem) -> "_Aim":
        """The aim for ``accuracy``."""
        corners = min(_CORNERS * accuracy, _LOOSEST)
        tilting = any(part.extent for part in problem.parts)
        return cls(
            accuracy=accuracy,
            bar=_BAR * accuracy,
            share=_ENDS * _AIM * accuracy,
            least=_growth(_AIM * accuracy / 2, problem.order),
            rounding=_ROUNDING * accuracy if any(part.face for part in problem.parts) else 0.0,
            corners=corners,
            tilts={key: share * corners * tilting for key, share in _TILTS.items()},
        )

    def goal(self, level: Level, problem: Problem) -> float:
        """Element size at the ends that suffices, in contact half-widths."""
        goal = self.share / _worst(end_errors(level, *_anywhere(level)))
        goal = min(goal, enough(level, _gaps(level, problem), self.share))
        return min(max(goal, _FINEST), _BESIDE / 2)


def adapt(problem: Problem, accuracy: float, width: float, clock: Clock, progress: Callable[[str], None]) -> Adapted:
    """Refine until the ends are known to ``accuracy``, by the estimates of :mod:`partialslip_fem.estimate`.

    Errors of elements of order k fall with the 2 k-th power of their growth away from the ends, which gives the growth
    that the next mesh needs. What costs a second solution is estimated only where the elements at the ends are small
    enough. ``width`` is the block's half-width in contact half-widths. The first contact line is a guess, doubled
    until the contact does not reach its ends. Steps of the load path are chosen on the first mesh that is fine enough
    to tell, and kept; elements are not to make up for what these leave.
    """
    order, parts = problem.order, problem.parts
    expense = Expense(clock, len(parts))
    level, meshes, factored = _first(problem, width, clock)
    expense.measure(level.dofs)
    a, iterations, known, before, size, finer = level.half_width, level.iterations, np.inf, np.inf, _FIRST, _FINER
    aim, errors, at_ends = _Aim.at(accuracy, problem), dict[str, float](), dict[str, float]()
    stepped: Mapping[str, float] | None = None  # what steps leave, once they are chosen
    waited = 0
    least, limit = aim.least, _limit(problem)
    coarsest = max(part.fineness for part in parts)  # what is not finer than that is to be fine enough
    while True:
        if expense.limited:
            done = bool(at_ends) and level.enclosed
            settled = _settle(expense, aim, level, problem, (size, finer, least), width, done)
            if at_ends and not settled:
                if known == np.inf:
                    other = neighbour(level, problem, width * a, clock)
                    factored, iterations = factored + other.factored, iterations + other.iterations
                    errors = together(level, smooth_errors(level, other), at_ends)
                settled_for = max(aim.accuracy, _worst(errors) / _BAR)
                return Adapted(level, errors, meshes, factored, iterations, width, settled_for)
            if settled and settled is not aim:
                least, aim = least * settled.least / aim.least, settled
                finer = finer if size > 1.01 * aim.goal(level, problem) else 1.0
        goal = aim.goal(level, problem)
        size, growth, finer = _course(size, finer, goal, least, order)[0]
        locked = kink_sizes(level, aim.share * BARS["q1"])
        a = level.half_width
        margin = (0.1 + 2 * finer * size) * a  # of safety, and what the mesh before may have been off by
        contact = (max(level.left - margin, -limit), min(level.right + margin, limit))
        kinks = [kink for kink in problem.kinks if contact[0] < kink < contact[1]]  # others touch nothing
        sizes = dict.fromkeys(apart([*level.ends.tolist(), *kinks], size * a), size * a / coarsest)
        for kink, needed in zip(level.kinks, np.clip(locked, size, None).tolist(), strict=True):
            if _sizes(np.array([kink]), sizes, growth / coarsest)[0] > _ANYWAY * needed * a / coarsest:
                sizes[kink] = needed * a / coarsest
        grading = (contact, sizes, growth / coarsest)
        expected = expense.unknowns(*grading[1:], order, width * a) if expense.limited else None
        choose = stepped is None and size <= _BESIDE
        steps = (0 if expense.limited else MOST) if choose else None  # more steps have no price
        level = solve_level(
            problem, width * a, *grading, clock, rounding=aim.rounding, corners=aim.corners, steps=steps
        )
        if choose and level.enclosed and level.history and not level.coupled:
            stepped, problem = level.stepped, replace(problem, path=replace(level.history.path, before=None))
            aim = _Aim.at(max(aim.accuracy, _worst(stepped)), problem)
        elif stepped is not None:
            level = replace(level, stepped=stepped)
        expense.measure(level.dofs, expected)
        meshes, factored, iterations = meshes + 1, factored + level.factored, iterations + level.iterations
        if not level.enclosed and max(-level.left, level.right) >= limit:
            raise _too_narrow(problem)
        local, beside = (
            _sizes(points, sizes, growth / coarsest) * coarsest / a for points in (level.ends, np.array(level.kinks))
        )
        errors = at_ends = {
            key: error + aim.rounding * (key in ENDS) + aim.tilts.get(key, 0.0)
            for key, error in end_errors(level, local, _gaps(level, problem), beside).items()
        }
        known, calmer = np.inf, 1.0
        found = f"mesh {meshes}: {level.dofs:,} unknowns"
        bar = max(aim.bar - _worst(stepped or {}), aim.bar / 2)  # steps have their share of it
        good = level.enclosed and local.max() <= _BESIDE
        waited = waited + 1 if before < np.inf else 0
        if (good and _worst(at_ends) <= bar) or size <= _FINEST or level.dofs > _MOST or waited > _WAITS:
            other = neighbour(level, problem, width * a, clock)
            expense.pass_over()
            factored, iterations = factored + other.factored, iterations + other.iterations
            smooth = smooth_errors(level, other)
            errors = together(level, smooth, at_ends)
            known = _worst(errors)
            calmer = float(np.clip((3 * _worst(smooth) / bar) ** (-0.5 / order), *_CALMER))
            waited = 0
            found += f", {', '.join(errors)} known to {known:.1e} a"
        progress(found)
        if (good and known <= bar) or before / 2 < known < np.inf or level.dofs > _MOST * calmer**2:
            reached = max(aim.accuracy, known / _BAR) if expense.limited else None
            return Adapted(level, errors, meshes, factored, iterations, width, reached)
        if size <= 1.01 * goal:
            finer = min(max(3 * _worst(at_ends) / bar, 1.0), _FINER)
        if known < np.inf:
            before, least = known, least * calmer


def _course(size: float, finer: float, goal: float, least: float, order: int) -> list[tuple[float, float, float]]:
    """Element size at the ends and growth of the meshes to come, from ``size`` to ``goal``, and by how much each is
    finer than the one before it: ``finer``, unless there is still some way to go."""
    if size > 1.01 * goal:
        finer = (size / goal) ** (1 / math.ceil(math.log(size / goal, _FINER)))
    course = []
    while True:
        size = max(size / finer, _FINEST)
        growth = max(least, _growth(size, order)) if size > 1.01 * goal else least
        course.append((size, growth, finer))
        if size <= max(1.01 * goal, _FINEST):
            return course


def _settle(
    expense: Expense,
    aim: _Aim,
    level: Level,
    problem: Problem,
    state: tuple[float, float, float],
    width: float,
    done: bool,
) -> _Aim | None:
    """The best aim, none beyond ``aim``, that the rest of the allowance suffices for; None if ``level``, which is
    ``done`` if it is good for an estimate, is about as good. ``state`` is element size, refinement and growth."""
    size, finer, least = state
    order, a = problem.order, level.half_width
    once_more = again(order, NEIGHBOUR[order]) + problem.inside
    best: _Aim = aim
    for accuracy in np.geomspace(aim.accuracy, max(_LOOSEST, aim.accuracy), _CHOICES).tolist():
        best = aim if accuracy == aim.accuracy else _Aim.at(accuracy, problem)
        goal = best.goal(level, problem)
        steps = _course(
            size, finer if best is aim or size > 1.01 * goal else 1.0, goal, least * best.least / aim.least, order
        )
        unknowns = [
            expense.unknowns(dict.fromkeys(level.ends.tolist(), each * a), growth, order, width * a)
            for each, growth, _ in steps
        ]
        if done and best is not aim and unknowns[-1] < _WORTH * level.dofs:
            return None
        if expense.affords(unknowns, once_more):
            return best
    return None if done else best


def uniform(problem: Problem, size: float | None, width: float, clock: Clock, keep: Kept | None = None) -> Adapted:
    """Solve on one mesh of elements of ``size``, in contact half-widths, all along the contact line; without a size, on
    meshes that are given, and on one whose elements are as large as theirs in the contact.

    It does not depend on friction and shear: with ``keep``, they can change without another factorisation. Nothing is
    refined, and no error estimated.
    """
    level, meshes, factored = _first(problem, width, clock, keep)
    iterations, sizes = level.iterations, _sizes_given(problem, level)
    if problem.meshed:
        return Adapted(level, {}, meshes, factored, iterations, width)
    size = size or min(sizes) / level.half_width
    growth = _growth(size / 10, problem.order)  # what is deeper is not to be worse
    a = float(f"{level.half_width:.2g}")  # loads and profiles that differ by little share a mesh
    reach, limit = 1.25 * max(-level.left, level.right), _limit(problem)
    while True:
        reach = min(float(f"{reach:.2g}"), limit)
        level = solve_level(problem, width * a, (-reach, reach), {}, growth, clock, size * a, keep, steps=MOST)
        meshes, factored, iterations = meshes + 1, factored + level.factored, iterations + level.iterations
        if level.enclosed:
            return Adapted(level, {}, meshes, factored, iterations, width)
        if reach == limit:
            raise _too_narrow(problem)
        reach *= 1.5


def _sizes_given(problem: Problem, level: Level) -> list[float]:
    """Mean sizes of the elements in the contact of meshes that are given."""
    sizes = []
    for part, half in zip(problem.parts, level.halves, strict=True):
        vertices = half.body.x[:: half.body.order]
        inside = vertices[(vertices > level.left) & (vertices < level.right)]
        if part.mesh and len(inside) <= _FEWEST:
            raise InputError(
                f"bodies.{part.name}.mesh: must have more than {_FEWEST} elements in the contact, not {len(inside) + 1}"
                f"; is bodies.{part.name}.unit right?"
            )
        if part.mesh:
            sizes.append(float(np.diff(inside).mean()))
    return sizes


def _first(problem: Problem, width: float, clock: Clock, keep: Kept | None = None) -> tuple[Level, int, int]:
    """A level on a mesh that is fine all over a contact line which the contact does not fill, and how many meshes and
    factorisations that took."""
    reach, limit, meshes, factored = 1.5 + max(problem.kinks, default=0.0), _limit(problem), 0, 0
    steps = MOST if problem.meshed else None  # of given meshes it is the last level, too
    while True:
        reach = min(reach, limit)
        guess = dict.fromkeys(np.linspace(-reach, reach, 16).tolist(), 2 * _FIRST * reach)
        level = solve_level(problem, width * reach, (-reach, reach), guess, _ROUGH, clock, keep=keep, steps=steps)
        meshes, factored = meshes + 1, factored + level.factored
        if level.enclosed:
            return level, meshes, factored
        if reach == limit:
            raise _too_narrow(problem)
        reach *= 2


def _gaps(level: Level, problem: Problem) -> Array:
    """From each end of the stick zone the distance to the other one, and from each end that to the nearest of all other
    ends and kinks of the profile, (2, k), in contact half-widths."""
    kinks = np.array(problem.kinks)
    apart = np.abs(level.ends[:, None] - np.concatenate([level.ends, kinks, -kinks]))
    np.fill_diagonal(apart, np.inf)
    across = np.full(len(level.ends), np.inf)
    if level.stick:
        across[2:4] = apart[2, 3]
        apart[2, 3] = apart[3, 2] = np.inf
    gaps: Array = np.maximum([across, apart.min(axis=1)], np.finfo(float).tiny) / level.half_width
    return gaps


def _anywhere(level: Level) -> tuple[Array, Array, Array]:
    """Elements as large as the contact's half-width at all ends, far apart, and kinks that do not matter."""
    count = len(level.ends)
    return np.ones(count), np.full((2, count), np.inf), np.zeros(len(level.kinks))


def _sizes(points: Array, sizes: Mapping[float, float], growth: float) -> Array:
    """Element sizes at points of the contact line, of a mesh that is graded to other points with those ``sizes``."""
    at, size = np.array([*sizes]), np.array([*sizes.values()])
    smallest: Array = (size + growth * np.abs(points[:, None] - at)).min(axis=1)
    return smallest


def _growth(error: float, order: int) -> float:
    """That of a mesh on which errors away from the ends are about as large as that."""
    return float(min(_SMOOTH * error ** (0.5 / order), _GROWTH))


def _limit(problem: Problem) -> float:
    """How far the contact line may reach: not to the corners of a finite body."""
    limit = min(_reach(part) for part in problem.parts)
    if max(problem.kinks, default=0.0) >= limit:
        raise _too_narrow(problem)
    return limit


def _reach(part: Part) -> float:
    if part.mesh:
        return float(np.abs(part.mesh.points[part.mesh.lines["contact"], 0]).max())
    return _FILLS * part.extent[0] if part.extent else np.inf


def _too_narrow(problem: Problem) -> InputError:
    names = (f"bodies.{part.name}.{'mesh' if part.mesh else 'width'}" for part in problem.parts if part.finite)
    return InputError(
        f"{' and '.join(names)}: must be wider than the contact, which fills more than {_FILLS:.0%} of it"
    )


def _worst(errors: Mapping[str, float]) -> float:
    """As an error of an end."""
    return max((error / BARS[key] for key, error in errors.items()), default=0.0)
