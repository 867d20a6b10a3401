"""CPU seconds that a process of partialslip takes besides the solution: start.py [--repeats 5].

Starts a fresh process for each method, which reads a problem and solves it three times. The start is the CPU time of
the process up to the end of the first solution, less the shorter of the other two: Python, NumPy, SciPy, partialslip,
the libraries that the method loads, and the problem. The smallest of the repeats goes to benchmarks/start.json, of
which docs/scoreboard.py makes the CPU seconds of whole processes.
"""

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

from partialslip.tools.origin import made_now

FILE = Path(__file__).parent / "start.json"
CODES = {"exact": "exact", "march": "march", "fem": "fem-1e-3", "equivalent": "equivalent"}  # by method
PROBLEM = {"equivalent": "PS-23"}  # others: PS-02
PROCESS = """
import sys, time
from partialslip.verify.benchmark import read_problems
from partialslip.verify.benchmark.codes import CODES
code, scene = CODES[sys.argv[1]], read_problems()[sys.argv[2]].scene
ends = [0.0]
for _ in range(3):
    code.solve(scene)
    ends.append(time.process_time())
first, *others = (after - before for before, after in zip(ends, ends[1:]))
print(first - min(others))
"""


def main():
    options = argparse.ArgumentParser(description=__doc__.partition(":")[0])
    options.add_argument("--repeats", type=int, default=5)
    repeats = options.parse_args().repeats
    machine = made_now().machine
    found = {}
    for name, code in CODES.items():
        command = [sys.executable, "-c", PROCESS, code, PROBLEM.get(name, "PS-02")]
        alone = os.environ | {"OPENBLAS_NUM_THREADS": "1"}
        done = [subprocess.run(command, capture_output=True, check=True, text=True, env=alone) for _ in range(repeats)]
        found[name] = round(min(float(each.stdout) for each in done), 2)
        print(f"{name}: {found[name]:.2f} CPU s", flush=True)
    content = {"machine": f"{machine.processor}, {machine.system}", "start": found}
    FILE.write_text(json.dumps(content, indent=1) + "\n")


if __name__ == "__main__":
    main()
