"""Exact steady states under random gradual loads where slip turns round: certificates and CPU time.

python benchmarks/turning_slip.py [--points 60] [--seed 1]
"""

import argparse
import math
import time

import numpy as np

from partialslip.halfplane.gradual_path.certificate import certificate
from partialslip.halfplane.gradual_path.half_cycle import steady
from partialslip.halfplane.gradual_path.phases import Drifting
from partialslip.halfplane.gradual_path.stage import Loads, LostError
from partialslip.halfplane.hertz import Hertz
from partialslip.halfplane.loading import half_cycle
from partialslip.halfplane.punch import Punch

KINDS = "plain", "far", "inner", "refused"


def random_loads(random, shape):
    """Q_f and s_f under which slip turns round."""
    while True:
        Qf, sf = random.uniform(0.02, 0.99), random.uniform(0.1, 20)
        if not half_cycle(Qf, sf, shape).holds:
            return Qf, sf


def solved(Qf, sf, shape):
    """Kind of the steady state, CPU seconds, and the largest violation of a condition, in f p0."""
    start = time.process_time()
    try:
        found = steady(Loads(sf, math.pi * Qf), shape)
    except LostError:
        return "refused", time.process_time() - start, math.nan
    seconds = time.process_time() - start
    travel = max((phase.travel for phase in found.phases if isinstance(phase, Drifting)), default=0.0)
    kind = "inner" if found.parted else "far" if travel > 1 else "plain"
    return kind, seconds, certificate(found).worst


def main(points, seed):
    random, found = np.random.default_rng([37, seed]), []
    for number in range(points):
        shape = Punch(random.uniform(0.1, 0.9)) if number % 3 == 2 else Hertz()
        Qf, sf = random_loads(random, shape)
        found.append(solved(Qf, sf, shape))
        kind, seconds, worst = found[-1]
        name = f"flat {shape.flats[0]:.3f}" if isinstance(shape, Punch) else "Hertz"
        print(f"{name:10} Q_f {Qf:.17g} s_f {sf:.17g}: {kind:8} {worst:.1e} f p0, {seconds:.2f} s", flush=True)
    for kind in KINDS:
        seconds, worst = np.array([each[1:] for each in found if each[0] == kind]).reshape(-1, 2).T
        if len(seconds):
            print(
                f"{kind:8} {len(seconds):4}: certificate median {np.median(worst):.1e}, worst {worst.max():.1e} f p0;"
            )
            print(f"{'':14} CPU median {np.median(seconds):.3f}, worst {seconds.max():.2f} s")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--points", type=int, default=60, metavar="N")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    main(arguments.points, arguments.seed)
