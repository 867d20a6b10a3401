"""Figures of a size study, legible in black and white."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from partialslip.arrays import Array
from partialslip.output.svg import svg
from partialslip.study.size.sizes import QUANTITIES, Law, Sizes

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LEVELS = (1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3)  # contours of the change
_STYLE = {"a": ("o", "-"), "p0": ("s", "--"), "p": ("x", ":"), "m": ("^", "-"), "n": ("v", "--"), "q": ("D", ":")}
_UNIT = {"a": "a", "p0": "p0, largest p", "p": "p, relative L2", "m": "m, in a", "n": "n, in a", "q": "q, relative L2"}


def size_svg(sizes: Sizes, laws: Sequence[Law], title: str, unit: str) -> str:
    """Return the changes over the size by quantity as SVG, with fitted laws; errors of the mesh in grey.

    Parameters
    ----------
    sizes : Sizes
    laws : sequence of Law
    title, unit : str
        Title of the figure, and unit of the sizes.
    """

    def draw(figure: "Figure") -> None:
        axes = figure.subplots()
        fitted = {law.quantity: law for law in laws}
        for quantity in QUANTITIES:
            mark, line = _STYLE[quantity]
            off, mesh = sizes.off[quantity], sizes.mesh[quantity]
            if not np.any(off > 0):
                continue
            label = _UNIT[quantity]
            if law := fitted.get(quantity):
                label += f": {law.C:.2g} size^-{law.k:.2f} (±{(law.bounds[1] - law.bounds[0]) / 2:.2f})"
                axes.loglog(sizes.size, law.C * sizes.size**-law.k, color="black", ls=line, lw=0.9)
            axes.loglog(sizes.size, off, mark, color="black", mfc="white", ms=6, label=label, ls="none")
            axes.loglog(sizes.size, np.where(mesh > 0, mesh, np.nan), mark, color="0.7", ms=3, ls=line, lw=0.6)
        axes.plot([], [], color="0.7", lw=0.6, label="of the mesh")
        axes.set(xlabel=f"{sizes.name}, {unit}", ylabel="change from the half-plane")
        axes.grid(which="major", color="0.92", lw=0.6)
        axes.set_title(title, loc="left", fontsize=10)
        axes.legend(loc="upper left", bbox_to_anchor=(1.02, 1.0), frameon=False, fontsize=9)

    return svg(draw, (8.6, 4.6))


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
    from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

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
        for side in (axes.xaxis, axes.yaxis):
            side.set_major_locator(LogLocator(subs=(1, 2, 5)))
            side.set_major_formatter(StrMethodFormatter("{x:g}"))
            side.set_minor_formatter(NullFormatter())
        axes.set_title(title, loc="left", fontsize=10)

    return svg(draw, (6.6, 4.6))
