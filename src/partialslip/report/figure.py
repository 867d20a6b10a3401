"""The traction plot: exact line, finite-element markers, stick zone shaded; x/a against q/(f p0); and the errors."""

import math
from collections.abc import Mapping
from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np

from partialslip.report.rows import shown_half_planes
from partialslip.result import Result
from partialslip.run import Run
from partialslip.scene import Friction, Scene, Tabulated
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError
from partialslip.tools.methods import METHODS
from partialslip.tools.output.svg import svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


_SIZE = 5.2, 4.2  # display: width and height, inches
_LEAST = 1e-17  # display: smallest error in the figure
_ERROR_LINES = ("-", "--", ":", "-.")
_MESH = 1.5, 1.0  # display: largest distance from the middle of the contact, and |y|, of the mesh, in a
_MARKERS = 41  # display: on a curve
_DRAWN = 5000  # display: most points of a line of errors
_MARGIN = 0.04  # display: beyond the contact, in a
_ALL = "1", "D"  # display: marks of p and q with all effects


def traction_svg(run: Run, *, errors: bool = True) -> str:
    """Return the traction plot of ``run`` as SVG; below it, with ``errors``, those of the compared methods along the
    contact."""
    if not (errors and run.comparisons):
        return svg(lambda figure: draw_run(figure.subplots(), run), _SIZE)

    def draw(figure: "Figure") -> None:
        above, below = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
        draw_run(above, run)
        above.set_xlabel("")
        draw_errors(below, run)

    return svg(draw, (_SIZE[0], 1.6 * _SIZE[1]))


def error_svg(run: Run) -> str:
    """Return the errors of the compared methods of ``run`` along the contact as SVG; empty without any."""
    if not run.comparisons:
        return ""
    return svg(lambda figure: draw_errors(figure.subplots(), run), (_SIZE[0], 0.6 * _SIZE[1]))


def mesh_svg(run: Run) -> str:
    """Return the element edges near the contact as SVG, of the first result with elements; empty without one."""
    result = next((each for each in run.results.values() if each.edges), None)
    if not result:
        return ""

    def draw(figure: "Figure") -> None:
        axes = figure.subplots()
        for edges in result.edges:
            apart = np.insert(edges / result.a, 2, np.nan, axis=1)  # one line with gaps: one element of the SVG
            axes.plot(*apart.reshape(-1, 2).T, color="black", lw=0.4)
        left, right = (end / result.a for end in result.ends[1])
        axes.plot([left, right], [0, 0], color="black", lw=2.2, solid_capstyle="butt")
        middle = (left + right) / 2
        axes.set(
            xlim=(middle - _MESH[0], middle + _MESH[0]),
            ylim=(-_MESH[1], _MESH[1]),
            aspect="equal",
            xlabel="x/a",
            ylabel="y/a",
        )

    return svg(draw, (_SIZE[0], 3.6))


def draw_run(axes: "Axes", run: Run) -> None:
    """Draw the tractions of all methods of ``run`` on ``axes``, scaled by the first of :func:`in_order`."""
    draw_tractions(axes, in_order(run), run.scene.friction)


def in_order(run: Run) -> dict[str, Result]:
    """Return the results of ``run`` by method, first that of the reference; of finite bodies that which answers, as
    half-planes only stand for them."""
    first = run.answering if run.scene.sized else run.reference or next(iter(run.results))
    return {first: run.results[first]} | run.results


def draw_tractions(
    axes: "Axes", results: Mapping[str, Result], friction: Friction | None = None, shear: str | None = None
) -> None:
    """Draw p/p0 and q/(f p0), q = (q2 - q1)/2, of all methods: lines for a closed form, markers for a mesh.

    Parameters
    ----------
    axes : matplotlib Axes
    results : mapping of str to Result
        By method. The first result gives the scales and the stick zone.
    friction : Friction, optional
        Friction of the scene; without it q/p0 is drawn, without the friction bound.
    shear : str, optional
        Name of the shear in the labels; default: q/(f p0) or q/p0.
    """
    leading, reference = next(iter(results.items()))
    a, p0 = reference.a, reference.p0
    unit, usual = (p0, "q/p0") if friction is None else (friction.f * p0, "q/(f p0)")
    shear = shear or usual
    if reference.m is not None and reference.n is not None and reference.steady:
        whose = f", {_without_formula(leading)}" if len(results) > 1 else ""
        axes.axvspan(-reference.m / a, reference.n / a, color="0.88", lw=0, label=f"stick zone [-m, n]{whose}")
    shears = bool(reference.traction.dq.any())
    for name, result in results.items():
        traction, label = result.traction, _without_formula(name)
        if traction.cells is None:
            x, p, q = traction.x, traction.p, traction.dq / 2
            axes.plot(x / a, p / p0, color="0.45", lw=1, ls="--", label=f"p/p0, {label}")
            bound, line = p, "--"
            if traction.p1 is not None:
                first = traction.p1
                bound, line = (first + p) / 2, "-."
                axes.plot(x / a, first / p0, color="0.45", lw=1, ls=":", label=f"p/p0 at load point 1, {label}")
                axes.plot(x / a, bound / p0, color="0.45", lw=0.8, ls=line, label="mean of both, bounds q/f")
            if shears:
                if friction is not None:
                    share = friction.at(x) / (friction.f or 1.0)
                    style: dict[str, Any] = {"color": "0.45", "lw": 1 if line == "--" else 0.8, "ls": line}
                    if friction.varies:
                        style["ls"] = (0, (1, 1))
                        axes.plot(x / a, bound * share / p0, **style, label="bounds ±f(x) p/(f p0)")
                    axes.plot(x / a, -bound * share / p0, **style)
                axes.plot(x / a, q / unit, color="black", lw=1.4, label=f"{shear}, {label}")
        else:
            x = _marker_places(result)
            found = traction.at(x)
            marks = METHODS[name].marks if name in METHODS else _ALL
            axes.plot(x / a, found.p / p0, marks[0], ms=6, color="black", ls="", label=f"p/p0, {label}")
            if shears:
                axes.plot(
                    x / a,
                    found.dq / 2 / unit,
                    marks[1],
                    mfc="white",
                    mec="black",
                    ms=4.5,
                    label=f"{shear}, {label}",
                )
    axes.axhline(0, color="0.7", lw=0.6, zorder=0)
    axes.set(xlabel="x/a", ylabel=f"tractions: p/p0 and {shear}", xlim=_limits(results))
    _legend_above(axes)


def _limits(results: Mapping[str, Result]) -> tuple[float, float]:
    """Return the smallest and the largest x/a of a figure along the contact, a being that of the first result."""
    low, high = _span(*(pair for result in results.values() for pair in result.ends))
    a = next(iter(results.values())).a
    return low / a - _MARGIN, high / a + _MARGIN


def _span(*ends: tuple[float, float]) -> tuple[float, float]:
    """Return the leftmost and the rightmost of some pairs of ``ends``."""
    lefts, rights = zip(*ends, strict=True)
    return min(lefts), max(rights)


def _without_formula(name: str) -> str:
    """Return a name that matplotlib takes for no formula."""
    return name.replace("$", r"\$")


def draw_errors(axes: "Axes", run: Run) -> None:
    """Draw |p - p_ref|/p0 and |q - q_ref|/(f p0) of each compared method on logarithmic ``axes``, at its points.

    ``run`` must have a reference. Errors below 1e-17 are not drawn, nor are those beyond both contacts, where there is
    rounding alone.
    """
    shown, reference = in_order(run), run.results[run.reference or ""]
    first, f = next(iter(shown.values())), run.scene.friction.f
    a, p0 = first.a, first.p0
    for name, line in zip(run.comparisons, cycle(_ERROR_LINES)):
        result, label = run.results[name], _without_formula(name)
        x = result.traction.x[:: -(-len(result.traction.x) // _DRAWN)]
        found, true = result.traction.at(x), reference.traction.at(x)
        at_2 = _span(result.ends[1], reference.ends[1])  # p is that of load point 2
        _draw_error(axes, x, a, (found.p - true.p) / p0, at_2, color="0.55", ls=line, label=f"p, {label}")
        if f and (found.dq.any() or true.dq.any()):
            ends, q = _span(*result.ends, *reference.ends), (found.dq - true.dq) / 2 / (f * p0)
            _draw_error(axes, x, a, q, ends, color="black", ls=line, label=f"q, {label}")
    from matplotlib.ticker import LogLocator, NullLocator

    what = "difference" if shown_half_planes(run) else "error"
    axes.set(yscale="log", xlabel="x/a", ylabel=f"{what}, in p0 and f p0", xlim=_limits(shown))
    axes.set_ylim(
        *(10.0 ** way(math.log10(end)) for way, end in zip((math.floor, math.ceil), axes.get_ylim(), strict=True))
    )
    # few ticks and plain text: small ticks and formulas take longer to lay out than all lines together
    axes.yaxis.set_major_locator(LogLocator(numticks=6))
    axes.yaxis.set_major_formatter("{x:.0e}")
    axes.yaxis.set_minor_locator(NullLocator())
    axes.grid(axis="y", color="0.92", lw=0.6)
    _legend_above(axes)


def _draw_error(axes: "Axes", x: Array, a: float, error: Array, ends: tuple[float, float], **style: Any) -> None:
    """Draw the ``error`` between the ``ends``, at points x/a."""
    within = (x > ends[0]) & (x < ends[1])
    size = np.abs(error[within])
    axes.plot(x[within] / a, np.where(size > _LEAST, size, np.nan), lw=0.9, **style)


def _legend_above(axes: "Axes") -> None:
    """Put the legend above the axes: figures stay narrow enough for a phone."""
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, frameon=False, fontsize=9,
                handlelength=1.6, columnspacing=1.2, borderaxespad=0.2)  # fmt: skip


def _marker_places(result: Result) -> Array:
    """Return some of the nodes, m, about evenly spread over the contact."""
    x = result.traction.x
    nearest = np.searchsorted((x[1:] + x[:-1]) / 2, np.linspace(x[0], x[-1], _MARKERS))
    return x[np.unique(nearest)]


_POINTS = 401  # display: of the fitted gap


def profile_svg(scene: Scene) -> str:
    """Return points and fit of a measured profile as SVG; empty for other profiles, and without the file of points."""
    profile = scene.profile
    if not isinstance(profile, Tabulated) or profile.measured is None:
        return ""
    try:
        x, gap = profile.measured.read()
    except InputError:
        return ""
    unit, length = "mm", 1e-3
    fine = np.linspace(x[0], x[-1], _POINTS)
    residuals = gap - profile.gap_at(x)
    residuals -= residuals.mean()

    def draw(figure: "Figure") -> None:
        above, below = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
        above.plot(x / length, (profile.gap_at(x) + residuals) / length, ".", ms=2, color="0.55", label="points")
        above.plot(fine / length, profile.gap_at(fine) / length, color="black", lw=1.2, label="convex gap")
        above.set(ylabel=f"gap, {unit}")
        above.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, frameon=False, fontsize=9)
        below.plot(x / length, residuals / length, ".", ms=2, color="0.3")
        below.axhline(0, color="0.7", lw=0.6, zorder=0)
        below.set(xlabel=f"x, {unit}", ylabel=f"points - gap, {unit}")

    return svg(draw, _SIZE)
