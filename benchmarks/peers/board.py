"""All codes of the board on the same problems, in turn, one at a time, each in a process of its own with one thread:
board.py [--codes ...] [--problems ...] [--keep].

For each problem, each code and each mesh of its ladder appends a line of JSON to --out: code, version, problem, size h
of the elements in a, unknowns, CPU and wall seconds of the process, peak memory, whether it converged or why not, the
largest load of the machine by others, processor, date, and the checksum of the deck. Seconds of partialslip are those
of a whole process with the start of Python; those of other codes are of the code alone, without meshing.

--keep also writes the answers into benchmarks/submissions: values, tables of tractions, the deck of PS-02 and the
script that it was run by, checksums of all decks, and meta.toml that lists them. docs/scoreboard.py makes the board of
both.
"""

import argparse
import csv
import datetime
import hashlib
import json
import os
import sys
import tempfile
import time
from importlib.resources import files
from pathlib import Path

import numpy as np

from partialslip.tools.inputfile import checksum
from partialslip.tools.origin import made_now
from partialslip.tools.output.files import zipped
from partialslip.verify.benchmark.codes import CODES, answer_on, installed, rungs_of
from partialslip.verify.benchmark.codes.getfem import HOST as GETFEM
from partialslip.verify.benchmark.codes.kratos import HOST as KRATOS
from partialslip.verify.benchmark.codes.opensees import HOST as OPENSEES
from partialslip.verify.benchmark.codes.own import Own
from partialslip.verify.benchmark.codes.process import CodeOutcome, ran
from partialslip.verify.benchmark.problem import chosen_problems
from partialslip.verify.benchmark.submission import Meta, Submission, write_submission

HERE = Path(__file__).parent
SUBMISSIONS = HERE.parent / "submissions"
TIMED = "PS-01,PS-02,PS-05,PS-23"
AUTHOR = "partialslip's developers"
SHOWN = "PS-02"  # whose deck is kept
_SCRIPTS = {"getfem": GETFEM, "kratos": KRATOS, "opensees": OPENSEES}


def main() -> None:
    """Run the chosen codes on the chosen problems."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--codes", default=",".join(CODES))
    options.add_argument("--problems", default=TIMED)
    options.add_argument("--out", type=Path, default=HERE / "timing.jsonl")
    options.add_argument("--keep", action="store_true")
    options.add_argument("--untimed", action="store_true", help="write no lines; partialslip in this process alone")
    options.add_argument("--one", nargs=2, metavar=("CODE", "RUNG"), help=argparse.SUPPRESS)
    chosen = options.parse_args()
    problems = chosen_problems(chosen.problems)
    if chosen.one:
        (problem,), (name, rung) = problems.values(), chosen.one
        list(rungs_of(CODES[name]).values())[int(rung)].solve(problem.scene)
        return
    machine = made_now().machine
    for number, problem in problems.items():
        for name in chosen.codes.split(","):
            code, outcomes = CODES[name], []
            for rung, (h, each) in enumerate(rungs_of(code).items()):
                busy, start = os.getloadavg()[0], time.perf_counter()
                found = each.solve(problem.scene)
                wall = time.perf_counter() - start
                if found and isinstance(each, Own) and not chosen.untimed:  # the whole process
                    words = ["--problems", number, "--one", name, str(rung)]
                    start = time.perf_counter()
                    with tempfile.TemporaryDirectory() as folder:
                        done = ran([sys.executable, str(Path(__file__).resolve()), *words], Path(folder))
                    wall = time.perf_counter() - start
                    found = found._replace(cpu_s=done.cpu_s, memory_mb=done.memory_mb)
                outcomes.append(found)
                if not found or chosen.untimed:
                    continue
                line = {"code": name, "version": installed(name), "problem": number, "h": h}
                line |= {"unknowns": found.unknowns, "cpu_s": round(found.cpu_s, 3), "wall_s": round(wall, 3)}
                line |= {"memory_mb": round(found.memory_mb or 0.0), "why": found.why, "load": busy}
                line |= {"processor": machine.processor, "date": f"{datetime.date.today()}"}
                line |= {"deck": sums(found)}
                with chosen.out.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(line) + "\n")
                print(json.dumps(line), flush=True)
            if chosen.keep and (answer := answer_on(code, problem, outcomes)):
                keep(name, number, answer, outcomes[-1])


def sums(outcome: CodeOutcome) -> dict[str, str]:
    """SHA-256 checksums of the input files of an outcome."""
    return {name: hashlib.sha256(content).hexdigest() for name, content in outcome.inputs.items()}


def keep(name: str, number: str, answer: object, outcome: CodeOutcome) -> None:
    """Write the ``answer`` of the code ``name`` to a problem, and what it was found from."""
    folder, code, machine = SUBMISSIONS / name, CODES[name], made_now().machine
    own = isinstance(next(iter(rungs_of(code).values())), Own)
    inputs = folder / "inputs"
    inputs.mkdir(parents=True, exist_ok=True)
    words = f"python benchmarks/peers/board.py --keep --codes {name} --problems {{}}\n"
    (inputs / "run.sh").write_text(words.format("'PS-*'"), "utf-8")
    if outcome.inputs:
        decks = inputs / "decks.sha256"
        known = decks.read_text("utf-8").splitlines() if decks.exists() else []
        known = [line for line in known if f" {number}/" not in line]
        known += [f"{checked}  {number}/{name}" for name, checked in sums(outcome).items()]
        decks.write_text("\n".join(sorted(known, key=lambda line: line[64:])) + "\n", "utf-8")
        if number == SHOWN:
            (inputs / f"{number}.zip").write_bytes(zipped(outcome.inputs))
        if host := _SCRIPTS.get(name.split("-")[0]):
            script = files("partialslip.verify.benchmark.codes") / "scripts" / host.script
            (inputs / host.script).write_bytes(script.read_bytes())
    if not own and outcome.result:
        of = outcome.result.traction
        with (folder / f"{number}.csv").open("w", encoding="utf-8") as file:
            columns = {"x": of.x, "p": of.p, "p1": of.values.p1, "dq": None, "q1": of.q1, "q2": of.q2}
            if of.q1 is None:
                columns["dq"] = of.dq
            columns = {key: values for key, values in columns.items() if values is not None}
            rows = csv.writer(file, lineterminator="\n")
            rows.writerow(columns)
            rows.writerows([f"{each:.9g}" for each in row] for row in np.column_stack(list(columns.values())))
    listed = {each.relative_to(folder).as_posix(): checksum(each, 2**30) for each in sorted(inputs.iterdir())}
    meta = Meta(
        f"partialslip {name}" if own else name, installed(name), code.settings or "the defaults",
        f"{machine.processor}, {machine.system}", AUTHOR, listed,
    )  # fmt: skip
    write_submission(Submission(meta, {number: answer}), folder)


if __name__ == "__main__":
    main()
