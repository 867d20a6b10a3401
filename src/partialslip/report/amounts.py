"""Values that the methods of a run found, with units such as mm and MPa."""

import math
from collections.abc import Callable, Mapping

import numpy as np

from partialslip.result import Result
from partialslip.units import PREFIXES, SI, Dimension, Units

_DIGITS = 7  # significant

_Value = Callable[[Result], float | None]
_LENGTHS: Mapping[str, _Value] = {
    "a, half-width": lambda found: found.a,
    "m, stick from -m": lambda found: found.m,
    "n, stick to n": lambda found: found.n,
}
_OTHERS: Mapping[str, tuple[Dimension, _Value]] = {
    "p, largest": ("Pa", lambda found: found.traction.p_max),
    "q = (q2 - q1)/2, largest": ("Pa", lambda found: float(np.abs(found.traction.dq).max()) / 2),
    "slip, largest each way": ("m", lambda found: float(np.abs(found.slip.slip).max()) if found.slip else None),
    "dissipated in a cycle": ("J/m", lambda found: found.slip.dissipated if found.slip else None),
}


def amounts(results: Mapping[str, Result], units: Units = SI) -> tuple[list[str], list[list[str]]]:
    """Return headings and rows of quantity, unit and the value of each method.

    All methods share a row's unit, that of ``units``; in SI with a prefix. a, m and n share one unit, in SI mm from
    1e-6 m to 1 m.
    """
    found = list(results.values())
    largest = max(result.a for result in found)
    lengths = (-3, "mm") if 1e-6 <= largest < 1 else scale(largest, "m", units)
    rows = [_row(quantity, lengths, [value(result) for result in found]) for quantity, value in _LENGTHS.items()]
    for quantity, (of, value) in _OTHERS.items():
        values = [value(result) for result in found]
        largest = max((abs(each) for each in values if each is not None and math.isfinite(each)), default=0.0)
        if largest:
            rows.append(_row(quantity, scale(largest, of, units), values))
    return ["quantity", "unit", *results], rows


def scale(size: float, of: Dimension, units: Units) -> tuple[int, str]:
    """Return the exponent of ten, and the label of the unit, for values up to ``size`` (SI) of dimension ``of``; in SI
    with a prefix."""
    label, power = units.units[of]
    if units != SI:
        return power, label
    return next(((exp, prefix + label) for exp, prefix in PREFIXES if 1 <= size / 10.0**exp < 1000), (0, label))


def _row(quantity: str, unit: tuple[int, str], values: list[float | None]) -> list[str]:
    return [quantity, unit[1], *(_digits(value, unit[0]) for value in values)]


def _digits(value: float | None, exponent: int) -> str:
    return "none" if value is None else f"{value / 10.0**exponent:.{_DIGITS}g}"
