"""The live page as a file, without a browser: self-contained, errors in one line."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from outline import Outline

from partialslip.cli import main
from partialslip.halfplane import contact
from partialslip.halfplane.gradual_table import tabled
from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.steady import stick_zones
from partialslip.scene.gradual import turns_round
from partialslip.scene.reading import load_scene
from partialslip.study.live import live_page
from partialslip.tools.errors import InputError
from partialslip.tools.output import place


@pytest.fixture(scope="module")
def text():
    return live_page(load_scene("fretting-aluminium"))


def test_one_file(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["page"]) == 0
    path = Path("results", "fretting-aluminium-page", "page.html")
    assert capsys.readouterr().out == f"written: {path}\n"
    assert main(["page", "hertz-shear", "--set", "friction.f=0.25", "--out", "here"]) == 0
    assert sorted(file.name for file in Path("here").iterdir()) == [place.REQUEST_NAME, "page.html"]
    assert "<h1>hertz-shear</h1>" in Path("here", "page.html").read_text("utf-8")


def test_it_says_what_the_sliders_do_not_reach(text):
    assert "The sliders do not reach a P or a moment that varies, loads out of phase" in text


def test_it_stands_alone(text):
    outline = Outline(text)
    assert outline.links == []
    assert not {"link", "img", "iframe", "object", "base"} & {tag for tag, _ in outline.tags}
    assert re.findall(r"@import|url\((?!#)|\bfetch\b|XMLHttpRequest|import\(", text) == []
    assert set(re.findall(r"https?://[^\"'<> ]*", text)) == {"http://www.w3.org/2000/svg"}


def test_what_it_knows_of_the_scene(text):
    scene, known = load_scene("fretting-aluminium"), Outline(text).scene
    pressed = contact(scene)
    for key, value in {"a": pressed.a, "p0": pressed.p0, "P": scene.P, "dQ": 77.5e3, "dsigma": 2e8, "f": 0.3}.items():
        assert known[key] == value
    for kind, way in (("m", -1), ("n", 1)):
        points = [(*point, line["value"]) for line in known["map"][kind] for point in line["points"][::7]]
        Qf, sf, value = np.array([point for point in points if point[0] < 0.95]).T  # Qf is rounded
        once, gradual = stick_zones(Qf, sf, HertzShape()), tabled(Qf, sf)
        turned = turns_round(Qf, sf, once.s, once.centre, once.half_width) & ~np.isnan(gradual.centre)
        ends = [zone.half_width + way * zone.centre for zone in (gradual, once)]
        assert len(Qf) > 40
        np.testing.assert_allclose(np.where(turned, *ends), value, rtol=0, atol=1e-3)


def test_the_map_reaches_as_far_as_the_loads():
    assert Outline(live_page(load_scene("hertz-shear", ["load.sigma=[-2e9, 2e9]"]))).scene["map"]["top"] > 20


def test_numbers_are_in_the_units_of_the_scene():
    shown = live_page(load_scene("fretting-aluminium", ["shown_in=N-mm"]))
    assert "p0 = 418.104 MPa, P = 135.75 N/mm" in shown
    data = json.loads(next(script for script in Outline(shown).scripts if script.lstrip().startswith("{")))
    assert data["units"] == {"m": ["mm", 1e-3], "Pa": ["MPa", 1e6], "N/m": ["N/mm", 1e3]}
    assert data["P"] == 135750.0


def test_every_field_has_a_label(text):
    tags = Outline(text).tags
    labels = {attributes["for"] for tag, attributes in tags if tag == "label" and "for" in attributes}
    fields = [attributes for tag, attributes in tags if tag == "input" and attributes["type"] != "checkbox"]
    assert [field["type"] for field in fields].count("range") == len(labels) == 4
    assert all({"aria-label", "aria-labelledby"} & field.keys() or field["id"] in labels for field in fields)


def test_a_title_is_text():
    title = "</script><script>alert(1)</script> & {{ 7 }} R&D"
    text = live_page(load_scene("hertz-shear", [f"title={json.dumps(title)}"]))
    outline = Outline(text)
    assert [tag for tag, _ in outline.tags].count("script") == 2
    assert outline.scene["title"] == title


@pytest.mark.parametrize(
    ("scene", "overrides", "says"),
    [
        ("flat-rounded", [], 'profile.kind = "flat-rounded": must be "hertz"'),
        ("hertz-shear", ["load.Q=[0, 1e5, 0, -1e5]", "load.sigma=[1e8, 0, -1e8, 0]"], "load: Q and sigma are out of"),
        (
            "fretting-aluminium",
            ["load.P=[2e5, 3e5, 2e5]", "load.Q=[0, 1e4, 2e4]", "load.sigma=[0, 0]"],
            "load: P, Q and sigma are out of phase",
        ),
        ("fretting-aluminium", ["load.P=[2e5, 3e5]"], "load: P varies; must be constant for a live page"),
        ("hertz-shear", ["load.M=50.0"], "load.M: must not be given for a live page"),
        ("hertz-shear", ["load.e=[1e-4, -1e-4]"], "load.e: must not be given for a live page"),
        ("hertz-shear", ["friction.f=0"], "friction.f = 0: must be > 0"),
        ("hertz-shear", ["effects.opposing-slip=false"], "effects.opposing-slip: must not be given for a live page"),
        ("hertz-shear", ["material.upper={E=1e9, nu=0.3}"], "material.upper, material.lower: the bodies differ"),
    ],
)
def test_scenes_that_it_is_not_for(scene, overrides, says):
    with pytest.raises(InputError, match=f"^{re.escape(says)}"):
        live_page(load_scene(scene, overrides))


def test_finite_bodies_are_said_to_be_left_out(tmp_path, capsys):
    """The page is that of half-planes under the same loads."""
    blocks = ["bodies.upper={width=1, height=1}", "bodies.lower={width=1, height=1}"]
    says = "he page shows half-planes: bodies.upper, bodies.lower left out"
    plain, page = (live_page(load_scene("hertz-shear", each)) for each in ([], blocks))
    assert [says in text for text in (plain, page)] == [False, True]
    assert Outline(plain).scene == Outline(page).scene
    command = ["page", "hertz-shear", "--set", blocks[0], "--set", blocks[1], "--out", str(tmp_path / "out")]
    assert main(command) == 0
    assert f"t{says}\n" in capsys.readouterr().out
