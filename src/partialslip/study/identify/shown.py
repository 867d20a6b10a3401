"""What was identified as a table, files and a figure."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from partialslip.report.answer import scale
from partialslip.scene.units import SI, Units
from partialslip.study.identify.fit import Identified
from partialslip.study.identify.interval import Interval
from partialslip.tools.output.files import csv_text
from partialslip.tools.output.svg import svg

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SCHEMA = "partialslip/identify/1"
HEADINGS = ("quantity", "value", "95 % interval", "from")
WORDS = (1, 2, 3)  # display: columns of words
_SIZE = 6.4, 3.2  # display: inches
_DOTS = 400  # display: most rows that are drawn
_TICKS = 4  # display: most intervals of an axis


def interval_row(name: str, of: Interval, source: str, unit: float = 1.0, label: str = "") -> tuple[str, ...]:
    """A row of the table: digits as the interval deserves them; ``of`` in ``unit``, whose ``label`` follows."""
    value, low, high = (each / unit for each in (of.value, of.low, of.high))
    wide = min((abs(end - value) for end in (low, high) if np.isfinite(end) and np.isfinite(value)), default=0)
    size = value if np.isfinite(value) else low
    digits = 3 if not wide else int(np.clip(np.ceil(np.log10(size / wide)) + 1, 2, 7))
    value_text, low_text, high_text = (
        f"{each:#.{digits}g}".rstrip(".") + f" {label}" * bool(label) for each in (value, low, high)
    )
    if of.one_sided:
        return name, "not told", f"at least {low_text}", source
    return name, value_text, "not known" if np.isnan(low) else f"{low_text} to {high_text}", source


def loop_rows(found: Identified, units: Units, stiffness: bool) -> list[tuple[str, ...]]:
    """Rows of the table of a loop; with the ``stiffness`` if it is asked for."""
    rows = [interval_row("f", found.f, f"{len(found.fitted)} rows, or means of rows")]
    if stiffness:
        power, label = scale(found.stiffness.value, "Pa", units)
        rows.append(interval_row("stiffness", found.stiffness, "all in series, per depth", 10.0**power, label))
    length, moved = units.text(found.scatter, "m", 2), units.text(found.opening, "m", 3)
    return [
        *rows,
        ("work of Q in a cycle", units.text(found.area, "J/m", 3), "", "area of the loop"),
        ("width of the loop", moved, "", f"rows scatter by {length}"),
    ]


def record(of: Interval, source: str, remarks: Sequence[str], found: Identified | None = None) -> dict[str, Any]:
    """Content of identify.json, SI units; no upper end is null."""
    data: dict[str, Any] = {"schema": SCHEMA, "level": 0.95, "source": source, "f": of, "remarks": list(remarks)}
    if found:
        names = "stiffness", "area", "opening", "scatter", "turns", "correlation", "P"
        data |= {name: getattr(found, name) for name in names}
    return data


def loop_csv(found: Identified, units: Units) -> str:
    """The rows that were fitted and the fitted displacement, as CSV in ``units``."""
    head = [units.heading("displacement", "m"), units.heading("Q", "N/m"), "time",
            units.heading("fitted", "m"), units.heading("drift", "m")]  # fmt: skip
    loop = found.loop
    moved, fitted, drift = (
        units.from_si(each, "m").tolist() for each in (loop.displacement, found.fitted, found.drift)
    )
    return csv_text(
        head, zip(moved, units.from_si(loop.Q, "N/m").tolist(), loop.time.tolist(), fitted, drift, strict=True)
    )


def loop_svg(found: Identified, units: Units) -> str:
    """The loop, measured and fitted, without drift: Q over displacement, and the same without Q over the stiffness. Q
    is from the middle of the loop, over f P where f is told."""
    of = found.f.value * found.P if np.isfinite(found.f.high) else 0.0
    middle = sum(found.turns) / 2
    power, force = (0, "") if of else scale(float(np.ptp(found.turns)), "N/m", units)
    unit = of or 10.0**power
    every = max(len(found.fitted) // _DOTS, 1)
    moved, Q = (found.loop.displacement - found.drift)[::every], found.loop.Q[::every]

    def draw(figure: "Figure") -> None:
        panels = figure.subplots(1, 2, sharey=True)
        for axes, stiffness, label in zip(
            panels, (np.inf, found.stiffness.value), ("displacement", "less Q/stiffness"), strict=True
        ):
            drawn = [
                (x - (Q - middle) / stiffness - found.curve[0].mean(), (Q - middle) / unit)
                for x, Q in ((moved, Q), found.curve)
            ]
            size, text = scale(float(np.abs(drawn[0][0]).max()), "m", SI)
            for (x, y), style in zip(
                drawn, ({"ls": "", "marker": "o", "ms": 2, "color": "0.6"}, {"lw": 1.2, "color": "black"}), strict=True
            ):
                axes.plot(x / 10.0**size, y, **style)
            axes.set(xlabel=f"{label}, {text}")
            axes.locator_params(axis="x", nbins=_TICKS)
        panels[0].set_ylabel("Q/(f P), from its middle" if of else f"Q from its middle, {force}")

    return svg(draw, _SIZE)
