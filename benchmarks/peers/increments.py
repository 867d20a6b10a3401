"""Codes on PS-27, where slip turns round, with 1, 8 and 64 increments per half cycle: increments.py [CODE ...].

The adapters of the benchmark (partialslip.verify.benchmark.codes) solve. Appends a line of JSON for every run to
increments.jsonl, of which docs/scoreboard.py makes a table: code, version, settings, increments (null: as the code
chooses); m and n in a as partialslip score reads them, which takes the friction bound to be met like a square root;
m_drift, m in a where it is met like (x + m)^(3/2); room, 1 - s dq/(2 f p) at x = -0.8 a, s being the sign of the
target; CPU seconds; and why there are no values. What is there already is not run again: delete the lines of a code
that has changed.
"""

import argparse
import json
from pathlib import Path

import numpy as np

from partialslip.result import Result
from partialslip.tools.errors import one_line
from partialslip.verify.benchmark import Problem, read_problems
from partialslip.verify.benchmark.codes import Code
from partialslip.verify.benchmark.codes.calculix import Calculix
from partialslip.verify.benchmark.codes.getfem import GetFEM
from partialslip.verify.benchmark.codes.kratos import Kratos
from partialslip.verify.benchmark.codes.opensees import OpenSees
from partialslip.verify.benchmark.codes.own import Own
from partialslip.verify.benchmark.measured import answer_of

OUT = Path(__file__).parent / "increments.jsonl"
PROBLEM = "PS-27"
INCREMENTS = (1, 8, 64)
PLACE = -0.8  # x/a; in one step from load point to load point, this point slips
DRIFTED = 0.01, 0.17  # room of the points from which m is read at an end that has drifted
OWN = {"partialslip march": Own("march", {}), "partialslip fem": Own("fem", {})}


def codes(increments: int) -> dict[str, Code]:
    """Codes that take exactly so many increments from load point to load point."""
    return {
        "CalculiX, mortar": Calculix(0.05, False, increments),
        "CalculiX, penalty": Calculix(0.05, True, increments),
        "GetFEM": GetFEM(0.05, increments=increments),
        "Kratos": Kratos(0.1, 8, increments),
        "OpenSees": OpenSees(0.05, 8, increments),
    }


def main() -> None:
    """Run the chosen codes."""
    options = argparse.ArgumentParser(description=__doc__.partition(":")[0])
    options.add_argument("codes", nargs="*", choices=[*OWN, *codes(1)], metavar="CODE")
    chosen = options.parse_args().codes or [*OWN, *codes(1)]
    problem = read_problems()[PROBLEM]
    lines = OUT.read_text("utf-8").splitlines() if OUT.exists() else []
    done = {(line["code"], line["increments"]) for line in map(json.loads, lines)}
    for name in chosen:
        rows = {None: OWN[name]} if name in OWN else {count: codes(count)[name] for count in INCREMENTS}
        for increments, code in rows.items():
            if (name, increments) in done:
                continue
            line = {"code": name, "increments": increments, **measured(problem, code)}
            with OUT.open("a", encoding="utf-8") as file:
                file.write(json.dumps(line) + "\n")
            print(json.dumps(line), flush=True)


def measured(problem: Problem, code: Code) -> dict[str, object]:
    """What ``code`` finds of the stick zone and of dq."""
    told: dict[str, object] = {"version": code.version, "settings": code.settings}
    found = code.solve(problem.scene)
    if not found or not found.result:
        return told | {"why": one_line(found.why) if found else "not offered", "cpu_s": found and found.cpu_s}
    result, a, f = found.result, problem.targets["a"].value, problem.scene.friction.f
    values = answer_of(problem, result).values
    ends = {key: values[key] / a for key in ("m", "n") if key in values}
    p, dq, *_ = result.traction.at(np.array([PLACE * a]))
    room = 1 - float(dq[0]) * np.sign(problem.targets[f"dq@{PLACE:g}"].value) / (2 * f * float(p[0]))
    return told | ends | {"m_drift": drifted(result, a, f), "room": room, "cpu_s": found.cpu_s}


def drifted(result: Result, a: float, f: float) -> float | None:
    """m/a at an end at which the room grows like (x + m)^(3/2); None if fewer than two points tell."""
    x, p, dq = result.traction.x / a, result.traction.p, result.traction.dq
    left = (np.abs(x) < 0.97) & (x < PLACE / 2)
    x, room = x[left], 1 - np.abs(dq[left]) / (2 * f * p[left])
    tells = (room > DRIFTED[0]) & (room < DRIFTED[1])
    if np.count_nonzero(tells) < 2:
        return None
    slope, start = np.polyfit(x[tells], room[tells] ** (2 / 3), 1)
    return float(start / slope)


if __name__ == "__main__":
    main()
