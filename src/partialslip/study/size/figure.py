"""Figures of a size study, legible in black and white."""

import math
import textwrap
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from partialslip.study.size.case import EQUIVALENT, HALF_PLANE
from partialslip.study.size.law import LEVELS, Kind, Needed, PointStatus, Sizes, Trend
from partialslip.study.size.tables import SizeStudy, size_heading
from partialslip.tools.arrays import Array
from partialslip.tools.output.svg import svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import XAxis, YAxis
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

_LEVELS = (1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3)  # display: contours of the change
_NAMES = {
    "a": "a", "p_max": "p_max, largest p", "p": "p, relative L2", "m": "m, in a", "n": "n, in a", "q": "q, relative L2",
    "sigma_xx": "sigma_xx, largest",
}  # fmt: skip
_COLUMNS = 2  # display: panels side by side: few, to be read on a phone
_FARTHEST = 10.0  # display: times the largest size: what is shown of extrapolated sizes
_LETTER = 0.036  # display: width of a letter of a label, as a fraction of the axis
_LETTER_WIDE, _LINE_HIGH = 0.018, 0.05  # display: the same on a map, and the height of a label
_LINE = 66  # display: characters of the heading


def size_svg(study: SizeStudy) -> str:
    """Return the differences of ``study`` over the size as SVG, a panel for each quantity; one size at least is solved.

    Circles are the half-plane's, squares those of equivalent half-planes. Fitted points are filled, others open. Lines
    show the laws, errors of the mesh are grey, and marks on the levels the sizes from which on the difference is below.
    Horizontal lines show what remains at an infinite size.
    """
    found = [quantity for quantity in study.quantities if any(trend.quantity == quantity for trend in study.trends)]
    count = -(-len(found) // _COLUMNS)
    title = textwrap.fill(size_heading(study), _LINE)

    def draw(figure: "Figure") -> None:
        panels = figure.subplots(count, _COLUMNS, sharex=True, sharey=True, squeeze=False)
        for axes in panels.flat[len(found) :]:
            axes.set_axis_off()
        _put_sizes(panels.flat[0], study)
        for number, quantity in enumerate(found):
            axes = panels.flat[number]
            _draw_quantity(axes, study, quantity)
            axes.tick_params(axis="x", labelsize=8, labelbottom=number + _COLUMNS >= len(found))
            if number + _COLUMNS >= len(found):
                axes.set_xlabel("size")
        for axes in panels[:, 0]:
            axes.set_ylabel("difference")
        panels.flat[0].set_ylim(bottom=_lowest(study) / 3)  # laws may fall far below
        figure.suptitle(title, x=0.01, ha="left", fontsize=10)
        figure.legend(handles=_keys(study), loc="outside lower left", ncols=2, frameon=False, fontsize=8)

    lines = 0.15 * count * (len(study.models) - 1)  # of the titles of the panels
    return svg(draw, (5.6, 1.7 + 2.3 * count + lines + 0.15 * title.count("\n")))


def _draw_quantity(axes: "Axes", study: SizeStudy, quantity: str) -> None:
    """Draw points, laws and needed sizes of one quantity."""
    title, across = [_NAMES.get(quantity, quantity)], axes.get_yaxis_transform()
    for model in study.models:
        for trend in (each for each in model.trends if each.quantity == quantity):
            _draw_trend(axes, study, model, trend)
            if law := trend.law:
                spread, sign = (law.bounds[1] - law.bounds[0]) / 2, "-" if law.floor.value < 0 else "+"
                remains = f"{law.floor} {sign} " if law.floor.clear else ""
                title.append(f"{model.name}: {remains}{law.C:.2g} size$^{{-{law.k:.2f}}}$ (± {spread:.1g})")
    plain = study.models[0]
    mesh, shown = plain.mesh[quantity], plain.size < plain.limit
    axes.plot(plain.size[shown], np.where(mesh > 0, mesh, np.nan)[shown], ".-", color="0.6", ms=3, lw=0.6, zorder=1)
    for failed in _failed(study):
        axes.axvline(failed, **_FAILED, zorder=0)
    for level in LEVELS:
        axes.axhline(level, color="0.8", lw=0.6, zorder=0)
        axes.text(1.01, level, f"{100 * level:g} %", transform=across, fontsize=8, va="center")
    axes.set_title("\n".join(title), loc="left", fontsize=8.5)


def _draw_trend(axes: "Axes", study: SizeStudy, model: Sizes, trend: Trend) -> None:
    """Draw points, law and needed sizes of one quantity of one model."""
    size, off, style = model.size, model.off[trend.quantity], _MODELS[model.name]
    for needed in trend.needed:
        _draw_needed(axes, needed, _farthest(study))
    if law := trend.law:
        for reach, line in (((min(law.sizes), max(law.sizes)), style["ls"]), ((size.min(), _farthest(study)), ":")):
            along = np.geomspace(*reach)
            axes.plot(along, law.at(along), color="black", ls=line, lw=0.9, zorder=1)
    if trend.floor and trend.floor.clear:
        axes.axhline(abs(trend.floor.value), **_REMAINS, ls=style["ls"], zorder=1)
    fitted = np.array([point is PointStatus.FITTED for point in trend.points])
    for which, fill in ((~fitted & (size < model.limit), "white"), (fitted, "black")):
        shown = np.where(off > 0, off, np.nan)[which]
        axes.plot(size[which], shown, style["marker"], mec="black", mfc=fill, ms=5, zorder=3)


def _farthest(study: SizeStudy) -> float:
    """Return the largest size that is shown."""
    sizes = _all_sizes(study)
    return min(max([*sizes, *_extrapolated(study)]), _FARTHEST * max(sizes))


def _lowest(study: SizeStudy) -> float:
    """Return the smallest difference, error of the mesh or level."""
    values = [each for model in study.models for found in (model.off, model.mesh) for each in found.values()]
    known = np.concatenate([*values, LEVELS])
    return float(known[known > 0].min())


def _all_sizes(study: SizeStudy) -> list[float]:
    """Return the sizes that were solved or failed, without the one that stands for an infinite size."""
    plain = study.models[0]
    return sorted([*plain.size[plain.size < plain.limit].tolist(), *_failed(study)])


def _failed(study: SizeStudy) -> list[float]:
    return [size for size in study.models[0].failed if size < study.models[0].limit]


def _extrapolated(study: SizeStudy) -> list[float]:
    """Return the upper ends of extrapolated sizes."""
    return [needed.high for trend in study.trends for needed in trend.needed if needed.kind is Kind.EXTRAPOLATED]


def _draw_needed(axes: "Axes", needed: Needed, farthest: float) -> None:
    """Draw the size for one level on the level's line."""
    if needed.kind is Kind.BOUND:
        for at, key in ((needed.low, "more"), (needed.high, "at most")):
            if 0 < at < np.inf:
                axes.plot(at, needed.level, **_MARKS[key], zorder=2)
        return
    if needed.kind is Kind.EXTRAPOLATED and needed.low < farthest:
        axes.plot([needed.low, min(needed.high, farthest)], [needed.level] * 2, **_MARKS["interval"], zorder=2)
    if needed.size <= farthest:
        axes.plot(needed.size, needed.level, **_MARKS["size"], zorder=2)


def _put_sizes(axes: "Axes", study: SizeStudy) -> None:
    """Set logarithmic axes with ticks at the sizes that were solved or failed."""
    axes.set(xscale="log", yscale="log")
    sizes = [size for size in _all_sizes(study) if size > 0]
    width = math.log(_farthest(study) / sizes[0]) or 1.0
    axes.set_xlim(sizes[0] * math.exp(-0.05 * width), _farthest(study) * math.exp(0.05 * width))
    _put_ticks(axes.xaxis, sizes, lambda label: width * _LETTER * (len(label) + 1))


def _put_ticks(axis: "XAxis | YAxis", values: Sequence[float], room: Callable[[str], float]) -> None:
    """Put the ticks of a logarithmic axis at ``values``, and labels where there is ``room(label)``, in logarithms."""
    from matplotlib.ticker import FixedFormatter, FixedLocator, NullLocator

    labels, free = [], -math.inf
    for value in values:
        label = f"{value:.3g}"
        at, half = math.log(value), 0.5 * room(label)
        labels.append(label if at - half >= free else "")
        free = at + half if labels[-1] else free
    axis.set_major_locator(FixedLocator(values))
    axis.set_major_formatter(FixedFormatter(labels))
    axis.set_minor_locator(NullLocator())


_MODELS = {HALF_PLANE: {"marker": "o", "ls": "-"}, EQUIVALENT: {"marker": "s", "ls": "--"}}
_POINT = {"ls": "", "mec": "black", "ms": 5}
_BOUND = {"mec": "black", "mfc": "white", "ls": "", "ms": 5}
_REMAINS: dict[str, Any] = {"color": "0.4", "lw": 1.6}
_FAILED: dict[str, Any] = {"color": "0.5", "lw": 1.2, "ls": (0, (1, 2))}
_MARKS: dict[str, dict[str, Any]] = {
    "size": {"color": "black", "marker": "|", "ls": "", "ms": 9, "mew": 1.6},
    "interval": {"color": "black", "alpha": 0.5, "lw": 2.4, "solid_capstyle": "butt"},
    "at most": {"marker": "<", **_BOUND},
    "more": {"marker": ">", **_BOUND},
}


def _keys(study: SizeStudy) -> "list[Line2D]":
    """Return the entries of the legend: of what is drawn."""
    from matplotlib.lines import Line2D

    needed = [each for trend in study.trends for each in trend.needed]
    bounds = [each for each in needed if each.kind is Kind.BOUND]
    entries: list[tuple[str, dict[str, Any], bool]] = []
    for model in study.models:
        points = {point for trend in model.trends for point in trend.points}
        name, point = model.name, _POINT | {"marker": _MODELS[model.name]["marker"]}
        entries += [
            (f"{name}, fitted", {"mfc": "black", **point}, PointStatus.FITTED in points),
            (f"{name}, not fitted", {"mfc": "white", **point}, bool(points - {PointStatus.FITTED, PointStatus.LIMIT})),
        ]
    for model in study.models:
        fitted = any(trend.law for trend in model.trends)
        style = {"color": "black", "lw": 0.9, "ls": _MODELS[model.name]["ls"]}
        entries.append((f"law, {model.name}", style, fitted))
    mesh = any((each > 0).any() for each in study.models[0].mesh.values())
    entries += [
        ("law beyond the fitted sizes", {"color": "black", "lw": 0.9, "ls": ":"},
         any(trend.law for trend in study.trends)),
        ("remains at an infinite size", _REMAINS, any(trend.floor and trend.floor.clear for trend in study.trends)),
        ("error of the mesh", {"color": "0.6", "marker": ".", "ms": 3, "lw": 0.6}, mesh),
        ("below the level from here on", _MARKS["size"], any(math.isfinite(each.size) for each in needed)),
        ("95 % interval, extrapolated", _MARKS["interval"], bool(_extrapolated(study))),
        ("at most this size", _MARKS["at most"], any(each.high < math.inf for each in bounds)),
        ("more than this size", _MARKS["more"], any(each.low > 0 for each in bounds)),
        ("not solved", _FAILED, bool(_failed(study))),
    ]  # fmt: skip
    return [Line2D([], [], label=label, **style) for label, style, drawn in entries if drawn]


def grid_svg(x: Array, y: Array, off: Array, labels: tuple[str, str], title: str) -> str:
    """Return contours of the change over two parameters as SVG; hatched where nothing was solved.

    Parameters
    ----------
    x, y : (k,) and (l,) arrays
        Values of the parameters.
    off : (l, k) array
        Change; NaN where not solved.
    labels : (str, str)
        Labels of the axes.
    title : str
    """
    from matplotlib import colormaps
    from matplotlib.colors import LogNorm

    def draw(figure: "Figure") -> None:
        axes = figure.subplots()
        axes.set_facecolor("white")
        axes.patch.set(hatch="///", edgecolor="0.7")
        levels, shades = np.array(_LEVELS), LogNorm(_LEVELS[0], 3 * _LEVELS[-1])
        shown = np.clip(off, levels[0] / 10, None)
        greys = colormaps["Greys"].with_extremes(under="white")
        filled = axes.contourf(x, y, shown, levels=levels, norm=shades, cmap=greys, extend="both")
        axes.contour(x, y, shown, levels=levels, colors="black", linewidths=0.8)
        bar = figure.colorbar(filled, ax=axes, ticks=levels, format="%g", label="change")
        bar.ax.minorticks_off()
        axes.set(xscale="log", yscale="log", xlabel=labels[0], ylabel=labels[1])
        wide, high = (math.log(values.max() / values.min()) for values in (x, y))
        _put_ticks(axes.xaxis, sorted(x.tolist()), lambda label: wide * _LETTER_WIDE * (len(label) + 1))
        _put_ticks(axes.yaxis, sorted(y.tolist()), lambda _: high * _LINE_HIGH)
        axes.set_title(title, loc="left", fontsize=10)

    return svg(draw, (6.6, 4.6))
