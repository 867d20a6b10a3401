"""Make the table of Hertz's stick zones under gradual loads: src/partialslip/halfplane/gradual_table.json.

    nice python benchmarks/gradual_table.py            make it anew (about 18 CPU minutes); then run inner_table.py
    nice python benchmarks/gradual_table.py --check 300 --seed 1    its error at random loads

The table is made of patches over s_f = dsigma/(f p0) and w = sqrt(1 - Q_f), each between two border curves w(s_f). In a
patch the ends of the stick zone are smooth, up to the borders; at a border they have a kink. The borders, from small
Q_f on, are those at which

- slip begins to turn round: the half-width of the zone of one step is c* = 4 Q_f/s_f;
- the zone just reaches the left end of the contact at the end of the half cycle;
- all that slipped backwards slips forwards again, so that one step holds again (in closed form), or Q_f = 0.9975, or an
  inner slip zone begins: n = -c* or, where points at the left end slip at once, n = (1 - m)/2 - c*. Beyond the
  beginning of an inner zone ``inner_table.py`` makes the patches.
"""

import argparse
import functools
import itertools
import json
import math
import time
from collections import deque
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from scipy.optimize import brentq

from partialslip.halfplane.gradual_path.half_cycle import HalfCycle, LostError, steady
from partialslip.halfplane.gradual_path.stage import Loads
from partialslip.halfplane.gradual_table import PLACE, tabled
from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.steady import steady_stick_zone, stick_zones
from partialslip.scene.gradual import turns_round
from partialslip.tools.arrays import Array

HERTZ = HertzShape()
CYCLES, STEADY = 8, 1e-8  # half cycles from a neighbour, and the last change: changes fall faster than tenfold
ALONG, ACROSS = 9, (8, 14)  # nodes along s_f, and across a patch: as many as it takes
SETTLED = 1e-7  # last coefficients of a patch that has enough nodes
MARGIN, POINTS, HALVINGS = 3e-3, 5, 5  # of a search for a border: it ends with an extrapolation from one side
CLOSE = 1e-2  # of a corner
ROUNDED = 13  # decimals
NARROWEST = 0.05  # w: for large tension the table ends here, at Q_f = 0.9975


class Found(NamedTuple):
    """Ends of the zone, by how much the first rate spares points inside (less than 0: an inner zone slips), and lambda
    at the end of the drift."""

    left: float
    right: float
    spared: float
    drifted: float
    reaches_end: bool


near: deque[HalfCycle] = deque(maxlen=1)


def following(loads: Loads) -> HalfCycle | None:
    """The steady half cycle from the one found before, at similar loads; None if that does not lead to it."""
    if not near:
        return None
    cycle, change = near[0], math.inf
    for _ in range(CYCLES):
        try:
            cycle, before = HalfCycle(loads, -cycle.settled, cycle, parts=False), cycle
        except (LostError, ValueError, ArithmeticError):
            return None
        change = max(abs(one - other) for one, other in zip(cycle.last.zone, before.last.zone, strict=True))
        if change < STEADY:
            return cycle
    return None


@functools.cache
def solved(s: float, w: float) -> Found | None:
    """The solver's zone, or None if it is not known or an inner zone slips."""
    loads = Loads(s, math.pi * (1 - w) * (1 + w))
    try:
        cycle = following(loads) or steady(loads, HERTZ, parts=False)
    except LostError:
        return None
    near.append(cycle)
    if cycle.opens:
        return None
    drift = next(phase for phase in cycle.phases if hasattr(phase, "reaches_end"))
    spared = cycle.last.zone.right + cycle.loads.least - cycle.phases[0].first.zone.centre
    return Found(*cycle.last.zone, spared, drift.last.progress, drift.reaches_end)


def least(s: float, w: float) -> float:
    """c*."""
    return 4 * (1 - w) * (1 + w) / s


def turning(s: float) -> float:
    """w at which slip begins to turn round, below the place at which large tension begins."""

    def off(w: float) -> float:
        return steady_stick_zone((1 - w) * (1 + w), s, HERTZ).half_width - least(s, w)

    start = max(1 - s / 8, 0.0)
    grid = (start + (1 - start) * np.geomspace(s / 1e3, 1, 200)[:-1]).tolist()
    bracket = next(pair for pair in itertools.pairwise(grid) if off(pair[0]) < 0 <= off(pair[1]))
    return float(brentq(off, *bracket, xtol=1e-15))


def holding_again(s: float) -> float:
    """w at which one step holds again, 1 - m = 2 (1 - c*): the root of (8/s) w^2 + w + 1 + s/8 - 8/s."""
    return (math.sqrt(1 - 32 / s * (1 + s / 8 - 8 / s)) - 1) * s / 16


def border(inside: Callable[[float], float | None], good: float, bad: float) -> float:
    """Place between ``good``, beyond which it is known, and ``bad`` at which the smooth ``inside``, None beyond it,
    vanishes: by halving, then by extrapolation from the side on which it is known."""
    first, width, known, halvings = good, good - bad, False, 0
    while not known or halvings < HALVINGS:
        middle = (good + bad) / 2
        known |= (here := inside(middle) is not None)
        good, bad = (middle, bad) if here else (good, middle)
        halvings += 1
    step = math.copysign(min(MARGIN * abs(width), abs(first - good) / POINTS), width)
    places = good + step * np.arange(POINTS)
    values = [inside(place) for place in places.tolist()]
    return float(np.polyval(np.polyfit(values, places - good, POINTS - 1), 0.0)) + good


def reaching(s: float, low: float, high: float) -> float:
    """w at which the zone reaches the left end of the contact at the end of the half cycle."""

    def inside(w: float) -> float | None:
        found = solved(s, w)
        return 1 - found.drifted if found and found.reaches_end else None

    return border(inside, low, high)


def parting(s: float, high: float) -> float:
    """w at which an inner slip zone begins."""

    def inside(w: float) -> float | None:
        found = solved(s, w)
        return found.spared if found and found.spared > 0 else None

    return border(inside, high, NARROWEST - 1e-2)


def nodes(count: int, low: float, high: float) -> Array:
    """Chebyshev nodes."""
    result: Array = low + (high - low) * (1 - np.cos(np.pi * (np.arange(count) + 0.5) / count)) / 2
    return result


def fitted(values: Array) -> Array:
    """Chebyshev coefficients of values at nodes, along the first axis."""
    count = len(values)
    flat = chebyshev.chebfit(nodes(count, -1, 1), values.reshape(count, -1), count - 1)
    return flat.reshape(values.shape)


def panel(low: float, high: float, borders: Callable[[float], list[float]]) -> dict[str, Any]:
    """Patches between the ``borders`` of s, from large to small w."""
    along = nodes(ALONG, low, high)
    curves = np.array([borders(s) for s in along.tolist()])
    patches = []
    for upper, lower in itertools.pairwise(curves.T):
        for across in ACROSS:
            at = upper[:, None] + nodes(across, 0, 1) * (lower - upper)[:, None]
            ends = np.array(
                [[solved(s, w)[:2] for w in row] for s, row in zip(along.tolist(), at.tolist(), strict=True)]
            )
            patch = np.swapaxes(fitted(np.swapaxes(fitted(ends), 0, 1)), 0, 1)
            if np.abs(patch[:, -1]).max() < SETTLED:
                break
        patches.append(patch)
        print(f"s_f {low:.3f} to {high:.3f}: {across} nodes across, last coefficients {np.abs(patch[-1]).max():.1e} "
              f"{np.abs(patch[:, -1]).max():.1e}, {time.process_time():.0f} s", flush=True)  # fmt: skip
    return {
        "low": low,
        "high": high,
        "borders": fitted(curves).T.round(ROUNDED).tolist(),
        "patches": [patch.transpose(2, 0, 1).round(ROUNDED).tolist() for patch in patches],
        "signs": [-1, 1][: len(patches)],
    }


def make() -> None:
    """Write the table."""

    def again_ends(s: float) -> list[float]:
        high, low = turning(s), holding_again(s)
        return [high, reaching(s, low + (high - low) / 2, high), low]

    def up_to_sliding(s: float) -> list[float]:
        high = turning(s)
        return [high, reaching(s, 0.7 * high, high), NARROWEST]

    def up_to_inner(s: float) -> list[float]:
        high = turning(s)
        low = parting(s, high)
        reached = reaching(s, low + 0.01 * (high - low), high)
        return [high, reached, low]

    def drifting(s: float) -> list[float]:
        high = turning(s)
        return [high, parting(s, high)]

    def room(s: float) -> float:
        found = solved(s, NARROWEST)
        return found.spared if found else -1.0

    def together(s: float) -> float:
        """1 if the zone reaches the left end of the contact before an inner zone begins."""
        found = solved(s, parting(s, turning(s)) + 2e-3)
        return 1.0 if found and found.reaches_end else -1.0

    def at_turning(s: float) -> float:
        zone = steady_stick_zone((1 - turning(s)) * (1 + turning(s)), s, HERTZ)
        return zone.centre + zone.half_width + least(s, turning(s))

    s_again = float(brentq(lambda s: holding_again(s) - NARROWEST, 4.5, 4.95))
    s_one, _ = ends_at(room, 5.0, 6.0)
    s_both, s_after = ends_at(together, 7.5, 9.0)
    s_top = float(brentq(at_turning, 9.0, 11.0))
    print(f"corners: {s_again} {s_one} {s_both} {s_after} {s_top}", flush=True)
    middle, panels = (s_one + s_both) / 2, []
    for low, high, borders in (
        (s_after, s_top, drifting),
        (s_one, middle, up_to_inner),
        (middle, s_both, up_to_inner),
        (s_again, s_one, up_to_sliding),
        (4.0, s_again, again_ends),
        (2.0, 4.0, again_ends),
        (0.0, 2.0, again_ends),
    ):
        panels.append(panel(low, high, borders) | {"parting": borders in (drifting, up_to_inner)})
        write(panels)
    top, below = panels[0], panels[2]
    meeting = corner(below)
    panels[0], panels[2] = stretched(top, meeting, top["high"]), stretched(below, below["low"], meeting)
    write(panels)


def write(panels: list[dict[str, Any]]) -> None:
    """Write the table."""
    PLACE.write_text(json.dumps({"panels": panels}, separators=(",", ":")) + "\n")


def corner(panel: dict[str, Any]) -> float:
    """s_f, beside the upper end of a ``panel``, at which the zone reaches the left end of the contact just where an
    inner zone begins."""

    def apart(s: float) -> float:
        along = 2 * (s - panel["low"]) / (panel["high"] - panel["low"]) - 1
        _, reached, parted = chebyshev.chebval(along, np.array(panel["borders"]).T)
        return float(reached - parted)

    return float(brentq(apart, panel["high"] - 0.1, panel["high"] + 0.05))


def stretched(panel: dict[str, Any], low: float, high: float) -> dict[str, Any]:
    """The same series over another range of s, a little longer or shorter."""
    s = nodes(ALONG, low, high)
    along = 2 * (s - panel["low"]) / (panel["high"] - panel["low"]) - 1

    def moved(series: Any) -> Any:
        return fitted(np.moveaxis(chebyshev.chebval(along, np.array(series)), -1, 0)).round(ROUNDED).tolist()

    return {
        **panel,
        "low": low,
        "high": high,
        "borders": [moved(border) for border in panel["borders"]],
        "patches": [[moved(end) for end in patch] for patch in panel["patches"]],
    }


def ends_at(positive: Callable[[float], float], low: float, high: float) -> tuple[float, float]:
    """Values of s close together between which ``positive`` is so no more."""
    while high - low > CLOSE:
        middle = (low + high) / 2
        low, high = (middle, high) if positive(middle) > 0 else (low, middle)
    return low, high


def check(count: int, seed: int) -> None:
    """Print errors at ``count`` random loads of the table."""
    random, off, worst = np.random.default_rng(seed), [], (0.0, 0.0, 0.0)
    while len(off) < count:
        Qf, sf = float(random.random()), 10.5 * float(random.random())
        once = stick_zones(np.array([Qf]), np.array([sf]), HERTZ)
        if not turns_round(Qf, sf, once.s[0], once.centre[0], once.half_width[0]):
            continue
        zone, found = tabled(np.array([Qf]), np.array([sf])), solved(sf, math.sqrt(1 - Qf))
        if found is None or np.isnan(zone.centre[0]):
            continue
        error = max(abs(zone.left[0] - found.left), abs(zone.right[0] - found.right))
        off.append(error)
        worst = max(worst, (error, Qf, sf))
    print(f"{count} loads, seed {seed}: median {np.median(off):.1e}, largest {worst[0]:.1e} at {worst[1:]}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", type=int, metavar="COUNT", help="check the table at so many random loads")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    check(arguments.check, arguments.seed) if arguments.check else make()
