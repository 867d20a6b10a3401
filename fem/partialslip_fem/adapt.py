"""Mesh after mesh, each fine where the one before it found the ends of the contact and of the stick zone."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from partialslip.condensed.zones import apart
from partialslip.result import Clock
from partialslip_fem.estimate import end_errors, neighbour, smooth_errors
from partialslip_fem.level import Level, Problem, solve_level

_FIRST = 0.05  # element size of the first mesh, in the half-width of its contact line
_FOUND = 2e-3  # what it finds the ends of a smooth contact to, in contact half-widths
_GROWTH = {1: 0.2, 2: 0.4, 3: 0.6, 4: 0.7}  # element size gained per distance, on the first graded mesh
_AT_ENDS = 10.0  # element size at the ends, in what the ends are to be known to: it puts them off by a tenth of that
_FINER, _CALMER = 16.0, (0.4, 0.85)  # from mesh to mesh: element size at the ends, and bounds on that of growth
_STEP = 200.0  # errors are to fall by no more from mesh to mesh: the ends must be known before much is spent on them
_COARSEST, _FINEST = 1e-3, 1e-7  # element sizes at the ends, in contact half-widths; below, rounding takes over
_BESIDE = 0.01  # element size at an end, in contact half-widths, beyond which the mesh is only good for finding it
_MOST = 200_000  # unknowns
_SHARES = {"p": 0.1, "q": 1 / 15}  # of the accuracy asked: tractions may be off by 10 and 15 times as much


@dataclass(frozen=True)
class Adapted:
    """The last level, what it may still be off by (ends in contact half-widths, tractions relative), and the work of
    all levels."""

    level: Level
    errors: dict[str, float]
    meshes: int
    factorizations: int
    iterations: int
    width: float


def adapt(problem: Problem, accuracy: float, width: float, clock: Clock, progress: Callable[[str], None]) -> Adapted:
    """Refine until the ends are known to ``accuracy``, by the estimates of :mod:`partialslip_fem.estimate`.

    Errors of elements of order k fall with the 2 k-th power of their growth away from the ends, which gives the
    growth that the next mesh needs. ``width`` is the block's half-width in contact half-widths. The first contact
    line is a guess, doubled until the contact does not reach its ends.
    """
    reach, growth = 1.5 + max(problem.kinks, default=0.0), _GROWTH[problem.order]
    levels, iterations = 0, 0
    while True:
        guess = dict.fromkeys(np.linspace(-reach, reach, 31).tolist(), 2 * _FIRST * reach)
        level = solve_level(problem, width * reach, (-reach, reach), guess, 0.5, clock)
        levels, iterations = levels + 1, iterations + level.iterations
        if level.enclosed:
            break
        reach *= 2
    meshes, before, known, size = levels, np.inf, _FOUND, _COARSEST * _FINER
    while True:
        goal = max(accuracy, known / _STEP)
        size = max(min(_AT_ENDS * goal, size / _FINER), _FINEST)
        a = level.half_width
        sizes = dict.fromkeys(apart([*level.ends.tolist(), *problem.kinks], size * a), size * a)
        margin = (0.1 + 10 * known) * a  # of safety, and what the mesh before may have been off by
        contact = (level.left - margin, level.right + margin)
        level = solve_level(problem, width * a, contact, sizes, growth, clock)
        other = neighbour(level, problem, width * a, clock)
        meshes, levels, iterations = meshes + 1, levels + 2, iterations + level.iterations + other.iterations

        smooth = smooth_errors(level, other)
        local = size + growth * np.abs(level.ends[:, None] - [*sizes]).min(axis=1) / a
        at_ends = end_errors(level, local)
        errors = {key: error + at_ends[key] for key, error in smooth.items()}
        known = _worst(errors)
        unknowns = level.body.stiffness.shape[0]
        progress(f"mesh {meshes}: {unknowns:,} unknowns, {', '.join(errors)} known to {known:.1e} a")
        to_gain = max(3 * _worst(smooth) / max(accuracy, known / _STEP), 1.0)
        calmer = float(np.clip(to_gain ** (-0.5 / problem.order), *_CALMER))
        done = known <= accuracy and level.enclosed and local.max() <= _BESIDE
        if done or known > before / 2 or unknowns > _MOST * calmer**2:
            return Adapted(level, errors, meshes, levels, iterations, width)
        before, growth = known, growth * calmer


def _worst(errors: dict[str, float]) -> float:
    """As an error of an end."""
    return max(error * _SHARES.get(key, 1.0) for key, error in errors.items())
