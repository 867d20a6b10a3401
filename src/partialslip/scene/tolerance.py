"""Tolerances of the numbers of a scene: half-widths or standard deviations. They change no solution."""

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import msgspec

from partialslip.scene.dimensions import shown
from partialslip.scene.table import Positive, Table
from partialslip.scene.units import SI, Units
from partialslip.tools.errors import InputError

if TYPE_CHECKING:
    from partialslip.scene.model import Scene

REACH = 2.0  # fixed: standard deviations that count as the reach of a normal distribution
_FAR = 1.5  # limit: of the reach: values up to there must be allowed in a scene, 3 standard deviations
_MOST = 12  # limit: inputs with a tolerance; solves grow like their number
_PERCENT = re.compile(r"\s*(\d+\.?\d*(?:[eE][+-]?\d+)?)\s*%\s*", re.ASCII)
_FORMS = "must be a half-width such as 0.015 or '5 %', or {std = ...} of a normal distribution"


class Normal(Table, frozen=True, kw_only=True):
    """Normal distribution with the standard deviation ``std``: in the unit of the input, or text such as "2 %"."""

    std: Positive | str


Width = Positive | str | Normal
"""Half-width of a uniform distribution, in the unit of the input or text such as "5 %"; or a normal distribution."""


class ElasticWidths(Table, frozen=True, kw_only=True):
    """Tolerances of ``E`` and ``nu`` of one body."""

    E: Width | None = None
    nu: Width | None = None


class MaterialWidths(ElasticWidths, frozen=True, kw_only=True):
    """Tolerances of ``[material]``."""

    upper: ElasticWidths | None = None
    lower: ElasticWidths | None = None


class ProfileWidths(Table, frozen=True, kw_only=True):
    """Tolerances of ``[profile]``."""

    R: Width | None = None
    b: Width | None = None
    crown: Width | None = None
    x: Width | None = None
    gap: Width | None = None


class FrictionWidths(Table, frozen=True, kw_only=True):
    """Tolerances of ``[friction]``."""

    f: Width | None = None


class LoadWidths(Table, frozen=True, kw_only=True):
    """Tolerances of ``[load]``."""

    P: Width | None = None
    a: Width | None = None
    p0: Width | None = None
    M: Width | None = None
    e: Width | None = None
    Q: Width | None = None
    sigma: Width | None = None
    sigma_slope: Width | None = None


class HolderWidths(Table, frozen=True, kw_only=True):
    """Tolerances of a holder."""

    width: Width | None = None
    height: Width | None = None


class BodyWidths(HolderWidths, frozen=True, kw_only=True):
    """Tolerances of a body."""

    holder: HolderWidths | None = None
    pivot_height: Width | None = None
    right_grip: Width | None = None


class BodiesWidths(Table, frozen=True, kw_only=True):
    """Tolerances of ``[bodies]``."""

    upper: BodyWidths | None = None
    lower: BodyWidths | None = None


class FatigueWidths(Table, frozen=True, kw_only=True):
    """Tolerances of ``[fatigue]``."""

    sigma_y: Width | None = None
    k_fatemi_socie: Width | None = None
    k_findley: Width | None = None
    alpha_dang_van: Width | None = None
    alpha_crossland: Width | None = None
    distance: Width | None = None
    sigma_upper: Width | None = None


class Tolerance(Table, frozen=True, kw_only=True):
    """Tolerances of a scene, by the tables and keys of the scene."""

    material: MaterialWidths | None = None
    profile: ProfileWidths | None = None
    friction: FrictionWidths | None = None
    load: LoadWidths | None = None
    bodies: BodiesWidths | None = None
    fatigue: FatigueWidths | None = None


@dataclass(frozen=True)
class Input:
    """A number of a scene with a tolerance; of a list the tolerance is on the number of the largest size, and all
    change in proportion.

    Parameters
    ----------
    key : str
        Dotted key, "friction.f".
    value : float or tuple of float
        SI units.
    reach : float
        Half-width of a uniform distribution, :data:`REACH` standard deviations of a normal one, SI units.
    normal : bool
    text : str
        The tolerance as text: "5 %".
    """

    key: str
    value: float | tuple[float, ...]
    reach: float
    normal: bool
    text: str

    def at(self, deviation: float) -> float | list[float]:
        """Value at a ``deviation``, in reaches."""
        if isinstance(self.value, tuple):
            factor = 1 + deviation * self.reach / self.size
            return [each * factor for each in self.value]
        return self.value + deviation * self.reach

    @property
    def size(self) -> float:
        """Size of the value; of a list the largest size in it."""
        return max(map(abs, self.value)) if isinstance(self.value, tuple) else abs(self.value)

    def number(self, deviation: float) -> float:
        """The value at a ``deviation`` as one number; of a list the number of the largest size, without sign."""
        return (self.size if isinstance(self.value, tuple) else self.value) + deviation * self.reach


def inputs(scene: "Scene", units: Units = SI) -> tuple[Input, ...]:
    """Return the numbers of ``scene`` that have a tolerance; absolute tolerances are shown in ``units``.

    Raises
    ------
    InputError
        If a tolerance is no tolerance, or one of a number that the scene does not give.
    """
    if scene.tolerance is None:
        return ()
    if scene.load.displacement is not None:
        raise InputError("tolerance: must be left out with load.displacement, for which only fem finds Q: give load.Q")
    tables = msgspec.to_builtins(scene)
    widths = dict(_leaves(tables["tolerance"]))
    if len(widths) > _MOST:
        raise InputError(f"tolerance: {len(widths)} inputs: must be at most {_MOST}")
    return tuple(_input(key, width, _value_at(tables, key), units) for key, width in widths.items())


def _leaves(table: Mapping[str, Any], before: str = "") -> list[tuple[str, Any]]:
    """Pairs of dotted key and tolerance."""
    found: list[tuple[str, Any]] = []
    for key, width in table.items():
        if isinstance(width, dict) and "std" not in width:
            found += _leaves(width, f"{before}{key}.")
        elif width is not None:
            found.append((before + key, width))
    return found


def _value_at(tables: Any, key: str) -> Any:
    for name in key.split("."):
        tables = tables.get(name) if isinstance(tables, dict) else None
    return tables


def _input(key: str, width: Any, value: Any, units: Units) -> Input:
    normal = isinstance(width, dict)
    given = width["std"] if normal else width
    place = f"tolerance.{key}"
    if not isinstance(value, (int, float, Sequence)) or isinstance(value, (str, bool)):
        raise InputError(f"{place}: the scene gives no number {key}: give {key}, or remove its tolerance")
    value = tuple(value) if isinstance(value, Sequence) else float(value)
    size = max(map(abs, value)) if isinstance(value, tuple) else abs(value)
    text = shown(key, given, units) if isinstance(given, float) else str(given)
    if isinstance(given, str):
        if not (percent := _PERCENT.fullmatch(given)) or not 0 < float(percent[1]) < math.inf:
            raise InputError(f"{place} = {given!r:.60}: {_FORMS}")
        if not size:
            raise InputError(f"{place} = {given!r}: {key} is 0, of which no share can be taken: give a number")
        given, text = size * float(percent[1]) / 100, f"{percent[1]} %"
    elif not size and isinstance(value, tuple):
        raise InputError(f"{place} = {given:g}: all numbers of {key} are 0, and a list changes in proportion")
    return Input(key, value, given * (REACH if normal else 1.0), normal, f"{text} (std)" if normal else text)


def moved(scene: "Scene", changed: Sequence[Input], deviations: Iterable[float]) -> "Scene":
    """Return ``scene`` with each of the inputs ``changed`` at its deviation, in reaches, and without tolerances.

    Raises
    ------
    InputError
        If there is no such scene.
    """
    values = {each.key: each.at(float(deviation)) for each, deviation in zip(changed, deviations, strict=True)}
    return scene.replace({**values, "tolerance": None})


def check(scene: "Scene", units: Units = SI) -> None:
    """Raise InputError if an input with a tolerance may leave the range that a scene allows."""
    for each in inputs(scene, units):
        for side in (-1.0, 1.0):
            try:
                moved(scene, [each], [side * (_FAR if each.normal else 1.0)])
            except InputError as error:
                raise InputError(f"tolerance.{each.key} = {each.text!r}: too wide: {error}") from None
