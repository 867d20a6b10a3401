"""Figures of an assessment, readable in black and white: stress fields, criteria, and planes."""

from collections.abc import Callable, Sequence
from functools import partial
from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np

from partialslip.report.answer import scale
from partialslip.study.fatigue.assessment import Assessment
from partialslip.study.fatigue.planes import stresses_on
from partialslip.study.fatigue.tables import curve
from partialslip.tools.arrays import Array
from partialslip.tools.output.labels import label_lines
from partialslip.tools.output.svg import svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_WIDE, _DEEP = 2.0, 1.2  # display: half-width and depth of the stress fields, in a
_COLUMNS, _ROWS = 97, 28  # display: points of a field in each body
_LEVELS = 10  # display: of contours
_LABELS = 6.5  # display: size of labels of contours, points
_CROSSING, _MARGIN = 1.0, 0.1  # display: labels may be close to other lines, and have room for all of their length
_ABREAST = {1: 3.4, 2: 2.6}  # display: side of one or two polar plots, inches
_SIDE = 2.1  # display: of more
_LINES = (("-", "black"), ("--", "black"), (":", "black"), ("-", "0.55"), ("--", "0.55"), ("-.", "black"))
_COMPONENTS = ("sigma_xx", "sigma_yy", "sigma_xy")


def stress_svg(found: Assessment) -> str:
    """Return the stress fields in both bodies at load points 1 and 2 as SVG: filled contours, negative ones dashed."""
    result, a = found.result, found.result.a
    assert result.stress_at
    middle = float(np.mean(result.ends))
    x = middle + a * np.linspace(-_WIDE, _WIDE, _COLUMNS)
    depth = _DEEP * a * np.linspace(0, 1, _ROWS) ** 1.5
    fields = [(y, np.asarray(result.stress_at(x, y[:, None]))) for y in (-depth, depth + 1e-30 * a)]
    largest = max(float(np.nanmax(np.abs(field))) for _, field in fields)
    exponent, unit = scale(largest, "Pa", found.scene.units)

    def draw(figure: "Figure") -> Callable[[], None]:
        grid = figure.subplots(3, 2, sharex=True, sharey=True)
        drawn: list[tuple[Axes, list[tuple[float, Array]]]] = []
        for component, row in enumerate(grid):
            low, high = (
                extreme([float(which(field[:, component])) for _, field in fields]) / 10.0**exponent
                for extreme, which in ((min, np.nanmin), (max, np.nanmax))
            )
            levels = _round_levels(low, high)
            for point, axes in enumerate(row):
                lines = []
                for y, field in fields:
                    values = np.ma.masked_invalid(field[point, component] / 10.0**exponent)
                    filled = axes.contourf(x / a, y / a, values, levels, cmap="Greys_r", extend="both")
                    edges = axes.contour(x / a, y / a, values, levels, colors="black", linewidths=0.5)
                    by_level = [*zip(edges.levels, edges.allsegs, strict=True)][::2]
                    lines += [(at, line) for at, some in by_level for line in some if len(line)]
                _outline(axes, found)
                axes.set(xlim=(x[0] / a, x[-1] / a), ylim=(-_DEEP, _DEEP), aspect="equal")
                axes.set_title(f"{_COMPONENTS[component]}, {unit}, load point {point + 1}", fontsize=9, loc="left")
                drawn.append((axes, lines))
            row[0].set_ylabel("y/a")
            figure.colorbar(filled, ax=row, aspect=12, pad=0.02).ax.tick_params(labelsize=7)
        for axes in grid[-1]:
            axes.set_xlabel("x/a")
        return partial(_label, drawn, np.column_stack([x / a, 0 * x]))

    return svg(draw, (8.6, 8.0))


def _label(drawn: Sequence[tuple["Axes", Sequence[tuple[float, Array]]]], surface: Array) -> None:
    """Label contours by axes, level and points (k, 2), off the points of the ``surface`` (k, 2)."""
    for axes, lines in drawn:
        texts = [f"{at:g}".replace("-", "\N{MINUS SIGN}") for at, _ in lines]
        label_lines(axes, [line for _, line in lines], texts, surface, _CROSSING, _LABELS, _MARGIN)


def _round_levels(low: float, high: float) -> Array:
    """Levels of contours: round numbers within the range of the values."""
    from matplotlib.ticker import MaxNLocator

    return np.asarray(MaxNLocator(_LEVELS, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high))


def _outline(axes: "Axes", found: Assessment) -> None:
    """Draw the contact, the surfaces and the sides of finite bodies."""
    a = found.result.a
    left, right = (end / a for end in found.result.ends[1])
    axes.plot([left, right], [0, 0], color="black", lw=2.4, solid_capstyle="butt")
    for way, body in ((-1.0, found.scene.bodies.lower), (1.0, found.scene.bodies.upper)):
        half = 1e3 if body is None or body.width is None else min(body.span / 2 / a, 1e3)
        deep = 1e3 if body is None or body.height is None else body.height / a
        x = np.linspace(-min(half, 2 * _WIDE), min(half, 2 * _WIDE), 201)
        face = found.scene.profile.face_at(a * x) / a if body is not None and body.kind == "pad" else 0 * x
        axes.plot(x, way * face, color="black", lw=0.8)
        if half < 1e3:
            for side in (-half, half):
                axes.plot([side, side], [way * float(face[-1]), way * deep], color="black", lw=0.8)
            axes.plot([-half, half], [way * deep] * 2, color="black", lw=0.8)


def criteria_svg(found: Assessment) -> str:
    """Return the criteria along the surface and over the depth as SVG, each over its largest value at the surface."""
    a = found.result.a

    def draw(figure: "Figure") -> None:
        along, below = figure.subplots(1, 2, sharey=True, width_ratios=(3, 2))
        for axes, kind in ((along, "surface"), (below, "depth")):
            x, depth, values = curve(found, kind)
            at = (x if kind == "surface" else depth) / a
            for (name, each), (line, color) in zip(values.items(), cycle(_LINES)):
                axes.plot(
                    at, each / (found.ratings[name].surface.value or 1.0), ls=line, color=color, lw=1.2, label=name
                )
            axes.axhline(0, color="0.7", lw=0.6, zorder=0)
        for end in found.result.ends[1]:
            along.axvline(end / a, color="0.8", lw=0.6, zorder=0)
        if distance := found.scene.fatigue.distance:
            below.axvline(distance / a, color="0.5", lw=0.8, ls=":")
            below.annotate(
                "distance", (distance / a, 1.02), xycoords=("data", "axes fraction"), fontsize=8, ha="center"
            )
        place = next(iter(found.ratings.values())).surface.x / a
        along.set(
            xlabel="x/a, along the surface", ylabel="criterion over its largest at the surface", ylim=(None, 1.05)
        )
        below.set(xlabel=f"depth/a, at x = {place:.4g} a")
        along.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, frameon=False, fontsize=9, handlelength=1.8,
                     columnspacing=1.2, borderaxespad=0.2)  # fmt: skip

    return svg(draw, (8.2, 4.0))


def planes_svg(found: Assessment) -> str:
    """Return polar plots of the critical plane as SVG: each criterion over the angle of the plane's normal in the xy
    plane, at the place where it is largest at the surface. Empty without criteria of planes."""
    rated = {name: rating for name, rating in found.ratings.items() if rating.criterion.measure}
    if not rated:
        return ""
    angle = np.linspace(0, 2 * np.pi, 721)

    def draw(figure: "Figure") -> None:
        grid = figure.subplots(1, len(rated), squeeze=False, subplot_kw={"projection": "polar"})
        for axes, (name, rating) in zip(grid.flat, rated.items(), strict=True):
            at, measure = rating.surface, rating.criterion.measure
            assert measure
            stress = found.stress(np.array([at.x]), np.array([at.depth]))
            values = measure(stresses_on(stress, angle, np.zeros_like(angle))) / (at.value or 1.0)
            axes.plot(angle, np.maximum(values, 0.0), color="black", lw=1.2)
            normal = at.angle + np.pi * np.arange(2)
            axes.plot(normal, [1.0, 1.0], color="black", lw=0.8, ls="--")
            axes.plot(normal + np.pi / 2, [1.0, 1.0], color="0.5", lw=2.0)
            out = f", tilt {np.degrees(at.tilt):.1f}°" if at.tilt > 1e-3 else ""
            axes.set_title(f"{name}\nnormal at {np.degrees(at.angle).round(1) + 0.0:.1f}°{out}", fontsize=9)
            axes.set(rticks=[0.5, 1.0], ylim=(0, 1.08))
            axes.set_yticklabels([])
            axes.set_thetagrids(np.arange(0, 360, 45))
            axes.tick_params(labelsize=7)

    side = _ABREAST.get(len(rated), _SIDE)
    return svg(draw, (side * len(rated) + 0.4, side + 0.8))
