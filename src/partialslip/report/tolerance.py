"""What the tolerances of a scene allow, as texts and table cells: values, intervals and shares of the inputs.

The numerical error has a column of its own; digits follow the larger of both.
"""

import math
from collections import Counter
from collections.abc import Mapping
from typing import TYPE_CHECKING

from partialslip.report.answer import scale
from partialslip.run import Run
from partialslip.run.tolerance import COVERAGE, Interval, Propagation
from partialslip.scene.dimensions import dimension
from partialslip.scene.units import Units
from partialslip.tools.output.svg import svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HEADINGS = ("quantity", "unit", "value", f"{COVERAGE:.0%} interval", "num. error", "from")
_LEAST = 0.01  # display: smaller shares are left out
_ROUNDING = 1e-9  # display: of the value: smaller intervals and errors are none
_LENGTH = (-3, "mm")
_MOST = 8  # display: inputs in the figure
TORNADO = (
    "What each input alone does at the ends of its tolerance, and its share of the variance; shaded: the interval; "
    "none: no stick zone there."
)


def tolerance_heading(found: Propagation) -> str:
    """Return which tolerances were propagated how, in one line."""
    given = ", ".join(f"{key} {text}" for key, text in found.inputs.items())
    by = f"{found.draws} draws" if found.draws else "differences"
    exact = f"{100 * found.misfit:.1g} % of the interval" if found.misfit > 0.0005 else "0.05 % of the interval"
    return f"within {given}: by {found.method}, {by}, known to {exact}"


def tolerance_rows(found: Propagation, units: Units) -> list[tuple[str, ...]]:
    """Return rows of quantity, unit, value, interval, numerical error and shares of the inputs."""
    return [_row(key, each, units) for key, each in found.quantities.items()]


def _row(key: str, found: Interval, units: Units) -> tuple[str, ...]:
    exponent, unit = (0, "a") if key in ("m", "n") else _unit(found, units)
    size = 10.0**exponent
    value, least, error = found.value / size, _ROUNDING * abs(found.value) / size, (found.error or 0.0) / size
    off = "no estimate" if found.error is None else "rounding" if error <= least else f"{error:.1e}"
    low, high = (value if each is None else each / size for each in (found.low, found.high))
    wide = max(abs(high - value), abs(value - low))
    known = found.low is not None and wide > least
    digits = _decimals(max(wide, error, least))
    shown = [f"{each:.{digits}f}" if max(wide, error) > least else f"{each:.7g}" for each in (value, low, high)]
    interval = f"{shown[1]} to {shown[2]}" if known else "as value" if found.low is not None else "not known"
    return key, unit, shown[0], interval, off, shares_text(found.shares) if known else ""


def _unit(found: Interval, units: Units) -> tuple[int, str]:
    if found.of == "m" and 1e-6 <= found.value < 1 and units.label("m") in ("m", "mm"):
        return _LENGTH
    return scale(abs(found.value), found.of, units)


def _decimals(width: float) -> int:
    """Decimals that leave two digits of a ``width``."""
    return max(0, 1 - math.floor(math.log10(width))) if 0 < width < math.inf else 6


def shares_text(shares: Mapping[str, float]) -> str:
    """Return shares of inputs, by the last part of their keys where this is enough, and of what inputs do together."""
    short = Counter(key.rpartition(".")[2] for key in shares)
    names = {key: last if short[last := key.rpartition(".")[2]] == 1 else key for key in shares}
    known = {names[key]: share for key, share in shares.items() if share >= _LEAST}
    if known and (rest := 1 - sum(shares.values())) >= _LEAST:
        known["together"] = rest
    return ", ".join(f"{key} {share:.0%}" for key, share in known.items())


def tolerance_lines(found: Propagation, units: Units) -> list[str]:
    """Return how probable the regimes are, where they change, and what could not be solved, as lines."""
    chances = [f"{regime} {_percent(chance)}" for regime, chance in found.regimes.items()]
    lines = [f"regime: {', '.join(chances) if len(chances) > 1 else f'{next(iter(found.regimes))} throughout'}"]
    if "sliding" in found.regimes and "m" in found.quantities:
        lines[0] += "; all but a and pressures are of cases that do not slide"
    for change in found.changes:
        value = units.labelled(change.value, dimension(change.key), 4).strip()
        off = "" if change.share is None else f" ({change.share:+.2%})"
        word = (
            "the contact slides"
            if change.regime == "sliding"
            else f"{change.regime} begins, an end at the contact edge,"
        )
        lines.append(f"{word} at {change.key} = {value}{off}")
    total = found.solves
    lines += [f"not solved: {count} of {total} scenes: {why}" for why, count in found.refused.items()]
    return lines


def _percent(chance: float) -> str:
    return f"{chance:.1%}" if 0.001 <= chance <= 0.999 else "less than 0.1%" if chance < 0.5 else "more than 99.9%"


def allowed_lines(run: Run) -> list[str]:
    """Return, for each compared method, whether m and n are within what the tolerances allow, a line each; empty
    without tolerances."""
    lines, found = list[str](), run.tolerance
    for name, comparison in run.comparisons.items() if found else ():
        assert found
        for verdict in comparison.verdicts:
            key, interval = verdict.quantity, found.quantities.get(verdict.quantity)
            if key not in ("m", "n") or interval is None or interval.low is None or interval.high is None:
                continue
            if not isinstance(verdict.found, float) or not isinstance(verdict.reference, float):
                continue
            off, low, high = (
                verdict.found - verdict.reference,
                interval.low - interval.value,
                interval.high - interval.value,
            )
            inside = "within" if low <= off <= high else "beyond"
            first = next(iter(interval.shares))
            allowed = f"{inside} what the inputs allow, {low:+.1%} to {high:+.1%}"
            lines.append(
                f"{name}: {key} off by {100 * off:+.2g}% of a, {allowed} "
                f"({first} {found.inputs[first]}: {interval.shares[first]:.0%} of it)"
            )
    return lines


def drawn_quantities(found: Propagation) -> list[str]:
    """Return the quantities that figures show: m and n, or a without a stick zone."""
    return [key for key in found.quantities if key in ("m", "n")] or ["a"]


def tornado_svg(found: Propagation) -> str:
    """Return what each input does to m and n, or to a without a stick zone, as SVG: bars from the value to that at the
    lower and the upper end of the tolerance."""
    shown = {key: found.quantities[key] for key in drawn_quantities(found)}

    def draw(figure: "Figure") -> None:
        panels = figure.subplots(1, len(shown), sharey=True, squeeze=False)[0]
        inputs = [*next(iter(shown.values())).shares][:_MOST]
        panels[0].set_yticks(range(len(inputs)), [f"{key}\n{found.inputs[key]}" for key in inputs])
        panels[0].invert_yaxis()
        for axes, (key, interval) in zip(panels, shown.items(), strict=True):
            draw_tornado(axes, key, interval, inputs)
        handles, labels = panels[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower left", ncols=3, frameon=False, fontsize=9)

    return svg(draw, (7.4, 1.5 + 0.45 * min(len(found.inputs), _MOST)))


def draw_tornado(axes: "Axes", key: str, found: Interval, inputs: list[str]) -> None:
    """Draw the bars of the ``inputs`` for the quantity ``key`` on ``axes``."""
    unit = found.value if key == "a" else 1.0
    value = found.value / unit
    if found.low is not None and found.high is not None:
        axes.axvspan(found.low / unit, found.high / unit, color="0.9", lw=0, label=f"{COVERAGE:.0%} interval")
    for end, (label, fill) in enumerate((("lower end", "white"), ("upper end", "0.5"))):
        ends = [found.ends[each][end] for each in inputs]
        known = {row: each / unit - value for row, each in enumerate(ends) if each is not None}
        axes.barh([*known], [*known.values()], 0.5, left=value, color=fill, edgecolor="black", lw=0.8, label=label)
    axes.axvline(value, color="black", lw=1)
    axes.set(xlabel=f"{key}/a" if key != "a" else "a, in that of the scene as given")
    for row, each in enumerate(inputs):
        axes.text(1.02, row, f"{found.shares[each]:.0%}", transform=axes.get_yaxis_transform(), va="center", fontsize=9)
        if None in found.ends[each]:
            side = "lower" if found.ends[each][0] is None else "upper"
            axes.text(0.02, row, f"{side} end: none", transform=axes.get_yaxis_transform(), va="center", fontsize=9)
