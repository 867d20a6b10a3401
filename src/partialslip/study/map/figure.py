"""Figures of stick-zone maps, legible in black and white: m/a solid, n/a dashed, regions by hatching and grey."""

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from partialslip.study.map.grid import M_LEVELS, N_LEVELS, Point, StickMap
from partialslip.study.map.varying import VaryingMap
from partialslip.tools.arrays import Array
from partialslip.tools.output.labels import CROSSING, label_lines
from partialslip.tools.output.svg import svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SIZE = (5.2, 5.0)  # display: inches; narrow, with the legend below, to be read on a phone
_HATCH, _ONE_STEP = "....", "m, n of one step"
_TOUCHED = 0.02  # display: hatching fills every cell of the grid that a turn of slip touches: lines end at its border
_STRIP = 0.025  # display: width of the strip of sliding beyond dQ = 2 f P
_VARYING_SIZE = (5.2, 5.3)  # display: inches; narrow, with the legend below, to be read on a phone
_VARYING_STRIP = 0.03  # display: of the height, for sliding under constant P
# display: labels may be closer to other lines than on the map over dQ and dsigma: lines cross at small angles
_CROSSING = 2.5
_FINER = 20  # display: points of a line between two crossings of the grid
_FEWEST = 3 * _FINER  # points of a line that is drawn


def map_svg(data: StickMap) -> str:
    """Return the map ``data`` as SVG: lines of equal m/a and n/a over dQ/(2 f P) and dsigma/(f p0)."""

    def draw(figure: "Figure") -> Callable[[], None]:
        axes = figure.subplots()
        axes.set(xlabel="ΔQ/(2 f P)", ylabel="Δσ/(f p0)", xlim=(0, 1 + _STRIP), ylim=(0, data.grid.sf.max()))
        axes.plot([], color="black", lw=1, label="m/a, stick from -m")
        axes.plot([], color="black", lw=1, ls="--", label="n/a, stick to n")
        axes.plot(*data.border[1:], color="black", lw=2.8, label="m = a in one step: large tension above")
        axes.axvspan(1, 1 + _STRIP, color="0.7", lw=0, label="sliding")
        grid = data.grid
        region = grid.Qf, grid.sf, grid.turned
        axes.contourf(*region, [_TOUCHED, 1.5], colors="none", hatches=[_HATCH])
        axes.contour(*region, [_TOUCHED], colors="0.5", linewidths=0.6)
        axes.fill_between([], [], [], hatch=_HATCH, fc="none", ec="black", lw=0, label=_ONE_STEP)
        avoided = np.column_stack(data.border[1:])  # no label on the border, nor on the scene's loads
        if data.point:
            mark_point(axes, data.point)
            avoided = np.vstack([avoided, data.point.place])
        axes.tick_params(pad=9)  # room for the mark of a scene without dQ or dsigma, on an axis
        axes.set_title(data.scene.name if data.scene else "hertz", loc="left", fontsize=10)
        figure.legend(loc="outside lower left", ncols=2, frameon=False, fontsize=9)
        found = (("m", data.m_lines), ("n", data.n_lines))
        lines = [(of, at, np.column_stack([Qf, sf])) for of, some in found for at, Qf, sf in some]
        return partial(draw_lines, axes, lines, avoided)

    return svg(draw, _SIZE)


def mark_point(axes: "Axes", point: Point) -> None:
    """Mark the ``point`` of a scene, above all that the map shows."""
    axes.plot(*point.place, "*", ms=15, mfc="white", mec="black", clip_on=False, zorder=6, label="the scene's loads")


def draw_lines(
    axes: "Axes", found: Iterable[tuple[str, float, Array]], avoided: Array, crossing: float = CROSSING
) -> None:
    """Draw labelled lines of equal m, solid, and n, dashed: ``found`` are m or n, its value, and points (k, 2). Labels
    keep off the ``avoided`` points; ``crossing`` as for :func:`partialslip.tools.output.labels.label_lines`."""
    lines, texts = [], []
    for of, at, points in found:
        axes.plot(*points.T, color="black", lw=1, ls={"m": "-", "n": "--"}[of])
        lines.append(points)
        texts.append(f"{of} {at:.1f}".replace("-", "−"))
    label_lines(axes, lines, texts, avoided, crossing=crossing)


def ends_svg(data: StickMap) -> str:
    """Return the ends of the stick zone over dsigma a/dQ as SVG, one panel per constant dQ (the paper's last
    figure). ``data`` is the map."""

    def draw(figure: "Figure") -> None:
        panels = figure.subplots(2, 2, sharex=True, sharey=True)
        for number, axes in enumerate(panels.flat):
            _draw_ends(axes, data, number)
        for axes in panels[1]:
            axes.set_xlabel("Δσ a/ΔQ")
        for axes in panels[:, 0]:
            axes.set_ylabel("x/a")
        keys = panels[0, 0].get_legend_handles_labels()
        figure.legend(*keys, loc="outside lower left", ncols=2, frameon=False, fontsize=9)

    return svg(draw, _SIZE)


def _draw_ends(axes: "Axes", data: StickMap, number: int) -> None:
    """Draw the stick zone of one curve, and the transition from small to large tension."""
    zone = data.curves.zone
    Qf, sf, m, n = (values[number] for values in (data.curves.Qf, data.curves.sf, zone.m, zone.n))
    ratio, turn = sf / (np.pi * Qf), data.turns.sf[number] / (np.pi * data.turns.Qf[number])
    axes.fill_between(ratio, -m, n, color="0.88", lw=0, label="stick zone [-m, n]")
    axes.plot(ratio, n, color="black", lw=1.4, ls="--", label="n/a")
    axes.plot(ratio, -m, color="black", lw=1.4, label="-m/a")
    axes.axvline(turn, color="black", lw=1, ls=":", label="from small (left) to large tension, in one step")
    turned = data.curves.turned[number]
    axes.fill_between(ratio, -1.05, 1.05, where=turned, hatch=_HATCH, fc="none", ec="0.6", lw=0, label=_ONE_STEP)
    axes.set(title=f"ΔQ/(2 f P) = {Qf[0]:g}", xlim=(0, ratio[-1]), ylim=(-1.05, 1.05))
    axes.title.set_fontsize(10)


def varying_svg(data: VaryingMap) -> str:
    """Return the map ``data`` as SVG: what the ends of the contact do over dP/P and dQ/(f P), and lines of equal m/a
    and n/a where both slip."""

    def draw(figure: "Figure") -> Callable[[], None]:
        axes, dP = figure.subplots(), data.P_change[0]
        sticks, slides = data.sticks(dP), data.slides(dP)
        top = (1 + _VARYING_STRIP) * float(slides.max())
        axes.set(xlabel="ΔP/P", ylabel="ΔQ/(f P)", xlim=(0, dP[-1]), ylim=(0, top))
        told = f"Δσ a/ΔQ = {data.ratio:.3g}, P: the larger normal force"
        axes.set_title(f"{data.scene.name}\n{told}", loc="left", fontsize=10)
        same = data.ratio == 0  # the stick zone is in the middle
        axes.plot([], color="black", lw=1, label="m/a = n/a, stick from -m to n" if same else "m/a, stick from -m")
        if not same:
            axes.plot([], color="black", lw=1, ls="--", label="n/a, stick to n")
        axes.contourf(
            data.P_change, data.Q_change, data.beyond, [0, np.inf], colors=["white"], hatches=["////"], zorder=2
        )
        if (data.regime == "part of the cycle").any():
            axes.fill([], [], hatch="////", lw=0, facecolor="white", label="an end slips in part of the cycle")
        axes.fill_between(dP, np.minimum(sticks, slides), color="0.9", lw=0, zorder=3, label="no end slips")
        axes.fill_between(dP, slides, top, color="0.7", lw=0, zorder=3, label="sliding at a load point")
        for edge in (np.minimum(sticks, slides), slides):
            axes.plot(dP, edge, color="black", lw=2, zorder=4)
        border = axes.contour(data.P_change, data.Q_change, data.beyond, [0], colors="black", linewidths=2, zorder=2.5)
        edges = [np.column_stack([dP, sticks]), np.column_stack([dP, slides])]
        avoided = np.vstack([*edges, *filter(len, border.allsegs[0])])
        if data.point:
            mark_point(axes, data.point)
            avoided = np.vstack([avoided, data.point.place])
        figure.legend(loc="outside lower left", ncols=2, frameon=False, fontsize=9)
        return lambda: draw_lines(axes, _all_lines(axes, data), avoided, _CROSSING)

    return svg(draw, _VARYING_SIZE)


def _all_lines(axes: "Axes", data: VaryingMap) -> Iterator[tuple[str, float, Array]]:
    """Lines of equal m and n where both ends slip: m or n, its value, and points (k, 2)."""
    ends: list[tuple[str, Array, tuple[float, ...]]] = [("m", data.m, M_LEVELS)]
    if data.ratio > 0:
        ends.append(("n", data.n, N_LEVELS))
    for of, values, levels in ends:
        for at in levels:
            for line in _contour_lines(axes, data, values, at):
                yield of, at, line


def _contour_lines(axes: "Axes", data: VaryingMap, values: Array, at: float) -> Iterator[Array]:
    """Lines (points, 2) over dP and dQ where ``values`` equal ``at`` and both ends slip."""
    from scipy.interpolate import RegularGridInterpolator  # takes long to import

    share = data.Q_change[:, 0] / 2  # of dQ = f (P1 + P2)
    beyond = RegularGridInterpolator((share, data.P_change[0]), data.beyond, bounds_error=False, fill_value=None)
    found = axes.contour(data.P_change, data.Q_change, values, [at])
    found.remove()
    for rough in filter(len, found.allsegs[0]):
        steps = np.linspace(0, len(rough) - 1, _FINER * (len(rough) - 1) + 1)
        dP, dQ = (np.interp(steps, np.arange(len(rough)), along) for along in rough.T)
        kept = (beyond((dQ / (2 - dP), dP)) <= 0) & (dQ > data.sticks(dP)) & (dQ < data.slides(dP))
        cuts = np.flatnonzero(np.diff(kept)) + 1
        for part, inside in zip(np.split(np.column_stack([dP, dQ]), cuts), np.split(kept, cuts), strict=True):
            if inside[0] and len(part) >= _FEWEST:
                yield part
