"""Regenerate the page of the hard cases: python docs/hard_cases.py [FOLDER] writes hard-cases.md from the catalogue and
benchmarks/hard_cases.csv. With FOLDER, that of ``partialslip verify --suite full``, the figures of that run come first.
"""

import csv
import json
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from textwrap import fill

import numpy as np

from partialslip.halfplane import contact
from partialslip.scene import Fem, Scene
from partialslip.tools.groups import grouped
from partialslip.verify import FAMILIES
from partialslip.verify.case import Case
from partialslip.verify.hard_cases import YOUNG
from partialslip.verify.hard_cases.catalogue import catalogue_page

DOCS = Path(__file__).parent
MEASURED = DOCS.parent / "benchmarks" / "hard_cases.csv"
COLUMNS = ("case", "method", "a", "m", "n", "p", "q", "certificate", "cpu_s", "machine", "date")

_TOLD = """\
`partialslip verify --suite full` on a busy machine with two cores ({machine}), {date}. *Q_f* is dQ/(2 f P) and *s_f* is
dsigma/(f p0), both with a sign, with the largest P and f where they vary. Unless a row says otherwise, the profile is
Hertz, a = 1 mm, E = 72.8 GPa, nu = 0.3 and f = 0.5; b is the half-width of a flat with round corners. Each method has
its errors of m and n against the reference, in a, and in brackets the CPU seconds of its solution. Brackets alone: the
reference, or m and n are not judged; blank: not solved by this method. The largest residual of all certificates is
{certificate:.0e}; the bar is 1e-7. Accuracies other than 2e-5:
"""
_USUAL = {"f": "0.5", "nu": "0.3"}
_METHODS = ("exact", "march", "fem")
_HEAD = f"""\
| case | Q_f | s_f | other | {" | ".join(_METHODS)} |
|---|---|---|---|---|---|---|
"""


def page() -> str:
    """Content of the page."""
    with MEASURED.open(encoding="utf-8", newline="") as file:
        rows = {(row["case"], row["method"]): row for row in csv.DictReader(file)}
    largest = max(float(row["certificate"]) for row in rows.values() if row["certificate"])
    machine = " and ".join(sorted({row["machine"] for row in rows.values()}))
    cases = [case for family in FAMILIES for case in family.cases]
    lines = [_line(case, rows) for case in cases]
    date = max(row["date"] for row in rows.values())
    told = fill(_TOLD.format(machine=machine, certificate=largest, date=date), 120, break_on_hyphens=False)
    parts = [catalogue_page(), "## Loads, and what was measured", "", told, "", *_accuracies(cases), ""]
    return "\n".join([*parts, _HEAD + "\n".join(lines), ""])


def _accuracies(cases: Iterable[Case]) -> Iterable[str]:
    """Items of a list: which ``cases`` have another accuracy than the default."""
    found = grouped((case.scene.fem.accuracy, f"`{case.name}`") for case in cases)
    for accuracy in sorted(found):
        if accuracy != Fem().accuracy:
            told = f"- {accuracy:.0e}: ".replace("e-0", "e-") + ", ".join(found[accuracy])
            yield fill(told, 120, subsequent_indent="  ", break_on_hyphens=False)


def _line(case: Case, rows: Mapping[tuple[str, str], Mapping[str, str]]) -> str:
    """Row of the table for ``case``."""
    found = [_found(rows.get((case.name, method), {})) for method in _METHODS]
    return "| " + " | ".join([f"`{case.name}`", *_loads(case.scene), *found]) + " |"


def _found(row: Mapping[str, str]) -> str:
    """Errors of m and n, and CPU seconds, of one method."""
    if not row:
        return ""
    errors = ", ".join("–" if not row.get(key) else f"{float(row[key]):.0e}".replace("e-0", "e-") for key in "mn")
    return f"{errors} ({float(row['cpu_s']):.2g})".removeprefix("–, – ")


def _loads(scene: Scene) -> list[str]:
    """Q_f, s_f of ``scene``, and what else is special of it."""
    material, load, f = scene.material, scene.load, scene.friction.f
    alike = scene if material.alike else scene.replace(material={"upper": None, "lower": None, "E": YOUNG, "nu": 0.3})
    pressed = contact(alike)
    Q, sigma = np.array(load.Q or (0.0, 0.0)) / (f * pressed.P), np.array(load.sigma) / (f * pressed.p0)
    share, tension, mean_Q, mean_sigma = (Q[1] - Q[0]) / 2, sigma[1] - sigma[0], Q.mean(), sigma.mean()
    more = []
    if b := getattr(scene.profile, "b", None):
        more.append(f"flat, b = {b / pressed.a:.4g} a")
    own = [body for body in (material.upper, material.lower) if body]
    shown = {
        "f": " to ".join(f"{each:g}" for each in sorted({np.min(scene.friction.given), np.max(scene.friction.given)})),
        "nu": ", ".join(f"{body.nu:g}" for body in own or [material]),
    }
    more += [f"{name} = {value}" for name, value in shown.items() if value != _USUAL[name]]
    means = {f"{mean_Q:.3g} f P": mean_Q, f"{mean_sigma:.3g} f p0": mean_sigma}
    if shown := [text for text, mean in means.items() if abs(mean) > 1e-9]:
        more.append("mean " + ", ".join(shown))
    if np.size(load.P) > 1 and np.ptp(load.P):
        more.append(f"P from {min(load.P) / max(load.P):.3g}")
    if np.size(load.e) > 1:
        more.append(f"e of {max(load.e) / pressed.a:.3g} a")
    more += _rig(scene)
    if own:
        more.append(" on ".join(f"{body.E / 1e9:g}" for body in own) + " GPa")
    if scene.fem.size:
        more.append(f"elements {scene.fem.size:g} a")
    near = "found" if load.displacement is not None else f"1 - {1 - share:.0e}" if 0.99 < share < 1 else f"{share:.3g}"
    return [near, f"{tension:.4g}", "; ".join(more)]


def _rig(scene: Scene) -> Iterable[str]:
    """What moves and holds finite bodies."""
    load, bodies = scene.load, (scene.bodies.upper, scene.bodies.lower)
    if load.displacement is not None:
        yield f"moved by {max(load.displacement):g} m"
    if load.spring:
        yield f"spring of {load.spring:g} Pa"
    for body in bodies:
        if getattr(body, "pivot_height", None) is not None:
            yield f"pin at height {body.pivot_height:g}"
        if getattr(body, "right_grip", None) is not None:
            yield f"right grip {body.right_grip}"


def measured(folder: Path) -> str:
    """Content of the file of figures, from the ledger of a verification in ``folder``."""
    lines = [",".join(COLUMNS)]
    for text in (folder / "ledger.jsonl").read_text("utf-8").splitlines():
        entry = json.loads(text)
        made = {"machine": entry["made"]["machine"]["processor"], "date": entry["made"]["date"][:10]}
        found: dict[str, dict[str, object]] = {}
        for verdict in entry["verdicts"]:
            row = found.setdefault(verdict["method"], {"cpu_s": round(verdict["cpu_s"], 3)})
            judged = verdict["outcome"] != "not judged" and verdict["error"] is not None
            if judged and verdict["quantity"] in COLUMNS:
                row[verdict["quantity"]] = f"{verdict['error']:.3g}"
        for method, row in found.items():
            known = {"case": entry["case"], "method": method} | made | row
            lines.append(",".join(str(known.get(name, "")) for name in COLUMNS))
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    if sys.argv[1:]:
        MEASURED.write_text(measured(Path(sys.argv[1])), "utf-8")
    (DOCS / "hard-cases.md").write_text(page(), "utf-8")
