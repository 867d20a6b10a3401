"""What a study of sizes found, as headings, rows and notes: for the terminal, CSV files and pages."""

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType

from partialslip.scene import Scene
from partialslip.study.fatigue import HotSpot
from partialslip.study.size.axes import Axis
from partialslip.study.size.case import EQUIVALENT, HALF_PLANE, STRIPS, Sized
from partialslip.study.size.law import NAMES, Kind, Levels, Needed, PointStatus, Sizes, Trend
from partialslip.study.size.sizes import along, hot_spots_along, refused
from partialslip.tools.output.files import csv_text

Rows = list[tuple[str, ...]]
INFINITE = "infinite"  # size that stands for an infinite one
_BY = "half-planes"  # heading of the names of models
_FITTED = "*"
_LISTED = 3  # display: largest number of sizes that are listed
_MEANINGS = {
    Kind.MEASURED: "measured: a solved size, where the difference is the level within the mesh's error",
    Kind.INTERPOLATED: "interpolated: between two solved sizes",
    Kind.EXTRAPOLATED: "extrapolated: by the law, with the 95 % confidence interval",
    Kind.BOUND: "<=, > and to: only bounds, solved sizes",
    Kind.NEVER: "never: the difference at an infinite size, of which the sizes that stay make this share",
}


@dataclass(frozen=True)
class SizeStudy:
    """A study of sizes along one axis.

    Parameters
    ----------
    scene : Scene
    axis : Axis
    models : tuple of Sizes
        The half-plane, then equivalent half-planes and exact strips if a case has them.
    remarks : tuple of str
        Cases that failed or have no equivalent half-planes, and why.
    spots : mapping of float to mapping of str to mapping of str to HotSpot
        Hot spots by size, by finite elements and names of half-planes, and by quantity; empty if the scene asks for no
        stresses.
    """

    scene: Scene
    axis: Axis
    models: tuple[Sizes, ...]
    remarks: tuple[str, ...]
    spots: Mapping[float, Mapping[str, Mapping[str, HotSpot]]] = field(default_factory=dict)

    @property
    def quantities(self) -> tuple[str, ...]:
        """Quantities that are compared."""
        return tuple(self.models[0].off)

    def part(self, quantities: Collection[str]) -> "SizeStudy":
        """Return the study of some ``quantities`` alone, without remarks."""
        return replace(self, models=tuple(model.part(quantities) for model in self.models), remarks=())

    @property
    def label(self) -> str:
        """Name of the axis with its unit."""
        return self.axis.label(self.scene.units)

    def heading(self, name: str = "size") -> str:
        """Return the heading ``name`` of a column of sizes in a CSV file, with their unit."""
        return self.axis.heading(self.scene.units, name)

    @property
    def trends(self) -> list[Trend]:
        """Trends of all models."""
        return [trend for model in self.models for trend in model.trends]


def size_study(scene: Scene, axis: Axis, entries: Sequence[Sized], levels: Levels = MappingProxyType({})) -> SizeStudy:
    """Evaluate the ``entries`` of a ledger for a sweep of ``scene`` along ``axis``, for ``levels`` of the differences
    (:func:`partialslip.study.size.law.levels`)."""
    sweeps = [along(axis, entries, name, levels) for name in (HALF_PLANE, EQUIVALENT, STRIPS)]
    models = tuple(each for each in sweeps if each.name == HALF_PLANE or each.size.size)
    halves = [
        f"{name} stands on rollers, half of a specimen: --over {name}.thickness=... gives twice the height"
        for name in axis.halves(scene)
    ]
    remarks = (*case_remarks([axis], entries), _limit_remark(scene, axis, models[0]), *halves)
    return SizeStudy(scene, axis, models, remarks, hot_spots_along(axis, entries))


def _limit_remark(scene: Scene, axis: Axis, sizes: Sizes) -> str:
    """Return at which size what remains was solved, and which sizes stay."""
    if sizes.limit not in sizes.size:
        return "what remains at an infinite size is not known: no laws, and sizes hold up to the largest solved"
    stays = " and ".join(filter(None, (", ".join(axis.stays(scene)), "the slopes of the profile")))
    return f"infinite size: solved at {size_text(sizes.limit)}; {stays} stay"


def case_remarks(axes: Sequence[Axis], entries: Sequence[Sized]) -> list[str]:
    """Return which of ``entries`` failed, and which have no equivalent half-planes, and why, as lines of text."""
    lines = [
        f"not solved: {', '.join(f'{key} {value}' for key, value in entry.labels.items())}: {entry.error}"
        for entry in entries
        if entry.error
    ]
    if without := refused(axes, entries):
        points = [
            size_text(*point) if len(point) == 1 else f"({', '.join(map(size_text, point))})" for point in without
        ]
        reason, where = next(iter(without.values())), _listed_points(points)
        lines.append(f"no equivalent half-planes at {where}: {reason}")
    return lines


def _listed_points(points: Sequence[str]) -> str:
    if len(points) <= _LISTED:
        return " and ".join(points)
    return f"{points[0]} and {len(points) - 1} more"


def size_heading(study: SizeStudy) -> str:
    """Return what was measured over which axis, as one line."""
    return f"{study.scene.name}: half-planes against finite elements, over {study.label}"


def size_answers(study: SizeStudy) -> list[str]:
    """Return from which size on the first level of each quantity is kept: a line for the half-plane, and one for
    equivalent half-planes."""
    unit = study.axis.unit(study.scene.units)
    return [
        f"{NAMES[model.name]}: "
        + ", ".join(
            f"{trend.quantity} within {percent(trend.needed[0].level)}{_from_size(trend.needed[0], unit)}"
            for trend in model.trends
        )
        for model in study.models
        if model.trends
    ]


def percent(level: float) -> str:
    """Return a level as text."""
    return f"{100 * level:g} %"


def _from_size(needed: Needed, unit: str = "") -> str:
    """Return from which size on, in ``unit``, a level is kept, as text that follows the level."""
    unit = f" {unit}" if unit else ""
    if needed.kind is Kind.NEVER:
        return ": " + str(needed).replace(": ", " (") + ")"
    if needed.kind is not Kind.BOUND:
        return f" from {needed.short}{unit} on"
    if needed.high == math.inf:
        return f": not up to {size_text(needed.low)}{unit}" if needed.low else ": not known"
    return f" from {size_text(needed.high)}{unit} on at the latest"


def differences_table(study: SizeStudy, model: Sizes) -> tuple[tuple[str, ...], Rows]:
    """Return headings and rows of the differences by size; a star says that the law is fitted to a difference."""
    points = {trend.quantity: trend.points for trend in model.trends}
    solved = {
        size: (*(marked(model.off[key][k], points[key][k]) for key in points), mesh_share(model, points, k))
        for k, size in enumerate(model.size.tolist())
    }
    without = study.models[0].size.tolist() if model.name != HALF_PLANE else ()
    failed = {size: (*["-"] * len(points), "") for size in (*model.failed, *without)}
    rows = [(row_text(model, size), *cells) for size, cells in sorted((failed | solved).items())] if points else []
    return ("size", *points, "mesh"), rows


def laws_table(study: SizeStudy) -> tuple[tuple[str, ...], Rows]:
    """Return headings and rows of the fitted laws."""
    rows: Rows = [
        (*of, str(law.floor), f"{law.C:.3g}", f"{law.k:.2f}", "{:.2f} to {:.2f}".format(*law.bounds),
         _sizes_text(law.sizes))
        for *of, trend in _by_quantity(study)
        if (law := trend.law)
    ]  # fmt: skip
    return ("remains +- C size^-k", _BY, "remains", "C", "k", "95 %", "fitted sizes"), rows


def needed_table(study: SizeStudy) -> tuple[tuple[str, ...], Rows]:
    """Return headings and rows of the sizes from which on the difference is below each level, and how they are
    known."""
    levels = sorted({needed.level for trend in study.trends for needed in trend.needed}, reverse=True)
    rows: Rows = [
        (*of, *("".join(str(needed) for needed in trend.needed if needed.level == level) for level in levels))
        for *of, trend in _by_quantity(study)
    ]
    return ("below", _BY, *map(percent, levels)), rows


def _by_quantity(study: SizeStudy) -> list[tuple[str, str, Trend]]:
    """Quantity, model and trend: the models of a quantity one after the other."""
    return [
        (trend.quantity, model.name, trend)
        for quantity in study.quantities
        for model in study.models
        for trend in model.trends
        if trend.quantity == quantity
    ]


def kinds_notes(study: SizeStudy) -> list[str]:
    """Return what the words of the sizes needed mean."""
    kinds = {needed.kind for trend in study.trends for needed in trend.needed}
    return [meaning for kind, meaning in _MEANINGS.items() if kind in kinds]


def table_notes(study: SizeStudy) -> list[str]:
    """Return what the marks of the tables of differences mean."""
    points = {point for trend in study.trends for point in trend.points}
    lines = ["mesh: the largest share of a difference that may be an error of the mesh"] if points else []
    return [f"{_FITTED}: the law is fitted to it; points.csv tells why not to others", *lines]


def points_csv(study: SizeStudy) -> str:
    """Return all points of ``study`` as CSV: absolute difference and mesh's error by half-planes, size and quantity,
    and whether it is fitted."""
    rows: list[tuple[object, ...]] = [
        (model.name, size, trend.quantity, model.off[trend.quantity][k], model.mesh[trend.quantity][k],
         trend.points[k])
        for model in study.models
        for trend in model.trends
        for k, size in enumerate(model.size.tolist())
    ]  # fmt: skip
    rows += [("", size, "", "", "", error) for size, error in study.models[0].failed.items()]
    return csv_text((_BY, study.heading(), "quantity", "difference", "error of the mesh", "point"), rows)


def laws_csv(study: SizeStudy) -> str:
    """Return laws and needed sizes of ``study`` as CSV, one row per half-planes, quantity and level; empty where there
    is none."""
    rows = [
        (
            model.name,
            trend.quantity,
            *((trend.law.C, trend.law.k, *trend.law.bounds) if trend.law else ("",) * 4),
            needed.level,
            needed.kind,
            *("" if not math.isfinite(each) or each == 0 else each for each in (needed.size, needed.low, needed.high)),
            *((abs(trend.floor.value), trend.floor.error) if trend.floor else ("", "")),
        )
        for model in study.models
        for trend in model.trends
        for needed in trend.needed
    ]
    sizes = map(study.heading, ("size", "low", "high"))
    head = (_BY, "quantity", "C", "k", "k low", "k high", "difference below", "kind", *sizes)
    return csv_text((*head, "remains", "error of what remains"), rows)


def marked(difference: float, point: PointStatus) -> str:
    """Return a difference as text, with a star if the law is fitted to it."""
    star = f"{_FITTED} " if point is PointStatus.FITTED else ""
    return "-" if math.isnan(difference) else f"{star}{difference:.1e}"


def mesh_share(sizes: Sizes, quantities: Collection[str], k: int) -> str:
    """Return the largest share of a difference of ``quantities`` that may be an error of the mesh, as text."""
    shares = [sizes.mesh[key][k] / sizes.off[key][k] for key in quantities if sizes.off[key][k] > 0]
    known = [share for share in shares if not math.isnan(share)]
    return "" if not known else f"{max(known):.1%}" if max(known) < 1 else "> 100%"


def size_text(size: float) -> str:
    """Return a size as text."""
    return f"{size:.4g}"


def row_text(model: Sizes, size: float) -> str:
    """Return a size of ``model`` as text; the one that stands for an infinite size by that name."""
    return INFINITE if size >= model.limit else size_text(size)


def _sizes_text(sizes: Sequence[float]) -> str:
    if len(sizes) <= _LISTED:
        return ", ".join(map(size_text, sizes))
    return f"{len(sizes)} from {size_text(min(sizes))} to {size_text(max(sizes))}"
