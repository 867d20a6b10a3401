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
OWN = ("mean-loads", "out-of-phase", "dovetail", "finite-pad", "fretting-rig")  # in docs/scenes

_HEAD = """\
# Gallery

The gallery has the shipped scenes, and five other scenes from `docs/scenes`. Each scene is solved at its own settings.

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

_CORRECTED = """
**A published case corrected.** `fretting-aluminium` takes the specimen of 10 mm for a half-plane. The size of the
bodies moves m by {m:+.1e} a and n by {n:+.1e} a, and the largest sigma_xx from {half_plane:.1f} to {peak:.1f} MPa
({rise:+.1%}); with R = 50 mm by {far_m:+.1e} a, {far_n:+.1e} a and {far_rise:+.1%}. `equivalent` finds m and n within
{others:.0e} a of fem. The pad is assumed: one 5 mm or 20 mm high, or clamped at its back, is within {pad:.0e} a, and
within {pad_rise:.2%} of the largest sigma_xx.

Tolerances allow more for m, and less for the stress: f 5 % larger moves m by {f_m:+.1e} a and the largest sigma_xx by
{f_rise:+.1%}, with f 5 % smaller the contact {smaller}; P 1 % larger moves them by {P_m:+.1e} a and {P_rise:+.1%}.
"""


def main(folder: Path) -> None:
    """Write the page and its figures into ``folder``."""
    (folder / "gallery").mkdir(parents=True, exist_ok=True)
    page = _HEAD
    for name, scene in scenes().items():
        run = partialslip.run(partialslip.load_scene(scene), stresses=True)
        page += entry(name, scene, run) + (corrected(run) if name == "fretting-rig" else "")
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


def corrected(run: Run) -> str:
    """What the size of the bodies of the fretting rig changes, and what tolerances do."""
    rig, fem = run.scene, run["fem"]
    half_plane = {"bodies": {"upper": None, "lower": None}}
    pads: list[dict[str, object]] = [
        {"bodies.upper.height": 5e-3}, {"bodies.upper.height": 20e-3}, {"bodies.upper.support": "clamped"}
    ]  # fmt: skip

    def solved(method: str, change: dict[str, object]) -> Result:
        return partialslip.run(rig.replace(change), method, stresses=method != "equivalent")[method]

    def moved(result: Result, other: Result) -> tuple[float, float, float]:
        """Changes of m and n (a), and of the largest sigma_xx."""
        ends = (getattr(result, key) / result.a - getattr(other, key) / other.a for key in "mn")
        return (*ends, result.surface.largest[1] / other.surface.largest[1] - 1 if result.surface else 0.0)  # type: ignore[return-value]

    exact = solved("exact", half_plane)
    far = {"profile.R": 0.050}
    own, apart = moved(fem, exact), moved(solved("fem", far), solved("exact", half_plane | far))
    other, pad = moved(solved("equivalent", {}), fem), [moved(solved("fem", each), fem) for each in pads]
    f, P = rig.friction.f, rig.load.P
    larger = moved(solved("exact", half_plane | {"friction.f": 1.05 * f}), exact)
    pressed = moved(solved("exact", half_plane | {"load.P": 1.01 * P}), exact)
    text = _CORRECTED.format(
        m=own[0], n=own[1], rise=own[2], half_plane=exact.surface.largest[1] / 1e6, peak=fem.surface.largest[1] / 1e6,
        far_m=apart[0], far_n=apart[1], far_rise=apart[2], others=max(map(abs, other[:2])),
        pad=max(abs(end) for each in pad for end in each[:2]), pad_rise=max(abs(each[2]) for each in pad),
        f_m=larger[0], f_rise=larger[2], P_m=pressed[0], P_rise=pressed[2],
        smaller="slides" if rig.replace(half_plane | {"friction.f": 0.95 * f}).slides else "still sticks",
    )  # fmt: skip
    parts = text.replace("e-0", "e-").strip().split("\n\n")
    return "".join(f"\n{textwrap.fill(part, 120, break_on_hyphens=False)}\n" for part in parts)


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
