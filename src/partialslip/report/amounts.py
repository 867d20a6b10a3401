"""Values that the methods of a run found, with units such as mm and MPa."""

import math
from collections.abc import Callable, Mapping

import numpy as np

from partialslip.result import Result

_PREFIXES = ((9, "G"), (6, "M"), (3, "k"), (0, ""), (-3, "m"), (-6, "µ"), (-9, "n"))
_DIGITS = 7  # significant

_Value = Callable[[Result], float | None]
_AMOUNTS: Mapping[str, tuple[str, _Value]] = {
    "a, half-width": ("m", lambda found: found.a),
    "m, stick from -m": ("m", lambda found: found.m),
    "n, stick to n": ("m", lambda found: found.n),
    "p, largest": ("Pa", lambda found: found.traction.p_max),
    "q = (q2 - q1)/2, largest": ("Pa", lambda found: float(np.abs(found.traction.dq).max()) / 2),
    "slip, largest each way": ("m", lambda found: float(np.abs(found.slip.slip).max()) if found.slip else None),
    "dissipated in a cycle": ("J/m", lambda found: found.slip.dissipated if found.slip else None),
}


def amounts(results: Mapping[str, Result]) -> tuple[list[str], list[list[str]]]:
    """Return headings and rows of quantity, unit and the value of each method; all methods share a row's unit."""
    rows = []
    for quantity, (unit, value) in _AMOUNTS.items():
        values = [value(result) for result in results.values()]
        known = [abs(each) for each in values if each is not None and math.isfinite(each)]
        if any(known):
            exponent, prefix = _prefix(max(known), unit)
            rows.append([quantity, prefix + unit, *(_digits(each, exponent) for each in values)])
    return ["quantity", "unit", *results], rows


def _prefix(size: float, unit: str) -> tuple[int, str]:
    """Return the exponent and the SI prefix for values up to ``size``: mm from 1e-6 m to 1 m."""
    if unit == "m" and 1e-6 <= size < 1:
        return -3, "m"
    suitable = (each for each in _PREFIXES if 1 <= size / 10.0 ** each[0] < 1000)
    return next(suitable, (0, ""))


def _digits(value: float | None, exponent: int) -> str:
    return "none" if value is None else f"{value / 10.0**exponent:.{_DIGITS}g}"
