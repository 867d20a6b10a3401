"""Stress paths around the steady cycle, at so many load points that the criteria settle."""

from collections.abc import Callable, Sequence

import numpy as np

from partialslip.result import Result
from partialslip.scene import Load, Scene
from partialslip.study.fatigue.criteria import Criterion, elastic
from partialslip.study.fatigue.critical_plane import with_zz
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

LOAD_POINTS = np.array([0.0, 0.5])  # phases of load points 1 and 2
_FIRST, _MOST = 8, 64  # accuracy: load points around the cycle: least number, and largest unless the scene has more
_SETTLED = 1e-6  # accuracy: relative change of the largest value at the surface when the load points are doubled
_ABOVE = 1e-30  # accuracy: half-widths: points of the upper body's surface, which is not the lower body's


def stress_path(scene: Scene, result: Result, body: str, phases: Array, x: Array, depth: Array) -> Array:
    """Return the stress path (s, 4, ...), Pa, of a ``body`` at ``phases`` (s,) of the cycle, with the tension
    ``fatigue.sigma_upper``; see :meth:`partialslip.Assessment.stress`."""
    assert result.stress_at
    own = scene.bodies.lower if body == "lower" else scene.bodies.upper
    round_face = own is not None and own.kind == "pad" and bool(result.bodies)  # half-planes have none
    below = depth + (scene.gap_at(x) if round_face else 0.0)
    stress = np.array(result.stress_at(x, -below if body == "lower" else below + _ABOVE * result.a, phases))
    if scene.fatigue.sigma_upper is not None:
        tension = np.interp(phases, [0.0, 0.5, 1.0], [*scene.fatigue.sigma_upper, scene.fatigue.sigma_upper[0]])
        stress[:, 0] += tension.reshape(-1, *[1] * (stress.ndim - 2))
    return with_zz(stress, elastic(scene, body).nu, scene.material.plane)


def phases_of(load: Load, parts: int) -> Array:
    """Return the phases (s,) of all load points, with the ways between them divided into ``parts``."""
    first, second = load.ends
    count = len(load.points)
    places = first + np.arange(count * parts) / parts
    return np.interp(places, [first, second, first + count], [0.0, 0.5, 1.0])


def dense(load: Load, phases: Array) -> Array:
    """Return as many phases (s,) as are ever taken, for curves, which bend at each of them in slip zones; ``phases``
    themselves if they are load points 1 and 2 only."""
    return phases if len(phases) == len(LOAD_POINTS) else phases_of(load, max(_MOST // len(load.points), 2))


def unknown_between(result: Result) -> str:
    """Return why the stresses between load points 1 and 2 are not known; empty if they are known."""
    assert result.stress_at
    try:
        result.stress_at(0.0, 0.0, [0.25])
    except InputError as error:
        return str(error)
    return ""


def settled_criteria(
    load: Load, found: Sequence[Criterion], path: Callable[[Array], Array], known: bool
) -> tuple[Array, list[float]]:
    """Return phases (s,) of the cycle at which the largest values of criteria settle, and their relative changes.

    The parts between the load points of the scene are doubled. The change is that over the one or the other half of the
    points between them, whichever is larger: a peak that one half happens to hit is missed by the other.

    Parameters
    ----------
    load : Load
    found : sequence of Criterion
    path : callable
        ``path(phases) -> (s, 4, ...)``: stress paths.
    known : bool
        Whether stresses between load points 1 and 2 are known; otherwise these two are taken, and the changes are NaN.
    """
    changes = np.full(len(found), np.nan)
    if not known:
        return LOAD_POINTS, changes.tolist()

    def largest(stress: Array) -> Array:
        return np.array([np.nanmax(each.at(stress).value) for each in found])

    count = len(load.points)
    parts = 2
    while count * parts < _FIRST:
        parts *= 2
    while True:
        phases = phases_of(load, parts)
        stress, number = path(phases), np.arange(len(phases)) % parts
        now = largest(stress)
        size = np.where(now == 0, 1.0, np.abs(now))
        halves = (number % 2 == 0), (number % 2 == 1) | (number == 0)
        changes = np.max([np.abs(now - largest(stress[half])) / size for half in halves], axis=0)
        if (changes <= _SETTLED).all() or 2 * len(phases) > _MOST:
            return phases, changes.tolist()
        parts *= 2
