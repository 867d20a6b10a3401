"""Assess a solved scene: fatigue criteria at the surface, inside the body, and averaged over a distance."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import NamedTuple

import numpy as np

from partialslip.result import Result
from partialslip.result.peak import peak_error
from partialslip.run import solved_with_stresses
from partialslip.scene import Scene
from partialslip.scene.reading import AnyScene, as_scene
from partialslip.study.fatigue.criteria import RUIZ, Criterion, beyond, check_distance, chosen, criterion
from partialslip.study.fatigue.critical_plane import Ruiz, ruiz
from partialslip.study.fatigue.cycle import settled_criteria, stress_path, unknown_between
from partialslip.study.fatigue.edges import Edge, edges
from partialslip.study.fatigue.places import OVER, averaged, depths, largest_at, surface_points
from partialslip.study.fatigue.planes import Critical
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError
from partialslip.tools.threads import one_thread

# accuracy: error of stresses at the surface in the difference at the ends of the contact (_edge_error): up to 2.5 in 59
# solutions of fem
_SURFACE = 3.0
# accuracy: error of averaged stresses in the error of the stresses at the ends of the contact: up to 0.52 in 57
# such solutions of fem
_AVERAGED = 0.6
# accuracy: height of a peak above the largest value at points, in the fall from there to the lower neighbour: 1/8 at
# most if the peak is a parabola
_BETWEEN = 0.25
BODIES = ("lower", "upper")


class CriterionErrors(NamedTuple):
    """Relative errors at the ``surface``, and ``below`` it: of averages and inside the body."""

    surface: float
    below: float


def errors_of_stresses(result: Result, body: str) -> CriterionErrors | None:
    """Return the errors of the stresses of a ``body``; None for the upper one, where the ``result`` has no estimate of
    them, and where it does not claim to hold."""
    error = peak_error(result)
    if error is None or body != "lower" or result.path_dependent or result.surface is None:
        return None
    share, edge = error / (abs(result.surface.largest[1]) or 1.0), _edge_error(result)
    return CriterionErrors(share + _SURFACE * edge, share + _AVERAGED * edge)


def criterion_errors(
    of: Criterion, stress: Array, change: float, errors: CriterionErrors | None
) -> CriterionErrors | None:
    """Return the errors of a criterion for the ``errors`` of the ``stress`` path (s, 4) of its point, and its own
    ``change`` over load points around the cycle, NaN if that is not known."""
    if errors is None:
        return None
    beside = 0.0 if np.isnan(change) else change
    now, *grown = (float(of.at((1.0 + share) * stress).value) for share in (0.0, *errors))
    changed = (abs(then / now - 1) if now else share for then, share in zip(grown, errors, strict=True))
    return CriterionErrors(*(each + beside for each in changed))


def ruiz_errors(of: Ruiz, errors: CriterionErrors | None) -> tuple[float, float] | None:
    """Return the relative errors of F1 and F2 for the ``errors`` of the stresses, to which shear and slip are
    proportional, and for points that miss the peaks."""
    if errors is None:
        return None
    grown = (1.0 + errors.surface) ** 3 - 1
    return grown + _missed(of.work), grown + _missed(of.product)


def _missed(values: Array) -> float:
    """Relative height by which the peak between points may exceed the largest of the ``values`` at the points."""
    peak = int(values.argmax())
    beside = values[max(peak - 1, 0) : peak + 2].min()
    return float(_BETWEEN * (1 - beside / values[peak])) if values[peak] > 0 else 0.0


def _edge_error(result: Result) -> float:
    """Relative error of the stresses at the ends of the contact.

    Tractions end like square roots. Their Cauchy integrals, from which criteria are found, are less accurate there than
    the strain of the surface beyond the ends: the difference is the error.
    """
    assert result.surface
    assert result.stress_at
    ends, sigma = np.array(result.ends), result.surface.sigma[0]
    at = np.abs(result.surface.x[:, None] - ends.ravel()).argmin(axis=0).reshape(ends.shape)
    integrals = result.stress_at(result.surface.x[at], np.zeros(ends.shape))[:, 0]  # by load point, then both ends
    apart = [np.abs(integrals[k, k] - sigma[k, at[k]]).max() for k in range(len(ends))]
    return float(max(apart) / np.abs(sigma).max())


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
    """Values of a criterion with their places and errors.

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
    errors : CriterionErrors or None
        Estimated relative errors at the surface, and of averages and inside the body; None if they are not known.
    """

    criterion: Criterion
    surface: Spot
    peak: Spot
    averages: Mapping[str, Spot]
    change: float
    errors: CriterionErrors | None = None


@dataclass(frozen=True, eq=False)  # arrays do not compare
class Assessment:
    """Fatigue criteria of one body of a solved scene (:func:`assess`).

    Parameters
    ----------
    scene : Scene
    result : Result
    body : str
        "lower" or "upper".
    phases : (s,) array
        Load points around the cycle, phases from 0 to 1.
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
    phases: Array
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
        from partialslip.study.fatigue.page import notebook_html

        return notebook_html(self)

    def stress(self, x: Array, depth: Array) -> Array:
        """Return the stress path (s, 4, ...), Pa, at the ``phases``, components xx, yy, xy and zz.

        Parameters
        ----------
        x, depth : arrays
            Points, m, of any common shape.
        """
        return stress_path(self.scene, self.result, self.body, self.phases, x, depth)

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


@one_thread
def assess(
    scene: AnyScene, result: Result | None = None, criteria: Iterable[str] | None = None, *, body: str = "lower"
) -> Assessment:
    """Assess a solved scene by fatigue criteria.

    The load points around the cycle are doubled until the largest value at the surface settles. The largest values are
    then sought along the surface and in the body, to two half-widths beyond and below the contact.

    Parameters
    ----------
    scene : Scene, str or path
        A scene, the name of a shipped one, or the path of a scene file.
        The table ``fatigue`` holds the constants of the criteria and the distance of averages.
    result : Result, optional
        Of ``scene``, with stresses: ``partialslip.run(scene, method, subsurface=True)[method]``. By default the scene
        is solved by the method that knows them (:func:`partialslip.run.solved_with_stresses`).
    criteria : iterable of str, optional
        Of principal, swt, fatemi-socie, findley, dang-van, crossland and ruiz. Default: all whose constants the scene
        has.
    body : "lower" or "upper"

    Raises
    ------
    InputError
        If a criterion is unknown, a constant of a named criterion is missing, the result has no stresses, or stresses
        are to be averaged over a distance that leaves the body.
    """
    scene = as_scene(scene)
    names = chosen(scene, criteria)
    if body not in BODIES:
        raise InputError(f"body {body!r}: must be of {', '.join(BODIES)}")
    check_distance(scene, body)
    result = solved_with_stresses(scene) if result is None else result
    scene = result.plates.told(scene) if result.plates else scene
    if result.stress_at is None:
        other = "another method" if scene.material.alike else "fem, as the materials are unlike"
        why = result.undetermined.get("stresses", f"run the scene with subsurface=True, or by {other}")
        raise InputError(f"{result.method}: stresses are not known; {why}")
    ruiz_asked = RUIZ in names and result.slip is not None and bool(result.slip.slip.any())
    found = [criterion(scene, name, body) for name in names if name != RUIZ]
    x = surface_points(rough_points(scene, result), result.a)
    unknown = unknown_between(result)
    path = partial(stress_path, scene, result, body)
    phases, changes = settled_criteria(scene.load, found, lambda phases: path(phases, x, np.zeros(1)), not unknown)
    at, errors = partial(path, phases), errors_of_stresses(result, body)
    grid = depths(result.a)
    stress = at(x[:, None], grid)
    ratings = {
        each.name: _rated(each, at, (x, grid, stress), scene.fatigue.distance, change, errors)
        for each, change in zip(found, changes, strict=True)
    }
    if not all(np.isfinite(spot.value) for rating in ratings.values() for spot in rating.averages.values()):
        raise beyond(scene, body)
    return Assessment(
        scene,
        result,
        body,
        phases,
        ratings,
        _ruiz(result, at, errors) if ruiz_asked else None,
        edges(scene, result),
        (f"load points 1 and 2 only: {unknown}",) if unknown else (),
    )


def rough_points(scene: Scene, result: Result) -> Array:
    """Return the points of the surface where stresses may have cusps, m: ends of the contact and of the stick zone,
    and kinks of the profile."""
    ends = np.ravel(result.ends)
    stick = [] if result.m is None or result.n is None else [-result.m, result.n]
    inside = [x for x in (*stick, *scene.profile.kinks) if ends.min() < x < ends.max()]
    return np.unique([*ends, *inside])


def _rated(
    of: Criterion,
    path: Callable[[Array, Array], Array],
    known: tuple[Array, Array, Array],
    distance: float | None,
    change: float,
    errors: CriterionErrors | None,
) -> Rating:
    """What a criterion finds, with stress paths ``known`` on a grid: x (k,), depth (l,), and stress (s, 4, k, l); and
    with the relative ``errors`` of the stresses."""
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
    off = criterion_errors(of, path(np.array(surface.x), np.zeros(())), change, errors)
    return Rating(of, surface, max(surface, peak, key=lambda each: each.value), averages, change, off)


def _ruiz(result: Result, path: Callable[[Array, Array], Array], errors: CriterionErrors | None) -> Ruiz:
    """Ruiz's parameters from the points of the slip and the ends of the contact, where the tension is largest."""
    assert result.slip
    x = np.union1d(result.slip.x, result.ends)
    found = ruiz(result, path(x, np.zeros(1))[:, 0], x)
    return found._replace(errors=ruiz_errors(found, errors))
