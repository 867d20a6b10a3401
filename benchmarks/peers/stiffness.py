"""Stiffness of a contact condition in E/a, and what other codes find with it: stiffness.py calculix|getfem [SCENE ...].

CalculiX solves the decks of ``partialslip export`` with other numbers for pressure over overlap (normal) and for shear
over slip in stick. GetFEM solves with other constants of the augmented conditions, the same for p (normal) and q
(stick). Appends a line of JSON for every run to --out: errors of a, m, n, p and q against the exact solution, or why
there are none, and CPU seconds of the process. What is there already is not run again. ``--show`` prints the rows
that docs/symptoms.md shows.
"""

import argparse
import json
import re
import tempfile
from pathlib import Path

from partialslip import load_scene, run
from partialslip.codes.export import export
from partialslip.codes.score.method import scored
from partialslip.codes.score.read import read_tractions
from partialslip.run.judge import compare
from partialslip.tools.errors import InputError
from partialslip.verify.benchmark.codes.calculix import Calculix
from partialslip.verify.benchmark.codes.getfem import GetFEM
from partialslip.verify.benchmark.codes.process import CodeOutcome, ran
from partialslip.verify.benchmark.neutral import GROWTH, STIFFER

SCENES = ("hertz-small-tension", "hertz-large-tension")
KEYS = ("a", "m", "n", "p", "q")
NORMAL, STICK = 1e3, {"penalty": 1e2, "mortar": 1e5}  # of the export, E/a
RUNS = {  # contact, normal, stick
    "calculix": [
        *(("penalty", NORMAL, stick) for stick in (1.0, 10.0, 30.0, 100.0, 300.0, 1e3)),
        *(("penalty", normal, 1e2) for normal in (10.0, 100.0, 1e4)),
        *(("mortar", None, stick) for stick in (1e2, 1e3, 1e5)),
    ],
    "getfem": [("multipliers", constant, constant) for constant in (1e-3, 1e-2, 0.1, 1.0)],  # 10: not in minutes
}

SHOWN = {  # rows of docs/symptoms.md: the best of each contact, and what goes wrong on either side of it
    *(("penalty", NORMAL, stick) for stick in (1.0, 30.0, 1e2, 1e3)),
    *(("penalty", normal, 1e2) for normal in (1e2, 1e4)),
    *(("mortar", None, stick) for stick in (1e2, 1e5)),
    *(("multipliers", constant, constant) for constant in (0.1, 1.0, 10.0)),
}


def main():
    options = argparse.ArgumentParser(description=__doc__.partition(":")[0])
    options.add_argument("code", choices=RUNS)
    options.add_argument("scenes", nargs="*", default=SCENES)
    options.add_argument("--size", type=float, default=0.05)
    options.add_argument("--out", type=Path, default=Path(__file__).parent / "stiffness.jsonl")
    options.add_argument("--show", action="store_true")
    chosen = options.parse_args()
    lines = [json.loads(line) for line in chosen.out.read_text().splitlines()] if chosen.out.exists() else []
    if chosen.show:
        print(table(lines))
        return
    done = {tuple(line[key] for key in ("scene", "contact", "normal", "stick", "size")) for line in lines}
    for name in chosen.scenes:
        scene = load_scene(name)
        exact = run(scene, ["exact"]).results["exact"]
        for contact, normal, stick in RUNS[chosen.code]:
            if (name, contact, normal, stick, chosen.size) in done:
                continue
            code = GetFEM(chosen.size, augmentation=stick) if chosen.code == "getfem" else None
            line = {"scene": name, "contact": contact, "normal": normal, "stick": stick, "size": chosen.size}
            line["version"] = (code or Calculix(chosen.size, contact == "penalty")).version
            found = code.solve(scene) if code else calculix(scene, contact, normal, stick, chosen.size)
            if found.result:
                errors = compare(found.result, exact, scene, None).errors
                line["errors"] = {key: errors.get(key) for key in KEYS}
            else:
                line["why"] = found.why
            line["cpu_s"] = round(found.cpu_s, 3)
            with chosen.out.open("a") as file:
                file.write(json.dumps(line) + "\n")
            print(json.dumps(line), flush=True)


def calculix(scene, contact, normal, stick, size):
    """Outcome of CalculiX with the deck of ``scene``, changed."""
    penalty = contact == "penalty"
    with tempfile.TemporaryDirectory() as folder:
        deck = Path(folder) / "job.inp"
        export(scene, "calculix", size=size, growth=GROWTH, stiffer=STIFFER, penalty=penalty)(deck)
        text = deck.read_text()
        f, written = re.search(r"\*FRICTION\n(\S+), (\S+)\n", text).groups()
        unit = float(written) / STICK[contact]  # E/a of the deck
        text = text.replace(f"*FRICTION\n{f}, {written}\n", f"*FRICTION\n{f}, {stick * unit:.6e}\n")
        if penalty:
            text = re.sub(r"(OVERCLOSURE=LINEAR\n)\S+", rf"\g<1>{normal * unit:.6e}", text)
        deck.write_text(text)
        done = ran(["ccx", "job"], deck.parent)
        cost = None, done.cpu_s, done.memory_mb
        try:
            if done.code != 0 or "Job finished" not in done.text:
                return CodeOutcome(None, "gave up", *cost)
            return CodeOutcome(
                scored(scene, read_tractions(deck.with_suffix(".frd"), scene), "calculix", "job.frd"), "", *cost
            )
        except InputError as error:
            return CodeOutcome(None, str(error), *cost)


def table(lines):
    """Markdown table of those ``lines`` that the page shows."""
    rows = ["| scene | contact | normal | stick | " + " | ".join(KEYS) + " | CPU s |", "|---" * 10 + "|"]
    for line in lines:
        if (line["contact"], line["normal"], line["stick"]) not in SHOWN:
            continue
        errors = line.get("errors", {})
        found = [f"{errors[key]:.0e}" if errors.get(key) is not None else "*none*" for key in KEYS]
        normal = "–" if line["normal"] is None else f"{line['normal']:g}"
        scene = line["scene"].split("-")[1]
        rows.append("| " + " | ".join([scene, line["contact"], normal, f"{line['stick']:g}", *found]) + " | ")
        rows[-1] += f"{line['cpu_s']:.3g} |"
    return "\n".join(rows)


if __name__ == "__main__":
    main()
