"""Hot spots: the largest sigma_xx and fatigue criteria of a result as plain data, with estimates of their errors."""

from collections.abc import Mapping

import msgspec

from partialslip.result import Result
from partialslip.result.peak import SIGMA as SIGMA
from partialslip.result.peak import peak_error
from partialslip.scene import Fatigue, Scene
from partialslip.scene.units import Dimension
from partialslip.study.fatigue.assessment import Assessment, Rating, assess
from partialslip.study.fatigue.criteria import RUIZ, chosen
from partialslip.tools.errors import InputError

_ROUNDING = 1e-9  # limit: of p0: less is no tension


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
    error, spots = peak_error(result), dict[str, HotSpot]()
    if value > _ROUNDING * result.p0:
        spots[SIGMA] = HotSpot(value, "Pa", x, None if error is None else error / value)
    if scene.fatigue != Fatigue():
        for name, rating in _assessed(scene, result).ratings.items():
            spots |= _of_rating(name, rating)
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


def _of_rating(name: str, rating: Rating) -> dict[str, HotSpot]:
    """Hot spots of a criterion."""
    at, of, errors = rating.surface, rating.criterion.of, rating.errors
    spots = {name: HotSpot(at.value, of, at.x, errors and errors.surface)}
    for over, spot in rating.averages.items():
        spots[f"{name}.{over}"] = HotSpot(spot.value, of, spot.x, errors and errors.below)
    return {key: spot for key, spot in spots.items() if spot.value > 0}
