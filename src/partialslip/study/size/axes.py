"""Axes of a sweep: parameters of a scene and their values, and the cases of the grid."""

import itertools
import math
import re
from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from typing import Any

import numpy as np

from partialslip.run import run
from partialslip.scene import Scene
from partialslip.scene.dimensions import DIMENSIONS
from partialslip.scene.plan import asks_for_stresses
from partialslip.scene.reading import meant, parse_scene, scene_tables
from partialslip.scene.units import Dimension, Units
from partialslip.study.batch.job import Job
from partialslip.study.size.case import compared_methods, half_plane_method
from partialslip.study.size.law import BEYOND, CLEAR
from partialslip.tools.errors import InputError

ACCURACY = "accuracy"  # label of a case besides the axes
_THICKNESS = ".thickness"  # end of the key for twice the height of a body on rollers: of all of a specimen
_COUNT = 9  # display: values of a range without a number of them
_KEY = re.compile(r"(?:([0-9.]+(?:[eE][-+]?[0-9]+)?)\*)?([^*0-9].*|\*\..*)")
_NUMBER = re.compile(r"([0-9.]+(?:[eE][-+]?[0-9]+)?)(a?)")


@dataclass(frozen=True)
class Axis:
    """One axis of a sweep.

    Parameters
    ----------
    keys : mapping of str to float
        Keys of the scene, each with the factor by which the value is multiplied.
    values : tuple of float
        Values, in contact half-widths of the half-plane if ``in_a``, else in the scene's units.
    in_a : bool
    """

    keys: Mapping[str, float]
    values: tuple[float, ...]
    in_a: bool

    @property
    def name(self) -> str:
        """Name for headings: the keys with a factor of 1."""
        return " = ".join(key for key, times in self.keys.items() if times == 1) or " = ".join(self.keys)

    @property
    def settings(self) -> dict[str, float]:
        """Keys as scenes have them, with factors: a thickness is twice the height."""
        halves = {key: key.removesuffix(_THICKNESS) + ".height" for key in self.keys if key.endswith(_THICKNESS)}
        return {halves.get(key, key): times / (2 if key in halves else 1) for key, times in self.keys.items()}

    @property
    def limit(self) -> float:
        """Value that stands for an infinite size: what falls with 1/size is CLEAR times smaller there than at the
        farthest size that a law is trusted for. Infinite for an axis of other settings than sizes of bodies."""
        sizes = all(key.startswith("bodies.") for key in self.keys) and self._dimension == "m"
        return CLEAR * BEYOND * max(self.values) if sizes and max(self.values) > 0 else math.inf

    def stays(self, scene: Scene) -> list[str]:
        """Return the keys of the lengths of the bodies of ``scene`` that the axis does not set."""

        def is_set(path: list[str]) -> bool:
            keys = [key.split(".") for key in self.settings]
            return any(len(key) == len(path) and all(map(fnmatchcase, path, key)) for key in keys)

        tables, found = scene_tables(scene), []
        for known, of in DIMENSIONS.items():
            path = known.split(".")
            value: Any = tables
            for part in path:
                value = value.get(part) if isinstance(value, dict) else None
            if path[0] == "bodies" and of == "m" and value is not None and not is_set(path):
                found.append(known)
        return found

    def check_thickness(self, scene: Scene) -> None:
        """Refuse a thickness of bodies that do not stand on rollers, in the middle plane of a specimen."""
        for name, body in scene.bodies:
            key = next((key for key in self.keys if fnmatchcase(name + _THICKNESS, key)), "")
            if key.endswith(_THICKNESS) and body.support != "roller":
                why = "only a body on rollers is half of a specimen"
                raise InputError(f"--over {key}: {why}; {name}.support = {body.support!r}: use {name}.height")

    def halves(self, scene: Scene) -> list[str]:
        """Return the names of bodies of ``scene`` on rollers whose height, half of a thickness, the axis sets."""
        found = [name for name, body in scene.bodies if body.support == "roller"]
        return [name for name in found if any(fnmatchcase(f"{name}.height", key) for key in self.keys)]

    @property
    def beyond(self) -> "Axis":
        """Axis with the single value :attr:`limit`, which stands for an infinite size."""
        return replace(self, values=(self.limit,))

    def label(self, units: Units) -> str:
        """Name with the unit of the values."""
        if self.in_a:
            return f"{self.name} in contact half-widths"
        return self.name if self._dimension == "1" else f"{self.name} in {units.label(self._dimension)}"

    def unit(self, units: Units) -> str:
        """Unit of the values; empty for a number."""
        return "a" if self.in_a else units.label(self._dimension)

    def heading(self, units: Units, name: str) -> str:
        """Heading ``name`` of a column of values in a CSV file, with their unit in brackets unless SI."""
        return f"{name} [a of the half-plane]" if self.in_a else units.heading(name, self._dimension)

    @property
    def _dimension(self) -> Dimension:
        set_by = self.settings
        found = {of for known, of in DIMENSIONS.items() if any(fnmatchcase(known, key) for key in set_by)} - {"1"}
        return found.pop() if len(found) == 1 else "1"


def axis(text: str) -> Axis:
    """Parse ``text``, ``KEY[+KEY ...]=VALUES``, as an axis.

    Values are a list ``4a,8a,16a`` or a range in equal ratios: ``4a..256a`` of 9 values, ``4a..256a:13`` of 13. The
    unit ``a`` is the half-plane's contact half-width. ``*`` in a key stands for any one table; ``3*KEY`` is set to
    three times the value. ``bodies.lower.thickness`` is twice the height of a body on rollers.

    Raises
    ------
    InputError
        If ``text`` has another form.
    """
    keys, equals, values = text.partition("=")
    named = [_KEY.fullmatch(key.strip()) for key in keys.split("+")]
    if not (equals and all(named)):
        raise InputError(f"--over {text}: must be key=values, for example bodies.*.width=4a..256a")
    span, _, count = values.partition(":")
    ends = span.split("..") if ".." in span else span.split(",")
    found = [_NUMBER.fullmatch(value.strip()) for value in ends]
    if not all(found) or (".." in span and len(ends) != 2) or (count and ".." not in span):
        for value, match in zip(ends, found, strict=True):
            if value.strip() and not match and not _is_positive(value.strip().removesuffix("a")):
                raise InputError(f"--over {keys}: {value.strip()!r}: must be a number > 0, such as 4 or 4a")
        raise InputError(f"--over {text}: values must be a list 4a,8a,16a or a range 4a..256a or 4a..256a:13")
    matches = [match for match in found if match]
    if len({match[2] for match in matches}) > 1:
        raise InputError(f"--over {text}: values must be all in a or all without a")
    try:
        times = {match[2]: float(match[1] or 1) for match in named if match}
        if not all(0 < each < math.inf for each in times.values()):
            raise ValueError
        numbers = [float(match[1]) for match in matches]
        if ".." in span:
            number = int(count) if count else _COUNT
            if not (0 < numbers[0] < numbers[1] < math.inf and 2 <= number <= 10_000):
                raise ValueError
            numbers = np.geomspace(numbers[0], numbers[1], number).tolist()
    except ValueError:
        raise InputError(
            f"--over {text}: a range must increase from above 0, in 2 to 10000 values; factors must be > 0"
        ) from None
    return Axis(times, tuple(float(f"{number:.12g}") for number in numbers), bool(matches[0][2]))


def _is_positive(text: str) -> bool:
    try:
        return 0 < float(text) < math.inf
    except ValueError:
        return False


def cases(scene: Scene, axes: Sequence[Axis], accuracies: Sequence[float] = (1.0,)) -> list[Job]:
    """Return the jobs of a sweep over the grid of ``axes``.

    Parameters
    ----------
    scene : Scene
    axes : sequence of Axis
    accuracies : sequence of float
        Each point is solved at each of these multiples of the scene's accuracy; the multiple is a label of the job.

    Raises
    ------
    InputError
        If a key is not in the scene, or a value is not allowed; or if Q is not given.
    """
    if scene.load.displacement is not None:
        shown = ", ".join(scene.units.plain(each, "m") for each in scene.load.displacement)
        why = "must be left out of a study of sizes, as half-planes have no plates; give load.Q"
        raise InputError(f"load.displacement = [{shown}]: {why}")
    for each in axes:
        each.check_thickness(scene)
    a = _half_width(scene) if any(each.in_a for each in axes) else 1.0
    plain = scene_tables(scene)
    found = []
    for values in itertools.product(*(each.values for each in axes)):
        data = deepcopy(plain)
        for each, value in zip(axes, values, strict=True):
            for key, times in each.settings.items():
                _put(data, key.split("."), value * times * (a if each.in_a else 1), key)
        labels = {each.name: value for each, value in zip(axes, values, strict=True)}
        for accuracy in accuracies:
            own = deepcopy(data)
            own["fem"]["accuracy"] = scene.fem.accuracy * accuracy
            point = parse_scene(own)
            labelled = {**labels, ACCURACY: accuracy}
            found.append(Job(point, compared_methods(point), labelled, asks_for_stresses(point)))
    return found


def _half_width(scene: Scene) -> float:
    """Contact half-width of the half-plane, in the scene's units."""
    method = half_plane_method(scene)
    return scene.units.from_si(run(scene.half_planes, method)[method].a, "m")


def _put(data: dict[str, Any], path: list[str], value: float, key: str) -> None:
    """Set the key at ``path`` to ``value``, in every table that matches a star in the path."""
    head, *rest = path
    if not rest:
        if head not in data:
            raise InputError(f"--over {key}: not in the scene{meant(head, data)}")
        data[head] = int(value) if isinstance(data[head], int) and value == int(value) else value
        return
    tables = [name for name, table in data.items() if isinstance(table, dict)]
    named = [name for name in tables if fnmatchcase(name, head)]
    if not named:
        raise InputError(f"--over {key}: no table {head!r} in the scene{meant(head, tables)}")
    for name in named:
        _put(data[name], rest, value, key)
