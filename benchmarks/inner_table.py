"""Add to the table of Hertz's stick zones under gradual loads (``gradual_table.py``) loads with an inner slip zone.

    nice python benchmarks/inner_table.py            make them anew (about two CPU minutes)
    nice python benchmarks/inner_table.py --check 30 --seed 1    their error at random loads

If all points that slipped inside slip again at the left before the zone begins to drift, the zone is what it would be
without the inner one. That holds up to a curve w(s_f), w = sqrt(1 - Q_f). The table has these loads from s_f = 5.7,
where the curve leaves Q_f = 0.9975, up to 9.2. The check takes the solver with the inner zone.
"""

import argparse
import math
from typing import Any

import numpy as np
from gradual_table import ALONG, HERTZ, NARROWEST, ROUNDED, fitted, nodes, write
from scipy.optimize import brentq

from partialslip.halfplane.gradual_path.half_cycle import HalfCycle, LostError, steady
from partialslip.halfplane.gradual_path.inner_rates import taken
from partialslip.halfplane.gradual_path.phases import Drifting
from partialslip.halfplane.gradual_path.stage import Loads
from partialslip.halfplane.gradual_table import parted, table, tabled

TOP = 9.2  # s_f
LOWEST = (5.6, 5.85)  # s_f, between which the curve leaves the last w
BORDER = 12  # nodes of the curve along s_f
START, SLOPE, STEP = 5.708, 0.0762, 0.01  # about where the curve is: s_f and slope; step of w in the search


def alone(s: float, w: float) -> HalfCycle:
    """The steady half cycle without an inner zone."""
    return steady(Loads(s, math.pi * (1 - w) * (1 + w)), HERTZ, parts=False)


def again(s: float, w: float) -> float:
    """How far right of the inner zone's right end, as it opens, the left end of the zone is when it begins to drift."""
    cycle = alone(s, w)
    c, stuck, low = cycle.loads.least, cycle.start.parts[0], cycle.start.parts[-1].low
    left = min(stuck.high, 1 - 2 * c) if stuck.smooth is None and stuck.factor < 0 else -1.0
    ends = np.array([left, low, low + 4 / 3 * ((left + 1) / 2 - c - low), 1.0])
    drift = next(phase for phase in cycle.phases if isinstance(phase, Drifting))
    return float(drift.first.zone.centre - c - taken(ends[:, None], c)[0])


def border(s: float) -> float:
    """w up to which all points that slipped inside slip again at the left."""
    low = high = NARROWEST + SLOPE * (s - START)
    while again(s, high) > 0:
        low, high = high, high + STEP
    while again(s, low) < 0:
        low, high = low - STEP, low
    return float(brentq(lambda w: again(s, w), low, high, xtol=1e-9))


def panel(low: float, high: float) -> dict[str, Any]:
    """The patch from the border to the last w."""
    curve = fitted(np.array([border(s) for s in nodes(BORDER, low, high).tolist()]))
    along = nodes(ALONG, low, high)
    upper = np.polynomial.chebyshev.chebval(nodes(ALONG, -1, 1), curve)
    places = upper[:, None] + nodes(ALONG, 0, 1) * (NARROWEST - upper)[:, None]
    ends = [[alone(s, w).last.zone for w in row] for s, row in zip(along.tolist(), places.tolist(), strict=True)]
    series = np.swapaxes(fitted(np.swapaxes(fitted(np.array(ends)), 0, 1)), 0, 1)
    print(f"s_f {low:.3f} to {high:.3f}: last coefficients {np.abs(series[-1]).max():.1e} "
          f"{np.abs(series[:, -1]).max():.1e}", flush=True)  # fmt: skip
    return {
        "inner": True,
        "low": low,
        "high": high,
        "borders": [curve.round(ROUNDED).tolist(), [NARROWEST]],
        "patches": [series.transpose(2, 0, 1).round(ROUNDED).tolist()],
        "signs": [1],
    }


def make() -> None:
    """Add the panels, below and above the corner of the other ones."""
    plain = [each for each in table()["panels"] if "inner" not in each]
    corner = max(each["low"] for each in plain)
    lowest = float(brentq(lambda s: again(s, NARROWEST), *LOWEST))
    write([*plain, panel(lowest, corner), panel(corner, TOP)])


def check(count: int, seed: int) -> None:
    """Print the table's share of random loads with an inner zone, and its errors at ``count`` of them."""
    random = np.random.default_rng(seed)
    Qf, sf = random.random(400 * count), TOP * random.random(400 * count)
    Qf, sf = (each[parted(Qf, sf)] for each in (Qf, sf))
    there = ~np.isnan(tabled(Qf, sf).left)
    print(f"the table has {there.mean():.1%} of {len(Qf)} loads with an inner zone")
    Qf, sf, off, lost = Qf[there][:count], sf[there][:count], list[float](), 0
    zones = tabled(Qf, sf)
    for Q, s, left, right in zip(Qf.tolist(), sf.tolist(), zones.left, zones.right, strict=True):
        try:
            found = steady(Loads(s, math.pi * Q), HERTZ)
        except LostError:
            lost += 1
        else:
            off.append(max(abs(left - found.last.zone.left), abs(right - found.last.zone.right)))
    print(f"{len(off)} loads, seed {seed}: median {np.median(off):.1e}, largest {max(off):.1e}; {lost} lost")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", type=int, metavar="COUNT", help="check the table at so many random loads")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    check(arguments.check, arguments.seed) if arguments.check else make()
