"""Tractions of the problems as curves, from which norms of errors are measured without solving again.

Between neighbouring breaks (ends of contact and stick zone, kinks of the gap) a traction is a Chebyshev series in
t = 2 theta/pi - 1, x = (right + left - (right - left) cos theta)/2: square roots at the breaks are analytic in t.
"""

import itertools
from collections.abc import Mapping
from functools import cache
from importlib.resources import files

import msgspec
import numpy as np
from numpy.polynomial import chebyshev

from partialslip.result import Result, Traction, TractionAt
from partialslip.tools.arrays import Array

_FILE = "curves.json"
_DEGREE = 47  # accuracy: of the series; 1e-9 p0 of exact solutions, 1e-7 at kinks of the gap
_CUT = 1e-10  # accuracy: coefficients that are left out, in the largest


class Curve(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Pressure at load point 2 and dq of a problem: ``breaks`` (s + 1,), m, and coefficients ``p`` and ``dq``, Pa, of
    each of the s segments; ``error``, the largest difference from targets at places, in their scales, and from the
    tractions that it stands for, in their norms."""

    breaks: tuple[float, ...]
    p: tuple[tuple[float, ...], ...]
    dq: tuple[tuple[float, ...], ...]
    error: float = 0.0

    def at(self, x: Array) -> TractionAt:
        """p and dq at ``x`` (n,), m; zero outside the breaks."""
        ends = np.array(self.breaks)
        number = np.clip(np.searchsorted(ends, x) - 1, 0, len(ends) - 2)
        values = np.zeros((2, len(x)))
        for segment in np.unique(number):
            left, right = ends[segment : segment + 2]
            here = (number == segment) & (x >= left) & (x <= right)
            angle = np.arccos(np.clip((right + left - 2 * x[here]) / (right - left), -1, 1))
            for row, series in enumerate((self.p[segment], self.dq[segment])):
                values[row, here] = chebyshev.chebval(2 * angle / np.pi - 1, series)
        return TractionAt(*values)

    @property
    def traction(self) -> Traction:
        """The curve as the tractions of a result."""
        breaks = np.array(self.breaks)
        return Traction(breaks, self.at(breaks), self.at, breaks)


def curve_of(result: Result, steps: Array) -> Curve:
    """Curve of the tractions of ``result`` under a gap whose curvature has ``steps`` at these points, m."""
    of = result.traction
    ends = np.array([end for pair in result.ends for end in pair])
    zone = [] if result.m is None or result.n is None else [-result.m, result.n]
    many = of.cells is not None  # breaks are those of elements
    breaks = np.unique([*ends, *zone, *([] if many else of.breaks), *steps])
    breaks = breaks[(breaks >= ends.min()) & (breaks <= ends.max())]
    breaks = breaks[np.diff(breaks, prepend=-np.inf) > 1e-9 * result.a]
    segments: list[list[tuple[float, ...]]] = [[], []]
    t = chebyshev.chebpts1(_DEGREE + 1)
    series = chebyshev.chebvander(t, _DEGREE) * np.append(1.0, np.full(_DEGREE, 2.0)) / len(t)
    for left, right in itertools.pairwise(breaks.tolist()):
        x = (right + left - (right - left) * np.cos(np.pi / 2 * (t + 1))) / 2
        for row, values in zip(segments, of.at(x)[:2], strict=True):
            found = values @ series
            kept = np.flatnonzero(np.abs(found) > _CUT * max(np.abs(found).max(), result.p0 * 1e-3))
            row.append(tuple(float(f"{each:.11g}") for each in found[: kept[-1] + 1 if len(kept) else 1]))
    return Curve(tuple(breaks.tolist()), tuple(segments[0]), tuple(segments[1]))


@cache
def read_curves() -> Mapping[str, Curve]:
    """Curves by number of the problem."""
    path = files("partialslip.verify.benchmark") / _FILE
    return msgspec.json.decode(path.read_bytes(), type=dict[str, Curve])


def curves_text(curves: Mapping[str, Curve]) -> str:
    """Content of the file of ``curves``."""
    return msgspec.json.format(msgspec.json.encode(dict(sorted(curves.items()))), indent=0).decode() + "\n"
