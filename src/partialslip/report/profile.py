"""The figure of a measured profile: points, the convex gap fitted to them, and what is left."""

from typing import TYPE_CHECKING

import numpy as np

from partialslip.errors import InputError
from partialslip.output.svg import svg
from partialslip.scene import Scene, Tabulated
from partialslip.scene.measured import read_points

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SIZE = 5.2, 4.2  # width and height, inches
_POINTS = 401  # of the fitted gap


def profile_svg(scene: Scene) -> str:
    """Return points and fit of a measured profile as SVG; empty for other profiles, and without the file of points."""
    profile = scene.profile
    if not isinstance(profile, Tabulated) or profile.measured is None:
        return ""
    try:
        x, gap = read_points(profile.measured.file, profile.measured.unit)
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
