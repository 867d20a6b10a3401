"""Other codes on the same scenes, over a ladder of meshes: ladder.py calculix|getfem|kratos [SCENE ...].

The adapters of the benchmark (partialslip.verify.benchmark.codes) solve. Appends a line of JSON for every run to --out:
scene, method, setting, element_size (in a; at the ends of the zones, where the mesh is graded to them), dofs, errors of
a, m, n, p and q against the exact solution, CPU and wall seconds of the processes, peak memory. Graded meshes are
refined at the ends that the code's own run before gave; here the cost of that run counts. What is there is not
run again.
"""

import argparse
import json
import time
from pathlib import Path

from partialslip import load_scene, run
from partialslip.run.judge import compare
from partialslip.verify.benchmark.codes.calculix import Calculix
from partialslip.verify.benchmark.codes.getfem import GetFEM
from partialslip.verify.benchmark.codes.kratos import Kratos

SCENES = ("hertz-small-tension", "hertz-large-tension")
SIZES = (0.1, 0.05, 0.025, 0.0125)
LADDERS = {
    "calculix": [
        *(("C3D8, mortar", size, Calculix(size, False)) for size in SIZES),
        ("C3D8, surface-to-surface penalty", 0.025, Calculix(0.025, True)),
    ],
    "getfem": [
        *(("Q1/P1", size, GetFEM(size, order=1)) for size in (*SIZES, 0.00625)),
        *(("Q2/P1", size, GetFEM(size)) for size in (*SIZES, 0.00625)),
        *(("Q2/P1, graded to the ends", fine, GetFEM(0.1, fine)) for fine in (0.01, 0.003, 0.001, 0.0003)),
    ],
    "kratos": [*(("Q1, mortar", size, Kratos(size, round(0.8 / size))) for size in (0.2, 0.1, 0.05))],
}


def main():
    options = argparse.ArgumentParser(description=__doc__.partition(":")[0])
    options.add_argument("code", choices=LADDERS)
    options.add_argument("scenes", nargs="*", default=SCENES)
    options.add_argument("--out", type=Path, default=Path(__file__).parent / "measured.jsonl")
    chosen = options.parse_args()
    lines = chosen.out.read_text().splitlines() if chosen.out.exists() else []
    done = {(line["scene"], line["setting"], line["element_size"]) for line in map(json.loads, lines)}
    for name in chosen.scenes:
        scene = load_scene(name)
        exact = run(scene, ["exact"]).results["exact"]
        for setting, size, code in LADDERS[chosen.code]:
            if (name, setting, size) in done:
                continue
            start = time.perf_counter()
            found = code.solve(scene)
            if not (found and found.result):
                print(f"{name} {setting} {size:g}: {found.why if found else 'not offered'}")
                continue
            errors = compare(found.result, exact, scene, None).errors
            line = {
                "scene": name,
                "method": chosen.code,
                "setting": setting,
                "element_size": size,
                "dofs": found.unknowns,
                "errors": {key: errors.get(key) for key in ("a", "m", "n", "p", "q")},
                "cpu_s": round(found.cpu_s, 3),
                "process_cpu_s": round(found.cpu_s, 3),
                "wall_s": round(time.perf_counter() - start, 3),
                "peak_rss_mb": round(found.memory_mb, 1),
            }
            with chosen.out.open("a") as file:
                file.write(json.dumps(line) + "\n")
            print(json.dumps(line), flush=True)


if __name__ == "__main__":
    main()
