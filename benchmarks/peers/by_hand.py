"""Finite elements of partialslip on one mesh graded by hand: python benchmarks/peers/by_hand.py [SCENE ...].

The best meshes of GetFEM are graded to ends that an earlier run found, and the mesh itself is not in GetFEM's CPU
seconds. This script gives P4 the same start: one mesh graded to the exact ends, no refinement and no error estimate.
Prints unknowns, errors of m, n and q against the exact solution, and CPU seconds (medians of ``--repeats``) of the
mesh, and of the solution on it.
"""

import argparse
import time
from itertools import product
from statistics import median

from partialslip import load_scene, plan, run
from partialslip.run.judge import compare
from partialslip.tools.threads import one_thread
from partialslip_fem.method import solve_meshed
from partialslip_meshes import block

SCENES = ("hertz-large-tension", "hertz-small-tension")
WIDTH = 16.0  # half-width of the block, in a
REACH = 1.02  # of the contact line, in a
GROWTHS, SIZES = (0.8, 0.7, 0.6, 0.5), (1e-2, 3e-3, 1e-3)


@one_thread
def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("scenes", nargs="*", default=SCENES)
    options.add_argument("--repeats", type=int, default=5)
    chosen = options.parse_args()
    print("scene", "growth", "size / a", "unknowns", "m", "n", "q", "mesh, CPU s", "solution, CPU s", sep=" | ")
    for name in chosen.scenes:
        scene = load_scene(name)
        exact, effects = run(scene, ["exact"]).results["exact"], plan(scene)
        ends = (-exact.a, -exact.m, exact.n, exact.a)
        for growth, size in product(GROWTHS, SIZES):
            meshing, solving = [], []
            for _ in range(chosen.repeats):
                mesh = block(
                    WIDTH * exact.a, (-REACH * exact.a, REACH * exact.a), dict.fromkeys(ends, size * exact.a), growth
                )
                start = time.process_time()
                found = solve_meshed(scene, effects, [mesh])
                solving.append(time.process_time() - start)
                meshing.append(mesh.cpu_s)
            errors = compare(found, exact, scene, None).errors
            shown = [f"{errors[key]:.1e}" for key in ("m", "n", "q")]
            shown += [f"{median(meshing):.3f}", f"{median(solving):.3f}"]
            print(name, growth, f"{size:g}", found.counts["dofs"], *shown, sep=" | ", flush=True)


if __name__ == "__main__":
    main()
