"""Assess a solved scene: fatigue criteria at the surface, inside the body, and averaged over a distance."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from partialslip.arrays import Array
from partialslip.errors import InputError
from partialslip.fatigue.criteria import with_zz
from partialslip.fatigue.edges import Edge, edges
from partialslip.fatigue.named import RUIZ, Criterion, chosen, criterion, elastic
from partialslip.fatigue.places import OVER, averaged, depths, largest_at, surface_points
from partialslip.fatigue.planes import Critical
from partialslip.fatigue.ruiz import Ruiz, ruiz
from partialslip.result import Result
from partialslip.scene import Scene

BODIES = ("lower", "upper")
_FEWEST, _PHASES = 4, 64  # load points around the cycle: first number, and largest
SETTLED = 1e-6  # relative change of the largest value at the surface when the load points are doubled
_ABOVE = 1e-30  # half-widths: points of the upper body's surface, which is not the lower body's


@dataclass(frozen=True)
class Spot:
    """A point of a body, and a criterion there.

    Parameters
    ----------
    x, depth : float
        m; the depth is positive in either body.
    value : float
    angle, tilt : float
        Normal of the critical plane: angle from the x axis in the xy plane, and from this plane, rad; NaN without.
    """

    x: float
    depth: float
    value: float
    angle: float
    tilt: float


@dataclass(frozen=True)
class Rating:
    """What a criterion finds.

    Parameters
    ----------
    criterion : Criterion
    surface, peak : Spot
        Largest values along the surface and in the whole body.
    averages : dict of str to Spot
        By "point", "line" and "area": value of the stresses at the depth ``fatigue.distance`` below ``surface``,
        averaged over the line to this depth, and over the half disc of this radius. Empty without distance.
    change : float
        Relative change of the largest value at the surface over half as many load points around the cycle; NaN if
        they were not doubled.
    """

    criterion: Criterion
    surface: Spot
    peak: Spot
    averages: Mapping[str, Spot]
    change: float


@dataclass(frozen=True)
class Assessment:
    """Fatigue criteria of one body of a solved scene (:func:`assess`).

    Parameters
    ----------
    scene : Scene
    result : Result
    body : str
        "lower" or "upper".
    phases : int
        Number of load points around the cycle.
    ratings : dict of str to Rating
        By criterion.
    ruiz : Ruiz or None
        If asked for, and something slips.
    edges : (Edge, Edge) or ()
        Asymptotes at the left and the right end of the contact; empty where P or M varies, or nothing sticks.
    notes : tuple of str
        Remarks for the reader.
    """

    scene: Scene
    result: Result
    body: str
    phases: int
    ratings: Mapping[str, Rating]
    ruiz: Ruiz | None = None
    edges: tuple[Edge, Edge] | tuple[()] = ()
    notes: tuple[str, ...] = field(default=())

    def __repr__(self) -> str:
        """The largest values, a line each."""
        lines = [f"Assessment of {self.scene.name} by {self.result.method}, {self.body} body"]
        for name, rating in self.ratings.items():
            at = rating.surface
            lines.append(f"{name}: {at.value:.6g} at x = {at.x / self.result.a:.6g} a")
        return "\n  ".join(lines)

    def _repr_html_(self) -> str:
        from partialslip.fatigue.page import notebook_html

        return notebook_html(self)

    def stress(self, x: Array, depth: Array, phases: int | None = None) -> Array:
        """Return the stress path (phases, 4, ...), Pa, components xx, yy, xy and zz.

        Parameters
        ----------
        x, depth : arrays
            Points, m, of any common shape.
        phases : int, optional
            Number of load points around the cycle; default: that of the assessment.
        """
        return stress_path(self.scene, self.result, self.body, phases or self.phases, x, depth)

    def at(self, name: str, x: Array, depth: Array) -> Critical:
        """Return a criterion at points.

        Parameters
        ----------
        name : str
            Of the criterion.
        x, depth : arrays
            Points, m, of any common shape.
        """
        return self.ratings[name].criterion.at(self.stress(x, depth))


def stress_path(scene: Scene, result: Result, body: str, phases: int, x: Array, depth: Array) -> Array:
    """Stress path (phases, 4, ...), Pa, of a ``body``, with the tension ``fatigue.sigma_upper``; see
    :meth:`Assessment.stress`."""
    assert result.stress_at
    y = -np.asarray(depth, float) if body == "lower" else np.asarray(depth, float) + _ABOVE * result.a
    cycle = np.arange(phases) / phases
    stress = np.array(result.stress_at(x, y, cycle))
    if scene.fatigue.sigma_upper is not None:
        first, second = scene.fatigue.sigma_upper
        tension = first + (second - first) * (1 - np.abs(1 - 2 * cycle))
        stress[:, 0] += tension.reshape(-1, *[1] * (stress.ndim - 2))
    return with_zz(stress, elastic(scene, body).nu, scene.material.plane)


def assess(scene: Scene, result: Result, criteria: Iterable[str] | None = None, *, body: str = "lower") -> Assessment:
    """Assess a solved scene by fatigue criteria.

    The load points around the cycle are doubled until the largest value at the surface settles. The largest values are
    then sought along the surface and in the body, to two half-widths beyond and below the contact.

    Parameters
    ----------
    scene : Scene
        The table ``fatigue`` holds the constants of the criteria and the distance of averages.
    result : Result
        Of ``scene``, with stresses: ``partialslip.run(scene, method, subsurface=True)[method]``.
    criteria : iterable of str, optional
        Of principal, swt, fatemi-socie, findley, dang-van, crossland and ruiz. Default: all whose constants the scene
        has.
    body : "lower" or "upper"

    Raises
    ------
    InputError
        If a criterion is unknown, a constant of a named criterion is missing, or the result has no stresses.
    """
    names = chosen(scene, criteria)
    if body not in BODIES:
        raise InputError(f"body {body!r}: must be of {', '.join(BODIES)}")
    if result.stress_at is None:
        raise InputError(
            f"{result.method}: stresses are not known; run the scene with subsurface=True, or by another method"
        )
    ruiz_asked = RUIZ in names and result.slip is not None and bool(result.slip.slip.any())
    found = [criterion(scene, name, body) for name in names if name != RUIZ]
    x = surface_points(rough_points(scene, result), result.a)
    most, notes = _phases_known(result, x)
    path = partial(stress_path, scene, result, body)
    phases, changes = _settled(found, path, x, most)
    at = partial(path, phases)
    grid = depths(result.a)
    stress = at(x[:, None], grid)
    ratings = {
        each.name: _rated(each, at, (x, grid, stress), scene.fatigue.distance, change)
        for each, change in zip(found, changes, strict=True)
    }
    return Assessment(
        scene,
        result,
        body,
        phases,
        ratings,
        _ruiz(result, at) if ruiz_asked else None,
        edges(scene, result),
        notes,
    )


def rough_points(scene: Scene, result: Result) -> Array:
    """Return the points of the surface where stresses may have cusps, m: ends of the contact and of the stick zone,
    and kinks of the profile."""
    ends = np.ravel(result.ends)
    stick = [] if result.m is None or result.n is None else [-result.m, result.n]
    inside = [x for x in (*stick, *scene.profile.kinks) if ends.min() < x < ends.max()]
    return np.unique([*ends, *inside])


def _phases_known(result: Result, x: Array) -> tuple[int, tuple[str, ...]]:
    """Largest number of load points around the cycle at which the method knows stresses, and why not more."""
    assert result.stress_at
    try:
        result.stress_at(x[:1], np.zeros(1), np.arange(_FEWEST) / _FEWEST)
    except InputError as error:
        return 2, (f"load points 1 and 2 only: {error}",)
    return _PHASES, ()


def _settled(found: Sequence[Criterion], path: "partial[Array]", x: Array, most: int) -> tuple[int, list[float]]:
    """Number of load points around the cycle at which the largest values along the surface settle, and their relative
    changes over half as many."""
    phases, change = min(_FEWEST, most), np.full(len(found), np.nan)

    def largest(stress: Array) -> Array:
        return np.array([np.nanmax(each.at(stress).value) for each in found])

    while 2 * phases <= most and not (change <= SETTLED).all():
        phases *= 2
        stress = path(phases, x, np.zeros(1))
        # every other load point, with one half or the other of those between load points 1 and 2
        one = np.arange(0, phases, 2)
        other = np.unique([0, phases // 2, *range(1, phases, 2)])
        now = largest(stress)
        size = np.where(now == 0, 1.0, np.abs(now))
        change = np.maximum(*(np.abs(now - largest(stress[half])) / size for half in (one, other)))
    return phases, change.tolist()


def _rated(
    of: Criterion,
    path: Callable[[Array, Array], Array],
    known: tuple[Array, Array, Array],
    distance: float | None,
    change: float,
) -> Rating:
    """What a criterion finds, with stress paths ``known`` on a grid: x (k,), depth (l,), and stress (s, 4, k, l)."""
    x, depth, stress = known

    def values(x: Array, depth: Array) -> Array:
        return of.at(path(x, depth)).value

    def spot(x: float, depth: float, over: str = "") -> Spot:
        stress = averaged(path, x, depth, over) if over else path(np.array(x), np.array(depth))
        value, angle, tilt = (float(each[()]) for each in of.at(stress))
        return Spot(x, depth, value, angle, tilt)

    on_grid = of.at(stress).value
    surface = spot(*largest_at(values, x, depth[:1], on_grid[:, :1]))
    peak = spot(*largest_at(values, x, depth, on_grid))
    averages = {over: spot(surface.x, distance, over) for over in (OVER if distance else ()) if distance}
    return Rating(of, surface, max(surface, peak, key=lambda each: each.value), averages, change)


def _ruiz(result: Result, path: Callable[[Array, Array], Array]) -> Ruiz:
    assert result.slip
    return ruiz(result, path(result.slip.x, np.zeros(1))[:, 0])
