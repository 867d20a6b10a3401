"""What leaving effects out saves: work and CPU of six scenes, from frictionless Hertz to all at once, in one run.

All on one element size along the contact. The lower body is a block in all of them, and has one and the same mesh but
for the contact half-width, which decides where it is fine.
"""

import argparse

from partialslip import load_scene, plan
from partialslip_fem import solve

LOWER = ("bodies.lower.width=30e-3", "bodies.lower.height=10e-3")
LIKE = (*LOWER, "bodies.upper.width=30e-3", "bodies.upper.height=10e-3")
UNLIKE = (*LOWER, "bodies.upper.width=20e-3", "bodies.upper.height=20e-3", "material.upper.E=400e9",
          "material.upper.nu=0.25")  # fmt: skip
MEAN = ("load.Q=[-5e4, 1e5]", "load.sigma=[0, 5e8]", "load.cycles=3")
SCENES = {
    "frictionless": (LIKE, "friction.f=0", "load.Q=[0, 0]"),
    "shear": (LIKE,),
    "shear and large tension": (LIKE, "load.sigma=[-1e9, 1e9]"),
    "mean loads": (LIKE, *MEAN),
    "unlike bodies": (UNLIKE, "load.Q=[-1e5, 1e5]"),
    "unlike bodies, mean loads, stresses inside": (UNLIKE, *MEAN),
}
COUNTS = ("dofs", "columns", "normal_unknowns", "tangential_unknowns", "factorizations", "normal_solves", "load_steps",
          "friction_iterations", "back_solves")  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", type=float, default=0.01, help="of elements, in contact half-widths")
    parser.add_argument("--repeats", type=int, default=3, help="the best CPU time of")
    chosen = parser.parse_args()
    print(f"| scene | {' | '.join(name.replace('_', ' ') for name in COUNTS)} | CPU s |")
    print("|---" * (len(COUNTS) + 2) + "|")
    cpu = []
    for name, (bodies, *settings) in SCENES.items():
        scene = load_scene("hertz-shear", [f"fem.size={chosen.size}", *bodies, *settings])
        effects, results = plan(scene, subsurface="inside" in name), []
        for _ in range(chosen.repeats + 1):  # the first one also imports
            results.append(solve(scene, effects))
        cpu.append(min(result.cost.cpu_s for result in results[1:]))
        counts = " | ".join(f"{results[-1].counts[key]:,}" for key in COUNTS)
        print(f"| {name} | {counts} | {cpu[-1]:.2f} |", flush=True)
    print(f"\ncheapest over fullest: {cpu[0] / cpu[-1]:.3f} (1/{cpu[-1] / cpu[0]:.1f})")


if __name__ == "__main__":
    main()
