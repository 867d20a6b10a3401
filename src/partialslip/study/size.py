"""When is a body a half-plane? Sweeps over sizes, or anything else in a scene, against the half-plane's solution."""

import itertools
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import Any

import msgspec
import numpy as np
from scipy.stats import t as student

from partialslip.errors import InputError
from partialslip.reading import parse_scene
from partialslip.result import Array
from partialslip.run import run
from partialslip.scene import Scene
from partialslip.study.case import Case

QUANTITIES = ("a", "p", "m", "n", "q")
LEVELS = (0.05, 0.01, 0.001)
_COARSER = 8.0  # accuracy of the second mesh, in the first's
_CLEAR = 10.0  # an error of size counts where it is so many times that of the mesh
_COUNT = 9
_NUMBER = re.compile(r"([0-9.]+(?:[eE][-+]?[0-9]+)?)(a?)")


@dataclass(frozen=True)
class Axis:
    """A parameter to sweep over: its keys in the scene, and the values, in the half-plane's contact half-widths where
    ``in_a`` is true."""

    keys: tuple[str, ...]
    values: tuple[float, ...]
    in_a: bool

    @property
    def name(self) -> str:
        """For headings."""
        return " = ".join(self.keys)


def axis(text: str) -> Axis:
    """Read ``KEY[+KEY ...]=VALUES``: a list ``4a,8a,16a``, or a range ``4a..256a`` or ``4a..256a:13`` of 9, or 13,
    values in equal ratios; ``a`` is the half-plane's contact half-width. ``*`` in a key stands for any one table.

    Raises
    ------
    InputError
        If it is not that.
    """
    keys, equals, values = text.partition("=")
    names = tuple(key.strip() for key in keys.split("+"))
    if not (equals and all(names)):
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
        numbers = [float(match[1]) for match in matches]
        if ".." in span:
            number = int(count) if count else _COUNT
            if not (0 < numbers[0] < numbers[1] < math.inf and 2 <= number <= 10_000):
                raise ValueError
            numbers = np.geomspace(numbers[0], numbers[1], number).tolist()
    except ValueError:
        raise InputError(f"--over {text}: a range must rise from above 0, in 2 to 10000 steps") from None
    return Axis(names, tuple(float(f"{number:.12g}") for number in numbers), bool(matches[0][2]))


def cases(scene: Scene, axes: Sequence[Axis], meshes: int = 2) -> list[Case]:
    """The cases of a sweep over the grid of all ``axes``, each at the scene's accuracy, and with two ``meshes`` at an
    eight times coarser one, too.

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
            for key in each.keys:
                _put(data, key.split("."), value * a if each.in_a else value, key)
        labels = {each.name: value for each, value in zip(axes, values, strict=True)}
        for coarser in (1.0, _COARSER)[:meshes]:
            own = deepcopy(data)
            own["fem"]["accuracy"] = scene.fem.accuracy * coarser
            found.append(Case(parse_scene(own), ("exact", "fem"), {**labels, "coarser": coarser}))
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


@dataclass(frozen=True)
class Sizes:
    """A sweep along one axis.

    ``size`` (k,), in a or as swept; ``off`` (k,) by quantity: what the body changes: a and the largest p relative, m
    and n in a, q in the relative L2 norm; ``mesh`` (k,): what of it may be due to the mesh.
    """

    name: str
    size: Array
    off: Mapping[str, Array]
    mesh: Mapping[str, Array]


@dataclass(frozen=True)
class Law:
    """off = C size^-k, fitted by least squares in logarithms where the size dominates, k with bounds of 95 %; and the
    sizes ``needed`` for LEVELS, infinite where there is no law to go by."""

    quantity: str
    C: float
    k: float
    bounds: tuple[float, float]
    points: int
    needed: tuple[float, ...]


def along(axis: Axis, entries: Iterable[Mapping[str, Any]]) -> Sizes:
    """The sweep along ``axis``, from the entries of a ledger with its label; cases that failed are left out."""
    fine: dict[float, Mapping[str, Any]] = {}
    coarse: dict[float, Mapping[str, Any]] = {}
    for entry in entries:
        if "error" not in entry:
            (fine if entry["labels"]["coarser"] == 1 else coarse)[entry["labels"][axis.name]] = entry
    sizes = sorted(fine)
    off: dict[str, list[float]] = {quantity: [] for quantity in QUANTITIES}
    mesh: dict[str, list[float]] = {quantity: [] for quantity in QUANTITIES}
    for size in sizes:
        found, estimate = _off(fine[size]), fine[size]["methods"]["fem"]["estimate"]
        rough = _off(coarse[size]) if size in coarse else {}
        for quantity in QUANTITIES:
            off[quantity].append(abs(found.get(quantity, np.nan)))
            known = estimate.get(quantity, np.nan)
            changed = abs(rough.get(quantity, np.nan) - found.get(quantity, np.nan))
            mesh[quantity].append(float(np.fmax(known, 0.0 if math.isnan(changed) else changed / _COARSER)))
    return Sizes(
        axis.name,
        np.array(sizes),
        {key: np.array(values) for key, values in off.items()},
        {key: np.array(values) for key, values in mesh.items()},
    )


def _off(entry: Mapping[str, Any]) -> dict[str, float]:
    fem, exact, comparison = entry["methods"]["fem"], entry["methods"]["exact"], entry["comparison"]["fem"]
    found = {"a": fem["a"] / exact["a"] - 1, "p": fem["p_max"] / exact["p_max"] - 1}
    for key in ("m", "n"):
        if fem[key] is not None and exact[key] is not None:
            found[key] = (fem[key] - exact[key]) / exact["a"]
    if comparison["q"] is not None:
        found["q"] = comparison["q"]
    return found


def law(sizes: Sizes, quantity: str) -> Law | None:
    """The law of a quantity, from the larger half of the sizes at which the mesh is ten times better than the size is
    bad; None where there are fewer than three."""
    off = sizes.off[quantity]
    clear = np.flatnonzero((off > _CLEAR * sizes.mesh[quantity]) & (off > 0))
    used = clear[len(clear) // 2 :] if len(clear) >= 6 else clear[-3:]
    if len(used) < 3:
        return None
    x, y = np.log(sizes.size[used]), np.log(off[used])
    slope, start = np.polyfit(x, y, 1)
    spread = math.sqrt(np.sum((y - slope * x - start) ** 2) / (len(used) - 2) / np.sum((x - x.mean()) ** 2))
    beside = float(student.ppf(0.975, len(used) - 2)) * spread
    needed = tuple(_needed(sizes.size[clear], off[clear], level, math.exp(start), -slope) for level in LEVELS)
    return Law(quantity, math.exp(start), -slope, (-slope - beside, -slope + beside), len(used), needed)


def _needed(size: Array, off: Array, level: float, C: float, k: float) -> float:
    """The size from which on the error is below ``level``: between those measured, or beyond them by the law."""
    above = np.flatnonzero(off > level)
    if len(above) == 0:
        return float(size[0])
    last = above[-1]
    if last == len(size) - 1:
        return float((C / level) ** (1 / k)) if k > 0 else math.inf
    ends = slice(last, last + 2)
    return float(np.exp(np.interp(-np.log(level), -np.log(off[ends]), np.log(size[ends]))))


def grid(axes: Sequence[Axis], entries: Iterable[Mapping[str, Any]], quantity: str) -> tuple[Array, Array, Array]:
    """The values of two ``axes``, and |change| of ``quantity`` over them, (second, first); NaN where not solved."""
    x, y = (np.array(each.values) for each in axes)
    off = np.full((len(y), len(x)), np.nan)
    for entry in entries:
        if "error" not in entry and entry["labels"]["coarser"] == 1:
            at = tuple(np.flatnonzero(v == entry["labels"][each.name]) for v, each in zip((x, y), axes, strict=True))
            off[at[1], at[0]] = abs(_off(entry).get(quantity, np.nan))
    return x, y, off


def table(axes: Sequence[Axis], entries: Iterable[Mapping[str, Any]]) -> tuple[list[str], list[list[Any]]]:
    """Headings and rows for a CSV file: one row a case."""
    figures = ("a", "p_max", "m", "n", "regime")
    head = [*(each.name for each in axes), "coarser", *figures, *(f"change of {key}" for key in QUANTITIES)]
    head += ["dofs", "cpu_s", "error"]
    rows = []
    for entry in entries:
        row = [entry["labels"][name] for name in (*(each.name for each in axes), "coarser")]
        if "error" in entry:
            rows.append([*row, *[""] * (len(head) - len(row) - 1), entry["error"]])
        else:
            fem, off = entry["methods"]["fem"], _off(entry)
            costs = [fem["counts"]["dofs"], fem["cost"]["cpu_s"], ""]
            rows.append([*row, *(fem[key] for key in figures), *(off.get(key, "") for key in QUANTITIES), *costs])
    return head, rows
