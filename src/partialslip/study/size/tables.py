"""What a study of sizes found, as headings, rows and notes: for the terminal, CSV files and pages."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from partialslip.batch.job import Solved
from partialslip.output.csv import csv_text
from partialslip.scene import Scene
from partialslip.study.size.axes import Axis
from partialslip.study.size.law import LEVELS, Kind, Point, Trend, trends
from partialslip.study.size.sizes import QUANTITIES, Sizes, along

Rows = list[tuple[str, ...]]
_MARKS = {Point.FITTED: "f", Point.SMALLER: "s", Point.UNCLEAR: "e", Point.UNKNOWN: "u", Point.FEW: "x"}
_LISTED = 3  # largest number of sizes that are listed
_MEANINGS = {
    Kind.MEASURED: "measured: a solved size, where the change is the level within the mesh's error",
    Kind.INTERPOLATED: "interpolated: between two solved sizes",
    Kind.EXTRAPOLATED: "extrapolated: by the law, with the 95 % confidence interval",
    Kind.BOUND: "<=, > and to: only bounds, solved sizes",
}


@dataclass(frozen=True)
class SizeStudy:
    """A study of sizes along one axis.

    Parameters
    ----------
    scene : Scene
    axis : Axis
    sizes : Sizes
    trends : list of Trend
        One per quantity with a value.
    unsolved : tuple of str
        Cases that failed, and why.
    """

    scene: Scene
    axis: Axis
    sizes: Sizes
    trends: list[Trend]
    unsolved: tuple[str, ...]

    @property
    def label(self) -> str:
        """Name of the axis with its unit."""
        return f"{self.axis.name} {'in contact half-widths' if self.axis.in_a else 'as in the scene'}"


def size_study(scene: Scene, axis: Axis, entries: Sequence[Solved]) -> SizeStudy:
    """Evaluate the ``entries`` of a ledger for a sweep of ``scene`` along ``axis``."""
    sizes = along(axis, entries)
    return SizeStudy(scene, axis, sizes, trends(sizes), tuple(unsolved(entries)))


def unsolved(entries: Iterable[Solved]) -> list[str]:
    """Return which of ``entries`` failed and why, as lines of text."""
    return [
        f"not solved: {', '.join(f'{key} {value}' for key, value in entry.labels.items())}: {entry.error}"
        for entry in entries
        if entry.error
    ]


def heading(study: SizeStudy) -> str:
    """Return what was measured over which axis, as one line."""
    return f"{study.scene.name}: change from the half-plane, over {study.label}"


def changes_table(study: SizeStudy) -> tuple[tuple[str, ...], Rows]:
    """Return headings and rows of the changes by size; a letter says whether the law is fitted to a change."""
    found = study.sizes
    points = {trend.quantity: trend.points for trend in study.trends}
    solved: dict[float, tuple[str, ...]] = {
        size: (*(_marked(found.off[key][k], points[key][k]) for key in points), _share(found, k))
        for k, size in enumerate(found.size.tolist())
    }
    failed = {size: (*["-"] * len(points), "") for size in found.failed}
    rows = [(_short(size), *cells) for size, cells in sorted((solved | failed).items())] if points else []
    return ("size", *points, "mesh"), rows


def laws_table(study: SizeStudy) -> tuple[tuple[str, ...], Rows]:
    """Return headings and rows of the fitted laws."""
    rows: Rows = [
        (trend.quantity, f"{law.C:.3g}", f"{law.k:.2f}", "{:.2f} to {:.2f}".format(*law.bounds), _listed(law.sizes))
        for trend in study.trends
        if (law := trend.law)
    ]
    return ("change = C size^-k", "C", "k", "95 %", "fitted sizes"), rows


def needed_table(study: SizeStudy) -> tuple[tuple[str, ...], Rows]:
    """Return headings and rows of the sizes from which on the change is below each level, and how they are known."""
    rows = [(trend.quantity, *map(str, trend.needed)) for trend in study.trends]
    return ("change below", *(f"{level:.1%}" for level in LEVELS)), rows


def notes(study: SizeStudy) -> list[str]:
    """Return what the letters and words of the tables mean, what is not extrapolated, and which cases failed."""
    points = {point for trend in study.trends for point in trend.points}
    kinds = {needed.kind for trend in study.trends for needed in trend.needed}
    flat = [trend.quantity for trend in study.trends if trend.law and not trend.law.falls]
    lines = [
        *(f"{mark}: {_fitted(point)}" for point, mark in _MARKS.items() if point in points),
        *(["mesh: the largest share of a change that may be an error of the mesh"] if points else []),
        *(meaning for kind, meaning in _MEANINGS.items() if kind in kinds),
        *([f"no sizes are extrapolated for {', '.join(flat)}: the law may not fall"] if flat else []),
    ]
    return [*lines, *study.unsolved]


def _fitted(point: Point) -> str:
    return f"{point}" if point is Point.FITTED else f"not fitted: {point}"


def points_csv(study: SizeStudy) -> str:
    """Return all points of ``study`` as CSV: change and mesh's error by size and quantity, and whether it is fitted."""
    found = study.sizes
    rows: list[tuple[object, ...]] = [
        (size, trend.quantity, found.off[trend.quantity][k], found.mesh[trend.quantity][k], trend.points[k])
        for trend in study.trends
        for k, size in enumerate(found.size.tolist())
    ]
    rows += [(size, "", "", "", error) for size, error in found.failed.items()]
    return csv_text(("size", "quantity", "change", "error of the mesh", "point"), rows)


def laws_csv(study: SizeStudy) -> str:
    """Return laws and needed sizes of ``study`` as CSV, one row per quantity and level; empty where there is none."""
    rows = [
        (
            trend.quantity,
            *((trend.law.C, trend.law.k, *trend.law.bounds) if trend.law else ("",) * 4),
            needed.level,
            needed.kind,
            *("" if not math.isfinite(each) or each == 0 else each for each in (needed.size, needed.low, needed.high)),
        )
        for trend in study.trends
        for needed in trend.needed
    ]
    return csv_text(("quantity", "C", "k", "k low", "k high", "change below", "kind", "size", "low", "high"), rows)


def _marked(change: float, point: Point) -> str:
    return f"{change:.1e} {_MARKS[point]}" if point in _MARKS else "-" if math.isnan(change) else f"{change:.1e}"


def _share(sizes: Sizes, k: int) -> str:
    """Return the largest share of a change that may be an error of the mesh, as text."""
    shares = [sizes.mesh[key][k] / sizes.off[key][k] for key in QUANTITIES if sizes.off[key][k] > 0]
    known = [share for share in shares if not math.isnan(share)]
    return f"{max(known):.1%}" if known else ""


def _short(size: float) -> str:
    return f"{size:.4g}"


def _listed(sizes: Sequence[float]) -> str:
    if len(sizes) <= _LISTED:
        return ", ".join(map(_short, sizes))
    return f"{len(sizes)} from {_short(min(sizes))} to {_short(max(sizes))}"
