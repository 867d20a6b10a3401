"""Finite bodies: stresses of equivalent half-planes over the size, and coupled bodies over the accuracy.

python benchmarks/bodies.py stresses FILE [--body block --body pulled-specimen] [--finer 1e-7]
python benchmarks/bodies.py coupled FILE [--scene NAME ...] [--finest 1e-7] [--steps 32]
python benchmarks/bodies.py show FILE...

Each run adds a line to FILE; runs that FILE has are not repeated.

- stresses: sigma_xx and swt of both kinds of half-planes on the scenes of docs/sizes, three sizes each, against finite
  elements at 1e-6; these at a finer accuracy tell their own error;
- coupled: unlike half-planes, unlike blocks, a pad that tilts, and the same of unlike materials (a, m, n, q1, q2),
  against the accuracy with the smallest estimates, and against small load steps at 1e-4.
"""

import argparse
import json
import math
import os
import time
from pathlib import Path

import numpy as np

import partialslip
from partialslip.study.fatigue import hot_spots
from partialslip.tools.errors import InputError

DOCS = Path(__file__).parents[1] / "docs"
UNIT = 1e-3  # m, the half-width a of the scenes of sizes
BLOCK, PULLED = "block", "pulled-specimen"
SIZES = {BLOCK: (8, 16, 32), PULLED: (4, 8, 16)}  # a: width of the blocks, half the thickness of the specimen
SHAPE = {
    BLOCK: {"upper.width": 1, "upper.height": 1, "lower.width": 1, "lower.height": 1},
    PULLED: {
        "lower.height": 1, "lower.width": 8, "upper.width": 2, "upper.height": 1, "upper.holder.width": 4,
        "upper.holder.height": 2,
    },
}  # fmt: skip
STRESSES = "sigma_xx", "swt", "swt.line"
FEM = 1e-6
ASKED = 1e-4, 1e-5, 1e-6
STEEL = {"material.upper": {"E": 210e9, "nu": 0.3}, "material.lower": {"E": 72.1e9, "nu": 0.33}, "material.E": None,
         "material.nu": None}  # fmt: skip
BLOCKS = {"bodies.upper": {"width": 4e-3, "height": 4e-3}, "bodies.lower": {"width": 4e-3, "height": 4e-3}}
COUPLED = {
    "half-planes, unlike": ("fretting-aluminium", STEEL),
    "blocks, unlike": ("fretting-aluminium", STEEL | BLOCKS),
    "pad": (DOCS / "scenes" / "finite-pad.toml", {}),
    "pad, unlike": (DOCS / "scenes" / "finite-pad.toml", STEEL),
}
ENDS, SHEAR = ("a", "m", "n"), ("q1", "q2")


def sized(body, size):
    """Scene of a body of docs/sizes at a size in a; stresses are averaged over 0.1 a."""
    changes = {f"bodies.{key}": share * size * UNIT for key, share in SHAPE[body].items()}
    return partialslip.load_scene(DOCS / "sizes" / f"{body}.toml").replace(changes | {"fatigue.distance": UNIT / 10})


def solved(scene, method, stresses=False):
    """Result and CPU seconds."""
    start = time.process_time()
    result = partialslip.run(scene, method, subsurface=stresses)[method]
    return result, time.process_time() - start


def stress_row(body, size, by, accuracy):
    """Hot spots of one method at one size: (value, estimate) each."""
    scene = sized(body, size).replace({"fem.accuracy": accuracy})
    method = {"half-plane": "march"}.get(by, by)
    result, seconds = solved(scene, method, stresses=True)
    spots = hot_spots(scene, result)
    return {"cpu": seconds, "spots": {key: (spots[key].value, spots[key].error) for key in STRESSES}}


def coupled_row(name, accuracy, steps):
    """Ends, shear at fixed places, and estimates of finite elements."""
    source, changes = COUPLED[name]
    scene = partialslip.load_scene(source).replace(changes | {"fem.accuracy": accuracy, "load.steps": steps})
    result, seconds = solved(scene, "fem")
    at = result.traction.at(grid(scene))
    values = {key: getattr(result, key) / result.a for key in ("m", "n")} | {"a": result.a / scene.length}
    shear = {key: q.tolist() for key, q in zip(SHEAR, at.levels, strict=True)} if at.levels else {}
    estimate = {key: result.estimate.get(key) for key in (*ENDS, *SHEAR)}
    return {"cpu": seconds, "values": values, "shear": shear, "estimate": estimate}


def grid(scene):
    """Places at which shear is compared, m: evenly along the contact."""
    return np.linspace(-1, 1, 2001) * 1.2 * scene.length


def collect(file, keys, measure):
    """Measure what ``file`` lacks, a line for each of ``keys``."""
    have = {json.dumps(row["key"]) for row in read([file])} if file.exists() else set()
    for key in keys:
        if json.dumps(key) not in have:
            try:
                row = measure(*key[1:])
            except InputError as error:
                row = {"refused": str(error)}
            row["load"] = os.getloadavg()[0]
            with file.open("a") as out:
                out.write(json.dumps({"key": key} | row) + "\n")
            print(*key, f"{row.get('cpu', math.nan):.1f} CPU s", row.get("refused", ""), flush=True)


def read(files):
    """Rows of all files."""
    return [json.loads(line) for file in files for line in file.read_text().splitlines()]


def show_stresses(rows):
    """Errors against the finest finite elements, estimates, and orders in the size."""
    print("| body | size, a | by | " + " | ".join(f"{key}, estimate, order" for key in STRESSES) + " | CPU s |")
    for body, by in {(key[1], key[3]): None for key in rows}:
        before = {}
        for size in SIZES[body]:
            found = rows.get(("stresses", body, size, by, FEM))
            finest = min((key[4] for key in rows if key[1:4] == (body, size, "fem")), default=None)
            true = rows.get(("stresses", body, size, "fem", finest))
            if not found or not true or found is true:
                continue
            cells = []
            for key in STRESSES:
                (value, told), (exact, _) = found["spots"][key], true["spots"][key]
                off = abs(value - exact) / exact
                cells.append(f"{off:.1e}" + ("" if by == "half-plane" else f", {told:.1e}"))
                if key in before:
                    cells[-1] += f", {math.log(before[key][1] / off) / math.log(size / before[key][0]):.1f}"
                before[key] = size, off
            print(f"| {body} | {size} | {by} | " + " | ".join(cells) + f" | {found['cpu']:.1f} |")


def show_coupled(rows):
    """Errors against the accuracy with the smallest estimates of m and n, which need not be the finest, and against
    small steps, with estimates."""
    print("| scene | asked | " + " | ".join(f"{key}, estimate" for key in (*ENDS, *SHEAR)) + " | CPU s |")
    for name in dict.fromkeys(key[1] for key in rows):
        own = {key[2:]: row for key, row in rows.items() if key[1] == name}
        plain = min(steps for _, steps in own)
        known = {accuracy: row["estimate"] for (accuracy, steps), row in own.items() if steps == plain}
        finest = min(known, key=lambda accuracy: max(known[accuracy][key] for key in ("m", "n")))
        for accuracy, steps in sorted(own, reverse=True):
            if steps == plain and accuracy != finest:
                row = own[accuracy, steps]
                small = (ASKED[0], max(steps for _, steps in own))
                against = {f"{finest:g}": own[finest, plain]}
                if accuracy == ASKED[0] and small in own and small[1] > plain:
                    against[f"{small[1]} steps"] = own[small]
                for what, true in against.items():
                    cells = " | ".join(_cell(row, true, key) for key in (*ENDS, *SHEAR))
                    print(f"| {name} | {accuracy:g}, against {what} | {cells} | {row['cpu']:.1f} |")


def _cell(row, true, key):
    told = row["estimate"][key]
    if key in ENDS:
        off = abs(row["values"][key] - true["values"][key])
        off /= true["values"]["a"] if key == "a" else 1.0
    elif not (row["shear"] and true["shear"]):
        return "not known"
    else:
        q, exact = (np.array(each["shear"][key]) for each in (row, true))
        off = float(np.linalg.norm(q - exact) / np.linalg.norm(exact))
    return f"{off:.1e}, {math.nan if told is None else told:.1e}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mode", choices=("stresses", "coupled", "show"))
    parser.add_argument("files", nargs="+", type=Path, metavar="FILE")
    parser.add_argument("--body", action="append", choices=(BLOCK, PULLED))
    parser.add_argument("--scene", action="append", choices=tuple(COUPLED))
    parser.add_argument("--finer", type=float, default=1e-7)
    parser.add_argument("--finest", type=float, default=1e-7)
    parser.add_argument("--steps", type=int, default=32)
    asked = parser.parse_args()
    if asked.mode == "stresses":
        bodies = asked.body or [BLOCK, PULLED]
        runs = ("half-plane", FEM), ("equivalent", FEM), ("fem", FEM), ("fem", asked.finer)
        keys = [["stresses", body, size, *run] for body in bodies for run in runs for size in SIZES[body]]
        collect(asked.files[0], keys, stress_row)
    elif asked.mode == "coupled":
        runs = [(ASKED[0], 1), (ASKED[0], asked.steps), *((accuracy, 1) for accuracy in (*ASKED[1:], asked.finest))]
        keys = [["coupled", name, *run] for name in asked.scene or COUPLED for run in runs]
        collect(asked.files[0], keys, coupled_row)
    else:
        rows = {tuple(row["key"]): row for row in read(asked.files)}
        for mode, show in (("stresses", show_stresses), ("coupled", show_coupled)):
            if own := {key: row for key, row in rows.items() if key[0] == mode}:
                show(own)


if __name__ == "__main__":
    main()
