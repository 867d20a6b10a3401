"""Exact steady states under random gradual loads: certificates and CPU time, by what the stick zone does.

python benchmarks/turning_slip.py [--one-way 150] [--plain 70] [--far 20] [--inner 60] [--means 60] [--seed 1]

Every third profile is flat and rounded, the others are Hertz's. Loads are drawn until each group is full:

- one-way: slip does not turn round, and one step holds;
- plain: the zone drifts, by less than its width, and no zone inside slips;
- far: it drifts by more than its width;
- inner: it drifts by less, and a zone inside it slips as a half cycle begins.

A mean of Q changes nothing but what is locked in, up to its bound. So many of the first loads under which some points
never slip and slip turns round show this bound over the room that many stages of the way leave.
"""

import argparse
import math
import time
from dataclasses import dataclass

import numpy as np

from partialslip.halfplane.contact import Contact
from partialslip.halfplane.gradual_path.certificate import certificate_of, stages
from partialslip.halfplane.gradual_path.half_cycle import HalfCycle, once, steady
from partialslip.halfplane.gradual_path.phases import Drifting
from partialslip.halfplane.gradual_path.stage import Loads, LostError
from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.loading import one_step as single
from partialslip.halfplane.punch import Punch
from partialslip.halfplane.turning import half_cycle

KINDS = "one-way", "plain", "far", "inner"
GOAL = 1e-9  # f p0
SHARES = np.linspace(0, 1, 65)[1:] ** 2  # of a phase: stages that see the room


@dataclass
class Row:
    """A load, what the stick zone does under it, CPU seconds of the solver, and the largest violation of a condition
    (f p0); or why the solver gives one step."""

    kind: str
    seconds: float
    worst: float = math.nan
    why: str = ""
    mean: float = math.nan  # bound on the mean of Q over the room along the way


def kind_of(Qf, sf, shape):
    """What the stick zone does, as far as it is known without a zone inside."""
    if single(Qf, sf, shape).holds:
        return "one-way"
    try:
        found = steady(Loads(sf, math.pi * Qf), shape, parts=False)
    except LostError:
        return "plain"
    travel = max((phase.travel for phase in found.phases if isinstance(phase, Drifting)), default=0.0)
    return "far" if travel > 1 else "inner" if found.opens else "plain"


def solved(kind, Qf, sf, shape):
    """A row, and the way of the half cycle."""
    contact = Contact(1.0, math.pi / 2, shape)
    start = time.process_time()
    found = half_cycle(contact, 1.0, math.pi * Qf, sf)
    seconds = time.process_time() - start
    if kind == "one-way":
        way = HalfCycle(Loads(sf, math.pi * Qf), -once(Loads(sf, math.pi * Qf), shape), 0.0, parts=False)
    elif not found.holds:
        return Row(kind, seconds, why=reason(Qf, sf, shape)), None
    else:
        way = found.way
    return Row(kind, seconds, certificate_of(way).worst), found


def reason(Qf, sf, shape):
    """Why the way is not known."""
    try:
        return f"certificate {certificate_of(steady(Loads(sf, math.pi * Qf), shape)).worst:.1e}"
    except LostError as error:
        return str(error) or "lost"


def room(way):
    """Room for a mean of Q, in f P, from many stages of the ``way``: the largest \\|dq_t - dq/2\\| of each point."""
    low, high = way.stuck
    nodes, weights = np.polynomial.legendre.leggauss(200)
    x = low + (high - low) * (1 + nodes) / 2
    changes = [stage.q(x) - way.start(x) for stage in stages(way, SHARES)]
    largest = np.max([np.abs(change - changes[-1] / 2) for change in changes], axis=0)
    return float((high - low) / math.pi * (weights @ (way.start.shape.pressure(x) - largest)))


def main(quotas, means, seed):
    random, rows, number = np.random.default_rng([37, seed]), [], 0
    while any(quotas.values()):
        number += 1
        shape = Punch(random.uniform(0.1, 0.9)) if number % 3 == 2 else HertzShape()
        Qf, sf = random.uniform(0.02, 0.99), random.uniform(0.1, 20)
        kind = kind_of(Qf, sf, shape)
        if not quotas[kind]:
            continue
        quotas[kind] -= 1
        row, found = solved(kind, Qf, sf, shape)
        if found and kind != "one-way" and means and found.permanent:
            row.mean, means = found.mean_load_bound / room(found.way), means - 1
        rows.append(row)
        name = f"flat {shape.flats[0]:.17g}" if isinstance(shape, Punch) else "Hertz"
        if kind != "one-way" or not row.worst < GOAL:
            says = row.why or f"{row.worst:.1e} f p0"
            print(f"{name:10} Q_f {Qf:.17g} s_f {sf:.17g}: {kind:8} {says}, {row.seconds:.3f} s", flush=True)
    for kind in KINDS:
        group = [row for row in rows if row.kind == kind]
        known = [row for row in group if not row.why]
        if not known:
            continue
        worst, seconds = np.array([row.worst for row in known]), np.array([row.seconds for row in group])
        print(f"{kind:8} {len(group):4}: {len(group) - len(known)} given by one step; certificate median")
        print(f"{'':14} {np.median(worst):.1e}, worst {worst.max():.1e} f p0, {(worst > GOAL).sum()} above {GOAL:g};")
        print(f"{'':14} CPU median {np.median(seconds):.4f}, worst {seconds.max():.2f} s")
    ratios = np.array([row.mean for row in rows if row.mean == row.mean])
    least, most = ratios.min(initial=np.inf), ratios.max(initial=-np.inf)
    print(f"bound on the mean of Q over the room along the way, {len(ratios)} loads: {least:.6f} to {most:.6f}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, count in zip(KINDS, (150, 70, 20, 60), strict=True):
        parser.add_argument(f"--{name}", type=int, default=count, metavar="N")
    parser.add_argument("--means", type=int, default=60, metavar="N")
    parser.add_argument("--seed", type=int, default=1)
    arguments = vars(parser.parse_args())
    main({name: arguments[name.replace("-", "_")] for name in KINDS}, arguments["means"], arguments["seed"])
