"""Cases per CPU second on one mesh under many loads, the factor kept or made again: python benchmarks/reuse.py"""

import numpy as np

from partialslip import load_scene, run
from partialslip_fem import Kept

SCENES = {
    "half-planes": ("hertz-small-tension", []),
    "blocks, 32 a": (
        "hertz-small-tension",
        ["bodies.upper={width=32e-3, height=32e-3}", "bodies.lower={width=32e-3, height=32e-3}"],
    ),
}
CASES, SIZE = 40, 0.01


def main() -> None:
    for name, (scene, bodies) in SCENES.items():
        fixed = load_scene(scene, bodies)
        shares = np.linspace(0.1, 1.0, CASES)
        scenes = [
            load_scene(scene, [*bodies, f"fem.size={SIZE}", f"load.Q={[share * Q for Q in fixed.load.Q]}"])
            for share in shares.tolist()
        ]
        rates = {}
        for kept in (True, False):
            keep = Kept() if kept else None
            run(scenes[0], ["fem"], keep=keep)
            costs = [run(each, ["fem"], keep=keep).results["fem"].cost.cpu_s for each in scenes]
            rates[kept] = CASES / sum(costs)
        ratio = rates[True] / rates[False]
        print(f"{name}: {rates[True]:.1f} cases a CPU s, factored again {rates[False]:.1f}: {ratio:.1f}")


if __name__ == "__main__":
    main()
