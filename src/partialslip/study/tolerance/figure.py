"""Figure and tables of a study of tolerances."""

from typing import TYPE_CHECKING

import numpy as np

from partialslip.report.tolerance import draw_tornado, drawn_quantities
from partialslip.run.tolerance import COVERAGE, Propagation
from partialslip.scene.dimensions import dimension
from partialslip.scene.units import Units
from partialslip.study.tolerance.propagation import Solved
from partialslip.tools.output.files import csv_text
from partialslip.tools.output.svg import svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_REACH, _POINTS = 1.1, 441  # display: of the figure, in a, and points along it
_MOST = 8  # display: inputs in the figure
CAPTION = (
    "Above: shear q/(f p0), q = (q2 - q1)/2, of the scene as given, and between which values it stays; below it the "
    "stick zone, and the intervals of its ends. Below: what each input alone does to m and n at the ends of its "
    "tolerance, and its share of the variance (none: no stick zone there)."
)


def tolerance_svg(found: Propagation, known: Solved) -> str:
    """Return the figure of ``found`` and the scenes ``known`` that were solved for it, as SVG: tractions and the stick
    zone with bands, and a tornado for m and n, or a without a stick zone."""
    shown = drawn_quantities(found)
    inputs = [*found.quantities[shown[0]].shares][:_MOST]

    def draw(figure: "Figure") -> None:
        grid = figure.add_gridspec(2, len(shown), height_ratios=(3, 0.6 + 0.5 * len(inputs)))
        _draw_tractions(figure.add_subplot(grid[0, :]), found, known)
        first = None
        for column, key in enumerate(shown):
            axes = figure.add_subplot(grid[1, column], sharey=first)
            draw_tornado(axes, key, found.quantities[key], inputs)
            if first is None:
                first = axes
                axes.set_yticks(range(len(inputs)), [f"{each}\n{found.inputs[each]}" for each in inputs])
                axes.invert_yaxis()
            else:
                axes.tick_params(labelleft=False)
        labelled = dict(
            each for axes in figure.axes for each in zip(*axes.get_legend_handles_labels()[::-1], strict=True)
        )
        figure.legend(labelled.values(), labelled.keys(), loc="outside lower left", ncols=3, frameon=False, fontsize=9)

    return svg(draw, (7.4, 4.6 + 0.5 * len(inputs)))


def _draw_tractions(axes: "Axes", found: Propagation, known: Solved) -> None:
    first, drawn = known.results[0], [each for each in known.results[-found.draws or 0 :] if each]
    assert first
    unit = (known.scene.friction.f or 1.0) * first.p0
    x = np.linspace(-_REACH, _REACH, _POINTS)
    curves = np.array([each.traction.at(x * first.a).dq / 2 / unit for each in drawn])
    ends = [(1 - COVERAGE) / 2, (1 + COVERAGE) / 2] if found.draws else [0.0, 1.0]
    low, high = np.nanquantile(np.nan_to_num(curves), ends, axis=0)
    what = f"{COVERAGE:.0%} of {found.draws} draws" if found.draws else f"all of {len(drawn)} solved scenes"
    axes.fill_between(x, low, high, color="0.8", lw=0, label=f"q/(f p0), {what}")
    axes.plot(x, np.nan_to_num(first.traction.at(x * first.a).dq) / 2 / unit, color="black", lw=1.4, label="as given")
    place = min(0.0, float(low.min())) - 0.12
    if "m" in found.quantities:
        m, n = (found.quantities[key] for key in "mn")
        axes.plot(
            [-m.value, n.value], [place] * 2, color="black", lw=3, solid_capstyle="butt", label="stick zone [-m, n]"
        )
        for sign, end in ((-1, m), (1, n)):
            if end.low is not None and end.high is not None:
                left, right = sorted((sign * end.low, sign * end.high))
                axes.fill_between([left, right], place - 0.05, place + 0.05, facecolor="none", edgecolor="black",
                                  hatch="////", lw=0.6, label="interval of an end" if sign > 0 else None)  # fmt: skip
    axes.set(xlabel="x/a", ylabel="q/(f p0)", xlim=(-_REACH, _REACH))
    axes.set_title(known.scene.name, loc="left", fontsize=10)


def tolerance_csv(found: Propagation, units: Units) -> str:
    """Return the intervals as CSV, one row a quantity, in ``units``, m and n in a; empty cells where a number is not
    known."""
    rows = [
        [
            key,
            "a" if key in ("m", "n") else units.label(each.of),
            *("" if number is None else units.from_si(number, each.of) for number in (each.value, each.low, each.high)),
            "" if each.error is None else units.from_si(each.error, each.of),
            *(each.shares[name] for name in found.inputs),
        ]
        for key, each in found.quantities.items()
    ]
    head = ("quantity", "unit", "value", "low", "high", "numerical error", *(f"share of {key}" for key in found.inputs))
    return csv_text(head, rows)


def draws_csv(found: Propagation, known: Solved) -> str:
    """Return the solved scenes as CSV, one row each, in the scene's units: inputs (of a list the largest size), regime,
    and quantities, m and n in a; empty cells where there is no value."""
    units, of = known.scene.units, {key: each.of for key, each in found.quantities.items()}
    rows = []
    for t, values, result in zip(known.t, known.values, known.results, strict=True):
        numbers = [
            units.from_si(each.number(float(at)), dimension(each.key)) for each, at in zip(known.inputs, t, strict=True)
        ]
        cells = [units.from_si(values[key], of[key]) if key in values else "" for key in of]
        rows.append([*numbers, result.regime if result else "not solved", *cells])
    inputs = [units.heading(key, dimension(key)) for key in found.inputs]
    return csv_text([*inputs, "regime", *(units.heading(key, each) for key, each in of.items())], rows)
