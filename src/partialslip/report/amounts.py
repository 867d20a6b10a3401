"""Values that the methods of a run found, with units such as mm and MPa."""

import math
from collections.abc import Callable, Mapping

import numpy as np

from partialslip.result import Result

_PREFIXES = ((9, "G"), (6, "M"), (3, "k"), (0, ""), (-3, "m"), (-6, "µ"), (-9, "n"))
_DIGITS = 7  # significant

_Value = Callable[[Result], float | None]
_LENGTHS: Mapping[str, _Value] = {
    "a, half-width": lambda found: found.a,
    "m, stick from -m": lambda found: found.m,
    "n, stick to n": lambda found: found.n,
}
_OTHERS: Mapping[str, tuple[str, _Value]] = {
    "p, largest": ("Pa", lambda found: found.traction.p_max),
    "q = (q2 - q1)/2, largest": ("Pa", lambda found: float(np.abs(found.traction.dq).max()) / 2),
    "slip, largest each way": ("m", lambda found: float(np.abs(found.slip.slip).max()) if found.slip else None),
    "dissipated in a cycle": ("J/m", lambda found: found.slip.dissipated if found.slip else None),
}


def amounts(results: Mapping[str, Result]) -> tuple[list[str], list[list[str]]]:
    """Return headings and rows of quantity, unit and the value of each method.

    All methods share a row's unit. a, m and n share one unit, mm from 1e-6 m to 1 m.
    """
    found = list(results.values())
    largest = max(result.a for result in found)
    scale = (-3, "mm") if 1e-6 <= largest < 1 else si_scale(largest, "m")
    rows = [_row(quantity, scale, [value(result) for result in found]) for quantity, value in _LENGTHS.items()]
    for quantity, (unit, value) in _OTHERS.items():
        values = [value(result) for result in found]
        largest = max((abs(each) for each in values if each is not None and math.isfinite(each)), default=0.0)
        if largest:
            rows.append(_row(quantity, si_scale(largest, unit), values))
    return ["quantity", "unit", *results], rows


def si_scale(size: float, unit: str) -> tuple[int, str]:
    """Return the exponent of ten, and ``unit`` with the SI prefix for it, for values up to ``size``."""
    return next(((exp, prefix + unit) for exp, prefix in _PREFIXES if 1 <= size / 10.0**exp < 1000), (0, unit))


def _row(quantity: str, scale: tuple[int, str], values: list[float | None]) -> list[str]:
    return [quantity, scale[1], *(_digits(value, scale[0]) for value in values)]


def _digits(value: float | None, exponent: int) -> str:
    return "none" if value is None else f"{value / 10.0**exponent:.{_DIGITS}g}"
