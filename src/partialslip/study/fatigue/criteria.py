"""The criteria by name, with the constants of a scene."""

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
from partialslip.study.fatigue.invariants import crossland, dang_van
from partialslip.study.fatigue.planes import Critical, PlaneMeasure, critical_plane
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError


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
