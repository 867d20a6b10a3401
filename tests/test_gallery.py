"""The gallery shows what is so: its page and figures are those of docs/gallery.py, with today's results."""

import re
import runpy
from pathlib import Path

import pytest
from outline import texts

import partialslip
from partialslip.report import rows
from partialslip.report.figure import traction_svg

DOCS = Path(__file__).parents[1] / "docs"
PAGE = (DOCS / "gallery.md").read_text("utf-8")
SCRIPT = runpy.run_path(str(DOCS / "gallery.py"))
SCENES = SCRIPT["scenes"]()
ROUNDING = 1e-9
NUMBER = re.compile(r"-?\d+\.\d+(?:e-\d+)?|\d+e-\d+")


def section(name):
    return re.search(rf"^## {name}\n.*?(?=^## |\Z)", PAGE, re.MULTILINE | re.DOTALL)[0]


def same(text, other):
    """Whether two texts have the same words, and numbers to 1e-5, those with an exponent to a factor of three."""
    pairs = list(zip(*(map(float, NUMBER.findall(each)) for each in (text, other)), strict=True))
    near = (
        abs(a - b) <= (2 / 3 * max(a, b) if 0 < max(a, b) < 1e-2 else 1e-5 * abs(b)) or max(abs(a), abs(b)) < ROUNDING
        for a, b in pairs
    )
    return NUMBER.sub("", text) == NUMBER.sub("", other) and all(near)


def test_all_scenes_have_their_section_and_figure():
    assert re.findall(r"^## (\S+)$", PAGE, re.MULTILINE) == list(SCENES)
    assert partialslip.shipped_scenes().keys() < SCENES.keys()
    figures = sorted(path.name for path in (DOCS / "gallery").iterdir())
    assert figures == sorted(f"{name}.svg" for name in SCENES)


@pytest.mark.parametrize("name", SCENES)
def test_references_are_todays(name, monkeypatch):
    monkeypatch.chdir(DOCS.parent)
    scene = partialslip.load_scene(SCENES[name])
    method = "exact" if scene.load.in_phase else "march"
    run = partialslip.run(scene, [method], stresses=True)
    result = run.results[method]
    shown = dict(re.findall(r"^\| ([mn]), .*? \| a \| (.*?) \|", section(name), re.MULTILINE))
    assert shown.keys() == set("mn")
    for key, text in shown.items():
        assert float(text) == pytest.approx(getattr(result, key) / result.a, abs=2e-7)
    heading, units, _, facts = section(name).split("\n\n")[3:7]
    if not scene.finite:  # finite elements answer for finite bodies
        assert "(fem)" in heading or same(SCRIPT["heading"](run), heading)
    assert same(rows.units(run).partition("f p0")[2], units.partition("f p0")[2])
    assert same(SCRIPT["fact"](result), facts)


def test_a_section_and_its_figure_are_what_the_script_makes():
    name = "hertz-shear"
    run = partialslip.run(partialslip.load_scene(name), stresses=True)
    assert same(SCRIPT["entry"](name, name, run).strip(), section(name).strip())
    assert texts(traction_svg(run)) == texts((DOCS / "gallery" / f"{name}.svg").read_text("utf-8"))


def test_another_result_is_noticed():
    text = section("hertz-shear")
    assert same(text, text)
    assert not same(text, text.replace("0.6324", "0.6325"))
    assert not same(text, text.replace("| ok |", "| MISSED |", 1))
