"""Figures of a size study, legible in black and white."""

import math
import textwrap
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from partialslip.study.size.case import EQUIVALENT, HALF_PLANE, STRIPS
from partialslip.study.size.law import NAMES, Kind, Needed, Sizes, Trend
from partialslip.study.size.tables import SizeStudy, percent, size_text
from partialslip.tools.arrays import Array
from partialslip.tools.output.svg import svg

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.axis import XAxis, YAxis
    from matplotlib.figure import Figure

CAPTION = "How far half-planes are off, over the size; marks and numbers: from there on within the level."
_LEVELS = (1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3)  # display: contours of the change
_WIDTH, _HIGH = 4.2, 1.8  # display: of the figure and of a panel, inches: read at a width of 9 cm
_FARTHEST = 10.0  # display: times the largest size: what is shown of extrapolated sizes
# display: of the largest level: smallest difference that is shown, but for smaller levels; the same with exact strips
_BELOW, _BELOW_STRIPS = 1e-3, 1e-5
_DECADES = 5  # display: most decades that all have a tick
_MARGIN = 1.3  # display: factor beyond the ends of the axis of differences
_LINE = 56  # display: characters of a title
_LABEL = 48  # display: characters of a label of the axis
_LETTER = 0.03  # display: width of a letter of a label, as a fraction of the axis
_LETTER_WIDE, _LINE_HIGH = 0.018, 0.05  # display: the same on a map, and the height of a label
_OF_A = ("m", "n")  # quantities whose differences are in a


def size_svg(study: SizeStudy) -> str:
    """Return the differences of ``study`` over the size as SVG, a panel for each quantity; one size at least is solved.

    Circles are the half-plane's, squares those of equivalent half-planes, triangles those of exact strips. Horizontal
    lines are the levels; where a level is kept from a size on, a line falls from there to the axis, beside the number.
    """
    trends = study.trends
    found = [quantity for quantity in study.quantities if any(trend.quantity == quantity for trend in trends)]
    levels = sorted({needed.level for trend in trends for needed in trend.needed})
    low, high = _decades(study, levels)

    def draw(figure: "Figure") -> None:
        panels = figure.subplots(len(found), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
        _put_sizes(panels[0], study)
        panels[0].set_ylim(low / _MARGIN, high * _MARGIN)
        first, last = (round(math.log10(each)) for each in (low, high))
        decades = [10.0**k for k in range(last, first - 1, -2 if last - first > _DECADES else -1)]
        panels[0].set_yticks(decades, [percent(each) for each in decades], minor=False)
        panels[0].yaxis.minorticks_off()
        for axes, quantity in zip(panels, found, strict=True):
            _draw_quantity(axes, study, quantity, low)
            axes.tick_params(labelsize=9, labelbottom=True)
            axes.spines["left"].set_bounds(low, high)
            axes.spines["bottom"].set_bounds(*axes.get_xticks()[[0, -1]])
        panels[-1].set_xlabel(textwrap.fill(study.label, _LABEL), fontsize=9)
        figure.legend(handles=_keys(study, low), loc="outside lower left", ncols=2, frameon=False, fontsize=8.5)

    return svg(draw, (_WIDTH, _HIGH * len(found) + 1.1))


def _decades(study: SizeStudy, levels: Sequence[float]) -> tuple[float, float]:
    """Return the powers of ten between which differences are shown."""
    off = np.concatenate([found for model in study.models for found in model.off.values()])
    off = off[off > 0]
    least = _BELOW_STRIPS if any(model.name == STRIPS for model in study.models) else _BELOW
    low = min(max(off.min(initial=levels[0]), least * levels[-1]), levels[0])
    high = max(off.max(initial=levels[-1]), levels[-1])
    return 10.0 ** math.floor(math.log10(low)), 10.0 ** math.ceil(math.log10(high))


def _draw_quantity(axes: "Axes", study: SizeStudy, quantity: str, bottom: float) -> None:
    """Draw differences, levels and needed sizes of one quantity."""
    unit = study.axis.unit(study.scene.units)
    plain = study.models[0]
    mesh, shown = plain.mesh[quantity], plain.size < plain.limit
    known = shown & (mesh > bottom)
    axes.fill_between(plain.size[known], bottom, mesh[known], **_MESH)
    for failed in _failed(study):
        axes.axvline(failed, **_FAILED, zorder=0)
    trends = [(model, trend) for model in study.models for trend in model.trends if trend.quantity == quantity]
    for model, trend in trends:
        _draw_trend(axes, study, model, trend, bottom)
    needed = trends[0][1].needed
    for each in needed:
        axes.axhline(each.level, **_LEVEL, zorder=0)
        if not math.log10(each.level).is_integer():  # else it has a tick
            axes.annotate(percent(each.level), (1, each.level), (2, 0), xycoords=axes.get_yaxis_transform(),
                          textcoords="offset points", fontsize=8.5, va="center")  # fmt: skip
    found = (f"{_SHORT[model.name]} {_with_unit(trend.needed[0].short, unit)}" for model, trend in trends)
    told = ", ".join(text.replace(" ", "\xa0") for text in found)  # lines break between them
    title = textwrap.fill(f"{quantity} within {percent(needed[0].level)}: {told}", _LINE)
    axes.set_title(title, loc="left", x=-0.17, fontsize=9)
    axes.set_ylabel("off by, of a" if quantity in _OF_A else "off by", fontsize=9)


def _with_unit(size: str, unit: str) -> str:
    return f"{size} {unit}" if unit and size[-1].isdigit() else size


def _draw_trend(axes: "Axes", study: SizeStudy, model: Sizes, trend: Trend, bottom: float) -> None:
    """Draw the line, the law beyond the solved sizes, and the needed sizes of one quantity of one model."""
    size, off, style = model.size, model.off[trend.quantity], _MODELS[model.name]
    near = (size < model.limit) & (size > 0)
    axes.plot(size[near], np.where(off > 0, off, np.nan)[near], color="black", **style, zorder=3)
    if trend.law and _farthest(study) > size[near].max():
        along = np.geomspace(size[near].max(), _farthest(study))
        axes.plot(along, trend.law.at(along), **_BEYOND, zorder=1)
    if trend.floor and trend.floor.clear and abs(trend.floor.value) > bottom:
        axes.axhline(abs(trend.floor.value), **_REMAINS, zorder=1)
    for needed in trend.needed:
        _draw_needed(axes, needed, bottom, _farthest(study))


def _draw_needed(axes: "Axes", needed: Needed, bottom: float, farthest: float) -> None:
    """Mark the size for one level, and its number where the falling difference leaves room: above, on the right."""
    spread = needed.kind in (Kind.EXTRAPOLATED, Kind.BOUND) and needed.high < math.inf
    if spread and 0 < needed.low < (high := min(needed.high, farthest)):
        axes.plot([needed.low, high], [needed.level] * 2, **_INTERVAL, zorder=2)
    if needed.size <= farthest:
        axes.plot([needed.size] * 2, [needed.level, bottom], **_MARK, markevery=[1], clip_on=False, zorder=2)
        axes.annotate(needed.short, (needed.size, needed.level), **_NUMBER)


def _farthest(study: SizeStudy) -> float:
    """Return the largest size that is shown: rounded up if it was not solved."""
    largest = max(_all_sizes(study))
    sizes = [needed.size for trend in study.trends for needed in trend.needed if needed.kind is Kind.EXTRAPOLATED]
    if not sizes or max(sizes) <= largest:
        return largest
    wanted = min(1.3 * max(sizes), _FARTHEST * largest)
    power = 10.0 ** math.floor(math.log10(wanted))
    return math.ceil(wanted / power) * power


def _all_sizes(study: SizeStudy) -> list[float]:
    """Return the sizes that were solved or failed, without the one that stands for an infinite size."""
    plain = study.models[0]
    return sorted([*plain.size[plain.size < plain.limit].tolist(), *_failed(study)])


def _failed(study: SizeStudy) -> list[float]:
    return [size for size in study.models[0].failed if size < study.models[0].limit]


def _put_sizes(axes: "Axes", study: SizeStudy) -> None:
    """Set logarithmic axes with ticks at the sizes that were solved or failed, and at the largest shown."""
    axes.set(xscale="log", yscale="log")
    sizes = sorted({size for size in (*_all_sizes(study), _farthest(study)) if size > 0})
    width = math.log(sizes[-1] / sizes[0]) or 1.0
    axes.set_xlim(sizes[0] * math.exp(-0.03 * width), sizes[-1] * math.exp(0.03 * width))
    _put_ticks(axes.xaxis, sizes, lambda label: width * _LETTER * (len(label) + 1))


def _put_ticks(axis: "XAxis | YAxis", values: Sequence[float], room: Callable[[str], float]) -> None:
    """Put the ticks of a logarithmic axis at ``values``, and labels at both ends and where there is ``room(label)``, in
    logarithms."""
    from matplotlib.ticker import FixedFormatter, FixedLocator, NullLocator

    texts = [size_text(value) for value in values]
    places = [(math.log(value), 0.5 * room(text)) for value, text in zip(values, texts, strict=True)]
    free, last, labels = -math.inf, places[-1][0] - places[-1][1], []
    for number, (text, (at, half)) in enumerate(zip(texts, places, strict=True)):
        fits = at - half >= free and at + half <= last
        labels.append(text if number in (0, len(texts) - 1) or fits else "")
        free = at + half if labels[-1] else free
    axis.set_major_locator(FixedLocator(values))
    axis.set_major_formatter(FixedFormatter(labels))
    axis.set_minor_locator(NullLocator())


_MODELS: dict[str, dict[str, Any]] = {
    HALF_PLANE: {"marker": "o", "ls": "-", "ms": 5, "mfc": "black", "lw": 1.2},
    STRIPS: {"marker": "^", "ls": ":", "ms": 5, "mfc": "white", "lw": 1.2},
    EQUIVALENT: {"marker": "s", "ls": "--", "ms": 5, "mfc": "white", "lw": 1.2},
}
_SHORT = {HALF_PLANE: "half-planes", EQUIVALENT: "equivalent", STRIPS: "strips"}
_LEVEL: dict[str, Any] = {"color": "0.5", "lw": 0.7}
_BEYOND: dict[str, Any] = {"color": "black", "lw": 1.0, "ls": ":"}
_MESH: dict[str, Any] = {"color": "0.9", "lw": 0, "zorder": -1}
_MARK: dict[str, Any] = {"color": "black", "lw": 0.8, "ls": (0, (3, 2)), "marker": "v", "ms": 4}
_NUMBER: dict[str, Any] = {
    "xytext": (2, 4), "textcoords": "offset points", "fontsize": 8.5, "zorder": 2.5,
    "bbox": {"fc": "white", "ec": "none", "pad": 0.4},
}  # fmt: skip
_INTERVAL: dict[str, Any] = {"color": "0.6", "lw": 3.0, "solid_capstyle": "butt"}
_REMAINS: dict[str, Any] = {"color": "0.4", "lw": 1.4, "ls": (0, (6, 1.5, 1, 1.5))}
_FAILED: dict[str, Any] = {"color": "0.5", "lw": 1.2, "ls": (0, (1, 2))}


def _keys(study: SizeStudy, low: float) -> "list[Artist]":
    """Return the entries of the legend: of what is drawn."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    trends = study.trends
    needed = [each for trend in trends for each in trend.needed]
    between = any(each.kind is Kind.BOUND and 0 < each.low < each.high < math.inf for each in needed)
    entries: list[tuple[str, dict[str, Any], bool]] = [
        *((NAMES[model.name], {"color": "black", **_MODELS[model.name]}, True) for model in study.models),
        ("size needed", _MARK, any(math.isfinite(each.size) for each in needed)),
        ("law", _BEYOND, _farthest(study) > max(_all_sizes(study))),
        ("the size lies within", _INTERVAL, between or any(each.kind is Kind.EXTRAPOLATED for each in needed)),
        ("at an infinite size", _REMAINS, any(trend.floor and trend.floor.clear for trend in trends)),
        ("not solved", _FAILED, bool(_failed(study))),
    ]  # fmt: skip
    mesh = any((each > low).any() for each in study.models[0].mesh.values())
    patches = [Patch(label="error of the mesh", color=_MESH["color"])] if mesh else []
    return [*(Line2D([], [], label=label, **style) for label, style, drawn in entries if drawn), *patches]


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
