"""Hot spots: the largest sigma_xx and fatigue criteria of a result as plain data, with estimates of their errors."""

from collections.abc import Mapping
from functools import partial

import msgspec
import numpy as np

from partialslip.arrays import Array
from partialslip.errors import InputError
from partialslip.fatigue.assessment import Assessment, Rating, assess
from partialslip.fatigue.criteria import RUIZ, chosen
from partialslip.result import Result
from partialslip.scene import Fatigue, Scene
from partialslip.units import Dimension

SIGMA = "sigma_xx"
# accuracy: error of the largest sigma_xx of fem, in the discretisation error of q, relative L2, times the largest |q|:
# up to 15.9 in 31 solutions of half-planes that are known exactly
_AT_ENDS = 20.0
# accuracy: the same in all other errors of q: up to 0.12 in 47 solutions of march; fem's steps were seen on one rig
# only
_ELSEWHERE = 2.0
# accuracy: error of stresses at the surface in the difference at the ends of the contact (_edge_error): up to 2.5 in 59
# solutions of fem
_SURFACE = 3.0
# accuracy: error of averaged stresses in the error of the stresses at the ends of the contact: up to 0.52 in 57
# such solutions of fem
_AVERAGED = 0.6
_ROUNDING = 1e-9  # accuracy: of p0: less is no tension


class HotSpot(msgspec.Struct, frozen=True):
    """A largest value along the surface of the lower body, or an average below it.

    Parameters
    ----------
    value : float
        SI units.
    of : Dimension
        Dimension of the value.
    x : float
        Place, m.
    error : float or None
        Estimated relative error; None if the result has no estimate.
    """

    value: float
    of: Dimension
    x: float
    error: float | None


HotSpots = Mapping[str, HotSpot]


def hot_spots(scene: Scene, result: Result) -> dict[str, HotSpot]:
    """Return the hot spots of the lower body by quantity.

    ``sigma_xx`` is the largest at either load point. A criterion that the scene calls for, such as ``swt``, is that at
    the surface, and ``swt.point``, ``swt.line`` and ``swt.area`` are those of averaged stresses
    (:func:`partialslip.assess`). Empty if the result has no stresses, or slip reverses in a way that the result does
    not follow. Criteria without a positive value are left out, as are averages over a distance that leaves
    the body.

    Parameters
    ----------
    scene : Scene
    result : Result
        Of ``scene``, with stresses.
    """
    if not result.surface or not result.stress_at or result.path_dependent:
        return {}
    x, value = result.surface.largest
    error = _stress_error(result)
    spots = {SIGMA: HotSpot(value, "Pa", x, error)} if value > _ROUNDING * result.p0 else {}
    if scene.fatigue != Fatigue():
        found, edge = _assessed(scene, result), _edge_error(result)
        for name, rating in found.ratings.items():
            spots |= _of_rating(found, name, rating, error, edge)
    return spots


def off_by(spot: HotSpot, true: HotSpot) -> float:
    """Return the relative error of ``spot`` if ``true`` is true."""
    return abs(spot.value - true.value) / abs(true.value)


def _assessed(scene: Scene, result: Result) -> Assessment:
    names = [name for name in chosen(scene, None) if name != RUIZ]
    try:
        return assess(scene, result, names)
    except InputError:
        if scene.fatigue.distance is None:
            raise
        return assess(scene.replace({"fatigue.distance": None}), result, names)  # the distance leaves the body


def _of_rating(found: Assessment, name: str, rating: Rating, error: float | None, edge: float) -> dict[str, HotSpot]:
    """Hot spots of a criterion; the relative ``error`` of the stresses, and that at the ends of the contact besides."""
    at, of = rating.surface, rating.criterion.of
    stress = found.stress(np.array(at.x), np.zeros(()))
    off = partial(_changed_by, rating, stress)
    change = 0.0 if np.isnan(rating.change) else rating.change
    surface = None if error is None else off(error + _SURFACE * edge) + change
    below = None if error is None else off(error + _AVERAGED * edge) + change
    spots = {name: HotSpot(at.value, of, at.x, surface)}
    spots |= {f"{name}.{over}": HotSpot(spot.value, of, spot.x, below) for over, spot in rating.averages.items()}
    return {key: spot for key, spot in spots.items() if spot.value > 0}


def _changed_by(rating: Rating, stress: Array, share: float) -> float:
    """Relative change of a criterion if the ``stress`` path grows by ``share``."""
    now, then = (float(rating.criterion.at(factor * stress).value) for factor in (1.0, 1.0 + share))
    return abs(then / now - 1) if now else share


def _stress_error(result: Result) -> float | None:
    """Estimated relative error of the largest sigma_xx; None without estimates."""
    if result.method == "exact":
        return 0.0
    if SIGMA in result.estimate:
        return float(result.estimate[SIGMA])
    if "q" not in result.estimate:
        return None
    found = 0.0
    for source, share in result.shares.items():
        largest = max((share[key] for key in ("q", "q1", "q2") if key in share), default=0.0)
        at_ends = result.method == "fem" and source == "discretisation"
        found += (_AT_ENDS if at_ends else _ELSEWHERE) * largest
    levels = result.traction.values.levels or (result.traction.dq / 2,)
    return (
        float(found * max(np.abs(q).max() for q in levels) / abs(result.surface.largest[1])) if result.surface else None
    )


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
