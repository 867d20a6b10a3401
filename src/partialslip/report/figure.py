"""The traction plot: exact line, finite-element markers, stick zone shaded; x/a against q/(f p0)."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from partialslip.arrays import Array
from partialslip.judge.reference import ALL_EFFECTS
from partialslip.output.svg import svg
from partialslip.result import Result
from partialslip.run import Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MARKERS = 41
_MARGIN = 0.04  # beyond the contact, in a
_P_MARKS = {"march": "x", "fem": "+", ALL_EFFECTS: "1"}
_Q_MARKS = {"march": "s", "fem": "o", ALL_EFFECTS: "D"}


def traction_svg(run: Run) -> str:
    """Return the traction plot of ``run`` as SVG."""
    return svg(lambda figure: draw_run(figure.subplots(), run))


def draw_run(axes: "Axes", run: Run) -> None:
    """Draw the tractions of all methods of ``run`` on ``axes``, scaled by the reference."""
    first = run.reference or next(iter(run.results))
    draw_tractions(axes, {first: run.results[first]} | run.results, run.scene.friction.f)


def draw_tractions(axes: "Axes", results: Mapping[str, Result], f: float | None = None) -> None:
    """Draw p/p0 and q/(f p0), q = (q2 - q1)/2, of all methods: lines for a closed form, markers for a mesh.

    Parameters
    ----------
    axes : matplotlib Axes
    results : mapping of str to Result
        By method. The first result gives the scales and the stick zone.
    f : float, optional
        Coefficient of friction; without it q/p0 is drawn, without the friction bound.
    """
    reference = next(iter(results.values()))
    a, p0 = reference.a, reference.p0
    unit, shear = (p0, "q/p0") if f is None else (f * p0, "q/(f p0)")
    if reference.m is not None and reference.n is not None:
        axes.axvspan(-reference.m / a, reference.n / a, color="0.88", lw=0, label="stick zone [-m, n]")
    shears = bool(reference.traction.dq.any())
    for name, result in results.items():
        traction, name = result.traction, name.replace("$", r"\$")
        if traction.cells is None:
            x, p, q = traction.x, traction.p, traction.dq / 2
            axes.plot(x / a, p / p0, color="0.45", lw=1, ls="--", label=f"p/p0, {name}")
            if shears:
                if f is not None:
                    axes.plot(x / a, -p / p0, color="0.45", lw=1, ls="--")
                axes.plot(x / a, q / unit, color="black", lw=1.4, label=f"{shear}, {name}")
        else:
            x = _spread(result)
            p, dq = traction.at(x)
            axes.plot(x / a, p / p0, _P_MARKS.get(name, "x"), ms=6, color="black", ls="", label=f"p/p0, {name}")
            if shears:
                axes.plot(
                    x / a,
                    dq / 2 / unit,
                    _Q_MARKS.get(name, "s"),
                    mfc="white",
                    mec="black",
                    ms=4.5,
                    label=f"{shear}, {name}",
                )
    axes.axhline(0, color="0.7", lw=0.6, zorder=0)
    left, right = np.array(reference.ends).T / a
    limits = min(left) - _MARGIN, max(right) + _MARGIN
    axes.set(xlabel="x/a", ylabel=f"tractions: p/p0 and {shear}", xlim=limits)
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)


def _spread(result: Result) -> Array:
    """Return some of the nodes, m, about evenly spread over the contact."""
    x = result.traction.x
    nearest = np.abs(x[:, None] - np.linspace(x[0], x[-1], _MARKERS)).argmin(axis=0)
    spread: Array = x[np.unique(nearest)]
    return spread
