"""Figures of a cost study, legible in black and white: error against CPU seconds, and CPU seconds by phase."""

import math
from collections.abc import Callable, Mapping, Sequence
from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np

from partialslip.study.cost.ladder import ADAPTED, CostPoint, by_series, front, slopes, start_s
from partialslip.tools.output.svg import svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_ROUNDING = 1e-16  # display: smallest error drawn
_BARS = 4  # display: as many have room
_SHORT = 30.0  # display: ratio of the ends of an axis up to which there is room for three labels in a decade
_MARKS = ("o", "s", "^", "v", "D", "<", ">", "p", "h", "X", "P", "*", "d")
_GREYS = ("0.0", "0.45", "0.65")
_LINES = ("-", "--", ":", "-.")
_HATCHES = ("", "////", "....", "xxxx", "----", "\\\\\\\\", "oooo", "++++")


def errors_svg(points: Sequence[CostPoint], peers: Sequence[CostPoint], title: str, asked: float) -> str:
    """Return the error of m and n against CPU seconds of the solution as SVG, legible at a width of 9 cm.

    ``points`` are results of partialslip, ``peers`` of other codes; ``asked`` is the accuracy that the scene asks for,
    as a fraction of a.
    """
    outside = {point.series for point in peers}

    def draw(figure: "Figure") -> None:
        axes, marks = figure.subplots(), cycle(_MARKS)
        for number, (series, found) in enumerate(by_series(each for each in [*points, *peers] if each.errors).items()):
            style: dict[str, Any] = {"ls": _LINES[number % len(_LINES)], "color": _GREYS[number % len(_GREYS)]}
            if series in outside:
                style = {"ls": "none", "color": "black", "mfc": "black"}
            data = np.array([[point.cpu_s, max(point.ends, _ROUNDING)] for point in found])
            axes.loglog(*data.T, next(marks), **{"mfc": "white", "ms": 5, "lw": 1, **style}, label=series)
        best = np.array([[point.cpu_s, max(point.ends, _ROUNDING)] for point in front([*points, *peers])])
        if len(best):
            axes.step(*best.T, where="post", color="0.82", lw=6, zorder=0, solid_capstyle="round", label="best of all")
        axes.axhline(asked, color="black", lw=0.8, ls=(0, (6, 2)), zorder=0.5, label=f"asked for: {asked:.0e} a")
        exact = [point.cpu_s for point in points if point.series == "exact"]
        if exact:
            axes.axvline(exact[0], color="black", lw=1, ls=(0, (1, 2)), label=f"exact: {exact[0]:.2g} s")
        start = start_s(points)
        if start > 0:
            low = axes.get_xlim()[0]
            axes.axvspan(low, start, color="0.93", lw=0, zorder=-1, label=f"start-up of a process: {start:.2g} s")
            axes.set_xlim(left=low)
        axes.set(xlabel="CPU s of the solution", ylabel="error of m and n, in a")
        axes.grid(which="major", color="0.88", lw=0.5, zorder=-2)
        axes.set_axisbelow(True)
        _tick_plainly(axes)
        figure.suptitle(title, x=0.01, ha="left", fontsize=10)
        figure.legend(loc="outside lower left", ncols=2, frameon=False, fontsize=8, handlelength=2.6)

    return svg(draw, (4.4, 4.6))


def phases_svg(points: Sequence[CostPoint], title: str) -> str:
    """Return CPU seconds of the finite elements by phase, and over the unknowns, as SVG, as far as ``points``, as
    measured, have them; empty without either."""
    series = {name: found for name, found in by_series(points).items() if "dofs" in found[0].counts}
    adapted = {name: found for name, found in series.items() if name.endswith("adapted")}
    shown = max(adapted, key=lambda name: (len(adapted[name]), name == ADAPTED), default="")
    grown = {name: found for name, found in series.items() if len({point.counts["dofs"] for point in found}) > 1}
    panels: list[Callable[[Any], None]] = []
    if shown:
        panels.append(lambda axes: _draw_shares(axes, adapted[shown], shown))
    if grown:
        panels.append(lambda axes: _draw_growth(axes, grown))
    if not panels:
        return ""

    def draw(figure: "Figure") -> None:
        for axes, panel in zip(figure.subplots(1, len(panels), squeeze=False).flat, panels, strict=True):
            panel(axes)
        figure.suptitle(title, x=0.01, ha="left", fontsize=10)

    return svg(draw, (5.9 * len(panels), 4.4))


def _draw_shares(axes: "Axes", points: Sequence[CostPoint], series: str) -> None:
    """Draw CPU seconds by phase as bars, one for each of the ``points`` of a series."""
    found = sorted(points, key=lambda point: point.counts["dofs"])
    names = list(dict.fromkeys(name for point in found for name in point.phases))
    place, bottom = np.arange(len(found)), np.zeros(len(found))
    others = [point.process_s - sum(point.phases.values()) for point in found]
    bars = {name: [point.phases.get(name, 0.0) for point in found] for name in names} | {"start, the rest": others}
    for number, (name, seconds) in enumerate(bars.items()):
        axes.bar(
            place, seconds, bottom=bottom, label=name, color=str(0.95 - 0.08 * number), ec="black", lw=0.6,
            hatch=_HATCHES[number % len(_HATCHES)], width=0.7,
        )  # fmt: skip
        bottom += seconds
    axes.set_xlim(-0.8, max(len(found), _BARS) - 0.2)
    axes.set_xticks(place, [f"{point.counts['dofs']:,}" for point in found], rotation=30)
    axes.set(xlabel=f"unknowns of the last mesh ({series})", ylabel="CPU s of the process")
    _put_legend(axes, reverse=True)  # as the bars are stacked


def _draw_growth(axes: "Axes", series: Mapping[str, Sequence[CostPoint]]) -> None:
    """Draw CPU seconds of the method over the unknowns, a line for each series."""
    exponents, marks = slopes(point for points in series.values() for point in points), cycle(_MARKS)
    for number, (name, points) in enumerate(series.items()):
        data = np.array([[point.counts["dofs"], point.cpu_s] for point in points])
        exponent = exponents[name]["CPU"]
        style = {"ls": _LINES[number % len(_LINES)], "color": _GREYS[number % len(_GREYS)], "mfc": "white"}
        label = name if math.isnan(exponent) else f"{name}: {exponent:.2f}"
        axes.loglog(*data.T, next(marks), ms=5, lw=1, label=label, **style)
    axes.set(xlabel="unknowns of the last mesh", ylabel="CPU s of the method")
    _tick_plainly(axes)
    _put_legend(axes, title="series: exponent")


def _tick_plainly(axes: "Axes") -> None:
    """Label the logarithmic x axis at powers of ten, and at 2 and 5 times these if the axis is short, by plain numbers:
    labels as 2 x 10^0 are so wide that they touch."""
    from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

    low, high = axes.get_xlim()
    axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5) if high < _SHORT * low else (1,)))
    axes.xaxis.set_major_formatter(StrMethodFormatter("{x:,.7g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())


def _put_legend(axes: "Axes", **more: Any) -> None:
    """Put the legend beside the panel, where nothing is drawn."""
    axes.legend(
        frameon=False, fontsize=8, title_fontsize=8, loc="upper left", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.3,
        **more,
    )  # fmt: skip
