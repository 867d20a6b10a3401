"""Dimensions of the numbers of a scene, and scenes as tables and settings as text in other units."""

import json
from collections.abc import Callable, Mapping
from typing import Any

from partialslip.scene.units import SI, Dimension, Units

_DIGITS = 10  # display: significant, of settings
_BODIES = ("bodies.upper", "bodies.lower")
_LENGTHS = ("width", "height", "pivot_height", "holder.width", "holder.height", "unit")
_BODY: dict[str, Dimension] = {**dict.fromkeys(_LENGTHS, "m"), "right_grip": "1"}

#: Dimension of every number of a scene, by key; of an array, of all its numbers.
DIMENSIONS: dict[str, Dimension] = {
    **{f"material.{body}E": "Pa" for body in ("", "upper.", "lower.")},
    **{f"material.{body}nu": "1" for body in ("", "upper.", "lower.")},
    "profile.R": "m",
    "profile.b": "m",
    "profile.crown": "m",
    "profile.x": "m",
    "profile.gap": "m",
    **{f"profile.measured.{key}": "m" for key in ("unit", "smooth", "noise", "offset", "misfit", "centre")},
    "friction.f": "1",
    "friction.x": "m",
    "load.P": "N/m",
    "load.a": "m",
    "load.p0": "Pa",
    "load.M": "N",
    "load.e": "m",
    "load.Q": "N/m",
    "load.displacement": "m",
    "load.spring": "Pa",
    "load.Q_found": "N/m",
    "load.sigma": "Pa",
    "load.sigma_slope": "Pa/m",
    **{f"{body}.{key}": of for body in _BODIES for key, of in _BODY.items()},
    "fem.accuracy": "1",
    "fem.width": "1",
    "fem.lower_size": "1",
    "fem.size": "1",
    "fatigue.sigma_y": "Pa",
    "fatigue.k_fatemi_socie": "1",
    "fatigue.k_findley": "1",
    "fatigue.alpha_dang_van": "1",
    "fatigue.alpha_crossland": "1",
    "fatigue.distance": "m",
    "fatigue.sigma_upper": "Pa",
}


def dimension(path: str) -> Dimension:
    """Return the dimension of the number at the dotted ``path`` of a scene; a tolerance has that of its input."""
    return DIMENSIONS.get(path.removeprefix("tolerance.").removesuffix(".std"), "1")


def with_units(data: Mapping[str, Any], convert: Callable[[float, Dimension], float]) -> dict[str, Any]:
    """Return the tables ``data`` of a scene with ``convert(number, dimension)`` of every number that has a dimension.

    Keys that are not in a scene, and values that are no numbers, stay as they are. A mesh without ``unit`` is in the
    unit of length of ``data``.
    """

    def each(value: Any, path: str) -> Any:
        if isinstance(value, Mapping):
            if path in _BODIES and value.get("mesh") is not None and value.get("unit") is None:
                value = {**value, "unit": 1.0}
            return {key: each(child, f"{path}.{key}") for key, child in value.items()}
        of = dimension(path)
        if of == "1":
            return value
        if isinstance(value, (list, tuple)):
            return [each(child, path) for child in value]
        return convert(value, of) if type(value) in (int, float) else value

    return {key: each(value, key) for key, value in data.items()}


def shown(key: str, value: Any, units: Units = SI) -> str:
    """Return the ``value``, in SI units, of a scene's dotted ``key`` as text in ``units``, with the unit."""
    of = DIMENSIONS.get(key, "1")

    def each(value: Any) -> str:
        if isinstance(value, (list, tuple)):
            return f"[{', '.join(map(each, value))}]"
        return units.plain(value, of, _DIGITS) if isinstance(value, float) else json.dumps(value)

    return f"{each(value)} {units.label(of)}".strip()
