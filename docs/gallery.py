"""Regenerate the gallery: python docs/gallery.py [DIR] (default: docs) writes gallery.md and gallery/*.svg."""

import sys
import textwrap
from pathlib import Path

import partialslip
from partialslip.report import answer, rows
from partialslip.report.figure import traction_svg
from partialslip.result import Result
from partialslip.run import Run

DOCS = Path(__file__).parent
_ANSWERS = ("stick zone", "a", "p0", "p_max")  # others are in the tables below
OWN = ("mean-loads", "out-of-phase", "dovetail", "finite-pad")  # in docs/scenes

_HEAD = """\
# Gallery

The gallery has the shipped scenes, and four other scenes from `docs/scenes`. Each scene is solved at its own settings.

- Lines are the reference, and markers are the finite elements.
- The figures show p in units of p0, and half the change of shear between the load points, q = (q2 - q1)/2, in units of
  f p0.
- Below them are the errors of p and q along the contact, in p0 and f p0.
- Where P varies, p is the pressure at load point 2, and q covers the contacts at both load points.
- Errors in the tables are those of `partialslip run`: a, m and n as fractions of a, p and q in the relative L2 norm of
  cell averages.
"""
_ENTRY = """
## {name}

{title}.

`partialslip run {scene}`

{table}

{facts}

![Tractions of {name} over the contact, its stick zone shaded](gallery/{name}.svg)
"""


def main(folder: Path) -> None:
    """Write the page and its figures into ``folder``."""
    (folder / "gallery").mkdir(parents=True, exist_ok=True)
    page = _HEAD
    for name, scene in scenes().items():
        run = partialslip.run(partialslip.load_scene(scene), stresses=True)
        page += entry(name, scene, run)
        (folder / "gallery" / f"{name}.svg").write_text(traction_svg(run), "utf-8")
    (folder / "gallery.md").write_text(page, "utf-8")


def scenes() -> dict[str, str]:
    """Argument of ``partialslip run`` (shipped name or path), by the name of the scene."""
    own = {name: str((DOCS / "scenes" / f"{name}.toml").relative_to(DOCS.parent)) for name in OWN}
    return {name: name for name in partialslip.shipped_scenes()} | own


def entry(name: str, scene: str, run: Run) -> str:
    """Section of a run: command, answer, errors, limits, slip and figure, in Markdown."""
    title = run.scene.title.rstrip(".")
    lines = [heading(run), rows.units(run), *(table(run, each) for each in run.comparisons)]
    facts = fact(run.results[run.reference or "fem"])
    return _ENTRY.format(name=name, title=title, scene=scene, table="\n\n".join(lines), facts=facts)


def heading(run: Run) -> str:
    """Method, regime and main answers in one paragraph."""
    own = ", ".join(f"{quantity} {value}" for quantity, value in answer.answers(run) if quantity in _ANSWERS)
    text = f"{answer.answer_heading(run)}: {own}"
    return textwrap.fill(text, 120, break_long_words=False, break_on_hyphens=False)


def table(run: Run, method: str) -> str:
    """Errors of a method as a Markdown table."""
    cells = [rows.error_headings(run, method), *rows.error_rows(run.comparisons[method])]
    lines = ["| " + " | ".join(row).rstrip() + " |" for row in cells]
    return "\n".join([lines[0], "|---" * len(cells[0]) + "|", *lines[1:]])


def fact(result: Result) -> str:
    """Regime, limits and slip in one or two sentences."""
    found = rows.facts(result)
    parts = [found["regime"], found.get("limits", ""), "slip " + found["slip"] if "slip" in found else ""]
    text = " ".join(part[0].upper() + part[1:] + "." for part in [*parts, found.get("note", "")] if part)
    return textwrap.fill(text, 120, break_long_words=False, break_on_hyphens=False)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if sys.argv[1:] else DOCS)
