"""Figure of the map over dP and dQ, legible in black and white: m/a solid, n/a dashed, regions by hatching and grey."""

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from partialslip.study.map.figure import draw_lines, mark_point
from partialslip.study.map.grid import M_LEVELS, N_LEVELS
from partialslip.study.map.varying import VaryingMap
from partialslip.tools.arrays import Array
from partialslip.tools.output.svg import svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SIZE = (5.2, 5.3)  # display: inches; narrow, with the legend below, to be read on a phone
_STRIP = 0.03  # display: of the height, for sliding under constant P
# display: labels may be closer to other lines than on the map over dQ and dsigma: lines cross at small angles
_CROSSING = 2.5
_FINER = 20  # display: points of a line between two crossings of the grid
_FEWEST = 3 * _FINER  # points of a line that is drawn


def varying_svg(data: VaryingMap) -> str:
    """Return the map ``data`` as SVG: what the ends of the contact do over dP/P and dQ/(f P), and lines of equal m/a
    and n/a where both slip."""

    def draw(figure: "Figure") -> Callable[[], None]:
        axes, dP = figure.subplots(), data.P_change[0]
        sticks, slides = data.sticks(dP), data.slides(dP)
        top = (1 + _STRIP) * float(slides.max())
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

    return svg(draw, _SIZE)


def _all_lines(axes: "Axes", data: VaryingMap) -> Iterator[tuple[str, float, Array]]:
    """Lines of equal m and n where both ends slip: m or n, its value, and points (k, 2)."""
    ends: list[tuple[str, Array, tuple[float, ...]]] = [("m", data.m, M_LEVELS)]
    if data.ratio > 0:
        ends.append(("n", data.n, N_LEVELS))
    for of, values, levels in ends:
        for at in levels:
            for line in _lines(axes, data, values, at):
                yield of, at, line


def _lines(axes: "Axes", data: VaryingMap, values: Array, at: float) -> Iterator[Array]:
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
