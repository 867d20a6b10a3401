"""What a sweep goes over: parameters of a scene and their values, and the cases that they make."""

import itertools
import math
import re
from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import Any

import msgspec
import numpy as np

from partialslip.batch.job import Job
from partialslip.errors import InputError
from partialslip.run import run
from partialslip.scene import Scene
from partialslip.scene.reading import parse_scene

ACCURACY = "accuracy"  # the label that is not an axis
_COUNT = 9
_KEY = re.compile(r"(?:([0-9.]+(?:[eE][-+]?[0-9]+)?)\*)?([^*0-9].*|\*\..*)")
_NUMBER = re.compile(r"([0-9.]+(?:[eE][-+]?[0-9]+)?)(a?)")


@dataclass(frozen=True)
class Axis:
    """A parameter to sweep over: its keys in the scene, each with how many times the value it is set to; and the
    values, in the half-plane's contact half-widths where ``in_a`` is true."""

    keys: Mapping[str, float]
    values: tuple[float, ...]
    in_a: bool

    @property
    def name(self) -> str:
        """For headings: the keys that are set to the values themselves."""
        return " = ".join(key for key, times in self.keys.items() if times == 1) or " = ".join(self.keys)


def axis(text: str) -> Axis:
    """Read ``KEY[+KEY ...]=VALUES``: a list ``4a,8a,16a``, or a range ``4a..256a`` or ``4a..256a:13`` of 9, or 13,
    values in equal ratios; ``a`` is the half-plane's contact half-width. ``*`` in a key stands for any one table, and
    ``3*KEY`` is set to three times the value.

    Raises
    ------
    InputError
        If it is not that.
    """
    keys, equals, values = text.partition("=")
    named = [_KEY.fullmatch(key.strip()) for key in keys.split("+")]
    if not (equals and all(named)):
        raise InputError(f"--over {text}: must be key=values, for example bodies.*.width=4a..256a")
    span, _, count = values.partition(":")
    ends = span.split("..") if ".." in span else span.split(",")
    found = [_NUMBER.fullmatch(value.strip()) for value in ends]
    if not all(found) or (".." in span and len(ends) != 2) or (count and ".." not in span):
        raise InputError(f"--over {text}: values must be a list 4a,8a,16a or a range 4a..256a or 4a..256a:13")
    matches = [match for match in found if match]
    if len({match[2] for match in matches}) > 1:
        raise InputError(f"--over {text}: values must be all in a or none")
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
            f"--over {text}: a range must rise from above 0, in 2 to 10000 steps, and times be above 0"
        ) from None
    return Axis(times, tuple(float(f"{number:.12g}") for number in numbers), bool(matches[0][2]))


def cases(scene: Scene, axes: Sequence[Axis], accuracies: Sequence[float] = (1.0,)) -> list[Job]:
    """The cases of a sweep over the grid of all ``axes``, each at all ``accuracies``, in the scene's; these are labels,
    too.

    Raises
    ------
    InputError
        If a key is not in the scene, or a value not allowed.
    """
    a = run(scene, ["exact"]).results["exact"].a
    plain = msgspec.to_builtins(scene)
    found = []
    for values in itertools.product(*(each.values for each in axes)):
        data = deepcopy(plain)
        for each, value in zip(axes, values, strict=True):
            for key, times in each.keys.items():
                _put(data, key.split("."), value * times * (a if each.in_a else 1), key)
        labels = {each.name: value for each, value in zip(axes, values, strict=True)}
        for accuracy in accuracies:
            own = deepcopy(data)
            own["fem"]["accuracy"] = scene.fem.accuracy * accuracy
            found.append(Job(parse_scene(own), ("exact", "fem"), {**labels, ACCURACY: accuracy}))
    return found


def _put(data: dict[str, Any], path: list[str], value: float, key: str) -> None:
    """Set what ``path`` leads to, in every table that its stars stand for."""
    head, *rest = path
    if not rest:
        if head not in data:
            raise InputError(f"--over {key}: not in the scene")
        data[head] = int(value) if isinstance(data[head], int) and value == int(value) else value
        return
    tables = [name for name, table in data.items() if fnmatchcase(name, head) and isinstance(table, dict)]
    if not tables:
        raise InputError(f"--over {key}: there is no table {head!r} in the scene")
    for name in tables:
        _put(data[name], rest, value, key)
