"""The gallery shows what is so: its page and figures are those of docs/gallery.py, with today's results."""

import re
import runpy
from pathlib import Path

import pytest
from outline import texts
from tests.test_docs_blocks import agrees

import partialslip
from partialslip.report import rows
from partialslip.report.figure import traction_svg

DOCS = Path(__file__).parents[1] / "docs"
PAGE = (DOCS / "gallery.md").read_text("utf-8")
SCRIPT = runpy.run_path(str(DOCS / "gallery.py"))
SCENES = SCRIPT["scenes"]()


def section(name):
    return re.search(rf"^## {name}\n.*?(?=^## |\Z)", PAGE, re.MULTILINE | re.DOTALL)[0]


def test_all_scenes_have_their_section_and_figure():
    assert re.findall(r"^## (\S+)$", PAGE, re.MULTILINE) == list(SCENES)
    assert partialslip.shipped_scenes().keys() < SCENES.keys()
    figures = sorted(path.name for path in (DOCS / "gallery").iterdir())
    assert figures == sorted(f"{name}.svg" for name in SCENES)


@pytest.mark.slow
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
        assert "(fem)" in heading or agrees(SCRIPT["heading"](run), heading)
    assert agrees(rows.units(run).partition("f p0")[2], units.partition("f p0")[2])
    assert agrees(SCRIPT["fact"](result), facts)


def test_a_section_and_its_figure_are_what_the_script_makes():
    name = "hertz-shear"
    run = partialslip.run(partialslip.load_scene(name), stresses=True)
    assert agrees(SCRIPT["entry"](name, name, run).strip(), section(name).strip())
    assert texts(traction_svg(run)) == texts((DOCS / "gallery" / f"{name}.svg").read_text("utf-8"))
