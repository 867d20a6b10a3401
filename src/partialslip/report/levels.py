"""Figures of what stands at load points 1 and 2: q1 and q2, or sigma_xx along the surface of the lower body."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from partialslip.report.answer import scale
from partialslip.report.figure import draw_tractions, in_order
from partialslip.result import Result
from partialslip.scene import Friction
from partialslip.scene.units import Dimension, Units
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError
from partialslip.tools.output.svg import svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from partialslip.run import Run

Shown = Literal["tractions", "shear", "stress"]
_SHOWN = ("tractions", "shear", "stress")
_LINES = ("--", "-")  # display: of the first method, at load points 1 and 2
_MARKS = (("s", "o"), ("^", "v"), ("<", ">"))  # display: of the other methods in turn, at load points 1 and 2
_MOST = 41  # display: marks on a curve
_REACH = 3.0  # display: farthest distance from the middle of the contact, in a
_SIZE = 5.6, 3.8  # display: of one plot, inches
_BELOW = -0.17  # display: of the legend: leaves room for the label of the axis, and none is needed above for a title


def draw_levels(
    axes: "Axes", results: Mapping[str, Result], shown: Shown, friction: Friction | None, units: Units | None
) -> None:
    """Draw ``results``, by method, on ``axes``; the first gives the scales. The legend stands below.

    Parameters
    ----------
    axes : matplotlib Axes
    results : mapping of str to Result
    shown : "tractions", "shear" or "stress"
        p and q; or q1 and q2; or sigma_xx along the surface of the lower body at load points 1 and 2.
    friction : Friction or None
        Friction of the scene, if it is known: shear is scaled by f p0, otherwise by p0.
    units : Units or None
        Units of the axes; None scales x by a and tractions by p0.

    Raises
    ------
    InputError
        If ``shown`` is none of these, no result knows it, or p and q are asked for in units.
    """
    if shown not in _SHOWN:
        raise InputError(f"what = {shown!r:.40}: must be one of {', '.join(map(repr, _SHOWN))}")
    if shown == "tractions":
        if units:
            raise InputError("what = 'tractions': must be 'shear' or 'stress' in units; p and q/f share one scale")
        draw_tractions(axes, results, friction)
    else:
        _draw_levels(axes, results, shown, friction, units)
    axes.legend(loc="upper left", bbox_to_anchor=(0.0, _BELOW), ncols=2, frameon=False, fontsize=9, handlelength=1.6,
                columnspacing=1.2)  # fmt: skip


def levels_svg(run: "Run") -> str:
    """Return q1 and q2, if they are known, and sigma_xx along the surface as SVG, in the units of the scene. Empty if
    no result has stresses: only then are they asked for."""
    every: tuple[Shown, ...] = ("shear", "stress")
    some = [shown for shown in every if any(_curves(result, shown) for result in run.results.values())]
    if "stress" not in some:
        return ""
    results, friction, units = in_order(run), run.scene.friction, run.scene.units

    def draw_all(figure: "Figure") -> None:
        for axes, shown in zip(figure.subplots(len(some), 1, squeeze=False).flat, some, strict=True):
            draw_levels(axes, results, shown, friction, units)

    return svg(draw_all, (_SIZE[0], _SIZE[1] * len(some)))


def _draw_levels(
    axes: "Axes", results: Mapping[str, Result], shown: Shown, friction: Friction | None, units: Units | None
) -> None:
    known = {name: curves for name, result in results.items() if (curves := _curves(result, shown))}
    if not known:
        what = "q1 and q2" if shown == "shear" else "sigma_xx: run(scene, subsurface=True) finds it"
        raise InputError(f"what = {shown!r}: no result of this run knows {what}")
    first = next(iter(results.values()))
    name, unit = ("q", first.p0) if shown == "shear" else ("sigma_xx", first.p0)
    across, up = "x/a", f"{name}/p0"
    length = first.a
    if units:
        largest = max(float(np.nanmax(np.abs(values))) for _, levels in known.values() for values in levels)
        (length, across), (unit, up) = _axis("x", first.a, "m", units), _axis(name, largest, "Pa", units)
    elif shown == "shear" and friction is not None and friction.f:
        unit, up = friction.f * first.p0, "q/(f p0)"
    low, high = (float(np.mean(first.ends)) + way * _REACH * first.a for way in (-1, 1))
    for number, (method, (x, levels)) in enumerate(known.items()):
        for point, (values, line, mark) in enumerate(zip(levels, _LINES, _MARKS[number % len(_MARKS)], strict=True), 1):
            label = f"{name}{point}, {method}" if shown == "shear" else f"{name}, load point {point}, {method}"
            style: dict[str, Any] = {"ls": line, "lw": 1.2}
            some = np.arange(len(x))
            if number:  # marks on the lines of the first
                places = np.linspace(max(x[0], low), min(x[-1], high), _MOST)
                some = np.unique(np.abs(x[:, None] - places).argmin(axis=0))
                style = {"ls": "", "marker": mark, "ms": 4.5, "mfc": "white"}
            axes.plot(x[some] / length, values[some] / unit, color="black", label=label, **style)
    if shown == "shear" and friction is not None:
        traction = first.traction
        for point, p in enumerate((traction.p if traction.p1 is None else traction.p1, traction.p), start=1):
            if point == 2 or traction.p1 is not None:
                bound, where = friction.at(traction.x) * p / unit, f", load point {point}" * (traction.p1 is not None)
                style = {"color": "0.45", "lw": 0.8, "ls": ":"}
                axes.plot(traction.x / length, bound, **style, label=f"bounds f p{where}")
                axes.plot(traction.x / length, -bound, **style)
    axes.axhline(0, color="0.7", lw=0.6, zorder=0)
    axes.set(xlabel=across, ylabel=up)
    if shown == "stress":
        axes.set_xlim(low / length, high / length)


def _curves(result: Result, shown: Shown) -> tuple[Array, tuple[Array, Array]] | None:
    """Points (k,) and the values (k,) at load points 1 and 2; None if the result does not know them."""
    if shown == "stress":
        surface = result.surface
        return None if surface is None else (surface.x, (surface.sigma[0, 0], surface.sigma[0, 1]))
    traction = result.traction
    if traction.q1 is None or traction.q2 is None:
        return None
    return traction.x, (traction.q1, traction.q2)


def _axis(name: str, size: float, of: Dimension, units: Units) -> tuple[float, str]:
    """Unit, SI, and label of an axis for values up to ``size``."""
    exponent, label = (-3, "mm") if of == "m" and 1e-6 <= size < 1 else scale(size, of, units)
    return 10.0**exponent, f"{name} in {label}"
