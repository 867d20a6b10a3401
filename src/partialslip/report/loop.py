"""The loop of Q over the displacement of the plates that hold two finite bodies: figure, table and file."""

from typing import TYPE_CHECKING

import numpy as np

from partialslip.report.answer import dissipated, scale
from partialslip.result import Result
from partialslip.result.plates import Plates
from partialslip.run import Run
from partialslip.scene.units import Dimension
from partialslip.tools.output.files import csv_text
from partialslip.tools.output.svg import svg

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LENGTH: Dimension = "m"
_FORCE: Dimension = "N/m"
_SIZE = 5.2, 3.0  # display: inches
_TICKS = 3  # display: most intervals of an axis: numbers are long
_OPEN = 1e-6  # display: least area of a loop that is drawn, in that of the box around it
_ROUNDING = 1e-9  # accuracy: of the range of Q
_FEWEST = 8  # display: steps of a cycle whose loop is drawn: the area of fewer tells little
_ENOUGH = 16  # display: load steps between load points from which the area is not worth a remark


def _result_with_plates(run: Run) -> tuple[Result, Plates] | None:
    """Return the first result of ``run`` that knows the plates, and these; None if none does."""
    return next(((result, result.plates) for result in run.results.values() if result.plates), None)


def loop_csv(run: Run) -> str:
    """Return the loop as CSV, one row per point, in the scene's units, with the number of the load point where it is
    at one; empty if no method knows the plates."""
    known, units = _result_with_plates(run), run.scene.units
    if not known:
        return ""
    moved, Q = known[1].loop.T
    headings = [units.heading("displacement", _LENGTH), units.heading("Q", _FORCE), "load point"]
    columns = units.from_si(moved, _LENGTH).tolist(), units.from_si(Q, _FORCE).tolist(), _load_points(known[1])
    return csv_text(headings, zip(*columns, strict=True))


def _load_points(plates: Plates) -> list[int | str]:
    """Return the numbers of the load points, in the order of ``load.Q``, by point of the loop; empty between them, and
    everywhere if Q does not tell them: it is the same at successive load points."""
    Q, at_points = plates.loop[:, 1], plates.at_points
    rounding, row = _ROUNDING * np.ptp(at_points), 0
    numbers: list[int | str] = [len(at_points), *[""] * (len(Q) - 1)]
    for number, force in enumerate(at_points, start=1):
        there = np.flatnonzero(np.abs(Q[row + 1 :] - force) <= rounding)
        if abs(Q[row] - force) <= rounding or not len(there):
            return [""] * len(Q)
        row += 1 + int(there[0])
        numbers[row] = number
    return numbers


def loop_remark(run: Run) -> str:
    """Return what the loop of ``run`` leaves out, as text; empty if it is fine enough."""
    if not (known := _result_with_plates(run)):
        return ""
    result, plates = known
    steps = len(plates.loop) - 1
    if result.regime == "stuck":
        return "Nothing slips: Q over the displacement of the plates, in loop.csv, is a line."
    if not _open(plates):
        return (
            f"The loop of Q over the displacement of the plates, in loop.csv, has no area to speak of in the {steps} "
            f"steps of this cycle: load.steps of {_ENOUGH} or more gives it."
        )
    if steps >= 2 * _ENOUGH or run.scene.mirrored:  # mirror images are followed event by event
        return ""
    return f"The loop is straight between the {steps} steps of this cycle: load.steps of {_ENOUGH} or more rounds it."


def _open(plates: Plates) -> bool:
    """Return whether the loop of the ``plates`` has an area, and steps enough to tell it."""
    box = np.prod(np.ptp(plates.loop, axis=0))
    return len(plates.loop) > _FEWEST and bool(abs(plates.work) > _OPEN * box)


def loop_rows(run: Run) -> list[tuple[str, str]]:
    """Return pairs of quantity and value: how stiff the plates are, the work of Q and what friction consumes."""
    if not (known := _result_with_plates(run)):
        return []
    (result, plates), units = known, run.scene.units
    along, across = (units.text(each, "Pa", 5) for each in plates.stiffness)
    rows = [("stiffness, x and y", f"{along}, {across} per unit depth, while all sticks")]
    if _open(plates):
        rows.append(("work of Q in a cycle", units.text(plates.work, "J/m", 4)))
    if result.slip:
        exponent, label = scale(result.slip.dissipated, "J/m", units)
        rows.append(("dissipated in a cycle", dissipated(result.slip, exponent, label)))
    return rows


def loop_svg(run: Run) -> str:
    """Return the loop as SVG, in the units of the scene, and beside it the same without Q over the stiffness: what is
    left is wide enough to be seen, and has the same area. Empty if the loop has no area."""
    known, units = _result_with_plates(run), run.scene.units
    if not known or not _open(known[1]):
        return ""
    plates = known[1]
    moved, Q = plates.loop.T
    left = moved - (Q - Q[0]) / plates.stiffness[0]
    force, forces = scale(float(np.abs(Q).max()), _FORCE, units)

    def draw(figure: "Figure") -> None:
        panels = figure.subplots(1, 2, sharey=True)
        for axes, x, label in zip(panels, (moved, left), ("displacement", "less Q/stiffness"), strict=True):
            length, lengths = scale(float(np.abs(x).max()), _LENGTH, units)
            axes.plot(x / 10.0**length, Q / 10.0**force, color="black", lw=1.0, marker="o", ms=2.5, mfc="white")
            axes.axhline(0, color="0.7", lw=0.6, zorder=0)
            axes.set(xlabel=f"{label}, {lengths}")
            axes.locator_params(axis="x", nbins=_TICKS)
        panels[0].set_ylabel(f"Q, {forces}")

    return svg(draw, _SIZE)
