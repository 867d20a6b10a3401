"""Other codes on the same scenes, over a ladder of meshes: ladder.py calculix|getfem [SCENE ...].

Appends a line of JSON for every run to --out: scene, method, setting, element_size (in a; at the ends of the zones,
where the mesh is graded to them), dofs, errors of a, m, n, p and q against the exact solution as `partialslip score`
finds them, CPU seconds of the solution (for CalculiX those of the whole process) and of the whole process, wall
seconds, peak memory. Everything runs on one thread, in a fresh process. What is there already is not run again.

Meshes graded to the ends are what an expert gets by hand: the ends, in "ends", are those that the code's own run before
gave, on a uniform mesh.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import calculix
import getfem_peer

from partialslip import load_scene
from partialslip.score import score

HERE = Path(__file__).parent
SCENES = ("hertz-small-tension", "hertz-large-tension")
STIFFER = 100.0  # the half-plane knows no slopes
RUNNERS = {"calculix": calculix, "getfem": getfem_peer}


def measured(command, folder):
    """Run ``command`` in ``folder``: its output, and CPU and wall seconds and peak memory of the process."""
    environment = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
    start = time.perf_counter()
    with open(folder / "output.txt", "w+") as output:
        process = subprocess.Popen(command, cwd=folder, env=environment, stdout=output, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        wall = time.perf_counter() - start
        output.seek(0)
        text = output.read()
    if process.returncode != 0:
        raise RuntimeError(f"{command[0]} failed: {text[-500:]}")
    cost = {
        "process_cpu_s": usage.ru_utime + usage.ru_stime,
        "wall_s": wall,
        "peak_rss_mb": usage.ru_maxrss / 1024,
    }
    return text, cost


def main():
    options = argparse.ArgumentParser(description=__doc__.partition(":")[0])
    options.add_argument("code", choices=RUNNERS)
    options.add_argument("scenes", nargs="*", default=SCENES)
    options.add_argument("--out", type=Path, default=HERE / "measured.jsonl")
    options.add_argument("--python", default="/usr/bin/python3", help="one that has getfem")
    options.add_argument("--ccx", default="ccx")
    options.add_argument("--only", default="", help="settings whose name has this in it")
    chosen = options.parse_args()
    runner = RUNNERS[chosen.code]
    program = chosen.ccx if chosen.code == "calculix" else chosen.python
    lines = chosen.out.read_text().splitlines() if chosen.out.exists() else []
    done = {(line["scene"], line["setting"], line["element_size"]): line for line in map(json.loads, lines)}

    for name in chosen.scenes:
        scene, ends = load_scene(name), ()
        for setting in runner.SETTINGS:
            least = setting.fine or setting.size
            label = f"{setting.name}, growth {setting.growth:g}"
            if before := done.get((name, label, least)):
                ends = before["ends"]
                continue
            if chosen.only not in label:
                continue
            with tempfile.TemporaryDirectory() as folder:
                try:
                    file, factors, dofs, cost = runner.run(
                        scene, setting, ends if setting.fine else (), STIFFER, Path(folder), program, measured
                    )
                    outcome = score(scene, file, factors=factors)
                except Exception as error:
                    print(f"{name} {label} {least:g}: {error}", file=sys.stderr)
                    continue
            compared, found = outcome.comparisons[file.name], outcome.results[file.name]
            exact = outcome.results["exact"]
            if setting.fine is None:
                ends = [end / exact.a for end in (-found.a, -found.m, found.n, found.a)]
            line = {
                "scene": name,
                "method": chosen.code,
                "setting": label,
                "element_size": least,
                "dofs": dofs,
                "errors": {key: getattr(compared, key) for key in ("a", "m", "n", "p", "q")},
                **{key: round(value, 3) for key, value in cost.items()},
                "ends": ends,
            }
            with chosen.out.open("a") as file:
                file.write(json.dumps(line) + "\n")
            print(json.dumps(line), flush=True)


if __name__ == "__main__":
    main()
