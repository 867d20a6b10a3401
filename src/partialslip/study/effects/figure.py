"""Figure of the study of effects, legible in black and white: changes and costs by effect."""

from typing import TYPE_CHECKING

from partialslip.study.effects.worth import EffectStudy
from partialslip.tools.output.svg import svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LEAST = 1e-14  # display: smaller changes are drawn here
_MARKS = {"a": ("o", "white"), "m": ("<", "white"), "n": (">", "white"), "q": ("s", "black"), "q2": ("D", "0.7")}


def effects_svg(study: EffectStudy) -> str:
    """Return the figure of ``study`` as SVG: changes on the left, CPU seconds with and without each effect on the
    right."""

    def draw(figure: "Figure") -> None:
        changes, costs = figure.subplots(1, 2, sharey=True, width_ratios=(3, 2))
        names = [entry.effect + ("" if entry.called_for else " (off)") for entry in study.entries]
        changes.set_yticks(range(len(names)), names)
        changes.invert_yaxis()
        _draw_changes(changes, study)
        _draw_costs(costs, study)
        figure.suptitle(study.scene.name, x=0.01, ha="left", fontsize=10)
        for axes, columns in ((changes, 5), (costs, 3)):
            axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=columns, frameon=False, fontsize=9,
                        handletextpad=0.3, columnspacing=1.0)  # fmt: skip

    return svg(draw, (8.6, 4.6))


def _draw_changes(axes: "Axes", study: EffectStudy) -> None:
    for place, (key, (mark, fill)) in enumerate(_MARKS.items(), start=-2):
        found = [(row + 0.14 * place, entry.changes.get(key)) for row, entry in enumerate(study.entries)]
        known = [(max(value, _LEAST), row) for row, value in found if value is not None]
        axes.plot(*zip(*known, strict=True), mark, mfc=fill, mec="black", ms=5, ls="", label=key, clip_on=False)
    for row, entry in enumerate(study.entries):
        axes.axhline(row, color="0.9", lw=0.6, zorder=0)
        if entry.refused:
            axes.text(1e-7, row, "must be on" if entry.called_for else "cannot be on", ha="center", va="center",
                      fontsize=9, bbox={"facecolor": "white", "edgecolor": "none", "pad": 1})  # fmt: skip
    axes.axvspan(_LEAST, 1e-10, color="0.93", lw=0, zorder=-1)
    axes.set(xscale="log", xlim=(_LEAST, 10), xlabel="change between on and off (shaded: none)")


def _draw_costs(axes: "Axes", study: EffectStudy) -> None:
    for called_for, label, fill in ((True, "without it", "white"), (False, "with it", "0.6")):
        turned = {
            row: entry.costs["cpu_s"][called_for] or 0.0
            for row, entry in enumerate(study.entries)
            if entry.called_for is called_for and not entry.refused
        }
        axes.barh([*turned], [*turned.values()], 0.5, color=fill, edgecolor="black", lw=0.8, label=label)
    axes.axvline(study.result.cost.cpu_s, color="black", lw=1, ls="--", label="as planned")
    axes.set(xlabel="CPU s")
