"""Where the time goes on one mesh of 10,000, 100,000 and 500,000 unknowns: python benchmarks/phases.py [--repeats 3]

Meshes of ``hertz-large-tension`` by P4, graded to the ends of the zones and growing at different rates beyond; CHOLMOD.
Beside the phases, as a floor, what CHOLMOD takes for the numbers alone of one factor of that stiffness, in the order
that it likes best itself, with no compliance asked for.
"""

import argparse
from statistics import median

import cvxopt
import numpy as np
from cvxopt import cholmod
from scipy import sparse

from partialslip import load_scene, plan
from partialslip.condensed.threads import one_thread
from partialslip.result import Clock
from partialslip_fem.elasticity import body
from partialslip_fem.problem import scaled
from partialslip_fem.solving import solve_on_meshes
from partialslip_meshes import block

WIDTH, SIZE = 16.0, 1e-5
GROWTHS = {10_000: 1.0, 100_000: 0.21, 500_000: 0.088}
PHASES = ("mesh", "assembly", "far field", "factorisation", "condensation", "contact")


@one_thread
def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--repeats", type=int, default=3)
    chosen = options.parse_args()

    scene = load_scene("hertz-large-tension", ["fem.factor='cholmod'"])
    problem = scaled(scene, plan(scene))
    a, (part,) = np.sqrt(2 / np.pi), problem.parts
    ends = {a * end: a * SIZE for end in (-1, -0.803853, 0.294929, 1)}
    print("unknowns", "nodes", *PHASES, "sum", "floor", sep=" | ")
    for growth in GROWTHS.values():
        spent, floors = [], []
        for _ in range(chosen.repeats):
            clock = Clock()
            with clock.phase("mesh"):
                mesh = block(WIDTH * a, (-1.1 * a, 1.1 * a), ends, growth)
            solution = solve_on_meshes([mesh], problem, WIDTH * a, clock)
            spent.append(clock.phases)
            half = body(mesh, part.kappa, problem.order)
            floors.append(numbers_alone(half.stiffness, half.held.ravel()))
        times = [median(phases[name] for phases in spent) for name in PHASES]
        shown = [f"{value:.2f}" for value in (*times, sum(times), median(floors))]
        print(f"{half.stiffness.shape[0]:,}", len(solution.bodies[0].body.x), *shown, sep=" | ", flush=True)


def numbers_alone(stiffness: sparse.csr_matrix, held: np.ndarray) -> float:
    """CPU seconds of the numeric factorisation."""
    free = np.setdiff1d(np.arange(stiffness.shape[0]), held)
    lower = sparse.tril(stiffness[free][:, free], format="coo")
    matrix = cvxopt.spmatrix(lower.data, lower.row.astype(np.int64), lower.col.astype(np.int64), lower.shape)
    factored, clock = cholmod.symbolic(matrix), Clock()
    with clock.phase("numbers"):
        cholmod.numeric(matrix, factored)
    return clock.phases["numbers"]


if __name__ == "__main__":
    main()
