"""CPU seconds of fatigue criteria at many points: python benchmarks/fatigue.py [--points 100000] [--load-points 2]"""

import argparse
import time

import numpy as np

from partialslip.study.fatigue import (
    crossland,
    dang_van,
    fatemi_socie,
    findley,
    principal_range,
    smith_watson_topper,
    with_zz,
)
from partialslip.study.fatigue.planes import ANGLES, TILTS

E, NU = 72.1e9, 0.33
CRITERIA = {
    "principal": principal_range,
    "swt": lambda stress: smith_watson_topper(stress, E, NU),
    "fatemi-socie": lambda stress: fatemi_socie(stress, E, NU, 1.0, 330e6),
    "findley": lambda stress: findley(stress, 0.3),
    "dang-van": lambda stress: dang_van(stress, 0.3),
    "crossland": lambda stress: crossland(stress, 0.3),
}


def main() -> None:
    """Print the least CPU seconds of three calls of each criterion."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--points", type=int, default=100_000)
    parser.add_argument("--load-points", type=int, default=2)
    options = parser.parse_args()
    random = np.random.default_rng(0)
    stress = with_zz(1e8 * random.normal(size=(options.load_points, 3, options.points)), NU)
    print(f"{options.points:,} points, {options.load_points} load points, {ANGLES * TILTS} sampled planes")
    for name, criterion in CRITERIA.items():
        times = []
        for _ in range(3):
            start = time.process_time()
            criterion(stress)
            times.append(time.process_time() - start)
        print(f"{name:14} {min(times):.2f} CPU s")


if __name__ == "__main__":
    main()
