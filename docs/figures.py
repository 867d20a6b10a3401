"""Regenerate the figures of theory.md: python docs/figures.py [DIR] (default: docs/figures)."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from partialslip.halfplane import Contact, adhered, hysteresis, one_step_zone
from partialslip.halfplane import stick_zone as stick_zone_under
from partialslip.halfplane.gradual_table import parted, tabled
from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.loading import one_step
from partialslip.halfplane.steady import steady_stick_zone, stick_zones
from partialslip.halfplane.traction import half_range
from partialslip.scene.gradual import turns_round
from partialslip.study.map.figure import ends_svg
from partialslip.study.map.grid import stick_map
from partialslip.tools.output.svg import svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_STYLES = ("-", "--", ":")
_SIZE = (7.4, 3.8)
_UNIT = Contact(a=1.0, P=np.pi / 2, shape=HertzShape())  # p0 = 1


def main(folder: Path) -> None:
    """Write all figures into ``folder``."""
    folder.mkdir(parents=True, exist_ok=True)
    figures = {
        "signs": svg(_signs, (7.4, 3.6)),
        "cycle": svg(_cycle, _SIZE),
        "adhered": svg(_adhered, _SIZE),
        "small-tension": svg(lambda figure: _tractions(figure, 0.75, 2.4), _SIZE),
        "large-tension": svg(lambda figure: _tractions(figure, 0.3, 4.0), _SIZE),
        "loop": svg(_loops, _SIZE),
        "ends": ends_svg(stick_map()),
        "turning": svg(_turning, _SIZE),
        "regions": svg(_regions, (7.4, 4.4)),
    }
    for name, text in figures.items():
        (folder / f"{name}.svg").write_text(text, "utf-8")


def _signs(figure: "Figure") -> None:
    """Two bodies, the loads that act on them, and q on both sides of the contact line: signs of section 1."""
    axes = figure.subplots()
    axes.set(xlim=(-3.4, 3.4), ylim=(-1.55, 1.75), aspect="equal")
    axes.set_axis_off()
    x = np.linspace(-2.4, 2.4, 201)
    gap = np.where(
        np.abs(x) > 1, 0.5 * (np.abs(x) * np.sqrt(np.maximum(x**2 - 1, 0)) - np.arccosh(np.maximum(np.abs(x), 1))), 0
    )
    axes.fill_between(x, np.minimum(0.36 * gap, 1.0), 1.0, color="0.93", lw=0)
    axes.plot(x, 0.36 * gap, color="black", lw=1)
    axes.fill_between(x, -1.0, 0.0, color="0.86", lw=0)
    axes.plot(x[[0, -1]], [0, 0], color="black", lw=1)
    m, n = 0.75, 0.35
    axes.plot([-1, 1], [0, 0], color="black", lw=2.2, solid_capstyle="butt")
    for place, text in ((-1, "-a"), (-m, "-m"), (n, "n"), (1, "a")):
        axes.plot([place, place], [-0.28, 0.06], color="black", lw=0.8)
        axes.text(place, -0.33, text, ha="center", va="top", fontsize=9)
    axes.text((n - m) / 2, -0.33, "sticks", ha="center", va="top", fontsize=9)
    _arrow(axes, (0, 1.7), (0, 1.05), "P", (0.1, 1.45))
    _arrow(axes, (0, -1.5), (0, -1.05), "P", (0.1, -1.35))
    _arrow(axes, (-0.7, 1.2), (-1.5, 1.2), "Q", (-1.1, 1.28))
    _arrow(axes, (0.7, -1.2), (1.5, -1.2), "Q", (1.1, -1.45))
    _arrow(axes, (2.45, -0.5), (3.15, -0.5), "σ", (2.8, -0.42))
    _arrow(axes, (-2.45, -0.5), (-3.15, -0.5), "σ", (-2.8, -0.42))
    _arrow(axes, (-0.25, 0.13), (0.3, 0.13), "q", (0.38, 0.09))
    _arrow(axes, (0.05, -0.13), (-0.5, -0.13), "", (0, 0))
    axes.text(-2.3, 0.82, "body 1", va="center", fontsize=10)
    axes.text(-2.3, -0.82, "body 2", va="center", fontsize=10)
    _arrow(axes, (2.5, 0.25), (3.1, 0.25), "x", (3.15, 0.2))
    _arrow(axes, (2.5, 0.25), (2.5, 0.85), "y", (2.45, 0.92))


def _arrow(
    axes: "Axes", start: tuple[float, float], end: tuple[float, float], text: str, at: tuple[float, float]
) -> None:
    axes.annotate(
        "", end, start, arrowprops={"arrowstyle": "-|>", "color": "black", "lw": 1.2, "shrinkA": 0, "shrinkB": 0}
    )
    axes.text(*at, text, fontsize=10)


def _cycle(figure: "Figure") -> None:
    """Load points and mean of a cycle under large tension, with the bound on the mean of Q."""
    axes = figure.subplots()
    Qf, sf, mean = 0.3, 4.0, np.array([0.8, 0.25])  # sigma and Q, in f p0 and f P
    bound = one_step(Qf, sf, HertzShape()).mean_load_bound
    half = np.array([sf / 2, Qf])
    second, first = mean + half, mean - half
    axes.axhspan(-bound, bound, color="0.88", lw=0, label="where the mean must be")
    for slides in (-1, 1):
        axes.axhline(slides, color="black", lw=1, ls=":", label="slides: |Q| = f P" if slides > 0 else None)
    axes.plot(*np.transpose([(0, 0), second]), color="black", lw=1.2, ls="--", label="first loading")
    axes.plot(*np.transpose([first, second]), color="black", lw=1.6, label="cycle between load points 1 and 2")
    axes.plot(*np.transpose([first, second]), "o", color="black", ms=5)
    axes.plot(*mean, "o", color="black", mfc="white", ms=6, label="mean")
    for point, text in ((first, "1"), (second, "2")):
        axes.annotate(text, point, xytext=(6, -12), textcoords="offset points")
    axes.axhline(0, color="0.7", lw=0.6, zorder=0)
    axes.axvline(0, color="0.7", lw=0.6, zorder=0)
    axes.set(xlim=(-2.2, 3.6), ylim=(-1.15, 1.15), xlabel="σ/(f p0)", ylabel="Q/(f P)")
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)


def _adhered(figure: "Figure") -> None:
    """Change of shear if nothing slips (1): shear force alone, no singularity at -a, a change of sign, and tension
    alone."""
    axes = figure.subplots()
    x = np.sin(np.linspace(-np.pi / 2, np.pi / 2, 803)[1:-1])
    for (ratio, text), style in zip(((0.0, "0"), (4 / np.pi, "4/π"), (4.0, "4")), _STYLES, strict=True):
        axes.plot(x, adhered(x, 1.0, 1.0, ratio), color="black", lw=1.4, ls=style, label=f"Δσ a/ΔQ = {text}")
    alone = adhered(x, 1.0, 0.0, 1.0)
    axes.plot(x, alone, color="0.55", lw=1.4, label="Δσ alone, Δq/Δσ")
    axes.set(ylim=(-1.5, 3), ylabel="a Δq/ΔQ")
    _finish(axes)


def _tractions(figure: "Figure", Qf: float, sf: float) -> None:
    """Shear at both load points under fully reversed loads, and the friction bounds."""
    axes, shape = figure.subplots(), HertzShape()
    zone = steady_stick_zone(Qf, sf, shape)
    m, n = zone.half_width - zone.centre, zone.half_width + zone.centre
    ends = np.array([-1.0, -m, n, 1.0])
    crowd = (1 - np.cos(np.linspace(0, np.pi, 101))) / 2
    x = np.unique(ends[:-1, None] + np.diff(ends)[:, None] * crowd)
    q, bound = half_range(x, zone, shape), shape.pressure(x)
    axes.axvspan(-m, n, color="0.88", lw=0, label="stick zone [-m, n]")
    axes.plot(x, bound, color="0.45", lw=1, ls=":", label="±f p")
    axes.plot(x, -bound, color="0.45", lw=1, ls=":")
    axes.plot(x, q, color="black", lw=1.4, label="q2, load point 2")
    axes.plot(x, -q, color="black", lw=1.4, ls="--", label="q1, load point 1")
    axes.set(ylabel="q/(f p0)", title=f"ΔQ/(2 f P) = {Qf:g}, Δσ/(f p0) = {sf:g}")
    axes.title.set_fontsize(10)
    _finish(axes)


def _turning(figure: "Figure") -> None:
    """Ends of the stick zone under growing tension: of a single step, and of gradual loads."""
    panels = figure.subplots(1, 2, sharey=True)
    for axes, Qf in zip(panels, (0.55, 0.75), strict=True):
        dQ, sf = Qf * np.pi, np.linspace(0, 8, 81)
        once, gradual = one_step_zone(_UNIT, 1.0, dQ, sf), stick_zone_under(_UNIT, 1.0, dQ, sf[4::8])
        axes.plot(sf, once.n, color="black", lw=1, ls="--", label="n/a, one step")
        axes.plot(sf, -once.m, color="black", lw=1, label="-m/a, one step")
        axes.plot(sf[4::8], gradual.n, "s", color="black", ms=4, label="n/a, gradual")
        axes.plot(sf[4::8], -gradual.m, "o", color="black", ms=4, label="-m/a, gradual")
        axes.set(xlabel="Δσ/(f p0)", title=f"ΔQ/(2 f P) = {Qf:g}", ylim=(-1.05, 1.05))
        axes.title.set_fontsize(10)
    panels[0].set_ylabel("x/a")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower left", ncols=4, frameon=False)


def _regions(figure: "Figure") -> None:
    """Where slip turns round, where an inner zone slips, and by how much m and n of one step are off there."""
    Qf, sf = np.meshgrid(np.linspace(0, 1, 400, endpoint=False), np.linspace(0, 10, 400))
    once = stick_zones(Qf.ravel(), sf.ravel(), HertzShape())
    turned = turns_round(Qf.ravel(), sf.ravel(), once.s, once.centre, once.half_width)
    zone, inner = tabled(Qf.ravel(), sf.ravel()), np.zeros(Qf.size)
    inner[turned] = parted(Qf.ravel()[turned], sf.ravel()[turned])
    panels = figure.subplots(1, 2, sharey=True)
    for axes, of in zip(panels, "mn", strict=True):
        off = np.abs(getattr(zone, of) - getattr(once, of))
        off[~turned] = np.nan
        off = off.reshape(Qf.shape)
        filled = axes.contourf(Qf, sf, off, [0, 1e-3, 1e-2, 3e-2, 0.1, 0.2, 0.4], cmap="Greys", extend="max")
        axes.contour(Qf, sf, turned.reshape(Qf.shape), [0.5], colors="black", linewidths=1.4)
        axes.contour(Qf, sf, inner.reshape(Qf.shape), [0.5], colors="black", linewidths=1, linestyles="--")
        axes.set(xlabel="ΔQ/(2 f P)", title=f"{of}/a of one step: error")
        axes.title.set_fontsize(10)
    panels[0].set_ylabel("Δσ/(f p0)")
    panels[0].text(0.12, 6, "one step\nholds", fontsize=9)
    panels[0].text(0.68, 9.4, "inner zone", fontsize=9)
    figure.colorbar(filled, ax=panels)


def _loops(figure: "Figure") -> None:
    """Shear force against displacement by slip. With A = f = 1 the unit of displacement is A f p0 a."""
    axes = figure.subplots()
    for Qf, style in zip((0.9, 0.7, 0.5), _STYLES, strict=True):
        dQ = Qf * np.pi  # 2 f P is pi
        loop = hysteresis(_UNIT, A=1.0, f=1.0, dQ=dQ, dsigma=dQ)
        x, Q = loop.displacement - loop.displacement.max() / 2, (loop.Q - dQ / 2) / (np.pi / 2)
        axes.plot(x, Q, color="black", lw=1.4, ls=style, label=f"ΔQ/(2 f P) = {Qf:g}")
    axes.axhline(0, color="0.7", lw=0.6, zorder=0)
    axes.set(xlabel="displacement by slip/(A f p0 a)", ylabel="Q/(f P)", title="Δσ a/ΔQ = 1")
    axes.title.set_fontsize(10)
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)


def _finish(axes: "Axes") -> None:
    axes.axhline(0, color="0.7", lw=0.6, zorder=0)
    axes.set(xlabel="x/a", xlim=(-1.04, 1.04))
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if sys.argv[1:] else Path(__file__).parent / "figures")
