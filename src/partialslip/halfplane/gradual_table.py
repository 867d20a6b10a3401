"""Table of Hertz's stick zones under gradual loads whose slip reverses (docs/theory.md, section 7), for many loads
at once. Scaled as in :mod:`partialslip.halfplane.shape`.

Patches over s_f and w = sqrt(1 - Q_f), between border curves w(s_f) at which the zone's ends have kinks; Chebyshev
series in s_f and in the share of the way from border to border. ``benchmarks/gradual_table.py`` makes the table from
the solver, ``benchmarks/inner_table.py`` the part of it in which an inner zone slips; both measure its error.
"""

import functools
import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.steady import stick_zones
from partialslip.result import StickZone
from partialslip.tools.arrays import Array, Mask

PLACE = Path(__file__).with_name("gradual_table.json")
_BESIDE = 1e-6  # accuracy: of a patch: a place as near to it is inside, as rounding may put it on the wrong side


def tabled(Qf: Array, sf: Array) -> StickZone[Array]:
    """Stick zones under gradual loads (k,) whose slip reverses, for Hertz; NaN where the table has none.

    m and n are within 1e-6 of the solver (``benchmarks/gradual_table.py --check``), also where an inner zone slips that
    makes no difference in the end (``benchmarks/inner_table.py --check``).
    """
    once = stick_zones(Qf, sf, HertzShape())
    left, right = np.full((2, len(Qf)), np.nan)
    sign = np.zeros(len(Qf), int)
    holds = again(Qf, sf, once)
    left[holds], right[holds], sign[holds] = once.left[holds], once.right[holds], 1
    w = np.sqrt(1 - Qf)
    for panel in table()["panels"]:
        here = np.flatnonzero(~holds & np.isnan(left) & (sf >= panel["low"]) & (sf <= panel["high"]))
        along = 2 * (sf[here] - panel["low"]) / (panel["high"] - panel["low"]) - 1
        borders = [chebyshev.chebval(along, border) for border in panel["borders"]]
        for upper, lower, patch, way in zip(borders, borders[1:], panel["patches"], panel["signs"], strict=False):
            share = (upper - w[here]) / (upper - lower)
            inside = (share >= -_BESIDE) & (share <= 1 + _BESIDE)
            across = np.clip(2 * share[inside] - 1, -1, 1)
            at = here[inside]
            left[at], right[at] = (chebyshev.chebval2d(along[inside], across, np.array(end)) for end in patch)
            sign[at] = way
    return StickZone((left + right) / 2, (right - left) / 2, sign)


def parted(Qf: Array, sf: Array) -> Mask:
    """Whether an inner zone slips at loads (k,), up to the largest s_f of the table: beyond the last border of panels
    that end there."""
    result, w = np.zeros(len(Qf), bool), np.sqrt(1 - Qf)
    for panel in table()["panels"]:
        if panel.get("parting"):
            here = (sf >= panel["low"]) & (sf <= panel["high"])
            along = 2 * (sf[here] - panel["low"]) / (panel["high"] - panel["low"]) - 1
            result[here] |= w[here] < chebyshev.chebval(along, panel["borders"][-1])
    return result


def again(Qf: Array, sf: Array, once: StickZone[Array]) -> Mask:
    """Whether one step has the zone of gradual loads, although slip reverses: the ends slip the same way at last,
    and all points that slipped the other way before slip again. Then the left end of the zone has come as far as
    1 - 2 c*, where it is when the zone begins to drift."""
    return (once.s > 0) & (sf * (1 - once.left) <= 8 * Qf)


@functools.cache
def table() -> dict[str, Any]:
    """The table, as its file has it."""
    return json.loads(PLACE.read_text())
