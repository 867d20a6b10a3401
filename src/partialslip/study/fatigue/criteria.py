"""The criteria by name, with the constants of a scene."""

import itertools
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from partialslip.scene import Body, Elastic, Scene
from partialslip.scene.reading import meant
from partialslip.scene.units import Dimension
from partialslip.study.fatigue.critical_plane import (
    fatemi_socie_measure,
    findley_measure,
    principal_range,
    range_measure,
    swt_measure,
)
from partialslip.study.fatigue.planes import Critical, PlaneMeasure, critical_plane
from partialslip.tools.arrays import Array, Indices
from partialslip.tools.errors import InputError

_SLACK = 1e-12  # accuracy: of the radius: a point this far outside lies on the sphere
_MOST = 100  # limit: steps; each makes the sphere larger, a few are enough


def dang_van(stress: Array, alpha: float) -> Array:
    """Dang Van's parameter, Pa: max over the cycle of tau + alpha p.

    p = (sigma_xx + sigma_yy + sigma_zz)/3, and tau is the largest shear stress (Tresca) of the mesoscopic deviator
    s - s*, with s* the centre of the smallest sphere around the path of the deviator s, to which the grains shake down.

    Parameters
    ----------
    stress : (s, 4, ...) array
        sigma_xx, sigma_yy, sigma_xy and sigma_zz, Pa.
    alpha : float
        Influence of the hydrostatic stress, of the material.

    References
    ----------
    K. Dang Van, G. Cailletaud, J. F. Flavenot, A. Le Douaron, H. P. Lieurade, Criterion for high cycle fatigue failure
    under multiaxial loading, in: Biaxial and Multiaxial Fatigue, EGF 3 (1989) 459-478.
    """
    pressure, deviator = _split(stress)
    half, zz, xy = deviator - smallest_sphere(deviator)[0]  # (xx - yy)/sqrt(2), sqrt(3/2) zz, sqrt(2) xy
    radius = np.hypot(half, xy) / np.sqrt(2)
    tresca = np.maximum(radius, (radius + np.sqrt(1.5) * np.abs(zz)) / 2)  # principal values -zz/2 +- radius and zz
    return (tresca + alpha * pressure).max(axis=0)


def crossland(stress: Array, alpha: float) -> Array:
    """Crossland's parameter, Pa: sqrt(J2)_a + alpha p_max.

    sqrt(J2)_a is the amplitude of the deviator s, the radius of the smallest sphere around its path by the norm
    sqrt(s : s/2), and p_max the largest (sigma_xx + sigma_yy + sigma_zz)/3 during the cycle.

    Parameters
    ----------
    stress : (s, 4, ...) array
        sigma_xx, sigma_yy, sigma_xy and sigma_zz, Pa.
    alpha : float
        Influence of the hydrostatic stress, of the material.

    References
    ----------
    B. Crossland, Effect of large hydrostatic pressures on the torsional fatigue strength of an alloy steel, Int. Conf.
    on Fatigue of Metals, London (1956) 138-149; the sphere: I. V. Papadopoulos, P. Davoli, C. Gorla, M. Filippini,
    A. Bernasconi, A comparative study of multiaxial high-cycle fatigue criteria for metals, Int. J. Fatigue 19 (1997)
    219-235.
    """
    pressure, deviator = _split(stress)
    return smallest_sphere(deviator)[1] / np.sqrt(2) + alpha * pressure.max(axis=0)


def _split(stress: Array) -> tuple[Array, Array]:
    """Hydrostatic stress (s, ...), and deviator (3, s, ...) in coordinates in which s : s is its square."""
    xx, yy, xy, zz = np.moveaxis(stress, 1, 0)
    pressure = (xx + yy + zz) / 3
    return pressure, np.stack([(xx - yy) / np.sqrt(2), np.sqrt(1.5) * (zz - pressure), np.sqrt(2) * xy])


def smallest_sphere(path: Array) -> tuple[Array, Array]:
    """Return centres (3, 1, ...) and radii (...) of the smallest spheres around paths.

    The sphere touches at most four points. A step adds the point farthest outside to those touched, and finds the
    sphere around these five; the spheres grow until no point is outside. For two points the centre is their midpoint.

    Parameters
    ----------
    path : (3, s, ...) array
        Coordinates of the s points of each path.
    """
    shape = path.shape[2:]
    points = path.reshape(3, path.shape[1], -1)
    count = points.shape[2]
    first = _farthest(points, points[:, 0])
    second = _farthest(points, _taken(points, first))
    touched = np.stack([first, second, second, second])
    centre = (_taken(points, first) + _taken(points, second)) / 2
    radius = _distances(_taken(points, first), centre)
    open_ = np.arange(count)
    for _ in range(_MOST):
        outside = _distances(points[:, :, open_], centre[:, None, open_])
        farthest = outside.argmax(axis=0)
        more = outside.max(axis=0, initial=0.0) > radius[open_] * (1 + _SLACK)
        open_, farthest = open_[more], farthest[more]
        if not len(open_):
            break
        five = np.concatenate([farthest[None], touched[:, open_]])
        corners = np.take_along_axis(points[:, :, open_], five[None], axis=1)
        centre[:, open_], radius[open_], chosen = _around_five(corners)
        touched[:, open_] = np.take_along_axis(five, chosen, axis=0)
    return centre.reshape(3, 1, *shape), radius.reshape(shape)


def _around_five(corners: Array) -> tuple[Array, Array, Indices]:
    """Centre (3, n), radius (n,) and the numbers (4, n) of the points touched of the smallest sphere around ``corners``
    (3, 5, n) that touches the first.

    Of the spheres through the first and up to three others, with the centre in their span: the centre from which the
    farthest of the five is nearest.
    """
    count = corners.shape[2]
    base, apart = corners[:, 0], corners[:, 1:] - corners[:, :1]
    centre, radius, chosen = np.empty((3, count)), np.full(count, np.inf), np.zeros((4, count), int)
    for size in (1, 2, 3):
        for subset in itertools.combinations(range(4), size):
            edges = apart[:, subset]
            gram = np.einsum("ijn,ikn->njk", edges, edges)
            squares = np.einsum("njj->nj", gram)
            weights = (np.linalg.pinv(gram, rcond=1e-10, hermitian=True) @ squares[..., None] / 2)[..., 0]
            middle = base + np.einsum("ijn,nj->in", edges, weights)
            reach = _distances(corners, middle[:, None]).max(axis=0)
            nearer = reach < radius * (1 - _SLACK)
            radius[nearer], centre[:, nearer] = reach[nearer], middle[:, nearer]
            numbers = [0, *(number + 1 for number in subset)]
            chosen[:, nearer] = np.array([*numbers, *[0] * (4 - len(numbers))])[:, None]
    return centre, radius, chosen


def _distances(points: Array, centre: Array) -> Array:
    return np.sqrt(((points - centre) ** 2).sum(axis=0))


def _farthest(points: Array, centre: Array) -> Indices:
    return _distances(points, centre[:, None]).argmax(axis=0)


def _taken(points: Array, number: Indices) -> Array:
    """The points (3, n) of ``number`` (n,) of each path of ``points`` (3, s, n)."""
    return np.take_along_axis(points, number[None, None], axis=1)[:, 0]


class Known(NamedTuple):
    """What is known of a criterion: the keys of the table fatigue that it ``needs``, the dimension ``of`` its values,
    and from the elastic constants of the body and the scene's table either its ``measure`` on a plane, or its
    ``invariant`` of stress paths; neither for :data:`RUIZ`. ``at``: the critical plane, where it has a closed form."""

    needs: tuple[str, ...] = ()
    of: Dimension = "Pa"
    measure: Callable[[Elastic, Any], PlaneMeasure] | None = None
    invariant: Callable[[Array, Any], Array] | None = None
    at: Callable[[Array], Critical] | None = None


RUIZ = "ruiz"  # of the surface, with slip: not a function of the stress path
#: The criteria by name. A new one is entered here.
CRITERIA = {
    "principal": Known(measure=lambda *_: range_measure, at=principal_range),
    "swt": Known(measure=lambda own, _: swt_measure(own.E, own.nu)),
    "fatemi-socie": Known(
        ("k_fatemi_socie", "sigma_y"),
        "1",
        lambda own, known: fatemi_socie_measure(own.E, own.nu, known.k_fatemi_socie, known.sigma_y),
    ),
    "findley": Known(("k_findley",), measure=lambda _, known: findley_measure(known.k_findley)),
    "dang-van": Known(
        ("alpha_dang_van",), invariant=lambda stress, known: dang_van(stress, alpha=known.alpha_dang_van)
    ),
    "crossland": Known(
        ("alpha_crossland",), invariant=lambda stress, known: crossland(stress, alpha=known.alpha_crossland)
    ),
    RUIZ: Known(),
}


@dataclass(frozen=True)
class Criterion:
    """A criterion with its constants.

    Parameters
    ----------
    name : str
    of : Dimension
        Of its values.
    at : callable
        ``at(stress) -> Critical`` of stress paths (s, 4, ...), Pa. Without planes the angle and the tilt are NaN.
    measure : callable or None
        The measure on a plane; None for criteria of invariants.
    """

    name: str
    of: Dimension
    at: Callable[[Array], Critical]
    measure: PlaneMeasure | None = None


def chosen(scene: Scene, names: Iterable[str] | None) -> list[str]:
    """Return the names of the criteria to assess: ``names``, also in capitals, or all whose constants the scene has.

    Raises
    ------
    InputError
        If a criterion is unknown, or a constant of a named criterion is missing.
    """
    if names is None:
        return [name for name in CRITERIA if not _missing(scene, name)]
    found = {name.lower() if isinstance(name, str) else name: name for name in names}
    for name, given in found.items():
        if name not in CRITERIA:
            raise InputError(f"criterion {given!r}: must be of {', '.join(CRITERIA)}{meant(str(given), CRITERIA)}")
        if missing := _missing(scene, name):
            raise InputError(f"fatigue.{missing[0]}: missing; the criterion {name} needs it")
    return list(found)


def check_distance(scene: Scene, body: str) -> None:
    """Raise InputError if ``fatigue.distance`` is more than the height of the ``body`` lower or upper."""
    own: Body | None = getattr(scene.bodies, body)
    if scene.fatigue.distance is None or own is None or own.height is None:
        return
    height = own.height + (own.holder.height if own.holder else 0.0)
    if scene.fatigue.distance > height:
        raise beyond(scene, body, f"; the body is {scene.units.labelled(height, 'm')} high")


def beyond(scene: Scene, body: str, why: str = "") -> InputError:
    """Return the error for stresses that are to be averaged over a distance that leaves the ``body``, and ``why``."""
    distance = scene.units.labelled(scene.fatigue.distance or 0.0, "m")
    return InputError(f"fatigue.distance = {distance}: must not leave the {body} body below the hot spot{why}")


def _missing(scene: Scene, name: str) -> list[str]:
    return [key for key in CRITERIA[name].needs if getattr(scene.fatigue, key) is None]


def criterion(scene: Scene, name: str, body: str) -> Criterion:
    """Return the criterion ``name``, except ruiz, with the constants of ``scene``, for the ``body`` lower or upper."""
    known = CRITERIA[name]
    if (invariant := known.invariant) is not None:
        return Criterion(name, known.of, _without_plane(lambda stress: invariant(stress, scene.fatigue)))
    assert known.measure
    measure = known.measure(elastic(scene, body), scene.fatigue)
    return Criterion(name, known.of, known.at or partial(critical_plane, measure=measure), measure)


def elastic(scene: Scene, body: str) -> Elastic:
    """Return E and nu of the ``body`` lower or upper."""
    tables = dict(scene.material)
    return tables.get(f"material.{body}") or tables["material"]


def _without_plane(function: Callable[[Array], Array]) -> Callable[[Array], Critical]:
    def at(stress: Array) -> Critical:
        value = function(stress)
        nowhere = np.full_like(value, np.nan)
        return Critical(value, nowhere, nowhere)

    return at
