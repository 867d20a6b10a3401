"""Mesh after mesh, each fine where the one before it found the ends of the contact and of the stick zone."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from partialslip.condensed.zones import apart
from partialslip.result import Clock
from partialslip_fem.level import Level, Problem, solve_level

_GROWTH = {1: 0.1, 2: 0.25, 3: 0.5, 4: 0.7}  # element size gained per distance, on the first graded mesh
_FINER, _CALMER = 8.0, 0.85  # from mesh to mesh: element size at the ends, and growth
_FIRST = 0.1  # element size of the first mesh, in contact half-widths
_FINEST = _FIRST / _FINER**6  # below that rounding takes over


@dataclass(frozen=True)
class Adapted:
    """The last level, what its ends may still be off by (in contact half-widths), and the work of all levels."""

    level: Level
    errors: dict[str, float]
    meshes: int
    iterations: int
    width: float


def adapt(problem: Problem, accuracy: float, width: float, clock: Clock, progress: Callable[[str], None]) -> Adapted:
    """Refine until the ends are known to ``accuracy``, by the estimate of two successive meshes.

    From mesh to mesh errors of the ends fall at least fourfold (6 to 10 times for P4), so that no more than a third
    of the last change is left. ``width`` is the block's half-width in contact half-widths. The first
    contact line is a guess, doubled until the contact does not reach its ends.
    """
    reach, size, growth = 1.5 + max(problem.kinks, default=0.0), _FIRST, _GROWTH[problem.order]
    meshes, iterations = 0, 0
    while True:
        guess = dict.fromkeys(np.linspace(-reach, reach, 16).tolist(), 2 * size * reach)
        level = solve_level(problem, width * reach, (-reach, reach), guess, 1.0, clock)
        meshes, iterations = meshes + 1, iterations + level.iterations
        if level.enclosed:
            break
        reach *= 2
    while True:
        a = level.half_width
        size, growth = size / _FINER, growth * _CALMER
        sizes = dict.fromkeys(apart([*level.ends.tolist(), *problem.kinks], size * a), size * a)
        margin = (0.1 + 2 * _FINER * size) * a  # of safety, and what the mesh before may have been off by
        contact = (level.left - margin, level.right + margin)
        before, level = level, solve_level(problem, width * a, contact, sizes, growth, clock)
        meshes, iterations = meshes + 1, iterations + level.iterations
        errors = {key: change / 3 for key, change in _changes(before, level).items()}
        progress(
            f"mesh {meshes}: {level.body.stiffness.shape[0]:,} unknowns, "
            f"{', '.join(errors)} known to {max(errors.values()):.1e} a"
        )
        if (max(errors.values()) <= accuracy and level.enclosed) or size <= _FINEST:
            return Adapted(level, errors, meshes, iterations, width)


def _changes(before: Level, after: Level) -> dict[str, float]:
    """Changes of a, m and n in contact half-widths."""
    changes = {"a": abs(after.half_width - before.half_width) / after.half_width}
    if before.stick and after.stick:
        changes["m"] = abs(after.stick.left - before.stick.left) / after.half_width
        changes["n"] = abs(after.stick.right - before.stick.right) / after.half_width
    return changes
