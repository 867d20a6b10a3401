"""Figures of a cost study, legible in black and white: error against CPU seconds, and CPU seconds by phase."""

from collections.abc import Sequence
from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np

from partialslip.convergence import power
from partialslip.output.svg import svg
from partialslip.study.cost.ladder import CostPoint, by_series, errors_of, front

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MARKS = ("o", "s", "^", "v", "D", "<", ">", "p", "h", "X", "P", "*", "d")
_GREYS = ("0.0", "0.45", "0.65")
_LINES = ("-", "--", ":", "-.")
_HATCHES = ("", "////", "....", "xxxx", "----", "\\\\\\\\", "oooo", "++++")


def errors_svg(points: Sequence[CostPoint], peers: Sequence[CostPoint], title: str) -> str:
    """Return errors of n and q against CPU seconds of the whole process as SVG.

    ``points`` are results of partialslip, ``peers`` of other codes.
    """

    def draw(figure: "Figure") -> None:
        panels = figure.subplots(1, 2, sharex=True)
        for axes, key, label in zip(panels, ("n", "q"), ("error of n, in a", "error of q, relative L2"), strict=True):
            marks = cycle(_MARKS)
            for number, (series, found) in enumerate(by_series([*points, *peers]).items()):
                data = errors_of(found, key)
                if len(data):
                    outside = series in {point.series for point in peers}
                    axes.loglog(
                        *np.maximum(data, 1e-16).T,
                        next(marks),
                        ls="none" if outside else _LINES[number % len(_LINES)],
                        color="black" if outside else _GREYS[number % len(_GREYS)],
                        mfc="black" if outside else "white",
                        ms=5,
                        lw=1,
                        label=series,
                    )
            best = errors_of(front(points), key)
            axes.loglog(*best.T, color="0.8", lw=5, zorder=0, solid_capstyle="round", label="front (m and n)")
            exact = [point.process_s for point in points if point.series == "exact"]
            if exact:
                axes.axvline(exact[0], color="black", lw=0.8, ls=(0, (1, 3)), label="the exact method")
            axes.set(xlabel="CPU s of the process", ylabel=label)
            axes.grid(which="major", color="0.92", lw=0.6)
        figure.suptitle(title, x=0.01, ha="left", fontsize=10)
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside right upper", frameon=False, fontsize=8)

    return svg(draw, (10.5, 4.4))


def phases_svg(points: Sequence[CostPoint], title: str) -> str:
    """Return CPU seconds of the finite elements by phase, and over the unknowns, as SVG; ``points`` as measured."""
    found = sorted((point for point in points if point.series == "P4, adapted"), key=lambda point: point.counts["dofs"])
    names = list(dict.fromkeys(name for point in found for name in point.phases))

    def draw(figure: "Figure") -> None:
        shares, growth = figure.subplots(1, 2)
        place, bottom = np.arange(len(found)), np.zeros(len(found))
        others = [point.process_s - sum(point.phases.values()) for point in found]
        bars = {name: [point.phases.get(name, 0.0) for point in found] for name in names} | {"start, the rest": others}
        for number, (name, seconds) in enumerate(bars.items()):
            shares.bar(
                place, seconds, bottom=bottom, label=name, color=str(0.95 - 0.08 * number), ec="black", lw=0.6,
                hatch=_HATCHES[number % len(_HATCHES)], width=0.7,
            )  # fmt: skip
            bottom += seconds
        shares.set_xticks(place, [f"{point.counts['dofs']:,}" for point in found], rotation=30)
        shares.set(xlabel="unknowns of the last mesh (P4, adapted)", ylabel="CPU s of the process")
        shares.legend(frameon=False, fontsize=8)
        marks = cycle(_MARKS)
        for number, (series, of) in enumerate(by_series(points).items()):
            data = np.array([[point.counts["dofs"], point.cpu_s] for point in of if "dofs" in point.counts])
            if len(data) > 1:
                label = f"{series}: {power(*data.T):.2f}"
                style = {"ls": _LINES[number % len(_LINES)], "color": _GREYS[number % len(_GREYS)], "mfc": "white"}
                growth.loglog(*data.T, next(marks), ms=5, lw=1, label=label, **style)
        growth.set(xlabel="unknowns of the last mesh", ylabel="CPU s of the method")
        if growth.lines:  # none of the exact method alone
            growth.legend(frameon=False, fontsize=8, title="series: exponent", title_fontsize=8)
        figure.suptitle(title, x=0.01, ha="left", fontsize=10)

    return svg(draw, (10.5, 4.4))
