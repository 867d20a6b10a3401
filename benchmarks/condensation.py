"""What a whole cycle costs in factorisations: python benchmarks/condensation.py [--growth 0.25] [--size 1e-5]."""

import argparse
import time

import numpy as np

from partialslip import load_scene, plan
from partialslip.result import Clock
from partialslip.tools.threads import one_thread
from partialslip_fem.condensation import Condensation
from partialslip_fem.contact import CondensedBody
from partialslip_fem.elasticity import body
from partialslip_fem.factor import factor
from partialslip_fem.farfield import half_plane
from partialslip_fem.mesh_solution import MeshSolution
from partialslip_fem.problem import scaled
from partialslip_fem.solving import solve_contact
from partialslip_meshes import block

WIDTH = 16.0
BACKENDS = ("superlu", "cholmod")


@one_thread
def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--growth", type=float, default=0.25, help="element size gained per distance")
    options.add_argument("--size", type=float, default=1e-5, help="element size at the ends of the zones, in a")
    options.add_argument("--repeats", type=int, default=3)
    chosen = options.parse_args()

    scene = load_scene("hertz-large-tension")
    problem = scaled(scene, plan(scene))
    a, (part,) = np.sqrt(2 / np.pi), problem.parts
    ends = {a * end: a * chosen.size for end in (-1, -0.803853, 0.294929, 1)}
    mesh = block(WIDTH * a, (-1.1 * a, 1.1 * a), ends, chosen.growth)
    assembly, half = _timed(lambda: body(mesh, part.kappa, 4))
    print(f"{half.unknowns:,} unknowns, {len(half.x)} nodes on the contact line; assembly {assembly:.2f} CPU s")
    contact, held = half.contact.ravel(), half.held.ravel()
    inner = np.setdiff1d(np.arange(half.stiffness.shape[0]), np.concatenate([contact, held]))

    for backend in BACKENDS:
        ratios = []
        for _ in range(chosen.repeats):
            once, _kept = _timed(lambda backend=backend: factor(half.stiffness, inner, contact, backend))
            del _kept

            def rest(backend: str = backend) -> MeshSolution:
                far = half_plane(half.held_points, half.x, WIDTH * a, part.kappa)
                whole = CondensedBody(mesh, half, Condensation(half, far, backend))
                return solve_contact(problem, (whole,), 1, Clock(), None)

            all_of_it, found = _timed(rest)
            ratios.append((all_of_it / once, once, all_of_it))
        ratio, once, all_of_it = sorted(ratios)[len(ratios) // 2]
        print(
            f"{backend}: ordering and one factorisation {once:.2f} CPU s, all after assembly {all_of_it:.2f} CPU s "
            f"({found.history.load_steps} load steps): ratio {ratio:.2f} (median of {chosen.repeats})"
        )


def _timed(function):
    start = time.process_time()
    result = function()
    return time.process_time() - start, result


if __name__ == "__main__":
    main()
